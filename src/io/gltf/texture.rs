//! Pictures: albedo textures, and the means of those that the surface model has no place for.

use super::Document;
use crate::io::image::decode_texture;
use ::gltf::json;
use ::gltf::json::texture::{Info, WrappingMode};
use ::gltf::json::validation::Checked;
use std::collections::BTreeMap;
use twinlight_core::scene::{Texture, Wrap};
use twinlight_core::{Error, Result, srgb};

/// An albedo texture and the coordinates it is read at.
pub(super) struct TextureUse {
    /// Index into the scene's textures.
    pub texture: u32,
    /// Which `TEXCOORD_n`.
    pub set: u32,
    /// From the file's coordinates to the scene's.
    pub transform: UvTransform,
}

/// KHR_texture_transform, followed by the flip from glTF's top-left to the scene's bottom-left origin.
#[derive(Debug, Clone, Copy)]
pub(super) struct UvTransform {
    /// Rows of the linear part.
    linear: [[f64; 2]; 2],
    offset: [f64; 2],
}

impl UvTransform {
    const IDENTITY: Self = Self { linear: [[1.0, 0.0], [0.0, 1.0]], offset: [0.0, 0.0] };

    fn new(offset: [f32; 2], rotation: f32, scale: [f32; 2]) -> Self {
        let (sin, cos) = f64::from(rotation).sin_cos();
        let [su, sv] = scale.map(f64::from);
        // v points down, so that this turns counter-clockwise for positive angles, as the extension's text asks. Its GLSL
        // sample turns the other way (KhronosGroup/glTF issue 1563); its test model and other readers follow the text.
        Self { linear: [[cos * su, sin * sv], [-sin * su, cos * sv]], offset: offset.map(f64::from) }
    }

    pub fn apply(&self, uv: [f32; 2]) -> [f32; 2] {
        let [u, v] = uv.map(f64::from);
        let row = |i: usize| self.linear[i][0] * u + self.linear[i][1] * v + self.offset[i];
        [row(0) as f32, (1.0 - row(1)) as f32]
    }
}

/// What is left of a picture when its places are forgotten.
#[derive(Clone, Copy)]
pub(super) struct Mean {
    /// Mean of the decoded colours.
    pub linear: [f32; 3],
    /// Mean of the stored values over 255.
    pub stored: [f32; 3],
}

/// The textures of a scene being read.
#[derive(Default)]
pub(super) struct Textures {
    list: Vec<Texture>,
    by_image: BTreeMap<(usize, bool), Option<u32>>,
    means: BTreeMap<usize, Option<Mean>>,
}

impl Textures {
    pub fn into_list(self) -> Vec<Texture> {
        self.list
    }

    /// The texture that `info` refers to; `None`, with a notice, when its picture can't be read and the caller is not
    /// strict.
    pub fn albedo(&mut self, document: &Document, info: &Info, path: &str) -> Result<Option<TextureUse>> {
        let texture = document.get(&document.root.textures, info.index, "texture", path)?;
        let clamp = document.wrap(texture, path)? == Wrap::Clamp;
        let key = (texture.source.value(), clamp);
        let index = match self.by_image.get(&key) {
            Some(known) => *known,
            None => {
                let decoded = document.picture(texture.source, path)?;
                let index = decoded.map(|mut picture| {
                    picture.wrap = if clamp { Wrap::Clamp } else { Wrap::Repeat };
                    self.list.push(picture);
                    self.list.len() as u32 - 1
                });
                self.by_image.insert(key, index);
                index
            }
        };
        let extension = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref());
        let transform = extension
            .map_or(UvTransform::IDENTITY, |t| UvTransform::new(t.offset.0, t.rotation.0, t.scale.0));
        let set = extension.and_then(|t| t.tex_coord).unwrap_or(info.tex_coord);
        Ok(index.map(|texture| TextureUse { texture, set, transform }))
    }

    /// The mean of the picture that `info` refers to.
    pub fn mean(&mut self, document: &Document, info: &Info, path: &str) -> Result<Option<Mean>> {
        let texture = document.get(&document.root.textures, info.index, "texture", path)?;
        let image = texture.source.value();
        if let Some(known) = self.means.get(&image) {
            return Ok(*known);
        }
        let mean = document.picture(texture.source, path)?.map(|picture| mean(&picture));
        self.means.insert(image, mean);
        Ok(mean)
    }
}

