//! Bugs in `rasterize_lhb`. Those that need other pixels or depths than the sound backend's find them by brute force on the
//! host.

use super::FaultyMesh;
use crate::faults::Fault;
use crate::oracle::rasterize_lhb::{Lists, Shown, on_screen};
use twinlight_core::kernels::rasterize_lhb::{
    CAP_NEAR, Lhb, LhbBuffers, LhbElement, PATH_LINEAR, PATH_SPANS, RasterizeLhbParams,
};
use twinlight_core::lattice::{LatticeMesh, View};
use twinlight_core::{Backend, Result};

pub(super) fn rasterize_lhb<B: Backend>(
    inner: &B,
    fault: Fault,
    mesh: &FaultyMesh<B::Mesh>,
    views: &[View],
    params: &RasterizeLhbParams,
) -> Result<Lhb<B>> {
    let lists = match (params.check(views), is_of_coverage(fault)) {
        (Err(_), _) if fault == Fault::LhbAcceptsAnything => Lists::of([]),
        (Err(error), _) => return Err(error),
        (Ok(_), true) => redrawn(fault, &mesh.host, views, params),
        (Ok(_), false) => {
            // The bugs of views and of caps are in what the sound backend is asked for.
            let whole = RasterizeLhbParams { layer_cap: 0, ..*params };
            let asked: Vec<View> = match fault {
                Fault::LhbViewsReversed => views.iter().rev().copied().collect(),
                Fault::LhbFirstViewOnly => views.iter().map(|_| views[0]).collect(),
                _ => views.to_vec(),
            };
            let sound = inner.rasterize_lhb(
                &mesh.inner,
                &asked,
                if fault == Fault::None { params } else { &whole },
            )?;
            if fault == Fault::None {
                return Ok(sound);
            }
            let offsets = inner.download(&sound.offsets)?;
            let lists = Lists { offsets, elements: inner.download(&sound.elements)?, left_out: Vec::new() };
            broken(fault, &lists, &mesh.host, &asked, params)
        }
    };
    Ok(LhbBuffers {
        size: params.size,
        view_count: views.len() as u32,
        offsets: inner.upload(&lists.offsets)?,
        elements: inner.upload(&lists.elements)?,
        left_out: inner.upload(&lists.left_out)?,
    })
}

/// Bugs for which every triangle is drawn anew.
fn is_of_coverage(fault: Fault) -> bool {
    matches!(
        fault,
        Fault::LhbEdgesInclusive
            | Fault::LhbEdgesExclusive
            | Fault::LhbBottomRight
            | Fault::LhbTruncatesScreen
            | Fault::LhbEdgeOnDrawn
    )
}

/// The oracle with another rule for edges, or other screen coordinates.
fn redrawn(fault: Fault, mesh: &LatticeMesh, views: &[View], params: &RasterizeLhbParams) -> Lists {
    let n = params.size as usize;
    let mut lists = vec![Vec::new(); views.len() * n * n];
    for (v, view) in views.iter().enumerate() {
        for (number, corners) in mesh.triangles().iter().enumerate() {
            let corners = corners.map(|c| placed(fault, view, params.size, mesh.vertices()[c as usize]));
            let mut wider = corners;
            if fault == Fault::LhbEdgeOnDrawn {
                (wider[1][0], wider[2][1]) = (wider[1][0] + 1, wider[2][1] + 1);
            }
            let shown = Shown::of(corners, number, params.size);
            let Some(shown) = shown.or_else(|| Shown::of(wider, number, params.size)) else { continue };
            for (column, row) in shown.pixels().filter(|&(x, y)| covers(fault, &shown, x, y)) {
                lists[(v * n + row) * n + column].push(shown.element(column, row));
            }
        }
    }
    for list in &mut lists {
        list.sort_by_key(|e| (e.depth, e.triangle()));
    }
    Lists::of(lists.iter().map(Vec::as_slice)).capped(params)
}

fn placed(fault: Fault, view: &View, size: u32, point: [i16; 3]) -> [i128; 3] {
    let rounded = on_screen(view, size, point);
    if fault != Fault::LhbTruncatesScreen {
        return rounded;
    }
    let middle = on_screen(view, size, [0; 3]);
    let dot = |row: [i32; 4]| (0..3).map(|i| i128::from(row[i]) * i128::from(point[i])).sum::<i128>();
    [middle[0] + (dot(view.right) >> 15), middle[1] + (dot(view.down) >> 15), rounded[2]]
}

fn covers(fault: Fault, shown: &Shown, column: usize, row: usize) -> bool {
    let owns = |dx: i128, dy: i128| match fault {
        Fault::LhbEdgesInclusive => true,
        Fault::LhbEdgesExclusive => false,
        Fault::LhbBottomRight => dy > 0 || (dy == 0 && dx < 0),
        _ => dy < 0 || (dy == 0 && dx > 0),
    };
    shown.edges(column, row).iter().all(|&[dx, dy, e]| e > 0 || (e == 0 && owns(dx, dy)))
}

