//! The WGSL files that kernels share: twins of `twinlight_core::math` and `twinlight_core::transport` under the same
//! stems, and what the GPU alone needs.

use crate::source::WgslFile;

macro_rules! shared {
    ($($(#[$doc:meta])* $name:ident = $stem:literal;)*) => {
        $(
            $(#[$doc])*
            pub const $name: WgslFile = WgslFile {
                path: concat!("backend-gpu/src/shared/", $stem, ".wgsl"),
                text: include_str!(concat!("shared/", $stem, ".wgsl")),
            };
        )*
    };
}

shared! {
    /// Twin of `transport::bsdf`.
    BSDF = "bsdf";
    /// Twin of `transport::cone`; wants `shared/morton.wgsl`, and the structs and bindings of `trace_cones`.
    CONE = "cone";
    /// Dispatches of any size, loops that end early.
    DISPATCH = "dispatch";
    /// Twin of `transport::environment`; wants `params.environment`.
    ENVIRONMENT = "environment";
    /// Twin of `math::fixed`.
    FIXED = "fixed";
    /// Twin of `math::fragment`; wants `params.texel_count` and a global `texels: array<u32>`.
    FRAGMENT = "fragment";
    /// Twin of `math::hash`.
    HASH = "hash";
    /// Twin of `transport::intersect`.
    INTERSECT = "intersect";
    /// Twin of `lattice`.
    LATTICE = "lattice";
    /// Twin of `transport::lhb`; wants `shared/look_up.wgsl` and the scene's triangles.
    LHB = "lhb";
    /// Twin of `transport::light`; wants `params.environment`.
    LIGHT = "light";
    /// What a lookup in layered hit buffers meets, and the bindings of them; wants `params.lhb`.
    LOOK_UP = "look_up";
    /// Twin of `math::morton`.
    MORTON = "morton";
    /// Twin of `math::octahedral`; wants a global `nearest_map: array<u32>`.
    OCTAHEDRAL = "octahedral";
    /// Twin of `transport::offset`.
    OFFSET = "offset";
    /// Twin of `math::packed`; wants a struct `LhbElement`.
    PACKED = "packed";
    /// What the kernels that follow paths share; wants `params.call`, `params.environment` and `DENSER_COUNTS`.
    PATH = "path";
    /// Twin of `scene::compiled`, and the scene's bindings.
    SCENE = "scene";
    /// Twin of `math::sobol`.
    SOBOL = "sobol";
    /// Twin of `transport::surface`.
    SURFACE = "surface";
    /// Twin of `transport::texture`.
    TEXTURE = "texture";
    /// Closest and any hit.
    TRAVERSE = "traverse";
    /// Twin of `math::trig`.
    TRIG = "trig";
    /// Twin of `math::vector`.
    VECTOR = "vector";
    /// Twin of `lattice::voxel`; wants `shared/wide.wgsl` and `params.items`.
    VOXEL = "voxel";
    /// Triangles cut into items, and the bindings of them; wants `shared/voxel.wgsl` and `params.items`.
    VOXEL_ITEMS = "voxel_items";
    /// Twin of `transport::voxel_light`; wants `params.call` and `params.environment`.
    VOXEL_LIGHT = "voxel_light";
    /// 64-bit integers, which Rust has and WGSL hasn't.
    WIDE = "wide";
}
