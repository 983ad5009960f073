//! Pictures in memory.

use twinlight_core::{Error, Result};

/// A picture of named channels, all of one size: what a render writes and a comparison reads.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LayeredImage {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Channels in the order given; files keep them in alphabetical order.
    pub channels: Vec<Channel>,
}

/// One named plane of samples, row-major from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// `R`, `Z`, `direct.G`…: the layer, a point, the component.
    pub name: String,
    /// `width * height` values.
    pub samples: Samples,
}

/// The values of a channel.
#[derive(Debug, Clone, PartialEq)]
pub enum Samples {
    /// Measurements.
    F32(Vec<f32>),
    /// Identifiers.
    U32(Vec<u32>),
}

impl Samples {
    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            Self::F32(v) => v.len(),
            Self::U32(v) => v.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl LayeredImage {
    /// A picture without channels yet.
    pub fn new(width: u32, height: u32) -> Self {
        Self { width, height, channels: Vec::new() }
    }

    /// Adds a float channel.
    pub fn add_f32(&mut self, name: impl Into<String>, samples: Vec<f32>) {
        self.channels.push(Channel { name: name.into(), samples: Samples::F32(samples) });
    }

    /// Adds an integer channel.
    pub fn add_u32(&mut self, name: impl Into<String>, samples: Vec<u32>) {
        self.channels.push(Channel { name: name.into(), samples: Samples::U32(samples) });
    }

    /// Adds three float channels `layer.R`, `layer.G`, `layer.B`, or `R`, `G`, `B` when `layer` is empty.
    pub fn add_rgb(&mut self, layer: &str, pixels: &[[f32; 3]]) {
        self.add_components(layer, ["R", "G", "B"], pixels);
    }

    /// Adds three float channels `layer.X`, `layer.Y`, `layer.Z`.
    pub fn add_xyz(&mut self, layer: &str, vectors: &[[f32; 3]]) {
        self.add_components(layer, ["X", "Y", "Z"], vectors);
    }

    fn add_components(&mut self, layer: &str, names: [&str; 3], pixels: &[[f32; 3]]) {
        for (i, component) in names.into_iter().enumerate() {
            let plane = pixels.iter().map(|p| p[i]).collect();
            let dot = if layer.is_empty() { "" } else { "." };
            self.add_f32(format!("{layer}{dot}{component}"), plane);
        }
    }

    /// The samples of the channel called `name`.
    pub fn channel(&self, name: &str) -> Option<&Samples> {
        self.channels.iter().find(|c| c.name == name).map(|c| &c.samples)
    }

    /// The float samples of the channel called `name`; `None` when there is no such channel or it holds integers.
    pub fn f32_channel(&self, name: &str) -> Option<&[f32]> {
        match self.channel(name) {
            Some(Samples::F32(v)) => Some(v),
            _ => None,
        }
    }

    /// The RGB pixels of `layer` (empty: the top level), or `None` when one of the three channels is missing or holds
    /// integers.
    pub fn rgb(&self, layer: &str) -> Option<Vec<[f32; 3]>> {
        let dot = if layer.is_empty() { "" } else { "." };
        let plane = |c: &str| self.f32_channel(&format!("{layer}{dot}{c}"));
        let (r, g, b) = (plane("R")?, plane("G")?, plane("B")?);
        Some(r.iter().zip(g).zip(b).map(|((&r, &g), &b)| [r, g, b]).collect())
    }

    /// Checks that every channel has `width * height` samples and a name of its own.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] naming the channel.
    pub fn validate(&self) -> Result<()> {
        let pixels = self.width as usize * self.height as usize;
        let side = super::MAX_SIDE;
        if !(1..=side).contains(&self.width) || !(1..=side).contains(&self.height) {
            let what = format!("size {}x{} is not within 1 and {side}", self.width, self.height);
            return Err(Error::invalid("image", what));
        }
        if self.channels.is_empty() {
            return Err(Error::invalid("image", "has no channel"));
        }
        for (i, channel) in self.channels.iter().enumerate() {
            let place = format!("channel '{}'", channel.name);
            if channel.samples.len() != pixels {
                let what =
                    format!("{} samples for {}x{} pixels", channel.samples.len(), self.width, self.height);
                return Err(Error::invalid(place, what));
            }
            if self.channels[..i].iter().any(|other| other.name == channel.name) {
                return Err(Error::invalid(place, "occurs twice"));
            }
        }
        Ok(())
    }
}

/// Linear RGB pixels.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RgbImage {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Row-major from the top.
    pub pixels: Vec<[f32; 3]>,
}
