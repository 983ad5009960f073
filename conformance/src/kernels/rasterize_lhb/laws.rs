//! Laws of `rasterize_lhb`: relations between lists that hold without knowing any.

use super::inputs::{Case, any_mesh, case, mixed_sizes, snapped, some_directions, views};
use super::{Checked, PATHS, drawn, same};
use crate::kernels::property::hold;
use crate::oracle::rasterize_lhb::{Lists, Shown};
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use twinlight_core::Backend;
use twinlight_core::kernels::rasterize_lhb::{LhbElement, RasterizeLhbParams};
use twinlight_core::lattice::{LatticeMesh, View};
use twinlight_fixtures::meshes;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "rasterize_lhb":
        every_path_gives_the_same_bits, views_are_independent, triangle_order_is_free, corner_order_is_free,
        duplicates_stay, meshes_add_up, depths_are_on_their_planes, opposite_views_are_mirrored, repeated,
    );
}

fn every_path_gives_the_same_bits<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, case(any_mesh()), |Case { mesh, views, params }| {
        let auto = drawn(cx, &mesh, &views, &params)?;
        for path in PATHS.into_iter().filter(|&path| path != params.path) {
            let params = RasterizeLhbParams { path, ..params };
            let place = |f: Failure| f.within(&format!("path {path}"));
            same(cx, params.size, &drawn(cx, &mesh, &views, &params)?, &auto).map_err(place)?;
        }
        Ok(())
    })
}

/// Views drawn one by one are the views drawn at once.
fn views_are_independent<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mesh = snapped(&meshes::soup(150, 0.3, 3 ^ cx.options.seed));
    for (size, count) in [(16, 5), (33, 3)] {
        let views = views(&some_directions(count, 7), size);
        let params = RasterizeLhbParams { layer_cap: 9, ..RasterizeLhbParams::new(size) };
        let at_once = drawn(cx, &mesh, &views, &params)?;
        let one_by_one: Vec<Lists> = views
            .iter()
            .map(|view| drawn(cx, &mesh, std::slice::from_ref(view), &params))
            .collect::<Checked<_>>()?;
        let joined = Lists {
            left_out: one_by_one.iter().flat_map(|l| l.left_out.iter().copied()).collect(),
            ..Lists::of(one_by_one.iter().flat_map(Lists::each))
        };
        same(cx, size, &joined, &at_once)?;
    }
    Ok(())
}

/// Lists whose surfaces are renamed and sorted anew.
fn renamed(lists: &Lists, rename: impl Fn(LhbElement) -> LhbElement) -> Lists {
    let sorted = |list: &[LhbElement]| {
        let mut list: Vec<LhbElement> = list.iter().map(|&e| rename(e)).collect();
        list.sort_by_key(|e| (e.depth, e.triangle()));
        list
    };
    let lists: Vec<Vec<LhbElement>> = lists.each().map(sorted).collect();
    Lists::of(lists.iter().map(Vec::as_slice))
}

/// A permutation of the triangles renames them and changes nothing else.
fn triangle_order_is_free<B: Backend>(cx: &Context<'_, B>) -> Check {
    let seed = cx.options.seed;
    hold(cx, case(any_mesh()), |Case { mesh, views, params }| {
        let mut random = Random::new(seed ^ mesh.triangles().len() as u64);
        let mut order: Vec<usize> = (0..mesh.triangles().len()).collect();
        for i in (1..order.len()).rev() {
            order.swap(i, random.index(i + 1));
        }
        let moved = order.iter().map(|&i| mesh.triangles()[i]).collect();
        let moved = LatticeMesh::new(mesh.vertices().to_vec(), moved)?;
        let got = drawn(cx, &moved, &views, &params)?;
        let old = |e: LhbElement| LhbElement {
            surface: 2 * order[e.triangle() as usize] as u32 + (e.surface & 1),
            ..e
        };
        same(cx, params.size, &renamed(&got, old), &drawn(cx, &mesh, &views, &params)?)
    })
}

/// The corner a triangle begins with changes nothing: its edges and plane are the same. Turned over, it shows its other
/// side.
fn corner_order_is_free<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, case(any_mesh()), |Case { mesh, views, params }| {
        let want = drawn(cx, &mesh, &views, &params)?;
        let with = |corners: [usize; 3]| {
            let triangles = mesh.triangles().iter().map(|t| corners.map(|c| t[c])).collect();
            LatticeMesh::new(mesh.vertices().to_vec(), triangles)
        };
        for corners in [[1, 2, 0], [2, 0, 1]] {
            same(cx, params.size, &drawn(cx, &with(corners)?, &views, &params)?, &want)?;
        }
        let over = |e: LhbElement| LhbElement { surface: e.surface ^ 1, ..e };
        same(cx, params.size, &drawn(cx, &with([0, 2, 1])?, &views, &params)?, &renamed(&want, over))
    })
}

/// A mesh joined with itself: everything twice, the first copy first.
fn duplicates_stay<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, case(any_mesh()), |Case { mesh, views, params }| {
        let count = mesh.triangles().len() as u32;
        let once = drawn(cx, &mesh, &views, &params)?;
        let second = |e: &LhbElement| LhbElement { surface: e.surface + 2 * count, ..*e };
        let doubled = |list: &[LhbElement]| list.iter().flat_map(|e| [*e, second(e)]).collect::<Vec<_>>();
        let doubled: Vec<Vec<LhbElement>> = once.each().map(doubled).collect();
        let want = renamed(&Lists::of(doubled.iter().map(Vec::as_slice)), |e| e);
        same(cx, params.size, &drawn(cx, &mesh.followed_by(&mesh)?, &views, &params)?, &want)
    })
}

