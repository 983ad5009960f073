//! Hard cases of shared edges and closed meshes. What is counted is winding: the faces of a pixel's list, fronts less backs,
//! depend on nothing but the mesh's border, whatever rounding does to the vertices.

use super::inputs::{
    Case, any_mesh, case, front, lattice_directions, separate, snapped, some_directions, turned, views,
};
use super::{Checked, agrees, agrees_on_every_path, drawn, same};
use crate::kernels::property::hold;
use crate::oracle::rasterize_lhb::{Lists, Shown};
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use glam::{DVec3, Vec3};
use twinlight_core::Backend;
use twinlight_core::kernels::rasterize_lhb::{LhbElement, RasterizeLhbParams};
use twinlight_core::lattice::{Lattice, LatticeMesh, View};
use twinlight_core::scene::Mesh;
use twinlight_fixtures::meshes;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "rasterize_lhb":
        r1_shared_edge_has_one_owner, r1_border_decides_alone, r2_fan_around_a_centre, r2_spokes_through_centres,
        r13_closed_meshes, r13_any_border_closed, r13_in_and_out_in_turn, r14_facing_is_exact,
    );
}

/// Fronts less backs, per pixel.
pub(super) fn windings(lists: &Lists) -> Vec<i64> {
    let sign = |e: &LhbElement| if e.is_front() { 1 } else { -1 };
    lists.each().map(|list| list.iter().map(sign).sum()).collect()
}

/// A rectangle in random triangulations whose vertices are on pixel centres and corners and half-way between: every pixel
/// of the half-open rectangle once, and no other.
fn r1_shared_edge_has_one_owner<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 53);
    // At size 32 column i's centre is at (2i − 31)·1024: the rectangle goes from column 8 to 24, from row 8 to 22, in cells
    // of two pixels.
    let (cell, origin) = (4_096, -15_360);
    let (columns, rows) = (8_u32, 7_u32);
    for _ in 0..if cx.full() { 30 } else { 6 } {
        let mut vertices = Vec::new();
        for (r, c) in (0..=rows).flat_map(|r| (0..=columns).map(move |c| (r, c))) {
            let inner = c > 0 && c < columns && r > 0 && r < rows;
            let mut moved = |i: u32| {
                let by = if inner { 1_024 * (random.index(3) as i32 - 1) } else { 0 };
                (origin + cell * i as i32 + by) as i16
            };
            vertices.push([moved(c), moved(r), 0]);
        }
        let mut triangles = Vec::new();
        for (r, c) in (0..rows).flat_map(|r| (0..columns).map(move |c| (r, c))) {
            let a = r * (columns + 1) + c;
            let (b, below) = (a + 1, a + columns + 1);
            let cuts = [[[a, below, b], [b, below, below + 1]], [[a, below, below + 1], [a, below + 1, b]]];
            triangles.extend(cuts[random.index(2)]);
        }
        let mesh = LatticeMesh::new(vertices, triangles)?;
        agrees_on_every_path(cx, &mesh, &[front()], 32)?;
        let lists = drawn(cx, &mesh, &[front()], &RasterizeLhbParams::new(32))?;
        for (i, list) in lists.each().enumerate() {
            let (column, row) = (i % 32, i / 32);
            let inside = (8..24).contains(&column) && (8..22).contains(&row);
            let owners = list.len();
            ensure(owners == usize::from(inside), || format!("column {column}, row {row}: {owners} owners"))?;
        }
    }
    Ok(())
}

/// Whatever stands inside a border of four corners, from anywhere: the winding of two triangles.
fn r1_border_decides_alone<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 59);
    let mut vertices =
        vec![[-16_000, -12_000, 500], [15_000, -14_000, -900], [-13_000, 14_000, 0], [9_000, 9_000, 77]];
    let halves = vec![[0, 2, 1], [1, 2, 3]];
    let border = LatticeMesh::new(vertices.clone(), halves.clone())?;
    let mut triangles: Vec<[u32; 3]> = halves;
    for _ in 0..60 {
        let new = vertices.len() as u32;
        vertices.push(std::array::from_fn(|_| 1_024 * (random.index(25) as i16 - 12)));
        let split = random.index(triangles.len());
        let [a, b, c] = triangles.swap_remove(split);
        triangles.extend([[a, b, new], [b, c, new], [c, a, new]]);
    }
    let mesh = LatticeMesh::new(vertices, triangles)?;
    let mut directions = lattice_directions();
    directions.extend(some_directions(4, 61));
    for size in [16, 33] {
        let views = views(&directions, size);
        let of = |mesh| drawn(cx, mesh, &views, &RasterizeLhbParams::new(size)).map(|l| windings(&l));
        let (got, want) = (of(&mesh)?, of(&border)?);
        let apart = got.iter().zip(&want).filter(|(a, b)| a != b).count();
        ensure(apart == 0, || format!("{apart} pixels of views of {size} have no owner, or two"))?;
    }
    Ok(())
}

