//! From the tables of a scene file to one scene.

use super::adopt::{self, Follows, Placement};
use super::document::{Document, InstanceTable, MeshTable};
use super::held::Held;
use super::nesting::Nesting;
use super::source::Source;
use super::{RenderSettings, light, material, motion, place, view};
use crate::io::resolve::{Files, refused};
use crate::io::{LoadOptions, builtin, image, load, text};
use std::collections::BTreeMap;
use toml::Spanned;
use twinlight_core::scene::{Camera, Instance, Light, Scene, Transform};
use twinlight_core::{Error, Result};

/// Placements of one scene: scene files within each other could otherwise ask for billions.
const MAX_INSTANCES: usize = 1 << 20;

/// What a mesh file contributes wherever it is placed. Indices are those of the whole scene.
struct Part {
    instances: Vec<Instance>,
    /// What each instance follows.
    follows: Vec<Option<Follows>>,
    lights: Vec<Light>,
    camera: Option<Camera>,
    placed: bool,
}

/// Reads a scene file and all it names.
pub(super) fn scene(
    bytes: &[u8],
    name: &str,
    files: &dyn Files,
    options: &LoadOptions,
    nesting: &mut Nesting,
) -> Result<(Scene, RenderSettings)> {
    let source = Source::new(bytes, name)?;
    let document = source.document()?;
    nesting.enter(files.identity(name).unwrap_or_else(|_| name.to_owned()));
    let mut builder = Builder {
        source,
        files,
        options,
        scene: Scene::default(),
        materials: BTreeMap::new(),
        textures: BTreeMap::new(),
        parts: Vec::new(),
        part_by_name: BTreeMap::new(),
        held: Held::default(),
    };
    builder.fill(&document, nesting)?;
    nesting.leave();
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
    part_by_name: BTreeMap<String, usize>,
    /// Triangles and bytes of the scene's meshes and textures so far.
    held: Held,
}

