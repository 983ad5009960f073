//! The three accuracy classes. Every output of every kernel names its own, with the reason.

/// How far two backends may differ in an output, and why.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Accuracy {
    /// Bit for bit on every backend, adapter, thread count, tile size and shard count.
    Exact {
        /// Why equality can be promised.
        because: &'static str,
    },
    /// Inside an interval derived from the operations; bit for bit in strict mode on adapters that round correctly.
    Interval {
        /// Where the interval comes from.
        because: &'static str,
    },
    /// Two estimators of the same integral: z-test with Šidák correction and a signed-bias test.
    Statistical {
        /// Why only expectations can be compared.
        because: &'static str,
    },
}

impl Accuracy {
    /// The class's name as printed in reports.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Exact { .. } => "exact",
            Self::Interval { .. } => "interval",
            Self::Statistical { .. } => "statistical",
        }
    }

    /// The stated reason.
    pub fn because(&self) -> &'static str {
        match self {
            Self::Exact { because } | Self::Interval { because } | Self::Statistical { because } => because,
        }
    }
}