/// Fans of any number of triangles, turned any way, around the lattice's centre, which in views of odd size is the middle
/// pixel's centre from everywhere.
fn r2_fan_around_a_centre<B: Backend>(cx: &Context<'_, B>) -> Check {
    let unit = Lattice::new(DVec3::ZERO, 1.0)?;
    let mut directions = lattice_directions();
    directions.extend(some_directions(3, 67));
    let mut seen = 0;
    for n in 3..if cx.full() { 40 } else { 15 } {
        let fan = turned(meshes::fan(n), u64::from(n) ^ cx.options.seed);
        let corners =
            fan.triangles.iter().map(|t| t.map(|v| Vec3::from(fan.positions[v as usize]).as_dvec3()));
        let mesh = LatticeMesh::snap(&unit, corners)?;
        for size in [1, 5, 33] {
            let views = views(&directions, size);
            let lists = drawn(cx, &mesh, &views, &RasterizeLhbParams::new(size))?;
            let middles = lists.each().skip((size * size / 2) as usize).step_by((size * size) as usize);
            for (view, list) in views.iter().zip(middles) {
                // Seen edge-on, a fan may be folded by rounding.
                let facing = |t| Shown::new(&mesh, t, view, size).map(|s| s.is_front());
                if facing(0).is_none() || (1..n as usize).any(|t| facing(t) != facing(0)) {
                    continue;
                }
                ensure(list.len() == 1, || format!("{n} triangles, {view:?} of {size}: {list:?}"))?;
                seen += 1;
            }
        }
    }
    ensure(seen > 900, || format!("only {seen} views of open fans"))
}

/// Spokes that run along rows, columns and diagonals through other centres, and between.
fn r2_spokes_through_centres<B: Backend>(cx: &Context<'_, B>) -> Check {
    // At size 32: column 16, row 14.
    let middle = [1_024_i16, -3_072];
    let around = [(4, 0), (4, 1), (4, 4), (1, 4), (0, 4), (-1, 4), (-4, 4), (-4, 1)];
    let around = around.into_iter().chain(around.map(|(x, y)| (-x, -y)));
    let views = [front(), View { right: front().down, down: front().right, ..front() }];
    for every in [1, 2, 3, 4, 5] {
        let ring = around.clone().step_by(every);
        let ring = ring.map(|(x, y)| [middle[0] + 2_048 * x, middle[1] + 2_048 * y, 0]);
        let vertices: Vec<[i16; 3]> = [[middle[0], middle[1], 0]].into_iter().chain(ring).collect();
        let n = vertices.len() as u32 - 1;
        let mesh = LatticeMesh::new(vertices, (0..n).map(|i| [0, 1 + i, 1 + (i + 1) % n]).collect())?;
        agrees_on_every_path(cx, &mesh, &views, 32)?;
        let lists = drawn(cx, &mesh, &views, &RasterizeLhbParams::new(32))?;
        let most = lists.each().map(<[LhbElement]>::len).max();
        let centres: Vec<usize> = lists.each().map(<[LhbElement]>::len).collect();
        let centres = [centres[14 * 32 + 16], centres[1024 + 16 * 32 + 14]];
        ensure((centres, most) == ([1, 1], Some(1)), || {
            format!("{n} spokes: {centres:?} owners of the centre, {most:?} of another")
        })?;
    }
    Ok(())
}

fn closed(seed: u64) -> Vec<(&'static str, Mesh)> {
    let displaced = |seed| meshes::displaced_sphere(7, DVec3::new(0.1, 0.2, -0.3), 0.8, 0.3, seed);
    vec![
        ("cube", meshes::cube()),
        ("turned cube", turned(meshes::cube(), 3)),
        ("icosphere", meshes::icosphere(4)),
        ("torus", turned(meshes::torus(12, 7, 0.4), 5)),
        ("displaced sphere", displaced(seed)),
        ("another", displaced(seed + 1)),
        ("shells", meshes::shells(3, 2)),
    ]
}

fn each_list(lists: &Lists, size: u32, holds: impl Fn(&[LhbElement]) -> bool) -> Check {
    let n = size as usize;
    for (i, list) in lists.each().enumerate() {
        ensure(holds(list), || {
            format!("size {size}, view {}, column {}, row {}: {list:?}", i / n / n, i % n, i / n % n)
        })?;
    }
    Ok(())
}

/// Closed meshes, from anywhere: an even number of faces on every line, half of them fronts.
fn r13_closed_meshes<B: Backend>(cx: &Context<'_, B>) -> Check {
    let even = |list: &[LhbElement]| 2 * list.iter().filter(|e| e.is_front()).count() == list.len();
    for (name, mesh) in closed(cx.options.seed) {
        let mesh = snapped(&mesh);
        for size in [1, 8, 31, 64] {
            let mut directions = vec![DVec3::X, DVec3::NEG_Z, DVec3::new(1.0, -1.0, 0.0), DVec3::ONE];
            directions.extend(some_directions(if cx.full() { 12 } else { 2 }, 71 ^ u64::from(size)));
            let lists = drawn(cx, &mesh, &views(&directions, size), &RasterizeLhbParams::new(size))?;
            each_list(&lists, size, even).map_err(|f| f.within(name))?;
            let covered = lists.each().filter(|list| !list.is_empty()).count();
            ensure(size < 8 || covered > 20, || format!("{name}: only {covered} pixels of size {size}"))?;
        }
    }
    Ok(())
}

