// Bilinear lookup of 8-bit sRGB textures. Twin of core/src/transport/texture.rs.

fn texel(material: MaterialRecord, x: u32, y: u32) -> vec3<f32> {
    let word = words[material.texture_offset + y * material.texture_width + x];
    return vec3<f32>(
        bitcast<f32>(words[word & 0xffu]),
        bitcast<f32>(words[(word >> 8u) & 0xffu]),
        bitcast<f32>(words[(word >> 16u) & 0xffu]),
    );
}

// The coordinate brought into [0, 1].
fn wrapped(coordinate: f32, wrap: u32) -> f32 {
    if wrap == 1u {
        let low = select(coordinate, 0.0f, coordinate < 0.0f);
        return select(low, 1.0f, low > 1.0f);
    }
    return coordinate - floor(coordinate);
}

struct Taps {
    first: u32,
    second: u32,
    // Weight of the second.
    weight: f32,
}

fn taps(coordinate: f32, size: u32, wrap: u32) -> Taps {
    let x = wrapped(coordinate, wrap) * f32(size) - 0.5f;
    let below = floor(x);
    let first = i32(below);
    let last = i32(size) - 1;
    let before = select(last, 0, wrap == 1u);
    let after = select(0, last, wrap == 1u);
    let i0 = select(first, before, first < 0);
    let i1 = select(first + 1, after, first + 1 > last);
    return Taps(u32(select(i0, last, i0 > last)), u32(i1), x - below);
}

fn sample_texture(material: MaterialRecord, u: f32, v: f32) -> vec3<f32> {
    let x = taps(u, material.texture_width, material.texture_wrap);
    let y = taps(v, material.texture_height, material.texture_wrap);
    let a = texel(material, x.first, y.first);
    let b = texel(material, x.second, y.first);
    let c = texel(material, x.first, y.second);
    let d = texel(material, x.second, y.second);
    let top = a + (b - a) * x.weight;
    let bottom = c + (d - c) * x.weight;
    return top + (bottom - top) * y.weight;
}
