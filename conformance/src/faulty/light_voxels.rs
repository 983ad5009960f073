//! Bugs in `light_voxels`: light on voxels on the host, wrong in one step.

use super::FaultyScene;
use crate::faults::Fault;
use crate::oracle::trace::occluded_as_written;
use glam::Vec3;
use twinlight_core::kernels::filter_indirect::RadianceTexel;
use twinlight_core::kernels::light_voxels::LightVoxelsBlock;
use twinlight_core::kernels::reduce_mips::{OPAQUE, VoxelLight};
use twinlight_core::kernels::sum_voxels::VoxelSums;
use twinlight_core::kernels::trace::Ray;
use twinlight_core::math::vector::normalized;
use twinlight_core::scene::{CompiledScene, NOTHING_HIDES};
use twinlight_core::transport::light::{FAR, spheres_occlude};
use twinlight_core::transport::voxel_light::{
    VoxelPoint, VoxelSample, voxel_leaf, voxel_point, voxel_sample,
};
use twinlight_core::transport::{PI, SceneView};
use twinlight_core::{Backend, Result};

/// What is known of voxels, on a device.
pub(super) struct Voxels<'a, B: Backend> {
    pub active: &'a B::Buffer<u32>,
    pub sums: &'a B::Buffer<VoxelSums>,
    pub gathered: &'a B::Buffer<RadianceTexel>,
}

pub(super) fn light_voxels<B: Backend>(
    inner: &B,
    fault: Fault,
    scene: &FaultyScene<B::Scene>,
    voxels: Voxels<'_, B>,
    params: &LightVoxelsBlock,
    leaves: &mut B::Buffer<VoxelLight>,
) -> Result<()> {
    let Voxels { active, sums, gathered } = voxels;
    let lengths = [inner.len(active), inner.len(sums), inner.len(gathered), inner.len(leaves)];
    if fault == Fault::LightAcceptsAnything && params.check(lengths).is_err() {
        return Ok(());
    }
    let before = inner.download(leaves)?;
    inner.light_voxels(&scene.inner, active, sums, gathered, params, leaves)?;
    if !crate::faults::FAULTS.iter().any(|(of, kernel, _)| *of == fault && *kernel == "light_voxels") {
        return Ok(());
    }
    let (active, sums) = (inner.download(active)?, inner.download(sums)?);
    let gathered = inner.download(gathered)?;
    let broken = Broken { fault, scene: &scene.host, params: *params };
    let light = |i: usize| gathered.get(i).map_or(Vec3::ZERO, |texel| Vec3::from(texel.rgb));
    let mut lit: Vec<VoxelLight> =
        (0..active.len()).map(|i| broken.leaf(active[i], sums[i], light(i))).collect();
    match fault {
        Fault::LightReverses => lit.reverse(),
        Fault::LightLosesLast if lit.len() > 256 => lit[active.len() - 1] = before[active.len() - 1],
        _ => {}
    }
    *leaves = inner.upload(&lit)?;
    Ok(())
}

struct Broken<'a> {
    fault: Fault,
    scene: &'a CompiledScene,
    params: LightVoxelsBlock,
}

