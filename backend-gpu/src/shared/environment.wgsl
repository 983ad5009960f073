// The environment map: lookup and sampling. Twin of core/src/transport/environment.rs.

struct EnvironmentValue {
    radiance: vec3<f32>,
    pdf: f32,
}

fn texel_value(index: u32) -> EnvironmentValue {
    let base = params.environment.offset + params.environment.height + 1u + index * 6u;
    return EnvironmentValue(
        vec3<f32>(bitcast<f32>(words[base]), bitcast<f32>(words[base + 1u]), bitcast<f32>(words[base + 2u])),
        bitcast<f32>(words[base + 3u]),
    );
}

fn row_cosine(row: u32) -> f32 {
    return bitcast<f32>(words[params.environment.offset + row]);
}

fn map_row(i: u32) -> vec3<f32> {
    return params.environment.world_to_map[i].xyz;
}

// What comes from the unit `direction`. Only for scenes with an environment.
fn environment_from(direction: vec3<f32>) -> EnvironmentValue {
    let x = dot_product(map_row(0u), direction);
    let y = dot_product(map_row(1u), direction);
    let z = dot_product(map_row(2u), direction);
    var low = 0u;
    var high = params.environment.height;
    while high - low > 1u {
        let middle = (low + high) >> 1u;
        if row_cosine(middle) >= y {
            low = middle;
        } else {
            high = middle;
        }
    }
    let width = params.environment.width;
    let column = u32(atan2_turns(x, -z) * f32(width));
    let last = width - 1u;
    return texel_value(low * width + select(last, column, column < last));
}

struct EnvironmentSample {
    direction: vec3<f32>,
    value: EnvironmentValue,
}

// A direction towards the environment: `choice` picks the texel, (u, v) the point in it.
fn sample_environment(choice: vec2<u32>, u: f32, v: f32) -> EnvironmentSample {
    let width = params.environment.width;
    let height = params.environment.height;
    let row_index = to_index(choice.x, width * height).x;
    let base = params.environment.offset + height + 1u + row_index * 6u;
    var index = words[base + 5u];
    if choice.y < words[base + 4u] {
        index = row_index;
    }
    let row = index / width;
    let column = index - row * width;
    let top = row_cosine(row);
    let cosine = top + (row_cosine(row + 1u) - top) * v;
    let squared = 1.0f - cosine * cosine;
    var sine = 0.0f;
    if squared > 0.0f {
        sine = sqrt(squared);
    }
    let sc = sin_cos_turns((f32(column) + u) / f32(width));
    let local = vec3<f32>(sine * sc.x, cosine, -(sine * sc.y));
    let direction = (map_row(0u) * local.x + map_row(1u) * local.y) + map_row(2u) * local.z;
    return EnvironmentSample(direction, texel_value(index));
}
