// Twin of `lattice::voxel` and of `lattice::VoxelGrid::place`: which voxels a triangle meets. Wants shared/wide.wgsl,
// `params.items` (shared/voxel_items.wgsl).
//
// Points and voxels are turned: their axes are in cyclic order with the dominant one last, so that no vector is indexed by a
// number that only the triangle knows.

const CONSERVATIVE: u32 = 1u;
const MARGIN: i32 = 1;
const SCALE_BITS: u32 = 14u;
const WEIGHT_BITS: u32 = 14u;

struct VoxelGrid {
    dims: vec3<u32>,
    scale: i32,
    offset: vec3<i32>,
    subvoxel_bits: u32,
}

struct VoxelTriangle {
    // Corners, turned.
    p0: vec3<i32>,
    p1: vec3<i32>,
    p2: vec3<i32>,
    // Turned, and with the sign in which its last component is not negative.
    normal: vec3<i32>,
    // -1 where the projection along an axis runs clockwise, else 1.
    turns: vec3<i32>,
    // The dominant axis before it was turned to the last place.
    axis: u32,
    // First and last voxel of the bounds.
    low: vec3<i32>,
    high: vec3<i32>,
}

// Grid coordinates of a lattice point.
fn place(point: vec3<i32>) -> vec3<i32> {
    let sum = params.items.grid.scale * point + params.items.grid.offset;
    let last = vec3<i32>(params.items.grid.dims << vec3<u32>(params.items.grid.subvoxel_bits)) - vec3<i32>(1);
    return clamp(sum >> vec3<u32>(SCALE_BITS), vec3<i32>(0), last);
}

// To the axes of a triangle whose dominant axis is `axis`.
fn turned(v: vec3<i32>, axis: u32) -> vec3<i32> {
    return select(select(v.xyz, v.zxy, axis == 1u), v.yzx, axis == 0u);
}

// The way back.
fn turned_back(v: vec3<i32>, axis: u32) -> vec3<i32> {
    return select(select(v.xyz, v.yzx, axis == 1u), v.zxy, axis == 0u);
}

fn dominant_axis(normal: vec3<i32>) -> u32 {
    let n = abs(normal);
    let first = select(0u, 1u, n.y > n.x);
    return select(first, 2u, n.z > max(n.x, n.y));
}

// The triangle of three corners in grid coordinates.
fn voxel_triangle(c0: vec3<i32>, c1: vec3<i32>, c2: vec3<i32>) -> VoxelTriangle {
    let a = c1 - c0;
    let b = c2 - c0;
    let cross_product = a.yzx * b.zxy - a.zxy * b.yzx;
    let axis = dominant_axis(cross_product);
    let normal = turned(cross_product, axis);
    let turns = select(vec3<i32>(1), vec3<i32>(-1), normal < vec3<i32>(0));
    let p0 = turned(c0, axis);
    let p1 = turned(c1, axis);
    let p2 = turned(c2, axis);
    let s = vec3<u32>(params.items.grid.subvoxel_bits);
    // A closed cube that ends where the margin begins is met.
    let before = select(0, MARGIN + 1, is_conservative());
    let behind = select(0, MARGIN, is_conservative());
    let last = turned(vec3<i32>(params.items.grid.dims), axis) - vec3<i32>(1);
    let low = max((min(p0, min(p1, p2)) - vec3<i32>(before)) >> s, vec3<i32>(0));
    let high = min((max(p0, max(p1, p2)) + vec3<i32>(behind)) >> s, last);
    return VoxelTriangle(p0, p1, p2, normal * turns.z, turns, axis, low, high);
}

fn is_conservative() -> bool {
    return params.items.separation == CONSERVATIVE;
}

// Whether nothing is met whatever the voxel: a triangle without area that is to be thin.
fn is_empty(triangle: VoxelTriangle) -> bool {
    return !is_conservative() && triangle.normal.z == 0;
}

// Columns of voxels along the dominant axis to look at.
fn cells(triangle: VoxelTriangle) -> u32 {
    let extent = triangle.high.xy - triangle.low.xy + vec2<i32>(1);
    return u32(extent.x * extent.y);
}

// The column of a cell, of which there are `cells`.
fn cell_column(triangle: VoxelTriangle, cell: u32) -> vec2<i32> {
    let width = u32(triangle.high.x - triangle.low.x + 1);
    return triangle.low.xy + vec2<i32>(vec2<u32>(cell % width, cell / width));
}

