//! The rays of a path tracer in a scene.

use glam::Vec3;
use std::io::{self, BufWriter, Write};
use twinlight_backend_cpu::bvh8::{NO_SLOT, WideBvh};
use twinlight_backend_cpu::simd::{Kernel, Width, detect, dispatch};
use twinlight_core::kernels::trace::{NO_HIT, Ray};
use twinlight_core::kernels::trace_paths::CameraRecord;
use twinlight_core::math::vector::{basis, concentric_disc, to_world};
use twinlight_core::scene::{Camera, CompiledScene, Scene};
use twinlight_core::transport::SceneView;
use twinlight_core::transport::light::FAR;
use twinlight_core::transport::offset::offset_origin;
use twinlight_core::transport::surface::{camera_direction, surface_at};
use twinlight_fixtures::random::Random;

/// Pixels per side of the picture whose rays are taken.
const SIZE: u32 = 512;

/// Bounces followed per pixel.
const BOUNCES: usize = 4;

pub struct Rays {
    /// From surfaces in cosine-distributed directions, path after path.
    pub bounce: Vec<Ray>,
    /// From the camera through pixels, row after row.
    pub camera: Vec<Ray>,
    /// From surfaces to points under the ceiling.
    pub shadow: Vec<Ray>,
}

struct Collect<'a> {
    scene: SceneView<'a>,
    wide: &'a WideBvh,
    camera: CameraRecord,
    lamp: Vec3,
}

pub fn bounce_rays(source: &Scene, scene: &CompiledScene, wide: &WideBvh) -> twinlight_core::Result<Rays> {
    let camera = Camera::of_scene(source).unwrap_or_else(|| Camera::framing(default_bounds()));
    let (low, high) = (Vec3::from(scene.bounds.0), Vec3::from(scene.bounds.1));
    let mut lamp = (low + high) * 0.5;
    lamp.y = low.y + (high.y - low.y) * 0.9;
    let record = camera.record(SIZE, SIZE, scene.origin)?;
    Ok(dispatch(detect(), Collect { scene: scene.into(), wide, camera: record, lamp }))
}

fn default_bounds() -> (glam::DVec3, glam::DVec3) {
    (glam::DVec3::NEG_ONE, glam::DVec3::ONE)
}

impl Kernel for Collect<'_> {
    type Output = Rays;

    #[inline(always)]
    fn run<W: Width>(self, width: W) -> Rays {
        let mut random = Random::new(7);
        let mut unit = || random.unit() as f32;
        let mut rays = Rays { bounce: Vec::new(), camera: Vec::new(), shadow: Vec::new() };
        for pixel in 0..SIZE * SIZE {
            let (x, y) = ((pixel % SIZE) as f32 + 0.5, (pixel / SIZE) as f32 + 0.5);
            let mut origin = Vec3::from(self.camera.position);
            let mut direction = camera_direction(&self.camera, x, y);
            rays.camera.push(ray(origin, direction, FAR));
            for _ in 0..BOUNCES {
                let hit = self.wide.closest(width, origin, direction, 0.0, FAR);
                if hit.slot == NO_SLOT {
                    break;
                }
                let surface = surface_at(&self.scene, hit.slot, hit.u, hit.v, direction);
                let normal = surface.geometric_normal;
                let (tangent, bitangent) = basis(normal);
                let (a, b) = concentric_disc(unit(), unit());
                let up = (1.0 - a * a - b * b).max(0.0).sqrt();
                direction = to_world(tangent, bitangent, normal, Vec3::new(a, b, up));
                origin = offset_origin(surface.position, surface.offset, normal, direction);
                rays.bounce.push(ray(origin, direction, FAR));
                let target = self.lamp + Vec3::new(unit() - 0.5, 0.0, unit() - 0.5) * 0.5;
                rays.shadow.push(ray(origin, target - origin, 0.999));
            }
        }
        rays
    }
}

fn ray(origin: Vec3, direction: Vec3, t_max: f32) -> Ray {
    Ray { origin: origin.into(), t_min: 0.0, direction: direction.into(), t_max }
}

struct Hits<'a>(&'a CompiledScene, &'a WideBvh, &'a [Ray]);

impl Kernel for Hits<'_> {
    type Output = Vec<[u32; 4]>;

    #[inline(always)]
    fn run<W: Width>(self, width: W) -> Vec<[u32; 4]> {
        let mut hits = Vec::with_capacity(self.2.len());
        for r in self.2 {
            let hit = self.1.closest(width, r.origin.into(), r.direction.into(), r.t_min, r.t_max);
            let id = if hit.slot == NO_SLOT { NO_HIT } else { self.0.triangles[hit.slot as usize].id };
            hits.push([hit.t.to_bits(), hit.u.to_bits(), hit.v.to_bits(), id]);
        }
        hits
    }
}

/// Writes the scene, the rays and the hits.
pub fn dump(file: &str, scene: &CompiledScene, wide: &WideBvh, rays: &Rays) -> io::Result<()> {
    let mut out = BufWriter::new(std::fs::File::create(file)?);
    let mut by_id: Vec<_> = scene.triangles.iter().collect();
    by_id.sort_by_key(|t| t.id);
    for count in [by_id.len(), rays.bounce.len(), rays.shadow.len()] {
        out.write_all(&(count as u32).to_le_bytes())?;
    }
    for t in by_id {
        out.write_all(bytemuck::bytes_of(&[t.p0, t.p1, t.p2]))?;
    }
    out.write_all(bytemuck::cast_slice(&rays.bounce))?;
    out.write_all(bytemuck::cast_slice(&rays.shadow))?;
    out.flush()?;
    let hits = dispatch(detect(), Hits(scene, wide, &rays.bounce));
    std::fs::write(format!("{file}.hits"), bytemuck::cast_slice(&hits))
}
