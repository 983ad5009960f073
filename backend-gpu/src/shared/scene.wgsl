// A resident scene. Twin of core/src/scene/compiled.rs and core/src/bvh.rs.

const NONE: u32 = 0xffffffffu;

const MATERIAL_OPAQUE: u32 = 0u;
const MATERIAL_MIRROR: u32 = 1u;
const MATERIAL_DIELECTRIC: u32 = 2u;

const LIGHT_SPHERE: u32 = 0u;
const LIGHT_TRIANGLE: u32 = 1u;
const LIGHT_POINT: u32 = 2u;
const LIGHT_SPOT: u32 = 3u;
const LIGHT_DIRECTIONAL: u32 = 4u;
const LIGHT_ENVIRONMENT: u32 = 5u;

const HAS_NORMALS: u32 = 1u;
const HAS_TEXCOORDS: u32 = 2u;
const EMITS_BOTH_SIDES: u32 = 1u;

struct BvhNode {
    min: vec3<f32>,
    first: u32,
    max: vec3<f32>,
    count: u32,
}

struct Triangle {
    p0: vec3<f32>,
    id: u32,
    p1: vec3<f32>,
    material: u32,
    p2: vec3<f32>,
    light: u32,
    normal: vec3<f32>,
    offset: f32,
}

struct TriangleAttributes {
    n0: vec3<f32>,
    flags: u32,
    n1: vec3<f32>,
    uv2_v: f32,
    n2: vec3<f32>,
    uv2_u: f32,
    uv0: vec2<f32>,
    uv1: vec2<f32>,
}

struct MaterialRecord {
    albedo: vec3<f32>,
    kind: u32,
    specular_f0: vec3<f32>,
    alpha: f32,
    emission: vec3<f32>,
    flags: u32,
    specular_f90: f32,
    ior: f32,
    smith_k: f32,
    texture_offset: u32,
    texture_width: u32,
    texture_height: u32,
    texture_wrap: u32,
    padding: u32,
}

struct LightRecord {
    position: vec3<f32>,
    kind: u32,
    direction: vec3<f32>,
    radius: f32,
    emission: vec3<f32>,
    select_pdf: f32,
    alias_threshold: u32,
    // `alias` is a word that WGSL keeps for itself.
    alias_light: u32,
    triangle: u32,
    flags: u32,
    spot_scale: f32,
    spot_offset: f32,
    area: f32,
    padding: u32,
}

struct EnvironmentHeader {
    world_to_map: array<vec4<f32>, 3>,
    offset: u32,
    width: u32,
    height: u32,
    light: u32,
    light_count: u32,
    sphere_count: u32,
    flags: u32,
    padding: u32,
}

// EnvironmentHeader.flags
const NOTHING_HIDES: u32 = 1u;

// Every kernel that includes this file binds the scene here, and its own buffers from 8 on.
@group(0) @binding(1) var<storage, read> nodes: array<BvhNode>;
@group(0) @binding(2) var<storage, read> triangles: array<Triangle>;
@group(0) @binding(3) var<storage, read> attributes: array<TriangleAttributes>;
@group(0) @binding(4) var<storage, read> materials: array<MaterialRecord>;
@group(0) @binding(5) var<storage, read> lights: array<LightRecord>;
@group(0) @binding(6) var<storage, read> words: array<u32>;
// Word 0 becomes 1 when a loop ended early; the rest is the kernel's.
@group(0) @binding(7) var<storage, read_write> status: array<atomic<u32>>;
