//! Two backends on whole scenes, one against the other: bit for bit when both evaluate floats as written, else by the
//! accuracy class of each output.

use crate::compare::{Shape, exact};
use crate::expectations::Verdict;
use crate::kernels::filter_indirect::{filtered_over, inputs, within_intervals};
use crate::kernels::light_voxels::lit_over;
use crate::kernels::query_lhb::scattered;
use crate::kernels::reduce_mips::{all_of, inputs::surfaces};
use crate::kernels::sum_voxels::some_surfaces;
use crate::kernels::trace_cones as cone_trials;
use crate::kernels::trace_paths::{params, traced};
use crate::kernels::voxelize::over;
use crate::kernels::walk_lhb::{Prepared, walked};
use crate::scenes::{Rays, compiled};
use crate::trial::{Check, Context, Failure, Options, ensure};
use twinlight_core::Backend;
use twinlight_core::kernels::merge_lhb::MergeLhbParams;
use twinlight_core::kernels::pack_lhb::PackLhbParams;
use twinlight_core::kernels::rasterize_lhb::{CAP_FAR, LhbElement, RasterizeLhbParams};
use twinlight_core::kernels::reduce_mips::VoxelLight;
use twinlight_core::kernels::shade_primary::{GBufferTexel, ShadePrimaryParams};
use twinlight_core::kernels::sum_voxels::VoxelSums;
use twinlight_core::kernels::trace::Hit;
use twinlight_core::kernels::trace_paths::{FilmTexel, SAMPLER_SOBOL, TracePathsParams};
use twinlight_core::kernels::voxelize::{CONSERVATIVE, THIN, VoxelBuffers, VoxelizeParams};
use twinlight_core::kernels::walk_lhb::{SHADOW_LOOKUPS, SHADOW_LOOKUPS_FIRST};
use twinlight_core::lattice::{Lattice, LatticeMesh, View, VoxelGrid};
use twinlight_core::scene::{Camera, CompiledScene, Scene};
use twinlight_fixtures::random::Random;
use twinlight_fixtures::scenes::builtin;
use twinlight_methods::post::image::Image;
use twinlight_methods::post::metrics::ztest::{Estimate, ZTest, ZTestSettings};

/// A comparison of two backends.
pub type CrossCheck<A, B> = fn(&A, &B) -> Check;

/// Every comparison, by name. The first backend is the yardstick in messages.
pub fn checks<A: Backend, B: Backend>() -> Vec<(&'static str, CrossCheck<A, B>)> {
    vec![
        ("rasterize_lhb", lists),
        ("merge_lhb", merges),
        ("pack_lhb", packings),
        ("query_lhb", lookups),
        ("trace", hits),
        ("shade_primary", gbuffers),
        ("trace_paths", films),
        ("walk_lhb", walks),
        ("filter_indirect", filters),
        ("reduce_mips", mips),
        ("voxelize", voxels),
        ("sum_voxels", sums),
        ("trace_cones", cones),
        ("light_voxels", voxel_lights),
    ]
}

/// The verdict of one comparison.
pub fn judge(check: Check) -> Verdict {
    match check {
        Ok(()) => Verdict::Passed,
        Err(Failure::Mismatch(evidence)) => Verdict::Failed(evidence),
        Err(Failure::Skip(reason)) => Verdict::Skipped(reason),
    }
}

/// Builtin scenes small enough to upload in a moment: every material, light and attribute between them.
const SCENES: [&str; 8] =
    ["cornell", "axis", "textured", "lights", "veach", "furnace", "environment", "materials"];

fn each_scene(check: impl Fn(&Scene) -> Check) -> Check {
    for name in SCENES {
        let scene = builtin(name).ok_or_else(|| Failure::Mismatch(format!("no builtin scene {name}")))?;
        check(&scene).map_err(|f| f.within(name))?;
    }
    Ok(())
}

fn both_strict<A: Backend, B: Backend>(a: &A, b: &B) -> bool {
    a.info().strict && b.info().strict
}

fn context<'a, B>(backend: &'a B, options: &'a Options, name: &'a str) -> Context<'a, B> {
    Context { backend, options, name }
}

