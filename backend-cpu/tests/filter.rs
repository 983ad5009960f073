//! `filter_indirect`: the same bits for any number of threads on any instruction set, whichever lanes a row leaves empty.

use twinlight_backend_cpu::CpuBackend;
use twinlight_backend_cpu::simd::{Isa, detect};
use twinlight_core::Backend;
use twinlight_core::kernels::filter_indirect::{FilterIndirectParams, RadianceTexel};
use twinlight_fixtures::inputs::{SURFACE_MATERIALS, surfaces};

fn filtered(backend: &CpuBackend, (width, height): (u32, u32), window: u32) -> Vec<RadianceTexel> {
    let params =
        FilterIndirectParams { width, height, window, least_cosine: 0.9, footprint: 0.1, padding: [0; 3] };
    let (gbuffer, light) = surfaces((width * height) as usize, 7);
    let diffuse = backend.upload(&[1; SURFACE_MATERIALS as usize]).unwrap();
    let mut output = backend.zeroed(light.len()).unwrap();
    let (gbuffer, light) = (backend.upload(&gbuffer).unwrap(), backend.upload(&light).unwrap());
    backend.filter_indirect(&gbuffer, &diffuse, &light, &params, &mut output).unwrap();
    output.as_slice().to_vec()
}

#[test]
fn any_number_of_threads_and_any_instruction_set_give_the_same_bits() {
    // Tasks of 1024 pixels begin within rows of 97.
    for (size, window) in [((1, 40), 8), ((7, 9), 3), ((16, 16), 32), ((97, 61), 4), ((97, 61), 9)] {
        let expected = filtered(&CpuBackend::with_threads(1).unwrap().with_isa(Isa::Portable), size, window);
        for (threads, isa) in [(1, detect()), (2, Isa::Sse2), (3, Isa::Portable), (8, detect())] {
            let backend = CpuBackend::with_threads(threads).unwrap().with_isa(isa);
            assert!(filtered(&backend, size, window) == expected, "{size:?}, {window}: {threads}, {isa:?}");
        }
    }
}
