//! Bugs in `filter_indirect`: the filter on the host, wrong in one step.

use crate::faults::Fault;
use crate::oracle::filter_indirect::Picture;
use glam::Vec3;
use twinlight_core::kernels::filter_indirect::{FilterIndirectParams, LEAST_ALBEDO, RadianceTexel};
use twinlight_core::kernels::shade_primary::GBufferTexel;
use twinlight_core::kernels::trace::NO_HIT;
use twinlight_core::{Backend, Result};

pub(super) fn filter_indirect<B: Backend>(
    inner: &B,
    fault: Fault,
    gbuffer: &B::Buffer<GBufferTexel>,
    diffuse: &B::Buffer<u32>,
    input: &B::Buffer<RadianceTexel>,
    params: &FilterIndirectParams,
    output: &mut B::Buffer<RadianceTexel>,
) -> Result<()> {
    let lengths = [inner.len(gbuffer), inner.len(input), inner.len(output)];
    let fits = params.check(lengths).is_ok();
    if fault == Fault::FilterAcceptsAnything && !fits {
        return Ok(());
    }
    if !fits || !is_of_filters(fault) {
        return inner.filter_indirect(gbuffer, diffuse, input, params, output);
    }
    let picture = Picture {
        params: *params,
        gbuffer: inner.download(gbuffer)?,
        diffuse: inner.download(diffuse)?,
        input: inner.download(input)?,
    };
    let before = inner.download(output)?;
    *output = inner.upload(&broken(fault, picture, &before))?;
    Ok(())
}

fn is_of_filters(fault: Fault) -> bool {
    crate::faults::FAULTS.iter().any(|(of, kernel, _)| *of == fault && *kernel == "filter_indirect")
}

fn broken(fault: Fault, picture: Picture, before: &[RadianceTexel]) -> Vec<RadianceTexel> {
    let filter = |picture, along| Broken { fault, picture, along }.filtered();
    let mut texels = match fault {
        Fault::FilterSeparated => {
            let rows = filter(picture.clone(), [true, false]);
            filter(Picture { input: rows, ..picture }, [false, true])
        }
        _ => filter(picture, [true, true]),
    };
    let count = texels.len();
    for (at, (texel, before)) in texels.iter_mut().zip(before).enumerate() {
        match fault {
            Fault::FilterLosesLast if at > 256 && at + 1 == count => *texel = *before,
            Fault::FilterKeepsPadding => texel.padding = before.padding,
            Fault::FilterAdds => texel.rgb = [0, 1, 2].map(|c| texel.rgb[c] + before.rgb[c]),
            Fault::FilterSwapsChannels => texel.rgb.swap(0, 2),
            _ => {}
        }
    }
    texels
}

struct Broken {
    fault: Fault,
    picture: Picture,
    /// Whether windows reach along rows, and along columns.
    along: [bool; 2],
}

impl Broken {
    fn filtered(mut self) -> Vec<RadianceTexel> {
        let mut texels = self.picture.input.clone();
        for (at, texel) in texels.iter_mut().enumerate() {
            *texel = self.texel(at);
            if self.fault == Fault::FilterInPlace {
                self.picture.input[at] = *texel;
            }
        }
        texels
    }

    fn texel(&self, at: usize) -> RadianceTexel {
        let mut texel = self.picture.input[at];
        let p = &self.picture.gbuffer[at];
        if self.is_copied(p) {
            return texel;
        }
        let window = self.window(at);
        for c in 0..3 {
            let albedo = p.albedo[c];
            if albedo >= LEAST_ALBEDO {
                texel.rgb[c] = self.sums(p, c, &window).map_or(texel.rgb[c], |sums| self.lit(albedo, sums));
            } else if self.fault == Fault::FilterBlackens {
                texel.rgb[c] = 0.0;
            }
        }
        texel
    }

    fn is_copied(&self, p: &GBufferTexel) -> bool {
        let entry = self.picture.diffuse.get(p.material as usize);
        let is_diffuse = match self.fault {
            Fault::FilterGlossy => entry.is_some(),
            Fault::FilterTrustsMaterials => entry.is_none_or(|entry| *entry != 0),
            _ => entry.is_some_and(|entry| *entry != 0),
        };
        let is_seen = p.triangle != NO_HIT || self.fault == Fault::FilterNothing;
        !is_seen || !is_diffuse || self.fault == Fault::FilterCopies
    }

    fn lit(&self, albedo: f32, (light, weights): (f32, f32)) -> f32 {
        match self.fault {
            Fault::FilterLosesAlbedo | Fault::FilterBlursTextures => light / weights,
            Fault::FilterDims => albedo * light / weights * 0.999,
            _ => albedo * light / weights,
        }
    }

    /// Sums of a channel's irradiance and of weights, if there are any.
    fn sums(&self, p: &GBufferTexel, c: usize, window: &[(usize, f32)]) -> Option<(f32, f32)> {
        let (mut light, mut weights) = (0.0_f32, 0.0_f32);
        for &(at, weight) in window {
            let q = &self.picture.gbuffer[at];
            let has_albedo = match self.fault {
                Fault::FilterOneChannelDecides => q.albedo[0] >= LEAST_ALBEDO,
                Fault::FilterLeastIsTooLittle => q.albedo[c] > LEAST_ALBEDO,
                Fault::FilterCountsBlack => true,
                _ => q.albedo[c] >= LEAST_ALBEDO,
            };
            let irradiance = self.irradiance(at, c);
            let is_sound = self.fault != Fault::FilterDropsInfinite || irradiance.is_finite();
            if self.is_joined(p, q) && has_albedo && is_sound {
                light += weight * irradiance;
                weights += weight;
            } else if self.fault == Fault::FilterMasks {
                light += weight * 0.0 * self.picture.input[at].rgb[c];
            } else if self.fault == Fault::FilterWholeWindow {
                weights += weight;
            }
        }
        (weights > 0.0 || self.fault == Fault::FilterDividesByNothing).then_some((light, weights))
    }

