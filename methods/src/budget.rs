//! Which method, and how many samples, for the time that there is: from what was measured before.
//!
//! An error has a part that samples don't change, the bias of a method's setting, and one that falls as their number grows. Both are taken from measurements
//! ([`Curve::through`]); a picture takes time that does not depend on samples (what is built, what is gathered), and time for each sample.

/// An error as a function of the number of samples per pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curve {
    /// What is left of it with samples without end.
    pub bias: f64,
    /// What one sample adds.
    pub noise: f64,
    /// Whether errors add up as squares do: differences that are seen, like ꟻLIP; not those that are squares themselves, like relMSE.
    pub of_roots: bool,
}

impl Curve {
    /// The curve next to errors that were measured with some numbers of samples: least squares in proportion to the errors, neither part below 0. Of a single
    /// measurement all is taken for bias, which promises no more than was seen.
    ///
    /// *Formula.* e(s) = b + n/s, or e(s)² = b² + n²/s.
    pub fn through(measured: &[(u32, f64)], of_roots: bool) -> Option<Self> {
        let usable =
            measured.iter().filter(|(samples, error)| *samples > 0 && *error > 0.0 && error.is_finite());
        let points: Vec<(f64, f64)> = usable
            .map(|&(samples, error)| (1.0 / f64::from(samples), if of_roots { error * error } else { error }))
            .collect();
        let (bias, noise) = line(&points)?;
        let root = |x: f64| if of_roots { x.sqrt() } else { x };
        Some(Self { bias: root(bias), noise: root(noise), of_roots })
    }

    /// The error with so many samples.
    pub fn at(&self, samples: u32) -> f64 {
        let inverse = 1.0 / f64::from(samples.max(1));
        if self.of_roots {
            (self.bias * self.bias + self.noise * self.noise * inverse).sqrt()
        } else {
            self.bias + self.noise * inverse
        }
    }

    /// The least number of samples with at most this error; `None` where bias alone is more.
    pub fn samples_for(&self, error: f64) -> Option<u32> {
        let squared = |x: f64| if self.of_roots { x * x } else { x };
        let room = squared(error) - squared(self.bias);
        if self.noise == 0.0 && room >= 0.0 {
            return Some(1);
        }
        let samples = (squared(self.noise) / room).ceil();
        (room > 0.0 && samples <= f64::from(MOST_SAMPLES)).then(|| (samples as u32).max(1))
    }
}

/// Samples beyond which nobody waits.
const MOST_SAMPLES: u32 = 1 << 24;

/// b and n of e = b + n·x next to (x, e), each at least 0, weighing errors by their inverse squares.
fn line(points: &[(f64, f64)]) -> Option<(f64, f64)> {
    let sum = |of: &dyn Fn(f64, f64) -> f64| points.iter().map(|&(x, e)| of(x, e) / (e * e)).sum::<f64>();
    let (w, wx, wxx) = (sum(&|_, _| 1.0), sum(&|x, _| x), sum(&|x, _| x * x));
    let (we, wxe) = (sum(&|_, e| e), sum(&|x, e| x * e));
    let determinant = w * wxx - wx * wx;
    if points.is_empty() {
        return None;
    }
    // Points at one place, as seen with rounding, say nothing about a slope.
    if determinant <= 1e-9 * w * wxx {
        return Some((we / w, 0.0));
    }
    let (bias, noise) = ((wxx * we - wx * wxe) / determinant, (w * wxe - wx * we) / determinant);
    Some(match (bias < 0.0, noise < 0.0) {
        (true, _) => (0.0, wxe / wxx),
        (_, true) => (we / w, 0.0),
        _ => (bias, noise),
    })
}

/// A method with all knobs set but the number of samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// Seconds that don't depend on samples.
    pub fixed: f64,
    /// Seconds per sample of every pixel.
    pub per_sample: f64,
    /// Fewer samples were never measured: nothing is known of their noise.
    pub least_samples: u32,
    /// What is to be small.
    pub error: Curve,
}

/// What to render.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// Index of the candidate.
    pub candidate: usize,
    /// Samples per pixel.
    pub samples: u32,
    /// Seconds that it is expected to take.
    pub seconds: f64,
    /// Error that is expected.
    pub error: f64,
}

impl Candidate {
    fn seconds(&self, samples: u32) -> f64 {
        self.fixed + self.per_sample * f64::from(samples)
    }

    fn choice(&self, candidate: usize, samples: u32) -> Choice {
        Choice { candidate, samples, seconds: self.seconds(samples), error: self.error.at(samples) }
    }

    /// Samples that fit into a time, at most so many as anyone waits for; `None` where not even the fewest do.
    fn samples_within(&self, seconds: f64) -> Option<u32> {
        let samples = ((seconds - self.fixed) / self.per_sample).floor().min(f64::from(MOST_SAMPLES));
        (samples >= f64::from(self.least_samples.max(1))).then_some(samples as u32)
    }
}

