//! From the tables of a scene file to one scene.

use super::document::{CameraTable, Document, EnvironmentTable, InstanceTable, MeshTable};
use super::source::Source;
use super::{RenderSettings, light, material, place};
use crate::io::resolve::{Files, refused};
use crate::io::{LoadOptions, builtin, image, load, text};
use glam::DMat3;
use std::collections::BTreeMap;
use toml::Spanned;
use twinlight_core::scene::{Camera, Environment, Instance, Light, Scene, Transform};
use twinlight_core::{Error, Result};

/// Scene files inside scene files, at most.
const MAX_DEPTH: usize = 8;
/// Mesh files of one scene, those of nested scene files included: eight levels of a few references each could
/// otherwise ask for billions.
const MAX_MESH_FILES: u32 = 4096;
/// Placements of one scene, for the same reason.
const MAX_INSTANCES: usize = 1 << 20;

/// The scene files that are being read.
pub(super) struct Nesting<'a> {
    options: &'a LoadOptions,
    /// Identities of the open scene files, outermost first.
    open: Vec<String>,
    /// Mesh files read so far.
    mesh_files: u32,
}

impl<'a> Nesting<'a> {
    pub fn new(options: &'a LoadOptions) -> Self {
        Self { options, open: Vec::new(), mesh_files: 0 }
    }
}

/// What a mesh file contributes wherever it is placed. Indices are those of the whole scene.
struct Part {
    name: String,
    instances: Vec<Instance>,
    lights: Vec<Light>,
    camera: Option<Camera>,
    placed: bool,
}

/// Reads a scene file and all it names.
pub(super) fn scene(
    bytes: &[u8],
    name: &str,
    files: &dyn Files,
    nesting: &mut Nesting<'_>,
) -> Result<(Scene, RenderSettings)> {
    let source = Source::new(bytes, name)?;
    let document = source.document()?;
    nesting.open.push(files.identity(name).unwrap_or_else(|_| name.to_owned()));
    let mut builder = Builder {
        source,
        files,
        options: nesting.options,
        scene: Scene::default(),
        materials: BTreeMap::new(),
        textures: BTreeMap::new(),
        parts: Vec::new(),
    };
    builder.fill(&document, nesting)?;
    nesting.open.pop();
    let render = document.render;
    let settings = RenderSettings {
        size: render.size,
        spp: render.spp,
        bounces: render.bounces,
        seed: render.seed,
        method: render.method,
    };
    Ok((builder.scene, settings))
}

struct Builder<'a> {
    source: Source<'a>,
    files: &'a dyn Files,
    options: &'a LoadOptions,
    scene: Scene,
    materials: BTreeMap<String, u32>,
    textures: BTreeMap<String, u32>,
    parts: Vec<Part>,
}

