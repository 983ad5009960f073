//! Hard cases of scene intake as they reach the rasterizer through the lattice.

use super::inputs::{front, lattice_directions, separate, snapped, some_directions, views};
use super::watertight::windings;
use super::{agreed, agrees, drawn, same};
use crate::scenes::{compiled, coplanar_copies, flat, junction, scene_of};
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use glam::DVec3;
use twinlight_core::Backend;
use twinlight_core::kernels::rasterize_lhb::RasterizeLhbParams;
use twinlight_core::lattice::{Lattice, LatticeMesh};
use twinlight_core::scene::{Mesh, Transform};
use twinlight_fixtures::meshes;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "rasterize_lhb":
        g5_no_area_is_nothing, g6_slivers, g7_copies_stay, g8_junction_leaks_its_sliver, g9_nothing_to_draw,
        g10_flat_bounds, g11_shifted_exactly, g12_scaled_by_powers_of_two,
    );
}

/// Equal corners are nothing from anywhere; collinear ones where rounding keeps them so, which it does along the axes.
/// Elsewhere they may be slivers of a sub-pixel, the same ones on every backend.
fn g5_no_area_is_nothing<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (a, b, c) = ([400, -16_000, 72], [-8_000, 12_000, 30], [-3_800, -2_000, 51]);
    let equal = separate(&[[a, a, b], [a, b, b], [b, a, b], [b, b, b]]);
    let from_anywhere = views(&lattice_directions(), 64);
    let params = RasterizeLhbParams::new(64);
    let shown = drawn(cx, &equal, &from_anywhere, &params)?.elements;
    ensure(shown.is_empty(), || format!("{shown:?} of equal corners"))?;
    let collinear = separate(&[[a, c, b], [b, a, c], [[0, 0, 0], [-16_000, 0, 0], [16_000, 0, 0]]]);
    let along_axes = views(&[DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X], 64);
    let shown = drawn(cx, &collinear, &along_axes, &params)?.elements;
    ensure(shown.is_empty(), || format!("{shown:?} of collinear corners"))?;
    let needles = snapped(&meshes::needles(200, 71 ^ cx.options.seed));
    agrees(cx, &needles, &views(&some_directions(4, 73), 64), &params)
}

fn g6_slivers<B: Backend>(cx: &Context<'_, B>) -> Check {
    for aspect in [1e-2, 1e-3, 1e-6] {
        let mesh = snapped(&meshes::slivers(100, aspect, 79));
        agrees(cx, &mesh, &views(&some_directions(2, 83), 100), &RasterizeLhbParams::new(100))?;
    }
    Ok(())
}

/// Copies and coplanar triangles: all in the list, by number.
fn g7_copies_stay<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mesh = snapped(&coplanar_copies());
    let lists = agreed(cx, &mesh, &views(&[DVec3::Z, DVec3::NEG_Z], 32), &RasterizeLhbParams::new(32))?;
    let numbers: Vec<Vec<u32>> = lists.each().map(|l| l.iter().map(|e| e.triangle()).collect()).collect();
    let of_square = numbers.iter().filter(|n| n.len() == 6).collect::<Vec<_>>();
    let copies = |n: &&&Vec<u32>| **n == &[0, 2, 4, 6, 8, 10] || **n == &[1, 3, 5, 7, 9, 10];
    let right = of_square.iter().filter(copies).count();
    ensure(right > 30 && right == of_square.len(), || {
        format!("{right} of {}: {of_square:?}", of_square.len())
    })
}

