// kernel family: rasterize_lhb
// contract core/src/kernels/rasterize_lhb.rs
// cpu backend-cpu/src/kernels/rasterize_lhb.rs
// gpu backend-gpu/src/kernels/rasterize_lhb.wgsl
// oracle conformance/src/oracle/rasterize_lhb.rs
//! Cases and laws of `rasterize_lhb`. Everything is compared exactly: coverage, depth and order are integers.

mod cases;
pub(super) mod inputs;
mod intake;
mod laws;
mod layers;
mod raster;
mod watertight;

use crate::compare::{Shape, exact};
use crate::oracle::rasterize_lhb::{Lists, rasterize};
use crate::trial::{Check, Context, Failure, Listing, ensure};
use twinlight_core::Backend;
use twinlight_core::kernels::rasterize_lhb::{
    PATH_AUTO, PATH_BLOCKS, PATH_LINEAR, PATH_MICRO, PATH_SPANS, RasterizeLhbParams,
};
use twinlight_core::lattice::{LatticeMesh, View};

/// Lists the trials.
pub fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    cases::list(list);
    laws::list(list);
    raster::list(list);
    layers::list(list);
    watertight::list(list);
    intake::list(list);
}

const PATHS: [u32; 5] = [PATH_AUTO, PATH_MICRO, PATH_BLOCKS, PATH_LINEAR, PATH_SPANS];

type Checked<T> = Result<T, Failure>;

/// The backend's lists.
fn drawn<B: Backend>(
    cx: &Context<'_, B>,
    mesh: &LatticeMesh,
    views: &[View],
    params: &RasterizeLhbParams,
) -> Checked<Lists> {
    let resident = cx.backend.upload_mesh(mesh)?;
    let lhb = cx.backend.rasterize_lhb(&resident, views, params)?;
    let shape = (lhb.size, lhb.view_count as usize);
    ensure(shape == (params.size, views.len()), || format!("{lhb:?} of {} views, {params:?}", views.len()))?;
    Ok(Lists {
        offsets: cx.backend.download(&lhb.offsets)?,
        elements: cx.backend.download(&lhb.elements)?,
        left_out: cx.backend.download(&lhb.left_out)?,
    })
}

/// Compares lists of views of `size` pixels.
fn same<B>(cx: &Context<'_, B>, size: u32, got: &Lists, want: &Lists) -> Check {
    let image = Shape::Image { width: size as usize };
    exact(cx, "offsets", &got.offsets, &want.offsets, image)?;
    exact(cx, "elements", &got.elements, &want.elements, Shape::Line)?;
    exact(cx, "left_out", &got.left_out, &want.left_out, image)
}

/// The backend's lists, which are the oracle's.
fn agreed<B: Backend>(
    cx: &Context<'_, B>,
    mesh: &LatticeMesh,
    views: &[View],
    params: &RasterizeLhbParams,
) -> Checked<Lists> {
    let want = rasterize(mesh, views, params);
    let place = || {
        let (triangles, views) = (mesh.triangles().len(), views.len());
        format!("{triangles} triangles, {views} views, {params:?}")
    };
    let got = drawn(cx, mesh, views, params).map_err(|f| f.within(&place()))?;
    same(cx, params.size, &got, &want).map_err(|f| f.within(&place()))?;
    Ok(got)
}

fn agrees<B: Backend>(
    cx: &Context<'_, B>,
    mesh: &LatticeMesh,
    views: &[View],
    params: &RasterizeLhbParams,
) -> Check {
    agreed(cx, mesh, views, params).map(|_| ())
}

/// Every path against the oracle.
fn agrees_on_every_path<B: Backend>(
    cx: &Context<'_, B>,
    mesh: &LatticeMesh,
    views: &[View],
    size: u32,
) -> Check {
    let want = rasterize(mesh, views, &RasterizeLhbParams::new(size));
    for path in PATHS {
        let params = RasterizeLhbParams { path, ..RasterizeLhbParams::new(size) };
        let check = drawn(cx, mesh, views, &params).and_then(|got| same(cx, size, &got, &want));
        check.map_err(|f| f.within(&format!("path {path}, size {size}")))?;
    }
    Ok(())
}
