//! Scenes with their buffers, and films walked through them.

use crate::trial::Failure;
use twinlight_core::Backend;
use twinlight_core::directions::DirectionSet;
use twinlight_core::kernels::trace_paths::{FilmTexel, TracePathsParams};
use twinlight_core::kernels::walk_lhb::WalkLhbParams;
use twinlight_core::scene::CompiledScene;
use twinlight_methods::slhb::{Buffers, LookupSettings, build};

/// A scene on a backend, ready to be walked.
pub(crate) struct Prepared<B: Backend> {
    pub(super) resident: B::Scene,
    pub(super) buffers: Buffers<B>,
}

impl<B: Backend> Prepared<B> {
    /// Buffers of views of `size` pixels along a set of directions, with the cone approximation.
    pub(crate) fn new(
        backend: &B,
        compiled: &CompiledScene,
        directions: &str,
        size: u32,
    ) -> Result<Self, Failure> {
        let directions: DirectionSet = directions.parse()?;
        let settings = LookupSettings { directions, size, trace_misses: false, ..LookupSettings::default() };
        Self::with(backend, compiled, &settings)
    }

    pub(super) fn with(
        backend: &B,
        compiled: &CompiledScene,
        settings: &LookupSettings,
    ) -> Result<Self, Failure> {
        let buffers = build(backend, compiled, settings)?;
        Ok(Self { resident: backend.upload_scene(compiled)?, buffers })
    }

    /// With flags beside those that it has.
    pub(crate) fn flagged(mut self, flags: u32) -> Self {
        self.buffers.lookup.flags |= flags;
        self
    }

    /// With patterns of that many pixels per row and column.
    pub(crate) fn interleaved(mut self, interleave: u32) -> Self {
        self.buffers.lookup.interleave = interleave;
        self
    }

    /// Adds to a film.
    pub(super) fn walk(
        &self,
        backend: &B,
        call: &TracePathsParams,
        film: &mut B::Buffer<FilmTexel>,
    ) -> twinlight_core::Result<()> {
        self.walk_as(backend, &WalkLhbParams { call: *call, lookup: self.buffers.lookup }, film)
    }

    /// Adds to a film, with lookups as they are given.
    pub(super) fn walk_as(
        &self,
        backend: &B,
        params: &WalkLhbParams,
        film: &mut B::Buffer<FilmTexel>,
    ) -> twinlight_core::Result<()> {
        let Buffers { mesh, lhb, views, map, .. } = &self.buffers;
        backend.walk_lhb(&self.resident, mesh, lhb, views, map, params, film)
    }
}

/// A fresh film with the samples of `params`.
pub(crate) fn walked<B: Backend>(
    backend: &B,
    prepared: &Prepared<B>,
    params: &TracePathsParams,
) -> Result<Vec<FilmTexel>, Failure> {
    let mut film = backend.zeroed::<FilmTexel>((params.width * params.height) as usize)?;
    prepared.walk(backend, params, &mut film)?;
    Ok(backend.download(&film)?)
}
