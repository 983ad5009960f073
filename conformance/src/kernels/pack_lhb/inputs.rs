//! Lists of elements at the ends of bins and in their midst, of triangles of few and of all bits.

use super::Views;
use crate::oracle::rasterize_lhb::Lists;
use twinlight_core::kernels::pack_lhb::MAX_TRIANGLES;
use twinlight_core::kernels::rasterize_lhb::LhbElement;
use twinlight_fixtures::random::Random;

/// The first and the last depth of a bin, one anywhere, or one of few, so that bins have many.
fn some_depth(random: &mut Random) -> u32 {
    let begin = random.index(2048) as u32 * (1 << 19);
    [begin, begin + (1 << 19) - 1, random.index(1 << 30) as u32, (7 << 19) + random.index(99) as u32]
        [random.index(4)]
}

fn some_element(random: &mut Random) -> LhbElement {
    let most = if random.index(2) == 0 { 1_000 } else { MAX_TRIANGLES as usize };
    let surface = 2 * random.index(most) as u32 + random.index(2) as u32;
    LhbElement { surface, depth: some_depth(random) }
}

/// Elements in order.
pub(super) fn some_list(random: &mut Random, count: usize) -> Vec<LhbElement> {
    let mut list: Vec<LhbElement> = (0..count).map(|_| some_element(random)).collect();
    list.sort_by_key(|e| (e.depth, e.triangle()));
    list
}

/// Views with lists of up to `longest` elements, a third of them empty.
pub(super) fn some_views(random: &mut Random, size: u32, view_count: u32, longest: usize) -> Views {
    let lists: Vec<Vec<LhbElement>> = (0..view_count * size * size)
        .map(|_| {
            let count = if random.index(3) == 0 { 0 } else { random.index(longest + 1) };
            some_list(random, count)
        })
        .collect();
    Views { size, view_count, lists: Lists::of(lists.iter().map(Vec::as_slice)) }
}

/// The same, of which something was left out before: little, and so much that a sum wraps.
pub(super) fn capped(random: &mut Random, views: Views) -> Views {
    let mut number =
        || [random.index(9) as u32, random.next_u32(), u32::MAX - random.index(3) as u32][random.index(3)];
    let left_out = (1..views.lists.offsets.len()).map(|_| number()).collect();
    Views { lists: Lists { left_out, ..views.lists }, ..views }
}

/// Elements of (surface, depth) in one pixel.
pub(super) fn pixel(of: &[(u32, u32)]) -> Views {
    let elements: Vec<_> = of.iter().map(|&(surface, depth)| LhbElement { surface, depth }).collect();
    Views::one_pixel(Lists::of([elements.as_slice()]))
}