/// Of 48² pixels.
fn four_views() -> twinlight_core::Result<Vec<View>> {
    let directions = [[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.3, -0.8, 0.5], [-0.6, 0.2, 0.7]];
    directions.map(|d| View::along(d.into(), 48)).into_iter().collect()
}

/// Cones through made-up voxels of every storage.
fn cones<A: Backend, B: Backend>(a: &A, b: &B) -> Check {
    for storage in cone_trials::STORAGES {
        let mut random = Random::new(u64::from(storage));
        let (lit, block, cones) = cone_trials::inputs::some_call(&mut random, storage);
        let got = cone_trials::traced(b, &lit, &block, &cones)?;
        let check = if both_strict(a, b) {
            cone_trials::same("light", &got, &cone_trials::traced(a, &lit, &block, &cones)?)
        } else {
            cone_trials::possible_light(&lit, &block, &cones, &got)
        };
        check.map_err(|f| f.within(&format!("storage {storage}")))?;
    }
    Ok(())
}

/// Layered hit buffers from four directions, in 48² pixels: integers, so the same bits in every mode.
fn lists<A: Backend, B: Backend>(a: &A, b: &B) -> Check {
    fn run<B: Backend>(backend: &B, scene: &Scene) -> Result<(Vec<u32>, Vec<LhbElement>), Failure> {
        let compiled = compiled(scene);
        let mesh = LatticeMesh::of_scene(&Lattice::of_scene(&compiled)?, &compiled)?;
        let views = four_views()?;
        let lhb =
            backend.rasterize_lhb(&backend.upload_mesh(&mesh)?, &views, &RasterizeLhbParams::new(48))?;
        Ok((backend.download(&lhb.offsets)?, backend.download(&lhb.elements)?))
    }
    each_scene(|scene| {
        let (want, got) = (run(a, scene)?, run(b, scene)?);
        let options = Options::default();
        let cx = context(b, &options, "cross.rasterize_lhb");
        exact(&cx, "offsets", &got.0, &want.0, Shape::Image { width: 48 })?;
        exact(&cx, "elements", &got.1, &want.1, Shape::Line)
    })
}

/// Such buffers of a scene's first two thirds and of the rest, merged: all of them, and the two farthest.
fn merges<A: Backend, B: Backend>(a: &A, b: &B) -> Check {
    type Downloaded = (Vec<u32>, Vec<LhbElement>, Vec<u32>);
    fn run<B: Backend>(backend: &B, mesh: &LatticeMesh, layer_cap: u32) -> Result<Downloaded, Failure> {
        let (kept, added) = mesh.triangles().split_at(mesh.triangles().len() * 2 / 3);
        let params = RasterizeLhbParams { layer_cap, cap_side: CAP_FAR, ..RasterizeLhbParams::new(48) };
        let drawn = |triangles: &[[u32; 3]]| {
            let part = LatticeMesh::new(mesh.vertices().to_vec(), triangles.to_vec())?;
            backend.rasterize_lhb(&backend.upload_mesh(&part)?, &four_views()?, &params)
        };
        let first_triangle = kept.len() as u32;
        let merge = MergeLhbParams { first_triangle, layer_cap, cap_side: CAP_FAR, padding: 0 };
        let lhb = backend.merge_lhb(&drawn(kept)?, &drawn(added)?, &merge)?;
        let left_out = backend.download(&lhb.left_out)?;
        Ok((backend.download(&lhb.offsets)?, backend.download(&lhb.elements)?, left_out))
    }
    each_scene(|scene| {
        let compiled = compiled(scene);
        let mesh = LatticeMesh::of_scene(&Lattice::of_scene(&compiled)?, &compiled)?;
        for layer_cap in [0, 2] {
            let (want, got) = (run(a, &mesh, layer_cap)?, run(b, &mesh, layer_cap)?);
            let options = Options::default();
            let cx = context(b, &options, "cross.merge_lhb");
            exact(&cx, "offsets", &got.0, &want.0, Shape::Image { width: 48 })?;
            exact(&cx, "elements", &got.1, &want.1, Shape::Line)?;
            exact(&cx, "left_out", &got.2, &want.2, Shape::Image { width: 48 })?;
        }
        Ok(())
    })
}

