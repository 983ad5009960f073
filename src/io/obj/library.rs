//! Materials and textures an OBJ file refers to.

use super::material::{self, Adjustments};
use super::mtl::{self, MtlMaterial};
use crate::io::resolve::{Files, refused};
use crate::io::text::{self, Token};
use crate::io::{LoadOptions, image};
use std::collections::{BTreeMap, BTreeSet};
use twinlight_core::scene::{Limits, Material, Texture};
use twinlight_core::{Error, Result};

/// The materials met so far; indices are those of the scene.
pub(super) struct Library<'a> {
    files: &'a dyn Files,
    options: &'a LoadOptions,
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
    pub notices: Vec<String>,
    /// Names of the libraries that were asked for: a statement may be repeated without end.
    libraries: BTreeSet<String>,
    by_name: BTreeMap<String, u32>,
    texture_by_name: BTreeMap<String, Option<u32>>,
    default: Option<u32>,
    adjustments: Adjustments,
}

impl<'a> Library<'a> {
    pub fn new(files: &'a dyn Files, options: &'a LoadOptions) -> Self {
        Self {
            files,
            options,
            materials: Vec::new(),
            textures: Vec::new(),
            notices: Vec::new(),
            libraries: BTreeSet::new(),
            by_name: BTreeMap::new(),
            texture_by_name: BTreeMap::new(),
            default: None,
            adjustments: Adjustments::default(),
        }
    }

    /// Reads the libraries of an `mtllib` statement: one name, which may hold blanks, or several.
    pub fn load(&mut self, label: Token<'_>, obj: &str) -> Result<()> {
        let names = String::from_utf8(label.bytes.to_vec())
            .map_err(|_| label.error(obj, format!("library name '{}' is not UTF-8", label.shown())))?;
        let words: Vec<&str> = names.split_whitespace().collect();
        let several = words.len() > 1 && words.iter().all(|w| w.to_ascii_lowercase().ends_with(".mtl"));
        let names = if several { words } else { vec![names.as_str()] };
        for name in names {
            if !self.libraries.insert(name.to_owned()) {
                continue;
            }
            if let Some(bytes) = self.fetch(name, &label.place(obj), "material library")? {
                let materials = mtl::parse(&bytes, name, self.options, &mut self.notices)?;
                let files = self.files.beside(name)?;
                for mtl in &materials {
                    self.add(mtl, files.as_ref())?;
                }
            }
        }
        Ok(())
    }

    /// The bytes of a file; a missing one is a notice unless strict.
    fn fetch(&mut self, name: &str, place: &str, what: &str) -> Result<Option<Vec<u8>>> {
        self.fetch_from(self.files, name, place, what)
    }

    fn fetch_from(
        &mut self,
        files: &dyn Files,
        name: &str,
        place: &str,
        what: &str,
    ) -> Result<Option<Vec<u8>>> {
        match files.read_path(name) {
            Ok(bytes) => Ok(Some(bytes)),
            Err(missing @ Error::Io { .. }) if !self.options.strict => {
                if self.notices.len() < super::MAX_NOTICES {
                    self.notices.push(refused(missing, place, what, name).to_string());
                }
                Ok(None)
            }
            Err(error) => Err(refused(error, place, what, name)),
        }
    }

    fn add(&mut self, mtl: &MtlMaterial, files: &dyn Files) -> Result<()> {
        let mut material = material::convert(mtl, &mut self.adjustments);
        if let Some((file, place)) = &mtl.map_kd {
            material.albedo_texture = self.texture(files, file, place)?;
        }
        let index = self.materials.len() as u32;
        self.materials.push(material);
        let again = self.by_name.insert(mtl.name.clone(), index).is_some();
        if again && self.notices.len() < super::MAX_NOTICES {
            self.notices.push(format!(
                "{}: material '{}' is defined again; the later one counts",
                mtl.place, mtl.name
            ));
        }
        Ok(())
    }

    fn texture(&mut self, files: &dyn Files, file: &str, place: &str) -> Result<Option<u32>> {
        let key = files.identity(file).unwrap_or_else(|_| file.to_owned());
        if let Some(&known) = self.texture_by_name.get(&key) {
            return Ok(known);
        }
        let index = match self.fetch_from(files, file, place, "texture")? {
            Some(bytes) => {
                let texture = image::decode_texture(&bytes, file, &self.texture_limits())?;
                self.textures.push(texture);
                Some(self.textures.len() as u32 - 1)
            }
            None => None,
        };
        self.texture_by_name.insert(key, index);
        Ok(index)
    }

    /// The limits less what the textures so far hold.
    fn texture_limits(&self) -> Limits {
        let limits = self.options.limits;
        let held = self.textures.iter().map(|t| 4 * t.texels.len() as u64).sum();
        Limits { max_bytes: limits.max_bytes.saturating_sub(held), ..limits }
    }

    /// The index of a material by name; an unknown one gets the default and a notice, or an error when strict.
    pub fn index_of(&mut self, label: Token<'_>, obj: &str) -> Result<u32> {
        let name = String::from_utf8_lossy(label.bytes);
        if let Some(&index) = self.by_name.get(&*name) {
            return Ok(index);
        }
        if self.options.strict || self.notices.len() < super::MAX_NOTICES {
            let hint = text::did_you_mean(&label.shown(), self.by_name.keys().map(String::as_str));
            let what = format!("no material library defines '{}'{hint}", label.shown());
            if self.options.strict {
                return Err(label.error(obj, what));
            }
            self.notices.push(format!("{}: {what}; grey is used", label.place(obj)));
        }
        let index = self.default_index();
        self.by_name.insert(name.into_owned(), index);
        Ok(index)
    }

    /// The index of the grey material of faces without one.
    pub fn default_index(&mut self) -> u32 {
        let next = self.materials.len() as u32;
        *self.default.get_or_insert_with(|| {
            self.materials.push(Material::default());
            next
        })
    }

    /// Says what was adjusted in the materials of `obj`.
    pub fn conclude(&mut self, obj: &str) {
        let Adjustments { scaled, opaque_instead } = std::mem::take(&mut self.adjustments);
        if scaled > 0 {
            let what = "materials reflect more than they receive (Kd + Ks > 1): scaled down to 1";
            self.notices.push(format!("{obj}: {scaled} {what}"));
        }
        for name in opaque_instead.into_iter().take(super::MAX_NOTICES) {
            self.notices.push(format!(
                "{obj}: material '{name}' is transparent without an index of refraction: drawn opaque"
            ));
        }
    }
}
