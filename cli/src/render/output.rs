//! Where pictures go.

use super::layers::Pictures;
use crate::exit::{Failure, Stage};
use std::path::{Path, PathBuf};
use twinlight::Error;
use twinlight::io::image::{exr, png};
use twinlight::io::write_file;

/// Where the number of a frame goes.
const PLACEHOLDER: &str = "{frame}";

/// Formats of pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Png,
    Exr,
}

/// The files of one render; at least one picture.
#[derive(Debug)]
pub struct Outputs {
    pictures: Vec<(PathBuf, Format)>,
    sidecar: PathBuf,
}

impl Outputs {
    /// From the paths asked for, or `stem`.png and `stem`.exr in the current folder.
    ///
    /// # Errors
    /// [`Failure::Usage`] for other extensions, for folders and for one file asked for twice.
    pub fn plan(paths: &[PathBuf], stem: &str) -> Result<Self, Failure> {
        let defaults = [format!("{stem}.png").into(), format!("{stem}.exr").into()];
        let paths = if paths.is_empty() { &defaults[..] } else { paths };
        let mut pictures = Vec::new();
        for path in paths {
            if path.is_dir() {
                return Err(Failure::Usage(folder_instead(path, stem)));
            }
            pictures.push((path.clone(), format_of(path)?));
        }
        Self::of(pictures)
    }

    fn of(pictures: Vec<(PathBuf, Format)>) -> Result<Self, Failure> {
        let again = |i: usize| pictures[..i].iter().any(|(other, _)| *other == pictures[i].0);
        if let Some(twice) = (0..pictures.len()).find(|&i| again(i)) {
            return Err(Failure::Usage(format!("'{}' is asked for twice", pictures[twice].0.display())));
        }
        let sidecar = pictures[0].0.with_extension("json");
        Ok(Self { pictures, sidecar })
    }

    /// The files of a frame: the number, of at least `digits` digits, stands where a name has `{frame}`, else before the
    /// extension.
    ///
    /// # Errors
    /// [`Failure::Usage`] for one file asked for twice.
    pub fn of_frame(&self, number: u32, digits: usize) -> Result<Self, Failure> {
        let number = format!("{number:0digits$}");
        Self::of(self.pictures.iter().map(|(path, format)| (numbered(path, &number), *format)).collect())
    }

    /// Makes the folders and sees whether files can be made in them: better now than after hours of rendering.
    ///
    /// # Errors
    /// [`Error::Io`] naming the picture.
    pub fn prepare_folders(&self) -> Result<(), Failure> {
        for (path, _) in &self.pictures {
            let io = |source| Failure::Library(Stage::Output, Error::Io { path: path.clone(), source });
            let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
            std::fs::create_dir_all(folder).map_err(io)?;
            let probe = folder.join(format!(".twinlight-{}.probe", std::process::id()));
            std::fs::File::create_new(&probe).map_err(io)?;
            std::fs::remove_file(&probe).map_err(io)?;
        }
        if self.sidecar.exists() && !is_sidecar(&self.sidecar) {
            let what = "exists and is not a report of twinlight: name the picture otherwise with -o";
            return Err(Failure::Usage(format!("'{}' {what}", self.sidecar.display())));
        }
        Ok(())
    }

    /// Writes every picture; `attributes` go into the headers of EXR files.
    ///
    /// # Errors
    /// [`Error::Io`] naming the picture.
    pub fn write(&self, pictures: &Pictures, attributes: &[(&str, String)]) -> Result<(), Failure> {
        let attributes: Vec<(&str, &str)> = attributes.iter().map(|(k, v)| (*k, v.as_str())).collect();
        let (width, height) = pictures.size();
        for (path, format) in &self.pictures {
            let written = match format {
                Format::Png => png::write(path, width, height, &pictures.srgb8()),
                Format::Exr => exr::write(path, &pictures.layered(), &attributes),
            };
            written.map_err(Failure::at(Stage::Output))?;
        }
        Ok(())
    }

    /// Writes the file that says how the pictures were made.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn write_sidecar(&self, text: &str) -> Result<(), Failure> {
        write_file(&self.sidecar, text.as_bytes()).map_err(Failure::at(Stage::Output))
    }

    /// The pictures' paths.
    pub fn pictures(&self) -> impl Iterator<Item = &Path> {
        self.pictures.iter().map(|(path, _)| path.as_path())
    }

    /// Every file's path, one a line.
    pub fn list(&self) -> String {
        self.pictures().chain([self.sidecar.as_path()]).map(|path| format!("{}\n", path.display())).collect()
    }
}

fn numbered(path: &Path, number: &str) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    if name.contains(PLACEHOLDER) {
        return path.with_file_name(name.replace(PLACEHOLDER, number));
    }
    let (stem, extension) = name.rsplit_once('.').unwrap_or((&name, ""));
    path.with_file_name(format!("{stem}-{number}.{extension}"))
}

fn folder_instead(path: &Path, stem: &str) -> String {
    let inside = path.join(format!("{stem}.png"));
    format!("'{}' is a folder: name a file in it, such as '{}'", path.display(), inside.display())
}

fn format_of(path: &Path) -> Result<Format, Failure> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    match (extension.as_str(), path.file_name()) {
        ("png", Some(_)) => Ok(Format::Png),
        ("exr", Some(_)) => Ok(Format::Exr),
        _ => Err(Failure::Usage(format!("'{}': pictures end in .png or .exr", path.display()))),
    }
}

/// Whether a file is what [`super::sidecar::json`] writes, which may be replaced; anything else is somebody's.
fn is_sidecar(path: &Path) -> bool {
    // Reading a pipe would wait for a writer that may never come.
    let text = path.is_file().then(|| std::fs::read(path).ok()).flatten();
    let parsed = text.and_then(|text| serde_json::from_slice::<serde_json::Value>(&text).ok());
    parsed.is_some_and(|value| value.get("twinlight").is_some())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_decide_formats_and_places() {
        let outputs = Outputs::plan(&[], "room").unwrap();
        assert_eq!(outputs.list(), "room.png\nroom.exr\nroom.json\n");
        let outputs = Outputs::plan(&["a/b.EXR".into(), "c.png".into()], "room").unwrap();
        assert_eq!(outputs.list(), "a/b.EXR\nc.png\na/b.json\n");
        let frame = outputs.of_frame(7, 4).unwrap();
        assert_eq!(frame.list(), "a/b-0007.EXR\nc-0007.png\na/b-0007.json\n");
        let named = Outputs::plan(&["{frame}/of-{frame}.x.png".into()], "room").unwrap();
        assert_eq!(
            named.of_frame(12345, 4).unwrap().list(),
            "{frame}/of-12345.x.png\n{frame}/of-12345.x.json\n"
        );
        let twice = Outputs::plan(&["a.png".into(), "a-{frame}.png".into()], "room").unwrap();
        assert!(matches!(twice.of_frame(1, 4), Err(Failure::Usage(_))));
        for bad in [&["a"][..], &["a.json"], &[".png"], &[""], &["a.png", "a.png"]] {
            let paths: Vec<PathBuf> = bad.iter().map(PathBuf::from).collect();
            assert!(matches!(Outputs::plan(&paths, "room"), Err(Failure::Usage(_))), "{bad:?}");
        }
    }
}