impl Broken<'_> {
    fn leaf(&self, code: u32, mut sums: VoxelSums, gathered: Vec3) -> VoxelLight {
        if sums.count == 0 {
            let opacity = if self.fault == Fault::LightEmptyIsOpaque { OPAQUE } else { 0 };
            return VoxelLight { opacity, ..VoxelLight::default() };
        }
        if self.fault == Fault::LightAlbedoAtMostOne {
            let most = sums.count.saturating_mul(4095);
            sums.albedo = sums.albedo.map(|a| a.min(most));
        }
        let point = self.point(code, &sums);
        let samples = self.params.samples.max(1) as f32;
        let mut light = self.irradiance(&point, code);
        if self.fault != Fault::LightSumsSamples {
            light *= 1.0 / samples;
        }
        match self.fault {
            Fault::LightLosesGathered | Fault::LightGatheredWithoutAlbedo => {}
            Fault::LightGatheredPerSample => light += gathered / samples,
            _ => light += gathered,
        }
        let past = if self.fault == Fault::LightGatheredWithoutAlbedo { gathered } else { Vec3::ZERO };
        self.quantized(&VoxelPoint { emission: point.emission + past, ..point }, light)
    }

    fn point(&self, code: u32, sums: &VoxelSums) -> VoxelPoint {
        let mut point = voxel_point(&self.params, code, sums);
        let count = sums.count as f32;
        match self.fault {
            Fault::LightNoPi => point.reflectance *= PI,
            Fault::LightEmissionAddsUp => point.emission *= count,
            Fault::LightEmissionUnscaled if self.params.emission_unit > 0.0 => {
                point.emission *= 1.0 / self.params.emission_unit;
            }
            Fault::LightAlbedoAddsUp => point.reflectance *= count,
            Fault::LightAlbedoOf4096 => point.reflectance *= 4095.0 / 4096.0,
            Fault::LightCornerOfVoxel => point.centre -= Vec3::splat(0.5 * point.width),
            Fault::LightSwapsAxes => {
                let corner = Vec3::from(self.params.frame.corner);
                let from_corner = point.centre - corner;
                point.centre = corner + Vec3::new(from_corner.z, from_corner.y, from_corner.x);
            }
            _ => {}
        }
        point
    }

    /// Sum over the samples.
    fn irradiance(&self, point: &VoxelPoint, code: u32) -> Vec3 {
        let view = SceneView::from(self.scene);
        if view.environment.light_count == 0 {
            return Vec3::ZERO;
        }
        let mut params = self.params;
        if self.fault == Fault::LightIgnoresSeed {
            params.seed = 0;
        }
        let code = if self.fault == Fault::LightIgnoresCode { 0 } else { code };
        let skipped = u32::from(self.fault == Fault::LightSkipsLastSample);
        let mut sum = Vec3::ZERO;
        for sample in 0..params.samples.saturating_sub(skipped) {
            let mut light = voxel_sample(&view, &params, point, code, sample);
            self.distort(point, &mut light);
            if light.irradiance != Vec3::ZERO && !self.is_shadowed(&view, &light) {
                sum += light.irradiance;
            }
        }
        sum
    }

    fn distort(&self, point: &VoxelPoint, light: &mut VoxelSample) {
        let is_far = light.reach == FAR;
        let way = if is_far { light.direction } else { light.origin + light.direction - point.centre };
        let facing = point.normal.dot(normalized(way));
        let has_normal = point.normal != Vec3::ZERO;
        match self.fault {
            Fault::LightOneSide if facing < 0.0 => light.irradiance = Vec3::ZERO,
            Fault::LightNoCosine if has_normal && facing != 0.0 => light.irradiance /= facing.abs(),
            Fault::LightFullWithoutNormal if !has_normal => light.irradiance *= 2.0,
            Fault::LightBlackWithoutNormal if !has_normal => light.irradiance = Vec3::ZERO,
            Fault::LightForgetsSelection => {
                light.irradiance *= self.scene.lights[light.light as usize].select_pdf;
            }
            Fault::LightFirstLightOnly if light.light != 0 => light.irradiance = Vec3::ZERO,
            _ => {}
        }
        let lift = light.origin - point.centre;
        let lift = match self.fault {
            Fault::LightNoLift => Vec3::ZERO,
            Fault::LightLiftsAway => -lift,
            Fault::LightLiftsFar => lift * 1.6,
            Fault::LightLiftsAlongNormal if facing < 0.0 => -lift,
            _ => return,
        };
        light.origin = point.centre + lift;
        light.direction = if is_far { light.direction } else { way - lift };
    }

    fn is_shadowed(&self, view: &SceneView<'_>, light: &VoxelSample) -> bool {
        let reach = if self.fault == Fault::LightShadowedFromBeyond { FAR } else { light.reach };
        let ray = Ray {
            origin: light.origin.to_array(),
            t_min: 0.0,
            direction: light.direction.to_array(),
            t_max: reach,
        };
        let nothing = self.fault == Fault::LightNoShadow;
        let hides = self.scene.environment.flags & NOTHING_HIDES == 0;
        let hides = hides || self.fault == Fault::LightShadowsAnyway;
        let triangles = hides && !nothing && self.fault != Fault::LightTrianglesDontShadow;
        let spheres = !nothing && self.fault != Fault::LightSpheresDontShadow;
        (triangles && occluded_as_written(&self.scene.triangles, &ray) == 1)
            || (spheres && spheres_occlude(view, light.origin, light.direction, reach, light.light))
    }

    fn quantized(&self, point: &VoxelPoint, irradiance: Vec3) -> VoxelLight {
        let sound = voxel_leaf(&self.params, point, irradiance);
        let units = (point.reflectance * irradiance + point.emission) * self.params.scale;
        match self.fault {
            Fault::LightTransparent => VoxelLight { opacity: 0, ..sound },
            // Casts saturate, and make 0 of what is negative.
            Fault::LightTruncates => {
                let rgb = units.to_array().map(|x| x as u32);
                VoxelLight { rgb: [0, 1, 2].map(|c| rgb[c].min(sound.rgb[c])), ..sound }
            }
            Fault::LightWithoutLimit => {
                VoxelLight { rgb: units.to_array().map(|x| (x + 0.5) as u32), ..sound }
            }
            _ => sound,
        }
    }
}
