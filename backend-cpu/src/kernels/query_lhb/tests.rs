//! Every instruction set gives the same answers, in whatever company a query is.

use super::*;
use bytemuck::Zeroable;
use glam::DVec3;
use twinlight_core::lattice::subpixel_bits;
use twinlight_fixtures::random::Random;

const SIZE: u32 = 16;
const TRIANGLES: usize = 40;
const VIEWS: usize = 3;

/// Lists of up to nine elements, and the planes of their triangles.
struct Made {
    views: Vec<View>,
    offsets: Vec<u32>,
    elements: Vec<LhbElement>,
    planes: Vec<LatticePlane>,
}

fn made(random: &mut Random) -> Made {
    let along = |i: usize| View::along(DVec3::new(i as f64, 2.0, -1.0), SIZE).expect("a view");
    let (mut offsets, mut elements) = (vec![0], Vec::new());
    for _ in 0..VIEWS as u32 * SIZE * SIZE {
        let mut list: Vec<LhbElement> = (0..random.index(10))
            .map(|_| LhbElement {
                surface: random.index(2 * TRIANGLES) as u32,
                depth: (1 << 29) + random.index(1 << 26) as u32 - (1 << 25),
            })
            .collect();
        list.sort_by_key(|e| (e.depth, e.surface >> 1));
        elements.extend(list);
        offsets.push(elements.len() as u32);
    }
    let plane = |random: &mut Random| LatticePlane {
        normal: [0; 3].map(|_: i16| random.index(8_000) as i16 - 4_000),
        offset: random.index(1 << 24) as i32 - (1 << 23),
        ..LatticePlane::zeroed()
    };
    let planes = (0..TRIANGLES).map(|_| plane(random)).collect();
    Made { views: (0..VIEWS).map(along).collect(), offsets, elements, planes }
}

/// Queries of which as many as `run` in a row look along one view; some along a view that there isn't.
fn asked(random: &mut Random, run: usize, count: usize) -> Vec<LhbQuery> {
    let mut ray = 0;
    let mut query = |i: usize| {
        if i.is_multiple_of(run) {
            ray = random.index(2 * VIEWS + 1) as u32;
        }
        LhbQuery {
            position: [0; 3].map(|_: i32| random.index(8_000) as i32 - 4_000),
            ray,
            offset: [0; 2].map(|_: i32| random.index(1 << 14) as i32 - (1 << 13)),
            leaves: random.index(2 * TRIANGLES) as u32,
            window: random.index(1 << 25) as u32,
        }
    };
    (0..count).map(&mut query).collect()
}

#[test]
fn every_instruction_set_gives_the_same_answers() {
    let mut random = Random::new(5);
    let made = made(&mut random);
    let lhb = LhbData {
        size: SIZE,
        bits: subpixel_bits(SIZE),
        views: &made.views,
        offsets: &made.offsets,
        elements: &made.elements,
        planes: &made.planes,
    };
    for (run, count) in [(1, 700), (8, 703), (13, 9_000), (200, 5), (9_000, 9_000)] {
        let queries = asked(&mut random, run, count);
        let one_by_one: Vec<LhbElement> = queries
            .iter()
            .map(|query| {
                let mut hit = [NOTHING];
                query_lhb(Isa::Portable, lhb, std::slice::from_ref(query), &mut hit);
                hit[0]
            })
            .collect();
        let met = one_by_one.iter().filter(|hit| **hit != NOTHING).count();
        assert!(count < 100 || (met * 5 > count && met < count), "{met} of {count} meet something");
        for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
            let mut hits = vec![LhbElement { surface: 7, depth: 7 }; count];
            query_lhb(isa, lhb, &queries, &mut hits);
            assert_eq!(hits, one_by_one, "{isa:?}, runs of {run}");
        }
    }
}
