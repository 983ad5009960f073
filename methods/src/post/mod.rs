//! What happens to an image after it is rendered: comparison, display, false colour.
//!
//! Everything here runs on the host, single-threaded and in a fixed order, so the same images give the same
//! numbers on the same machine. Sums are `f64`. Nothing here is a kernel: no result feeds back into light
//! transport.
//!
//! ```
//! use twinlight_methods::post::{image::Image, metrics::{CompareSettings, Comparison, Metric}};
//!
//! let reference = Image::filled(16, 16, [0.5; 3])?;
//! let rendered = Image::filled(16, 16, [0.6; 3])?;
//! let comparison = Comparison::new(&rendered, &reference, &CompareSettings::default())?;
//! for metric in Metric::ALL {
//!     println!("{:8} {:.6}  {}", metric.name(), comparison.value(metric), metric.formula());
//! }
//! assert!((comparison.radiance_ratio - 1.2).abs() < 1e-6);
//! # Ok::<(), twinlight_methods::post::PostError>(())
//! ```

pub mod error;
pub mod falsecolor;
pub mod image;
pub mod metrics;
pub mod tonemap;

pub use error::PostError;
pub use twinlight_core::srgb;
