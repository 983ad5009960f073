//! How a render went, in a line for people.

use super::run::Done;
use std::time::Duration;
use twinlight::BackendInfo;

/// Such as `64 samples per pixel in 2.1 s (2.0 M paths/s, CPU, 2 threads)`.
pub fn line(done: &Done) -> String {
    let (least, most) = done.taken.samples();
    let samples = match (least, most) {
        (1, 1) => "1 sample".into(),
        _ if least == most => format!("{least} samples"),
        _ => format!("{least} to {most} samples"),
    };
    let seconds = done.taken.elapsed.as_secs_f64();
    let rate = magnitude(done.taken.paths_per_second());
    format!("{samples} per pixel in {seconds:.1} s ({rate}paths/s, {})", device(&done.info))
}

/// Such as `48 frames in 100.2 s (2.1 s per frame, CPU, 2 threads)`.
pub fn frames_line(count: u32, elapsed: Duration, info: &BackendInfo) -> String {
    let seconds = elapsed.as_secs_f64();
    let frames = if count == 1 { "1 frame".into() } else { format!("{count} frames") };
    format!("{frames} in {seconds:.1} s ({:.1} s per frame, {})", seconds / f64::from(count), device(info))
}

fn device(info: &BackendInfo) -> String {
    // The CPU's driver ends in the number of threads; a GPU is known by its name.
    match info.driver.rsplit(", ").next().filter(|_| info.kind == "cpu") {
        Some(threads) => format!("CPU, {threads}"),
        None => info.device.clone(),
    }
}

/// A count to two digits or more, with the unit that follows it.
fn magnitude(count: f64) -> String {
    match count {
        c if c >= 1e9 => format!("{:.1} G ", c / 1e9),
        c if c >= 1e6 => format!("{:.1} M ", c / 1e6),
        c if c >= 1e3 => format!("{:.1} k ", c / 1e3),
        c => format!("{c:.0} "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_and_devices() {
        let rates = [(0.0, "0 "), (999.0, "999 "), (1234.0, "1.2 k "), (2e6, "2.0 M "), (3.26e9, "3.3 G ")];
        for (count, text) in rates {
            assert_eq!(magnitude(count), text);
        }
        let info = |kind, driver: &str| BackendInfo {
            kind,
            device: "Model 7".into(),
            driver: driver.into(),
            strict: true,
        };
        assert_eq!(device(&info("cpu", "x86_64 AVX2, 2 threads")), "CPU, 2 threads");
        assert_eq!(device(&info("gpu", "vendor 1, 2")), "Model 7");
    }
}
