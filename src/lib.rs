//! twinlight

#[cfg(feature = "io")]
pub mod io;