impl Document<'_> {
    fn wrap(&self, texture: &json::Texture, path: &str) -> Result<Wrap> {
        let Some(sampler) = texture.sampler else { return Ok(Wrap::Repeat) };
        let sampler = self.get(&self.root.samplers, sampler, "sampler", path)?;
        match (sampler.wrap_s, sampler.wrap_t) {
            (Checked::Valid(WrappingMode::Repeat), Checked::Valid(WrappingMode::Repeat)) => Ok(Wrap::Repeat),
            (Checked::Valid(WrappingMode::ClampToEdge), Checked::Valid(WrappingMode::ClampToEdge)) => {
                Ok(Wrap::Clamp)
            }
            (Checked::Valid(_), Checked::Valid(_)) => {
                self.note("textures that mirror, or clamp on one axis, repeated instead", path);
                Ok(Wrap::Repeat)
            }
            _ => Err(self.invalid(path, "sampler has no valid wrapping mode")),
        }
    }

    fn picture(&self, index: json::Index<json::Image>, path: &str) -> Result<Option<Texture>> {
        let image = self.get(&self.root.images, index, "image", path)?;
        let path = format!("images[{}]", index.value());
        let name = match (&image.name, &image.uri) {
            (_, Some(uri)) if !uri.starts_with("data:") => uri.clone(),
            (Some(name), _) => name.clone(),
            _ => path.clone(),
        };
        match self.decoded(image, &name, &path) {
            Ok(picture) => Ok(Some(picture)),
            Err(Refused { error, forgivable: true }) if !self.options.strict => {
                self.note("textures left out, because their pictures can't be read", error.to_string());
                Ok(None)
            }
            Err(refused) => Err(refused.error),
        }
    }

    fn decoded(&self, image: &json::Image, name: &str, path: &str) -> std::result::Result<Texture, Refused> {
        let limits = self.budget.limits();
        let label = format!("{}: {name}", self.name);
        let decode = |bytes: &[u8]| decode_texture(bytes, &label, limits).map_err(Refused::decoding);
        let picture = match (&image.uri, image.buffer_view) {
            (Some(uri), _) => decode(
                &self
                    .uri_bytes(uri, path)
                    .map_err(|e| Refused { forgivable: is_missing(&e), error: self.unread(e, uri, path) })?,
            ),
            (None, Some(view)) => decode(self.view(view, path).map_err(Refused::reading)?.bytes()),
            (None, None) => Err(Refused::reading(self.invalid(path, "has neither a URI nor a buffer view"))),
        }?;
        let bytes = picture.texels.len() as u64 * 4;
        self.budget.spend(|| label.clone(), bytes, 1).map_err(Refused::reading)?;
        Ok(picture)
    }
}

/// Why there is no picture, and whether the rest of the scene is worth showing without it: a missing or damaged picture
/// is no reason to refuse all; a reference to a place that may not be read, or more than the limits allow, is.
struct Refused {
    error: Error,
    forgivable: bool,
}

impl Refused {
    fn reading(error: Error) -> Self {
        Self { forgivable: is_missing(&error), error }
    }

    fn decoding(error: Error) -> Self {
        Self { forgivable: !matches!(error, Error::LimitExceeded { .. }), error }
    }
}

fn is_missing(error: &Error) -> bool {
    matches!(error, Error::Io { .. })
}

fn mean(picture: &Texture) -> Mean {
    let linear: Vec<f64> = (0..=255_u8).map(|b| srgb::decode(f64::from(b) / 255.0)).collect();
    let (mut decoded, mut stored) = ([0.0; 3], [0_u64; 3]);
    for texel in &picture.texels {
        for c in 0..3 {
            decoded[c] += linear[usize::from(texel[c])];
            stored[c] += u64::from(texel[c]);
        }
    }
    let count = picture.texels.len().max(1) as f64;
    Mean {
        linear: decoded.map(|s| (s / count) as f32),
        stored: stored.map(|s| (s as f64 / count / 255.0) as f32),
    }
}

#[cfg(test)]
mod tests {
    use super::UvTransform;

    #[test]
    fn texture_transforms_of_the_extension() {
        let near = |t: UvTransform, uv, expected: [f32; 2]| {
            let got = t.apply(uv);
            assert!(got.iter().zip(expected).all(|(g, e)| (g - e).abs() < 1e-6), "{uv:?} → {got:?}");
        };
        // Expected values are those of the top-left origin, with 1 − v for the flip.
        near(UvTransform::IDENTITY, [0.25, 0.75], [0.25, 0.25]);
        near(UvTransform::new([0.5, 0.25], 0.0, [2.0, 4.0]), [0.1, 0.1], [0.7, 1.0 - 0.65]);
        // A quarter turn counter-clockwise with v down takes the u axis to −v.
        near(UvTransform::new([0.0, 0.0], std::f32::consts::FRAC_PI_2, [1.0, 1.0]), [1.0, 0.0], [0.0, 2.0]);
        near(UvTransform::new([0.0, 0.0], std::f32::consts::FRAC_PI_2, [1.0, 1.0]), [0.0, 1.0], [1.0, 1.0]);
    }
}
