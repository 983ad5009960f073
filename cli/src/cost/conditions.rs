//! What measurements depend on beside the setting.

use super::setup::Setup;
use crate::args::PictureArgs;
use serde_json::{Value, json};
use twinlight::BackendInfo;
use twinlight::methods::post::image::Image;
use twinlight::scene::{Camera, CompiledScene};

/// What identifies the conditions: measurements under others can't be compared. Not the time limit, so that more time goes on with what is there.
pub fn key(setup: &Setup, camera: &Camera, usual: &PictureArgs, info: &BackendInfo) -> String {
    let (args, prepared) = (setup.args, setup.prepared);
    let conditions: Value = json!({
        "twinlight": env!("CARGO_PKG_VERSION"),
        "scene": args.scene,
        "content": format!("{:016x}", scene_digest(&prepared.compiled)),
        "size": [args.size.0, args.size.1],
        "bounces": setup.bounces,
        "seed": args.seed,
        "camera": format!("{camera:?}"),
        "tone": format!("{:?}", args.tone),
        "usual": format!("{:?} {:?} {:?}", usual.effects, usual.tolerance, usual.sampler),
        "reference_spp": args.reference_spp,
        "backend": [info.kind, &info.device, &info.driver, if info.strict { "strict" } else { "portable" }],
    });
    format!("{:016x}", digest([conditions.to_string().as_bytes()]))
}

/// The same, and the picture that errors are measured against.
pub fn key_with(key: &str, reference: &Image) -> String {
    format!("{:016x}", digest([key.as_bytes(), bytemuck::cast_slice(reference.pixels())]))
}

fn scene_digest(scene: &CompiledScene) -> u64 {
    digest([
        bytemuck::cast_slice(&scene.triangles),
        bytemuck::cast_slice(&scene.attributes),
        bytemuck::cast_slice(&scene.materials),
        bytemuck::cast_slice(&scene.lights),
        bytemuck::cast_slice(&scene.words),
        bytemuck::bytes_of(&scene.environment),
    ])
}

/// FNV-1a of 64 bits: it tells edited scenes apart, and is no defence against anybody.
pub fn digest<const N: usize>(parts: [&[u8]; N]) -> u64 {
    let bytes = parts.into_iter().flatten();
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::digest;

    /// Known answers of Fowler, Noll and Vo.
    #[test]
    fn digests() {
        assert_eq!(digest([b""]), 0xcbf2_9ce4_8422_2325);
        assert_eq!(digest([b"foo", b"bar"]), 0x8594_4171_f739_67e8);
    }
}