/// Such buffers packed and read back: whole lists, and the two farthest layers.
fn packings<A: Backend, B: Backend>(a: &A, b: &B) -> Check {
    type Downloaded = (Vec<u32>, Vec<u32>, Vec<LhbElement>);
    fn run<B: Backend>(backend: &B, mesh: &LatticeMesh, layers: u32) -> Result<Downloaded, Failure> {
        let resident = backend.upload_mesh(mesh)?;
        let lhb = backend.rasterize_lhb(&resident, &four_views()?, &RasterizeLhbParams::new(48))?;
        let packed = backend.pack_lhb(&lhb, &PackLhbParams { layers, cap_side: CAP_FAR })?;
        let back = backend.unpack_lhb(&packed)?;
        let words = backend.download(&packed.words)?;
        Ok((words, backend.download(&packed.left_out)?, backend.download(&back.elements)?))
    }
    each_scene(|scene| {
        let compiled = compiled(scene);
        let mesh = LatticeMesh::of_scene(&Lattice::of_scene(&compiled)?, &compiled)?;
        for layers in [0, 2] {
            let (want, got) = (run(a, &mesh, layers)?, run(b, &mesh, layers)?);
            let options = Options::default();
            let cx = context(b, &options, "cross.pack_lhb");
            exact(&cx, "words", &got.0, &want.0, Shape::Line)?;
            exact(&cx, "left_out", &got.1, &want.1, Shape::Line)?;
            exact(&cx, "elements", &got.2, &want.2, Shape::Line)?;
        }
        Ok(())
    })
}

/// Lookups in such buffers from all over the lattice, from triangles and from between them: integers too.
fn lookups<A: Backend, B: Backend>(a: &A, b: &B) -> Check {
    fn run<B: Backend>(backend: &B, scene: &Scene) -> Result<Vec<LhbElement>, Failure> {
        let compiled = compiled(scene);
        let mesh = LatticeMesh::of_scene(&Lattice::of_scene(&compiled)?, &compiled)?;
        let views = four_views()?;
        let queries = backend.upload(&scattered(&mesh, views.len(), 3_000))?;
        let resident = backend.upload_mesh(&mesh)?;
        let lhb = backend.rasterize_lhb(&resident, &views, &RasterizeLhbParams::new(48))?;
        let mut hits = backend.zeroed::<LhbElement>(3_000)?;
        backend.query_lhb(&resident, &lhb, &views, &queries, &mut hits)?;
        Ok(backend.download(&hits)?)
    }
    each_scene(|scene| {
        let (want, got) = (run(a, scene)?, run(b, scene)?);
        exact(&context(b, &Options::default(), "cross.query_lhb"), "hits", &got, &want, Shape::Line)
    })
}

/// A scene's mesh in a grid of 48 voxels to its longest axis.
fn gridded(scene: &Scene) -> Result<(LatticeMesh, VoxelGrid), Failure> {
    let compiled = compiled(scene);
    let mesh = LatticeMesh::of_scene(&Lattice::of_scene(&compiled)?, &compiled)?;
    let grid = over(&mesh, 48)?;
    Ok((mesh, grid))
}

/// Voxels that a scene passes through, thin and conservative: integers.
fn voxels<A: Backend, B: Backend>(a: &A, b: &B) -> Check {
    type Downloaded = [Vec<u32>; 6];
    fn run<B: Backend>(backend: &B, scene: &Scene, separation: u32) -> Result<Downloaded, Failure> {
        let (mesh, grid) = gridded(scene)?;
        let params = VoxelizeParams { separation, ..VoxelizeParams::thin() };
        let voxels = backend.voxelize(&backend.upload_mesh(&mesh)?, &grid, &params)?;
        let VoxelBuffers { small, large, mask, ranks, active, parents, .. } = &voxels;
        let mut downloaded = Downloaded::default();
        for (words, buffer) in downloaded.iter_mut().zip([small, large, mask, ranks, active, parents]) {
            *words = backend.download(buffer)?;
        }
        Ok(downloaded)
    }
    each_scene(|scene| {
        for separation in [THIN, CONSERVATIVE] {
            let (want, got) = (run(a, scene, separation)?, run(b, scene, separation)?);
            let options = Options::default();
            let cx = context(b, &options, "cross.voxelize");
            let names = ["small", "large", "mask", "ranks", "active", "parents"];
            for ((name, got), want) in names.into_iter().zip(&got).zip(&want) {
                exact(&cx, name, got, want, Shape::Line)?;
            }
        }
        Ok(())
    })
}

