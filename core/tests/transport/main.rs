//! Laws of the shared transport functions: samplers follow their densities, materials conserve energy.

mod bsdf;
mod chi_squared;
mod light;
mod offset;
