//! `compare`: how far a picture is from a reference.

use crate::args::CompareArgs;
use crate::exit::{Failure, Stage};
use crate::report;
use serde_json::{Map, Value, json};
use std::fmt::Write as _;
use std::path::Path;
use twinlight::Error;
use twinlight::io::image::{LayeredImage, exr, png, read_layers, read_rgb};
use twinlight::io::resolve::read_limited;
use twinlight::methods::post::falsecolor::false_colour;
use twinlight::methods::post::image::Image;
use twinlight::methods::post::metrics::ztest::{Estimate, FORMULA, ZTest, ZTestSettings};
use twinlight::methods::post::metrics::{CompareSettings, Comparison, Metric};
use twinlight::methods::post::tonemap::Display;
use twinlight::scene::Limits;

/// Largest picture file that is read.
const MAX_FILE_BYTES: u64 = 4 << 30;

/// Runs the command.
///
/// # Errors
/// [`Failure::Differs`] when a threshold or the z-test fails; unreadable pictures; pictures of different sizes.
pub fn run(args: &CompareArgs) -> Result<(), Failure> {
    check_error_image(args)?;
    let display = Display::new(args.tone.exposure, args.tone.tonemap).map_err(Failure::Pictures)?;
    let (test, reference) = (Picture::read(&args.test)?, Picture::read(&args.reference)?);
    let settings = CompareSettings { display, ..CompareSettings::default() };
    let comparison = Comparison::new(&test.rgb, &reference.rgb, &settings).map_err(Failure::Pictures)?;
    let ztest = if args.ztest { Some(z_test(&test, &reference)?) } else { None };
    if let Some(path) = &args.error_image {
        let pixels = false_colour(&comparison.flip_map, 1.0).map_err(Failure::Pictures)?;
        png::write(path, comparison.width, comparison.height, &pixels).map_err(Failure::at(Stage::Output))?;
    }
    let missed = missed(args, &comparison);
    let text = if args.json {
        json_text(args, &comparison, ztest.as_ref(), &missed)
    } else {
        table(args, &comparison, ztest.as_ref())
    };
    report::print(&text)?;
    verdict(missed, ztest.as_ref())
}

/// Refuses another name than that of the format which is written, before anything is compared.
fn check_error_image(args: &CompareArgs) -> Result<(), Failure> {
    let Some(path) = &args.error_image else { return Ok(()) };
    match path.extension() {
        Some(extension) if extension.eq_ignore_ascii_case("png") => Ok(()),
        _ => Err(Failure::Usage(format!("'{}': the error image is a PNG and ends in .png", path.display()))),
    }
}

/// The pictures' radiance and, of EXR files, the layers.
struct Picture {
    name: String,
    rgb: Image,
    layers: Option<LayeredImage>,
}

impl Picture {
    fn read(path: &Path) -> Result<Self, Failure> {
        let name = path.display().to_string();
        let read = || -> twinlight::Result<_> {
            let bytes = read_limited(path, MAX_FILE_BYTES)?;
            let limits = Limits::default();
            let rgb = read_rgb(&bytes, &name, &limits)?;
            let is_exr = bytes.starts_with(&exr::MAGIC);
            let layers = if is_exr { Some(read_layers(&bytes, &name, &limits)?) } else { None };
            Ok((rgb, layers))
        };
        let (rgb, layers) = read().map_err(Failure::at(Stage::Pictures))?;
        let rgb = Image::new(rgb.width, rgb.height, rgb.pixels).map_err(Failure::Pictures)?;
        Ok(Self { name, rgb, layers })
    }

    /// Mean luminance and its variance: what a render's file knows about its own noise.
    fn luminance(&self) -> Result<(Image, Image), Failure> {
        let variance = self.layers.as_ref().and_then(|layers| layers.f32_channel("variance.Y"));
        let Some(variance) = variance else {
            let what = "has no variance.Y layer: the z-test compares EXR files of `twinlight render`";
            return Err(Failure::Library(Stage::Pictures, Error::invalid(&self.name, what)));
        };
        let weights = [0.2126, 0.7152, 0.0722];
        let luminance = |p: &[f32; 3]| (0..3).map(|c| weights[c] * f64::from(p[c])).sum::<f64>() as f32;
        let mean = self.rgb.pixels().iter().map(|p| [luminance(p); 3]).collect();
        let image =
            |pixels| Image::new(self.rgb.width(), self.rgb.height(), pixels).map_err(Failure::Pictures);
        Ok((image(mean)?, image(variance.iter().map(|&v| [v; 3]).collect())?))
    }
}

