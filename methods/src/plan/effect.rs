//! The effects that light has, and what is decided about each.

use std::fmt;
use std::str::FromStr;
use twinlight_core::{Error, Result};

/// Something that light does, which takes work to simulate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Effect {
    /// Light straight from emitters into the camera.
    Emission,
    /// Light that surfaces scatter once.
    DirectLight,
    /// That surfaces hide lights from others.
    Shadows,
    /// Edges of the shadows of lights with an extent.
    SoftShadows,
    /// Light from the surroundings, by a map of directions.
    EnvironmentLight,
    /// Light that surfaces scatter more than once.
    Interreflection,
    /// Reflection in a lobe around the mirrored direction.
    GlossyReflection,
    /// Reflection in the mirrored direction alone.
    MirrorReflection,
    /// Light through glass.
    Refraction,
    /// Light that mirrors, glass and lobes throw onto other surfaces.
    Caustics,
    /// Colours that vary over a surface.
    Textures,
    /// Geometry that is not where it was.
    Motion,
}

impl Effect {
    /// All, in the order of reports, and their names.
    pub const NAMES: [(Self, &'static str); 12] = [
        (Self::Emission, "emission"),
        (Self::DirectLight, "direct"),
        (Self::Shadows, "shadows"),
        (Self::SoftShadows, "soft-shadows"),
        (Self::EnvironmentLight, "environment"),
        (Self::Interreflection, "interreflection"),
        (Self::GlossyReflection, "glossy"),
        (Self::MirrorReflection, "mirror"),
        (Self::Refraction, "refraction"),
        (Self::Caustics, "caustics"),
        (Self::Textures, "textures"),
        (Self::Motion, "motion"),
    ];

    /// Those that a person may leave out ([`Effects::Only`]): a scene without them is a scene. The others follow from what is left.
    pub const OPTIONAL: [Self; 7] = [
        Self::Shadows,
        Self::EnvironmentLight,
        Self::Interreflection,
        Self::GlossyReflection,
        Self::MirrorReflection,
        Self::Refraction,
        Self::Textures,
    ];

    /// As it is written on the command line.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(effect, _)| *effect == self).map_or("", |(_, name)| name)
    }
}

impl fmt::Display for Effect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Which effects are simulated.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Effects {
    /// Those that the scene calls for, up to the tolerance.
    #[default]
    Auto,
    /// Everything that the method can do, whether the scene has it or not.
    All,
    /// Of [`Effect::OPTIONAL`], these alone; of them, those that the scene calls for.
    Only(Vec<Effect>),
}

impl Effects {
    /// Whether a person wants `effect`.
    pub(super) fn admit(&self, effect: Effect) -> bool {
        match self {
            Self::Only(list) => list.contains(&effect) || !Effect::OPTIONAL.contains(&effect),
            _ => true,
        }
    }
}

impl fmt::Display for Effects {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => f.write_str("auto"),
            Self::All => f.write_str("all"),
            Self::Only(list) if list.is_empty() => f.write_str("none"),
            Self::Only(list) => {
                let names: Vec<&str> = list.iter().map(|effect| effect.name()).collect();
                f.write_str(&names.join(","))
            }
        }
    }
}

impl FromStr for Effects {
    type Err = Error;

    /// `auto`, `all`, `none`, or names of [`Effect::OPTIONAL`] with commas between them.
    fn from_str(text: &str) -> Result<Self> {
        let effect = |name: &str| {
            let found = Effect::OPTIONAL.into_iter().find(|effect| effect.name() == name);
            found.ok_or_else(|| {
                let names = Effect::OPTIONAL.map(Effect::name).join(", ");
                Error::invalid("effects", format!("'{name}' is none of auto, all, none, {names}"))
            })
        };
        match text {
            "auto" => Ok(Self::Auto),
            "all" => Ok(Self::All),
            "none" => Ok(Self::Only(Vec::new())),
            _ => Ok(Self::Only(text.split(',').map(effect).collect::<Result<_>>()?)),
        }
    }
}

/// What is decided about an effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Decision {
    /// It is simulated.
    Run,
    /// It is simulated as far as the bound says.
    Bounded,
    /// It is not simulated: the scene does without it, or a person does.
    Skipped,
    /// The scene calls for it, and the method has no way to simulate it.
    Lacking,
}

impl fmt::Display for Decision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Run => "run",
            Self::Bounded => "bounded",
            Self::Skipped => "skipped",
            Self::Lacking => "lacking",
        })
    }
}

/// An effect, what is decided about it, and why.
#[derive(Debug, Clone, PartialEq)]
pub struct Decided {
    /// The effect.
    pub effect: Effect,
    /// The decision.
    pub decision: Decision,
    /// Why, as a clause.
    pub reason: String,
    /// Most radiance that a pixel lacks because of it, beside a picture with all effects; infinite where nothing is known, NaN never.
    pub bound: f64,
}
