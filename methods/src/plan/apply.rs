//! A scene without what a plan leaves out.

use std::borrow::Cow;
use twinlight_core::scene::{
    CompiledScene, LIGHT_ENVIRONMENT, MATERIAL_DIELECTRIC, MATERIAL_MIRROR, MATERIAL_OPAQUE, NONE,
    NOTHING_HIDES,
};

/// What a plan changes about a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Edits {
    /// Shadow rays aren't sent: nothing hides a light, or it is as if.
    pub nothing_hides: bool,
    /// No lobes.
    pub drop_glossy: bool,
    /// Mirrors are black.
    pub drop_mirrors: bool,
    /// Glass is black.
    pub drop_glass: bool,
    /// Surfaces have their materials' albedo alone.
    pub drop_textures: bool,
    /// No light from the surroundings.
    pub drop_environment: bool,
}

impl Edits {
    /// The scene with these changes; the same where there are none.
    pub fn apply(self, scene: &CompiledScene) -> Cow<'_, CompiledScene> {
        if self == Self::default() {
            return Cow::Borrowed(scene);
        }
        let mut scene = scene.clone();
        if self.nothing_hides {
            scene.environment.flags |= NOTHING_HIDES;
        }
        self.edit_materials(&mut scene);
        if self.drop_environment {
            drop_environment(&mut scene);
        }
        Cow::Owned(scene)
    }

    fn edit_materials(self, scene: &mut CompiledScene) {
        for material in &mut scene.materials {
            let is_dropped = match material.kind {
                MATERIAL_MIRROR => self.drop_mirrors,
                MATERIAL_DIELECTRIC => self.drop_glass,
                _ => false,
            };
            if is_dropped {
                (material.kind, material.albedo) = (MATERIAL_OPAQUE, [0.0; 3]);
                material.texture_offset = NONE;
            }
            if is_dropped || (self.drop_glossy && material.kind == MATERIAL_OPAQUE) {
                (material.specular_f0, material.specular_f90) = ([0.0; 3], 0.0);
            }
            if self.drop_textures {
                material.texture_offset = NONE;
            }
        }
    }
}

/// The environment stays in the list of lights, where others are chosen with the probabilities that they had, and gives none.
fn drop_environment(scene: &mut CompiledScene) {
    for light in scene.lights.iter_mut().filter(|light| light.kind == LIGHT_ENVIRONMENT) {
        light.emission = [0.0; 3];
    }
    let header = scene.environment;
    if header.offset == NONE {
        return;
    }
    let (begin, texels) = (header.offset as usize, header.width as usize * header.height as usize);
    for texel in 0..texels {
        let first = begin + header.height as usize + 1 + 6 * texel;
        scene.words[first..first + 3].fill(0);
    }
}
