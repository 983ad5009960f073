//! Lights with an extent: means over many seeds against the oracle's integrals.

use super::inputs::{exact_lights, of_scene, voxel, within};
use super::rooms::cornell;
use super::{Case, ROUNDING, lit_in};
use crate::oracle::light_voxels::{Voxel, expected};
use crate::scenes::scene_of;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use glam::DVec3;
use twinlight_core::Backend;
use twinlight_core::kernels::light_voxels::LightVoxelsBlock;
use twinlight_core::scene::{Environment, Light};
use twinlight_fixtures::meshes::{cube, placed};

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "light_voxels":
        mean_of_area_lights, mean_under_a_sky, mean_of_all_kinds, mean_in_the_cornell_box,
    );
}

/// Calls with seeds of their own.
const SEEDS: u32 = 40;

/// Standard errors by which a mean may miss. With forty values a mean is twelve in a million times as far off; Šidák's correction for
/// the some two hundred means that are compared makes it one in four hundred, and with fixed seeds it is decided once.
const SIGMAS: f64 = 5.0;

/// Relative standard error of the sum over all voxels at which a bias of 5 % still shows.
const POWER: f64 = 0.01;

/// Sum, and sum of squares.
#[derive(Debug, Clone, Copy, Default)]
struct Moments(f64, f64);

impl Moments {
    fn add(&mut self, value: f64) {
        *self = Self(self.0 + value, self.1 + value * value);
    }

    /// Mean and the variance of the mean.
    fn mean(self) -> (f64, f64) {
        let n = f64::from(SEEDS);
        let mean = self.0 / n;
        (mean, (self.1 / n - mean * mean).max(0.0) / (n - 1.0))
    }
}

fn agrees<B: Backend>(cx: &Context<'_, B>, case: &Case) -> Check {
    let resident = cx.backend.upload_scene(&case.scene)?;
    let mut each = vec![Moments::default(); 3 * case.voxels.len()];
    let mut all = Moments::default();
    for seed in 0..SEEDS {
        let seed = (seed + cx.options.seed as u32).wrapping_mul(0x9e37_79b9);
        let leaves = lit_in(cx, &resident, &LightVoxelsBlock { seed, ..case.block }, &case.voxels)?;
        let values: Vec<f64> = leaves.iter().flat_map(|leaf| leaf.rgb.map(f64::from)).collect();
        each.iter_mut().zip(&values).for_each(|(moments, value)| moments.add(*value));
        all.add(values.iter().sum());
    }
    let mut sum = (0.0, 0.0, 0.0);
    for (index, voxel) in case.voxels.iter().enumerate() {
        let want = expected(&case.scene, &case.block, voxel);
        for channel in 0..3 {
            let slack = 0.5 + ROUNDING * want.most[channel];
            let (value, variance) = (want.value[channel], want.error[channel].powi(2));
            sum = (sum.0 + value, sum.1 + variance, sum.2 + slack);
            let place = || format!("voxel {index}, channel {channel}");
            near(each[3 * index + channel].mean(), (value, variance), slack, place)?;
        }
    }
    let (mean, variance) = all.mean();
    ensure(variance.sqrt() < POWER * mean, || {
        format!("a sum of {mean} ± {} hides biases: the check has no power", variance.sqrt())
    })?;
    near((mean, variance), (sum.0, sum.1), sum.2, || "all voxels".into())
}

fn near(
    (got, got_variance): (f64, f64),
    (want, want_variance): (f64, f64),
    slack: f64,
    place: impl FnOnce() -> String,
) -> Check {
    let allowed = SIGMAS * (got_variance + want_variance).sqrt() + slack;
    ensure((got - want).abs() <= allowed, || {
        format!("{}: the mean is {got:.2}, want {want:.2} ± {allowed:.2}", place())
    })
}

/// Without light of their own, all of one surface: what differs is where they are.
fn some_voxels() -> Vec<Voxel> {
    let places = [[1, 0, 1], [6, 1, 2], [3, 2, 5], [4, 7, 4], [0, 3, 7], [5, 5, 0]];
    let normals = [[0, 9, 0], [-4, 5, 1], [7, 0, 3], [0, -8, 2], [0; 3], [1, 1, 9]];
    places.iter().zip(normals).map(|(at, normal)| voxel(*at, normal)).collect()
}

/// A rectangle, which emits to one side, and a sphere that is in its way.
fn mean_of_area_lights<B: Backend>(cx: &Context<'_, B>) -> Check {
    let rectangle = Light::Rectangle {
        corner: [-1.0, 2.0, -1.0],
        edge_u: [2.0, 0.0, 0.0],
        edge_v: [0.0, 0.5, 1.0],
        radiance: [4.0, 2.0, 1.0],
    };
    let sphere = Light::Sphere { center: [0.4, 1.4, -0.1], radius: 0.3, radiance: [6.0, 1.0, 9.0] };
    let case =
        within(vec![placed(cube(), 0.2, DVec3::new(0.1, 0.4, 0.3))], vec![rectangle, sphere], some_voxels());
    agrees(cx, &case.with(|block| block.samples = 48))
}

/// Brighter above than below, and turned.
fn mean_under_a_sky<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut scene = scene_of(placed(cube(), 0.6, DVec3::new(0.1, 0.2, 0.3)));
    let texel = |i: u32| [1.0 + (i % 8) as f32 * 0.25, 2.0 - (i / 8) as f32 * 0.25, 0.5];
    scene.environment = Some(Environment {
        width: 8,
        height: 4,
        texels: (0..32).map(texel).collect(),
        rotation: glam::DMat3::from_rotation_z(0.7) * glam::DMat3::from_rotation_y(0.4),
        ..Environment::constant([0.0; 3])
    });
    agrees(cx, &of_scene(&scene, some_voxels()).with(|block| block.samples = 32))
}

/// All that there are, at once.
fn mean_of_all_kinds<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut scene = scene_of(placed(cube(), 0.3, DVec3::new(0.1, 0.4, 0.3)));
    scene.lights = exact_lights().map(|(_, light)| light).into();
    scene.lights.push(Light::Sphere { center: [-0.6, 1.7, 0.2], radius: 0.4, radiance: [5.0, 1.0, 7.0] });
    scene.lights.push(Light::Rectangle {
        corner: [-1.0, -2.5, -1.0],
        edge_u: [0.0, 0.0, 2.0],
        edge_v: [2.0, 0.0, 0.0],
        radiance: [2.0, 1.0, 3.0],
    });
    scene.environment = Some(Environment::constant([0.5, 0.75, 1.0]));
    agrees(cx, &of_scene(&scene, some_voxels()).with(|block| block.samples = 96))
}

/// Voxels of the room's own surfaces, under its light.
fn mean_in_the_cornell_box<B: Backend>(cx: &Context<'_, B>) -> Check {
    let room = cornell(None)?;
    let voxels: Vec<Voxel> = room.voxels.iter().step_by(61).copied().collect();
    let count = voxels.len();
    ensure((8..60).contains(&count), || format!("{count} voxels: too few or too many"))?;
    agrees(cx, &Case { voxels, ..room }.with(|block| block.samples = 32))
}