/// Sums of made-up surfaces over such voxels.
fn sums<A: Backend, B: Backend>(a: &A, b: &B) -> Check {
    fn run<B: Backend>(backend: &B, scene: &Scene) -> Result<Vec<VoxelSums>, Failure> {
        let (mesh, grid) = gridded(scene)?;
        let (surfaces, texels) = some_surfaces(mesh.triangles().len(), 9);
        let (surfaces, texels) = (backend.upload(&surfaces)?, backend.upload(&texels)?);
        let (params, mesh) = (VoxelizeParams::thin(), backend.upload_mesh(&mesh)?);
        let voxels = backend.voxelize(&mesh, &grid, &params)?;
        Ok(backend.download(&backend.sum_voxels(&mesh, &voxels, &surfaces, &texels, &params)?)?)
    }
    each_scene(|scene| {
        let (want, got) = (run(a, scene)?, run(b, scene)?);
        exact(&context(b, &Options::default(), "cross.sum_voxels"), "sums", &got, &want, Shape::Line)
    })
}

/// Closest hits. In portable mode both are held to the oracle's intervals by the suite; here at most one ray in a
/// thousand may name another triangle: edges and equal distances, which incoherent rays all but avoid.
fn hits<A: Backend, B: Backend>(a: &A, b: &B) -> Check {
    fn run<B: Backend>(backend: &B, scene: &Scene, strict: bool) -> Result<Vec<Hit>, Failure> {
        let compiled = compiled(scene);
        let mut rays = Rays::new(&compiled, 5);
        let rays: Vec<_> =
            if strict { rays.mixed(4_000) } else { (0..4_000).map(|_| rays.incoherent()).collect() };
        let resident = backend.upload_scene(&compiled)?;
        let rays = backend.upload(&rays)?;
        let mut hits = backend.zeroed::<Hit>(4_000)?;
        backend.trace_closest(&resident, &rays, &mut hits)?;
        Ok(backend.download(&hits)?)
    }
    let strict = both_strict(a, b);
    each_scene(|scene| {
        let (want, got) = (run(a, scene, strict)?, run(b, scene, strict)?);
        if strict {
            return exact(&context(b, &Options::default(), "cross.trace"), "hits", &got, &want, Shape::Line);
        }
        let other = want.iter().zip(&got).filter(|(a, b)| a.triangle != b.triangle).count();
        ensure(other <= 4, || format!("{other} of 4000 rays meet another triangle"))
    })
}

/// G-buffers of 64 × 48 pixels. In portable mode at most one pixel in a hundred may show another triangle: those that
/// an edge crosses at their centre.
fn gbuffers<A: Backend, B: Backend>(a: &A, b: &B) -> Check {
    fn run<B: Backend>(backend: &B, scene: &Scene) -> Result<Vec<GBufferTexel>, Failure> {
        let compiled = compiled(scene);
        let (width, height) = (64, 48);
        let camera = Camera::of_scene(scene).ok_or_else(|| Failure::Mismatch("no camera".into()))?;
        let camera = camera.record(width, height, compiled.origin)?;
        let params = ShadePrimaryParams { camera, width, height, padding: [0; 2] };
        let resident = backend.upload_scene(&compiled)?;
        let mut gbuffer = backend.zeroed::<GBufferTexel>(64 * 48)?;
        backend.shade_primary(&resident, &params, &mut gbuffer)?;
        Ok(backend.download(&gbuffer)?)
    }
    each_scene(|scene| {
        let (want, got) = (run(a, scene)?, run(b, scene)?);
        if both_strict(a, b) {
            let options = Options::default();
            let cx = context(b, &options, "cross.shade_primary");
            return exact(&cx, "gbuffer", &got, &want, Shape::Image { width: 64 });
        }
        let other = want.iter().zip(&got).filter(|(a, b)| a.triangle != b.triangle).count();
        ensure(other <= 30, || format!("{other} of 3072 pixels show another triangle"))
    })
}

