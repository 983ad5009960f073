//! WGSL structs and constants equal their Rust twins: names, offsets, sizes, values. Needs no GPU.
//!
//! Each kernel adds one [`Twins`] to [`twins`]. A Rust field that is missing in the table fails to compile only if it
//! is misspelt; one that is left out shows as a WGSL field that nothing answers to.

use std::mem::{offset_of, size_of};
use twinlight_backend_gpu::kernels::voxelize::items;
use twinlight_backend_gpu::kernels::{
    self, filter_indirect, light_voxels, merge_lhb, pack_lhb, path, query_lhb, rasterize_lhb, reduce_mips,
    scan, shade_primary, sort, sum_voxels, trace, trace_cones, trace_paths, voxelize, walk_lhb,
};
use twinlight_backend_gpu::source::{CheckedModule, KernelSource, WgslFile};
use twinlight_core::kernels::{
    filter_indirect as filter_contract, light_voxels as lights_contract, merge_lhb as merge_contract,
    pack_lhb as pack_contract, query_lhb as query_contract, rasterize_lhb as lhb_contract,
    reduce_mips as mips_contract, shade_primary as shade_contract, sum_voxels as sums_contract,
    trace as trace_contract, trace_cones as cones_contract, trace_paths as paths_contract,
    voxelize as voxel_contract, walk_lhb as walk_contract,
};
use twinlight_core::transport::{intersect, lhb, light};
use twinlight_core::{bvh, lattice, math, scene, transport};

