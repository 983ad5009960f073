//! One voxel, one light.

use super::inputs::{exact_lights, point, sun, under, voxel, voxels, within};
use super::{Case, Checked};
use crate::oracle::light_voxels::Voxel;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use twinlight_core::Backend;
use twinlight_core::kernels::reduce_mips::{MAX_RADIANCE, OPAQUE, VoxelLight};

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "light_voxels":
        no_voxels, no_lights, no_samples, without_fragments, without_normal, both_sides_count, in_the_plane, each_light_alone,
        many_samples_are_a_mean, equal_lights_add_up, rounded_halves_up, saturated, numbers_of_voxels,
    );
}

/// The red channel.
fn reds<B: Backend>(cx: &Context<'_, B>, case: &Case) -> Checked<Vec<u32>> {
    Ok(case.agreed(cx)?.iter().map(|leaf| leaf.rgb[0]).collect())
}

fn no_voxels<B: Backend>(cx: &Context<'_, B>) -> Check {
    under(point([0.0, 3.0, 0.0]), Vec::new()).agrees(cx)
}

/// Emission alone, what was gathered alone, both.
fn no_lights<B: Backend>(cx: &Context<'_, B>) -> Check {
    let dark = voxel([1, 2, 3], [0, 254, 0]);
    let mut glowing = dark;
    glowing.sums.emission = [40, 20, 10];
    let gathered = Voxel { gathered: [1.5, 0.75, 0.25], ..dark };
    let both = Voxel { gathered: gathered.gathered, ..glowing };
    for voxels in [vec![dark], vec![glowing], vec![gathered], vec![dark, glowing, gathered, both]] {
        within(Vec::new(), Vec::new(), voxels).agrees(cx)?;
    }
    within(Vec::new(), Vec::new(), voxels(1, 300)).agrees(cx)
}

/// Lights are as if they were not there.
fn no_samples<B: Backend>(cx: &Context<'_, B>) -> Check {
    under(point([0.3, 2.0, 0.1]), voxels(2, 70)).with(|block| block.samples = 0).agrees(cx)
}

fn without_fragments<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut nothing = voxel([1, 1, 1], [0, 254, 0]);
    nothing.sums.count = 0;
    let lit = Voxel { gathered: [1.0; 3], ..nothing };
    for voxels in [vec![nothing], vec![voxel([1, 1, 1], [0, 1, 0]), lit]] {
        under(point([0.3, 2.0, 0.1]), voxels).agrees(cx)?;
    }
    Ok(())
}

/// Half of what comes from straight above.
fn without_normal<B: Backend>(cx: &Context<'_, B>) -> Check {
    let case = under(sun([0.0, -1.0, 0.0]), vec![voxel([3; 3], [0; 3]), voxel([3; 3], [0, 7, 0])]);
    let reds = reds(cx, &case)?;
    ensure(reds[0].abs_diff(reds[1] / 2) <= 1, || format!("{reds:?}"))
}

/// Normals that face the light and their opposites, behind and in front of a light.
fn both_sides_count<B: Backend>(cx: &Context<'_, B>) -> Check {
    for (name, light) in exact_lights() {
        let voxels = vec![voxel([2, 3, 4], [3, 5, -2]), voxel([2, 3, 4], [-3, -5, 2])];
        let reds = reds(cx, &under(light, voxels)).map_err(|f| f.within(name))?;
        ensure(reds[0] > 0 && reds[0] == reds[1], || format!("{name}: {reds:?}"))?;
    }
    Ok(())
}

/// Light along the surface gives nothing: its cosine is 0 to the bit.
fn in_the_plane<B: Backend>(cx: &Context<'_, B>) -> Check {
    let flat = voxel([4; 3], [0, 254, 0]);
    for light in [sun([1.0, 0.0, 0.0]), point([3.0, 0.125, 0.125])] {
        let leaves = under(light, vec![flat]).agreed(cx)?;
        ensure(leaves == [VoxelLight { rgb: [0; 3], opacity: OPAQUE }], || format!("{leaves:?}"))?;
    }
    Ok(())
}

/// Hundreds of voxels with all normals.
fn each_light_alone<B: Backend>(cx: &Context<'_, B>) -> Check {
    for (seed, (name, light)) in exact_lights().into_iter().enumerate() {
        under(light, voxels(10 + seed as u64, 300)).agrees(cx).map_err(|f| f.within(name))?;
    }
    Ok(())
}

/// One sample, and numbers of them around what is done at a time.
fn many_samples_are_a_mean<B: Backend>(cx: &Context<'_, B>) -> Check {
    let case = under(point([0.3, 2.0, 0.1]), voxels(20, 20));
    for samples in [1, 2, 15, 16, 17, 33, 64] {
        let many = case.with(|block| block.samples = samples);
        many.agrees(cx).map_err(|f| f.within(&format!("{samples} samples")))?;
    }
    Ok(())
}

/// Each is chosen half of the time, and counts twice then.
fn equal_lights_add_up<B: Backend>(cx: &Context<'_, B>) -> Check {
    for (name, light) in exact_lights() {
        let case = within(Vec::new(), vec![light; 2], voxels(30, 60));
        case.with(|block| block.samples = 5).agrees(cx).map_err(|f| f.within(name))?;
    }
    Ok(())
}

/// Emission of quarters of a unit.
fn rounded_halves_up<B: Backend>(cx: &Context<'_, B>) -> Check {
    let glowing = |emission| {
        let mut voxel = voxel([0; 3], [0, 1, 0]);
        voxel.sums.count = 1;
        voxel.sums.emission = [emission; 3];
        voxel
    };
    let case = within(Vec::new(), Vec::new(), (0..9).map(glowing).collect());
    let case = case.with(|block| {
        block.scale = 2.0;
        block.emission_unit = 0.125;
    });
    let reds = reds(cx, &case)?;
    ensure(reds == [0, 0, 1, 1, 1, 1, 2, 2, 2], || format!("{reds:?}"))
}

/// Light beyond the limit stays at it; a scale below 0 makes all of it 0.
fn saturated<B: Backend>(cx: &Context<'_, B>) -> Check {
    let case = under(point([0.3, 2.0, 0.1]), vec![voxel([2, 3, 4], [3, 5, -2])]);
    for (scale, want) in [(1e9, MAX_RADIANCE), (3e38, MAX_RADIANCE), (-1e4, 0), (0.0, 0)] {
        let reds = reds(cx, &case.with(|block| block.scale = scale))?;
        ensure(reds == [want], || format!("scale {scale}: {reds:?}, want {want}"))?;
    }
    Ok(())
}

/// One, and as many as fill a workgroup, or don't.
fn numbers_of_voxels<B: Backend>(cx: &Context<'_, B>) -> Check {
    for count in [1, 2, 63, 64, 65, 257, 1000] {
        let case = under(point([0.3, 2.0, 0.1]), voxels(40, count));
        case.agrees(cx).map_err(|f| f.within(&format!("{count} voxels")))?;
    }
    Ok(())
}
