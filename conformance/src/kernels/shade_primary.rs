// kernel family: shade_primary
// contract core/src/kernels/shade_primary.rs
// cpu backend-cpu/src/kernels/shade_primary.rs
// gpu backend-gpu/src/kernels/shade_primary.wgsl
// oracle conformance/src/oracle/shade_primary.rs
//! Cases and laws of `shade_primary`.

use super::strict_only;
use crate::compare::{Evidence, Shape, exact};
use crate::oracle::shade_primary as oracle;
use crate::scenes::{compiled, scene_of};
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use bytemuck::Zeroable;
use glam::DVec3;
use twinlight_core::kernels::shade_primary::{GBufferTexel, ShadePrimaryParams};
use twinlight_core::kernels::trace::NO_HIT;
use twinlight_core::scene::{Camera, CompiledScene, Mesh, Scene};
use twinlight_core::{Backend, Error};
use twinlight_fixtures::{meshes, scenes};

/// Lists the trials.
pub fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "shade_primary":
        within_intervals, as_written, image_sizes, repeated, lengths_must_agree, g9_no_scene, g14_bad_normals,
    );
}

/// What the buffer holds before the kernel runs.
fn garbage(len: usize) -> Vec<GBufferTexel> {
    vec![
        GBufferTexel { depth: -7.0, triangle: 0xdead_beef, padding: 0xdead_beef, ..GBufferTexel::zeroed() };
        len
    ]
}

fn params(
    scene: &Scene,
    compiled: &CompiledScene,
    width: u32,
    height: u32,
) -> Result<ShadePrimaryParams, Failure> {
    let camera = Camera::of_scene(scene)
        .ok_or_else(|| Failure::Mismatch("a scene of the suite has no camera and no bounds".into()))?;
    Ok(ShadePrimaryParams {
        camera: camera.record(width, height, compiled.origin)?,
        width,
        height,
        padding: [0; 2],
    })
}

fn shaded<B: Backend>(
    cx: &Context<'_, B>,
    scene: &CompiledScene,
    params: &ShadePrimaryParams,
) -> Result<Vec<GBufferTexel>, Failure> {
    let resident = cx.backend.upload_scene(scene)?;
    let mut gbuffer = cx.backend.upload(&garbage((params.width * params.height) as usize))?;
    cx.backend.shade_primary(&resident, params, &mut gbuffer)?;
    Ok(cx.backend.download(&gbuffer)?)
}

