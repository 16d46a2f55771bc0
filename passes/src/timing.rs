//! Counts of a frame, and GPU time per pass where the device can measure it.
//!
//! Times come from timestamps at the boundaries of render and compute passes; copies and clears have none. Queries are handed
//! out frame by frame to the steps that run, so that every query that is resolved has been written.
//!
//! Accepted downside: reading times waits for the GPU, so they are measured only when asked for.

use std::sync::Arc;

use luminaire_graph::diagnostic::Diagnostic;

use crate::device::Gpu;
use crate::errors::{Subject, catch};

/// Queries of a set; wgpu takes no more.
const SET_QUERIES: u32 = 4096;

/// What a frame did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FrameCounts {
    /// Draw calls, those of Fullscreen passes included.
    pub draw_calls: u64,
    /// Triangles, those of Fullscreen passes included.
    pub triangles: u64,
    /// Compute dispatches.
    pub dispatches: u64,
    /// Steps that ran.
    pub steps: u64,
    /// Command buffers handed to the device.
    pub submissions: u64,
}

/// The GPU time of a step.
#[derive(Debug, Clone, PartialEq)]
pub struct StepTime {
    /// The step's name.
    pub name: Arc<str>,
    /// Milliseconds; clears that ran before it are not in it.
    pub milliseconds: f64,
}

/// Where a pass writes its two timestamps.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stamps<'a> {
    pub(crate) set: &'a wgpu::QuerySet,
    /// The begin; the end is the one after it.
    pub(crate) first: u32,
}

/// Query sets, and who uses which query in this frame.
#[derive(Debug)]
pub(crate) struct Timing {
    sets: Vec<wgpu::QuerySet>,
    resolved: wgpu::Buffer,
    mapped: wgpu::Buffer,
    /// Nanoseconds of a tick.
    period: f64,
    /// The steps that measure in this frame, by pair of queries.
    measured: Vec<usize>,
}

impl Timing {
    /// Room for so many steps; `None` if the device can't measure.
    pub(crate) fn new(gpu: &Gpu, steps: usize) -> Result<Option<Timing>, Diagnostic> {
        if !gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) || steps == 0 {
            return Ok(None);
        }
        let sets = (steps as u64 * 2).div_ceil(u64::from(SET_QUERIES));
        let size = sets * u64::from(SET_QUERIES) * 8;
        let buffer =
            |label, usage| gpu.device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false });
        let (timing, errors) = catch(&gpu.device, || Timing {
            sets: (0..sets)
                .map(|_| {
                    gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                        label: Some("timing"),
                        ty: wgpu::QueryType::Timestamp,
                        count: SET_QUERIES,
                    })
                })
                .collect(),
            resolved: buffer("timing", wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            mapped: buffer("timing", wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
            period: f64::from(gpu.queue.get_timestamp_period()),
            measured: Vec::new(),
        });
        Subject::nowhere("measuring GPU time").check(&errors)?;
        Ok(Some(timing))
    }

    /// Forgets the last frame.
    pub(crate) fn begin(&mut self) {
        self.measured.clear();
    }

    /// The next pair of queries, for a step; `None` if the sets are full.
    pub(crate) fn stamps(&mut self, step: usize) -> Option<Stamps<'_>> {
        let first = u32::try_from(self.measured.len()).ok()?.checked_mul(2)?;
        let set = self.sets.get((first / SET_QUERIES) as usize)?;
        self.measured.push(step);
        Some(Stamps { set, first: first % SET_QUERIES })
    }

    /// Brings this frame's queries to where they can be read.
    pub(crate) fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        let mut left = self.measured.len() as u32 * 2;
        let bytes = u64::from(left) * 8;
        for (index, set) in self.sets.iter().enumerate() {
            let here = left.min(SET_QUERIES);
            if here > 0 {
                encoder.resolve_query_set(set, 0..here, &self.resolved, index as u64 * u64::from(SET_QUERIES) * 8);
            }
            left -= here;
        }
        if bytes > 0 {
            encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.mapped, 0, bytes);
        }
    }

    /// Waits for the frame, and returns the measured steps with their milliseconds.
    pub(crate) fn read(&self, gpu: &Gpu) -> Result<Vec<(usize, f64)>, Diagnostic> {
        let bytes = self.measured.len() as u64 * 16;
        if bytes == 0 {
            return Ok(Vec::new());
        }
        let ticks = crate::readback::map(gpu, &self.mapped, bytes)?;
        let tick = |index: usize| {
            let bytes = ticks.get(index * 8..index * 8 + 8).and_then(|bytes| bytes.try_into().ok());
            bytes.map_or(0, u64::from_le_bytes)
        };
        let milliseconds = |pair: usize| tick(pair * 2 + 1).saturating_sub(tick(pair * 2)) as f64 * self.period / 1e6;
        Ok(self.measured.iter().enumerate().map(|(pair, step)| (*step, milliseconds(pair))).collect())
    }
}
