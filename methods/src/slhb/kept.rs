//! The buffers of what stays, kept while the rest moves.

use super::buffers::build_by;
use super::plan::Plan;
use super::{Buffers, LookupSettings, build};
use std::time::{Duration, Instant};
use twinlight_core::kernels::rasterize_lhb::Lhb;
use twinlight_core::lattice::{Lattice, LatticeMesh};
use twinlight_core::scene::{CompiledScene, Triangle};
use twinlight_core::{Backend, Error, Result};

/// The buffers of what stays in a scene, kept from frame to frame: only what moves ([`twinlight_core::scene::Instance::moves`]) is
/// rasterized every time, and merged behind it.
///
/// What is kept is compared with what is asked for, never tracked: frames may come in any order and from any scene, and each has the
/// bits that [`build`] gives it. Where something moves out of the ball around what stays, everything is on another lattice: such
/// frames are built whole, and so are frames for which memory suffices but once.
///
/// ```
/// use twinlight_backend_cpu::CpuBackend;
/// use twinlight_core::scene::{Limits, compile};
/// use twinlight_methods::slhb::{Kept, LookupSettings};
///
/// # fn main() -> twinlight_core::Result<()> {
/// let mut scene = twinlight_fixtures::scenes::builtin("axis").expect("there is one, a cube on a floor");
/// scene.instances[0].moves = true;
/// let backend = CpuBackend::new();
/// let settings = LookupSettings { directions: "icosahedron:20".parse()?, size: 16, ..LookupSettings::default() };
/// let mut kept = Kept::new();
/// for frame in 0..3 {
///     scene.instances[0].transform.translation.x = 0.5 * f64::from(frame);
///     let buffers = kept.build(&backend, &compile(&scene, &Limits::default())?, &settings)?;
///     assert_eq!(buffers.kept_elements > 0, frame > 0);
/// }
/// # Ok(())
/// # }
/// ```
pub struct Kept<B: Backend> {
    staying: Option<Staying<B>>,
}

/// What stays, and what was made of it.
struct Staying<B: Backend> {
    plan: Plan,
    triangles: Vec<Corners>,
    lattice: Lattice,
    /// From the first frame that needs it.
    made: Option<Made<B>>,
}

type Corners = [[f32; 3]; 3];

struct Made<B: Backend> {
    mesh: LatticeMesh,
    lhb: Lhb<B>,
}

impl<B: Backend> Default for Kept<B> {
    fn default() -> Self {
        Self::new()
    }
}

impl<B: Backend> Kept<B> {
    /// Nothing yet.
    pub fn new() -> Self {
        Self { staying: None }
    }

    /// The buffers of `scene`, as [`build`] makes them. Every call is for the same backend.
    ///
    /// # Errors
    /// As [`build`].
    pub fn build(
        &mut self,
        backend: &B,
        scene: &CompiledScene,
        settings: &LookupSettings,
    ) -> Result<Buffers<B>> {
        match self.build_with_kept(backend, scene, settings) {
            // What stays and the whole are there at once, which takes up to twice the memory of the whole.
            Err(Error::OutOfMemory { .. } | Error::LimitExceeded { .. }) => {
                self.staying = None;
                build(backend, scene, settings)
            }
            other => other,
        }
    }

    fn build_with_kept(
        &mut self,
        backend: &B,
        scene: &CompiledScene,
        settings: &LookupSettings,
    ) -> Result<Buffers<B>> {
        settings.elements.check(scene.triangles.len())?;
        let (triangles, moving) = scene.parts();
        let staying = match self.staying.take().filter(|kept| kept.is_of(triangles, settings)) {
            Some(kept) => kept,
            None => Staying::new(triangles, settings)?,
        };
        let staying = self.staying.insert(staying);
        // The choice of `Lattice::of_scene`.
        if triangles.is_empty() || !staying.lattice.reaches(moving) {
            return build_by(&staying.plan, backend, scene);
        }
        staying.merged(backend, triangles, moving)
    }
}

impl<B: Backend> Staying<B> {
    fn new(triangles: &[Triangle], settings: &LookupSettings) -> Result<Self> {
        Ok(Self {
            plan: Plan::new(settings)?,
            triangles: triangles.iter().map(corners).collect(),
            lattice: Lattice::of_triangles(triangles)?,
            made: None,
        })
    }

    fn is_of(&self, triangles: &[Triangle], settings: &LookupSettings) -> bool {
        self.plan.settings == *settings && self.triangles.iter().copied().eq(triangles.iter().map(corners))
    }

    /// With `moving` behind `triangles`, which are those it was made for.
    fn merged(&mut self, backend: &B, triangles: &[Triangle], moving: &[Triangle]) -> Result<Buffers<B>> {
        let (made, kept_elements, mut build_time) = match self.made.take() {
            Some(made) => {
                let elements = backend.len(&made.lhb.elements);
                (made, elements, Duration::ZERO)
            }
            None => {
                let (made, time) = self.make(backend, triangles)?;
                (made, 0, time)
            }
        };
        let Made { mesh, lhb } = self.made.insert(made);
        let moving = LatticeMesh::of_triangles(&self.lattice, moving)?;
        let resident = backend.upload_mesh(&moving)?;
        let start = Instant::now();
        let added = self.plan.rasterize(backend, &resident)?;
        let merged = self.plan.merge(backend, lhb, &added, triangles.len() as u32)?;
        build_time += start.elapsed();
        let whole = backend.upload_mesh(&mesh.followed_by(&moving)?)?;
        self.plan.buffers(backend, &self.lattice, whole, merged, build_time, kept_elements)
    }

    /// What stays, and the time to rasterize it.
    fn make(&self, backend: &B, triangles: &[Triangle]) -> Result<(Made<B>, Duration)> {
        let mesh = LatticeMesh::of_triangles(&self.lattice, triangles)?;
        let resident = backend.upload_mesh(&mesh)?;
        let start = Instant::now();
        let lhb = self.plan.rasterize(backend, &resident)?;
        Ok((Made { mesh, lhb }, start.elapsed()))
    }
}

fn corners(triangle: &Triangle) -> Corners {
    [triangle.p0, triangle.p1, triangle.p2]
}
