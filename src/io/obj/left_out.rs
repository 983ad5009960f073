//! What of an OBJ file is not read.

use std::collections::BTreeMap;

/// What is left out, and how often.
#[derive(Default)]
pub(super) struct LeftOut {
    pub colors: usize,
    pub small_faces: usize,
    pub partial_faces: usize,
    pub statements: BTreeMap<&'static str, usize>,
    /// Notices about the first few.
    pub unknown: Vec<String>,
    pub unknown_count: usize,
}

impl LeftOut {
    /// One notice per kind, and those about single statements.
    pub fn notices(self, name: &str) -> Vec<String> {
        let Self { colors, small_faces, partial_faces, statements, unknown, unknown_count } = self;
        let mut notices = Vec::new();
        let mut counted = |count: usize, what: &str| {
            if count > 0 {
                notices.push(format!("{name}: {count} {what}"));
            }
        };
        counted(colors, "vertex colours ignored");
        counted(small_faces, "faces with fewer than 3 corners left out");
        let partial = "faces whose corners don't all have texture coordinates or normals: those dropped";
        counted(partial_faces, partial);
        for (statement, count) in statements {
            counted(count, &format!("'{statement}' statements left out: only faces are drawn"));
        }
        counted(unknown_count.saturating_sub(unknown.len()), "more unknown statements ignored");
        notices.extend(unknown);
        notices
    }
}
