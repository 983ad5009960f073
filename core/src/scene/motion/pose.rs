//! A scene at a time.

use super::super::{Scene, Transform};
use super::{Binding, Local, Motion, Skin};
use crate::error::{Error, Result};

impl Motion {
    /// From every node's space to the world. Parents come first, so that theirs are known.
    fn world(&self, seconds: f64) -> Vec<Transform> {
        let mut world: Vec<Transform> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let local = match &node.local {
                Local::Fixed(transform) => *transform,
                Local::Keyed(track) => track.at(seconds),
            };
            let parent = node.parent.map_or(Transform::IDENTITY, |parent| world[parent as usize]);
            world.push(parent.then_inner(&local));
        }
        world
    }
}

impl Binding {
    fn transform(&self, world: &[Transform]) -> Transform {
        let outer = self.nodes.iter().map(|&node| world[node as usize]);
        let outer = outer.reduce(|outer, node| outer.then_inner(&node)).unwrap_or(Transform::IDENTITY);
        outer.then_inner(&self.inner)
    }
}

impl Scene {
    /// The scene as it stands at a time, in seconds; before the first keyframe it is as there, after the last likewise
    /// (glTF 2.0, §3.11). Instances that follow nodes get their transforms, meshes with skins their positions and normals;
    /// all else stays, so that the same triangle has the same number at all times. The result stands still, and its instances
    /// say which of them move ([`crate::scene::Instance::moves`]).
    ///
    /// What is scaled to nothing, as animations hide objects, becomes a point and keeps its triangles:
    /// [`Transform::or_point`].
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for a time that is not finite and for a motion that does not fit the scene, as
    /// [`Scene::validate`] finds it.
    pub fn at(&self, seconds: f64) -> Result<Self> {
        if !seconds.is_finite() {
            return Err(Error::invalid("time", format!("{seconds} seconds is not a finite number")));
        }
        self.motion.check(self)?;
        let world = self.motion.world(seconds);
        let mut meshes = self.meshes.clone();
        for skin in &self.motion.skins {
            skin.bend(&world, &mut meshes[skin.mesh as usize]);
        }
        let mut instances = self.instances.clone();
        for (instance, moves) in instances.iter_mut().zip(self.moving()) {
            instance.moves = moves;
        }
        for binding in &self.motion.bindings {
            instances[binding.instance as usize].transform = binding.transform(&world).or_point();
        }
        Ok(Self {
            meshes,
            instances,
            materials: self.materials.clone(),
            textures: self.textures.clone(),
            lights: self.lights.clone(),
            environment: self.environment.clone(),
            camera: self.camera,
            motion: Motion::default(),
            notices: self.notices.clone(),
        })
    }

    /// Whether an instance can be elsewhere, or of another shape, at another time, by the motion or by its own word; the others
    /// are the same in every [`Scene::at`]. [`Scene::moving`] tells it of all at once.
    pub fn moves(&self, instance: usize) -> bool {
        Moving::of(&self.motion).instance(self, instance)
    }

    /// [`Scene::moves`] of every instance.
    pub fn moving(&self) -> Vec<bool> {
        let moving = Moving::of(&self.motion);
        (0..self.instances.len()).map(|instance| moving.instance(self, instance)).collect()
    }
}

/// What changes with time.
struct Moving {
    nodes: Vec<bool>,
    skins: Vec<bool>,
}

impl Moving {
    fn of(motion: &Motion) -> Self {
        let mut nodes: Vec<bool> = Vec::with_capacity(motion.nodes.len());
        for node in &motion.nodes {
            let carried = node.parent.is_some_and(|parent| at(&nodes, parent));
            nodes.push(carried || matches!(&node.local, Local::Keyed(track) if !track.is_constant()));
        }
        let bends = |skin: &Skin| skin.joints.iter().any(|joint| at(&nodes, joint.node));
        let skins = motion.skins.iter().map(bends).collect();
        Self { nodes, skins }
    }

    fn instance(&self, scene: &Scene, index: usize) -> bool {
        let (bindings, skins) = (&scene.motion.bindings, &scene.motion.skins);
        let bound = bindings.binary_search_by_key(&index, |binding| binding.instance as usize);
        let carried = |binding: &Binding| binding.nodes.iter().any(|&node| at(&self.nodes, node));
        let skin = |mesh: u32| skins.binary_search_by_key(&mesh, |skin| skin.mesh).ok();
        let Some(instance) = scene.instances.get(index) else { return false };
        instance.moves
            || bound.is_ok_and(|binding| carried(&bindings[binding]))
            || skin(instance.mesh).is_some_and(|skin| self.skins[skin])
    }
}

/// A flag, or false outside: a motion that does not fit its scene is refused elsewhere.
fn at(flags: &[bool], index: u32) -> bool {
    flags.get(index as usize).copied().unwrap_or(false)
}

#[cfg(test)]
mod tests;