/// The candidate with the least error within a time; of equal errors the first. `None` where no candidate takes so little time.
pub fn best_within(candidates: &[Candidate], seconds: f64) -> Option<Choice> {
    let fitting = candidates.iter().enumerate().filter_map(|(i, candidate)| {
        candidate.samples_within(seconds).map(|samples| candidate.choice(i, samples))
    });
    fitting.filter(|choice| !choice.error.is_nan()).min_by(|a, b| a.error.total_cmp(&b.error))
}

/// The quickest candidate with at most this error; `None` where every bias is more.
pub fn quickest_for(candidates: &[Candidate], error: f64) -> Option<Choice> {
    let good = candidates.iter().enumerate().filter_map(|(i, candidate)| {
        let samples = candidate.error.samples_for(error)?.max(candidate.least_samples);
        Some(candidate.choice(i, samples))
    });
    good.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
}

/// The quickest of all, with the fewest samples.
pub fn quickest(candidates: &[Candidate]) -> Option<Choice> {
    let all =
        candidates.iter().enumerate().map(|(i, candidate)| candidate.choice(i, candidate.least_samples));
    all.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn candidate(fixed: f64, per_sample: f64, bias: f64, noise: f64) -> Candidate {
        Candidate { fixed, per_sample, least_samples: 1, error: Curve { bias, noise, of_roots: false } }
    }

    #[test]
    fn noise_for_little_time_and_bias_for_much() {
        // Slow to build and smooth; unbiased and noisy; quick and wrong.
        let all =
            [candidate(0.5, 0.01, 0.02, 0.1), candidate(0.0, 0.02, 0.0, 2.0), candidate(0.0, 0.01, 0.2, 0.3)];
        let chosen = |seconds| best_within(&all, seconds).map(|choice| choice.candidate);
        assert_eq!(chosen(0.001), None);
        assert_eq!(chosen(0.1), Some(2));
        assert_eq!(chosen(1.0), Some(0));
        assert_eq!(chosen(10.0), Some(1));
        assert_eq!(quickest_for(&all, 0.31).map(|c| (c.candidate, c.samples)), Some((2, 3)));
        assert_eq!(quickest_for(&all, 0.01).map(|c| (c.candidate, c.samples)), Some((1, 200)));
        assert_eq!(quickest_for(&all[..1], 0.01), None, "its bias is more");
        assert_eq!(quickest(&all).map(|c| c.candidate), Some(2));
    }

    #[test]
    fn fewer_samples_than_measured_are_not_chosen() {
        let few = Candidate { least_samples: 16, ..candidate(0.0, 0.01, 0.1, 0.0) };
        assert_eq!(best_within(std::slice::from_ref(&few), 0.15), None);
        assert_eq!(best_within(std::slice::from_ref(&few), 0.17).map(|c| c.samples), Some(17));
        assert_eq!(quickest_for(std::slice::from_ref(&few), 0.2).map(|c| c.samples), Some(16));
        assert_eq!(quickest(&[few]).map(|c| c.samples), Some(16));
    }

    #[test]
    fn one_measurement_is_no_promise_of_less() {
        let curve = Curve::through(&[(16, 0.3)], false).unwrap();
        assert!((curve.bias - 0.3).abs() < 1e-12 && curve.noise == 0.0, "{curve:?}");
        assert_eq!(Curve::through(&[], true), None);
        assert_eq!(Curve::through(&[(4, f64::NAN), (0, 1.0)], true), None);
    }

    proptest! {
        #[test]
        fn curves_go_through_what_is_on_one(bias in 1e-3..1.0_f64, noise in 1e-3..10.0_f64, of_roots: bool) {
            let wanted = Curve { bias, noise, of_roots };
            let measured: Vec<(u32, f64)> = [1, 4, 16, 64].map(|s| (s, wanted.at(s))).to_vec();
            let found = Curve::through(&measured, of_roots).unwrap();
            for samples in [1, 7, 64, 500] {
                // Differences of products of f64, to a millionth.
                prop_assert!((found.at(samples) / wanted.at(samples) - 1.0).abs() < 1e-6);
            }
            let enough = wanted.samples_for(wanted.at(37)).unwrap();
            prop_assert!((36..=38).contains(&enough), "{enough}");
        }

        #[test]
        fn what_is_chosen_keeps_its_word(
            parts in prop::collection::vec((0.0..2.0_f64, 1e-3..1.0_f64, 0.0..1.0_f64, 0.0..4.0_f64), 1..6),
            seconds in 0.01..20.0_f64,
        ) {
            let all: Vec<Candidate> = parts.iter().map(|&(f, p, b, n)| candidate(f, p, b, n)).collect();
            if let Some(choice) = best_within(&all, seconds) {
                prop_assert!(choice.seconds <= seconds * (1.0 + 1e-12));
                for other in &all {
                    if let Some(samples) = other.samples_within(seconds) {
                        prop_assert!(choice.error <= other.error.at(samples));
                    }
                }
            } else {
                prop_assert!(all.iter().all(|c| c.fixed + c.per_sample > seconds * (1.0 - 1e-12)));
            }
        }
    }
}
