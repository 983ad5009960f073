//! Limits: of windows to the unit, of clearances to the step, of images to the sub-pixel, and of lists.

use super::inputs::{anywhere, from, made_up, some_queries};
use super::{Seen, both_ways};
use crate::kernels::rasterize_lhb::inputs::{front, separate};
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use twinlight_core::Backend;
use twinlight_core::kernels::query_lhb::LhbQuery;
use twinlight_core::lattice::View;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "query_lhb":
        windows_to_the_unit, clearance_to_the_step, own_triangle_and_other_side, offsets_off_every_side,
        every_size_at_the_reach, long_lists, equal_depths,
    );
}

/// A wall across the view at z.
fn wall(z: i16) -> [[i16; 3]; 3] {
    [[-9_000, -18_000, z], [-9_000, 18_000, z], [18_000, 0, z]]
}

/// The same wall turned over.
fn back(z: i16) -> [[i16; 3]; 3] {
    let [a, b, c] = wall(z);
    [a, c, b]
}

fn walls(corners: &[[[i16; 3]; 3]], size: u32) -> Seen {
    Seen::new(separate(corners), vec![front()], size)
}

/// Every limit of a window, in units: at it, before it and beyond it, at walls ahead of the position and behind.
fn windows_to_the_unit<B: Backend>(cx: &Context<'_, B>) -> Check {
    let seen = walls(&[wall(-100), wall(100), back(100), wall(10_000)], 8);
    let mut queries = Vec::new();
    for z in [-101, -100, -99, 0, 99, 100, 101, 20_000] {
        for of in [0_i32, 100 - z, z + 100, 10_000 - z] {
            let limit = of.unsigned_abs() << 14;
            for window in [limit.saturating_sub(1), limit, limit + 1, 0, 1 << 30] {
                for leaves in [4, 5, 6, 7, 12, 13, u32::MAX] {
                    for ray in [0, 1] {
                        queries.push(LhbQuery { leaves, window, ..from([0, 0, z], ray) });
                    }
                }
            }
        }
    }
    both_ways(&seen.agreed(cx, &queries)?)
}

/// Eight steps before a plane are not enough, nine are; along an axis, where a step is 2¹³ units exactly, and along a slant.
fn clearance_to_the_step<B: Backend>(cx: &Context<'_, B>) -> Check {
    let slanted = |by: i16| [[-9_000, -18_000, -by], [-9_000, 18_000, -by], [18_000, 0, 2 * by]];
    for by in [0, 1, 500, 9_000] {
        let there = slanted(by);
        let mesh = [there, [there[0], there[2], there[1]], wall(15_000), back(-15_000)];
        let seen = walls(&mesh, 16);
        let queries: Vec<LhbQuery> = (-40..=40)
            .flat_map(|z| [0, 1].map(|ray| (z, ray)))
            .flat_map(|(z, ray)| [8, 9].map(|leaves| (z, ray, leaves)))
            .flat_map(|(z, ray, leaves)| {
                // The plane is met at the pixel's centre, the position's own point of it is beside.
                [0, 1_000].map(|x| LhbQuery { leaves, window: 20_000 << 14, ..from([x, 0, z + x], ray) })
            })
            .collect();
        both_ways(&seen.agreed(cx, &queries)?)?;
    }
    let seen = walls(&[wall(0), wall(15_000)], 8);
    let steps: Vec<bool> = (-12..=12)
        .map(|z| LhbQuery { leaves: 9, window: 100 << 14, ..from([0, 0, z], 0) })
        .map(|query| seen.agreed(cx, &[query]).map(|hits| hits[0].triangle() == 0))
        .collect::<Result<_, _>>()?;
    let want: Vec<bool> = (-12..=12).map(|z| z < -8).collect();
    ensure(steps == want, || format!("entered from {steps:?}"))
}

/// Within the window a query passes its own triangle and what shows it the other side, and nothing else.
fn own_triangle_and_other_side<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut layers = Vec::new();
    for z in [-300, -200, -100, 100, 200, 300] {
        layers.extend([wall(z), back(z + 5)]);
    }
    let seen = walls(&layers, 8);
    let queries: Vec<LhbQuery> = (0..26)
        .flat_map(|leaves| [0, 1].map(|ray| (leaves, ray)))
        .flat_map(|(leaves, ray)| {
            let windows = [0, 110 << 14, 250 << 14, 1 << 30];
            windows.map(|window| LhbQuery { leaves, window, ..from([0; 3], ray) })
        })
        .collect();
    seen.agrees(cx, &queries)
}

