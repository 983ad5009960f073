//! Tables.

/// What one contender took.
#[derive(Default)]
pub struct Timing {
    /// Millions of rays per second, one per slice.
    rates: Vec<f64>,
    rays: usize,
    hits: usize,
}

impl Timing {
    pub fn add(&mut self, rays: usize, hits: usize, seconds: f64) {
        self.rates.push(rays as f64 / seconds / 1e6);
        self.rays += rays;
        self.hits += hits;
    }

    fn at(&self, share: f64) -> f64 {
        let mut sorted = self.rates.clone();
        sorted.sort_by(f64::total_cmp);
        sorted[((sorted.len() - 1) as f64 * share) as usize]
    }
}

pub fn print_header(kind: &str, threads: usize, rounds: usize) {
    println!("  {kind}: M rays/s, {threads} threads, {rounds} slices in turn");
    println!("    {:28} {:>7} {:>15} {:>7} {:>7}", "", "median", "quartiles", "best", "hits");
}

pub fn print_row(name: &str, timing: &Timing) {
    let quartiles = format!("{:.2} - {:.2}", timing.at(0.25), timing.at(0.75));
    let hits = 100.0 * timing.hits as f64 / timing.rays as f64;
    println!("    {name:28} {:7.2} {quartiles:>15} {:7.2} {hits:6.2}%", timing.at(0.5), timing.at(1.0));
}
