//! Where a voxel's children are.

/// The level below one whose voxels are looked at.
pub(super) struct Below<'a, const W: usize> {
    pub(super) mask: &'a [u32],
    pub(super) ranks: &'a [u32],
    /// Number of its first value.
    pub(super) begin: u32,
    pub(super) values: &'a [[u32; W]],
}

impl<'a, const W: usize> Below<'a, W> {
    /// The children's values, and a bit for each one's octant. None where masks and ranks of other origin lead out of the level.
    #[inline(always)]
    pub(super) fn children(&self, code: u32) -> (&'a [[u32; W]], u32) {
        let (word, shift) = ((code >> 2) as usize, (code & 3) * 8);
        let (Some(&bits), Some(&rank)) = (self.mask.get(word), self.ranks.get(word)) else {
            return (&[], 0);
        };
        let octants = (bits >> shift) & 0xff;
        let first = rank.wrapping_sub(self.begin).wrapping_add((bits & ((1 << shift) - 1)).count_ones());
        let end = first.wrapping_add(octants.count_ones());
        match self.values.get(first as usize..end as usize) {
            Some(children) => (children, octants),
            None => (&[], 0),
        }
    }
}

/// Children at their octants; those that are missing are all zeroes.
#[inline(always)]
pub(super) fn placed<const W: usize>(children: &[[u32; W]], octants: u32) -> [[u32; W]; 8] {
    let mut places = [[0; W]; 8];
    let mut octants = octants;
    for child in children {
        places[octants.trailing_zeros() as usize & 7] = *child;
        octants &= octants.wrapping_sub(1);
    }
    places
}
