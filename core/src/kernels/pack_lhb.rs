// kernel family: pack_lhb
// contract core/src/kernels/pack_lhb.rs
// cpu backend-cpu/src/kernels/pack_lhb.rs
// gpu backend-gpu/src/kernels/pack_lhb.wgsl
// oracle conformance/src/oracle/pack_lhb.rs
//! `pack_lhb`: layered hit buffers with elements in half the bytes, as lists or in a fixed number of layers, and back.
//!
//! *Shapes.* [`LhbBuffers`] of V views of N × N pixels in, [`PackedLhbBuffers`] of as many out; and the way back. *Units.* Those of
//! [`crate::kernels::rasterize_lhb`].
//!
//! *An element* is a word, most significant bit first: 11 bits of depth, ⌊depth / 2¹⁹⌋, but at most [`LAST_BIN`]; 20 bits of the triangle's
//! number; 1 bit, set where it shows the viewer its front. Depth comes first, so that the words of a list ascend in their depths.
//!
//! *Packing.* With [`PackLhbParams::layers`] 0, `words[n]` is element n, and `offsets` and `left_out` are copied, whatever they say.
//! With K > 0 layers, list i, as in `rasterize_lhb`, is `words[i·K..(i + 1)·K]`: its first K elements
//! ([`CAP_NEAR`](crate::kernels::rasterize_lhb::CAP_NEAR)) or its last ([`CAP_FAR`]) in their order, then [`EMPTY`]. `left_out[i]` is
//! what was left out of the list before, if that is known, and what K layers have no room for, modulo 2³². There are no offsets.
//!
//! *Unpacking.* Each word is an element whose depth is the middle of its bin: `(word >> 21) · 2¹⁹ + 2¹⁸`. With layers, list i is its words before the
//! first that is [`EMPTY`], and the offsets are the sums of their numbers. Equal depths stay in the order in which they were.
//!
//! *Accuracy of depth.* What is read back is within 2¹⁸ units, 16 lattice steps, of the depth that was packed: a 4096th of the lattice's
//! width, 1/32 of a pixel's at 128² and a quarter of it at 1024². Triangle and facing come back as they were. The windows of
//! `walk_lhb`'s lookups are not widened for it: what they allow for other roundings is as much, 4 steps times a slope of 4 or more.
//! *Why pixel by pixel.* A lookup reads a list from one end; 16 words are a cache line. Layer by layer each element would be in
//! a line of its own.
//! *Edge cases.* No elements: no words, or only empty ones. The last number of 20 bits is refused, so that no element is [`EMPTY`].
//! Offsets that fall or leave their elements are an error with layers. Words of other origin unpack to some elements, and nothing
//! outside the buffers is read.
//! *Limits.* Triangles below [`MAX_TRIANGLES`], of all elements that are packed; fewer than 2³² words, checked before they are
//! allocated. Of malformed offsets and triangles beyond the limit, the former are reported.
//! *Source.* Yu, layered hit buffers: 20 bits of id, 12 bits of depth, 16 layers. Deviation: one of the depth's bits tells fronts from
//! backs, which lookups judge surfaces by; K is free.

use crate::accuracy::Accuracy;
use crate::backend::Backend;
use crate::error::{Error, Result};
use crate::kernels::rasterize_lhb::{CAP_FAR, LhbBuffers, lists};
use bytemuck::{Pod, Zeroable};
use std::fmt;

/// Bits are moved.
pub const ACCURACY: Accuracy = Accuracy::Exact { because: "shifts and copies of integers" };

/// Bits of a word below the depth: the triangle's number and the facing.
pub const SURFACE_BITS: u32 = 21;
/// Bits that a packed depth lacks.
pub const DEPTH_SHIFT: u32 = 19;
/// The farthest bin of depths.
pub const LAST_BIN: u32 = 2047;
/// Most triangles of a packed mesh.
pub const MAX_TRIANGLES: u32 = (1 << 20) - 1;
/// A layer without an element.
pub const EMPTY: u32 = u32::MAX;

/// Parameters of one call.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct PackLhbParams {
    /// Words per pixel, 0 for lists as long as they are.
    pub layers: u32,
    /// One of the `CAP_…` constants of [`crate::kernels::rasterize_lhb`].
    pub cap_side: u32,
}

