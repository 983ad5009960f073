//! `render --show`: what a method works with, drawn.

use super::job;
use crate::args::{RenderArgs, Show};
use crate::device::{self, Device};
use crate::exit::{Failure, Stage};
use crate::report;
use crate::source::{self, Prepared};
use std::path::PathBuf;
use twinlight::io::image::png;
use twinlight::methods::slhb::{LookupSettings, Sheet, build, sheet};
use twinlight::{Backend, Result};

/// Draws what was asked for and says in a line what it shows.
///
/// # Errors
/// [`Failure::Usage`] for an output that is no single PNG; what the backend and the method refuse.
pub fn run(args: &RenderArgs, prepared: &Prepared, show: Show) -> std::result::Result<(), Failure> {
    let path = output(args)?;
    let (device, notice) = device::open(&args.device)?;
    prepared.notices.iter().chain(&notice).for_each(|text| report::notice(text));
    let (Show::Lhb(view), lookups) = (show, job::lookups(&args.picture.slhb));
    let drawn = match &device {
        Device::Cpu(backend) => draw(backend, prepared, &lookups, view),
        #[cfg(feature = "gpu")]
        Device::Gpu(backend) => draw(&**backend, prepared, &lookups, view),
    };
    let (sheet, line) = drawn.map_err(Failure::at(Stage::Device))?;
    png::write(&path, sheet.width, sheet.height, &sheet.pixels).map_err(Failure::at(Stage::Output))?;
    report::print(&format!("{}\n", path.display()))?;
    report::status(&line);
    Ok(())
}

/// The one PNG.
fn output(args: &RenderArgs) -> std::result::Result<PathBuf, Failure> {
    let is_png = |path: &PathBuf| path.extension().is_some_and(|e| e.eq_ignore_ascii_case("png"));
    match &args.outputs[..] {
        [] => Ok(PathBuf::from(format!("{}-lhb.png", source::stem(&args.picture.scene)))),
        [path] if is_png(path) => Ok(path.clone()),
        _ => Err(Failure::Usage("--show draws one picture: -o FILE.png".into())),
    }
}

fn draw<B: Backend>(
    backend: &B,
    prepared: &Prepared,
    lookups: &LookupSettings,
    view: u32,
) -> Result<(Sheet, String)> {
    let buffers = build(backend, &prepared.compiled, lookups)?;
    let sheet = sheet(backend, &buffers, view)?;
    let direction = buffers.views[view as usize].direction();
    let line = format!(
        "view {view} of {} along {:.3} {:.3} {:.3}: {} elements, {:.1} % of the pixels covered, {} layers at most; tiles: number of \
         layers, then the nearest 7, orange fronts, blue backs",
        buffers.views.len(),
        direction.x,
        direction.y,
        direction.z,
        sheet.elements,
        sheet.covered * 100.0,
        sheet.deepest
    );
    Ok((sheet, line))
}
