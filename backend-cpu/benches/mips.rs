//! Levels over the active voxels beside levels of all voxels, on the same threads, alternately in one run:
//!
//! ```text
//! cargo bench -p twinlight-backend-cpu --bench mips
//! ```
//!
//! The grid has 256³ voxels, of which shells of balls are active, about half a million, and values are isotropic. The dense contender has
//! an array per level, in the same order of codes, so that the 8 children of a voxel follow each other; it is given its leaves in place.

mod support;

use rayon::prelude::*;
use std::collections::BTreeMap;
use support::{Contender, compare, timed};
use twinlight_backend_cpu::{CpuBackend, CpuBuffer};
use twinlight_core::Backend;
use twinlight_core::kernels::reduce_mips::{ISOTROPIC, OPAQUE, ReduceMipsParams, VoxelLight};
use twinlight_core::kernels::voxelize::{VoxelBuffers, Voxels};
use twinlight_core::lattice::VoxelGrid;
use twinlight_core::math::morton::morton_code;
use twinlight_fixtures::random::Random;

const ROUNDS: usize = 9;
const SIDE: u32 = 256;
const BALLS: usize = 250;

type Value = [u32; 4];

/// The voxels in which the distance from a centre passes a radius.
fn shells() -> BTreeMap<u32, VoxelLight> {
    let mut random = Random::new(1);
    let mut leaves = BTreeMap::new();
    for _ in 0..BALLS {
        let centre = [(); 3].map(|()| random.between(30.0, f64::from(SIDE) - 30.0));
        let radius = random.between(4.0, 24.0);
        let range = |axis: usize| {
            let from = (centre[axis] - radius - 1.0) as u32;
            from..=(centre[axis] + radius + 1.0) as u32
        };
        for z in range(2) {
            for y in range(1) {
                for x in range(0) {
                    let along = [x, y, z].map(f64::from);
                    let square: f64 = (0..3).map(|axis| (along[axis] - centre[axis]).powi(2)).sum();
                    if (square.sqrt() - radius).abs() <= 0.5 {
                        let rgb = [x, y, z].map(|c| c * 1_000);
                        leaves.insert(morton_code([x, y, z]), VoxelLight { rgb, opacity: OPAQUE / 2 });
                    }
                }
            }
        }
    }
    leaves
}

fn voxels(leaves: &BTreeMap<u32, VoxelLight>) -> Voxels<CpuBackend> {
    let subvoxel_bits = 15 - SIDE.trailing_zeros();
    let grid = VoxelGrid { dims: [SIDE; 3], scale: 1 << 14, offset: [0; 3], subvoxel_bits };
    let mut mask = vec![0_u32; grid.mask_words()];
    leaves.keys().for_each(|&code| mask[(code >> 5) as usize] |= 1 << (code & 31));
    let mut ranks = vec![0];
    for word in &mask {
        ranks.push(ranks[ranks.len() - 1] + word.count_ones());
    }
    let active: Vec<u32> = leaves.keys().copied().collect();
    let mut parents: Vec<u32> = active.iter().map(|code| code >> 3).collect();
    parents.dedup();
    let [mask, ranks, active, parents] = [mask, ranks, active, parents].map(CpuBuffer::from);
    let [small, large] = [Vec::new(), Vec::new()].map(CpuBuffer::from);
    VoxelBuffers { grid, small, large, mask, ranks, active, parents }
}

/// Values of all voxels, level by level.
fn dense(leaves: &BTreeMap<u32, VoxelLight>) -> Vec<Vec<Value>> {
    let mut level = SIDE.pow(3) as usize;
    let mut levels = Vec::new();
    while level > 0 {
        levels.push(vec![[0; 4]; level]);
        level /= 8;
    }
    for (&code, light) in leaves {
        let [r, g, b] = light.rgb;
        levels[0][code as usize] = [r, g, b, light.opacity];
    }
    levels
}

fn reduce_dense(levels: &mut [Vec<Value>]) {
    for level in 1..levels.len() {
        let (below, above) = levels.split_at_mut(level);
        let children = below[level - 1].as_chunks::<8>().0;
        let parents = above[0].par_iter_mut().with_min_len(1 << 11);
        parents.zip(children).for_each(|(parent, children)| {
            let mut sums = [4; 4];
            for child in children {
                (0..4).for_each(|word| sums[word] += child[word]);
            }
            *parent = sums.map(|sum: u32| sum >> 3);
        });
    }
}

fn main() {
    let backend = CpuBackend::new();
    let leaves = shells();
    let voxels = voxels(&leaves);
    let lights: Vec<VoxelLight> = leaves.values().copied().collect();
    let lights = backend.upload(&lights).expect("memory for the leaves");
    let levels = backend.voxel_levels(&voxels).expect("memory for the levels");
    let params = ReduceMipsParams { storage: ISOTROPIC };
    let reduced = || backend.reduce_mips(&levels, &lights, &params).expect("memory for the values");
    let mut arrays = dense(&leaves);
    compare(
        &format!("isotropic mips of {} of {SIDE}³ voxels", leaves.len()),
        ROUNDS,
        &mut [
            Contender { name: "reduce_mips", run: &mut || timed(|| drop(reduced())) },
            Contender {
                name: "voxel_levels and reduce_mips",
                run: &mut || {
                    timed(|| {
                        let levels = backend.voxel_levels(&voxels).expect("memory for the levels");
                        drop(backend.reduce_mips(&levels, &lights, &params).expect("memory for the values"));
                    })
                },
            },
            Contender { name: "dense arrays", run: &mut || timed(|| reduce_dense(&mut arrays)) },
        ],
    );
    let values = reduced();
    for (level, ends) in levels.starts.windows(2).enumerate() {
        for i in ends[0] as usize..ends[1] as usize {
            let code = levels.active.as_slice()[i] as usize;
            assert_eq!(values.as_slice()[4 * i..][..4], arrays[level][code], "the same bits");
        }
    }
}
