const WORKGROUP_SIZE: u32 = 64u;

struct Probe {
    count: u32,
}

@group(0) @binding(0) var<uniform> params: Probe;
// a, b and what is to become of them.
@group(0) @binding(1) var<storage, read> wide_a: array<vec2<u32>>;
@group(0) @binding(2) var<storage, read> wide_b: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read_write> results: array<vec2<u32>>;

@compute @workgroup_size(64)
fn probe(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.count {
        return;
    }
    let a = wide_a[index];
    let b = wide_b[index];
    let word = i32(b.x);
    let divisor = (b.x & 0x7fffffffu) | select(0u, 1u, (b.x & 0x7fffffffu) == 0u);
    results[6u * index] = wide_mul(i32(a.x), word);
    results[6u * index + 1u] = wide_add(a, b);
    results[6u * index + 2u] = wide_sub(a, b);
    results[6u * index + 3u] = wide_scale(a, word);
    results[6u * index + 4u] = wide_shift_left(a, b.x % 31u + 1u);
    results[6u * index + 5u] = vec2<u32>(wide_div_floor(a, divisor), divisor);
}
