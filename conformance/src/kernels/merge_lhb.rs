// kernel family: merge_lhb
// contract core/src/kernels/merge_lhb.rs
// cpu backend-cpu/src/kernels/merge_lhb.rs
// gpu backend-gpu/src/kernels/merge_lhb.wgsl
// oracle conformance/src/oracle/merge_lhb.rs
//! Cases and laws of `merge_lhb`. Lists are made up, so that a wrong result is the merge's own, or drawn, so that the promise is
//! kept where it is used. Everything is compared exactly.

mod caps;
mod cases;
mod foreign;
mod inputs;
mod laws;
mod parts;

use crate::compare::{Shape, exact};
use crate::oracle::merge_lhb::merge;
use crate::oracle::rasterize_lhb::Lists;
use crate::trial::{Check, Context, Failure, Listing, ensure};
use twinlight_core::Backend;
use twinlight_core::kernels::merge_lhb::MergeLhbParams;
use twinlight_core::kernels::rasterize_lhb::{CAP_FAR, CAP_NEAR, Lhb, LhbBuffers};

/// Lists the trials.
pub fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    cases::list(list);
    caps::list(list);
    laws::list(list);
    parts::list(list);
    foreign::list(list);
}

type Checked<T> = Result<T, Failure>;

const SIDES: [u32; 2] = [CAP_NEAR, CAP_FAR];

/// All elements; added triangles are numbered from `first_triangle`.
fn all_from(first_triangle: u32) -> MergeLhbParams {
    MergeLhbParams { first_triangle, layer_cap: 0, cap_side: CAP_NEAR, padding: 0 }
}

/// Two sets of lists of one shape.
#[derive(Debug, Clone)]
struct Pair {
    size: u32,
    view_count: u32,
    kept: Lists,
    added: Lists,
}

impl Pair {
    /// The backend's merge, which is the oracle's, and leaves both inputs as they were.
    fn agreed<B: Backend>(&self, cx: &Context<'_, B>, params: &MergeLhbParams) -> Checked<Lists> {
        let inputs = [&self.kept, &self.added];
        let [kept, added] = inputs.map(|lists| uploaded(cx, self.size, self.view_count, lists));
        let (kept, added) = (kept?, added?);
        let place = || {
            let [a, b] = inputs.map(|lists| lists.elements.len());
            format!("{a} and {b} elements of {} views of {}², {params:?}", self.view_count, self.size)
        };
        let got = merged(cx, &kept, &added, params).and_then(|lhb| downloaded(cx, &lhb));
        let got = got.map_err(|f| f.within(&place()))?;
        same(cx, self.size, &got, &merge(&self.kept, &self.added, params)).map_err(|f| f.within(&place()))?;
        for (name, lhb, before) in [("kept", &kept, &self.kept), ("added", &added, &self.added)] {
            let check = downloaded(cx, lhb).and_then(|after| same(cx, self.size, &after, before));
            check.map_err(|f| f.within(&format!("{name} after the merge")))?;
        }
        Ok(got)
    }

    fn agrees<B: Backend>(&self, cx: &Context<'_, B>, params: &MergeLhbParams) -> Check {
        self.agreed(cx, params).map(|_| ())
    }
}

fn uploaded<B: Backend>(cx: &Context<'_, B>, size: u32, view_count: u32, lists: &Lists) -> Checked<Lhb<B>> {
    Ok(LhbBuffers {
        size,
        view_count,
        offsets: cx.backend.upload(&lists.offsets)?,
        elements: cx.backend.upload(&lists.elements)?,
        left_out: cx.backend.upload(&lists.left_out)?,
    })
}

fn downloaded<B: Backend>(cx: &Context<'_, B>, lhb: &Lhb<B>) -> Checked<Lists> {
    Ok(Lists {
        offsets: cx.backend.download(&lhb.offsets)?,
        elements: cx.backend.download(&lhb.elements)?,
        left_out: cx.backend.download(&lhb.left_out)?,
    })
}

/// The backend's merge, of the shape of its inputs.
fn merged<B: Backend>(
    cx: &Context<'_, B>,
    kept: &Lhb<B>,
    added: &Lhb<B>,
    params: &MergeLhbParams,
) -> Checked<Lhb<B>> {
    let lhb = cx.backend.merge_lhb(kept, added, params)?;
    let shapes = [&lhb, kept].map(|lhb| (lhb.size, lhb.view_count));
    ensure(shapes[0] == shapes[1], || format!("{lhb:?} of {kept:?}"))?;
    Ok(lhb)
}

/// Compares lists of views of `size` pixels.
fn same<B>(cx: &Context<'_, B>, size: u32, got: &Lists, want: &Lists) -> Check {
    let image = Shape::Image { width: size as usize };
    exact(cx, "offsets", &got.offsets, &want.offsets, image)?;
    exact(cx, "elements", &got.elements, &want.elements, Shape::Line)?;
    exact(cx, "left_out", &got.left_out, &want.left_out, image)
}
