// Twin of `math::fragment`: what a surface adds to a voxel's sums. Wants `params.texel_count` and a global
// `texels: array<u32>`.

const NONE: u32 = 0xffffffffu;
const CLAMP: u32 = 1u;

// As arrays of words: a vec3 would begin at a multiple of 16 bytes.
struct VoxelSurface {
    normals: array<u32, 3>,
    texture: u32,
    texcoords: array<vec2<i32>, 3>,
    texture_size: u32,
    flags: u32,
    tint: vec2<u32>,
    emission: vec2<u32>,
}

// What a fragment adds.
struct Fragment {
    albedo: vec3<u32>,
    normal: vec3<i32>,
    emission: vec3<u32>,
}

fn fragment_at(surface: VoxelSurface, weights: vec3<u32>) -> Fragment {
    let w = vec3<i32>(weights);
    let sum = w.x * normal_bytes(surface.normals[0])
        + w.y * normal_bytes(surface.normals[1])
        + w.z * normal_bytes(surface.normals[2]);
    let normal = (sum + vec3<i32>(1 << 13u)) >> vec3<u32>(14u);
    let texel = texel_at(surface, w);
    let channels = vec3<u32>(texel, texel >> 10u, texel >> 20u) & vec3<u32>(1023u);
    let albedo = (unpacked_halves(surface.tint) * channels + vec3<u32>(511u)) / 1023u;
    return Fragment(albedo, normal, unpacked_halves(surface.emission));
}

// The texel at the weighted texture coordinates; white where there is none.
fn texel_at(surface: VoxelSurface, weights: vec3<i32>) -> u32 {
    let white = (1u << 30u) - 1u;
    if surface.texture == NONE {
        return white;
    }
    let sum = weights.x * surface.texcoords[0]
        + weights.y * surface.texcoords[1]
        + weights.z * surface.texcoords[2];
    let whole = sum >> vec2<u32>(20u);
    let size = vec2<u32>(surface.texture_size & 0xffffu, surface.texture_size >> 16u);
    let clamped = max(min(whole, vec2<i32>(size) - vec2<i32>(1)), vec2<i32>(0));
    let period = max(vec2<i32>(size), vec2<i32>(1));
    let wrapped = (whole % period + period) % period;
    let at = vec2<u32>(select(wrapped, clamped, (surface.flags & CLAMP) != 0u));
    let index = surface.texture + at.y * size.x + at.x;
    // Surfaces of other origin.
    if index >= params.texel_count {
        return white;
    }
    return texels[index];
}

// Three signed bytes, the lowest first.
fn normal_bytes(word: u32) -> vec3<i32> {
    return vec3<i32>(vec3<u32>(word << 24u, word << 16u, word << 8u)) >> vec3<u32>(24u);
}

// Red and green share a word.
fn unpacked_halves(words: vec2<u32>) -> vec3<u32> {
    return vec3<u32>(words.x & 0xffffu, words.x >> 16u, words.y & 0xffffu);
}
