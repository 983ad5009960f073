//! `filter_indirect` beside the loop over neighbours that its contract describes, on the same threads, alternately in one run:
//!
//! ```text
//! cargo bench -p twinlight-backend-cpu --bench filter
//! ```
//!
//! The picture is 512 × 512 pixels of a room's corner: three materials, and one surface behind another.

mod support;

use rayon::prelude::*;
use support::{Contender, compare, timed};
use twinlight_backend_cpu::CpuBackend;
use twinlight_core::Backend;
use twinlight_core::kernels::filter_indirect::{FilterIndirectParams, LEAST_ALBEDO, RadianceTexel};
use twinlight_core::kernels::shade_primary::GBufferTexel;

const ROUNDS: usize = 9;
const SIDE: u32 = 512;

struct Picture {
    gbuffer: Vec<GBufferTexel>,
    input: Vec<RadianceTexel>,
    params: FilterIndirectParams,
}

impl Picture {
    fn new(window: u32) -> Self {
        let pixels = || (0..SIDE * SIDE).map(|pixel| (pixel % SIDE, pixel / SIDE));
        let surface = |(x, y): (u32, u32)| {
            let material = x * 3 / SIDE;
            let mut normal = [0.0; 3];
            normal[material as usize] = 1.0;
            let behind = if y < SIDE / 2 { 1.0 } else { 0.0 };
            GBufferTexel {
                position: [x as f32 / SIDE as f32, y as f32 / SIDE as f32, behind],
                depth: 2.0,
                geometric_normal: normal,
                triangle: material,
                shading_normal: normal,
                material,
                albedo: [0.5, 0.25, 0.125],
                padding: 0,
            }
        };
        let light = |(x, y): (u32, u32)| RadianceTexel { rgb: [x as f32, y as f32, 1.0], padding: 0 };
        let params = FilterIndirectParams {
            width: SIDE,
            height: SIDE,
            window,
            least_cosine: 0.9,
            footprint: 0.1,
            padding: [0; 3],
        };
        Self { gbuffer: pixels().map(surface).collect(), input: pixels().map(light).collect(), params }
    }

    /// As the contract says it, neighbour by neighbour.
    fn pixel(&self, pixel: usize) -> RadianceTexel {
        let FilterIndirectParams { width, height, window, .. } = self.params;
        let (x, y, reach) =
            (pixel as i64 % i64::from(width), pixel as i64 / i64::from(width), i64::from(window / 2));
        let centre = &self.gbuffer[pixel];
        let (mut sums, mut weights) = ([0.0; 3], [0.0; 3]);
        for j in -reach..=reach {
            for i in -reach..=reach {
                let (column, row) = (x + i, y + j);
                if column < 0 || row < 0 || column >= i64::from(width) || row >= i64::from(height) {
                    continue;
                }
                let index = (row * i64::from(width) + column) as usize;
                let other = &self.gbuffer[index];
                if !self.joins(centre, other) {
                    continue;
                }
                let half = |offset: i64| if 2 * offset.abs() < i64::from(window) { 1.0 } else { 0.5 };
                let weight = half(j) * half(i);
                for c in 0..3 {
                    if other.albedo[c] >= LEAST_ALBEDO {
                        sums[c] += weight * (self.input[index].rgb[c] / other.albedo[c]);
                        weights[c] += weight;
                    }
                }
            }
        }
        RadianceTexel { rgb: [0, 1, 2].map(|c| centre.albedo[c] * sums[c] / weights[c]), padding: 0 }
    }

    fn joins(&self, centre: &GBufferTexel, other: &GBufferTexel) -> bool {
        let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let along = [0, 1, 2].map(|c| other.position[c] - centre.position[c]);
        let reach = self.params.footprint * self.params.window as f32 * centre.depth;
        other.material == centre.material
            && dot(centre.shading_normal, other.shading_normal) >= self.params.least_cosine
            && dot(centre.geometric_normal, along).abs() <= reach
    }
}

fn main() {
    let backend = CpuBackend::new();
    for window in [4, 8, 16] {
        let picture = Picture::new(window);
        let gbuffer = backend.upload(&picture.gbuffer).expect("memory for the G-buffer");
        let diffuse = backend.upload(&[1; 3]).expect("memory for the materials");
        let input = backend.upload(&picture.input).expect("memory for the light");
        let mut output = backend.zeroed(picture.input.len()).expect("memory for the result");
        let mut loops = picture.input.clone();
        compare(
            &format!("filter_indirect, {SIDE} x {SIDE} pixels, window {window}"),
            ROUNDS,
            &mut [
                Contender {
                    name: "filter_indirect",
                    run: &mut || {
                        timed(|| {
                            let done = backend.filter_indirect(
                                &gbuffer,
                                &diffuse,
                                &input,
                                &picture.params,
                                &mut output,
                            );
                            assert!(done.is_ok());
                        })
                    },
                },
                Contender {
                    name: "a loop over neighbours",
                    run: &mut || {
                        timed(|| {
                            loops
                                .par_iter_mut()
                                .enumerate()
                                .for_each(|(pixel, texel)| *texel = picture.pixel(pixel));
                        })
                    },
                },
            ],
        );
        assert_eq!(output.as_slice(), loops, "the same bits");
    }
}
