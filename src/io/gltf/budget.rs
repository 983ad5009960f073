//! Memory promised to the scene being read.
//!
//! Many primitives may refer to one accessor and many nodes to one mesh, so that a small file can describe a large scene:
//! what is built is counted, before it is built.

use std::cell::Cell;
use twinlight_core::scene::Limits;
use twinlight_core::{Error, Result};

/// What has been spent of the limits.
pub(super) struct Budget {
    limits: Limits,
    bytes: Cell<u64>,
    triangles: Cell<u64>,
}

impl Budget {
    pub fn new(limits: Limits) -> Self {
        Self { limits, bytes: Cell::new(0), triangles: Cell::new(0) }
    }

    /// The limits, for what is checked elsewhere.
    pub fn limits(&self) -> &Limits {
        &self.limits
    }

    /// Spends memory for `count` things of `size` bytes.
    pub fn spend(&self, place: impl Fn() -> String, count: u64, size: u64) -> Result<()> {
        let total = count.checked_mul(size).and_then(|b| b.checked_add(self.bytes.get()));
        match total.filter(|&t| t <= self.limits.max_bytes) {
            Some(total) => {
                self.bytes.set(total);
                Ok(())
            }
            None => {
                let needed = total.unwrap_or(u64::MAX);
                Err(Error::limit(format!("{}: bytes of the scene", place()), needed, self.limits.max_bytes))
            }
        }
    }

    /// Counts triangles of an instance.
    pub fn add_triangles(&self, place: impl Fn() -> String, count: u64) -> Result<()> {
        let total = self.triangles.get().saturating_add(count);
        self.triangles.set(total);
        if total > self.limits.max_triangles {
            let what = format!("{}: triangles of the scene", place());
            return Err(Error::limit(what, total, self.limits.max_triangles));
        }
        Ok(())
    }
}
