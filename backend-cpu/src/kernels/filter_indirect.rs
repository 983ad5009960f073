// kernel family: filter_indirect
// contract core/src/kernels/filter_indirect.rs
// cpu backend-cpu/src/kernels/filter_indirect.rs
// gpu backend-gpu/src/kernels/filter_indirect.wgsl
// oracle conformance/src/oracle/filter_indirect.rs
//! `filter_indirect`: eight pixels of a row at a time, whose neighbours at one offset are eight pixels of a row too. What neighbours are
//! asked for lies in planes, row by row: divisions are one per pixel, and not one per neighbour.

use crate::buffer::try_zeroed;
use crate::parallel::fill_chunks;
use crate::simd::{Isa, Kernel, LaneMask, Lanes, Width};
use twinlight_core::kernels::filter_indirect::{FilterIndirectParams, LEAST_ALBEDO, RadianceTexel};
use twinlight_core::kernels::shade_primary::GBufferTexel;
use twinlight_core::kernels::trace::NO_HIT;
use twinlight_core::{Error, Result};

/// Pixels per vector.
const LANES: usize = 8;

/// Pixels per task: a few microseconds with the narrowest window.
const PIXELS: usize = 1024;

// Planes of a row: material, position, shading normal, light by albedo, and 1 for the channels that have such light.
const KEY: usize = 0;
const POSITION: usize = 1;
const NORMAL: usize = 4;
const LIGHT: usize = 7;
const COUNTED: usize = 10;
const PLANES: usize = 13;

/// Key of the first material: a key is a float, whose comparisons are those of its bits, and which is no subnormal, because those are slow.
const FIRST_KEY: u32 = 0x0080_0000;
/// Materials with a key of their own, below infinity.
const MAX_MATERIALS: usize = (0x7f80_0000 - FIRST_KEY) as usize;

/// Filters `input` to `output`; all arrays have the lengths that [`FilterIndirectParams::check`] asks for.
///
/// # Errors
/// [`Error::OutOfMemory`], [`Error::LimitExceeded`] beyond 2³¹ materials.
pub(crate) fn filter_indirect(
    isa: Isa,
    gbuffer: &[GBufferTexel],
    diffuse: &[u32],
    input: &[RadianceTexel],
    params: &FilterIndirectParams,
    output: &mut [RadianceTexel],
) -> Result<()> {
    if output.is_empty() {
        return Ok(());
    }
    if diffuse.len() > MAX_MATERIALS {
        return Err(Error::limit("materials", diffuse.len() as u64, MAX_MATERIALS as u64));
    }
    let picture = Picture { gbuffer, diffuse, input, params };
    let planes = Planes::new(isa, &picture)?;
    fill_chunks(isa, PIXELS, output, |first, texels| Filter { picture, planes: &planes, first, texels });
    Ok(())
}

#[derive(Clone, Copy)]
struct Picture<'a> {
    gbuffer: &'a [GBufferTexel],
    diffuse: &'a [u32],
    input: &'a [RadianceTexel],
    params: &'a FilterIndirectParams,
}

impl Picture<'_> {
    /// Whether a pixel shows a diffuse surface.
    #[inline(always)]
    fn is_diffuse(&self, texel: &GBufferTexel) -> bool {
        texel.triangle != NO_HIT
            && self.diffuse.get(texel.material as usize).is_some_and(|&diffuse| diffuse != 0)
    }
}

/// What neighbours are asked for. Beside a row's pixels lie some that show nothing, so that windows and vectors may leave it.
struct Planes {
    values: Vec<f32>,
    /// Floats from one plane to the next.
    stride: usize,
    /// Pixels before a row's first.
    lead: usize,
}

impl Planes {
    fn new(isa: Isa, picture: &Picture<'_>) -> Result<Self> {
        let (width, height) = (picture.params.width as usize, picture.params.height as usize);
        let lead = reach(picture.params.window) as usize;
        let stride = lead + width + lead + LANES - 1;
        let mut values = try_zeroed((stride * PLANES).saturating_mul(height))?;
        fill_chunks(isa, stride * PLANES, &mut values, |first, row| {
            let begin = first / (stride * PLANES) * width;
            PlanesOfRow { picture, begin, stride, lead, row }
        });
        Ok(Self { values, stride, lead })
    }

