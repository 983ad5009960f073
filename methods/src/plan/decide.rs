//! One decision per effect.

use super::bounces::{left_after, needed};
use super::{Decided, Decision, Edits, Effect, Effects, Facts, Method, Plan, Request, Sampling, Sight};
use crate::slhb::Shadows;
use crate::voxel::{MAX_BOUNCES, VoxelSettings};
use Decision::{Bounded, Lacking, Run, Skipped};

/// A decision, why, and what it leaves out.
type Verdict = (Decision, String, f64);

fn run(reason: impl Into<String>) -> Verdict {
    (Run, reason.into(), 0.0)
}

fn skipped(reason: impl Into<String>) -> Verdict {
    (Skipped, reason.into(), 0.0)
}

/// Decides about every effect, and draws the conclusions.
pub(super) fn decide(facts: Facts, request: &Request) -> Plan {
    let question = Question { facts: &facts, request };
    let (interreflection, bounces) = question.interreflection();
    let effects = Effect::NAMES.map(|(effect, _)| {
        let (decision, reason, bound) = match effect {
            Effect::Interreflection => interreflection.clone(),
            other => question.verdict(other, bounces),
        };
        Decided { effect, decision, reason, bound }
    });
    let edits = question.edits();
    let mut plan = Plan {
        request: request.clone(),
        effects: effects.to_vec(),
        edits,
        bounces,
        sampling: Sampling::Nothing,
        sampled_bounces: bounces,
        buffers: None,
        filter: 1,
        voxels: None,
        steps: Vec::new(),
        facts,
    };
    conclude(&mut plan);
    plan
}

/// What is built and sampled for the effects that are left.
fn conclude(plan: &mut Plan) {
    let scatters = |times: u32| plan.bounces.is_none_or(|bounces| bounces >= times);
    if !plan.lit() {
        plan.bounces = Some(0);
        plan.sampled_bounces = Some(0);
        return;
    }
    plan.sampling = Sampling::Paths;
    match &plan.request.method {
        Method::Reference => {}
        Method::Slhb { lookups, filter } => {
            // First vertices look shadow rays up too, where those are asked for.
            let looks_up = scatters(2) || (scatters(1) && lookups.shadows == Shadows::Lookups);
            if looks_up {
                (plan.sampling, plan.buffers) = (Sampling::Lookups, Some(lookups.clone()));
                plan.filter = *filter;
            }
        }
        Method::Voxel(settings) => {
            if scatters(2) {
                let bounces = plan.bounces.unwrap_or(settings.bounces);
                let shining = [Effect::GlossyReflection, Effect::MirrorReflection];
                let shining = shining.into_iter().any(|effect| plan.decision(effect) == Run);
                let seed = plan.request.picture.seed;
                plan.voxels = Some(VoxelSettings { bounces, shining, seed, ..*settings });
            }
            plan.sampled_bounces = Some(plan.bounces.unwrap_or(1).min(1));
        }
    }
}

impl Plan {
    /// Whether any light is simulated at all.
    fn lit(&self) -> bool {
        self.request.effects == Effects::All
            || self.decision(Effect::Emission) == Run
            || self.decision(Effect::DirectLight) != Skipped
    }
}

/// What the decisions are about.
struct Question<'a> {
    facts: &'a Facts,
    request: &'a Request,
}

