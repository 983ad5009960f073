//! From a ray to a lookup in layered hit buffers, and from what it finds to a hit. Twin:
//! `backend-gpu/src/shared/lhb.wgsl`.
//!
//! *The cone approximation.* The ray goes along ω, the buffer along d, the nearest of its directions. Yu jitters the pixel
//! within a disc as wide as the solid angle that d stands for. Here ω itself says where in that disc: what the first lookup
//! finds at distance t is found again on the line that crosses the ray at t, and the ray is then intersected with the plane
//! of the triangle that this line meets. The radius of the disc at t follows from ω; there is none to choose.

use super::SceneView;
use super::light::{FAR, SHADOW_REACH};
use crate::kernels::query_lhb::{LhbQuery, NO_ELEMENT};
use crate::kernels::rasterize_lhb::LhbElement;
use crate::kernels::walk_lhb::WalkLhbBlock;
use crate::lattice::{DEPTH_ORIGIN, View};
use glam::{IVec3, Vec3};

/// 2⁻¹⁴: a unit of a view's rows, and of a depth in steps.
pub const FINE: f32 = 6.103_515_6e-5;
/// 2¹⁴.
pub const COARSE: f32 = 16_384.0;
/// Steps across the lattice.
pub const ACROSS: f32 = 65_536.0;
/// √½ of a pixel is from its centre to its corner.
pub const HALF_DIAGONAL: f32 = 0.707_106_77;
/// Steps by which rounding may put a line farther aside, where a view's size is a power of two: of the position to the lattice, √3/2; of
/// it on the screen, to units of two steps in two axes, √2; and of the triangle's vertices there, √2. At other sizes units are
/// larger by [`WalkLhbBlock::row_scale`].
pub const ROUNDING: f32 = 4.0;
/// Slope that the window allows for at least: what other surfaces may have.
pub const LEAST_SLOPE: f32 = 4.0;
/// And at most: what keeps a window within the lattice.
pub const GREATEST_SLOPE: f32 = 64.0;

/// Where a ray meets a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LhbHit {
    /// Number of the triangle, or [`NO_ELEMENT`].
    pub slot: u32,
    /// Barycentric weight of the second vertex.
    pub u: f32,
    /// Barycentric weight of the third vertex.
    pub v: f32,
    /// Distance along the ray; [`FAR`] where nothing is met.
    pub t: f32,
    /// Whether the ray itself is known to meet the triangle; else the triangle's point next to the lookup's line stands in.
    pub is_exact: bool,
}

/// Unit direction of a view, or its opposite.
#[inline(always)]
pub fn ray_direction(view: &View, ray: u32) -> Vec3 {
    let [x, y, z, _] = view.forward;
    let forward = Vec3::new(x as f32, y as f32, z as f32) * FINE;
    if ray & 1 == 1 { -forward } else { forward }
}

/// The nearest lattice point.
#[inline(always)]
fn lattice_point(block: &WalkLhbBlock, position: Vec3) -> IVec3 {
    let steps = (position - Vec3::from(block.centre)) * block.steps_per_unit;
    IVec3::new(lattice_coordinate(steps.x), lattice_coordinate(steps.y), lattice_coordinate(steps.z))
}

#[inline(always)]
fn lattice_coordinate(c: f32) -> i32 {
    let low = if c > -32_760.0 { c } else { -32_760.0 };
    let cut = if low < 32_760.0 { low } else { 32_760.0 };
    cut.round_ties_even() as i32
}

/// How near in depth elements are judged by their planes, when lines are `distance` steps from the position that a surface
/// with that cosine to the line is left at: what the slope explains.
#[inline(always)]
fn depth_window(distance: f32, cosine: f32) -> u32 {
    let sine_squared = 1.0 - cosine * cosine;
    let sine = if sine_squared > 0.0 { sine_squared.sqrt() } else { 0.0 };
    // Steep, edge-on and contrary surfaces take the greatest slope.
    let mut slope = GREATEST_SLOPE;
    if sine < cosine * GREATEST_SLOPE {
        slope = sine / cosine;
    }
    if slope < LEAST_SLOPE {
        slope = LEAST_SLOPE;
    }
    let depth = distance * slope;
    (if depth < ACROSS { depth } else { ACROSS } * COARSE) as u32
}

/// The lookup for a ray from `position` on a triangle with the unit `normal` on the ray's side, along the line of `ray`.
#[inline(always)]
pub fn lhb_query(
    block: &WalkLhbBlock,
    view: &View,
    ray: u32,
    position: Vec3,
    normal: Vec3,
    leaves: u32,
) -> LhbQuery {
    let p = lattice_point(block, position);
    let cosine = normal.dot(ray_direction(view, ray));
    LhbQuery {
        position: p.to_array(),
        ray,
        offset: [0, 0],
        leaves,
        window: depth_window(aside_at_most(block), cosine),
    }
}