/// A Rust struct: name, size, and its fields with their offsets.
struct Layout {
    name: &'static str,
    size: usize,
    fields: Vec<(&'static str, usize)>,
}

/// `layout!(Type { field, … })`, fields in the order of the WGSL struct of the same name. `field as other` where WGSL
/// reserves the word.
macro_rules! layout {
    (@name $field:ident) => { stringify!($field) };
    (@name $field:ident $wgsl:ident) => { stringify!($wgsl) };
    ($module:ident :: $name:ident { $($field:ident $(as $wgsl:ident)?),* $(,)? }) => {
        Layout {
            name: stringify!($name),
            size: size_of::<$module::$name>(),
            fields: vec![$((layout!(@name $field $($wgsl)?), offset_of!($module::$name, $field))),*],
        }
    };
}

struct Twins {
    source: &'static KernelSource,
    structs: Vec<Layout>,
    constants: Vec<(&'static str, Constant)>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Constant {
    U32(u32),
    I32(i32),
    F32(f32),
}

impl From<u32> for Constant {
    fn from(value: u32) -> Self {
        Self::U32(value)
    }
}

impl From<i32> for Constant {
    fn from(value: i32) -> Self {
        Self::I32(value)
    }
}

impl From<f32> for Constant {
    fn from(value: f32) -> Self {
        Self::F32(value)
    }
}

fn twins() -> Vec<Twins> {
    vec![
        Twins {
            source: &scan::SOURCE,
            structs: vec![layout!(scan::ScanParams { count, tile_count })],
            constants: vec![("TILE_SIZE", scan::TILE_SIZE.into())],
        },
        Twins {
            source: &sort::SOURCE,
            structs: vec![layout!(sort::SortParams {
                count,
                tile_count,
                key_words,
                word,
                shift,
                other_count,
                other_first,
                window_begin,
                window_count
            })],
            constants: vec![
                ("WORKGROUP_SIZE", sort::WORKGROUP_SIZE.into()),
                ("TILE_SIZE", sort::TILE_SIZE.into()),
                ("DIGIT_BITS", sort::DIGIT_BITS.into()),
                ("DIGITS", sort::DIGITS.into()),
            ],
        },
        Twins {
            source: &rasterize_lhb::SOURCE,
            structs: vec![
                layout!(rasterize_lhb::RasterizeLhbBlock {
                    call,
                    view_begin,
                    triangle_begin,
                    triangle_count,
                    pair_count,
                    view_count,
                    vertex_count,
                    item_begin,
                    item_end,
                    fill,
                    list_count,
                    element_count,
                    run,
                    tile_count,
                    loop_rounds,
                    padding,
                }),
                layout!(rasterize_lhb::ListTile { list_begin, list_len, begin }),
                layout!(rasterize_lhb::ListSums { elements_low, elements_high, tiles, longest }),
                layout!(lhb_contract::RasterizeLhbParams { size, path, layer_cap, cap_side }),
                layout!(lhb_contract::LhbElement { surface, depth }),
                layout!(lattice::View { right, down, forward }),
            ],
            constants: vec![
                ("WORKGROUP_SIZE", rasterize_lhb::WORKGROUP_SIZE.into()),
                ("TILE_SIZE", rasterize_lhb::TILE_SIZE.into()),
                ("LISTS_PER_LANE", rasterize_lhb::LISTS_PER_LANE.into()),
                ("DEPTH_ORIGIN", (lattice::DEPTH_ORIGIN as u32).into()),
                ("PATH_AUTO", lhb_contract::PATH_AUTO.into()),
                ("PATH_MICRO", lhb_contract::PATH_MICRO.into()),
                ("PATH_BLOCKS", lhb_contract::PATH_BLOCKS.into()),
                ("PATH_LINEAR", lhb_contract::PATH_LINEAR.into()),
                ("PATH_SPANS", lhb_contract::PATH_SPANS.into()),
                ("CAP_FAR", lhb_contract::CAP_FAR.into()),
            ],
        },
        Twins {
            source: &merge_lhb::SOURCE,
            structs: vec![
                layout!(merge_lhb::MergeLhbBlock {
                    call,
                    list_count,
                    kept_count,
                    added_count,
                    element_count,
                    loop_rounds,
                }),
                layout!(merge_contract::MergeLhbParams { first_triangle, layer_cap, cap_side, padding }),
                layout!(lhb_contract::LhbElement { surface, depth }),
            ],
            constants: vec![
                ("WORKGROUP_SIZE", merge_lhb::WORKGROUP_SIZE.into()),
                ("MALFORMED", merge_lhb::MALFORMED.into()),
                ("HAS_LONG_LISTS", merge_lhb::HAS_LONG_LISTS.into()),
                ("CAP_FAR", lhb_contract::CAP_FAR.into()),
            ],
        },
        Twins {
            source: &pack_lhb::SOURCE,
            structs: vec![
                layout!(pack_lhb::PackLhbBlock {
                    layers,
                    cap_side,
                    list_count,
                    element_count,
                    word_count,
                    has_left_out,
                    loop_rounds,
                    padding,
                }),
                layout!(lhb_contract::LhbElement { surface, depth }),
            ],
            constants: vec![
                ("WORKGROUP_SIZE", pack_lhb::WORKGROUP_SIZE.into()),
                ("MALFORMED", pack_lhb::MALFORMED.into()),
                ("TRIANGLES", pack_lhb::TRIANGLES.into()),
                ("MAX_TRIANGLES", pack_contract::MAX_TRIANGLES.into()),
                ("EMPTY", pack_contract::EMPTY.into()),
                ("SURFACE_BITS", pack_contract::SURFACE_BITS.into()),
                ("DEPTH_SHIFT", pack_contract::DEPTH_SHIFT.into()),
                ("LAST_BIN", pack_contract::LAST_BIN.into()),
                ("CAP_FAR", lhb_contract::CAP_FAR.into()),
            ],
        },
        Twins {
            source: &query_lhb::SOURCE,
            structs: with_lookups(vec![layout!(query_lhb::QueryLhbBlock {
                lhb,
                query_count,
                loop_rounds,
                padding,
            })]),
            constants: with_lookup_constants(vec![("WORKGROUP_SIZE", query_lhb::WORKGROUP_SIZE.into())]),
        },
        Twins {
            source: &trace::SOURCE,
            structs: with_scene(vec![
                layout!(trace::TraceParams { ray_count, loop_rounds }),
                layout!(trace_contract::Ray { origin, t_min, direction, t_max }),
                layout!(trace_contract::Hit { t, triangle, u, v }),
            ]),
            constants: with_intersection(vec![("WORKGROUP_SIZE", trace::WORKGROUP_SIZE.into())]),
        },
        Twins {
            source: &shade_primary::SOURCE,
            structs: with_camera(vec![
                layout!(shade_primary::ShadePrimaryBlock {
                    call,
                    environment,
                    loop_rounds,
                    pixel_begin,
                    pixel_count,
                    padding,
                }),
                layout!(shade_contract::ShadePrimaryParams { camera, width, height, padding }),
                layout!(shade_contract::GBufferTexel {
                    position,
                    depth,
                    geometric_normal,
                    triangle,
                    shading_normal,
                    material,
                    albedo,
                    padding,
                }),
            ]),
            constants: with_lights(vec![("WORKGROUP_SIZE", shade_primary::WORKGROUP_SIZE.into())]),
        },
        Twins {
            source: &trace_paths::SOURCE,
            structs: with_paths(vec![layout!(trace_paths::TracePathsBlock {
                call,
                environment,
                segment,
                alive_word,
                loop_rounds,
                film_begin,
            })]),
            constants: with_path_constants(vec![(
                "VERTICES_PER_DISPATCH",
                trace_paths::VERTICES_PER_DISPATCH.into(),
            )]),
        },
        Twins {
            source: &walk_lhb::SOURCE,
            structs: with_lookups(with_paths(vec![
                layout!(walk_lhb::WalkLhbParams {
                    call,
                    lookup,
                    environment,
                    lhb,
                    segment,
                    alive_word,
                    loop_rounds,
                    film_begin,
                }),
                layout!(walk_lhb::Walker {
                    path,
                    normal,
                    leaves,
                    slot,
                    u,
                    v,
                    t,
                    light,
                    order,
                    to_light,
                    light_distance,
                }),
                layout!(walk_contract::WalkLhbBlock {
                    centre,
                    steps_per_unit,
                    unit_per_step,
                    row_scale,
                    lift,
                    size,
                    subpixel_bits,
                    map_resolution,
                    flags,
                    interleave,
                    gather_begin,
                    gather_count,
                    padding,
                }),
            ])),
            constants: with_lookup_constants(with_path_constants(vec![
                ("CONE", walk_contract::CONE.into()),
                ("GATHER", walk_contract::GATHER.into()),
                ("SHADOW_LOOKUPS", walk_contract::SHADOW_LOOKUPS.into()),
                ("SHADOW_LOOKUPS_FIRST", walk_contract::SHADOW_LOOKUPS_FIRST.into()),
                ("TRACE_MISSES", walk_contract::TRACE_MISSES.into()),
                ("FINE", lhb::FINE.into()),
                ("COARSE", lhb::COARSE.into()),
                ("ACROSS", lhb::ACROSS.into()),
                ("HALF_DIAGONAL", lhb::HALF_DIAGONAL.into()),
                ("ROUNDING", lhb::ROUNDING.into()),
                ("LEAST_SLOPE", lhb::LEAST_SLOPE.into()),
                ("GREATEST_SLOPE", lhb::GREATEST_SLOPE.into()),
            ])),
        },
        Twins {
            source: &filter_indirect::SOURCE,
            structs: vec![
                layout!(filter_indirect::FilterIndirectBlock {
                    width,
                    height,
                    window,
                    least_cosine,
                    footprint,
                    diffuse_count,
                    pixel_begin,
                    pixel_count,
                    neighbour_begin,
                    loop_rounds,
                    padding,
                }),
                layout!(shade_contract::GBufferTexel {
                    position,
                    depth,
                    geometric_normal,
                    triangle,
                    shading_normal,
                    material,
                    albedo,
                    padding,
                }),
                layout!(filter_contract::RadianceTexel { rgb, padding }),
            ],
            constants: vec![
                ("WORKGROUP_SIZE", filter_indirect::WORKGROUP_SIZE.into()),
                ("LEAST_ALBEDO", filter_contract::LEAST_ALBEDO.into()),
                ("NO_HIT", trace_contract::NO_HIT.into()),
            ],
        },
        Twins {
            source: &reduce_mips::SOURCE,
            structs: vec![
                layout!(reduce_mips::ReduceMipsBlock {
                    storage,
                    padded,
                    level_count,
                    word_count,
                    level,
                    word_begin,
                    word_end,
                    below_word,
                    value_begin,
                    value_end,
                    below_value,
                    padding,
                }),
                layout!(mips_contract::VoxelLight { rgb, opacity }),
            ],
            constants: vec![
                ("WORKGROUP_SIZE", reduce_mips::WORKGROUP_SIZE.into()),
                ("ANISOTROPIC", mips_contract::ANISOTROPIC.into()),
                ("HARMONICS", mips_contract::HARMONICS.into()),
                ("SUMS", mips_contract::SUMS.into()),
                ("RANGES", mips_contract::RANGES.into()),
                ("OPAQUE", mips_contract::OPAQUE.into()),
                ("NEAR_LESS_FAR", mips_contract::NEAR_LESS_FAR.into()),
                ("TWO_THIRDS", mips_contract::TWO_THIRDS.into()),
            ],
        },
        Twins {
            source: &voxelize::SOURCE,
            structs: with_voxel_items(vec![layout!(voxelize::VoxelizeBlock {
                items,
                cutoff,
                small_count,
                word_count,
                level,
                words_per_rank,
                code_begin,
                code_end,
                padding,
            })]),
            constants: with_voxel_constants(vec![("WORKGROUP_SIZE", voxelize::WORKGROUP_SIZE.into())]),
        },
        Twins {
            source: &sum_voxels::SOURCE,
            structs: with_voxel_items(vec![
                layout!(sum_voxels::SumVoxelsBlock { items, texel_count, active_begin, active_end, padding }),
                layout!(sums_contract::VoxelSurface {
                    normals,
                    texture,
                    texcoords,
                    texture_size,
                    flags,
                    tint,
                    emission,
                }),
            ]),
            constants: with_voxel_constants(vec![
                ("WORKGROUP_SIZE", sum_voxels::WORKGROUP_SIZE.into()),
                ("SUM_WORDS", words(size_of::<sums_contract::VoxelSums>()).into()),
                ("COUNT", words(offset_of!(sums_contract::VoxelSums, count)).into()),
                ("NORMAL", words(offset_of!(sums_contract::VoxelSums, normal)).into()),
                ("EMISSION", words(offset_of!(sums_contract::VoxelSums, emission)).into()),
                ("NONE", sums_contract::NONE.into()),
                ("CLAMP", sums_contract::CLAMP.into()),
            ]),
        },
        Twins {
            source: &trace_cones::SOURCE,
            structs: vec![
                layout!(trace_cones::TraceConesCall {
                    call,
                    dims,
                    level_count,
                    word_starts,
                    value_words,
                    cone_count,
                    padding,
                }),
                layout!(cones_contract::TraceConesBlock { frame, unit, reach, storage, flags }),
                layout!(cones_contract::VoxelFrame { corner, voxels_per_unit }),
                layout!(cones_contract::Cone { origin, sine, direction, start, normal, padding }),
                layout!(cones_contract::ConeLight { rgb, transmittance }),
            ],
            constants: vec![
                ("WORKGROUP_SIZE", trace_cones::WORKGROUP_SIZE.into()),
                ("ISOTROPIC", mips_contract::ISOTROPIC.into()),
                ("ANISOTROPIC", mips_contract::ANISOTROPIC.into()),
                ("HARMONICS", mips_contract::HARMONICS.into()),
                ("HARMONICS_8", mips_contract::HARMONICS_8.into()),
                ("OPAQUE", mips_contract::OPAQUE.into()),
                ("MAX_SINE", cones_contract::MAX_SINE.into()),
                ("MAX_STEPS", cones_contract::MAX_STEPS.into()),
                ("PLANE_MARGIN", cones_contract::PLANE_MARGIN.into()),
                ("LEAST_TRANSMITTANCE", cones_contract::LEAST_TRANSMITTANCE.into()),
                ("SIXTY_DEGREES", cones_contract::SIXTY_DEGREES.into()),
            ],
        },
        Twins {
            source: &light_voxels::SOURCE,
            structs: with_scene(vec![
                layout!(light_voxels::LightVoxelsParams {
                    call,
                    environment,
                    voxel_count,
                    sample_begin,
                    sample_end,
                    is_lit,
                    has_gathered,
                    loop_rounds,
                    padding,
                }),
                layout!(lights_contract::LightVoxelsBlock { frame, seed, samples, scale, emission_unit }),
                layout!(cones_contract::VoxelFrame { corner, voxels_per_unit }),
                layout!(sums_contract::VoxelSums { albedo, count, normal, padding, emission, padding_too }),
                layout!(filter_contract::RadianceTexel { rgb, padding }),
                layout!(mips_contract::VoxelLight { rgb, opacity }),
            ]),
            constants: with_lights(vec![
                ("WORKGROUP_SIZE", light_voxels::WORKGROUP_SIZE.into()),
                ("LIFT", lights_contract::LIFT.into()),
                ("MAX_RADIANCE", mips_contract::MAX_RADIANCE.into()),
                ("OPAQUE", mips_contract::OPAQUE.into()),
                ("INV_PI", transport::INV_PI.into()),
            ]),
        },
    ]
}

fn words(bytes: usize) -> u32 {
    (bytes / size_of::<u32>()) as u32
}

/// The structs of `shared/voxel.wgsl` and `shared/voxel_items.wgsl`.
fn with_voxel_items(mut structs: Vec<Layout>) -> Vec<Layout> {
    structs.extend([
        layout!(lattice::VoxelGrid { dims, scale, offset, subvoxel_bits }),
        layout!(items::VoxelItems {
            grid,
            separation,
            triangle_count,
            list_count,
            cells_per_item,
            most_items,
            item_begin,
            item_end,
            padding,
        }),
        layout!(items::ListedTriangle { corners, triangle, padding }),
    ]);
    structs
}

/// The structs of `shared/scene.wgsl`.
fn with_scene(mut structs: Vec<Layout>) -> Vec<Layout> {
    structs.extend([
        layout!(bvh::BvhNode { min, first, max, count }),
        layout!(scene::Triangle { p0, id, p1, material, p2, light, normal, offset }),
        layout!(scene::TriangleAttributes { n0, flags, n1, uv2_v, n2, uv2_u, uv0, uv1 }),
        layout!(scene::MaterialRecord {
            albedo, kind, specular_f0, alpha, emission, flags, specular_f90, ior, smith_k, texture_offset,
            texture_width, texture_height, texture_wrap, padding,
        }),
        layout!(scene::LightRecord {
            position, kind, direction, radius, emission, select_pdf, alias_threshold, alias as alias_light, triangle,
            flags, spot_scale, spot_offset, area, padding,
        }),
        layout!(scene::EnvironmentHeader {
            world_to_map, offset, width, height, light, light_count, sphere_count, flags, padding,
        }),
    ]);
    structs
}

/// Those, and the struct of `shared/surface.wgsl`.
fn with_camera(mut structs: Vec<Layout>) -> Vec<Layout> {
    structs.push(layout!(paths_contract::CameraRecord {
        position,
        padding_a,
        corner,
        padding_b,
        step_x,
        padding_c,
        step_y,
        padding_d,
        forward,
        padding_e,
    }));
    with_scene(structs)
}

/// Those, and the structs of `shared/path.wgsl`.
fn with_paths(mut structs: Vec<Layout>) -> Vec<Layout> {
    structs.extend([
        layout!(path::PathState {
            origin,
            pdf,
            direction,
            vertices,
            throughput,
            alive,
            direct,
            numbers_of,
            indirect,
            padding_b,
        }),
        layout!(paths_contract::TracePathsParams {
            camera, width, height, pixel_begin, pixel_count, sample_begin, sample_count, seed, max_bounces,
            roulette_begin, sampler as sampler_kind, film_exponent, moment_exponent,
        }),
        layout!(paths_contract::FilmTexel { direct, indirect, luminance_squared, samples, rejected }),
    ]);
    with_camera(structs)
}

/// The structs of `shared/look_up.wgsl`.
fn with_lookups(mut structs: Vec<Layout>) -> Vec<Layout> {
    // WGSL has no numbers of 16 bits.
    let plane = layout!(lattice::LatticePlane { offset });
    structs.extend([
        layout!(query_lhb::LhbHeader { size, view_count, element_count, plane_count }),
        layout!(query_contract::LhbQuery { position, ray, offset, leaves, window }),
        layout!(lhb_contract::LhbElement { surface, depth }),
        layout!(lattice::View { right, down, forward }),
        Layout { fields: [vec![("normal_xy", 0), ("normal_z", 4)], plane.fields].concat(), ..plane },
    ]);
    structs
}

type Constants = Vec<(&'static str, Constant)>;

/// The constants of `shared/intersect.wgsl` and `shared/traverse.wgsl`.
fn with_intersection(mut constants: Constants) -> Constants {
    constants.extend([
        ("MIN_DIRECTION", intersect::MIN_DIRECTION.into()),
        ("SLAB_FAR_FACTOR", intersect::SLAB_FAR_FACTOR.into()),
        ("PAD_EXTENT", intersect::PAD_EXTENT.into()),
        ("PAD_COORDINATE", intersect::PAD_COORDINATE.into()),
        ("SIDE_ERROR", intersect::SIDE_ERROR.into()),
        ("STACK", (bvh::MAX_DEPTH + 1).into()),
        ("NONE", scene::NONE.into()),
        ("NONE", trace_contract::NO_HIT.into()),
    ]);
    constants
}

/// Those, and what `shared/{offset,surface,light}.wgsl` use.
fn with_lights(mut constants: Constants) -> Constants {
    constants.extend([
        ("FAR", light::FAR.into()),
        ("SHADOW_REACH", light::SHADOW_REACH.into()),
        ("PI", transport::PI.into()),
        ("HAS_NORMALS", scene::HAS_NORMALS.into()),
        ("HAS_TEXCOORDS", scene::HAS_TEXCOORDS.into()),
        ("EMITS_BOTH_SIDES", scene::EMITS_BOTH_SIDES.into()),
        ("LIGHT_SPHERE", scene::LIGHT_SPHERE.into()),
        ("LIGHT_TRIANGLE", scene::LIGHT_TRIANGLE.into()),
        ("LIGHT_POINT", scene::LIGHT_POINT.into()),
        ("LIGHT_SPOT", scene::LIGHT_SPOT.into()),
        ("LIGHT_DIRECTIONAL", scene::LIGHT_DIRECTIONAL.into()),
        ("LIGHT_ENVIRONMENT", scene::LIGHT_ENVIRONMENT.into()),
    ]);
    with_intersection(constants)
}

/// Those, and the constants of `shared/path.wgsl` and `shared/bsdf.wgsl`.
fn with_path_constants(mut constants: Constants) -> Constants {
    constants.extend([
        ("WORKGROUP_SIZE", path::WORKGROUP_SIZE.into()),
        ("SAMPLER_SOBOL", paths_contract::SAMPLER_SOBOL.into()),
        ("PAIRS_PER_VERTEX", paths_contract::PAIRS_PER_VERTEX.into()),
        ("MAX_SURVIVAL", paths_contract::MAX_SURVIVAL.into()),
        ("INV_PI", transport::INV_PI.into()),
        ("MATERIAL_OPAQUE", scene::MATERIAL_OPAQUE.into()),
        ("MATERIAL_MIRROR", scene::MATERIAL_MIRROR.into()),
        ("MATERIAL_DIELECTRIC", scene::MATERIAL_DIELECTRIC.into()),
        ("OUT_OF_RANGE", math::fixed::OUT_OF_RANGE[0].into()),
    ]);
    with_lights(constants)
}

/// The constants of `shared/voxel.wgsl`.
fn with_voxel_constants(mut constants: Constants) -> Constants {
    constants.extend([
        ("CONSERVATIVE", voxel_contract::CONSERVATIVE.into()),
        ("MARGIN", voxel_contract::MARGIN.into()),
        ("SCALE_BITS", lattice::SCALE_BITS.into()),
        ("WEIGHT_BITS", lattice::WEIGHT_BITS.into()),
    ]);
    constants
}

/// The constants of `shared/look_up.wgsl`.
fn with_lookup_constants(mut constants: Constants) -> Constants {
    constants.extend([
        ("DEPTH_ORIGIN", (lattice::DEPTH_ORIGIN as u32).into()),
        ("CLEARANCE", query_contract::CLEARANCE.into()),
        ("NO_ELEMENT", query_contract::NO_ELEMENT.into()),
    ]);
    constants
}

#[test]
fn every_kernel_has_a_row() {
    for source in kernels::ALL {
        let rows = twins().iter().filter(|twins| twins.source.stem == source.stem).count();
        assert_eq!(rows, 1, "{}", source.stem);
    }
}

#[test]
fn structs_and_constants_agree() {
    for twins in twins() {
        let checked = twins.source.check().unwrap_or_else(|error| panic!("{error}"));
        for layout in &twins.structs {
            if let Err(difference) = compare_struct(&checked, layout) {
                panic!("{}: {difference}", twins.source.stem);
            }
        }
        for &(name, value) in &twins.constants {
            if let Err(difference) = compare_constant(&checked, name, value) {
                panic!("{}: {difference}", twins.source.stem);
            }
        }
    }
}

#[test]
fn every_struct_of_a_buffer_is_in_the_table() {
    for twins in twins() {
        let checked = twins.source.check().unwrap_or_else(|error| panic!("{error}"));
        let module = &checked.module;
        for (_, global) in module.global_variables.iter().filter(|(_, global)| global.binding.is_some()) {
            let mut ty = &module.types[global.ty];
            while let naga::TypeInner::Array { base, .. } = ty.inner {
                ty = &module.types[base];
            }
            if let (naga::TypeInner::Struct { .. }, Some(name)) = (&ty.inner, &ty.name) {
                let listed = twins.structs.iter().any(|layout| layout.name == name);
                assert!(listed, "{}: {name} of {:?} has no twin", twins.source.stem, global.name);
            }
        }
    }
}

/// The workgroup sizes that the indices in the WGSL assume.
#[test]
fn workgroup_sizes_are_those_of_the_constants() {
    for twins in twins() {
        let checked = twins.source.check().unwrap_or_else(|error| panic!("{error}"));
        for entry_point in &checked.module.entry_points {
            let size: u32 = entry_point.workgroup_size.iter().product();
            if let Err(difference) = compare_constant(&checked, "WORKGROUP_SIZE", size.into()) {
                panic!("{} / {}: {difference}", twins.source.stem, entry_point.name);
            }
        }
    }
}

#[test]
fn a_wrong_twin_is_named() {
    const TEXT: &str = "
struct Probe { a: u32, b: vec3<f32>, c: u32 }
const SIZE: u32 = 3u;
const WIDTH: f32 = 0.1f;
@group(0) @binding(0) var<uniform> params: Probe;
@compute @workgroup_size(1) fn probe() { _ = params.a; }";
    let source = KernelSource { stem: "probe", files: &[WgslFile { path: "probe.wgsl", text: TEXT }] };
    let checked = source.check().expect("valid");
    let probe = |size, fields| compare_struct(&checked, &Layout { name: "Probe", size, fields });
    assert_eq!(probe(32, vec![("a", 0), ("b", 16), ("c", 28)]), Ok(()));
    let wrong = [
        (probe(32, vec![("a", 0), ("b", 4), ("c", 28)]), "field b is at 16 in WGSL, at 4 in Rust"),
        (probe(32, vec![("a", 0), ("c", 16), ("b", 28)]), "field b in WGSL is c in Rust"),
        (probe(32, vec![("a", 0), ("b", 16)]), "field c is only in WGSL"),
        (probe(32, vec![("a", 0), ("b", 16), ("c", 28), ("d", 32)]), "field d is only in Rust"),
        (probe(28, vec![("a", 0), ("b", 16), ("c", 28)]), "32 bytes in WGSL, 28 in Rust"),
    ];
    for (result, expected) in wrong {
        assert_eq!(result, Err(format!("Probe: {expected}")));
    }
    assert_eq!(compare_constant(&checked, "SIZE", 3_u32.into()), Ok(()));
    assert_eq!(compare_constant(&checked, "WIDTH", 0.1_f32.into()), Ok(()));
    assert!(compare_constant(&checked, "SIZE", 4_u32.into()).is_err());
    assert!(compare_constant(&checked, "WIDTH", 0.1_f32.next_up().into()).is_err());
    assert!(compare_constant(&checked, "ABSENT", 4_u32.into()).is_err());
}

fn compare_struct(checked: &CheckedModule, layout: &Layout) -> Result<(), String> {
    let name = layout.name;
    let found = checked.module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name));
    let Some((_, naga::Type { inner: naga::TypeInner::Struct { members, span }, .. })) = found else {
        return Err(format!("{name}: no such struct in WGSL"));
    };
    for position in 0..members.len().max(layout.fields.len()) {
        let wgsl =
            members.get(position).map(|member| (member.name.as_deref().unwrap_or_default(), member.offset));
        match (wgsl, layout.fields.get(position)) {
            (Some((field, _)), None) => return Err(format!("{name}: field {field} is only in WGSL")),
            (None, Some((field, _))) => return Err(format!("{name}: field {field} is only in Rust")),
            (Some((wgsl, _)), Some(&(rust, _))) if wgsl != rust => {
                return Err(format!("{name}: field {wgsl} in WGSL is {rust} in Rust"));
            }
            (Some((field, wgsl)), Some(&(_, rust))) if wgsl as usize != rust => {
                return Err(format!("{name}: field {field} is at {wgsl} in WGSL, at {rust} in Rust"));
            }
            _ => {}
        }
    }
    if *span as usize != layout.size {
        return Err(format!("{name}: {span} bytes in WGSL, {} in Rust", layout.size));
    }
    Ok(())
}

fn compare_constant(checked: &CheckedModule, name: &str, value: Constant) -> Result<(), String> {
    let module = &checked.module;
    let found = module.constants.iter().find(|(_, constant)| constant.name.as_deref() == Some(name));
    let Some((_, constant)) = found else {
        return Err(format!("{name}: no such constant in WGSL"));
    };
    let mut init = constant.init;
    // A vector is compared by its first component.
    while let naga::Expression::Compose { ref components, .. } = module.global_expressions[init] {
        init = components[0];
    }
    match (&module.global_expressions[init], value) {
        (naga::Expression::Literal(naga::Literal::U32(wgsl)), Constant::U32(rust)) if *wgsl == rust => Ok(()),
        (naga::Expression::Literal(naga::Literal::I32(wgsl)), Constant::I32(rust)) if *wgsl == rust => Ok(()),
        (naga::Expression::Literal(naga::Literal::F32(wgsl)), Constant::F32(rust))
            if wgsl.to_bits() == rust.to_bits() =>
        {
            Ok(())
        }
        (wgsl, _) => Err(format!("{name} is {wgsl:?} in WGSL, {value:?} in Rust")),
    }
}
