//! The order of lookups: after rays that are traced, by view, along it and against it.

use super::{ENDED, Leaves, TRACED};

/// A counting sort of the rays that go on.
pub(super) struct Order {
    /// One for those that are traced, two per view, and one for the end.
    begins: Vec<u32>,
    indices: Vec<u32>,
}

impl Order {
    pub(super) fn new(views: usize) -> Self {
        Self { begins: vec![0; 2 * views + 2], indices: Vec::new() }
    }

    #[inline(always)]
    fn bin(ray: u32) -> usize {
        if ray == TRACED { 0 } else { ray as usize + 1 }
    }

    #[inline(always)]
    pub(super) fn sort<R: Leaves>(&mut self, rays: &[R]) {
        self.begins.fill(0);
        for ray in rays.iter().map(R::ray).filter(|ray| *ray != ENDED) {
            self.begins[Self::bin(ray) + 1] += 1;
        }
        for bin in 1..self.begins.len() {
            self.begins[bin] += self.begins[bin - 1];
        }
        let count = self.begins[self.begins.len() - 1] as usize;
        self.indices.resize(count, 0);
        for (index, ray) in rays.iter().map(R::ray).enumerate().filter(|(_, ray)| *ray != ENDED) {
            let place = &mut self.begins[Self::bin(ray)];
            self.indices[*place as usize] = index as u32;
            *place += 1;
        }
    }

    /// Those that are traced.
    pub(super) fn traced(&self) -> &[u32] {
        &self.indices[..self.begins[0] as usize]
    }

    /// Those that are looked up, by view.
    pub(super) fn looked_up(&self) -> &[u32] {
        &self.indices[self.begins[0] as usize..]
    }

    pub(super) fn is_empty(&self) -> bool {
        self.indices.is_empty()
    }
}