impl Builder<'_> {
    fn fill(&mut self, document: &Document, nesting: &mut Nesting) -> Result<()> {
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
                let placement = Placement { transform: Transform::IDENTITY, track: None };
                self.place(i, &placement, None, &(0..0))?;
            }
        }
        for table in &document.light {
            self.scene.lights.push(light::light(table, &self.source)?);
        }
        if let Some(table) = &document.camera {
            self.scene.camera = Some(view::camera(table, &self.source)?);
        }
        if let Some(table) = &document.environment {
            self.scene.environment = Some({
                let limits = self.remaining().limits;
                view::environment(table, &self.source, &limits, |file| self.read(file, "environment"))?
            });
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
        let texture = image::decode_texture(&bytes, file.get_ref(), &self.remaining().limits)?;
        self.held.bytes += 4 * texture.texels.len() as u64;
        self.scene.textures.push(texture);
        let index = self.scene.textures.len() as u32 - 1;
        self.textures.insert(file.get_ref().clone(), index);
        Ok(index)
    }

    fn read(&self, file: &Spanned<String>, what: &str) -> Result<Vec<u8>> {
        let place = || self.source.place(&file.span());
        self.files.read_path(file.get_ref()).map_err(|e| refused(e, &place(), what, file.get_ref()))
    }

    fn mesh(&mut self, table: &MeshTable, nesting: &mut Nesting) -> Result<()> {
        let name = table.name.as_ref().unwrap_or(&table.path);
        if self.part_by_name.contains_key(name.get_ref()) {
            let what = format!("mesh '{}' is there twice; give each a name of its own", shown(name));
            return Err(self.source.error(&name.span(), what));
        }
        nesting.count_mesh_file()?;
        let own = self.load(table, nesting)?;
        if let Some(animation) = table.animation.as_ref().filter(|_| own.motion.is_empty()) {
            let what = format!("'{}' has no animation that could be played", shown(&table.path));
            return Err(self.source.error(&animation.span(), what));
        }
        let material = table.material.as_ref().map(|m| self.material_index(m)).transpose()?;
        let part = self.absorb(own, name.get_ref(), material)?;
        self.part_by_name.insert(name.get_ref().clone(), self.parts.len());
        self.parts.push(part);
        Ok(())
    }

    fn load(&self, table: &MeshTable, nesting: &mut Nesting) -> Result<Scene> {
        let path = &table.path;
        let mut options = self.remaining();
        options.animation = table.animation.as_ref().map(|a| a.get_ref().clone()).or(options.animation);
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
            nesting.check(&self.files.identity(text)?, text, &place)?;
            return scene(&bytes, name, files.as_ref(), &options, nesting).map(|(scene, _)| scene);
        };
        parse(&bytes, name, files.as_ref(), &options)
    }

    /// The options less what the scene holds already.
    fn remaining(&self) -> LoadOptions {
        let mut options = self.options.clone();
        options.limits.max_triangles = options.limits.max_triangles.saturating_sub(self.held.triangles);
        options.limits.max_bytes = options.limits.max_bytes.saturating_sub(self.held.bytes);
        options
    }

    /// Takes over what another file describes.
    fn absorb(&mut self, own: Scene, name: &str, material: Option<u32>) -> Result<Part> {
        let [meshes, materials, textures] =
            [self.scene.meshes.len(), self.scene.materials.len(), self.scene.textures.len()]
                .map(|n| n as u32);
        self.held.add(&own);
        let limits = &self.options.limits;
        // Builtin scenes know no limits.
        if self.held.triangles > limits.max_triangles {
            let what = "triangles of the scene's meshes";
            return Err(Error::limit(what, self.held.triangles, limits.max_triangles));
        }
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
        let follows = adopt::adopt(&mut self.scene.motion, own.motion, meshes, own.instances.len());
        let adopted = |i: Instance| Instance {
            mesh: i.mesh + meshes,
            material: material.or(i.material.map(|m| m + materials)),
            ..i
        };
        let instances = own.instances.into_iter().map(adopted).collect();
        Ok(Part { instances, follows, lights: own.lights, camera: own.camera, placed: false })
    }

    fn instance(&mut self, table: &InstanceTable) -> Result<()> {
        let Some(&part) = self.part_by_name.get(table.mesh.get_ref()) else {
            let names = self.part_by_name.keys().map(String::as_str);
            let hint = text::did_you_mean(table.mesh.get_ref(), names);
            let what = format!("no mesh is called '{}'{hint}", shown(&table.mesh));
            return Err(self.source.error(&table.mesh.span(), what));
        };
        let mut transform = place::transform(table, &self.source)?;
        let moving = motion::moving(table, &self.source, self.remaining().limits.max_bytes)?;
        if let Some(moving) = &moving {
            transform = moving.track.at(0.0).or_point();
            self.held.bytes += moving.bytes;
            self.scene.motion.duration = self.scene.motion.duration.max(moving.duration);
            if !self.parts[part].lights.is_empty() || self.parts[part].camera.is_some() {
                let name = shown(&table.mesh);
                let notice = format!("lights and cameras of '{name}' stay where its motion begins");
                self.scene.notices.push(notice);
            }
        }
        let material = table.material.as_ref().map(|m| self.material_index(m)).transpose()?;
        let placement = Placement { transform, track: moving.as_ref().map(|moving| &moving.track) };
        self.place(part, &placement, material, &table.mesh.span())
    }

    fn place(
        &mut self,
        part: usize,
        placement: &Placement<'_>,
        material: Option<u32>,
        at: &std::ops::Range<usize>,
    ) -> Result<()> {
        let part = &mut self.parts[part];
        part.placed = true;
        let count = self.scene.instances.len() + part.instances.len();
        if count > MAX_INSTANCES {
            return Err(Error::limit("instances of the scene", count as u64, MAX_INSTANCES as u64));
        }
        let transform = &placement.transform;
        let motion = &mut self.scene.motion;
        let node = placement.node(motion, part.follows.iter().any(Option::is_some));
        for (instance, follows) in part.instances.iter().zip(&part.follows) {
            motion.bindings.extend(placement.bind(
                self.scene.instances.len(),
                instance,
                follows.as_ref(),
                node,
            ));
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
}

fn shown(name: &Spanned<String>) -> String {
    text::shown(name.get_ref().as_bytes())
}
