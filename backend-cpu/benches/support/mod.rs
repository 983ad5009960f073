//! Timing side by side: on a busy machine only ratios within one run mean something.

use std::time::{Duration, Instant};

/// One way of doing the work.
pub struct Contender<'a> {
    /// As printed.
    pub name: &'a str,
    /// Runs once and returns the time of what is to be compared; preparing its input isn't.
    pub run: &'a mut dyn FnMut() -> Duration,
}

/// Time that `body` takes.
pub fn timed(body: impl FnOnce()) -> Duration {
    let start = Instant::now();
    body();
    start.elapsed()
}

fn sorted(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    values
}

/// Runs the contenders alternately, `rounds` times after one round that isn't counted, and prints times and, for all
/// but the last, how fast they are beside the last: above 1 is faster.
pub fn compare(title: &str, rounds: usize, contenders: &mut [Contender<'_>]) {
    let mut seconds = vec![Vec::with_capacity(rounds); contenders.len()];
    for round in 0..=rounds {
        for (contender, seconds) in contenders.iter_mut().zip(&mut seconds) {
            let time = (contender.run)().as_secs_f64();
            if round > 0 {
                seconds.push(time);
            }
        }
    }
    println!("{title}, {rounds} rounds");
    let last = seconds[contenders.len() - 1].clone();
    for (contender, seconds) in contenders.iter().zip(&seconds) {
        let ratios = sorted(seconds.iter().zip(&last).map(|(own, last)| last / own).collect());
        let times = sorted(seconds.clone());
        println!(
            "  {:<28} {:>8.2} ms ({:.2} to {:.2})   speed ratio {:.2} ({:.2} to {:.2})",
            contender.name,
            times[rounds / 2] * 1e3,
            times[0] * 1e3,
            times[rounds - 1] * 1e3,
            ratios[rounds / 2],
            ratios[0],
            ratios[rounds - 1],
        );
    }
}
