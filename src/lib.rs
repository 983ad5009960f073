//! twinlight
