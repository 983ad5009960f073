//! Animations: keyframes of nodes (glTF 2.0, §3.11).

use super::Document;
use super::node::Rest;
use crate::io::text;
use ::gltf::json::animation::{
    Animation as JsonAnimation, Channel, Interpolation as Name, Property, Sampler,
};
use ::gltf::json::validation::Checked;
use ::gltf::json::{self, Index};
use glam::{DQuat, DVec3};
use std::collections::BTreeMap;
use twinlight_core::scene::motion::{Curve, Interpolation, Keyed, Local, Track};
use twinlight_core::{Error, Result};

/// Names listed when the one asked for is not there, at most.
const LISTED: usize = 12;

/// The animation that is played.
#[derive(Default)]
pub(super) struct Animation {
    /// Curves by node.
    nodes: BTreeMap<usize, Curves>,
    /// Seconds to the last keyframe.
    pub duration: f64,
}

#[derive(Default)]
struct Curves {
    translation: Option<Curve<DVec3>>,
    rotation: Option<Curve<DQuat>>,
    scale: Option<Curve<DVec3>>,
}

impl Animation {
    /// How a node moves within its parent, if channels target it; what none moves stays at rest. Once for each node.
    pub fn take(&mut self, node: Index<json::Node>, rest: &Rest) -> Option<Local> {
        let Curves { translation, rotation, scale } = self.nodes.remove(&node.value())?;
        Some(Local::Keyed(Box::new(Track {
            translation: translation.unwrap_or_else(|| Curve::constant(rest.translation)),
            rotation: rotation.unwrap_or_else(|| Curve::constant(rest.rotation)),
            scale: scale.unwrap_or_else(|| Curve::constant(rest.scale)),
        })))
    }

    /// Nodes that were not taken.
    pub fn left(&self) -> impl Iterator<Item = usize> {
        self.nodes.keys().copied()
    }
}

impl Document<'_> {
    /// The animation asked for, else the first; none when there is none.
    pub fn animation(&self) -> Result<Animation> {
        let mut played = Animation::default();
        let Some(chosen) = self.chosen_animation()? else { return Ok(played) };
        for (i, animation) in self.root.animations.iter().enumerate().filter(|(i, _)| *i != chosen) {
            self.note("animations not played", animation.name.clone().unwrap_or_else(|| i.to_string()));
        }
        let animation = &self.root.animations[chosen];
        for (i, channel) in animation.channels.iter().enumerate() {
            let path = format!("animations[{chosen}].channels[{i}]");
            let sampler = self.get(&animation.samplers, channel.sampler, "sampler", &path)?;
            let sampler_path = format!("animations[{chosen}].samplers[{}]", channel.sampler.value());
            self.channel(channel, sampler, &path, &sampler_path, &mut played)?;
        }
        Ok(played)
    }

    fn chosen_animation(&self) -> Result<Option<usize>> {
        let animations = &self.root.animations;
        let Some(wish) = self.options.animation.as_deref() else {
            return Ok((!animations.is_empty()).then_some(0));
        };
        // One wish may be for several files of a scene, some of which stand still.
        if animations.is_empty() {
            return Ok(None);
        }
        let named = |a: &JsonAnimation| a.name.as_deref() == Some(wish);
        if let Some(index) = animations.iter().position(named) {
            return Ok(Some(index));
        }
        if let Some(index) = wish.parse().ok().filter(|&index: &usize| index < animations.len()) {
            return Ok(Some(index));
        }
        let names: Vec<&str> = animations.iter().filter_map(|a| a.name.as_deref()).collect();
        let hint = text::did_you_mean(wish, names.iter().copied());
        let listed: Vec<String> =
            names.iter().take(LISTED).map(|name| text::shown(name.as_bytes())).collect();
        let known = match animations.len() {
            n if listed.is_empty() => format!("there are numbers 0 to {}", n - 1),
            n => format!("there are {n}: {}{}", listed.join(", "), if n > listed.len() { ", …" } else { "" }),
        };
        let what = format!("no animation is called '{}'{hint}; {known}", text::shown(wish.as_bytes()));
        Err(self.invalid("animations", what))
    }

    fn channel(
        &self,
        channel: &Channel,
        sampler: &Sampler,
        path: &str,
        sampler_path: &str,
        played: &mut Animation,
    ) -> Result<()> {
        let target = &channel.target;
        let node = self.get(&self.root.nodes, target.node, "node", &format!("{path}.target"))?;
        let node_path = format!("nodes[{}]", target.node.value());
        if node.matrix.is_some() {
            let what = format!("moves {node_path}, whose transform is a matrix");
            return Err(self.invalid(&format!("{path}.target"), what));
        }
        let mut curves = played.nodes.remove(&target.node.value()).unwrap_or_default();
        let end = match target.path {
            Checked::Valid(Property::Translation) => {
                self.set(&mut curves.translation, sampler, path, sampler_path, DVec3::from_array)?
            }
            Checked::Valid(Property::Rotation) => {
                self.set(&mut curves.rotation, sampler, path, sampler_path, DQuat::from_array)?
            }
            Checked::Valid(Property::Scale) => {
                self.set(&mut curves.scale, sampler, path, sampler_path, DVec3::from_array)?
            }
            Checked::Valid(Property::MorphTargetWeights) => {
                self.note("animated morph weights ignored", node_path);
                0.0
            }
            Checked::Invalid => {
                self.note("animated properties that are not known ignored", node_path);
                0.0
            }
        };
        if curves.translation.is_some() || curves.rotation.is_some() || curves.scale.is_some() {
            played.nodes.insert(target.node.value(), curves);
        }
        played.duration = played.duration.max(end);
        Ok(())
    }

    /// Reads a sampler into `slot`; returns the time of its last keyframe.
    fn set<const N: usize, T: Keyed>(
        &self,
        slot: &mut Option<Curve<T>>,
        sampler: &Sampler,
        path: &str,
        sampler_path: &str,
        value: fn([f64; N]) -> T,
    ) -> Result<f64> {
        if slot.is_some() {
            return Err(self.invalid(path, "another channel moves the same property of the same node"));
        }
        let interpolation = match sampler.interpolation {
            Checked::Valid(Name::Linear) => Interpolation::Linear,
            Checked::Valid(Name::Step) => Interpolation::Step,
            Checked::Valid(Name::CubicSpline) => Interpolation::CubicSpline,
            Checked::Invalid => return Err(self.invalid(sampler_path, "has no valid interpolation")),
        };
        let times = self.floats::<1>(sampler.input, &format!("{sampler_path}.input"))?;
        let values = self.floats::<N>(sampler.output, &format!("{sampler_path}.output"))?;
        // Kept in f64, and a file may use one accessor for many channels.
        let place = || format!("{}: {sampler_path}", self.name);
        self.budget.spend(place, times.len() as u64, 8)?;
        self.budget.spend(place, values.len() as u64, size_of::<T>() as u64)?;
        let times: Vec<f64> = times.iter().map(|&[time]| f64::from(time)).collect();
        let end = times.last().copied().unwrap_or_default();
        let values = values.into_iter().map(|v| value(v.map(f64::from))).collect();
        let curve = Curve::new(interpolation, times, values).map_err(|error| match error {
            Error::InvalidInput { place, what } => self.invalid(sampler_path, format!("{place}: {what}")),
            other => other,
        })?;
        *slot = Some(curve);
        Ok(end)
    }
}
