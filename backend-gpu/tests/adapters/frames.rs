//! Hit buffers of which what stays is kept on the device, against the CPU's of every frame.

use crate::{Check, Target, expect_same};
use libtest_mimic::Failed;
use twinlight_backend_cpu::CpuBackend;
use twinlight_backend_gpu::GpuBackend;
use twinlight_core::directions::DirectionSet;
use twinlight_core::scene::{Limits, compile};
use twinlight_core::{Backend, Result};
use twinlight_fixtures::scenes::builtin;
use twinlight_methods::slhb::{Buffers, Kept, LookupSettings, build};

pub const CHECKS: &[(&str, Check)] = &[("frames with kept hit buffers are the CPU's", frames)];

type Lists = (Vec<u32>, Vec<[u32; 2]>, Vec<u32>);

fn lists<B: Backend>(backend: &B, buffers: &Buffers<B>) -> Result<Lists> {
    let lhb = &buffers.lhb;
    let elements = backend.download(&lhb.elements)?;
    let elements = elements.iter().map(|element| [element.surface, element.depth]).collect();
    Ok((backend.download(&lhb.offsets)?, elements, backend.download(&lhb.left_out)?))
}

fn frames(target: &Target) -> std::result::Result<(), Failed> {
    let (gpu, cpu) = (GpuBackend::new(target.device()?.clone()), CpuBackend::new());
    let mut scene = builtin("axis").ok_or("no such scene")?;
    scene.instances[0].moves = true;
    for layers in [None, Some(2)] {
        let directions = DirectionSet::octahedron(2)?;
        let settings = LookupSettings { directions, size: 40, layers, ..LookupSettings::default() };
        let mut kept = Kept::new();
        for frame in 0..3 {
            scene.instances[0].transform.translation.y = 0.25 * f64::from(frame);
            let frame_scene = compile(&scene, &Limits::default())?;
            let got = kept.build(&gpu, &frame_scene, &settings)?;
            if (got.kept_elements > 0) != (frame > 0) {
                return Err(format!("frame {frame}: {} elements kept", got.kept_elements).into());
            }
            let got = lists(&gpu, &got)?;
            let want = lists(&cpu, &build(&cpu, &frame_scene, &settings)?)?;
            expect_same("offsets", &got.0, &want.0)?;
            expect_same("elements", &got.1, &want.1)?;
            expect_same("left out", &got.2, &want.2)?;
        }
    }
    Ok(())
}