/// The lists of two meshes together are their lists merged.
fn meshes_add_up<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (a, b) = (snapped(&meshes::icosphere(5)), snapped(&meshes::soup(300, 0.2, cx.options.seed ^ 5)));
    let count = a.triangles().len() as u32;
    let size = 40;
    let views = views(&some_directions(2, 11), size);
    let params = RasterizeLhbParams::new(size);
    let [of_a, of_b] = [drawn(cx, &a, &views, &params)?, drawn(cx, &b, &views, &params)?];
    let later = |e: &LhbElement| LhbElement { surface: e.surface + 2 * count, ..*e };
    let merged = |(a, b): (&[LhbElement], &[LhbElement])| {
        a.iter().copied().chain(b.iter().map(later)).collect::<Vec<_>>()
    };
    ensure(of_a.offsets.len() == of_b.offsets.len(), || "lists of unequal number".into())?;
    let merged: Vec<Vec<LhbElement>> = of_a.each().zip(of_b.each()).map(merged).collect();
    let want = renamed(&Lists::of(merged.iter().map(Vec::as_slice)), |e| e);
    same(cx, size, &drawn(cx, &a.followed_by(&b)?, &views, &params)?, &want)
}

/// Every depth against the exact plane of its triangle, without the contract's formula, within the contract's bounds.
fn depths_are_on_their_planes<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, case(mixed_sizes()), |Case { mesh, views, params }| {
        let size = params.size as usize;
        let lists = drawn(cx, &mesh, &views, &params)?;
        for (i, list) in lists.each().enumerate() {
            let (column, row, view) = (i % size, i / size % size, &views[i / size / size]);
            for e in list {
                let triangle = e.triangle() as usize;
                let on_plane = triangle < mesh.triangles().len()
                    && Shown::new(&mesh, triangle, view, params.size).is_some_and(|shown| {
                        shown.covers(column, row) && shown.is_near_plane(column, row, e.depth)
                    });
                ensure(on_plane, || format!("column {column}, row {row} of {view:?}: {e:?}"))?;
            }
        }
        Ok(())
    })
}

/// The opposite view, columns from the right: the same surfaces from behind, and the same depths from the other end but
/// for both ends' roundings. Nothing is promised for centres on edges, which change owners, nor where a screen coordinate
/// is half-way between two, which both views round up: such pixels and triangles are left aside.
fn opposite_views_are_mirrored<B: Backend>(cx: &Context<'_, B>) -> Check {
    let size = 64;
    let n = size as usize;
    let mesh = snapped(&meshes::soup(60, 0.4, 13 ^ cx.options.seed));
    for direction in some_directions(2, 17) {
        let pair = views(&[direction, -direction], size);
        let lists = drawn(cx, &mesh, &pair, &RasterizeLhbParams::new(size))?;
        let lists: Vec<&[LhbElement]> = lists.each().collect();
        let mut compared = 0;
        for (i, list) in lists[..n * n].iter().enumerate() {
            let (column, row) = (i % n, i / n);
            let other = n - 1 - column;
            let back = lists[n * n + row * n + other];
            let sure =
                |e: &&LhbElement| is_mirrored(&mesh, &pair, e.triangle() as usize, (column, row), size);
            let mut here: Vec<&LhbElement> = list.iter().filter(sure).collect();
            let mut there: Vec<&LhbElement> = back.iter().filter(sure).collect();
            here.sort_by_key(|e| e.triangle());
            there.sort_by_key(|e| e.triangle());
            let alike = |(a, b): (&&LhbElement, &&LhbElement)| {
                // Half a unit of each anchor, and of two gradients over at most size − 1 pixels, from either side.
                let error = i64::from(a.depth) + i64::from(b.depth) - (1 << 30);
                a.surface ^ b.surface == 1 && error.abs() <= 2 * (i64::from(size) - 1) + 1
            };
            let all_alike = here.len() == there.len() && here.iter().zip(&there).all(alike);
            ensure(all_alike, || format!("column {column}, row {row}: {here:?}, from behind {there:?}"))?;
            compared += here.len();
        }
        ensure(compared > 1_000, || format!("only {compared} elements compared"))?;
    }
    Ok(())
}

/// Whether a triangle's corners are each other's mirror images in a pair of opposite views, and a pixel's centre is on none
/// of its edges.
fn is_mirrored(mesh: &LatticeMesh, pair: &[View], triangle: usize, pixel: (usize, usize), size: u32) -> bool {
    let [Some(a), Some(b)] = [0, 1].map(|v| Shown::new(mesh, triangle, &pair[v], size)) else { return false };
    let width = 2 * crate::oracle::rasterize_lhb::on_screen(&pair[0], size, [0; 3])[0];
    // One of the two is a front, so corners 1 and 2 of one have changed places.
    let (ours, [p, q, r]) = (a.corners(), b.corners());
    let mirrored = [p, r, q].iter().zip(ours).all(|(b, a)| b[0] == width - a[0] && b[1] == a[1]);
    mirrored && a.edges(pixel.0, pixel.1).iter().all(|[_, _, e]| *e != 0)
}

fn repeated<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mesh = snapped(&meshes::soup(500, 0.3, 19 ^ cx.options.seed));
    let views = views(&some_directions(3, 23), 50);
    let params = RasterizeLhbParams::new(50);
    let first = drawn(cx, &mesh, &views, &params)?;
    for _ in 0..3 {
        same(cx, 50, &drawn(cx, &mesh, &views, &params)?, &first)?;
    }
    Ok(())
}
