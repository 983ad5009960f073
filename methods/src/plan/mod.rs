//! What a render simulates, and what it leaves out and why: decided before anything runs.
//!
//! [`Plan::new`] looks at a scene and at what is asked for, and decides about every [`Effect`]. It is a function of its arguments, needs no device, and
//! says of everything that is left out how much radiance a pixel can lack because of it. [`Plan::run`] does what the plan says and nothing else.
//!
//! ```
//! use twinlight_core::scene::{Camera, Limits, compile};
//! use twinlight_methods::plan::{Decision, Effect, Effects, Method, Plan, Request};
//! use twinlight_methods::reference::Settings;
//!
//! # fn main() -> twinlight_core::Result<()> {
//! let room = twinlight_fixtures::scenes::builtin("cornell").expect("there is one");
//! let compiled = compile(&room, &Limits::default())?;
//! let camera = Camera::of_scene(&room).expect("it has one");
//! let request = Request {
//!     method: Method::Reference,
//!     picture: Settings::default(),
//!     effects: Effects::Auto,
//!     tolerance: 1.0 / 255.0,
//! };
//! let plan = Plan::new(&compiled, &camera, &request)?;
//! assert_eq!(plan.decision(Effect::Refraction), Decision::Skipped);
//! assert_eq!(plan.decision(Effect::Interreflection), Decision::Bounded);
//! assert!(plan.bound() <= 1.0 / 255.0);
//! # Ok(())
//! # }
//! ```

mod apply;
mod bounces;
mod decide;
mod effect;
mod facts;
mod light;
mod request;
mod sight;
mod steps;

pub use apply::Edits;
pub use effect::{Decided, Decision, Effect, Effects};
pub use facts::Facts;
pub use request::{Method, Request};
pub use sight::Sight;
pub use steps::{Dispatches, Step};

use crate::slhb::LookupSettings;
use crate::voxel::VoxelSettings;
use twinlight_core::Result;
use twinlight_core::scene::{Camera, CompiledScene};

/// What samples a picture's pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sampling {
    /// Nothing: the picture is black.
    Nothing,
    /// `trace_paths`.
    Paths,
    /// `walk_lhb`.
    Lookups,
}

/// What a render does.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// What was asked for.
    pub request: Request,
    /// What the scene has.
    pub facts: Facts,
    /// Every effect, in the order of [`Effect::NAMES`].
    pub effects: Vec<Decided>,
    /// What is changed about the scene before it is made resident.
    pub edits: Edits,
    /// How often light is scattered at most; `None` leaves it to roulette.
    pub bounces: Option<u32>,
    /// What samples pixels.
    pub sampling: Sampling,
    /// How often paths scatter while pixels are sampled; where cones gather the rest, less than [`Plan::bounces`].
    pub sampled_bounces: Option<u32>,
    /// Hit buffers to build.
    pub buffers: Option<LookupSettings>,
    /// The window that indirect light is averaged over, pixels; 1 averages nothing.
    pub filter: u32,
    /// Voxels to build and to gather from.
    pub voxels: Option<VoxelSettings>,
    /// The calls of kernels, in order.
    pub steps: Vec<Step>,
}

impl Plan {
    /// Decides what to simulate of `scene`, seen from `camera`.
    ///
    /// # Errors
    /// What the camera refuses.
    pub fn new(scene: &CompiledScene, camera: &Camera, request: &Request) -> Result<Self> {
        let size = (request.picture.width, request.picture.height);
        let facts = Facts::of(scene, camera, size)?;
        let mut plan = decide::decide(facts, request);
        plan.steps = steps::of(&plan);
        Ok(plan)
    }

    /// What is decided about an effect.
    pub fn decided(&self, effect: Effect) -> Option<&Decided> {
        self.effects.iter().find(|decided| decided.effect == effect)
    }

    /// The decision about an effect.
    pub fn decision(&self, effect: Effect) -> Decision {
        self.decided(effect).map_or(Decision::Skipped, |decided| decided.decision)
    }

    /// Most radiance by which a pixel of the picture that the plan makes differs from one with all effects that the method can simulate, beyond noise.
    pub fn bound(&self) -> f64 {
        let known = self.effects.iter().filter(|decided| decided.decision != Decision::Lacking);
        known.map(|decided| decided.bound).sum()
    }
}