    /// Eight pixels of a plane from `column` on, which may be negative by as much as windows reach.
    #[inline(always)]
    fn load<W: Width>(&self, width: W, row: usize, plane: usize, column: isize) -> W::F8 {
        let begin = (row * PLANES + plane) * self.stride + self.lead;
        let begin = begin.wrapping_add_signed(column);
        let mut lanes = [0.0; LANES];
        lanes.copy_from_slice(&self.values[begin..begin + LANES]);
        W::F8::load(width, &lanes)
    }

    #[inline(always)]
    fn load_vector<W: Width>(&self, width: W, row: usize, plane: usize, column: isize) -> Vector<W> {
        let (x, y) = (self.load(width, row, plane, column), self.load(width, row, plane + 1, column));
        [x, y, self.load(width, row, plane + 2, column)]
    }
}

struct PlanesOfRow<'a> {
    picture: &'a Picture<'a>,
    /// First pixel of the row.
    begin: usize,
    stride: usize,
    lead: usize,
    row: &'a mut [f32],
}

impl Kernel for PlanesOfRow<'_> {
    type Output = ();

    #[inline(always)]
    fn run<W: Width>(self, _: W) {
        let Self { picture, begin, stride, lead, row } = self;
        for column in 0..picture.params.width as usize {
            let (texel, light) = (&picture.gbuffer[begin + column], &picture.input[begin + column]);
            if !picture.is_diffuse(texel) {
                continue;
            }
            let mut set = |plane: usize, value: f32| row[plane * stride + lead + column] = value;
            set(KEY, f32::from_bits(FIRST_KEY + texel.material));
            for c in 0..3 {
                set(POSITION + c, texel.position[c]);
                set(NORMAL + c, texel.shading_normal[c]);
                if texel.albedo[c] >= LEAST_ALBEDO {
                    // [1] light by albedo
                    set(LIGHT + c, light.rgb[c] / texel.albedo[c]);
                    set(COUNTED + c, 1.0);
                }
            }
        }
    }
}

struct Filter<'a> {
    picture: Picture<'a>,
    planes: &'a Planes,
    first: usize,
    texels: &'a mut [RadianceTexel],
}

impl Kernel for Filter<'_> {
    type Output = ();

    #[inline(always)]
    fn run<W: Width>(self, width: W) {
        let row_len = self.picture.params.width as usize;
        let mut at = 0;
        while at < self.texels.len() {
            let pixel = self.first + at;
            let column = pixel % row_len;
            let count = LANES.min(row_len - column).min(self.texels.len() - at);
            let texels = &mut self.texels[at..at + count];
            filter_pixels(width, &self.picture, self.planes, pixel, column, texels);
            at += count;
        }
    }
}

type Vector<W> = [<W as Width>::F8; 3];

/// What is the same for all neighbours of eight pixels.
struct Centre<W: Width> {
    key: W::F8,
    position: Vector<W>,
    shading_normal: Vector<W>,
    geometric_normal: Vector<W>,
    least_cosine: W::F8,
    /// Greatest distance from the pixel's plane.
    reach: W::F8,
}

/// Sums over joined neighbours, per channel.
struct Sums<W: Width> {
    light: Vector<W>,
    weight: Vector<W>,
}

#[inline(always)]
fn filter_pixels<W: Width>(
    width: W,
    picture: &Picture<'_>,
    planes: &Planes,
    first: usize,
    column: usize,
    texels: &mut [RadianceTexel],
) {
    let own = first..first + texels.len();
    let (gbuffer, input) = (&picture.gbuffer[own.clone()], &picture.input[own]);
    // [2] pixels that show no diffuse surface
    for (texel, light) in texels.iter_mut().zip(input) {
        *texel = RadianceTexel { rgb: light.rgb, padding: 0 };
    }
    if !gbuffer.iter().any(|texel| picture.is_diffuse(texel)) {
        return;
    }
    let row = first / picture.params.width as usize;
    let centre = centre_of(width, picture.params, planes, row, column, gbuffer);
    let sums = sum_neighbours(width, picture.params, planes, &centre, row, column);
    // [4] light of the pixel
    for c in 0..3 {
        let (light, weight) = (sums.light[c].to_array(), sums.weight[c].to_array());
        for (lane, (surface, texel)) in gbuffer.iter().zip(&mut *texels).enumerate() {
            let albedo = surface.albedo[c];
            if picture.is_diffuse(surface) && albedo >= LEAST_ALBEDO && weight[lane] > 0.0 {
                texel.rgb[c] = albedo * light[lane] / weight[lane];
            }
        }
    }
}

