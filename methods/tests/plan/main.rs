//! Plans: what they decide, and that pictures made by them keep what they promise.

use twinlight_backend_cpu::CpuBackend;
use twinlight_core::scene::{Camera, CompiledScene, Limits, Scene, compile};
use twinlight_methods::Picture;
use twinlight_methods::plan::{Effects, Method, Plan, Request};
use twinlight_methods::reference::{Control, Settings};
use twinlight_methods::slhb::LookupSettings;
use twinlight_methods::voxel::VoxelSettings;

mod decisions;
mod dispatches;
mod laws;
mod sight;

const SIZE: u32 = 16;

/// A scene and where it is seen from.
struct Subject {
    compiled: CompiledScene,
    camera: Camera,
}

impl Subject {
    fn of(scene: &Scene) -> Self {
        Self {
            compiled: compile(scene, &Limits::default()).unwrap(),
            camera: Camera::of_scene(scene).expect("scenes of tests have something to look at"),
        }
    }

    fn builtin(name: &str) -> Self {
        Self::of(&twinlight_fixtures::scenes::builtin(name).expect("a scene of that name"))
    }

    fn plan(&self, request: &Request) -> Plan {
        Plan::new(&self.compiled, &self.camera, request).unwrap()
    }

    fn picture(&self, plan: &Plan) -> Picture {
        plan.run(&CpuBackend::new(), &self.compiled, &self.camera, |_| Control::Continue).unwrap()
    }
}

fn request(method: Method) -> Request {
    Request {
        method,
        picture: Settings { width: SIZE, height: SIZE, samples: 8, ..Settings::default() },
        effects: Effects::Auto,
        tolerance: 0.0,
    }
}

/// Every method, small.
fn methods() -> [Method; 3] {
    let lookups = LookupSettings {
        directions: "icosahedron:20".parse().unwrap(),
        size: 16,
        ..LookupSettings::default()
    };
    let voxels = VoxelSettings { grid: 16, light_samples: 2, ..VoxelSettings::default() };
    [Method::Reference, Method::Slhb { lookups, filter: 4 }, Method::Voxel(voxels)]
}

/// Every builtin scene but the one whose hit buffers take seconds.
fn names() -> impl Iterator<Item = &'static str> {
    twinlight_fixtures::scenes::builtin_names()
        .iter()
        .map(|(name, _)| *name)
        .filter(|name| *name != "room-1m")
}