/// Films of 32 × 32 pixels. In strict mode the same bits; else, with a quarter of the pixels and 32 times the samples, two
/// estimates of one picture, with independent seeds, under the z-test with Šidák's correction and the signed-bias test.
fn films<A: Backend, B: Backend>(a: &A, b: &B) -> Check {
    let strict = both_strict(a, b);
    let (side, samples) = if strict { (32, 8) } else { (16, 256) };
    each_scene(|scene| {
        let compiled = compiled(scene);
        let params = params(scene, &compiled, (side, side), samples, None)?;
        if strict {
            let params = TracePathsParams { sampler: SAMPLER_SOBOL, ..params };
            let (want, got) = (traced(a, &compiled, &params)?, traced(b, &compiled, &params)?);
            let options = Options::default();
            let cx = context(b, &options, "cross.trace_paths");
            return exact(&cx, "film", &got, &want, Shape::Image { width: 32 });
        }
        let other = TracePathsParams { seed: params.seed + 1, ..params };
        let estimates = [traced(a, &compiled, &params)?, traced(b, &compiled, &other)?];
        z_test(&estimates, &params)
    })
}

/// Walks of 16 × 16 pixels through 80 directions of 32². In strict mode the same bits, with shadow rays traced, and looked up
/// behind interleaved numbers; else two estimates of one picture, as [`films`] compares them: what a lookup finds is decided by
/// integers, but where it looks is not.
fn walks<A: Backend, B: Backend>(a: &A, b: &B) -> Check {
    fn prepared<B: Backend>(backend: &B, compiled: &CompiledScene) -> Result<Prepared<B>, Failure> {
        Prepared::new(backend, compiled, "icosahedron:80", 32)
    }
    let strict = both_strict(a, b);
    each_scene(|scene| {
        let compiled = compiled(scene);
        let params = params(scene, &compiled, (16, 16), if strict { 16 } else { 256 }, Some(6))?;
        let (on_a, on_b) = (prepared(a, &compiled)?, prepared(b, &compiled)?);
        if !strict {
            let other = TracePathsParams { seed: params.seed + 1, ..params };
            return z_test(&[walked(a, &on_a, &params)?, walked(b, &on_b, &other)?], &params);
        }
        let params = TracePathsParams { sampler: SAMPLER_SOBOL, ..params };
        let same = |on_a: &Prepared<A>, on_b: &Prepared<B>| {
            let (want, got) = (walked(a, on_a, &params)?, walked(b, on_b, &params)?);
            let options = Options::default();
            exact(&context(b, &options, "cross.walk_lhb"), "film", &got, &want, Shape::Image { width: 16 })
        };
        same(&on_a, &on_b)?;
        // The same buffers again: making them takes longer than the walks.
        let flags = SHADOW_LOOKUPS | SHADOW_LOOKUPS_FIRST;
        same(&on_a.flagged(flags).interleaved(5), &on_b.flagged(flags).interleaved(5))
            .map_err(|f| f.within("shadows looked up"))
    })
}

/// Noise in pictures of 48 × 36 pixels that the first backend shades, filtered. In portable mode both are within the oracle's
/// intervals: what is joined there may differ where a limit is in doubt.
fn filters<A: Backend, B: Backend>(a: &A, b: &B) -> Check {
    each_scene(|scene| {
        let shown = inputs::shown(scene, 48, 36)?;
        let mut gbuffer = a.zeroed::<GBufferTexel>(48 * 36)?;
        a.shade_primary(&a.upload_scene(&compiled(scene))?, &shown, &mut gbuffer)?;
        let gbuffer = a.download(&gbuffer)?;
        for window in [5, 8] {
            let picture = inputs::in_scene(scene, gbuffer.clone(), &shown, window);
            let before = vec![inputs::radiance([f32::NAN; 3]); gbuffer.len()];
            let (want, got) = (filtered_over(a, &picture, &before)?, filtered_over(b, &picture, &before)?);
            if both_strict(a, b) {
                let options = Options::default();
                let cx = context(b, &options, "cross.filter_indirect");
                exact(&cx, "output", &got, &want, Shape::Image { width: 48 })?;
            } else {
                within_intervals(&picture, &want)?;
                within_intervals(&picture, &got)?;
            }
        }
        Ok(())
    })
}

