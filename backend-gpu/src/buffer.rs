//! Typed device buffers.

use crate::device::GpuDevice;
use bytemuck::Pod;
use std::marker::PhantomData;
use std::ops::Range;
use std::sync::mpsc;
use twinlight_core::{Error, Result};

/// Bindings must not be empty, and 16 bytes keep every element type of ours aligned.
const GRANULE: u64 = 16;

/// Runs of elements are bound from multiples of this on: elements are whole words, so that is a multiple of the 256
/// bytes that WebGPU lets adapters ask of an offset.
pub(crate) const CHUNK_GRAIN: usize = 64;

/// `len` elements of `T` on one device.
#[derive(Debug)]
pub struct GpuBuffer<T> {
    pub(crate) raw: wgpu::Buffer,
    /// Serial number of the device that owns it.
    pub(crate) owner: u64,
    len: usize,
    element: PhantomData<T>,
}

/// A buffer, or a run of its elements, without its element type: a kernel's binding.
#[derive(Debug, Clone, Copy)]
pub struct BufferRef<'a> {
    pub(crate) raw: &'a wgpu::Buffer,
    pub(crate) owner: u64,
    /// First byte.
    pub(crate) offset: u64,
    pub(crate) bytes: u64,
}

impl<T: Pod> GpuBuffer<T> {
    /// Number of elements.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// For [`crate::dispatch::Recorder::dispatch`].
    pub fn binding(&self) -> BufferRef<'_> {
        BufferRef { raw: &self.raw, owner: self.owner, offset: 0, bytes: self.raw.size() }
    }

    /// `elements` alone, which the kernel sees from index 0 on. They begin at a multiple of [`CHUNK_GRAIN`].
    pub(crate) fn binding_of(&self, elements: Range<usize>) -> BufferRef<'_> {
        debug_assert!(elements.start.is_multiple_of(CHUNK_GRAIN) && elements.end <= self.len);
        let size = size_of::<T>() as u64;
        let offset = elements.start as u64 * size;
        let bytes = (elements.len() as u64 * size).next_multiple_of(GRANULE);
        BufferRef { raw: &self.raw, owner: self.owner, offset, bytes }
    }
}

impl GpuDevice {
    /// How many elements of `size` bytes one binding holds, in whole grains.
    pub(crate) fn elements_per_binding(&self, size: usize) -> usize {
        let most = self.report().limits.storage_binding_bytes / size.max(1) as u64;
        usize::try_from(most).unwrap_or(usize::MAX) / CHUNK_GRAIN * CHUNK_GRAIN
    }

    /// Whether one binding holds `len` elements of `T`: for kernels that need all of them at once, before anything of
    /// that size is allocated.
    pub(crate) fn expect_bindable<T: Pod>(&self, what: &str, len: usize) -> Result<()> {
        let limit = self.report().limits.storage_binding_bytes;
        let bytes = (len as u64 * size_of::<T>() as u64).next_multiple_of(GRANULE);
        if bytes > limit {
            let what = format!("bytes of {what} in one binding on {}", self.report().name);
            return Err(Error::limit(what, bytes, limit));
        }
        Ok(())
    }
}

/// `0..len` in runs of at most `most` elements, which is a multiple of [`CHUNK_GRAIN`]. Where a binding holds not even a
/// grain, that is one run: binding it tells the caller about the limit.
pub(crate) fn chunks(len: usize, most: usize) -> impl Iterator<Item = Range<usize>> {
    let step = if most == 0 { len.max(1) } else { most };
    (0..len).step_by(step).map(move |begin| begin..len.min(begin + step))
}

impl GpuDevice {
    /// A zeroed buffer of `len` elements.
    ///
    /// # Errors
    /// [`Error::LimitExceeded`] before anything is allocated, [`Error::OutOfMemory`] when the driver refuses.
    pub fn zeroed<T: Pod>(&self, len: usize) -> Result<GpuBuffer<T>> {
        let limit = self.report().limits.buffer_bytes;
        let bytes =
            (len as u64).saturating_mul(size_of::<T>() as u64).max(1).checked_next_multiple_of(GRANULE);
        let bytes = bytes.unwrap_or(u64::MAX);
        if bytes > limit {
            return Err(Error::limit(format!("bytes of one buffer on {}", self.report().name), bytes, limit));
        }
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        let raw = self.scoped(bytes, |device| {
            let label = Some(std::any::type_name::<T>());
            device.create_buffer(&wgpu::BufferDescriptor {
                label,
                size: bytes,
                usage,
                mapped_at_creation: false,
            })
        })?;
        Ok(GpuBuffer { raw, owner: self.shared.serial, len, element: PhantomData })
    }