/// A T-junction leaks what the sliver between its edges covers, and nothing else.
fn g8_junction_leaks_its_sliver<B: Backend>(cx: &Context<'_, B>) -> Check {
    // Triangles (left, right, top), (left, below, middle), (middle, below, right), each with corners of its own.
    let mesh = snapped(&junction());
    let closed = |triangles: &[[u32; 3]]| {
        let all = mesh.triangles().iter().chain(triangles).copied().collect();
        LatticeMesh::new(mesh.vertices().to_vec(), all)
    };
    let (left, right, middle, below) = (0, 1, 5, 4);
    let sealed = closed(&[[left, middle, right]])?;
    let whole = LatticeMesh::new(mesh.vertices().to_vec(), vec![[0, 1, 2], [left, below, right]])?;
    let mut directions = vec![DVec3::NEG_Z];
    directions.extend(some_directions(4, 89));
    let views = views(&directions, 128);
    let params = RasterizeLhbParams::new(128);
    let first = agreed(cx, &mesh, &views, &params)?;
    same(cx, 128, &drawn(cx, &mesh, &views, &params)?, &first)?;
    let [sealed, whole] = [sealed, whole].map(|mesh| drawn(cx, &mesh, &views, &params));
    let (sealed, whole) = (windings(&sealed?), windings(&whole?));
    let leaks = sealed.iter().zip(&whole).filter(|(s, w)| s != w).count();
    ensure(leaks == 0, || format!("{leaks} pixels differ although the junction is sealed"))
}

fn g9_nothing_to_draw<B: Backend>(cx: &Context<'_, B>) -> Check {
    let nothing = LatticeMesh::default();
    let mesh = snapped(&meshes::cube());
    for params in
        [RasterizeLhbParams::new(6), RasterizeLhbParams { layer_cap: 2, ..RasterizeLhbParams::new(6) }]
    {
        agrees(cx, &nothing, &[], &params)?;
        agrees(cx, &nothing, &[front(); 3], &RasterizeLhbParams { size: 8, ..params })?;
        agrees(cx, &mesh, &[], &params)?;
        // Vertices without triangles.
        let unused = LatticeMesh::new(mesh.vertices().to_vec(), vec![])?;
        agrees(cx, &unused, &views(&[DVec3::ONE], 6), &params)?;
    }
    Ok(())
}

fn g10_flat_bounds<B: Backend>(cx: &Context<'_, B>) -> Check {
    for axes in 1..=3 {
        let mesh = snapped(&flat(axes));
        let lists = agreed(cx, &mesh, &views(&lattice_directions(), 32), &RasterizeLhbParams::new(32))?;
        ensure(lists.elements.is_empty() == (axes > 1), || format!("{axes} flat axes: {lists:?}"))?;
    }
    Ok(())
}

/// A scene on its own lattice, by way of the compiler.
fn moved(mesh: &Mesh, transform: Transform) -> Result<LatticeMesh, crate::Failure> {
    let mut scene = scene_of(mesh.clone());
    for instance in &mut scene.instances {
        instance.transform = transform;
    }
    let compiled = compiled(&scene);
    Ok(LatticeMesh::of_scene(&Lattice::of_scene(&compiled)?, &compiled)?)
}

fn same_lists<B: Backend>(cx: &Context<'_, B>, mesh: &Mesh, transform: Transform) -> Check {
    let views = views(&some_directions(2, 97), 40);
    let params = RasterizeLhbParams::new(40);
    let here = agreed(cx, &moved(mesh, Transform::IDENTITY)?, &views, &params)?;
    same(cx, 40, &drawn(cx, &moved(mesh, transform)?, &views, &params)?, &here)
}

/// 2²⁰ from the origin by an exact shift.
fn g11_shifted_exactly<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mesh = meshes::snapped(meshes::soup(200, 0.3, 101), 1.0 / 1_048_576.0);
    let far = DVec3::new(1_048_576.0, -2_097_152.0, 4_194_304.0);
    same_lists(cx, &mesh, Transform::scale_translate(1.0, far))
}

fn g12_scaled_by_powers_of_two<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mesh = meshes::soup(200, 0.3, 103);
    for factor in [1_048_576.0, 1.0 / 1_024.0] {
        same_lists(cx, &mesh, Transform::scale_translate(factor, DVec3::ZERO))?;
    }
    Ok(())
}
