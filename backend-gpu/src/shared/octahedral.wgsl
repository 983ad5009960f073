// From a direction to the nearest of a fixed set. Twin of core/src/math/octahedral.rs. The kernel declares
// nearest_map: array<u32>, the words of the map.

const LAST_CANDIDATE: u32 = 0x8000u;
const CANDIDATE_INDEX: u32 = 0x7fffu;

// The odd number of units 2^-15 that is within one of |c|, which is cut at 1.
fn steps(c: f32) -> i32 {
    let size = abs(c);
    let cut = select(1.0f, size, size < 1.0f);
    return 2 * i32(cut * 16384.0f) + 1;
}

// The number of steps with the sign of c. Subnormals, which adapters may flush, count as 0, and 0 as positive.
fn signed_steps(c: f32) -> i32 {
    return select(steps(c), -steps(c), c < -1e-30f);
}

// The direction in units of 2^-15.
fn quantised(direction: vec3<f32>) -> vec3<i32> {
    return vec3<i32>(signed_steps(direction.x), signed_steps(direction.y), signed_steps(direction.z));
}

// Octahedral projection, with the faces below z = 0 folded outwards over the diagonals.
fn cell_of(q: vec3<i32>, resolution: u32) -> u32 {
    let x = u32(abs(q.x));
    let y = u32(abs(q.y));
    let z = u32(abs(q.z));
    let sum = x + y + z;
    let middle = resolution >> 1u;
    let column = select(x, sum - y, q.z < 0) * middle / sum;
    let row = select(y, sum - x, q.z < 0) * middle / sum;
    let row_index = select(middle + row, middle - 1u - row, q.y < 0);
    return row_index * resolution + select(middle + column, middle - 1u - column, q.x < 0);
}

// The cell of an octahedral map that the unit direction falls into. Even resolutions from 2 to 4096.
fn nearest_cell(direction: vec3<f32>, resolution: u32) -> u32 {
    return cell_of(quantised(direction), resolution);
}

// Scalar product with a candidate's vector.
fn alignment(q: vec3<i32>, xy: u32, z: u32) -> i32 {
    let x = bitcast<i32>(xy << 16u) >> 16u;
    let y = bitcast<i32>(xy) >> 16u;
    return q.x * x + q.y * y + q.z * (bitcast<i32>(z) >> 16u);
}

// Index of the direction nearest to the unit direction. The first of equals.
fn nearest_direction(resolution: u32, direction: vec3<f32>) -> u32 {
    let q = quantised(direction);
    var at = nearest_map[cell_of(q, resolution)];
    var word = nearest_map[at + 1u];
    var nearest = word & CANDIDATE_INDEX;
    // About half of the cells have one candidate, and no product to compute.
    if (word & LAST_CANDIDATE) == LAST_CANDIDATE {
        return nearest;
    }
    var best = alignment(q, nearest_map[at], word);
    // A foreign map may lack the mark of the last candidate.
    while (word & LAST_CANDIDATE) == 0u && at + 3u < arrayLength(&nearest_map) {
        at += 2u;
        word = nearest_map[at + 1u];
        let aligned = alignment(q, nearest_map[at], word);
        if aligned > best {
            best = aligned;
            nearest = word & CANDIDATE_INDEX;
        }
    }
    return nearest;
}