    /// A buffer with a copy of `data`.
    ///
    /// # Errors
    /// As [`GpuDevice::zeroed`].
    pub fn upload<T: Pod>(&self, data: &[T]) -> Result<GpuBuffer<T>> {
        let buffer = self.zeroed(data.len())?;
        self.write(&buffer, data)?;
        Ok(buffer)
    }

    /// Overwrites a buffer of the same length.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] when the lengths differ, else as [`GpuDevice::zeroed`].
    pub fn write<T: Pod>(&self, buffer: &GpuBuffer<T>, data: &[T]) -> Result<()> {
        self.expect_own(buffer.binding())?;
        if data.len() != buffer.len {
            let what = format!("{} elements for a buffer of {}", data.len(), buffer.len);
            return Err(Error::invalid("write", what));
        }
        let mut bytes: &[u8] = bytemuck::cast_slice(data);
        // Copies come in words of 4 bytes: the last, incomplete one is sent padded.
        let tail = bytes.len() % 4;
        let mut word = [0u8; 4];
        word[..tail].copy_from_slice(&bytes[bytes.len() - tail..]);
        bytes = &bytes[..bytes.len() - tail];
        self.scoped(bytes.len() as u64, |_| {
            self.shared.queue.write_buffer(&buffer.raw, 0, bytes);
            if tail > 0 {
                self.shared.queue.write_buffer(&buffer.raw, bytes.len() as u64, &word);
            }
        })
    }

    /// A buffer with a copy of another's elements, after everything that was recorded before.
    ///
    /// # Errors
    /// As [`GpuDevice::zeroed`].
    pub(crate) fn copied<T: Pod>(&self, buffer: &GpuBuffer<T>) -> Result<GpuBuffer<T>> {
        self.expect_own(buffer.binding())?;
        let copy = self.zeroed(buffer.len)?;
        let commands = self.scoped(0, |device| {
            let mut encoder =
                device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("copy") });
            encoder.copy_buffer_to_buffer(&buffer.raw, 0, &copy.raw, 0, copy.raw.size());
            encoder.finish()
        })?;
        self.finish(commands)?;
        Ok(copy)
    }

    /// Copies a buffer back, after everything that was recorded before.
    ///
    /// # Errors
    /// [`Error::DeviceLost`] when the device doesn't answer, [`Error::OutOfMemory`] when there is no room for the copy.
    pub fn download<T: Pod>(&self, buffer: &GpuBuffer<T>) -> Result<Vec<T>> {
        self.download_range(buffer, 0, buffer.len)
    }

    /// Copies `len` elements from element `begin` on back.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] when the range leaves the buffer, else as [`GpuDevice::download`].
    pub fn download_range<T: Pod>(&self, buffer: &GpuBuffer<T>, begin: usize, len: usize) -> Result<Vec<T>> {
        self.expect_own(buffer.binding())?;
        if begin.checked_add(len).is_none_or(|end| end > buffer.len) {
            let what = format!("{len} elements from {begin} on, of a buffer of {}", buffer.len);
            return Err(Error::invalid("download", what));
        }
        let size = size_of::<T>();
        let (from, to) = ((begin * size) as u64, ((begin + len) * size) as u64);
        let first = from / 4 * 4;
        let bytes = (to - first).next_multiple_of(4);
        if len == 0 || size == 0 {
            return Ok(Vec::new());
        }
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let label = Some("copy for the host");
        let staging = self.scoped(bytes, |device| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label,
                size: bytes,
                usage,
                mapped_at_creation: false,
            })
        })?;
        let (send, receive) = mpsc::channel();
        let commands = self.scoped(bytes, |device| {
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label });
            encoder.copy_buffer_to_buffer(&buffer.raw, first, &staging, 0, bytes);
            encoder.map_buffer_on_submit(&staging, wgpu::MapMode::Read, 0..bytes, move |mapped| {
                // The receiver is gone only when the wait timed out.
                let _ = send.send(mapped);
            });
            encoder.finish()
        })?;
        self.finish(commands)?;
        // Another thread's poll may have taken the callback and not have run it yet.
        match receive.recv_timeout(self.timeout()) {
            Ok(Ok(())) => {}
            refused => {
                self.check()?;
                return Err(Error::Internal(format!("a finished copy can't be mapped: {refused:?}")));
            }
        }
        let view = staging
            .get_mapped_range(..)
            .map_err(|error| Error::Internal(format!("a mapped copy can't be read: {error}")))?;
        let skip = (from - first) as usize;
        Ok(bytemuck::pod_collect_to_vec(&view[skip..skip + len * size]))
    }

    pub(crate) fn expect_own(&self, buffer: BufferRef<'_>) -> Result<()> {
        if buffer.owner == self.shared.serial {
            Ok(())
        } else {
            Err(Error::invalid("buffer", "it belongs to another device"))
        }
    }
}
