//! Bugs in `query_lhb`: a reading of the lists on the host, wrong in one step.

use super::FaultyMesh;
use crate::faults::Fault;
use crate::oracle::query_lhb::{Looking, NOTHING, Plane};
use crate::oracle::rasterize_lhb::Lists;
use twinlight_core::kernels::query_lhb::{CLEARANCE, LhbQuery};
use twinlight_core::kernels::rasterize_lhb::{Lhb, LhbElement};
use twinlight_core::lattice::View;
use twinlight_core::{Backend, Error, Result};

pub(super) fn query_lhb<B: Backend>(
    inner: &B,
    fault: Fault,
    mesh: &FaultyMesh<B::Mesh>,
    lhb: &Lhb<B>,
    views: &[View],
    queries: &B::Buffer<LhbQuery>,
    hits: &mut B::Buffer<LhbElement>,
) -> Result<()> {
    let sound = inner.query_lhb(&mesh.inner, lhb, views, queries, hits);
    match sound {
        Err(Error::InvalidInput { .. }) if fault == Fault::QueryAcceptsLengths => return Ok(()),
        sound if !is_of_queries(fault) => return sound,
        sound => sound?,
    }
    let asked = inner.download(queries)?;
    let before = inner.download(hits)?;
    let lists = Lists {
        offsets: inner.download(&lhb.offsets)?,
        elements: inner.download(&lhb.elements)?,
        left_out: Vec::new(),
    };
    let corners = |triangle: &[u32; 3]| triangle.map(|v| mesh.host.vertices()[v as usize]);
    let broken = Broken {
        fault,
        size: lhb.size,
        views,
        lists: lists.each().collect(),
        planes: mesh.host.triangles().iter().map(|t| Plane::of(corners(t))).collect(),
    };
    let mut answers: Vec<LhbElement> = asked.iter().map(|query| broken.answer(query)).collect();
    if let (Fault::QueryLosesLast, true, Some(last)) = (fault, asked.len() > 256, answers.last_mut()) {
        *last = before[asked.len() - 1];
        last.depth ^= 1;
    }
    *hits = inner.upload(&answers)?;
    Ok(())
}

fn is_of_queries(fault: Fault) -> bool {
    crate::faults::FAULTS.iter().any(|(of, kernel, _)| *of == fault && *kernel == "query_lhb")
}

struct Broken<'a> {
    fault: Fault,
    size: u32,
    views: &'a [View],
    lists: Vec<&'a [LhbElement]>,
    planes: Vec<Plane>,
}

impl Broken<'_> {
    fn is(&self, fault: Fault) -> bool {
        self.fault == fault
    }

    fn answer(&self, query: &LhbQuery) -> LhbElement {
        let Some(looking) = self.looking(query) else { return NOTHING };
        let list = self.lists[looking.list(self.size)];
        let mut list =
            list[..if self.is(Fault::QueryLongLists) { list.len().min(64) } else { list.len() }].to_vec();
        if looking.reversed && !self.is(Fault::QueryOrderKept) {
            list.reverse();
        }
        if self.is(Fault::QueryTiesByNumber) {
            list.sort_by_key(|e| (looking.ahead(*e), e.triangle()));
        }
        let mut ahead = list.iter().filter(|e| self.is_hit(query, &looking, **e));
        let hit = if self.is(Fault::QueryLastAhead) { ahead.next_back() } else { ahead.next() };
        let turned = match self.fault {
            Fault::QueryFacingKept => false,
            Fault::QueryFacingAlwaysInverted => true,
            _ => looking.reversed,
        };
        hit.map_or(NOTHING, |e| LhbElement { surface: e.surface ^ u32::from(turned), ..*e })
    }

    fn looking(&self, query: &LhbQuery) -> Option<Looking> {
        let count = self.views.len() as u32;
        let pixel = 1 << (15 - self.size.next_power_of_two().trailing_zeros());
        let ray = match self.fault {
            Fault::QueryViewOffByOne if query.ray / 2 < count => (query.ray + 2) % (2 * count),
            Fault::QueryLastViewOnly if count > 0 => query.ray.min(2 * count - 1),
            Fault::QueryReversedIsView if query.ray / 2 < count => query.ray % count * 2 + query.ray % 2,
            _ => query.ray,
        };
        let offset = match self.fault {
            Fault::QueryIgnoresOffset => [0; 2],
            Fault::QueryOffsetInPixels => query.offset.map(|c| c.saturating_mul(pixel)),
            _ => query.offset,
        };
        let mut looking = Looking::of(&LhbQuery { ray, offset, ..*query }, self.views, self.size)?;
        let n = i64::from(self.size);
        match self.fault {
            Fault::QueryWraps => {
                let at = Looking::of(&LhbQuery { ray, offset: [0; 2], ..*query }, self.views, self.size)?;
                let moved = |i: usize| at.pixel[i] as i64 + i64::from(query.offset[i] / pixel);
                let outside = |i: usize| !(0..n).contains(&moved(i));
                for i in [0, 1].into_iter().filter(|&i| outside(i)) {
                    looking.pixel[i] = moved(i).rem_euclid(n) as usize;
                }
            }
            Fault::QueryTransposed => looking.pixel.reverse(),
            Fault::QueryDepthOfPixel => looking.depth -= 1 << 29,
            _ => {}
        }
        Some(looking)
    }

    fn is_hit(&self, query: &LhbQuery, looking: &Looking, e: LhbElement) -> bool {
        let (ahead, window) = (looking.ahead(e), i128::from(query.window));
        let (far, near) = match self.fault {
            Fault::QueryWindowInclusive => (ahead >= window, ahead >= -window),
            Fault::QueryWindowAheadOnly => (ahead > window, ahead >= 0),
            Fault::QueryWindowBehind => (ahead > window, true),
            _ => (ahead > window, ahead >= -window),
        };
        let entered = match self.fault {
            Fault::QueryNoWindow => false,
            Fault::QueryDepthsOnly => ahead > 0,
            _ => self.is_entered(query, looking, e),
        };
        far || (near && entered)
    }

    fn is_entered(&self, query: &LhbQuery, looking: &Looking, e: LhbElement) -> bool {
        let front = looking.sees_front(e);
        let side = self.planes[e.triangle() as usize].side(query.position.map(i128::from));
        let before = if front { side } else { -side };
        let clearance = i128::from(CLEARANCE);
        let clear = match self.fault {
            Fault::QueryNoClearance => before > 0,
            Fault::QueryClearanceInclusive => before >= clearance,
            Fault::QueryClearanceOneSided if !front => before > 0,
            _ => before > clearance,
        };
        let own_side = match self.fault {
            Fault::QueryAnySide => true,
            Fault::QuerySideInverted => front != (query.leaves % 2 == 1),
            _ => front == (query.leaves % 2 == 1),
        };
        let other = self.is(Fault::QueryOwnTriangle) || e.triangle() != query.leaves / 2;
        clear && own_side && other
    }
}
