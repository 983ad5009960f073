//! A hit buffer as a picture, for people who debug.

use super::Buffers;
use twinlight_core::kernels::rasterize_lhb::LhbElement;
use twinlight_core::lattice::{DEPTH_ORIGIN, REACH};
use twinlight_core::{Backend, Error, Result};

/// Layers that are shown, nearest first, beside the number of layers.
const PEELS: u32 = 7;

/// One view's lists, as tiles in a row: how many layers each pixel has, then the layers one by one.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// Pixels per row: 8 tiles.
    pub width: u32,
    /// Rows: a tile.
    pub height: u32,
    /// sRGB, row-major from the top-left. The first tile grows from black to white at the deepest pixel; the others fade with the
    /// distance from the viewer, orange where he sees a front and blue where he sees a back.
    pub pixels: Vec<[u8; 3]>,
    /// Share of pixels with any layer.
    pub covered: f64,
    /// Layers of the deepest pixel.
    pub deepest: u32,
    /// Elements of the view.
    pub elements: u64,
}

/// Draws a view.
///
/// # Errors
/// [`Error::InvalidInput`] for a view that there isn't; what the backend says.
pub fn sheet<B: Backend>(backend: &B, buffers: &Buffers<B>, view: u32) -> Result<Sheet> {
    let lhb = &buffers.lhb;
    if view >= lhb.view_count {
        let what = format!("{view}: there are {} views, from 0 on", lhb.view_count);
        return Err(Error::invalid("view", what));
    }
    let size = lhb.size;
    let pixels = size as usize * size as usize;
    let offsets = backend.download(&lhb.offsets)?;
    let elements = backend.download(&lhb.elements)?;
    let own = &offsets[view as usize * pixels..][..pixels + 1];
    let lists: Vec<&[LhbElement]> =
        own.windows(2).map(|ends| &elements[ends[0] as usize..ends[1] as usize]).collect();
    let deepest = lists.iter().map(|list| list.len()).max().unwrap_or(0);
    let width = size * (PEELS + 1);
    let mut picture = Vec::with_capacity(pixels * (PEELS as usize + 1));
    for row in lists.chunks(size as usize) {
        picture.extend(row.iter().map(|list| count_colour(list.len(), deepest)));
        for layer in 0..PEELS as usize {
            picture.extend(row.iter().map(|list| list.get(layer).map_or([0; 3], |e| layer_colour(*e))));
        }
    }
    let covered = lists.iter().filter(|list| !list.is_empty()).count() as f64 / pixels as f64;
    let count = u64::from(own[pixels] - own[0]);
    Ok(Sheet { width, height: size, pixels: picture, covered, deepest: deepest as u32, elements: count })
}

fn count_colour(count: usize, deepest: usize) -> [u8; 3] {
    // One layer can be told from none, however deep others are.
    let level = if count == 0 { 0 } else { 40 + 215 * (count - 1) / (deepest - 1).max(1) };
    [level as u8; 3]
}

fn layer_colour(element: LhbElement) -> [u8; 3] {
    let reach = f64::from(REACH) * 16_384.0;
    let near = (f64::from(element.depth as i32 - DEPTH_ORIGIN) / reach * -0.5 + 0.5).clamp(0.0, 1.0);
    let level = 50.0 + 205.0 * near;
    let colour = if element.is_front() { [1.0, 0.65, 0.3] } else { [0.35, 0.6, 1.0] };
    colour.map(|share: f64| (level * share) as u8)
}
