//! Lists that no mesh has: of any length, with as many equal depths as wanted.

use super::Pair;
use crate::oracle::rasterize_lhb::Lists;
use twinlight_core::kernels::rasterize_lhb::LhbElement;
use twinlight_fixtures::random::Random;

/// How lists come about.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kind {
    /// Most elements of a list.
    pub longest: usize,
    /// How many depths there are to choose from; few make many equal ones.
    pub depths: usize,
    /// Whether numbers left out are there, as with a cap.
    pub capped: bool,
}

/// Elements of triangles below 1000, in order.
pub(super) fn some_list(random: &mut Random, count: usize, depths: usize) -> Vec<LhbElement> {
    let step = (1_usize << 30) / depths.max(1);
    let element = |random: &mut Random| LhbElement {
        surface: random.index(2_000) as u32,
        depth: (step / 2 + step * random.index(depths)) as u32,
    };
    let mut list: Vec<LhbElement> = (0..count).map(|_| element(random)).collect();
    list.sort_by_key(|e| (e.depth, e.triangle()));
    list
}

/// As many lists as that.
pub(super) fn some_lists(random: &mut Random, count: usize, kind: Kind) -> Lists {
    let lists: Vec<Vec<LhbElement>> = (0..count)
        .map(|_| {
            // A third are empty: lists that only one side has, and that neither has.
            let count = if random.index(3) == 0 { 0 } else { random.index(kind.longest + 1) };
            some_list(random, count, kind.depths)
        })
        .collect();
    let left_out = (0..if kind.capped { count } else { 0 }).map(|_| random.index(50) as u32).collect();
    Lists { left_out, ..Lists::of(lists.iter().map(Vec::as_slice)) }
}

/// Two sets of lists of one shape.
pub(super) fn some_pair(random: &mut Random, size: u32, view_count: u32, kind: Kind) -> Pair {
    let count = (view_count * size * size) as usize;
    let [kept, added] = [(); 2].map(|()| some_lists(random, count, kind));
    Pair { size, view_count, kept, added }
}

/// One pixel with two lists.
pub(super) fn one_pixel(kept: &[LhbElement], added: &[LhbElement]) -> Pair {
    Pair { size: 1, view_count: 1, kept: Lists::of([kept]), added: Lists::of([added]) }
}

/// Elements of (surface, depth).
pub(super) fn elements(of: &[(u32, u32)]) -> Vec<LhbElement> {
    of.iter().map(|&(surface, depth)| LhbElement { surface, depth }).collect()
}

/// The same lists as with a cap that left nothing out.
pub(super) fn with_nothing_left_out(lists: &Lists) -> Lists {
    Lists { left_out: vec![0; lists.offsets.len() - 1], ..lists.clone() }
}