/// Levels and values of every storage, over shells of 64³ and 200³ voxels: integers, so the same bits in every mode.
fn mips<A: Backend, B: Backend>(a: &A, b: &B) -> Check {
    let options = Options::default();
    for (side, count) in [(64, 4_000), (200, 20_000)] {
        let field = surfaces(&mut Random::new(u64::from(side)), side, count);
        let cx = context(b, &options, "cross.reduce_mips");
        let (want, got) = (all_of(&context(a, &options, "cross.reduce_mips"), &field)?, all_of(&cx, &field)?);
        for ((name, want), (_, got)) in want.iter().zip(&got) {
            exact(&cx, name, got, want, Shape::Line)?;
        }
    }
    Ok(())
}

/// Means and variances of both films, compared.
fn z_test(films: &[Vec<FilmTexel>; 2], params: &TracePathsParams) -> Check {
    let failed = |error: twinlight_methods::post::PostError| Failure::Mismatch(error.to_string());
    let mut images = Vec::new();
    for film in films {
        let film =
            twinlight_methods::reference::Film::new(params.width, params.height, params, film.clone())?;
        let mean = film.radiance();
        // One variance per pixel is known, of luminance; a channel's is taken as at most that of a sample whose light is
        // all in it: (1 / 0.0722)² would pass anything, so channels are compared as luminance only.
        let luminance = |c: &[f32; 3]| [0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; 3];
        let mean = mean.iter().map(luminance).collect();
        // Squares are summed in quanta fit for the brightest emitter: of a dim sample's square only "at most one quantum"
        // is known, and that much more variance the mean may have.
        let quantum = f64::from(-params.moment_exponent).exp2() / f64::from(params.sample_count);
        let variance = film.variance().iter().map(|v| [(f64::from(*v) + quantum) as f32; 3]).collect();
        let image = |pixels| Image::new(params.width, params.height, pixels).map_err(failed);
        images.push((image(mean)?, image(variance)?));
    }
    let estimate = |i: usize| Estimate { mean: &images[i].0, variance_of_mean: &images[i].1 };
    // Lamps and caustics are rare events whose spread 256 samples don't show: two pixels in a hundred may fail.
    let settings = ZTestSettings { allowed_fraction: 0.02, ..ZTestSettings::default() };
    let test = ZTest::new(estimate(0), estimate(1), settings).map_err(failed)?;
    ensure(test.passes(), || {
        format!(
            "z-test: {} of {} values beyond {:.2} (worst {:.2} at {:?}), bias z {:?} beyond {:.2}",
            test.failures,
            test.values,
            test.threshold,
            test.max_abs_z,
            test.worst,
            test.bias_z,
            test.bias_threshold
        )
    })
}

/// Share of the leaves that may differ in portable mode by more than roundings: shadow rays past edges.
const GRAZING: f64 = 0.01;

/// Light on voxels all over the scene.
fn voxel_lights<A: Backend, B: Backend>(a: &A, b: &B) -> Check {
    each_scene(|scene| {
        let compiled = compiled(scene);
        let (want, got) = (lit_over(a, &compiled)?, lit_over(b, &compiled)?);
        if both_strict(a, b) {
            return exact(
                &context(b, &Options::default(), "cross.light_voxels"),
                "leaves",
                &got,
                &want,
                Shape::Line,
            );
        }
        let near = |(got, want): &(&VoxelLight, &VoxelLight)| {
            let close = |(got, want): (&u32, u32)| got.abs_diff(want) <= 1 + want / 4096;
            got.opacity == want.opacity && got.rgb.iter().zip(want.rgb).all(close)
        };
        let far = got.len() - got.iter().zip(&want).filter(near).count();
        ensure(far as f64 <= GRAZING * got.len() as f64, || format!("{far} of {} leaves differ", got.len()))
    })
}
