//! Doing what a plan says.

use crate::plan::{Plan, Sampling};
use crate::reference::{self, Control, Film, Progress, Rendered, Settings, StopReason};
use crate::slhb::{self, Buffers, Kept};
use crate::voxel::{self, Lit};
use std::time::{Duration, Instant};
use twinlight_core::kernels::shade_primary::GBufferTexel;
use twinlight_core::kernels::trace_paths::FilmTexel;
use twinlight_core::scene::{Camera, CompiledScene};
use twinlight_core::{Backend, Result};

/// What a plan builds of a scene before pixels are sampled.
pub struct Built<B: Backend> {
    /// Hit buffers, if rays are looked up.
    pub buffers: Option<Buffers<B>>,
    /// Lit voxels, if cones gather.
    pub voxels: Option<Lit<B>>,
}

/// What the camera sees, and what is made with it.
pub struct Surfaces {
    /// The G-buffer.
    pub gbuffer: Vec<GBufferTexel>,
    /// Time for it.
    pub gbuffer_time: Duration,
    /// The picture, where it is more than the samples' mean.
    pub made: Option<Made>,
    /// Time for that.
    pub made_time: Duration,
}

/// A picture whose indirect light is averaged over pixels, or comes through cones.
#[derive(Debug, Clone, PartialEq)]
pub struct Made {
    /// Of both kinds of light.
    pub radiance: Vec<[f32; 3]>,
    /// Of indirect light.
    pub indirect: Vec<[f32; 3]>,
}

/// A finished picture.
pub struct Picture {
    /// The samples.
    pub rendered: Rendered,
    /// What the camera sees.
    pub surfaces: Surfaces,
}

impl Picture {
    /// Mean radiance per pixel, W·sr⁻¹·m⁻².
    pub fn radiance(&self) -> Vec<[f32; 3]> {
        match &self.surfaces.made {
            Some(made) => made.radiance.clone(),
            None => self.rendered.film.radiance(),
        }
    }
}

impl Plan {
    /// Does all that the plan says. `scene` is the scene that the plan was made for; what the plan leaves out of it is left out here.
    ///
    /// # Errors
    /// What the parts refuse: [`Plan::build`], [`Plan::sample`], [`Plan::surfaces`].
    ///
    /// ```
    /// use twinlight_backend_cpu::CpuBackend;
    /// use twinlight_core::scene::{Camera, Limits, compile};
    /// use twinlight_methods::plan::{Effects, Method, Plan, Request};
    /// use twinlight_methods::reference::{Control, Settings};
    /// use twinlight_methods::voxel::VoxelSettings;
    ///
    /// # fn main() -> twinlight_core::Result<()> {
    /// let room = twinlight_fixtures::scenes::builtin("cornell").expect("there is one");
    /// let compiled = compile(&room, &Limits::default())?;
    /// let camera = Camera::of_scene(&room).expect("it has one");
    /// let request = Request {
    ///     method: Method::Voxel(VoxelSettings { grid: 16, ..VoxelSettings::default() }),
    ///     picture: Settings { width: 8, height: 8, samples: 4, ..Settings::default() },
    ///     effects: Effects::Auto,
    ///     tolerance: 1.0 / 255.0,
    /// };
    /// let plan = Plan::new(&compiled, &camera, &request)?;
    /// let picture = plan.run(&CpuBackend::new(), &compiled, &camera, |_| Control::Continue)?;
    /// assert!(picture.radiance().iter().flatten().any(|&radiance| radiance > 0.0));
    /// # Ok(())
    /// # }
    /// ```
    pub fn run<B: Backend>(
        &self,
        backend: &B,
        scene: &CompiledScene,
        camera: &Camera,
        observe: impl FnMut(Progress) -> Control,
    ) -> Result<Picture> {
        let scene = &*self.edits.apply(scene);
        let resident = backend.upload_scene(scene)?;
        let built = self.build(backend, &resident, scene, None)?;
        let settings = &self.request.picture;
        let rendered = self.sample(backend, &resident, scene, &built, camera, settings, observe)?;
        let surfaces = self.surfaces(backend, &resident, scene, &built, camera, &rendered.film)?;
        Ok(Picture { rendered, surfaces })
    }

