// kernel family: pack_lhb
// contract core/src/kernels/pack_lhb.rs
// cpu backend-cpu/src/kernels/pack_lhb.rs
// gpu backend-gpu/src/kernels/pack_lhb.wgsl
// oracle conformance/src/oracle/pack_lhb.rs
//! Cases and laws of `pack_lhb`. Lists are made up, so that a wrong word is the packing's own, or drawn on the device. Everything is
//! compared exactly, in both directions.

mod caps;
mod cases;
mod foreign;
mod inputs;
mod laws;

use crate::compare::{Shape, exact};
use crate::oracle::pack_lhb::{Packed, pack, unpack};
use crate::oracle::rasterize_lhb::Lists;
use crate::trial::{Check, Context, Failure, Listing, ensure};
use twinlight_core::Backend;
use twinlight_core::kernels::pack_lhb::{PackLhbParams, PackedLhb, PackedLhbBuffers};
use twinlight_core::kernels::rasterize_lhb::{CAP_FAR, CAP_NEAR, Lhb, LhbBuffers};

/// Lists the trials.
pub fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    cases::list(list);
    caps::list(list);
    laws::list(list);
    foreign::list(list);
}

type Checked<T> = Result<T, Failure>;

const SIDES: [u32; 2] = [CAP_NEAR, CAP_FAR];

/// Lists as long as they are.
const AS_LISTS: PackLhbParams = PackLhbParams { layers: 0, cap_side: CAP_NEAR };

/// The nearest elements of each list.
fn near(layers: u32) -> PackLhbParams {
    PackLhbParams { layers, cap_side: CAP_NEAR }
}

/// Lists of views of one size.
#[derive(Debug, Clone)]
struct Views {
    size: u32,
    view_count: u32,
    lists: Lists,
}

impl Views {
    fn one_pixel(lists: Lists) -> Self {
        Self { size: 1, view_count: 1, lists }
    }

    fn uploaded<B: Backend>(&self, cx: &Context<'_, B>) -> Checked<Lhb<B>> {
        Ok(LhbBuffers {
            size: self.size,
            view_count: self.view_count,
            offsets: cx.backend.upload(&self.lists.offsets)?,
            elements: cx.backend.upload(&self.lists.elements)?,
            left_out: cx.backend.upload(&self.lists.left_out)?,
        })
    }

    /// The backend's words and what it reads back of them, which are the oracle's; neither input has changed.
    fn agreed<B: Backend>(&self, cx: &Context<'_, B>, params: &PackLhbParams) -> Checked<(Packed, Lists)> {
        let Self { size, view_count, lists } = self;
        let place =
            || format!("{} elements of {view_count} views of {size}², {params:?}", lists.elements.len());
        let lhb = self.uploaded(cx)?;
        let check = || {
            let found = both_ways(cx, &lhb, lists, params)?;
            same_lists(cx, *size, &downloaded(cx, &lhb)?, lists).map_err(|f| f.within("input"))?;
            Ok(found)
        };
        check().map_err(|f: Failure| f.within(&place()))
    }

    fn agrees<B: Backend>(&self, cx: &Context<'_, B>, params: &PackLhbParams) -> Check {
        self.agreed(cx, params).map(|_| ())
    }
}

/// Packs and unpacks buffers that hold `lists`, and compares with the oracle.
fn both_ways<B: Backend>(
    cx: &Context<'_, B>,
    lhb: &Lhb<B>,
    lists: &Lists,
    params: &PackLhbParams,
) -> Checked<(Packed, Lists)> {
    let packed = cx.backend.pack_lhb(lhb, params)?;
    let shapes = [(packed.size, packed.view_count, packed.layers), (lhb.size, lhb.view_count, params.layers)];
    ensure(shapes[0] == shapes[1], || format!("{packed:?} of {lhb:?}"))?;
    let (words, want) = (downloaded_words(cx, &packed)?, pack(lists, params));
    same_words(cx, &words, &want)?;
    let back = cx.backend.unpack_lhb(&packed)?;
    let shapes = [&back, lhb].map(|lhb| (lhb.size, lhb.view_count));
    ensure(shapes[0] == shapes[1], || format!("{back:?} of {packed:?}"))?;
    let back = downloaded(cx, &back)?;
    same_lists(cx, lhb.size, &back, &unpack(&want, params.layers)).map_err(|f| f.within("read back"))?;
    same_words(cx, &downloaded_words(cx, &packed)?, &want)
        .map_err(|f| f.within("words after reading back"))?;
    Ok((words, back))
}

/// Words on the device.
fn uploaded_words<B: Backend>(
    cx: &Context<'_, B>,
    [size, view_count, layers]: [u32; 3],
    packed: &Packed,
) -> Checked<PackedLhb<B>> {
    Ok(PackedLhbBuffers {
        size,
        view_count,
        layers,
        offsets: cx.backend.upload(&packed.offsets)?,
        words: cx.backend.upload(&packed.words)?,
        left_out: cx.backend.upload(&packed.left_out)?,
    })
}

fn downloaded_words<B: Backend>(cx: &Context<'_, B>, packed: &PackedLhb<B>) -> Checked<Packed> {
    Ok(Packed {
        offsets: cx.backend.download(&packed.offsets)?,
        words: cx.backend.download(&packed.words)?,
        left_out: cx.backend.download(&packed.left_out)?,
    })
}

fn downloaded<B: Backend>(cx: &Context<'_, B>, lhb: &Lhb<B>) -> Checked<Lists> {
    Ok(Lists {
        offsets: cx.backend.download(&lhb.offsets)?,
        elements: cx.backend.download(&lhb.elements)?,
        left_out: cx.backend.download(&lhb.left_out)?,
    })
}

fn same_words<B>(cx: &Context<'_, B>, got: &Packed, want: &Packed) -> Check {
    exact(cx, "packed offsets", &got.offsets, &want.offsets, Shape::Line)?;
    exact(cx, "words", &got.words, &want.words, Shape::Line)?;
    exact(cx, "packed left_out", &got.left_out, &want.left_out, Shape::Line)
}

/// Compares lists of views of `size` pixels.
fn same_lists<B>(cx: &Context<'_, B>, size: u32, got: &Lists, want: &Lists) -> Check {
    let image = Shape::Image { width: size as usize };
    exact(cx, "offsets", &got.offsets, &want.offsets, image)?;
    exact(cx, "elements", &got.elements, &want.elements, Shape::Line)?;
    exact(cx, "left_out", &got.left_out, &want.left_out, image)
}
