//! How elements split into named fields, so that evidence can say which one differs.

use bytemuck::Pod;
use twinlight_core::kernels::filter_indirect::RadianceTexel;
use twinlight_core::kernels::rasterize_lhb::LhbElement;
use twinlight_core::kernels::reduce_mips::VoxelLight;
use twinlight_core::kernels::shade_primary::GBufferTexel;
use twinlight_core::kernels::sum_voxels::VoxelSums;
use twinlight_core::kernels::trace::Hit;
use twinlight_core::kernels::trace_paths::FilmTexel;

/// How the bits of a field read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// `u32`.
    Unsigned,
    /// `u64`, or (low, high) words.
    Unsigned64,
    /// `f32`.
    Float,
}

impl Kind {
    /// Value and bit pattern.
    pub fn show(self, bits: u64) -> String {
        match self {
            Self::Unsigned => format!("{bits} ({bits:#010x})"),
            Self::Unsigned64 => format!("{bits} ({bits:#018x})"),
            Self::Float => format!("{:e} ({bits:#010x})", f32::from_bits(bits as u32)),
        }
    }

    fn bytes(self) -> usize {
        if self == Self::Unsigned64 { 8 } else { 4 }
    }
}

/// Consecutive values of one kind.
#[derive(Debug, Clone, Copy)]
pub struct Field {
    /// As in the contract; several values get `.0`, `.1`, ….
    pub name: &'static str,
    /// How to read them.
    pub kind: Kind,
    /// How many.
    pub count: usize,
}

const fn field(name: &'static str, kind: Kind, count: usize) -> Field {
    Field { name, kind, count }
}

/// An element the comparator can take apart.
pub trait Record: Pod + Send + Sync {
    /// The fields in memory order, without gaps.
    const FIELDS: &'static [Field];

    /// Calls `visit(name, kind, bits of a, bits of b)` for every value.
    fn each(a: &Self, b: &Self, mut visit: impl FnMut(&str, Kind, u64, u64)) {
        let (a, b) = (bytemuck::bytes_of(a), bytemuck::bytes_of(b));
        let word = |bytes: &[u8]| bytes.iter().rev().fold(0_u64, |word, &byte| word << 8 | u64::from(byte));
        let mut at = 0;
        for field in Self::FIELDS {
            for lane in 0..field.count {
                let range = at..at + field.kind.bytes();
                let name =
                    if field.count == 1 { field.name.to_owned() } else { format!("{}.{lane}", field.name) };
                visit(&name, field.kind, word(&a[range.clone()]), word(&b[range.clone()]));
                at = range.end;
            }
        }
    }
}

impl Record for u32 {
    const FIELDS: &'static [Field] = &[field("value", Kind::Unsigned, 1)];
}

impl Record for u64 {
    const FIELDS: &'static [Field] = &[field("value", Kind::Unsigned64, 1)];
}

impl Record for Hit {
    const FIELDS: &'static [Field] = &[
        field("t", Kind::Float, 1),
        field("triangle", Kind::Unsigned, 1),
        field("u", Kind::Float, 1),
        field("v", Kind::Float, 1),
    ];
}

impl Record for LhbElement {
    const FIELDS: &'static [Field] =
        &[field("surface", Kind::Unsigned, 1), field("depth", Kind::Unsigned, 1)];
}

impl Record for GBufferTexel {
    const FIELDS: &'static [Field] = &[
        field("position", Kind::Float, 3),
        field("depth", Kind::Float, 1),
        field("geometric_normal", Kind::Float, 3),
        field("triangle", Kind::Unsigned, 1),
        field("shading_normal", Kind::Float, 3),
        field("material", Kind::Unsigned, 1),
        field("albedo", Kind::Float, 3),
        field("padding", Kind::Unsigned, 1),
    ];
}

impl Record for FilmTexel {
    const FIELDS: &'static [Field] = &[
        field("direct", Kind::Unsigned64, 3),
        field("indirect", Kind::Unsigned64, 3),
        field("luminance_squared", Kind::Unsigned64, 1),
        field("samples", Kind::Unsigned, 1),
        field("rejected", Kind::Unsigned, 1),
    ];
}

impl Record for RadianceTexel {
    const FIELDS: &'static [Field] = &[field("rgb", Kind::Float, 3), field("padding", Kind::Unsigned, 1)];
}

impl Record for VoxelSums {
    const FIELDS: &'static [Field] = &[
        field("albedo", Kind::Unsigned, 3),
        field("count", Kind::Unsigned, 1),
        field("normal", Kind::Unsigned, 3),
        field("padding", Kind::Unsigned, 1),
        field("emission", Kind::Unsigned, 3),
        field("padding_too", Kind::Unsigned, 1),
    ];
}

impl Record for VoxelLight {
    const FIELDS: &'static [Field] = &[field("rgb", Kind::Unsigned, 3), field("opacity", Kind::Unsigned, 1)];
}
