//! Pictures from a film and a G-buffer.

use crate::exit::Failure;
use twinlight::io::image::LayeredImage;
use twinlight::kernels::shade_primary::GBufferTexel;
use twinlight::methods::Surfaces;
use twinlight::methods::post::image::Image;
use twinlight::methods::post::tonemap::Display;
use twinlight::methods::reference::Film;

/// What files are made from.
pub struct Pictures<'a> {
    film: &'a Film,
    surfaces: Option<&'a Surfaces>,
    beauty: Image,
    display: Display,
}

impl<'a> Pictures<'a> {
    /// Pictures of a film, with the light that was made for `surfaces` where they have some.
    ///
    /// # Errors
    /// When the film has no pixels.
    pub fn new(film: &'a Film, surfaces: Option<&'a Surfaces>, display: Display) -> Result<Self, Failure> {
        let made = surfaces.and_then(|surfaces| surfaces.made.as_ref());
        let radiance = made.map_or_else(|| film.radiance(), |made| made.radiance.clone());
        let beauty = Image::new(film.width(), film.height(), radiance).map_err(Failure::Pictures)?;
        Ok(Self { film, surfaces, beauty, display })
    }

    /// Pixels per row, rows.
    pub fn size(&self) -> (u32, u32) {
        (self.film.width(), self.film.height())
    }

    /// What a screen shows.
    pub fn srgb8(&self) -> Vec<[u8; 3]> {
        self.display.to_srgb8(&self.beauty)
    }

    /// Radiance and everything that was measured beside it.
    pub fn layered(&self) -> LayeredImage {
        let mut image = LayeredImage::new(self.film.width(), self.film.height());
        image.add_rgb("", self.beauty.pixels());
        image.add_rgb("direct", &self.film.direct());
        match self.surfaces.and_then(|surfaces| surfaces.made.as_ref()) {
            Some(made) => image.add_rgb("indirect", &made.indirect),
            None => image.add_rgb("indirect", &self.film.indirect()),
        }
        // That of the samples, whatever is averaged.
        image.add_f32("variance.Y", self.film.variance());
        if let Some(Surfaces { gbuffer, .. }) = self.surfaces {
            let vectors = |pick: fn(&GBufferTexel) -> [f32; 3]| gbuffer.iter().map(pick).collect::<Vec<_>>();
            image.add_rgb("albedo", &vectors(|t| t.albedo));
            image.add_xyz("N", &vectors(|t| t.shading_normal));
            image.add_f32("Z", gbuffer.iter().map(|t| t.depth).collect());
            image.add_u32("id", gbuffer.iter().map(|t| t.triangle).collect());
        }
        image
    }
}