#[inline(always)]
fn centre_of<W: Width>(
    width: W,
    params: &FilterIndirectParams,
    planes: &Planes,
    row: usize,
    column: usize,
    gbuffer: &[GBufferTexel],
) -> Centre<W> {
    let widest = params.footprint * params.window as f32;
    let (mut normal, mut reach) = ([[0.0; LANES]; 3], [0.0; LANES]);
    for (lane, texel) in gbuffer.iter().enumerate() {
        for (lanes, value) in normal.iter_mut().zip(texel.geometric_normal) {
            lanes[lane] = value;
        }
        reach[lane] = widest * texel.depth;
    }
    let [x, y, z] = &normal;
    let column = column as isize;
    Centre {
        key: planes.load(width, row, KEY, column),
        position: planes.load_vector(width, row, POSITION, column),
        shading_normal: planes.load_vector(width, row, NORMAL, column),
        geometric_normal: [W::F8::load(width, x), W::F8::load(width, y), W::F8::load(width, z)],
        least_cosine: W::F8::splat(width, params.least_cosine),
        reach: W::F8::load(width, &reach),
    }
}

#[inline(always)]
fn sum_neighbours<W: Width>(
    width: W,
    params: &FilterIndirectParams,
    planes: &Planes,
    centre: &Centre<W>,
    row: usize,
    column: usize,
) -> Sums<W> {
    let zero = W::F8::splat(width, 0.0);
    let mut sums = Sums { light: [zero; 3], weight: [zero; 3] };
    // [3] sums over joined neighbours
    let reach = reach(params.window);
    for j in -reach..=reach {
        let Some(row) = row.checked_add_signed(j).filter(|&row| row < params.height as usize) else {
            continue;
        };
        for i in -reach..=reach {
            let column = column as isize + i;
            let joined = is_joined(width, planes, centre, row, column);
            if joined.bits() == 0 {
                continue;
            }
            let weight =
                W::F8::splat(width, window_weight(j, params.window) * window_weight(i, params.window));
            let light = planes.load_vector(width, row, LIGHT, column);
            let counted = planes.load_vector(width, row, COUNTED, column);
            for c in 0..3 {
                sums.light[c] = sums.light[c] + (weight * light[c]).select(joined, zero);
                sums.weight[c] = sums.weight[c] + (weight * counted[c]).select(joined, zero);
            }
        }
    }
    sums
}

/// Whether the pixels from `column` on show the surfaces of the centre.
#[inline(always)]
fn is_joined<W: Width>(
    width: W,
    planes: &Planes,
    centre: &Centre<W>,
    row: usize,
    column: isize,
) -> <W::F8 as Lanes>::Mask {
    let key = planes.load(width, row, KEY, column);
    let position = planes.load_vector(width, row, POSITION, column);
    let normal = planes.load_vector(width, row, NORMAL, column);
    let from = centre.position;
    let along = [position[0] - from[0], position[1] - from[1], position[2] - from[2]];
    let distance = dot::<W>(centre.geometric_normal, along).abs();
    key.le(centre.key)
        & centre.key.le(key)
        & centre.least_cosine.le(dot::<W>(centre.shading_normal, normal))
        & distance.le(centre.reach)
}

/// In the order of glam's.
#[inline(always)]
fn dot<W: Width>(a: Vector<W>, b: Vector<W>) -> W::F8 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Weight of a neighbour's row or column.
#[inline(always)]
fn window_weight(offset: isize, window: u32) -> f32 {
    if 2 * offset.unsigned_abs() < window as usize { 1.0 } else { 0.5 }
}

/// How far windows reach from their centre, pixels.
#[inline(always)]
fn reach(window: u32) -> isize {
    (window / 2) as isize
}
