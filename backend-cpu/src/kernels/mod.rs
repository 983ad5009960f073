//! The CPU twins. Contracts: [`twinlight_core::kernels`].

pub(crate) mod scan;
pub(crate) mod sort;
pub(crate) mod trace;
