//! A scene as a TOML file, with a PLY file per mesh and material, PNG textures and an EXR environment in a folder
//! beside it.

use super::ply;
use crate::exit::{Failure, Stage};
use crate::report;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use twinlight::io::image::{LayeredImage, exr, png};
use twinlight::io::toml_scene::RenderSettings;
use twinlight::io::write_file;
use twinlight::scene::{Environment, Light, Material, MaterialKind, Scene, Transform, Wrap};
use twinlight::{Error, Result};

/// Writes `scene` to `path` and prints the name of every file.
///
/// # Errors
/// [`Error::Io`].
pub fn write(scene: &Scene, settings: &RenderSettings, path: &Path) -> std::result::Result<(), Failure> {
    let stem = path.file_stem().map_or_else(|| "scene".into(), |s| s.to_string_lossy().into_owned());
    let name = format!("{stem}-files");
    let mut writer =
        Writer { folder: path.with_file_name(&name), name, text: String::new(), files: Vec::new() };
    let output = Failure::at(Stage::Output);
    writer.scene(scene, settings).map_err(&output)?;
    write_file(path, writer.text.as_bytes()).map_err(&output)?;
    writer.files.insert(0, path.to_path_buf());
    report::print(&writer.files.iter().map(|f| format!("{}\n", f.display())).collect::<String>())
}

struct Writer {
    /// Where meshes and pictures go, and its name as the scene file says it.
    folder: PathBuf,
    name: String,
    text: String,
    files: Vec<PathBuf>,
}

impl Writer {
    fn scene(&mut self, scene: &Scene, settings: &RenderSettings) -> Result<()> {
        std::fs::create_dir_all(&self.folder)
            .map_err(|source| Error::Io { path: self.folder.clone(), source })?;
        self.render(settings);
        if let Some(c) = &scene.camera {
            let _ = writeln!(
                self.text,
                "[camera]\nposition = {:?}\ntarget = {:?}\nup = {:?}\nvfov = {:?}\n",
                c.position, c.target, c.up, c.vfov_degrees
            );
        }
        if let Some(environment) = &scene.environment {
            self.environment(environment)?;
        }
        let names = unique_names(scene.materials.iter().map(|m| m.name.as_str()));
        for (material, name) in scene.materials.iter().zip(&names) {
            self.material(scene, material, name)?;
        }
        self.meshes(scene, &names)?;
        for light in &scene.lights {
            self.light(light);
        }
        Ok(())
    }

    fn render(&mut self, settings: &RenderSettings) {
        let RenderSettings { size, spp, bounces, seed, method } = settings;
        let numbers = [("spp", spp), ("bounces", bounces), ("seed", seed)];
        let size = size.map(|size| format!("size = {size:?}\n"));
        let method = method.as_ref().map(|method| format!("method = {}\n", quoted(method)));
        let numbers = numbers.into_iter().filter_map(|(key, n)| n.map(|n| format!("{key} = {n}\n")));
        let lines: String = size.into_iter().chain(numbers).chain(method).collect();
        if !lines.is_empty() {
            let _ = writeln!(self.text, "[render]\n{lines}");
        }
    }

    fn environment(&mut self, e: &Environment) -> Result<()> {
        let rotation = e.rotation.z_axis.x.atan2(e.rotation.z_axis.z).to_degrees();
        if (e.rotation.y_axis.y - 1.0).abs() > 1e-9 {
            report::notice("the environment is tilted; a scene file can only turn it about +Y");
        }
        let light = if e.texels.len() == 1 {
            format!("radiance = {:?}", e.texels[0])
        } else {
            let mut image = LayeredImage::new(e.width, e.height);
            image.add_rgb("", &e.texels);
            format!("file = {}", self.file("environment.exr", &exr::encode(&image, &[])?)?)
        };
        let _ =
            writeln!(self.text, "[environment]\n{light}\nscale = {:?}\nrotation = {rotation:?}\n", e.scale);
        Ok(())
    }

    fn material(&mut self, scene: &Scene, m: &Material, name: &str) -> Result<()> {
        let kind = match m.kind {
            MaterialKind::Opaque => "kind = \"opaque\"".into(),
            MaterialKind::Mirror => "kind = \"mirror\"".into(),
            MaterialKind::Dielectric { ior } => format!("kind = \"dielectric\"\nior = {ior:?}"),
        };
        let texture = match m.albedo_texture.and_then(|t| Some((t, scene.textures.get(t as usize)?))) {
            None => String::new(),
            Some((index, texture)) => {
                if texture.wrap == Wrap::Clamp {
                    report::notice(&format!("texture '{}' repeats: a scene file can't clamp", texture.name));
                }
                let pixels: Vec<[u8; 3]> = texture.texels.iter().map(|&[r, g, b, _]| [r, g, b]).collect();
                let bytes = png::encode(texture.width, texture.height, &pixels)?;
                format!("albedo_texture = {}\n", self.file(&format!("texture-{index}.png"), &bytes)?)
            }
        };
        let _ = writeln!(
            self.text,
            "[[material]]\nname = {}\n{kind}\nalbedo = {:?}\n{texture}specular = {:?}\nroughness = {:?}\nemission = {:?}\nemits_both_sides = {}\n",
            quoted(name),
            m.albedo,
            m.specular_f0,
            m.roughness,
            m.emission,
            m.emits_both_sides
        );
        Ok(())
    }