/// How far a pixel's line may be from a point that is looked up there, steps.
#[inline(always)]
fn aside_at_most(block: &WalkLhbBlock) -> f32 {
    ACROSS * HALF_DIAGONAL / block.size as f32 + ROUNDING * block.row_scale
}

/// z of a lookup's position, as elements count it.
#[inline(always)]
fn query_depth(view: &View, query: &LhbQuery) -> i32 {
    let [x, y, z, _] = view.forward;
    let [a, b, c] = query.position;
    x * a + y * b + z * c + DEPTH_ORIGIN
}

/// Distance to an element along the lookup's line, steps. The lattice's radius where there is none, which is as far as anything
/// that the line misses can be.
#[inline(always)]
fn element_distance(view: &View, query: &LhbQuery, element: LhbElement) -> f32 {
    if element.surface == NO_ELEMENT {
        return ACROSS * 0.5;
    }
    let ahead = element.depth as i32 - query_depth(view, query);
    let steps = ahead as f32 * FINE;
    let forward = if query.ray & 1 == 1 { -steps } else { steps };
    if forward > 0.0 { forward } else { 0.0 }
}

/// The lookup on the line that crosses the ray along `direction` where the first lookup met something, or at the ray's end, `reach` from
/// its start, if that is nearer.
#[inline(always)]
pub fn lhb_refined(
    block: &WalkLhbBlock,
    view: &View,
    query: &LhbQuery,
    normal: Vec3,
    direction: Vec3,
    reach: f32,
    found: LhbElement,
) -> LhbQuery {
    let along = ray_direction(view, query.ray);
    // Coarse sets have directions at right angles to the ray.
    let cosine = direction.dot(along);
    let cosine = if cosine > 0.25 { cosine } else { 0.25 };
    let met = element_distance(view, query, found);
    // Not multiplied where it is no end: WGSL leaves overflow open.
    let end = if reach < FAR { reach * block.steps_per_unit * cosine } else { FAR };
    let aside = direction * (1.0 / cosine) - along;
    let offset = aside * if end < met { end } else { met };
    let distance = aside_at_most(block) + offset.dot(offset).sqrt();
    LhbQuery {
        offset: [screen_offset(view.right, offset), screen_offset(view.down, offset)],
        window: depth_window(distance, normal.dot(along)),
        ..*query
    }
}

#[inline(always)]
fn screen_offset(row: [i32; 4], offset: Vec3) -> i32 {
    let axis = Vec3::new(row[0] as f32, row[1] as f32, row[2] as f32);
    lattice_coordinate(axis.dot(offset) * (FINE * 0.5))
}

/// The point where the centre line of a lookup's pixel meets an element, in the scene's coordinates.
#[inline(always)]
fn element_position(block: &WalkLhbBlock, view: &View, query: &LhbQuery, element: LhbElement) -> Vec3 {
    let bits = block.subpixel_bits;
    let middle = ((block.size << (bits + 14)) + (1 << 14)) as i32;
    let edge = (block.size << bits) as i32 - 1;
    let [a, b, c] = query.position;
    let x = ((view.right[0] * a + view.right[1] * b + view.right[2] * c + middle) >> 15) + query.offset[0];
    let y = ((view.down[0] * a + view.down[1] * b + view.down[2] * c + middle) >> 15) + query.offset[1];
    let column = x.clamp(0, edge) >> bits;
    let row = y.clamp(0, edge) >> bits;
    let pixel = ACROSS / block.size as f32;
    let across = (column as f32 + 0.5) * pixel - ACROSS * 0.5;
    let along = (row as f32 + 0.5) * pixel - ACROSS * 0.5;
    let depth = (element.depth as i32 - DEPTH_ORIGIN) as f32 * FINE;
    // Rows are longer than 1 by the size over its power of two.
    let unit = FINE * block.row_scale;
    let right = Vec3::new(view.right[0] as f32, view.right[1] as f32, view.right[2] as f32) * unit;
    let down = Vec3::new(view.down[0] as f32, view.down[1] as f32, view.down[2] as f32) * unit;
    let forward = Vec3::new(view.forward[0] as f32, view.forward[1] as f32, view.forward[2] as f32) * FINE;
    let steps = (right * across + down * along) + forward * depth;
    Vec3::from(block.centre) + steps * block.unit_per_step
}