/// Offsets to the last sub-pixel of the image on each side, beyond it, and far beyond, as windows go: the lists of the border.
fn offsets_off_every_side<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 9);
    for size in [1_u32, 2, 3, 8, 20] {
        let seen = made_up(&mut random, 2, size, 3);
        let edge = (32_768 / size.next_power_of_two() * size) as i32;
        let far = [-40_000, -edge, -edge - 1, 0, edge - 1, edge, edge + 1, 40_000, 1 << 30, -(1 << 30)];
        let mut queries = Vec::new();
        for x in far {
            for y in far {
                let position = anywhere(&mut random);
                queries.extend([0, 1, 2, 3].map(|ray| LhbQuery { offset: [x, y], ..from(position, ray) }));
            }
        }
        seen.agrees(cx, &queries)?;
    }
    Ok(())
}

/// Positions as far out as they may be, along rows of the views, where coordinates reach the last pixel.
fn every_size_at_the_reach<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 10);
    let sizes =
        [1_u32, 2, 3, 4, 5, 7, 8, 9, 16, 31, 33, 61, 64, 100, 127, 128, 129, 255, 257, 512, 1_023, 1_024];
    for size in sizes {
        if size > 257 && !cx.full() && size != 1_024 {
            continue;
        }
        let seen = made_up(&mut random, 1, size, 2);
        let rows = |view: &View| [view.right, view.down, view.forward];
        let mut queries = some_queries(&seen, &mut random, 200);
        for row in seen.views.iter().flat_map(rows) {
            let length = row.iter().map(|&c| f64::from(c).powi(2)).sum::<f64>().sqrt();
            for reach in [32_760.0, -32_760.0, 32_000.0] {
                let position = [0, 1, 2].map(|i| (f64::from(row[i]) / length * reach) as i32);
                queries.extend([0, 1].map(|ray| from(position, ray)));
            }
        }
        seen.agrees(cx, &queries).map_err(|f| f.within(&format!("size {size}")))?;
    }
    Ok(())
}

/// Thousands of layers, all of them passed but one.
fn long_lists<B: Backend>(cx: &Context<'_, B>) -> Check {
    for count in [63_i16, 64, 65, 1_000, 5_000] {
        let layers: Vec<_> =
            (0..count).map(|i| if i % 3 == 0 { back(i - 2_500) } else { wall(i - 2_500) }).collect();
        let seen = walls(&layers, 8);
        let mut random = Random::new(cx.options.seed ^ 11);
        let mut queries = some_queries(&seen, &mut random, 100);
        for z in [-2_600, -2_500, -1_000, 0, 2_400, 2_600] {
            for (ray, leaves) in [(0, 20), (1, 20), (0, 21), (1, 21)] {
                let window = 1 << 30;
                queries.push(from([0, 0, z], ray));
                queries.push(LhbQuery { leaves, window, ..from([0, 0, z], ray) });
            }
        }
        both_ways(&seen.agreed(cx, &queries)?)?;
    }
    Ok(())
}

/// Equal depths: away from the viewer the lower number comes first, towards him the higher.
fn equal_depths<B: Backend>(cx: &Context<'_, B>) -> Check {
    let seen = walls(&[wall(50), back(50), wall(50), wall(-50), back(-50), wall(-50)], 8);
    let queries: Vec<LhbQuery> = (0..16)
        .flat_map(|leaves| [0, 1].map(|ray| (leaves, ray)))
        .flat_map(|(leaves, ray)| {
            let windows = [0, (50 << 14) - 1, 50 << 14];
            windows.map(|window| LhbQuery { leaves, window, ..from([0; 3], ray) })
        })
        .collect();
    let hits = seen.agreed(cx, &queries)?;
    let ends = [hits[0].triangle(), hits[3].triangle()];
    ensure(ends == [0, 5], || format!("first of equals, away and back: {ends:?}, want 0 and 5"))
}