// The first and the last voxel of a column that may be met, by the plane and by the edges of the dominant projection; the
// first is beyond the last where there is none.
fn column(triangle: VoxelTriangle, cell: vec2<i32>) -> vec2<i32> {
    let none = vec2<i32>(0, -1);
    let point = vec2<i32>(centre(cell.x), centre(cell.y));
    let inside = is_inside(triangle.p0.xy, triangle.p1.xy, triangle.p2.xy, triangle.turns.z, point);
    if is_empty(triangle) || !inside {
        return none;
    }
    if triangle.normal.z == 0 {
        return vec2<i32>(triangle.low.z, triangle.high.z);
    }
    let n = u32(triangle.normal.z);
    let ahead = point - triangle.p0.xy;
    let q = wide_add(wide_mul(triangle.normal.x, ahead.x), wide_mul(triangle.normal.y, ahead.y));
    let s = params.items.grid.subvoxel_bits;
    let height = triangle.p0.z;
    if !is_conservative() {
        let k = (height + i32(wide_div_floor(wide_sub(vec2<u32>(0u), q), n))) >> s;
        return select(none, vec2<i32>(k), k >= triangle.low.z && k <= triangle.high.z);
    }
    let half = 1 << (s - 1u);
    let parts = vec3<u32>(abs(triangle.normal));
    let reach = wide_mul_unsigned(u32(half + MARGIN), parts.x + parts.y + parts.z);
    // Heights of centres, rounded to the inside.
    let top = height + i32(wide_div_floor(wide_sub(reach, q), n));
    let bottom = height - i32(wide_div_floor(wide_add(reach, q), n));
    return vec2<i32>(
        max(triangle.low.z, (bottom + half - 1) >> s),
        min(triangle.high.z, (top - half) >> s),
    );
}

// Whether a turned voxel that `column` gives is met: the edges of the other two projections.
fn meets(triangle: VoxelTriangle, voxel: vec3<i32>) -> bool {
    let c = vec3<i32>(centre(voxel.x), centre(voxel.y), centre(voxel.z));
    return is_inside(triangle.p0.yz, triangle.p1.yz, triangle.p2.yz, triangle.turns.x, c.yz)
        && is_inside(triangle.p0.zx, triangle.p1.zx, triangle.p2.zx, triangle.turns.y, c.zx);
}

// How much each corner counts at a turned voxel's centre: 2^-14 each, 2^14 in all.
fn weights(triangle: VoxelTriangle, voxel: vec3<i32>) -> vec3<u32> {
    let point = vec2<i32>(centre(voxel.x), centre(voxel.y));
    // The edge from corner 0 to 1 is opposite to corner 2.
    let edges = vec3<i32>(
        edge_at(triangle.p1.xy, triangle.p2.xy, point),
        edge_at(triangle.p2.xy, triangle.p0.xy, point),
        edge_at(triangle.p0.xy, triangle.p1.xy, point),
    );
    let areas = vec3<u32>(max(edges * triangle.turns.z, vec3<i32>(0)));
    let zeroes = countLeadingZeros(areas.x + areas.y + areas.z);
    let shifted = areas >> vec3<u32>(15u - min(zeroes, 15u));
    let total = max(shifted.x + shifted.y + shifted.z, 1u);
    let behind = (shifted.yz << vec2<u32>(WEIGHT_BITS)) / total;
    return vec3<u32>((1u << WEIGHT_BITS) - behind.x - behind.y, behind);
}

// Coordinate of a voxel's centre.
fn centre(i: i32) -> i32 {
    let s = params.items.grid.subvoxel_bits;
    return (i << s) + (1 << (s - 1u));
}

// Whether a voxel whose centre is `point` in a projection is met by the triangle's projection, as far as its edges say.
fn is_inside(p0: vec2<i32>, p1: vec2<i32>, p2: vec2<i32>, turn: i32, point: vec2<i32>) -> bool {
    return edge_at(p0, p1, point) * turn + allowance(p1 - p0) >= 0
        && edge_at(p1, p2, point) * turn + allowance(p2 - p1) >= 0
        && edge_at(p2, p0, point) * turn + allowance(p0 - p2) >= 0;
}

// Twice the area of the triangle that a point makes with an edge. Within +-2^30 in the grid; products wrap.
fn edge_at(p: vec2<i32>, q: vec2<i32>, point: vec2<i32>) -> i32 {
    let step = q - p;
    let ahead = point - p;
    return step.x * ahead.y - step.y * ahead.x;
}

// How far outside of an edge a centre may be, times the edge's step.
fn allowance(step: vec2<i32>) -> i32 {
    let half = 1 << (params.items.grid.subvoxel_bits - 1u);
    let d = abs(step);
    return select(half * max(d.x, d.y), (half + MARGIN) * (d.x + d.y), is_conservative());
}
