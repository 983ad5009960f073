//! Cuts a render into passes of about the same time, whatever the device's speed.

use std::time::Duration;

/// A rectangle of pixels and samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pass {
    pub(super) pixel_begin: u32,
    pub(super) pixel_count: u32,
    pub(super) sample_begin: u32,
    pub(super) sample_count: u32,
}

/// Passes in order: all pixels of some samples before the next samples.
#[derive(Debug)]
pub(super) struct Schedule {
    pixels: u32,
    samples: u32,
    sample: u32,
    /// Samples of the row of passes under way.
    sample_count: u32,
    pixel: u32,
    /// Paths (pixels × samples) that should fill one pass.
    paths_per_pass: u64,
    /// What a pass should take.
    time: Duration,
}

impl Schedule {
    pub(super) fn new(pixels: u32, samples: u32, time: Duration) -> Self {
        // The first pass is small: nothing is known about the device's speed.
        Self { pixels, samples, sample: 0, sample_count: 1, pixel: 0, paths_per_pass: 4096, time }
    }

    pub(super) fn next(&mut self) -> Option<Pass> {
        if self.is_done() {
            return None;
        }
        if self.pixel == 0 {
            let fitting = self.paths_per_pass / u64::from(self.pixels);
            self.sample_count = (fitting.max(1) as u32).min(self.samples - self.sample);
        }
        let fitting = (self.paths_per_pass / u64::from(self.sample_count)).max(1);
        let pixel_count = u64::from(self.pixels - self.pixel).min(fitting) as u32;
        let pass = Pass {
            pixel_begin: self.pixel,
            pixel_count,
            sample_begin: self.sample,
            sample_count: self.sample_count,
        };
        self.pixel += pixel_count;
        if self.pixel == self.pixels {
            self.pixel = 0;
            self.sample += self.sample_count;
        }
        Some(pass)
    }

    /// Learns from the time a pass took.
    pub(super) fn took(&mut self, pass: &Pass, time: Duration) {
        let paths = u64::from(pass.pixel_count) * u64::from(pass.sample_count);
        let ratio = self.time.as_secs_f64() / time.as_secs_f64().max(1e-6);
        let ideal = (paths as f64 * ratio) as u64;
        // At most four times more at once: the next pixels may be costlier.
        self.paths_per_pass = ideal.clamp(256, self.paths_per_pass.saturating_mul(4)).min(1 << 32);
    }

    pub(super) fn is_done(&self) -> bool {
        self.sample >= self.samples
    }

    /// Samples that every pixel has.
    pub(super) fn whole_samples(&self) -> u32 {
        self.sample
    }

    pub(super) fn fraction(&self) -> f64 {
        let partial = f64::from(self.pixel) / f64::from(self.pixels) * f64::from(self.sample_count);
        ((f64::from(self.sample) + partial) / f64::from(self.samples)).min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_cover_every_path_once() {
        for (pixels, samples, milliseconds) in [(1, 1, 1), (7, 13, 900), (10_000, 5, 3), (100, 4096, 40)] {
            let mut schedule = Schedule::new(pixels, samples, Duration::from_millis(250));
            let mut done = vec![0_u32; pixels as usize];
            let mut fraction = 0.0;
            while let Some(pass) = schedule.next() {
                assert!(pass.pixel_count > 0 && pass.sample_count > 0);
                for texel in &mut done[pass.pixel_begin as usize..][..pass.pixel_count as usize] {
                    assert_eq!(*texel, pass.sample_begin, "samples in order, none twice");
                    *texel += pass.sample_count;
                }
                schedule.took(&pass, Duration::from_millis(milliseconds));
                assert!(schedule.fraction() >= fraction);
                fraction = schedule.fraction();
            }
            assert!(done.iter().all(|&n| n == samples));
            assert_eq!(fraction, 1.0);
        }
    }
}
