//! `scene inspect`.

use crate::args::InspectArgs;
use crate::exit::Failure;
use crate::report;
use crate::source::{self, Prepared};
use serde_json::{Value, json};
use std::fmt::Write as _;
use twinlight::scene::{Light, MaterialKind, Scene};

/// Moving instances named, at most.
const NAMED: usize = 4;

/// Runs the command.
///
/// # Errors
/// Those of reading the scene.
pub fn run(args: &InspectArgs) -> Result<(), Failure> {
    let loaded = source::load(&args.scene, &args.load, None)?;
    let prepared = loaded.at(0.0)?;
    let motion = Motion::of(&loaded.scene);
    let text = if args.json { json_text } else { text };
    report::print(&text(&args.scene, &prepared, motion.as_ref()))
}

/// What moves.
struct Motion {
    seconds: f64,
    /// Names of the instances.
    moving: Vec<String>,
}

impl Motion {
    fn of(scene: &Scene) -> Option<Self> {
        let instances = scene.instances.iter().zip(scene.moving());
        let moving =
            instances.filter(|(_, moves)| *moves).map(|(instance, _)| instance.name.clone()).collect();
        (!scene.motion.is_empty()).then_some(Self { seconds: scene.motion.duration, moving })
    }

    fn line(&self, instances: usize) -> String {
        let named: Vec<&str> = self.moving.iter().take(NAMED).map(String::as_str).collect();
        let more = if self.moving.len() > NAMED { ", …" } else { "" };
        let count = self.moving.len();
        format!("{:.3} s, {count} of {instances} instances: {}{more}", self.seconds, named.join(", "))
    }
}

/// Kinds of light and how many there are of each.
fn light_counts(prepared: &Prepared) -> Vec<(&'static str, usize)> {
    let scene = &prepared.scene;
    let count = |is: fn(&Light) -> bool| scene.lights.iter().filter(|l| is(l)).count();
    let emissive = prepared.compiled.triangles.iter().filter(|t| t.light != twinlight::scene::NONE).count();
    // A rectangle light is two emissive triangles of the compiled scene.
    let rectangles = count(|l| matches!(l, Light::Rectangle { .. }));
    vec![
        ("point", count(|l| matches!(l, Light::Point { .. }))),
        ("spot", count(|l| matches!(l, Light::Spot { .. }))),
        ("directional", count(|l| matches!(l, Light::Directional { .. }))),
        ("rectangle", rectangles),
        ("sphere", count(|l| matches!(l, Light::Sphere { .. }))),
        ("emissive triangle", emissive.saturating_sub(2 * rectangles)),
        ("environment", usize::from(scene.environment.is_some())),
    ]
}

fn kind_name(kind: MaterialKind) -> &'static str {
    match kind {
        MaterialKind::Opaque => "opaque",
        MaterialKind::Mirror => "mirror",
        MaterialKind::Dielectric { .. } => "dielectric",
    }
}

fn text(name: &str, prepared: &Prepared, motion: Option<&Motion>) -> String {
    let scene = &prepared.scene;
    let mut text = format!("{name}\n");
    // Writing to a string can't fail.
    let _ = writeln!(
        text,
        "  triangles   {} in {} instances of {} meshes",
        scene.triangle_count(),
        scene.instances.len(),
        scene.meshes.len()
    );
    let _ = writeln!(text, "  materials   {}, textures {}", scene.materials.len(), scene.textures.len());
    let lights: Vec<String> = light_counts(prepared)
        .into_iter()
        .filter(|(_, n)| *n > 0)
        .map(|(kind, n)| format!("{n} {kind}"))
        .collect();
    let _ =
        writeln!(text, "  lights      {}", if lights.is_empty() { "none".into() } else { lights.join(", ") });
    if let Some((lo, hi)) = scene.bounds() {
        let _ = writeln!(text, "  bounds      {} to {}", vector(lo.to_array()), vector(hi.to_array()));
    }
    if let Some(c) = &scene.camera {
        let _ = writeln!(
            text,
            "  camera      --camera \"{} {} {} {}\"",
            vector(c.position),
            vector(c.target),
            vector(c.up),
            c.vfov_degrees
        );
    }
    if let Some(motion) = motion {
        let _ = writeln!(text, "  motion      {}", motion.line(scene.instances.len()));
    }
    let _ = writeln!(
        text,
        "  memory      {} compiled",
        report::bytes(source::compiled_bytes(&prepared.compiled))
    );
    let (load, compile) = (prepared.load_time.as_secs_f64(), prepared.compile_time.as_secs_f64());
    let _ = writeln!(text, "  time        {load:.3} s to read, {compile:.3} s to compile");
    for notice in &prepared.notices {
        let _ = writeln!(text, "  notice      {notice}");
    }
    text
}

fn vector(v: [f64; 3]) -> String {
    format!("{},{},{}", v[0], v[1], v[2])
}

fn json_text(name: &str, prepared: &Prepared, motion: Option<&Motion>) -> String {
    let scene = &prepared.scene;
    let meshes: Vec<Value> = scene
        .meshes
        .iter()
        .map(|m| json!({ "name": m.name, "triangles": m.triangles.len(), "vertices": m.positions.len() }))
        .collect();
    let materials: Vec<Value> = scene
        .materials
        .iter()
        .map(|m| {
            json!({
                "name": m.name, "kind": kind_name(m.kind), "albedo": m.albedo, "textured": m.albedo_texture.is_some(),
                "specular": m.specular_f0, "roughness": m.roughness, "emission": m.emission,
            })
        })
        .collect();
    let lights: serde_json::Map<String, Value> =
        light_counts(prepared).into_iter().map(|(kind, n)| (kind.replace(' ', "_"), n.into())).collect();
    let value = json!({
        "scene": name,
        "triangles": scene.triangle_count(),
        "instances": scene.instances.len(),
        "meshes": meshes,
        "materials": materials,
        "textures": scene.textures.iter().map(|t| json!({ "name": t.name, "size": [t.width, t.height] })).collect::<Vec<_>>(),
        "lights": lights,
        "bounds": scene.bounds().map(|(lo, hi)| [lo.to_array(), hi.to_array()]),
        "camera": scene.camera.map(|c| json!({
            "position": c.position, "target": c.target, "up": c.up, "vfov": c.vfov_degrees
        })),
        "motion": motion.map(|m| json!({ "seconds": m.seconds, "moving": m.moving })),
        "bytes": source::compiled_bytes(&prepared.compiled),
        "notices": prepared.notices,
    });
    format!("{value:#}\n")
}