    /// Builds what pixels are sampled with. `scene` has the plan's edits ([`crate::plan::Edits::apply`]) and is resident on `backend` as
    /// `resident`; `kept` has what may be left of the frame before.
    ///
    /// # Errors
    /// As [`slhb::build`] and [`voxel::build()`].
    pub fn build<B: Backend>(
        &self,
        backend: &B,
        resident: &B::Scene,
        scene: &CompiledScene,
        kept: Option<&mut Kept<B>>,
    ) -> Result<Built<B>> {
        let buffers = match (&self.buffers, kept) {
            (None, _) => None,
            (Some(lookups), None) => Some(slhb::build(backend, scene, lookups)?),
            (Some(lookups), Some(kept)) => Some(kept.build(backend, scene, lookups)?),
        };
        let voxels = self.voxels.as_ref();
        let voxels = voxels.map(|settings| voxel::build(backend, resident, scene, settings)).transpose()?;
        Ok(Built { buffers, voxels })
    }

    /// Samples pixels: `settings` says which samples, the plan how often their light is scattered.
    ///
    /// # Errors
    /// As [`reference::render`].
    pub fn sample<B: Backend>(
        &self,
        backend: &B,
        resident: &B::Scene,
        scene: &CompiledScene,
        built: &Built<B>,
        camera: &Camera,
        settings: &Settings,
        observe: impl FnMut(Progress) -> Control,
    ) -> Result<Rendered> {
        let settings = &Settings { bounces: self.sampled_bounces, ..settings.clone() };
        match (self.sampling, &built.buffers) {
            (Sampling::Nothing, _) => black(scene, camera, settings),
            (_, None) => reference::render(backend, resident, scene, camera, settings, observe),
            (_, Some(buffers)) => slhb::render(backend, resident, scene, buffers, camera, settings, observe),
        }
    }

    /// What the camera sees, and the picture where it is more than the mean of samples.
    ///
    /// # Errors
    /// As [`crate::gbuffer`], [`slhb::filter()`] and [`voxel::gather()`].
    pub fn surfaces<B: Backend>(
        &self,
        backend: &B,
        resident: &B::Scene,
        scene: &CompiledScene,
        built: &Built<B>,
        camera: &Camera,
        film: &Film,
    ) -> Result<Surfaces> {
        let start = Instant::now();
        let on_device = crate::gbuffer(backend, resident, scene, camera, (film.width(), film.height()))?;
        let gbuffer = backend.download(&on_device)?;
        let gbuffer_time = start.elapsed();
        let start = Instant::now();
        let made = match (&built.voxels, &self.voxels, self.filter) {
            (Some(lit), Some(settings), _) => {
                let gathered = voxel::gather(backend, scene, lit, camera, &gbuffer, film, settings)?;
                Some(Made { radiance: gathered.radiance, indirect: gathered.indirect })
            }
            (_, _, 1) => None,
            (_, _, window) => {
                let filtered = slhb::filter(backend, scene, camera, &on_device, film, window)?;
                Some(Made { radiance: filtered.radiance, indirect: filtered.indirect })
            }
        };
        Ok(Surfaces { gbuffer, gbuffer_time, made, made_time: start.elapsed() })
    }
}

/// The film of a scene without light: every sample is known to be 0.
fn black(scene: &CompiledScene, camera: &Camera, settings: &Settings) -> Result<Rendered> {
    let params = settings.params(camera, scene)?;
    let dark = FilmTexel { samples: settings.samples, ..bytemuck::Zeroable::zeroed() };
    let texels = vec![dark; settings.width as usize * settings.height as usize];
    let film = Film::new(settings.width, settings.height, &params, texels)?;
    Ok(Rendered { film, stop: StopReason::Samples, elapsed: Duration::ZERO })
}