    /// A mesh of a scene file has one material, so each mesh becomes one per material that it uses.
    fn meshes(&mut self, scene: &Scene, materials: &[String]) -> Result<()> {
        for (index, mesh) in scene.meshes.iter().enumerate() {
            let placements: Vec<_> = scene.instances.iter().filter(|i| i.mesh as usize == index).collect();
            let used: BTreeSet<u32> = mesh.material_ids.iter().copied().collect();
            // A mesh without a placement is not in the picture; in a scene file it would be placed once.
            for material in used.into_iter().filter(|_| !placements.is_empty()) {
                let name = format!("mesh-{index}-{material}");
                let bytes = ply::encode(mesh, |triangle| mesh.material_ids[triangle] == material);
                let path = self.file(&format!("{name}.ply"), &bytes)?;
                let own = quoted(&materials[material as usize]);
                let _ = writeln!(
                    self.text,
                    "[[mesh]] # {}\nname = \"{name}\"\npath = {path}\nmaterial = {own}\n",
                    quoted(&mesh.name)
                );
                for placement in &placements {
                    let matrix = matrix(&placement.transform);
                    let _ = writeln!(self.text, "[[instance]]\nmesh = \"{name}\"\nmatrix = {matrix:?}");
                    if let Some(material) = placement.material {
                        let _ = writeln!(self.text, "material = {}", quoted(&materials[material as usize]));
                    }
                    self.text.push('\n');
                }
            }
        }
        Ok(())
    }

    fn light(&mut self, light: &Light) {
        let lines = match *light {
            Light::Point { position, intensity } => {
                format!("type = \"point\"\nposition = {position:?}\nintensity = {intensity:?}")
            }
            Light::Spot { position, direction, intensity, inner_angle, outer_angle } => format!(
                "type = \"spot\"\nposition = {position:?}\ndirection = {direction:?}\nintensity = {intensity:?}\n\
                 inner_angle = {:?}\nouter_angle = {:?}",
                inner_angle.to_degrees(),
                outer_angle.to_degrees()
            ),
            Light::Directional { direction, irradiance } => {
                format!("type = \"directional\"\ndirection = {direction:?}\nirradiance = {irradiance:?}")
            }
            Light::Rectangle { corner, edge_u, edge_v, radiance } => format!(
                "type = \"rectangle\"\ncorner = {corner:?}\nedge_u = {edge_u:?}\nedge_v = {edge_v:?}\nradiance = {radiance:?}"
            ),
            Light::Sphere { center, radius, radiance } => {
                format!(
                    "type = \"sphere\"\ncenter = {center:?}\nradius = {radius:?}\nradiance = {radiance:?}"
                )
            }
        };
        let _ = writeln!(self.text, "[[light]]\n{lines}\n");
    }

    /// Writes a file and returns its path as the scene file quotes it.
    fn file(&mut self, name: &str, bytes: &[u8]) -> Result<String> {
        let path = self.folder.join(name);
        write_file(&path, bytes)?;
        self.files.push(path);
        Ok(quoted(&format!("{}/{name}", self.name)))
    }
}

fn matrix(t: &Transform) -> [[f64; 4]; 3] {
    let columns = [t.linear.x_axis, t.linear.y_axis, t.linear.z_axis, t.translation];
    [columns.map(|c| c.x), columns.map(|c| c.y), columns.map(|c| c.z)]
}

/// The names, with a number after those that came before.
fn unique_names<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut taken = BTreeSet::new();
    names
        .map(|name| {
            let mut unique = name.to_owned();
            let mut number = 2_u64;
            while !taken.insert(unique.clone()) {
                unique = format!("{name}-{number}");
                number += 1;
            }
            unique
        })
        .collect()
}

/// A TOML basic string.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => {
                let _ = write!(quoted, "\\u{:04X}", u32::from(c));
            }
            c => quoted.push(c),
        }
    }
    quoted + "\""
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_unique() {
        assert_eq!(unique_names(["a", "a", "a-2", "a"].into_iter()), ["a", "a-2", "a-2-2", "a-3"]);
    }

    #[test]
    fn strings_are_escaped() {
        assert_eq!(quoted("a\"b\\c\nd\u{7f}é"), r#""a\"b\\c\u000Ad\u007Fé""#);
    }
}
