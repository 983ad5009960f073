//! Hit buffers of files that move: a skin that bends and an object with keyframes, in a room that stays.
#![cfg(all(feature = "cpu", feature = "io", feature = "methods"))]

use twinlight::Backend;
use twinlight::cpu::CpuBackend;
use twinlight::io::resolve::MemoryFiles;
use twinlight::io::{LoadOptions, toml_scene};
use twinlight::methods::slhb::{Buffers, Kept, LookupSettings, build};
use twinlight::scene::{Limits, Scene, compile};

const ROOM: &str = "
[[mesh]]
name = 'room'
path = 'builtin:cornell'
[[mesh]]
name = 'bending'
path = 'b.glb'
[[mesh]]
name = 'triangle'
path = 'm.obj'
[[instance]]
mesh = 'bending'
translate = [180, 340, 280]
scale = 60
[[instance]]
mesh = 'triangle'
scale = 100
[[instance.motion]]
time = 0
translate = [100, 300, 300]
[[instance.motion]]
time = 2
translate = [300, 400, 200]
[[instance]]
mesh = 'room'
";

fn scene() -> Scene {
    let all = twinlight::fixtures::files::all();
    let glb = all.into_iter().find(|(path, _)| *path == "bending/bending.glb").unwrap().1;
    let triangle = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_vec();
    let files = MemoryFiles::new([("b.glb".to_owned(), glb), ("m.obj".to_owned(), triangle)]);
    toml_scene::parse(ROOM.as_bytes(), "room.toml", &files, &LoadOptions::default()).unwrap()
}

#[test]
fn frames_of_a_skin_and_keyframes_have_the_bits_of_whole_builds() {
    let (scene, backend) = (scene(), CpuBackend::new());
    let settings = LookupSettings {
        directions: "icosahedron:80".parse().unwrap(),
        size: 64,
        ..LookupSettings::default()
    };
    let bits = |buffers: &Buffers<CpuBackend>| {
        let elements = backend.download(&buffers.lhb.elements).unwrap();
        (backend.download(&buffers.lhb.offsets).unwrap(), elements, buffers.lookup)
    };
    let mut kept = Kept::new();
    let mut seen = Vec::new();
    for (i, seconds) in [0.0, 0.3, 1.0, 1.9, 0.3].into_iter().enumerate() {
        let frame = compile(&scene.at(seconds).unwrap(), &Limits::default()).unwrap();
        // The bar's 16 triangles, the cube's 12 and the one; the quad of the file stays, as does the room.
        assert_eq!(frame.parts().1.len(), 29);
        let found = kept.build(&backend, &frame, &settings).unwrap();
        assert_eq!(found.kept_elements > 0, i > 0, "{seconds}");
        let found = bits(&found);
        assert!(found == bits(&build(&backend, &frame, &settings).unwrap()), "{seconds}");
        seen.push(found);
    }
    assert!(seen[1] == seen[4] && seen.windows(2).all(|pair| pair[0] != pair[1]));
}
