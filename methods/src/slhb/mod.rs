//! Spherical layered hit buffers: indirect light by looking up, not tracing, what a surface sees.
//!
//! [`build`] rasterizes a scene along every direction of a set and keeps all layers; [`render`] walks paths through the buffers
//! with the kernel `walk_lhb`. In a scene that moves, [`Kept`] rasterizes only what moves again. [`filter`] averages what is left of the
//! noise over neighbours. Biased, in exchange for lookups that cost a fraction of a ray: the error falls with the number of directions
//! and pixels. *Source.* Yu, spherical layered hit buffers.

mod buffers;
mod elements;
mod filter;
mod kept;
mod plan;
mod sheet;

pub use buffers::{Buffers, LookupSettings, Shadows, build};
pub use elements::Elements;
pub use filter::{Filtered, filter};
pub use kept::Kept;
pub use sheet::{Sheet, sheet};

use crate::reference::{Control, Progress, Rendered, Settings, accumulate};
use twinlight_core::kernels::trace_paths::TracePathsParams;
use twinlight_core::kernels::walk_lhb::WalkLhbParams;
use twinlight_core::scene::{Camera, CompiledScene};
use twinlight_core::{Backend, Result};

/// Renders `scene` (resident on `backend` as `resident`) with buffers that were built of it.
///
/// # Errors
/// As [`crate::reference::render`].
///
/// ```
/// use twinlight_backend_cpu::CpuBackend;
/// use twinlight_core::{Backend, scene};
/// use twinlight_methods::reference::{Control, Settings};
/// use twinlight_methods::slhb::{LookupSettings, build, render};
///
/// # fn main() -> twinlight_core::Result<()> {
/// let room = twinlight_fixtures::scenes::builtin("cornell").expect("there is one");
/// let compiled = scene::compile(&room, &scene::Limits::default())?;
/// let backend = CpuBackend::new();
/// let resident = backend.upload_scene(&compiled)?;
/// let lookups = LookupSettings { directions: "icosahedron:20".parse()?, size: 16, ..LookupSettings::default() };
/// let buffers = build(&backend, &compiled, &lookups)?;
/// let camera = scene::Camera::of_scene(&room).expect("it has one");
/// let settings = Settings { width: 8, height: 8, samples: 4, ..Settings::default() };
/// let rendered = render(&backend, &resident, &compiled, &buffers, &camera, &settings, |_| Control::Continue)?;
/// assert!(rendered.film.indirect().iter().flatten().any(|&radiance| radiance > 0.0));
/// # Ok(())
/// # }
/// ```
pub fn render<B: Backend>(
    backend: &B,
    resident: &B::Scene,
    scene: &CompiledScene,
    buffers: &Buffers<B>,
    camera: &Camera,
    settings: &Settings,
    observe: impl FnMut(Progress) -> Control,
) -> Result<Rendered> {
    let kernel = |call: &TracePathsParams, film: &mut _| {
        let params = WalkLhbParams { call: *call, lookup: buffers.lookup };
        let Buffers { mesh, lhb, views, map, .. } = buffers;
        backend.walk_lhb(resident, mesh, lhb, views, map, &params, film)
    };
    accumulate(backend, scene, camera, settings, kernel, observe)
}
