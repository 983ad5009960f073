//! The order in which walkers look up: after those that are traced, by view, along it and against it.

use super::{ENDED, TRACED, Walker};

/// A counting sort of the walkers that go on.
pub(super) struct Order {
    /// One for those that are traced, two per view, and one for the end.
    begins: Vec<u32>,
    walkers: Vec<u32>,
}

impl Order {
    pub(super) fn new(walkers: usize, views: usize) -> Self {
        Self { begins: vec![0; 2 * views + 2], walkers: vec![0; walkers] }
    }

    #[inline(always)]
    fn bin(walker: &Walker) -> usize {
        if walker.ray == TRACED { 0 } else { walker.ray as usize + 1 }
    }

    #[inline(always)]
    pub(super) fn sort(&mut self, walkers: &[Walker]) {
        self.begins.fill(0);
        for walker in walkers.iter().filter(|walker| walker.ray != ENDED) {
            self.begins[Self::bin(walker) + 1] += 1;
        }
        for bin in 1..self.begins.len() {
            self.begins[bin] += self.begins[bin - 1];
        }
        let count = self.begins[self.begins.len() - 1] as usize;
        self.walkers.truncate(count);
        for (index, walker) in walkers.iter().enumerate().filter(|(_, walker)| walker.ray != ENDED) {
            let place = &mut self.begins[Self::bin(walker)];
            self.walkers[*place as usize] = index as u32;
            *place += 1;
        }
    }

    /// Those whose rays are traced.
    pub(super) fn traced(&self) -> &[u32] {
        &self.walkers[..self.begins[0] as usize]
    }

    /// Those whose rays are looked up, by view.
    pub(super) fn looked_up(&self) -> &[u32] {
        &self.walkers[self.begins[0] as usize..]
    }

    pub(super) fn is_empty(&self) -> bool {
        self.walkers.is_empty()
    }
}
