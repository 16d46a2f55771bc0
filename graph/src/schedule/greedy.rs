//! Choosing ready passes by what they add to memory.
//!
//! A pass that is ready has two costs: the bytes of new textures, where no free one of the right descriptor is left over, and
//! the bytes by which those in use grow. Weights say how much each counts. A score changes when a resource comes into use, has
//! one user left, or free textures come and go. A texture that comes is offered to a few passes, since one of them will take it;
//! for the others it is found out when their turn comes. So the work stays nearly linear in uses. Accepted: buffers are taken to
//! share freely with each other, and a pass that was not offered a texture may come later than its cost would have it.

use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

use crate::allocate::model::{Model, Pool};
use crate::expand::types::PassId;

/// To how many waiting passes a free texture is offered.
const OFFERS: usize = 8;

/// How ready passes are compared.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Weights {
    /// Of bytes that no free texture can serve.
    pub(crate) fresh: i64,
    /// Of the growth of bytes in use.
    pub(crate) growth: i64,
    /// From the end of the frame to its start.
    pub(crate) backwards: bool,
}

/// Which live passes touch each resource: the same for all weights.
pub(crate) struct Users {
    ends: Vec<u32>,
    passes: Vec<u32>,
    /// One more than the largest pass.
    pass_count: usize,
}

impl Users {
    pub(crate) fn new(model: &Model, live: impl Iterator<Item = PassId> + Clone) -> Users {
        let mut ends = vec![0u32; model.touches.resource_count() + 1];
        let mut pass_count = 0;
        for pass in live.clone() {
            pass_count = pass_count.max(pass.index() + 1);
            for resource in model.touches.of(pass) {
                ends[*resource as usize + 1] += 1;
            }
        }
        for index in 1..ends.len() {
            ends[index] += ends[index - 1];
        }
        let mut passes = vec![0u32; ends.last().copied().unwrap_or(0) as usize];
        for pass in live {
            for resource in model.touches.of(pass) {
                let place = &mut ends[*resource as usize];
                passes[*place as usize] = pass.0;
                *place += 1;
            }
        }
        Users { ends, passes, pass_count }
    }

    fn of(&self, resource: usize) -> &[u32] {
        let start = resource.checked_sub(1).map_or(0, |before| self.ends[before] as usize);
        &self.passes[start..self.ends[resource] as usize]
    }
}

/// The ready passes, and what is in use.
pub(crate) struct Greedy<'a> {
    model: &'a Model,
    users: &'a Users,
    weights: Weights,
    left: Vec<u32>,
    in_use: Vec<bool>,
    /// By descriptor: textures that exist and are in no use.
    free: Vec<u32>,
    /// By descriptor: ready passes that would bring one into use.
    waiting: Vec<BTreeSet<u32>>,
    /// By pass: the score of a ready pass.
    scores: Vec<Option<i64>>,
    queue: BinaryHeap<Reverse<(i64, i64, u32)>>,
}

impl<'a> Greedy<'a> {
    pub(crate) fn new(model: &'a Model, users: &'a Users, weights: Weights) -> Greedy<'a> {
        let resources = model.touches.resource_count();
        Greedy {
            model,
            users,
            weights,
            left: (0..resources).map(|resource| users.of(resource).len() as u32).collect(),
            in_use: vec![false; resources],
            free: vec![0; model.descriptors.len()],
            waiting: vec![BTreeSet::new(); if weights.fresh == 0 { 0 } else { model.descriptors.len() }],
            scores: vec![None; users.pass_count],
            queue: BinaryHeap::new(),
        }
    }

    fn bytes(&self, resource: usize) -> i64 {
        // Room for the sum of a pass times a weight; sizes beyond are refused later.
        self.model.charged[resource].min(1 << 48) as i64
    }

    fn score(&self, pass: PassId) -> i64 {
        let (mut fresh, mut growth) = (0i64, 0i64);
        for resource in self.model.touches.of(pass).iter().map(|resource| *resource as usize) {
            if !self.model.is_transient(resource) {
                continue;
            }
            let bytes = self.bytes(resource);
            if !self.in_use[resource] {
                growth = growth.saturating_add(bytes);
                if let Pool::Texture(descriptor) = self.model.pools[resource]
                    && self.free[descriptor as usize] == 0
                {
                    fresh = fresh.saturating_add(bytes);
                }
            }
            if self.left[resource] == 1 {
                growth = growth.saturating_sub(bytes);
            }
        }
        fresh.saturating_mul(self.weights.fresh).saturating_add(growth.saturating_mul(self.weights.growth))
    }

    /// Takes in a pass that has become ready.
    pub(crate) fn ready(&mut self, pass: PassId) {
        self.update(pass);
        for resource in self.model.touches.of(pass) {
            if let Some(waiting) = self.waits_for(*resource as usize) {
                waiting.insert(pass.0);
            }
        }
    }

    /// Where passes wait for a texture that this resource would use.
    fn waits_for(&mut self, resource: usize) -> Option<&mut BTreeSet<u32>> {
        match self.model.pools[resource] {
            Pool::Texture(descriptor) if self.model.is_transient(resource) && !self.in_use[resource] => {
                self.waiting.get_mut(descriptor as usize)
            }
            _ => None,
        }
    }

    fn update(&mut self, pass: PassId) {
        let score = self.score(pass);
        if self.scores[pass.index()] != Some(score) {
            self.scores[pass.index()] = Some(score);
            let place = i64::from(pass.0);
            self.queue.push(Reverse((score, if self.weights.backwards { -place } else { place }, pass.0)));
        }
    }

    fn update_ready(&mut self, passes: &[u32]) {
        for pass in passes {
            if self.scores[*pass as usize].is_some() {
                self.update(PassId(*pass));
            }
        }
    }

    /// A texture is in no use any more.
    fn offer(&mut self, resource: usize) {
        let Pool::Texture(descriptor) = self.model.pools[resource] else { return };
        self.free[descriptor as usize] += 1;
        if let Some(waiting) = self.waiting.get(descriptor as usize).filter(|_| self.free[descriptor as usize] == 1) {
            let offered: Vec<u32> = match self.weights.backwards {
                false => waiting.iter().take(OFFERS).copied().collect(),
                true => waiting.iter().rev().take(OFFERS).copied().collect(),
            };
            self.update_ready(&offered);
        }
    }

    /// Takes out the pass to run next.
    pub(crate) fn next(&mut self) -> Option<PassId> {
        let pass = loop {
            let Reverse((score, _, pass)) = self.queue.pop()?;
            if self.scores[pass as usize] == Some(score) {
                let pass = PassId(pass);
                if self.score(pass) <= score {
                    break pass;
                }
                // Another pass took the texture that it counted on.
                self.update(pass);
            }
        };
        self.scores[pass.index()] = None;
        let (model, users) = (self.model, self.users);
        let touched = model.touches.of(pass).iter().map(|resource| *resource as usize);
        for resource in touched.clone() {
            if let Some(waiting) = self.waits_for(resource) {
                waiting.remove(&pass.0);
            }
            let began = !std::mem::replace(&mut self.in_use[resource], true);
            if began
                && model.is_transient(resource)
                && let Pool::Texture(descriptor) = model.pools[resource]
            {
                let free = &mut self.free[descriptor as usize];
                *free = free.saturating_sub(1);
            }
            self.left[resource] -= 1;
            if began || self.left[resource] == 1 {
                self.update_ready(users.of(resource));
            }
        }
        for resource in touched {
            if self.left[resource] == 0 && model.is_transient(resource) {
                self.offer(resource);
            }
        }
        Some(pass)
    }
}
