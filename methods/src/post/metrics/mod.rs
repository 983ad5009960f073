//! How far one image is from another.
//!
//! Two families. *Radiance* metrics (MAE, MSE, NRMSE, relMSE, ratio) look at linear radiance as it is. *Display*
//! metrics (PSNR, MSSIM, ꟻLIP) look at what a [`Display`](super::tonemap::Display) shows: exposure, tone curve,
//! clamp to [0, 1]; no metric quantises to 8 bits. The z-test ([`ztest`]) is neither: it asks whether two noisy
//! estimates can have one expectation.
//!
//! Non-finite pixels: a pixel with a NaN or an infinity in any channel of either image is counted and left out of
//! every mean. Windowed metrics (MSSIM, ꟻLIP) replace it by black in both images, so that it adds no difference
//! of its own to its neighbours, and leave out the window centred on it. A comparison without a single usable
//! pixel is an error.
//!
//! The first image is the one under test, the second the reference; only MAE, MSE, PSNR, MSSIM and ꟻLIP are
//! symmetric.

mod comparison;
mod convolve;
pub mod flip;
mod metric;
pub mod mssim;
mod pair;
pub mod pointwise;
pub mod ztest;

pub use comparison::{CompareSettings, Comparison};
pub use metric::Metric;
