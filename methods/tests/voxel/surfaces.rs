//! What the surfaces of scenes become.

use twinlight_core::kernels::sum_voxels::{ALBEDO_ONE, NONE, VoxelSurface};
use twinlight_core::scene::{Limits, compile};
use twinlight_fixtures::scenes::builtin;
use twinlight_methods::voxel::{VoxelSurfaces, surfaces};

/// Of a builtin scene, for voxels of 1/64 of its extent.
fn of(name: &str) -> VoxelSurfaces {
    let scene = compile(&builtin(name).unwrap(), &Limits::default()).unwrap();
    let (low, high) = scene.bounds;
    let extent = (0..3).map(|i| high[i] - low[i]).fold(0.0, f32::max);
    surfaces(&scene, extent / 64.0)
}

fn halves([two, blue]: [u32; 2]) -> [u32; 3] {
    [two & 0xffff, two >> 16, blue]
}

fn length(word: u32) -> f64 {
    let c = [0, 8, 16].map(|shift| f64::from((word >> shift) as i8));
    (c[0] * c[0] + c[1] * c[1] + c[2] * c[2]).sqrt()
}

/// The kernel's contract: ranges of coordinates, colours and normals, and texels that are there.
#[test]
fn surfaces_keep_to_the_budget_of_voxels() {
    for name in ["cornell", "textured", "materials", "lights", "axis"] {
        let VoxelSurfaces { surfaces, texels, .. } = of(name);
        for (i, surface) in surfaces.iter().enumerate() {
            let VoxelSurface { normals, texture, texcoords, texture_size, tint, emission, .. } = *surface;
            assert!(
                normals.iter().all(|&word| (length(word) - 127.0).abs() < 1.0),
                "{name} {i}: {normals:x?}"
            );
            assert!(texcoords.iter().flatten().all(|c| c.unsigned_abs() <= 1 << 16), "{name} {i}");
            let colours = halves(tint).into_iter().chain(halves(emission));
            assert!(colours.into_iter().all(|c| c <= ALBEDO_ONE), "{name} {i}");
            let (width, height) = (texture_size & 0xffff, texture_size >> 16);
            assert!(width > 0 && height > 0);
            assert!(texture == NONE || (texture + width * height) as usize <= texels.len(), "{name} {i}");
        }
    }
}

/// The last level of a texture is its mean: both are rounded once, by ½ of 1023.
#[test]
fn the_smallest_texture_is_the_mean() {
    let texture = &builtin("textured").unwrap().textures[0];
    assert!(texture.width.is_power_of_two() && texture.height.is_power_of_two());
    let VoxelSurfaces { texels, .. } = of("textured");
    let finest = &texels[..texture.width as usize * texture.height as usize];
    for shift in [0, 10, 20] {
        let value = |word: &u32| f64::from(word >> shift & 1023);
        let mean = finest.iter().map(value).sum::<f64>() / finest.len() as f64;
        let last = texels.last().map_or(0.0, value);
        assert!((mean - last).abs() <= 1.0 && last > 0.0, "{mean} and {last}");
    }
}