impl Builder<'_> {
    fn fill(&mut self, document: &Document, nesting: &mut Nesting<'_>) -> Result<()> {
        for table in &document.material {
            self.material(table)?;
        }
        for table in &document.mesh {
            self.mesh(table, nesting)?;
        }
        for table in &document.instance {
            self.instance(table)?;
        }
        for i in 0..self.parts.len() {
            if !self.parts[i].placed {
                self.place(i, &Transform::IDENTITY, None, &(0..0))?;
            }
        }
        for table in &document.light {
            self.scene.lights.push(light::light(table, &self.source)?);
        }
        if let Some(table) = &document.camera {
            self.scene.camera = Some(self.camera(table)?);
        }
        if let Some(table) = &document.environment {
            self.scene.environment = Some(self.environment(table)?);
        }
        Ok(())
    }

    fn material(&mut self, table: &Spanned<super::document::MaterialTable>) -> Result<()> {
        let mut material = material::material(table, &self.source)?;
        let name = &table.get_ref().name;
        if self.materials.contains_key(name.get_ref()) {
            let what = format!("material '{}' is defined twice", shown(name));
            return Err(self.source.error(&name.span(), what));
        }
        if let Some(file) = &table.get_ref().albedo_texture {
            material.albedo_texture = Some(self.texture(file)?);
        }
        let index = self.scene.add_material(material);
        self.materials.insert(name.get_ref().clone(), index);
        Ok(())
    }

    fn texture(&mut self, file: &Spanned<String>) -> Result<u32> {
        if let Some(&known) = self.textures.get(file.get_ref()) {
            return Ok(known);
        }
        let bytes = self.read(file, "texture")?;
        self.scene.textures.push(image::decode_texture(&bytes, file.get_ref(), &self.options.limits)?);
        let index = self.scene.textures.len() as u32 - 1;
        self.textures.insert(file.get_ref().clone(), index);
        Ok(index)
    }

    fn read(&self, file: &Spanned<String>, what: &str) -> Result<Vec<u8>> {
        let place = || self.source.place(&file.span());
        self.files.read_path(file.get_ref()).map_err(|e| refused(e, &place(), what, file.get_ref()))
    }

    fn mesh(&mut self, table: &MeshTable, nesting: &mut Nesting<'_>) -> Result<()> {
        let name = table.name.as_ref().unwrap_or(&table.path);
        if self.parts.iter().any(|p| p.name == *name.get_ref()) {
            let what = format!("mesh '{}' is there twice; give each a name of its own", shown(name));
            return Err(self.source.error(&name.span(), what));
        }
        nesting.mesh_files += 1;
        if nesting.mesh_files > MAX_MESH_FILES {
            let count = nesting.mesh_files.into();
            return Err(Error::limit("mesh files of the scene", count, MAX_MESH_FILES.into()));
        }
        let own = self.load(&table.path, nesting)?;
        let material = table.material.as_ref().map(|m| self.material_index(m)).transpose()?;
        let part = self.absorb(own, name.get_ref(), material)?;
        self.parts.push(part);
        Ok(())
    }

    fn load(&self, path: &Spanned<String>, nesting: &mut Nesting<'_>) -> Result<Scene> {
        let (text, place) = (path.get_ref(), self.source.place(&path.span()));
        if let Some(name) = text.strip_prefix(builtin::PREFIX) {
            return builtin::load(name).map_err(|e| refused(e, &place, "mesh", text));
        }
        let name = text.rsplit(['/', '\\']).next().unwrap_or(text);
        let reader = load::reader_of(name).map_err(|e| refused(e, &place, "mesh", text))?;
        let refuse = |e| refused(e, &place, "mesh file", text);
        let bytes = self.files.read_path(text).map_err(refuse)?;
        let files = self.files.beside(text).map_err(refuse)?;
        let load::Reader::Scene(parse) = reader else {
            self.check_nesting(text, &place, nesting)?;
            return scene(&bytes, name, files.as_ref(), nesting).map(|(scene, _)| scene);
        };
        parse(&bytes, name, files.as_ref(), self.options)
    }

    fn check_nesting(&self, path: &str, place: &str, nesting: &Nesting<'_>) -> Result<()> {
        let identity = self.files.identity(path)?;
        if nesting.open.contains(&identity) {
            return Err(Error::invalid(place, format!("'{path}' includes itself")));
        }
        if nesting.open.len() >= MAX_DEPTH {
            let depth = nesting.open.len() as u64 + 1;
            return Err(Error::limit(
                format!("{place}: scene files inside each other"),
                depth,
                MAX_DEPTH as u64,
            ));
        }
        Ok(())
    }

    /// Takes over what another file describes.
    fn absorb(&mut self, own: Scene, name: &str, material: Option<u32>) -> Result<Part> {
        let [meshes, materials, textures] =
            [self.scene.meshes.len(), self.scene.materials.len(), self.scene.textures.len()]
                .map(|n| n as u32);
        for mut mesh in own.meshes {
            mesh.material_ids.iter_mut().for_each(|id| *id += materials);
            self.scene.meshes.push(mesh);
        }
        for mut m in own.materials {
            m.albedo_texture = m.albedo_texture.map(|t| t + textures);
            self.scene.materials.push(m);
        }
        self.scene.textures.extend(own.textures);
        self.scene.notices.extend(own.notices);
        if own.environment.is_some() {
            self.scene
                .notices
                .push(format!("the environment of '{name}' is left out: only a scene's own counts"));
        }
        let stored = self.scene.meshes.iter().map(|m| m.triangles.len() as u64).sum();
        let limit = self.options.limits.max_triangles;
        if stored > limit {
            return Err(Error::limit("triangles of the scene's meshes", stored, limit));
        }
        let adopt = |i: Instance| Instance {
            mesh: i.mesh + meshes,
            material: material.or(i.material.map(|m| m + materials)),
            ..i
        };
        let instances = own.instances.into_iter().map(adopt).collect();
        Ok(Part { name: name.into(), instances, lights: own.lights, camera: own.camera, placed: false })
    }

    fn instance(&mut self, table: &InstanceTable) -> Result<()> {
        let Some(part) = self.parts.iter().position(|p| p.name == *table.mesh.get_ref()) else {
            let names = self.parts.iter().map(|p| p.name.as_str());
            let hint = text::did_you_mean(table.mesh.get_ref(), names);
            let what = format!("no mesh is called '{}'{hint}", shown(&table.mesh));
            return Err(self.source.error(&table.mesh.span(), what));
        };
        let transform = place::transform(table, &self.source)?;
        let material = table.material.as_ref().map(|m| self.material_index(m)).transpose()?;
        self.place(part, &transform, material, &table.mesh.span())
    }

    fn place(
        &mut self,
        part: usize,
        transform: &Transform,
        material: Option<u32>,
        at: &std::ops::Range<usize>,
    ) -> Result<()> {
        let part = &mut self.parts[part];
        part.placed = true;
        let count = self.scene.instances.len() + part.instances.len();
        if count > MAX_INSTANCES {
            return Err(Error::limit("instances of the scene", count as u64, MAX_INSTANCES as u64));
        }
        for instance in &part.instances {
            self.scene.instances.push(Instance {
                transform: transform.then_inner(&instance.transform),
                material: material.or(instance.material),
                ..instance.clone()
            });
        }
        for &own in &part.lights {
            self.scene.lights.push(place::light(own, transform, &self.source, at)?);
        }
        if let (None, Some(camera)) = (self.scene.camera, part.camera) {
            self.scene.camera = Some(place::camera(camera, transform));
        }
        Ok(())
    }

    fn material_index(&self, name: &Spanned<String>) -> Result<u32> {
        self.materials.get(name.get_ref()).copied().ok_or_else(|| {
            let hint = text::did_you_mean(name.get_ref(), self.materials.keys().map(String::as_str));
            self.source.error(&name.span(), format!("no [[material]] is called '{}'{hint}", shown(name)))
        })
    }

    fn camera(&self, table: &Spanned<CameraTable>) -> Result<Camera> {
        let CameraTable { position, target, up, vfov } = *table.get_ref();
        let camera = Camera { position, target, up, vfov_degrees: vfov };
        match camera.record(1, 1, [0.0; 3]) {
            Ok(_) => Ok(camera),
            Err(Error::InvalidInput { what, .. }) => Err(self.source.error(&table.span(), what)),
            Err(other) => Err(other),
        }
    }

    fn environment(&self, table: &Spanned<EnvironmentTable>) -> Result<Environment> {
        let t = table.get_ref();
        let mut environment = match (&t.file, t.radiance) {
            (Some(file), None) => {
                let bytes = self.read(file, "environment")?;
                image::read_exr_environment(&bytes, file.get_ref(), &self.options.limits)?
            }
            (None, Some(radiance)) => Environment::constant(radiance.narrow()),
            _ => {
                return Err(self
                    .source
                    .error(&table.span(), "an environment needs either 'file' or 'radiance'"));
            }
        };
        environment.scale = t.scale.unwrap_or(1.0);
        environment.rotation = DMat3::from_rotation_y(t.rotation.unwrap_or(0.0).to_radians());
        self.source
            .check(&table.span(), Scene { environment: Some(environment.clone()), ..Scene::default() })?;
        Ok(environment)
    }
}

fn shown(name: &Spanned<String>) -> String {
    text::shown(name.get_ref().as_bytes())
}
