//! Light that waits for the lookup of its shadow ray.

use super::order::Order;
use super::{Leaves, Leaving, Walker, Wave};
use crate::kernels::query_lhb::BATCH;
use crate::path::{DirectLight, add_light, nothing_hides};
use crate::simd::{Width, prefetch};
use glam::Vec3;
use twinlight_core::kernels::walk_lhb::{SHADOW_LOOKUPS, SHADOW_LOOKUPS_FIRST};
use twinlight_core::transport::lhb::{lhb_hit, lhb_shadows};
use twinlight_core::transport::light::FAR;

/// Light that arrives if its lookup finds nothing before it. A line of the cache, beside the walkers: most passes have none.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct Shadow {
    leaving: Leaving,
    /// To the light; [`FAR`] for infinitely.
    distance: f32,
    radiance: Vec3,
    /// Twice the walker's index, plus 1 for light that is scattered more than once.
    place: u32,
}

impl Leaves for Shadow {
    #[inline(always)]
    fn leaving(&self) -> Leaving {
        self.leaving
    }

    #[inline(always)]
    fn reach(&self) -> f32 {
        self.distance
    }

    #[inline(always)]
    fn ray(&self) -> u32 {
        self.leaving.ray
    }
}

/// What waits, and the order in which it is looked up.
pub(super) struct Shadows {
    waiting: Vec<Shadow>,
    order: Order,
}

impl Shadows {
    pub(super) fn new(views: usize) -> Self {
        Self { waiting: Vec::new(), order: Order::new(views) }
    }
}

/// Asks for the lines that a batch will read and write.
#[inline(always)]
fn fetch(waiting: &[Shadow], walkers: &[Walker], batch: &[u32]) {
    for &index in batch {
        let shadow = &waiting[index as usize];
        prefetch(shadow);
        prefetch(&walkers[(shadow.place >> 1) as usize].path.light);
    }
}

impl<W: Width> Wave<'_, W> {
    /// Whether the shadow rays of a vertex are looked up.
    #[inline(always)]
    pub(super) fn shadows_are_looked_up(&self, vertex: u32) -> bool {
        let flags = self.params.lookup.flags;
        let is_looked_up = flags & SHADOW_LOOKUPS != 0 && (vertex > 0 || flags & SHADOW_LOOKUPS_FIRST != 0);
        is_looked_up && !nothing_hides(&self.scene)
    }

    /// Leaves light for [`Wave::add_waiting`]. False where there is no direction to look up, which the tracer sees to.
    #[inline(always)]
    pub(super) fn leave(&self, direct: &DirectLight, walker: u32, slot: u32, shadows: &mut Shadows) -> bool {
        let squared = direct.direction.dot(direct.direction);
        if !(squared > 0.0) {
            return false;
        }
        // Sphere lights are with the scene, and a ray meets them whatever it looks up.
        if direct.is_behind_spheres(&self.scene) {
            return true;
        }
        let mut distance = FAR;
        let mut direction = direct.direction;
        if !direct.infinite {
            distance = squared.sqrt();
            direction *= 1.0 / distance;
        }
        let ray = self.nearest_ray(direct.normal, direction);
        let leaves = slot << 1 | u32::from(direct.front);
        let leaving = Leaving { origin: direct.origin, direction, normal: direct.normal, leaves, ray };
        let place = walker << 1 | u32::from(direct.order > 1);
        shadows.waiting.push(Shadow { leaving, distance, radiance: direct.radiance, place });
        true
    }

    /// Adds the light that waits unless the lookup of its ray finds something before it.
    #[inline(always)]
    pub(super) fn add_waiting(&self, shadows: &mut Shadows, walkers: &mut [Walker]) {
        let Shadows { waiting, order } = shadows;
        if waiting.is_empty() {
            return;
        }
        order.sort(waiting);
        let mut next = order.looked_up().chunks(BATCH).skip(1);
        for batch in order.looked_up().chunks(BATCH) {
            fetch(waiting, walkers, next.next().unwrap_or_default());
            self.add_batch(waiting, batch, walkers);
        }
        waiting.clear();
    }

    #[inline(always)]
    fn add_batch(&self, waiting: &[Shadow], batch: &[u32], walkers: &mut [Walker]) {
        let lookup = &self.params.lookup;
        let (queries, found) = self.find(waiting, batch);
        for ((query, found), &index) in queries.iter().zip(&found).zip(batch) {
            let Shadow { leaving, distance, radiance, place } = &waiting[index as usize];
            let view = &self.lookups.lhb.views[(leaving.ray >> 1) as usize];
            let (origin, direction) = (leaving.origin, leaving.direction);
            let hit =
                lhb_hit(lookup, &self.scene, view, query, origin, direction, *found, self.follows_rays());
            if !lhb_shadows(lookup, &hit, *distance) {
                add_light(&mut walkers[(place >> 1) as usize].path.light, 1 + (place & 1), *radiance);
            }
        }
    }
}