/// Packed layered hit buffers on a device: `O` holds `u32`.
#[derive(Clone)]
pub struct PackedLhbBuffers<O> {
    /// Pixels per row and column of every view.
    pub size: u32,
    /// Number of views.
    pub view_count: u32,
    /// Words per pixel, 0 for lists as long as they are.
    pub layers: u32,
    /// Where each pixel's list begins, and the number of words; empty with layers.
    pub offsets: O,
    /// The elements.
    pub words: O,
    /// How many elements a cap left out, per pixel; empty without one.
    pub left_out: O,
}

impl<O> fmt::Debug for PackedLhbBuffers<O> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { size, view_count, layers, .. } = self;
        write!(f, "PackedLhbBuffers({view_count} views of {size}x{size}, {layers} layers)")
    }
}

/// [`PackedLhbBuffers`] in a backend's buffers.
pub type PackedLhb<B> = PackedLhbBuffers<<B as Backend>::Buffer<u32>>;

/// How much there is to write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PackedShape {
    /// Lists.
    pub lists: usize,
    /// Words.
    pub words: u32,
}

impl PackLhbParams {
    /// What is to be written, if the call is sound; `len` gives the length of a buffer of offsets or of numbers left out, and there are
    /// `elements` of them.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for an unknown side, offsets that are not one more than the lists, or numbers left out that are neither none nor as
    /// many; [`Error::LimitExceeded`] for 2³² words and more; those of [`LhbBuffers::lists`].
    pub fn check<O, E>(
        &self,
        lhb: &LhbBuffers<O, E>,
        len: impl Fn(&O) -> usize,
        elements: usize,
    ) -> Result<PackedShape> {
        if self.cap_side > CAP_FAR {
            return Err(Error::invalid("cap_side", format!("{} is neither 0 nor 1", self.cap_side)));
        }
        let lists = lhb.lists()?;
        expect_lengths(lists + 1, lists, false, [&lhb.offsets, &lhb.left_out].map(len))?;
        let words = if self.layers > 0 { lists as u64 * u64::from(self.layers) } else { elements as u64 };
        Ok(PackedShape { lists, words: check_words(words)? })
    }
}

impl<O> PackedLhbBuffers<O> {
    /// What there is to unpack, if it is sound; `len` gives the length of a buffer.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for buffers of other lengths than the size, the views and the layers ask for; as
    /// [`PackLhbParams::check`].
    pub fn check(&self, len: impl Fn(&O) -> usize) -> Result<PackedShape> {
        let lists = lists(self.view_count.into(), self.size)?;
        let [offsets, left_out, words] = [&self.offsets, &self.left_out, &self.words].map(len);
        let has_layers = self.layers > 0;
        let wanted_offsets = if has_layers { 0 } else { lists + 1 };
        expect_lengths(wanted_offsets, lists, has_layers, [offsets, left_out])?;
        let wanted = if has_layers { lists as u64 * u64::from(self.layers) } else { words as u64 };
        if words as u64 != wanted {
            let what = format!("{words} words, where {wanted} are needed");
            return Err(Error::invalid("pack_lhb", what));
        }
        Ok(PackedShape { lists, words: check_words(wanted)? })
    }
}

/// Refuses lengths of offsets and of numbers left out that are not as wanted. Of the latter there may be none, unless they are `needed`.
fn expect_lengths(offsets: usize, left_out: usize, needed: bool, found: [usize; 2]) -> Result<()> {
    let is_none = found[1] == 0 && !needed;
    if found[0] == offsets && (found[1] == left_out || is_none) {
        return Ok(());
    }
    let what = format!(
        "{} offsets and {} numbers left out, where {offsets} and {left_out} are needed",
        found[0], found[1]
    );
    Err(Error::invalid("pack_lhb", what))
}

fn check_words(count: u64) -> Result<u32> {
    let limit = u64::from(u32::MAX);
    u32::try_from(count).map_err(|_| Error::limit("words of packed layered hit buffers", count, limit))
}

/// Refuses elements of which the greatest number of a triangle is `greatest`, if that needs more bits than a word has for it.
///
/// # Errors
/// [`Error::LimitExceeded`] beyond [`MAX_TRIANGLES`].
pub fn check_triangles(greatest: u32) -> Result<()> {
    let count = u64::from(greatest) + 1;
    let limit = u64::from(MAX_TRIANGLES);
    if count > limit {
        return Err(Error::limit("triangles of packed layered hit buffers", count, limit));
    }
    Ok(())
}

/// Refuses what malformed offsets say.
pub fn malformed() -> Error {
    Error::invalid("pack_lhb", "offsets fall or leave their elements")
}
