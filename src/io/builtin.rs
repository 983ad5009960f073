//! Scenes that need no file: `builtin:NAME`.

use super::text;
use twinlight_core::scene::Scene;
use twinlight_core::{Error, Result};
use twinlight_fixtures::scenes;

/// What a source begins with that names a builtin scene.
pub const PREFIX: &str = "builtin:";

/// Names of the builtin scenes and one line about each.
pub fn names() -> &'static [(&'static str, &'static str)] {
    scenes::builtin_names()
}

/// ` (did you mean 'builtin:x'?)` for a name without the prefix, or nothing when no builtin scene is called like it.
pub(super) fn did_you_mean(name: &str) -> String {
    let near = text::nearest(name, names().iter().map(|&(name, _)| name));
    near.map_or_else(String::new, |near| format!(" (did you mean '{PREFIX}{near}'?)"))
}

/// The builtin scene `name`, without the prefix.
///
/// # Errors
/// [`Error::InvalidInput`] for an unknown name, listing the known ones.
pub fn load(name: &str) -> Result<Scene> {
    if let Some(scene) = scenes::builtin(name) {
        return Ok(scene);
    }
    let known: Vec<&str> = names().iter().map(|&(name, _)| name).collect();
    let hint = text::did_you_mean(name, known.iter().copied());
    let place = format!("{PREFIX}{}", text::shown(name.as_bytes()));
    Err(Error::invalid(place, format!("no such builtin scene{hint}; there are: {}", known.join(", "))))
}
