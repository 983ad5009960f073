use super::*;
use twinlight_core::kernels::reduce_mips::{ISOTROPIC, OPAQUE};
use twinlight_core::kernels::trace_cones::{Cone, ConeLight, TraceConesBlock, VoxelFrame};

const BLOCK: TraceConesBlock = TraceConesBlock {
    frame: VoxelFrame { corner: [0.0; 3], voxels_per_unit: 1.0 },
    unit: 1.0,
    reach: 100.0,
    storage: ISOTROPIC,
    flags: 0,
};

fn along_x(origin: [f32; 3]) -> Cone {
    Cone { origin, sine: 0.0, direction: [1.0, 0.0, 0.0], start: 0.0, normal: [0.0; 3], padding: 0 }
}

/// Two half opaque voxels behind each other, seen through their middles.
#[test]
fn two_voxels_by_hand() {
    let half = OPAQUE / 2;
    let pyramid = Pyramid::new(
        [2, 1, 1],
        ISOTROPIC,
        &[0, 2, 3],
        &[0, 1, 0],
        &[8, 4, 2, half, 16, 0, 0, half, 3, 1, 0, 9],
    );
    assert_eq!(pyramid.value(0, [1, 0, 0]), Some([16, 0, 0, half].as_slice()));
    assert_eq!(pyramid.counts(1), [1, 1, 1]);
    let found = possible(&pyramid, &BLOCK, &along_x([0.5, 0.5, 0.5]));
    let want = ConeLight { rgb: [16.0, 4.0, 2.0], transmittance: 0.25 };
    assert!(found.iter().any(|light| light.holds(&want)), "{found:?}");
    for wrong in [
        ConeLight { rgb: [16.01, 4.0, 2.0], transmittance: 0.25 },
        ConeLight { rgb: [16.0, 4.0, 2.0], transmittance: 0.5 },
    ] {
        assert!(!found.iter().any(|light| light.holds(&wrong)), "{wrong:?}");
    }
}

/// On the grid's very end a cone is in it; a step beyond it isn't.
#[test]
fn ends_that_are_exact_are_decided() {
    let pyramid = Pyramid::new([2, 1, 1], ISOTROPIC, &[0, 0, 0], &[], &[]);
    assert_eq!(possible(&pyramid, &BLOCK, &along_x([2.0, 0.5, 0.5])).len(), 1);
    // 0.1 + 0.9 is 1 or beside it in f32: a reach of that is undecided.
    let third = Cone { start: 0.1, ..along_x([0.3, 0.5, 0.5]) };
    let block = TraceConesBlock { reach: 1.1, ..BLOCK };
    assert_eq!(possible(&pyramid, &block, &third).len(), 2);
}

#[test]
fn codes_are_places() {
    assert_eq!(voxel_of(0), [0; 3]);
    assert_eq!(voxel_of(0b110_001), [1, 2, 2]);
}
