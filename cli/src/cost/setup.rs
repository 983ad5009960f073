//! What every render of a study has in common.

use super::command::{Flags, Render};
use super::progress::Display;
use crate::args::{Bounces, CostArgs};
use crate::exit::Failure;
use crate::interrupt::Interrupt;
use crate::render::Job;
use crate::source::Prepared;
use twinlight::methods::post::image::Image;
use twinlight::methods::post::tonemap;
use twinlight::methods::reference::{Control, Progress};

/// As often light scatters at most, unless the scene or a flag says otherwise: methods can be compared where they simulate the same light.
const BOUNCES: u32 = 4;

/// The scene, the picture of it, and who watches.
pub struct Setup<'a> {
    pub args: &'a CostArgs,
    pub prepared: &'a Prepared<'a>,
    /// Of the reference and of every method.
    pub bounces: Option<u32>,
    pub tone: tonemap::Display,
    pub interrupt: Interrupt,
    pub progress: Display,
}

impl<'a> Setup<'a> {
    /// As the flags and the scene say.
    pub fn new(
        args: &'a CostArgs,
        prepared: &'a Prepared<'a>,
        tone: tonemap::Display,
        interrupt: Interrupt,
    ) -> Self {
        let bounces = match args.bounces {
            Some(Bounces(bounces)) => bounces,
            None => prepared.settings.bounces.or(Some(BOUNCES)),
        };
        Self { args, prepared, bounces, tone, interrupt, progress: Display::new(args.progress) }
    }

    /// The render of some flags.
    pub fn render(&self, method: &'static str, flags: Flags, seed: u32) -> Render<'a> {
        Render { args: self.args, bounces: self.bounces, seed, method, flags }
    }

    /// The same, ready to run.
    ///
    /// # Errors
    /// As [`Render::picture`] and [`Job::new`].
    pub fn job(&self, method: &'static str, flags: Flags, seed: u32) -> Result<Job, Failure> {
        Job::new(&self.render(method, flags, seed).picture()?, None, self.prepared)
    }

    /// Radiance as an image.
    ///
    /// # Errors
    /// [`Failure::Pictures`] if the pixels are not those of the size.
    pub fn image(&self, radiance: Vec<[f32; 3]>) -> Result<Image, Failure> {
        Image::new(self.args.size.0, self.args.size.1, radiance).map_err(Failure::Pictures)
    }

    /// Stops after a signal.
    pub fn control(&self, _: Progress) -> Control {
        if self.interrupt.caught().is_some() { Control::Stop } else { Control::Continue }
    }
}
