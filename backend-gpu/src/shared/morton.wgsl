// Twin of `math::morton`: codes of voxels in Morton order.

// `x` with two zeroes between its bits, for x < 2^10.
fn spread(x: u32) -> u32 {
    let a = (x | (x << 16u)) & 0x030000ffu;
    let b = (a | (a << 8u)) & 0x0300f00fu;
    let c = (b | (b << 4u)) & 0x030c30c3u;
    return (c | (c << 2u)) & 0x09249249u;
}

// The way back from `spread`.
fn gather_thirds(x: u32) -> u32 {
    let a = x & 0x09249249u;
    let b = (a | (a >> 2u)) & 0x030c30c3u;
    let c = (b | (b >> 4u)) & 0x0300f00fu;
    let d = (c | (c >> 8u)) & 0x030000ffu;
    return (d | (d >> 16u)) & 0x3ffu;
}

fn morton_code(voxel: vec3<u32>) -> u32 {
    return spread(voxel.x) | (spread(voxel.y) << 1u) | (spread(voxel.z) << 2u);
}

fn morton_voxel(code: u32) -> vec3<u32> {
    return vec3<u32>(gather_thirds(code), gather_thirds(code >> 1u), gather_thirds(code >> 2u));
}
