//! From the name on the command line to a compiled scene.

use crate::args::LoadArgs;
use crate::exit::{Failure, Stage};
use std::borrow::Cow;
use std::path::Path;
use std::time::{Duration, Instant};
use twinlight::Error;
use twinlight::io::toml_scene::RenderSettings;
use twinlight::io::{self, builtin};
use twinlight::scene::{self, Camera, CompiledScene, Scene};

/// A scene as read, with a camera and a light if it had none.
pub struct Loaded<'a> {
    /// The name on the command line.
    name: &'a str,
    args: &'a LoadArgs,
    /// The scene, with its motion.
    pub scene: Scene,
    /// What a TOML scene file asks for.
    pub settings: RenderSettings,
    /// Time to read.
    load_time: Duration,
}

/// A scene that is ready to be looked at or rendered.
pub struct Prepared<'a> {
    /// As it stands at the moment asked for.
    pub scene: Cow<'a, Scene>,
    /// For backends.
    pub compiled: CompiledScene,
    /// What a TOML scene file asks for.
    pub settings: &'a RenderSettings,
    /// What a person should know.
    pub notices: Vec<String>,
    /// Time to read.
    pub load_time: Duration,
    /// Time to pose and compile.
    pub compile_time: Duration,
}

/// Reads and completes a scene; `camera` comes before the scene's own, so that a light that has to be added stands beside
/// it.
///
/// # Errors
/// Those of the readers; [`Failure::Usage`] for an animation of a scene that does not move.
pub fn load<'a>(name: &'a str, args: &'a LoadArgs, camera: Option<Camera>) -> Result<Loaded<'a>, Failure> {
    let start = Instant::now();
    let (mut scene, settings) =
        io::load_with_settings(name, &args.options()).map_err(Failure::at(Stage::Input))?;
    if args.animation.is_some() && scene.motion.is_empty() {
        return Err(Failure::Usage(format!("'{name}' has no animation to play: leave out --animation")));
    }
    scene.camera = camera.or(scene.camera);
    io::complete(&mut scene);
    Ok(Loaded { name, args, scene, settings, load_time: start.elapsed() })
}

impl Loaded<'_> {
    /// The scene as it stands at a time in seconds, compiled.
    ///
    /// # Errors
    /// Those of [`Scene::at`] and [`scene::compile`].
    pub fn at(&self, seconds: f64) -> Result<Prepared<'_>, Failure> {
        let start = Instant::now();
        let refused = |error| Failure::Library(Stage::Input, in_file(self.name, error));
        let scene = if self.scene.motion.is_empty() {
            Cow::Borrowed(&self.scene)
        } else {
            Cow::Owned(self.scene.at(seconds).map_err(refused)?)
        };
        let compiled = scene::compile(&scene, &self.args.limits()).map_err(refused)?;
        let compile_time = start.elapsed();
        let mut notices = scene.notices.clone();
        notices.extend(compiled.notices.iter().cloned());
        if scene.triangle_count() == 0 {
            notices.push("no triangles in the scene: there is nothing that light could meet".into());
        }
        if !scene.has_light() {
            notices.push("no light in the scene: the picture is black".into());
        }
        let (settings, load_time) = (&self.settings, self.load_time);
        Ok(Prepared { scene, compiled, settings, notices, load_time, compile_time })
    }
}

/// An error about an element of a scene, which does not know what file the scene came from, with the name of the file.
pub fn in_file(name: &str, error: Error) -> Error {
    match error {
        Error::InvalidInput { place, what } => Error::invalid(format!("{name}: {place}"), what),
        other => other,
    }
}

/// What output files are called after: the file name without its extension, or the builtin's name.
pub fn stem(name: &str) -> String {
    match name.strip_prefix(builtin::PREFIX) {
        Some(builtin) => builtin.to_owned(),
        None => {
            Path::new(name).file_stem().map_or_else(|| "scene".into(), |s| s.to_string_lossy().into_owned())
        }
    }
}

/// Bytes of a compiled scene's arrays.
pub fn compiled_bytes(scene: &CompiledScene) -> u64 {
    let bytes = size_of_val(&*scene.triangles)
        + size_of_val(&*scene.attributes)
        + size_of_val(&*scene.materials)
        + size_of_val(&*scene.lights)
        + size_of_val(&*scene.words)
        + size_of_val(&*scene.bvh.nodes);
    bytes as u64
}
