//! Draw lists: which instances a pass draws, in batches.
//!
//! Opaque and masked objects are one call per material, mesh and orientation, in that order; what they look like
//! depends on no order. Blended objects go back to front, by the distance of the middle of their bounds from the view, ties by slot;
//! neighbours that agree in everything still share a call. A list holds what its view sees ([`super::visible`]).
//!
//! Kept from frame to frame: a list is made again if what stands in it may be other objects than before, or stand in another order.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::DVec3;
use luminaire_graph::published::{DrawBatch, DrawFilter, DrawList, Table, ViewKind};

use super::casters::Cube;
use super::geometry::MeshRange;
use super::objects::{Changed, Coverage, Object, Objects};
use super::projection::CameraView;
use super::visible::Visible;

/// How far an object is from a view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Distance {
    /// From this point.
    From(DVec3),
    /// Along this direction.
    Along(DVec3),
}

impl Distance {
    /// As the camera sorts: by distance in perspective, by depth otherwise.
    pub(super) fn from_camera(camera: &CameraView) -> Distance {
        if camera.far().is_some() { Distance::Along(camera.forward()) } else { Distance::From(camera.pose.position) }
    }

    fn of(self, object: &Object) -> f64 {
        match self {
            Distance::From(point) => object.center().distance_squared(point),
            Distance::Along(direction) => object.center().dot(direction),
        }
    }
}

/// A list, wherever its slots will stand.
#[derive(Debug, Default)]
struct Kept {
    /// First instances count from the list's own first slot.
    batches: Vec<DrawBatch>,
    slots: Vec<u32>,
    /// By what its blended objects are sorted.
    distance: Option<Distance>,
    /// As last published: where its slots begin, and the batches with that.
    placed: Option<(u32, Arc<Vec<DrawBatch>>)>,
}

/// Lists by what they hold.
type Name = (DrawFilter, ViewKind);

/// All lists that were asked for last, and the table `instance_slots` that they index.
#[derive(Debug, Default)]
pub(super) struct Draws {
    kept: BTreeMap<Name, Kept>,
    slots: Table,
}

/// What lists are made from.
pub(super) struct DrawInput<'a> {
    pub(super) objects: &'a Objects,
    pub(super) changed: &'a Changed,
    pub(super) ranges: &'a [MeshRange],
    pub(super) visible: &'a Visible,
    /// Views that see other objects than before.
    pub(super) views: &'a BTreeSet<ViewKind>,
}

impl Draws {
    /// The lists asked for, in that order.
    pub(super) fn update(&mut self, wanted: &[Name], input: &DrawInput<'_>, distance: impl Fn(ViewKind) -> Distance) -> Vec<DrawList> {
        let names: BTreeSet<Name> = wanted.iter().copied().collect();
        let before = self.kept.len();
        self.kept.retain(|name, _| names.contains(name));
        let mut stand_elsewhere = self.kept.len() != before || self.slots.is_empty();
        for name in &names {
            let kept = self.kept.entry(*name).or_default();
            let sorts = matches!(name.0, DrawFilter::Blended | DrawFilter::All);
            let by = Some(distance(name.1)).filter(|_| sorts);
            let stale = input.changed.keys || input.views.contains(&name.1) || (sorts && (input.changed.blended || kept.distance != by));
            if kept.placed.is_none() || stale {
                kept.make(*name, input, by);
                stand_elsewhere = true;
            }
        }
        if stand_elsewhere {
            self.place();
        }
        let list = |(filter, view): &Name| {
            let placed = self.kept.get(&(*filter, *view)).and_then(|kept| kept.placed.as_ref());
            DrawList { filter: *filter, view: *view, batches: placed.map(|(_, batches)| Arc::clone(batches)).unwrap_or_default() }
        };
        wanted.iter().map(list).collect()
    }

    /// Puts the slots of all lists behind each other.
    fn place(&mut self) {
        let mut first = 0;
        let mut slots: Vec<u8> = Vec::new();
        for kept in self.kept.values_mut() {
            kept.place(first);
            first += kept.slots.len() as u32;
            slots.extend_from_slice(bytemuck::cast_slice(&kept.slots));
        }
        if slots.is_empty() {
            slots.extend([0; size_of::<u32>()]);
        }
        if self.slots.is_empty() {
            self.slots = Table::new(size_of::<u32>(), &slots);
        } else {
            self.slots.set(&slots);
        }
    }

    /// The table `instance_slots`; it is never empty.
    pub(super) fn table(&self) -> &Table {
        &self.slots
    }
}

impl Kept {
    fn make(&mut self, (filter, view): Name, input: &DrawInput<'_>, by: Option<Distance>) {
        let stands = |object: &&Object| match filter {
            DrawFilter::Opaque => object.coverage == Coverage::Opaque,
            DrawFilter::Masked => object.coverage == Coverage::Masked,
            DrawFilter::Solid => object.coverage != Coverage::Blended,
            DrawFilter::Blended => object.coverage == Coverage::Blended,
            DrawFilter::All => true,
        };
        let seen = |object: &&Object| input.visible.sees(view, object.slot);
        let (mut blended, solid): (Vec<&Object>, Vec<&Object>) =
            input.objects.in_order().filter(stands).filter(seen).partition(|object| object.coverage == Coverage::Blended);
        if let Some(by) = by {
            blended.sort_by(|a, b| by.of(b).total_cmp(&by.of(a)).then(a.slot.cmp(&b.slot)));
        }
        let (mut batches, mut slots): (Vec<DrawBatch>, Vec<u32>) = (Vec::new(), Vec::new());
        let mut last: Option<&Object> = None;
        for object in solid.into_iter().chain(blended) {
            let Some(range) = input.ranges.get(object.mesh) else { continue };
            match batches.last_mut() {
                Some(batch) if last.is_some_and(|last| share(last, object)) => batch.instance_count += 1,
                _ => batches.push(DrawBatch {
                    material: object.material,
                    first_index: range.first_index,
                    index_count: range.index_count,
                    base_vertex: range.base_vertex,
                    first_instance: slots.len() as u32,
                    instance_count: 1,
                    // The frames of cube faces are left-handed, so the winding turns once more.
                    mirrored: object.mirrored != Cube::of(view).is_some(),
                    double_sided: object.double_sided,
                }),
            }
            last = Some(object);
            slots.push(object.slot);
        }
        if self.placed.is_none() || self.batches != batches {
            (self.batches, self.placed) = (batches, None);
        }
        (self.slots, self.distance) = (slots, by);
    }

    /// Batches for slots that begin here.
    fn place(&mut self, first: u32) {
        if self.placed.as_ref().is_none_or(|(known, _)| *known != first) {
            let moved = |batch: &DrawBatch| DrawBatch { first_instance: batch.first_instance + first, ..*batch };
            self.placed = Some((first, Arc::new(self.batches.iter().map(moved).collect())));
        }
    }
}

/// Whether objects are drawn by one call. A material fixes coverage and sidedness.
fn share(a: &Object, b: &Object) -> bool {
    (a.material, a.mesh, a.mirrored) == (b.material, b.mesh, b.mirrored)
}
