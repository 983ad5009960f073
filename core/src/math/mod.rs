//! The mathematics kernels share. Each file is the twin of `backend-gpu/src/shared/<stem>.wgsl`.

pub mod fixed;
pub mod fragment;
pub mod hash;
pub mod morton;
pub mod octahedral;
pub mod packed;
pub mod sobol;
pub mod trig;
pub mod vector;