/// Whatever a mesh is, through itself, twice the same, with any number of triangles at an edge: once fans close its border, the
/// winding of every line is 0.
fn r13_any_border_closed<B: Backend>(cx: &Context<'_, B>) -> Check {
    // Of one lattice step, so that corners at one place become one vertex and stay where they are.
    let same_place = Lattice::new(DVec3::ZERO, 32_759.0)?;
    hold(cx, case(any_mesh()), |Case { mesh, views, params }| {
        let corner = |v: u32| DVec3::from(mesh.vertices()[v as usize].map(f64::from));
        let welded = LatticeMesh::snap(&same_place, mesh.triangles().iter().map(|t| t.map(corner)))?;
        let fans = meshes::fans_over_border(welded.triangles());
        let all = welded.triangles().iter().chain(&fans).copied().collect();
        let closed = LatticeMesh::new(welded.vertices().to_vec(), all)?;
        let lists = drawn(cx, &closed, &views, &params)?;
        let wound = windings(&lists).iter().filter(|winding| **winding != 0).count();
        ensure(wound == 0, || format!("{wound} lines with a winding, {} fans", fans.len()))
    })
}

/// Into a solid and out of it, in turn, wherever neighbours in a list are farther apart than both depths' roundings. Along the
/// axes even coordinates fall on sub-pixels, so that the solid on the screen is the solid on the lattice; from elsewhere
/// rounding may fold it.
fn r13_in_and_out_in_turn<B: Backend>(cx: &Context<'_, B>) -> Check {
    for (name, mesh) in closed(cx.options.seed) {
        let mesh = snapped(&mesh);
        let even = mesh.vertices().iter().map(|p| p.map(|c| c / 2 * 2)).collect();
        let mesh = LatticeMesh::new(even, mesh.triangles().to_vec())?;
        for size in [8, 64] {
            let axes = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z];
            let lists = drawn(cx, &mesh, &views(&axes, size), &RasterizeLhbParams::new(size))?;
            // Half a unit of the anchor, and of two gradients over size − 1 pixels, each.
            let roundings = 2 * (size - 1) + 1;
            // Shells lie in each other: in turn they are entered, then left.
            let deepest = if name == "shells" { 3 } else { 1 };
            let in_turn = |list: &[LhbElement]| {
                let mut winding = 0;
                list.iter().enumerate().all(|(i, e)| {
                    winding += if e.is_front() { 1 } else { -1 };
                    let apart = list.get(i + 1).is_none_or(|next| next.depth - e.depth > roundings);
                    !apart || (0..=deepest).contains(&winding)
                })
            };
            each_list(&lists, size, in_turn).map_err(|f| f.within(name))?;
        }
    }
    Ok(())
}

/// Facing is a bit of its own: turned inside out, nothing else changes. A wall shows its front to one side only.
fn r14_facing_is_exact<B: Backend>(cx: &Context<'_, B>) -> Check {
    let size = 16;
    let params = RasterizeLhbParams::new(size);
    let inside_out = snapped(&meshes::inverted(meshes::cube()));
    let cube = snapped(&meshes::cube());
    let around = views(&lattice_directions(), size);
    agrees(cx, &cube, &around, &params)?;
    let outwards = drawn(cx, &cube, &around, &params)?;
    let mut inwards = drawn(cx, &inside_out, &around, &params)?;
    inwards.elements.iter_mut().for_each(|e| e.surface ^= 1);
    same(cx, size, &inwards, &outwards)?;
    // Along an axis four sides are edge-on.
    let along = drawn(cx, &cube, &views(&[DVec3::NEG_Y], size), &params)?;
    let through =
        |list: &[LhbElement]| matches!(list, [] | [_, _]) && faces(list) == [true, false][..list.len()];
    each_list(&along, size, through)?;

    // From above its first corner down to the second, then back to the right: counter-clockwise.
    let wall = separate(&[[[-9_000, -9_000, 0], [-9_000, 9_000, 0], [9_000, 0, 0]]]);
    let behind = View { right: [-16_384, 0, 0, 0], forward: [0, 0, -16_384, 0], ..front() };
    let both: Checked<Vec<Lists>> =
        [front(), behind].iter().map(|&view| drawn(cx, &wall, &[view], &params)).collect();
    let both: Vec<Vec<bool>> = both?.iter().map(|lists| faces(&lists.elements)).collect();
    let seen = both.iter().all(|faces| !faces.is_empty());
    let exact = seen && both[0].iter().all(|&f| f) && !both[1].iter().any(|&f| f);
    ensure(exact, || format!("fronts of a wall, then from behind: {both:?}"))
}

fn faces(list: &[LhbElement]) -> Vec<bool> {
    list.iter().map(|e| e.is_front()).collect()
}
