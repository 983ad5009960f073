// kernel family: query_lhb
// contract core/src/kernels/query_lhb.rs
// cpu backend-cpu/src/kernels/query_lhb.rs
// gpu backend-gpu/src/kernels/query_lhb.wgsl
// oracle conformance/src/oracle/query_lhb.rs
//! Cases and laws of `query_lhb`. Lists come from the oracle of `rasterize_lhb` or are made up, so that a wrong answer is the
//! query's own; answers are compared exactly.

mod cases;
mod hard;
mod inputs;
mod laws;
mod limits;
mod rooms;
mod solids;

use crate::compare::{Shape, exact};
use crate::oracle::query_lhb::query;
use crate::oracle::rasterize_lhb::{Lists, rasterize};
use crate::trial::{Check, Context, Failure, Listing, ensure};
use twinlight_core::Backend;
use twinlight_core::kernels::query_lhb::LhbQuery;
use twinlight_core::kernels::rasterize_lhb::{Lhb, LhbBuffers, LhbElement, RasterizeLhbParams};
use twinlight_core::lattice::{LatticeMesh, View};
use twinlight_fixtures::random::Random;

/// Lists the trials.
pub fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    cases::list(list);
    limits::list(list);
    hard::list(list);
    laws::list(list);
    solids::list(list);
    rooms::list(list);
}

type Checked<T> = Result<T, Failure>;

/// What queries are asked of.
#[derive(Debug, Clone)]
struct Seen {
    mesh: LatticeMesh,
    views: Vec<View>,
    size: u32,
    lists: Lists,
}

impl Seen {
    /// All surfaces of a mesh.
    fn new(mesh: LatticeMesh, views: Vec<View>, size: u32) -> Self {
        let lists = rasterize(&mesh, &views, &RasterizeLhbParams::new(size));
        Self { mesh, views, size, lists }
    }

    /// All surfaces of a mesh, by the backend: for laws that ask for more than the oracle draws in the time.
    fn drawn<B: Backend>(
        cx: &Context<'_, B>,
        mesh: LatticeMesh,
        views: Vec<View>,
        size: u32,
    ) -> Checked<Self> {
        let resident = cx.backend.upload_mesh(&mesh)?;
        let lhb = cx.backend.rasterize_lhb(&resident, &views, &RasterizeLhbParams::new(size))?;
        let offsets = cx.backend.download(&lhb.offsets)?;
        let lists = Lists { offsets, elements: cx.backend.download(&lhb.elements)?, left_out: Vec::new() };
        Ok(Self { mesh, views, size, lists })
    }

    /// What the contract promises.
    fn expected(&self, queries: &[LhbQuery]) -> Vec<LhbElement> {
        query(&self.mesh, &self.lists, self.size, &self.views, queries)
    }

    fn uploaded<B: Backend>(&self, cx: &Context<'_, B>) -> Checked<(B::Mesh, Lhb<B>)> {
        let lhb = LhbBuffers {
            size: self.size,
            view_count: self.views.len() as u32,
            offsets: cx.backend.upload(&self.lists.offsets)?,
            elements: cx.backend.upload(&self.lists.elements)?,
            left_out: cx.backend.upload(&self.lists.left_out)?,
        };
        Ok((cx.backend.upload_mesh(&self.mesh)?, lhb))
    }

    /// The backend's answers. The buffer holds something else before.
    fn answers<B: Backend>(&self, cx: &Context<'_, B>, queries: &[LhbQuery]) -> Checked<Vec<LhbElement>> {
        let (mesh, lhb) = self.uploaded(cx)?;
        let stale = vec![LhbElement { surface: 0xdead_beef, depth: 0xdead_beef }; queries.len()];
        let mut hits = cx.backend.upload(&stale)?;
        cx.backend.query_lhb(&mesh, &lhb, &self.views, &cx.backend.upload(queries)?, &mut hits)?;
        Ok(cx.backend.download(&hits)?)
    }

    /// The backend's answers, which are the oracle's.
    fn agreed<B: Backend>(&self, cx: &Context<'_, B>, queries: &[LhbQuery]) -> Checked<Vec<LhbElement>> {
        let got = self.answers(cx, queries)?;
        let want = self.expected(queries);
        let first = got.iter().zip(&want).position(|(got, want)| got != want);
        exact(cx, "hits", &got, &want, Shape::Line).map_err(|f| {
            let (triangles, views) = (self.mesh.triangles().len(), self.views.len());
            let place = format!("{triangles} triangles, {views} views of {}²", self.size);
            f.within(&format!("{place}, first at {:?}", first.map(|i| queries[i])))
        })?;
        Ok(got)
    }

    fn agrees<B: Backend>(&self, cx: &Context<'_, B>, queries: &[LhbQuery]) -> Check {
        self.agreed(cx, queries).map(|_| ())
    }
}

/// Enough queries meet something, and enough don't: a case in which one of the two is all there is decides little.
fn both_ways(hits: &[LhbElement]) -> Check {
    let met = hits.iter().filter(|e| e.surface != u32::MAX).count();
    ensure(met * 20 > hits.len() && met < hits.len(), || {
        format!("{met} of {} queries meet something", hits.len())
    })
}

/// Queries along the rays of `views` views: from lattice points of triangles, either side, with a window of a few pixels, and from
/// free space.
pub(crate) fn scattered(mesh: &LatticeMesh, views: usize, count: usize) -> Vec<LhbQuery> {
    let mut random = Random::new(61);
    let query = |i: usize| {
        let free = inputs::from(inputs::anywhere(&mut random), random.index(2 * views) as u32);
        if i.is_multiple_of(3) || mesh.triangles().is_empty() {
            return free;
        }
        let triangle = random.index(mesh.triangles().len());
        LhbQuery {
            position: inputs::on_triangle(&mut random, mesh, triangle),
            leaves: 2 * triangle as u32 + random.index(2) as u32,
            window: random.index(4_000) as u32 * (1 << 14),
            offset: [0, 1].map(|_| random.index(2_000) as i32 - 1_000),
            ..free
        }
    };
    (0..count).map(query).collect()
}
