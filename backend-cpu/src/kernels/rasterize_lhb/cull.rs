//! Which triangles have a pixel's centre within their bounds.

use super::project::Screen;
use crate::mesh::CpuMesh;

/// Triangles per round: their corners fill one vector of 8 words each.
const GROUP: usize = 8;

/// Lists the triangles whose bounds hold a centre, in order.
#[inline(always)]
pub(super) fn cull(mesh: &CpuMesh, screen: &Screen, survivors: &mut Vec<u32>) {
    let half = 1_u16 << (screen.bits - 1);
    let whole = !((1_u32 << screen.bits) - 1) as u16;
    survivors.resize(mesh.triangles.len() + GROUP, 0);
    let mut count = 0;
    let mut groups = mesh.triangles.chunks_exact(GROUP);
    let mut first = 0;
    for group in &mut groups {
        let mut corners = [[0_u32; GROUP]; 3];
        for (i, triangle) in group.iter().enumerate() {
            for corner in 0..3 {
                corners[corner][i] = screen.points[triangle[corner] as usize];
            }
        }
        let keep = hold_a_centre(bytemuck::cast(corners), half, whole);
        for i in 0..GROUP {
            survivors[count] = first + i as u32;
            count += usize::from(keep[2 * i] & keep[2 * i + 1]);
        }
        first += GROUP as u32;
    }
    for triangle in groups.remainder() {
        let mut corners = [[0_u32; GROUP]; 3];
        for corner in 0..3 {
            corners[corner][0] = screen.points[triangle[corner] as usize];
        }
        let keep = hold_a_centre(bytemuck::cast(corners), half, whole);
        survivors[count] = first;
        count += usize::from(keep[0] & keep[1]);
        first += 1;
    }
    survivors.truncate(count);
}

/// 1 where a multiple of a pixel plus a half lies between the least and the greatest of three coordinates. Rounding
/// min − ½ up and max − ½ down to whole pixels, less a pixel, gives the same order as rounding min + ½ − 2⁻ˢ and max + ½ down,
/// which stays positive and within 16 bits.
#[inline(always)]
fn hold_a_centre([a, b, c]: [[u16; 2 * GROUP]; 3], half: u16, whole: u16) -> [u16; 2 * GROUP] {
    let mut keep = [0; 2 * GROUP];
    for i in 0..2 * GROUP {
        let least = smaller(smaller(a[i], b[i]), c[i]);
        let greatest = larger(larger(a[i], b[i]), c[i]);
        keep[i] = u16::from(((least + (half - 1)) & whole) < ((greatest + half) & whole));
    }
    keep
}

#[inline(always)]
fn smaller(a: u16, b: u16) -> u16 {
    if a < b { a } else { b }
}

#[inline(always)]
fn larger(a: u16, b: u16) -> u16 {
    if a > b { a } else { b }
}