/// Scenes with one difficulty each, small enough for brute force.
fn cases() -> Vec<(&'static str, Scene)> {
    let ball = meshes::with_smooth_normals(meshes::icosphere(4));
    let named = ["cornell", "axis", "textured", "lights", "furnace"];
    let mut cases: Vec<(&'static str, Scene)> =
        named.iter().filter_map(|name| Some((*name, scenes::builtin(name)?))).collect();
    cases.push(("smooth ball", scene_of(ball)));
    cases.push(("soup", scene_of(meshes::soup(150, 0.4, 3))));
    cases
}

fn each_case<B: Backend>(
    cx: &Context<'_, B>,
    check: impl Fn(&CompiledScene, &ShadePrimaryParams, &[GBufferTexel]) -> Check,
) -> Check {
    let (width, height) = if cx.full() { (61, 47) } else { (31, 23) };
    for (name, scene) in cases() {
        let compiled = compiled(&scene);
        let params = params(&scene, &compiled, width, height)?;
        let got = shaded(cx, &compiled, &params)?;
        check(&compiled, &params, &got).map_err(|f| f.within(name))?;
    }
    Ok(())
}

fn as_written<B: Backend>(cx: &Context<'_, B>) -> Check {
    strict_only(cx)?;
    each_case(cx, |scene, params, got| {
        let pixels = (0..params.height).flat_map(|y| (0..params.width).map(move |x| (x, y)));
        let want: Vec<GBufferTexel> = pixels.map(|(x, y)| oracle::as_written(scene, params, x, y)).collect();
        exact(cx, "gbuffer", got, &want, Shape::Image { width: params.width as usize })
    })
}

fn within_intervals<B: Backend>(cx: &Context<'_, B>) -> Check {
    each_case(cx, |scene, params, got| {
        let mut evidence = Evidence::new("gbuffer", Shape::Image { width: params.width as usize });
        let mut decided = 0;
        for (index, texel) in got.iter().enumerate() {
            let (x, y) = (index as u32 % params.width, index as u32 / params.width);
            let allowed = oracle::possible(scene, params, x, y);
            decided += usize::from(allowed.surfaces.len() + usize::from(allowed.nothing) == 1);
            check_texel(&mut evidence, index, texel, &allowed);
        }
        evidence.finish()?;
        // Rays through edges are undecided; more than a tenth of the pixels would make the check a formality.
        let share = decided as f64 / got.len() as f64;
        ensure(share > 0.9, || format!("the oracle decides only {share} of the pixels"))
    })
}

fn check_texel(evidence: &mut Evidence, index: usize, got: &GBufferTexel, allowed: &oracle::Pixel) {
    let mut ids: Vec<u32> = allowed.surfaces.iter().map(|s| s.triangle).collect();
    if allowed.nothing {
        ids.push(NO_HIT);
    }
    if !evidence.one_of(index, "triangle", got.triangle, &ids) {
        return;
    }
    if got.triangle == NO_HIT {
        let nothing = GBufferTexel { triangle: NO_HIT, ..GBufferTexel::zeroed() };
        evidence.holds(index, *got == nothing, || format!("{got:?} where nothing is seen, want zeros"));
        return;
    }
    for surface in allowed.surfaces.iter().filter(|s| s.triangle == got.triangle) {
        let because = "WGSL's accuracy of each operation";
        let mut near = |field: &str, got: [f32; 3], want: DVec3, error: f64| {
            for (axis, got) in got.into_iter().enumerate() {
                let field = format!("{field}.{axis}");
                evidence.interval(index, &field, got, want[axis] - error, want[axis] + error, because);
            }
        };
        near("position", got.position, surface.position.0, surface.position.1);
        near("albedo", got.albedo, surface.albedo.0, surface.albedo.1);
        for (field, got, (normals, error)) in [
            ("geometric_normal", got.geometric_normal, &surface.geometric_normals),
            ("shading_normal", got.shading_normal, &surface.shading_normals),
        ] {
            let given = crate::oracle::trace::wide(got);
            let nearest = normals.iter().min_by(|a, b| given.distance(**a).total_cmp(&given.distance(**b)));
            near(field, got, nearest.copied().unwrap_or(DVec3::ZERO), *error);
        }
        let (depth, error) = surface.depth;
        evidence.interval(index, "depth", got.depth, depth - error, depth + error, because);
        evidence.one_of(index, "material", got.material, &[surface.material]);
        evidence.one_of(index, "padding", got.padding, &[0]);
    }
}

/// One pixel, one row, one column, primes: a texel is never another's.
fn image_sizes<B: Backend>(cx: &Context<'_, B>) -> Check {
    let scene = scenes::cornell();
    let compiled = compiled(&scene);
    for (width, height) in [(1, 1), (1, 67), (67, 1), (13, 7), (64, 4), (65, 3)] {
        let params = params(&scene, &compiled, width, height)?;
        let got = shaded(cx, &compiled, &params)?;
        let mut evidence = Evidence::new(format!("{width}x{height}"), Shape::Image { width: width as usize });
        for (index, texel) in got.iter().enumerate() {
            let (x, y) = (index as u32 % width, index as u32 / width);
            check_texel(&mut evidence, index, texel, &oracle::possible(&compiled, &params, x, y));
        }
        evidence.finish()?;
    }
    Ok(())
}

fn repeated<B: Backend>(cx: &Context<'_, B>) -> Check {
    let scene = scenes::cornell();
    let compiled = compiled(&scene);
    let params = params(&scene, &compiled, 65, 33)?;
    let first = shaded(cx, &compiled, &params)?;
    exact(cx, "gbuffer of a second run", &shaded(cx, &compiled, &params)?, &first, Shape::Image { width: 65 })
}

fn lengths_must_agree<B: Backend>(cx: &Context<'_, B>) -> Check {
    let scene = scenes::cornell();
    let compiled = compiled(&scene);
    let params = params(&scene, &compiled, 5, 4)?;
    let resident = cx.backend.upload_scene(&compiled)?;
    for len in [0, 19, 21] {
        let mut gbuffer = cx.backend.upload(&garbage(len))?;
        match cx.backend.shade_primary(&resident, &params, &mut gbuffer) {
            Err(Error::InvalidInput { .. }) => {}
            Err(Error::Unsupported(what)) => return Err(Failure::Skip(what)),
            other => {
                return Err(Failure::Mismatch(format!("{len} texels for 5x4: {other:?}, want InvalidInput")));
            }
        }
        exact(cx, "a refused buffer", &cx.backend.download(&gbuffer)?, &garbage(len), Shape::Line)?;
    }
    Ok(())
}

/// Nothing in the scene: every texel says so.
fn g9_no_scene<B: Backend>(cx: &Context<'_, B>) -> Check {
    let scene = scenes::empty();
    let compiled = compiled(&scene);
    let params = params(&scene, &compiled, 9, 5)?;
    let nothing = GBufferTexel { triangle: NO_HIT, ..GBufferTexel::zeroed() };
    exact(cx, "gbuffer", &shaded(cx, &compiled, &params)?, &[nothing; 45], Shape::Image { width: 9 })
}

/// Zero, cancelling and contrary vertex normals: the geometric normal, or the turned one, and never NaN.
fn g14_bad_normals<B: Backend>(cx: &Context<'_, B>) -> Check {
    let flat = meshes::with_smooth_normals(meshes::icosphere(3));
    let with = |change: fn([f32; 3]) -> [f32; 3]| Mesh {
        normals: flat.normals.iter().map(|n| change(*n)).collect(),
        ..flat.clone()
    };
    for (name, mesh) in [
        ("zero", with(|_| [0.0; 3])),
        ("long", with(|n| n.map(|x| x * 1e4))),
        ("contrary", with(|n| n.map(|x| -x))),
        ("sideways", with(|n| [n[1], n[2], n[0]])),
    ] {
        let scene = scene_of(mesh);
        let compiled = compiled(&scene);
        let params = params(&scene, &compiled, 31, 31)?;
        let got = shaded(cx, &compiled, &params)?;
        let mut evidence = Evidence::new(name, Shape::Image { width: 31 });
        for (index, texel) in got.iter().enumerate() {
            let (x, y) = (index as u32 % 31, index as u32 / 31);
            check_texel(&mut evidence, index, texel, &oracle::possible(&compiled, &params, x, y));
        }
        evidence.finish()?;
    }
    Ok(())
}
