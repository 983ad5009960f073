//! How the elements of hit buffers are stored.

use std::fmt;
use std::str::FromStr;
use twinlight_core::kernels::pack_lhb::{MAX_TRIANGLES, PackLhbParams, PackedLhb};
use twinlight_core::kernels::rasterize_lhb::{CAP_NEAR, Lhb};
use twinlight_core::{Backend, Error, Result};

/// How elements are stored: `full`, `packed` or `layers:K`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Elements {
    /// 8 bytes each, and nothing is lost.
    #[default]
    Full,
    /// 4 bytes each: depths to a 4096th of the scene ([`twinlight_core::kernels::pack_lhb`]), at most 2²⁰ − 1 triangles.
    Packed,
    /// So many such words per pixel, for its nearest elements: Yu's layout. What has no room is lost.
    Layers(u32),
}

impl fmt::Display for Elements {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Full => f.write_str("full"),
            Self::Packed => f.write_str("packed"),
            Self::Layers(layers) => write!(f, "layers:{layers}"),
        }
    }
}

impl FromStr for Elements {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let layers = text.strip_prefix("layers:").and_then(|layers| layers.parse().ok());
        match (text, layers) {
            ("full", _) => Ok(Self::Full),
            ("packed", _) => Ok(Self::Packed),
            (_, Some(layers)) if layers > 0 => Ok(Self::Layers(layers)),
            _ => Err(Error::invalid(
                "elements",
                format!("'{text}' is neither full, packed nor layers:K, K above 0"),
            )),
        }
    }
}

/// What lookups read, and what it takes to keep it.
pub(super) struct Stored<B: Backend> {
    pub(super) lhb: Lhb<B>,
    /// Bytes of the lists as they are stored.
    pub(super) bytes: u64,
    /// Bytes of what is read back of them for lookups; 0 where they are looked up as they are.
    pub(super) read_back_bytes: u64,
}

impl Elements {
    /// Refuses what the format can't hold of a scene of so many triangles, before anything is drawn.
    ///
    /// # Errors
    /// [`Error::LimitExceeded`] for too many triangles, [`Error::InvalidInput`] for no layers.
    pub(super) fn check(self, triangles: usize) -> Result<()> {
        if self == Self::Layers(0) {
            return Err(Error::invalid("elements", "no layers hold no elements"));
        }
        let limit = u64::from(MAX_TRIANGLES);
        if self != Self::Full && triangles as u64 > limit {
            let what = format!("triangles of elements that are stored {self}");
            return Err(Error::limit(what, triangles as u64, limit));
        }
        Ok(())
    }

    /// Packs buffers and reads them back.
    pub(super) fn stored<B: Backend>(self, backend: &B, lhb: Lhb<B>) -> Result<Stored<B>> {
        let layers = match self {
            Self::Full => return Ok(Stored { bytes: bytes(backend, &lhb), lhb, read_back_bytes: 0 }),
            Self::Packed => 0,
            Self::Layers(layers) => layers,
        };
        let packed = backend.pack_lhb(&lhb, &PackLhbParams { layers, cap_side: CAP_NEAR })?;
        // There need not be room for both.
        drop(lhb);
        let lhb = backend.unpack_lhb(&packed)?;
        Ok(Stored { bytes: packed_bytes(backend, &packed), read_back_bytes: bytes(backend, &lhb), lhb })
    }
}

fn bytes<B: Backend>(backend: &B, lhb: &Lhb<B>) -> u64 {
    let words = backend.len(&lhb.offsets) + backend.len(&lhb.left_out);
    8 * backend.len(&lhb.elements) as u64 + 4 * words as u64
}

fn packed_bytes<B: Backend>(backend: &B, packed: &PackedLhb<B>) -> u64 {
    let lens = [&packed.offsets, &packed.words, &packed.left_out].map(|buffer| backend.len(buffer) as u64);
    4 * lens.iter().sum::<u64>()
}