    fn irradiance(&self, at: usize, c: usize) -> f32 {
        let (light, albedo) = (self.picture.input[at].rgb[c], self.picture.gbuffer[at].albedo[c]);
        match self.fault {
            Fault::FilterBlursTextures => light,
            Fault::FilterCountsBlack if !(albedo >= LEAST_ALBEDO) => 0.0,
            _ => light / albedo,
        }
    }

    fn is_joined(&self, p: &GBufferTexel, q: &GBufferTexel) -> bool {
        let params = &self.picture.params;
        let is_seen = q.triangle != NO_HIT || self.fault == Fault::FilterJoinsNothing;
        let is_same = q.material == p.material || self.fault == Fault::FilterIgnoresMaterials;
        is_seen && is_same && self.faces(p, q, params.least_cosine) && self.is_near(p, q)
    }

    fn faces(&self, p: &GBufferTexel, q: &GBufferTexel, least: f32) -> bool {
        let cosine = |a: [f32; 3], b: [f32; 3]| Vec3::from(a).dot(b.into());
        match self.fault {
            Fault::FilterIgnoresNormals => true,
            Fault::FilterFlatNormals => cosine(p.geometric_normal, q.geometric_normal) >= least,
            Fault::FilterAnySide => cosine(p.shading_normal, q.shading_normal).abs() >= least,
            Fault::FilterCosineExclusive => cosine(p.shading_normal, q.shading_normal) > least,
            _ => cosine(p.shading_normal, q.shading_normal) >= least,
        }
    }

    fn is_near(&self, p: &GBufferTexel, q: &GBufferTexel) -> bool {
        let params = &self.picture.params;
        let apart = Vec3::from(q.position) - Vec3::from(p.position);
        let normal = match self.fault {
            Fault::FilterShadingPlane => p.shading_normal,
            Fault::FilterNeighboursPlane => q.geometric_normal,
            _ => p.geometric_normal,
        };
        let signed = Vec3::from(normal).dot(apart);
        let height = match self.fault {
            Fault::FilterOneSidedPlane => signed,
            Fault::FilterDistance => apart.length(),
            _ => signed.abs(),
        };
        let limit = match self.fault {
            Fault::FilterLimitPerPixel => params.footprint * p.depth,
            Fault::FilterLimitWithoutDepth => params.footprint * params.window as f32,
            Fault::FilterNeighboursDepth => params.footprint * params.window as f32 * q.depth,
            _ => params.footprint * params.window as f32 * p.depth,
        };
        match self.fault {
            Fault::FilterIgnoresPlanes => true,
            Fault::FilterPlaneExclusive => height < limit,
            _ => height <= limit,
        }
    }

    /// Pixels around one, with their weights.
    fn window(&self, at: usize) -> Vec<(usize, f32)> {
        let [rows, columns] = self.along.map(|along| if along { self.steps() } else { vec![(0, 1.0)] });
        let steps =
            columns.iter().flat_map(|&(j, down)| rows.iter().map(move |&(i, across)| (i, j, down * across)));
        steps.filter_map(|(i, j, weight)| Some((self.neighbour(at, i, j)?, weight))).collect()
    }

    /// Steps along an axis, with their weights.
    fn steps(&self) -> Vec<(i64, f32)> {
        let n = i64::from(self.picture.params.window);
        let range = match self.fault {
            Fault::FilterWide => -(n / 2) - 1..=n / 2 + 1,
            Fault::FilterAhead => -(n / 2)..=(n - 1) / 2,
            Fault::FilterNarrow => -((n - 1) / 2)..=(n - 1) / 2,
            Fault::FilterCapped => -(n / 2).min(15)..=(n / 2).min(15),
            _ => -(n / 2)..=n / 2,
        };
        let is_whole = [Fault::FilterBox, Fault::FilterAhead].contains(&self.fault);
        let weight = |step: i64| match 2 * step.abs() == n && !is_whole {
            true if self.fault == Fault::FilterQuarters => 0.25,
            true => 0.5,
            false => 1.0,
        };
        range.map(|step| (step, weight(step))).collect()
    }

    fn neighbour(&self, at: usize, i: i64, j: i64) -> Option<usize> {
        let params = &self.picture.params;
        let [x, y] = self.picture.place(at);
        let ends = [params.width, params.height].map(|size| i64::from(size) - 1);
        match self.fault {
            Fault::FilterClamps => self.picture.pixel((x + i).clamp(0, ends[0]), (y + j).clamp(0, ends[1])),
            Fault::FilterWraps => usize::try_from(at as i64 + j * (ends[0] + 1) + i)
                .ok()
                .filter(|at| *at < self.picture.input.len()),
            Fault::FilterDropsBorder => {
                let inside = x + i > 0 && y + j > 0 && x + i < ends[0] && y + j < ends[1];
                self.picture.pixel(x + i, y + j).filter(|_| inside || (i, j) == (0, 0))
            }
            _ => self.picture.pixel(x + i, y + j),
        }
    }
}