/// What the ray from `position` along `direction` meets, by what its lookup found: where it meets the triangle's plane if that is
/// on the triangle and `exact` holds, else the point of the triangle next to where the lookup's line does.
#[inline(always)]
pub fn lhb_hit(
    block: &WalkLhbBlock,
    scene: &SceneView<'_>,
    view: &View,
    query: &LhbQuery,
    position: Vec3,
    direction: Vec3,
    element: LhbElement,
    exact: bool,
) -> LhbHit {
    if element.surface == NO_ELEMENT {
        return LhbHit { slot: NO_ELEMENT, u: 0.0, v: 0.0, t: FAR, is_exact: false };
    }
    let slot = element.surface >> 1;
    let triangle = &scene.triangles[slot as usize];
    let p0 = Vec3::from(triangle.p0);
    let e1 = Vec3::from(triangle.p1) - p0;
    let e2 = Vec3::from(triangle.p2) - p0;
    let normal = cross(e1, e2);
    let squared = normal.dot(normal);
    let inverse = if squared > 0.0 { 1.0 / squared } else { 0.0 };
    if exact {
        let t = normal.dot(p0 - position) / normal.dot(direction);
        // False for a NaN: a ray within the plane.
        if t > 0.0 {
            let w = (position + direction * t) - p0;
            let u = cross(w, e2).dot(normal) * inverse;
            let v = cross(e1, w).dot(normal) * inverse;
            if u >= 0.0 && v >= 0.0 && u + v <= 1.0 {
                return LhbHit { slot, u, v, t, is_exact: true };
            }
        }
    }
    let w = element_position(block, view, query, element) - p0;
    let u = not_negative(cross(w, e2).dot(normal) * inverse);
    let v = not_negative(cross(e1, w).dot(normal) * inverse);
    let sum = u + v;
    let scale = if sum > 1.0 { 1.0 / sum } else { 1.0 };
    let (u, v) = (u * scale, v * scale);
    let offset = (p0 + (e1 * u + e2 * v)) - position;
    LhbHit { slot, u, v, t: not_negative(offset.dot(direction)), is_exact: false }
}

/// How much nearer than a light something may seem that carries it, world units: what a pixel's line sees of a surface with the slope that
/// the window allows for at least.
#[inline(always)]
pub fn shadow_margin(block: &WalkLhbBlock) -> f32 {
    aside_at_most(block) * LEAST_SLOPE * block.unit_per_step
}

/// Whether what the lookup of a shadow ray found is between its start and the light, which is `distance` away; [`FAR`] for infinitely.
#[inline(always)]
pub fn lhb_shadows(block: &WalkLhbBlock, hit: &LhbHit, distance: f32) -> bool {
    if hit.slot == NO_ELEMENT {
        return false;
    }
    let end = if hit.is_exact { distance * SHADOW_REACH } else { distance - shadow_margin(block) };
    // What the ray passes beside may be behind its start.
    hit.t > 0.0 && hit.t < end
}

#[inline(always)]
fn not_negative(x: f32) -> f32 {
    if x > 0.0 { x } else { 0.0 }
}

#[inline(always)]
fn cross(a: Vec3, b: Vec3) -> Vec3 {
    Vec3::new(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::{REACH, subpixel_bits};
    use crate::math::hash::{mix_pair, to_unit};
    use glam::DVec3;

    /// How far from its place on the screen a lattice point is put, steps.
    fn put_off(view: &View, size: u32, point: IVec3) -> f64 {
        let middle = ((size << (subpixel_bits(size) + 14)) + (1 << 14)) as i32;
        let unit = 65_536.0 / f64::from(size << subpixel_bits(size));
        let off = [view.right, view.down].map(|[a, b, c, _]| {
            let exact = a * point.x + b * point.y + c * point.z + middle;
            // To the nearest: half a unit was added before the bits were cut off.
            (f64::from(exact) - 16_384.0) / 32_768.0 - f64::from(exact >> 15)
        });
        unit * (off[0] * off[0] + off[1] * off[1]).sqrt()
    }

    fn random(seed: u32, index: u32) -> DVec3 {
        let [x, y, z] = [0, 1, 2].map(|axis| f64::from(to_unit(mix_pair(seed, 3 * index + axis))));
        (DVec3::new(x, y, z) - 0.5) * 2.0
    }

    /// The three roundings at their worst among many are within [`ROUNDING`], and come near to it: less would not do.
    #[test]
    fn roundings_add_up_to_no_more() {
        for size in [1_u32, 100, 128, 513, 1000, 1024] {
            let scale = f64::from(size.next_power_of_two()) / f64::from(size);
            let (mut snapped, mut drawn) = (0.0_f64, 0.0_f64);
            for index in 0..20_000 {
                let exact = random(size, index) * (0.57 * f64::from(REACH));
                let point = IVec3::new(
                    lattice_coordinate(exact.x as f32),
                    lattice_coordinate(exact.y as f32),
                    lattice_coordinate(exact.z as f32),
                );
                snapped = snapped.max(point.as_dvec3().distance(exact));
                let view = View::along(random(size + 1, index), size).expect("a direction");
                drawn = drawn.max(put_off(&view, size, point));
            }
            let (worst, allowed) = (snapped + 2.0 * drawn, f64::from(ROUNDING) * scale);
            assert!(worst <= allowed, "{worst} steps at size {size}, {allowed} allowed");
            assert!(worst > 0.8 * allowed, "{worst} steps at size {size}, {allowed} allowed");
        }
    }
}
