//! Pictures in the folder of a study.

use super::conditions::digest;
use super::judge::Taken;
use super::records::Words;
use crate::exit::{Failure, Stage};
use std::path::{Path, PathBuf};
use twinlight::Error;
use twinlight::io::image::{LayeredImage, exr, png, read_layers, read_rgb};
use twinlight::io::resolve::read_limited;
use twinlight::methods::cost::Reference;
use twinlight::methods::post::image::Image;
use twinlight::methods::post::tonemap::Display;
use twinlight::scene::Limits;

/// Largest picture file that is read.
const MAX_FILE_BYTES: u64 = 4 << 30;

/// Layers of the reference's halves.
const HALVES: [&str; 2] = ["first", "second"];

/// Where pictures are kept, and how they are shown.
pub struct Pictures {
    folder: PathBuf,
    key: String,
    tone: Display,
}

impl Pictures {
    /// In a folder, under the conditions of `key`.
    pub fn new(folder: &Path, key: &str, tone: Display) -> Self {
        Self { folder: folder.into(), key: key.into(), tone }
    }

    /// A picture that somebody has.
    ///
    /// # Errors
    /// What the readers refuse; [`Failure::Usage`] for another size.
    pub fn read_reference(&self, path: &Path, size: (u32, u32)) -> Result<Reference, Failure> {
        let name = path.display().to_string();
        let read = || read_rgb(&read_limited(path, MAX_FILE_BYTES)?, &name, &Limits::default());
        let rgb = read().map_err(Failure::at(Stage::Pictures))?;
        if (rgb.width, rgb.height) != size {
            let (width, height) = (rgb.width, rgb.height);
            return Err(Failure::Usage(format!(
                "'{name}' has {width}x{height} pixels: add --size {width}x{height}"
            )));
        }
        let image = Image::new(rgb.width, rgb.height, rgb.pixels).map_err(Failure::Pictures)?;
        Ok(Reference::single(image))
    }

    /// The reference of an earlier run under the same conditions; `None` if there is none that can be read.
    pub fn kept_reference(&self) -> Option<(Reference, Taken)> {
        let bytes = read_limited(&self.reference_path(), MAX_FILE_BYTES).ok()?;
        let limits = Limits::default();
        let attributes = exr::read_attributes(&bytes, "reference", &limits).ok()?;
        let attribute = |wanted| attributes.iter().find(|(name, _)| name == wanted).map(|(_, value)| value);
        let taken = Taken {
            samples: attribute("samples")?.parse().ok()?,
            seconds: attribute("seconds")?.parse().ok()?,
        };
        if attribute("conditions") != Some(&self.key) {
            return None;
        }
        let layers = read_layers(&bytes, "reference", &limits).ok()?;
        let half = |name| Image::new(layers.width, layers.height, layers.rgb(name)?).ok();
        let reference = Reference::of_halves(half(HALVES[0])?, half(HALVES[1])?).ok()?;
        Some((reference, taken))
    }

    /// Keeps the reference for later runs: its mean, as a picture, and its halves.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn keep_reference(&self, first: &Image, second: &Image, taken: Taken) -> Result<(), Failure> {
        let mean = Reference::of_halves(first.clone(), second.clone()).map_err(Failure::Pictures)?;
        let mut layers = LayeredImage::new(first.width(), first.height());
        layers.add_rgb("", mean.image().pixels());
        layers.add_rgb(HALVES[0], first.pixels());
        layers.add_rgb(HALVES[1], second.pixels());
        let (samples, seconds) = (taken.samples.to_string(), taken.seconds.to_string());
        let attributes =
            [("conditions", self.key.as_str()), ("samples", samples.as_str()), ("seconds", seconds.as_str())];
        exr::write(&self.reference_path(), &layers, &attributes).map_err(Failure::at(Stage::Output))
    }

    fn reference_path(&self) -> PathBuf {
        self.folder.join("reference.exr")
    }

    /// Keeps what a setting made, as it is shown.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn keep(&self, setting: &Words, image: &Image) -> Result<(), Failure> {
        let path = self.path(setting);
        let folder = path.parent().unwrap_or(&self.folder);
        std::fs::create_dir_all(folder)
            .map_err(|source| Failure::Library(Stage::Output, Error::Io { path: folder.into(), source }))?;
        png::write(&path, image.width(), image.height(), &self.tone.to_srgb8(image))
            .map_err(Failure::at(Stage::Output))
    }

    /// What was kept of a setting, as PNG; `None` if somebody took it away.
    pub fn kept(&self, setting: &Words) -> Option<Vec<u8>> {
        std::fs::read(self.path(setting)).ok()
    }

    /// An image as PNG.
    ///
    /// # Errors
    /// [`Error::Internal`] of the encoder.
    pub fn png(&self, image: &Image) -> Result<Vec<u8>, Failure> {
        let pixels = self.tone.to_srgb8(image);
        png::encode(image.width(), image.height(), &pixels).map_err(Failure::at(Stage::Output))
    }

    fn path(&self, setting: &Words) -> PathBuf {
        let flags = format!("{:?}", setting.flags);
        let digest = digest([self.key.as_bytes(), flags.as_bytes()]);
        self.folder.join("pictures").join(format!("{}-{digest:016x}.png", setting.method))
    }
}