impl Question<'_> {
    fn all(&self) -> bool {
        self.request.effects == Effects::All
    }

    fn admits(&self, effect: Effect) -> bool {
        self.request.effects.admit(effect)
    }

    fn is_voxel(&self) -> bool {
        matches!(self.request.method, Method::Voxel(_))
    }

    /// Whether light comes from anywhere, of what is wanted.
    fn has_light(&self) -> bool {
        let environment = self.facts.environment && self.admits(Effect::EnvironmentLight);
        self.facts.area_lights + self.facts.delta_lights > 0 || environment
    }

    fn has_extended_light(&self) -> bool {
        self.facts.area_lights > 0 || (self.facts.environment && self.admits(Effect::EnvironmentLight))
    }

    /// A person left an effect out: as much may be missing as there may be light at all.
    fn left_out(&self, from_bounce: u32) -> Verdict {
        let bound = left_after(self.facts, from_bounce);
        (Skipped, "it was left out on request".into(), bound)
    }

    fn verdict(&self, effect: Effect, bounces: Option<u32>) -> Verdict {
        match effect {
            Effect::Emission => self.emission(),
            Effect::DirectLight => self.direct(bounces),
            Effect::Shadows => self.shadows(bounces),
            Effect::SoftShadows => self.soft_shadows(bounces),
            Effect::EnvironmentLight => self.environment(),
            Effect::Interreflection => skipped(""),
            Effect::GlossyReflection => self.shine(effect, self.facts.glossy, "surfaces with a lobe"),
            Effect::MirrorReflection => self.shine(effect, self.facts.mirrors, "mirrors"),
            Effect::Refraction => self.refraction(),
            Effect::Caustics => self.caustics(bounces),
            Effect::Textures => self.textures(),
            Effect::Motion => self.motion(),
        }
    }

    fn emission(&self) -> Verdict {
        match (self.facts.area_lights, self.facts.environment && self.admits(Effect::EnvironmentLight)) {
            _ if self.all() => run("everything is asked for"),
            (0, false) => skipped("nothing that gives light can be seen"),
            (0, true) => run("the surroundings give light"),
            (lamps, _) => run(format!("{lamps} surfaces give light")),
        }
    }

    fn direct(&self, bounces: Option<u32>) -> Verdict {
        if self.all() {
            return run("everything is asked for");
        }
        if !self.has_light() {
            return skipped("nothing gives light");
        }
        match bounces {
            Some(0) if self.request.picture.bounces == Some(0) => skipped("no bounces are asked for"),
            Some(0) if left_after(self.facts, 0) == 0.0 => skipped("no surface reflects anything"),
            Some(0) => {
                let left = left_after(self.facts, 0);
                (Bounded, "all that surfaces reflect is below the tolerance".into(), left)
            }
            _ => {
                let (areas, points) = (self.facts.area_lights, self.facts.delta_lights);
                let map = if self.facts.environment { " and the surroundings" } else { "" };
                run(format!("{areas} lights with an extent, {points} without{map}"))
            }
        }
    }

    fn shadows(&self, bounces: Option<u32>) -> Verdict {
        match self.facts.sight {
            _ if self.all() => run("everything is asked for"),
            _ if !self.has_light() => skipped("nothing gives light"),
            _ if bounces == Some(0) => skipped("no light is scattered"),
            Sight::None(why) => skipped(format!("no surface hides a light from another: {why}")),
            _ if !self.admits(Effect::Shadows) => self.left_out(0),
            Sight::Some(why) | Sight::Unknown(why) => run(why),
        }
    }

    fn soft_shadows(&self, bounces: Option<u32>) -> Verdict {
        match self.shadows(bounces).0 {
            Run if self.all() => run("everything is asked for"),
            Run if self.has_extended_light() => run("lights have an extent"),
            Run => skipped("no light has an extent"),
            _ => skipped("there are no shadows"),
        }
    }

    fn environment(&self) -> Verdict {
        if self.all() {
            run("everything is asked for")
        } else if !self.facts.environment {
            skipped("no light comes from the surroundings")
        } else if self.admits(Effect::EnvironmentLight) {
            run("the scene has an environment")
        } else {
            (Skipped, "it was left out on request".into(), f64::INFINITY)
        }
    }

    /// The verdict, and how often light is scattered at most.
    fn interreflection(&self) -> (Verdict, Option<u32>) {
        let asked = self.request.picture.bounces;
        if self.all() {
            return self.all_bounces(asked);
        }
        if asked.is_some_and(|bounces| bounces < 2) {
            return (skipped("fewer than two bounces are asked for"), asked);
        }
        if !self.has_light() {
            return (skipped("nothing gives light"), Some(0));
        }
        if let Sight::None(why) = self.facts.sight {
            return (skipped(format!("no surface sees another: {why}")), Some(1));
        }
        if !self.admits(Effect::Interreflection) {
            return (self.left_out(1), Some(1));
        }
        match needed(self.facts, self.request.tolerance) {
            Some(bounces) if asked.is_none_or(|asked| bounces < asked) => self.enough(bounces),
            _ => self.all_bounces(asked),
        }
    }

    /// As many bounces as the tolerance asks for.
    fn enough(&self, bounces: u32) -> (Verdict, Option<u32>) {
        let (left, share) = (left_after(self.facts, bounces), self.facts.reflectance);
        if self.is_voxel() && self.request.picture.bounces.is_none() {
            return self.usual_bounces(bounces);
        }
        let reason = match bounces {
            _ if left == 0.0 => "no surface reflects anything".into(),
            0 | 1 => format!(
                "surfaces reflect at most {share:.3}: light that is scattered twice is below the tolerance"
            ),
            _ => format!("{bounces} bounces: surfaces reflect at most {share:.3} of what they get"),
        };
        let decision = if bounces < 2 && left == 0.0 { Skipped } else { Bounded };
        ((decision, reason, left), Some(bounces))
    }

    /// As many as are asked for.
    fn all_bounces(&self, asked: Option<u32>) -> (Verdict, Option<u32>) {
        match asked {
            None if self.is_voxel() => self.usual_bounces(MAX_BOUNCES),
            None => {
                let what = self.facts.brightest_surface;
                let share = self.facts.reflectance;
                (run(format!("to roulette: what reflects most ({share:.3}) is {what}")), None)
            }
            Some(bounces) => (run(format!("{bounces} bounces are asked for")), asked),
        }
    }

    /// Voxels gather every bounce for itself: without a number, as often as the method's own setting says.
    fn usual_bounces(&self, needed: u32) -> (Verdict, Option<u32>) {
        let usual = match &self.request.method {
            Method::Voxel(settings) => settings.bounces,
            _ => MAX_BOUNCES,
        };
        let bounces = usual.min(needed);
        let reason = format!("{bounces} bounces, unless --bounces says otherwise");
        ((Bounded, reason, left_after(self.facts, bounces)), Some(bounces))
    }

    fn shine(&self, effect: Effect, count: usize, what: &str) -> Verdict {
        if self.all() {
            run("everything is asked for")
        } else if count == 0 {
            skipped(format!("there are no {what}"))
        } else if !self.admits(effect) {
            (Skipped, "it was left out on request".into(), f64::INFINITY)
        } else if self.is_voxel() && !self.facts.shining_in_view {
            skipped(format!("none of {count} {what} is in the picture"))
        } else {
            run(format!("{count} {what}"))
        }
    }

    fn refraction(&self) -> Verdict {
        match self.facts.glass {
            0 if self.all() => run("everything is asked for"),
            0 => skipped("there is no glass"),
            _ if !self.admits(Effect::Refraction) => {
                (Skipped, "it was left out on request".into(), f64::INFINITY)
            }
            _ if self.is_voxel() => (Lacking, "cones don't go through glass".into(), f64::INFINITY),
            count => run(format!("{count} surfaces of glass")),
        }
    }

    fn caustics(&self, bounces: Option<u32>) -> Verdict {
        let is_wanted = |effect, count: usize| count > 0 && self.admits(effect);
        let throws = is_wanted(Effect::GlossyReflection, self.facts.glossy)
            || is_wanted(Effect::MirrorReflection, self.facts.mirrors)
            || is_wanted(Effect::Refraction, self.facts.glass);
        if !throws {
            return skipped("nothing throws light in a direction");
        }
        if bounces.is_some_and(|bounces| bounces < 2) {
            return skipped("light is scattered less than twice");
        }
        let by_mirrors = self.facts.mirrors + self.facts.glass > 0;
        if self.is_voxel() {
            (Lacking, "voxels scatter all light diffusely".into(), f64::INFINITY)
        } else if by_mirrors && self.facts.delta_lights > 0 {
            (Lacking, "no path from mirrors or glass meets a light without an extent".into(), f64::INFINITY)
        } else {
            run("lobes, mirrors and glass throw light")
        }
    }

    fn textures(&self) -> Verdict {
        match self.facts.textured {
            _ if self.all() => run("everything is asked for"),
            0 => skipped("no surface has a texture"),
            _ if !self.admits(Effect::Textures) => {
                (Skipped, "they were left out on request".into(), f64::INFINITY)
            }
            count => run(format!("{count} triangles have one")),
        }
    }

    fn motion(&self) -> Verdict {
        match self.facts.moving {
            0 if self.all() => run("everything is asked for"),
            0 => skipped("nothing moves"),
            count => run(format!("{count} of {} triangles move", self.facts.triangles)),
        }
    }

    fn edits(&self) -> Edits {
        if self.all() {
            return Edits::default();
        }
        let (facts, left_out) = (self.facts, |effect| !self.admits(effect));
        let sees_none = matches!(facts.sight, Sight::None(_)) && facts.triangles > 0;
        Edits {
            nothing_hides: sees_none || left_out(Effect::Shadows),
            drop_glossy: facts.glossy > 0 && left_out(Effect::GlossyReflection),
            drop_mirrors: facts.mirrors > 0 && left_out(Effect::MirrorReflection),
            drop_glass: facts.glass > 0 && left_out(Effect::Refraction),
            drop_textures: facts.textured > 0 && left_out(Effect::Textures),
            drop_environment: facts.environment && left_out(Effect::EnvironmentLight),
        }
    }
}