fn z_test(test: &Picture, reference: &Picture) -> Result<ZTest, Failure> {
    let ((ma, va), (mb, vb)) = (test.luminance()?, reference.luminance()?);
    let a = Estimate { mean: &ma, variance_of_mean: &va };
    let b = Estimate { mean: &mb, variance_of_mean: &vb };
    ZTest::new(a, b, ZTestSettings::default()).map_err(Failure::Pictures)
}

/// Thresholds that are passed, in words.
fn missed(args: &CompareArgs, comparison: &Comparison) -> Vec<String> {
    let worse = args.threshold.iter().filter(|t| t.metric.is_worse(comparison.value(t.metric), t.limit));
    worse
        .map(|t| format!("{} is {}, the limit is {}", t.metric.key(), comparison.value(t.metric), t.limit))
        .collect()
}

fn verdict(missed: Vec<String>, ztest: Option<&ZTest>) -> Result<(), Failure> {
    let mut reasons = missed;
    if ztest.is_some_and(|z| !z.passes()) {
        reasons.push("the z-test says that the expectations differ".into());
    }
    if reasons.is_empty() {
        Ok(())
    } else {
        Err(Failure::Differs(format!("pictures differ: {}", reasons.join("; "))))
    }
}

fn table(args: &CompareArgs, comparison: &Comparison, ztest: Option<&ZTest>) -> String {
    let mut text = String::new();
    // Writing to a string can't fail.
    for metric in Metric::ALL {
        let value = comparison.value(metric);
        let _ = writeln!(text, "{:7} {:>14}  {}", metric.name(), number(value), metric.formula());
    }
    let (c, total) = (comparison, u64::from(comparison.width) * u64::from(comparison.height));
    let _ = writeln!(
        text,
        "\nx = {}, r = {}; {}",
        args.test.display(),
        args.reference.display(),
        c.settings.display.formula()
    );
    let _ = writeln!(
        text,
        "{}x{} pixels: {} differ in their bits, {} are compared; not finite: {} of x, {} of r",
        c.width, c.height, c.differing_pixels, c.compared_pixels, c.non_finite_test, c.non_finite_reference
    );
    if c.differing_pixels == 0 {
        let _ = writeln!(text, "the same picture bit for bit ({total} pixels)");
    } else {
        let _ = writeln!(
            text,
            "largest difference {} at column {}, row {}",
            number(c.max_abs),
            c.max_abs_at.0,
            c.max_abs_at.1
        );
    }
    if let Some(z) = ztest {
        let verdict = if z.passes() { "passes" } else { "FAILS" };
        let _ = writeln!(
            text,
            "\nz-test of luminance {verdict}: {} of {} values beyond z* = {:.3} ({:.2} % may be), largest |z| {:.3}, bias z {:.3} (limit {:.3})\n{FORMULA}",
            z.failures,
            z.values,
            z.threshold,
            100.0 * z.settings.allowed_fraction,
            z.max_abs_z,
            z.bias_z[0],
            z.bias_threshold
        );
    }
    text
}

/// Six significant digits, whatever the magnitude.
fn number(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && size.is_finite() && !(1e-3..1e6).contains(&size) {
        format!("{value:.5e}")
    } else {
        format!("{value:.6}")
    }
}

fn json_text(args: &CompareArgs, c: &Comparison, ztest: Option<&ZTest>, missed: &[String]) -> String {
    let metrics: Map<String, Value> = Metric::ALL
        .into_iter()
        .map(|m| (m.key().to_owned(), json!({ "value": c.value(m), "formula": m.formula() })))
        .collect();
    let value = json!({
        "test": args.test.display().to_string(),
        "reference": args.reference.display().to_string(),
        "size": [c.width, c.height],
        "display": c.settings.display.formula(),
        "pixels": {
            "differing": c.differing_pixels,
            "compared": c.compared_pixels,
            "non_finite_test": c.non_finite_test,
            "non_finite_reference": c.non_finite_reference,
        },
        "metrics": metrics,
        "max_abs": { "value": c.max_abs, "at": [c.max_abs_at.0, c.max_abs_at.1] },
        "ztest": ztest.map(|z| json!({
            "passes": z.passes(), "failures": z.failures, "values": z.values, "threshold": z.threshold,
            "max_abs_z": z.max_abs_z, "bias_z": z.bias_z[0], "bias_threshold": z.bias_threshold,
            "formula": FORMULA,
        })),
        "missed": missed,
    });
    format!("{value:#}\n")
}
