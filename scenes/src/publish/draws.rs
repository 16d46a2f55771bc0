//! Draw lists: which instances a pass draws, in batches.
//!
//! Opaque and masked objects are one call per material, mesh and orientation, in that order; what they look like
//! depends on no order. Blended objects go back to front, by the distance of the middle of their bounds from the view, ties by slot;
//! neighbours that agree in everything still share a call. Nothing is culled: every list of a filter holds the same objects.

use std::collections::BTreeMap;

use glam::DVec3;
use luminaire_graph::published::{DrawBatch, DrawFilter, ViewKind};

use super::geometry::MeshRange;
use super::objects::{Coverage, Object};
use super::projection::CameraView;

/// A list as it is published.
pub(super) type DrawList = (DrawFilter, ViewKind, Vec<DrawBatch>);

/// How far an object is from a view.
#[derive(Debug, Clone, Copy)]
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
            Distance::From(point) => object.center.distance_squared(point),
            Distance::Along(direction) => object.center.dot(direction),
        }
    }
}

/// The lists asked for, and the table `instance_slots` that they index; it is never empty.
pub(super) fn build(
    objects: &[Object],
    ranges: &[MeshRange],
    wanted: &[(DrawFilter, ViewKind)],
    distance: impl Fn(ViewKind) -> Distance,
) -> (Vec<DrawList>, Vec<u32>) {
    let mut slots = Vec::new();
    // Sorted by nothing but material and mesh, a list is the same from everywhere.
    let mut shared: BTreeMap<DrawFilter, Vec<DrawBatch>> = BTreeMap::new();
    let lists = wanted
        .iter()
        .map(|&(filter, view)| {
            let mut batches = if matches!(filter, DrawFilter::Blended | DrawFilter::All) {
                list(objects, ranges, filter, distance(view), &mut slots)
            } else {
                shared.entry(filter).or_insert_with(|| list(objects, ranges, filter, distance(view), &mut slots)).clone()
            };
            // The frames of cube faces are left-handed, so the winding turns once more.
            if matches!(view, ViewKind::LocalLight(..)) {
                for batch in &mut batches {
                    batch.mirrored = !batch.mirrored;
                }
            }
            (filter, view, batches)
        })
        .collect();
    if slots.is_empty() {
        slots.push(0);
    }
    (lists, slots)
}

fn list(objects: &[Object], ranges: &[MeshRange], filter: DrawFilter, distance: Distance, slots: &mut Vec<u32>) -> Vec<DrawBatch> {
    let stands = |object: &&Object| match filter {
        DrawFilter::Opaque => object.coverage == Coverage::Opaque,
        DrawFilter::Masked => object.coverage == Coverage::Masked,
        DrawFilter::Solid => object.coverage != Coverage::Blended,
        DrawFilter::Blended => object.coverage == Coverage::Blended,
        DrawFilter::All => true,
    };
    let (mut blended, mut solid): (Vec<&Object>, Vec<&Object>) =
        objects.iter().filter(stands).partition(|object| object.coverage == Coverage::Blended);
    solid.sort_by_key(|object| (object.coverage, key(object), object.slot));
    blended.sort_by(|a, b| distance.of(b).total_cmp(&distance.of(a)).then(a.slot.cmp(&b.slot)));
    let mut batches: Vec<DrawBatch> = Vec::new();
    let mut last_key = None;
    for object in solid.into_iter().chain(blended) {
        let Some(range) = ranges.get(object.mesh) else { continue };
        match batches.last_mut() {
            Some(batch) if last_key == Some(key(object)) => batch.instance_count += 1,
            _ => batches.push(DrawBatch {
                material: object.material,
                first_index: range.first_index,
                index_count: range.index_count,
                base_vertex: range.base_vertex,
                first_instance: slots.len() as u32,
                instance_count: 1,
                mirrored: object.mirrored,
                double_sided: object.double_sided,
            }),
        }
        last_key = Some(key(object));
        slots.push(object.slot);
    }
    batches
}

/// What the objects of a batch agree in. A material fixes coverage and sidedness.
fn key(object: &Object) -> (usize, usize, bool) {
    (object.material, object.mesh, object.mirrored)
}