/// What becomes of sound lists, uncapped ones whatever the cap.
fn broken(
    fault: Fault,
    sound: &Lists,
    mesh: &LatticeMesh,
    views: &[View],
    params: &RasterizeLhbParams,
) -> Lists {
    let n = params.size as usize;
    let source = |i: usize| {
        let (view, column, row) = (i / n / n, i % n, i / n % n);
        match fault {
            Fault::LhbTransposed => (view * n + column) * n + row,
            Fault::LhbUpsideDown => (view * n + n - 1 - row) * n + column,
            _ => i,
        }
    };
    let all: Vec<&[LhbElement]> = sound.each().collect();
    let lists: Vec<Vec<LhbElement>> = (0..all.len())
        .map(|i| {
            let pixel = (i % n, i / n % n);
            let shown =
                |e: &LhbElement| Shown::new(mesh, e.triangle() as usize, &views[i / n / n], params.size);
            let of_surface = |e: &LhbElement| surface(fault, e, shown, pixel, mesh, params);
            of_list(fault, all[source(i)].iter().filter_map(of_surface).collect())
        })
        .collect();
    let lists = Lists::of(lists.iter().map(Vec::as_slice));
    let mut capped = match fault {
        Fault::LhbCapKeepsNear => lists.capped(&RasterizeLhbParams { cap_side: CAP_NEAR, ..*params }),
        Fault::LhbCapOff if params.layer_cap > 1 => {
            lists.capped(&RasterizeLhbParams { layer_cap: params.layer_cap - 1, ..*params })
        }
        _ => lists.capped(params),
    };
    match fault {
        Fault::LhbLeftOutZero => capped.left_out.fill(0),
        Fault::LhbOffsetsInclusive => {
            capped.offsets.rotate_left(1);
            let last = capped.offsets.len() - 1;
            capped.offsets[last] = capped.elements.len() as u32;
        }
        _ => {}
    }
    capped
}

/// One surface of a list, or nothing.
fn surface(
    fault: Fault,
    e: &LhbElement,
    shown: impl Fn(&LhbElement) -> Option<Shown>,
    (column, row): (usize, usize),
    mesh: &LatticeMesh,
    params: &RasterizeLhbParams,
) -> Option<LhbElement> {
    let at = |z: i128| LhbElement { depth: (z + (1 << 29)) as u32, ..*e };
    let last = mesh.triangles().len() as u32 - 1;
    Some(match fault {
        Fault::LhbFacingInverted => LhbElement { surface: e.surface ^ 1, ..*e },
        Fault::LhbAlwaysFront => LhbElement { surface: e.surface | 1, ..*e },
        Fault::LhbCullsBacks if !e.is_front() => return None,
        Fault::LhbLosesLastTriangle if last >= 256 && e.triangle() == last => return None,
        Fault::LhbEdgeOverflow if shown(e)?.edges(column, row).iter().any(|[_, _, f]| *f >= 1 << 29) => {
            return None;
        }
        Fault::LhbCullsSmall if bounds(&shown(e)?) <= 1 => return None,
        Fault::LhbLosesBlock if bounds(&shown(e)?) > 64 => {
            let (right, bottom) = shown(e)?.pixels().last()?;
            if column / 4 == right / 4 && row / 4 == bottom / 4 {
                return None;
            }
            *e
        }
        Fault::LhbPathLosesPixel
            if params.path == PATH_LINEAR && shown(e)?.pixels().last() == Some((column, row)) =>
        {
            return None;
        }
        Fault::LhbPathBits if params.path == PATH_SPANS => LhbElement { depth: e.depth - 1, ..*e },
        Fault::LhbNearestVertex => at(shown(e)?.corners().iter().map(|c| c[2]).min()?),
        Fault::LhbFlatRows => at(shown(e)?.unclamped(shown(e)?.pixels().next()?.0, row)),
        Fault::LhbUnclamped => at(shown(e)?.unclamped(column, row)),
        Fault::LhbRoundsDown => {
            let shown = shown(e)?;
            let (first_column, first_row) = shown.pixels().next()?;
            // Half a unit less per pixel is what rounding down loses in the middle.
            let pixels = (column - first_column + row - first_row) as i128;
            at(shown.unclamped(column, row) - pixels / 2)
        }
        _ => *e,
    })
}

/// Pixels whose centres are in the bounds.
fn bounds(shown: &Shown) -> usize {
    shown.pixels().count()
}

/// One list.
fn of_list(fault: Fault, mut list: Vec<LhbElement>) -> Vec<LhbElement> {
    match fault {
        Fault::LhbTiesToHigher => list.sort_by_key(|e| (e.depth, !e.triangle())),
        Fault::LhbFarFirst => list.reverse(),
        Fault::LhbLosesLastLayer if list.len() > 3 => list.truncate(list.len() - 1),
        Fault::LhbMergesCopies => list.dedup_by_key(|e| (e.depth, e.surface & 1)),
        Fault::LhbLongUnsorted if list.len() > 64 => {
            // As if the parts were of every second triangle.
            list.sort_by_key(|e| (e.triangle() % 2, e.depth, e.triangle()));
        }
        Fault::LhbNearestVertex | Fault::LhbFlatRows | Fault::LhbUnclamped | Fault::LhbRoundsDown => {
            list.sort_by_key(|e| (e.depth, e.triangle()));
        }
        _ => {}
    }
    list
}
