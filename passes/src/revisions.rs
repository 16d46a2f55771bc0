//! Revisions of what a scene publishes: equal bytes are the same revision.
//!
//! What a draw list shows is its batches with the rows that they show; where those stand in their tables is no matter. Accepted: a
//! change of any geometry or texture counts for every list.

use std::collections::HashMap;

use luminaire_graph::plan::{Input, Plan};
use luminaire_graph::published::{DrawBatch, PublishedScene, PublishedSchema};

use crate::scene_check::draw_list;

/// The content and revision of every input met so far.
#[derive(Debug, Clone, Default)]
pub(crate) struct Revisions {
    known: HashMap<Input, (Vec<u8>, u64)>,
    /// Geometry, textures, samplers and materials: one revision for all.
    shared: u64,
    next: u64,
}

impl Revisions {
    /// Takes a scene over; returns the revisions of a plan's inputs, in order. `before` is the scene that stood.
    pub(crate) fn update(&mut self, plan: &Plan, schema: &PublishedSchema, before: &PublishedScene, scene: &PublishedScene) -> Vec<u64> {
        if !same_shared(before, scene) {
            self.shared += 1;
        }
        let contents: Vec<Vec<u8>> = plan.inputs.iter().map(|input| self.content(plan, schema, scene, input)).collect();
        let mut found = Vec::with_capacity(contents.len());
        for (input, content) in plan.inputs.iter().zip(contents) {
            let revision = match self.known.get(input).filter(|(known, _)| *known == content) {
                Some((_, revision)) => *revision,
                None => {
                    self.next += 1;
                    self.known.insert(input.clone(), (content, self.next));
                    self.next
                }
            };
            found.push(revision);
        }
        found
    }

    fn content(&self, plan: &Plan, schema: &PublishedSchema, scene: &PublishedScene, input: &Input) -> Vec<u8> {
        match input {
            Input::Table(name) => scene.tables.get(name).cloned().unwrap_or_default(),
            Input::Row(name, row) => row_of(schema, scene, name, *row).to_vec(),
            Input::View(view) => {
                let place = plan.views.iter().position(|known| known == view);
                place.and_then(|place| scene.views.get(place)).cloned().unwrap_or_default()
            }
            Input::Draws(filter, view) => {
                let mut content = self.shared.to_le_bytes().to_vec();
                for batch in draw_list(scene, *filter, *view).unwrap_or_default() {
                    batch_content(schema, scene, batch, &mut content);
                }
                content
            }
            Input::Param(_) => Vec::new(),
        }
    }
}

fn row_of<'a>(schema: &PublishedSchema, scene: &'a PublishedScene, table: &str, row: u32) -> &'a [u8] {
    let stride = schema.tables.get(table).map_or(0, |table| table.stride as usize);
    let start = stride.saturating_mul(row as usize);
    scene.tables.get(table).and_then(|bytes| bytes.get(start..start.saturating_add(stride))).unwrap_or_default()
}

/// A batch without the place of its slots, and the rows that it shows.
fn batch_content(schema: &PublishedSchema, scene: &PublishedScene, batch: &DrawBatch, content: &mut Vec<u8>) {
    let DrawBatch { material, first_index, index_count, base_vertex, first_instance, instance_count, mirrored, double_sided } = *batch;
    content.extend((material as u64).to_le_bytes());
    content.extend(
        [first_index, index_count, base_vertex as u32, instance_count, u32::from(mirrored), u32::from(double_sided)]
            .map(u32::to_le_bytes)
            .concat(),
    );
    content.extend(row_of(schema, scene, "materials", material as u32));
    for instance in first_instance..first_instance.saturating_add(instance_count) {
        let slot = row_of(schema, scene, "instance_slots", instance);
        content.extend(slot);
        if let Ok(slot) = slot.try_into() {
            content.extend(row_of(schema, scene, "instances", u32::from_le_bytes(slot)));
        }
    }
}

fn same_shared(a: &PublishedScene, b: &PublishedScene) -> bool {
    let textures = || {
        a.textures.len() == b.textures.len()
            && a.textures
                .iter()
                .zip(&b.textures)
                .all(|(a, b)| (a.srgb, a.width, a.height) == (b.srgb, b.width, b.height) && a.mips == b.mips)
    };
    a.vertices == b.vertices && a.indices == b.indices && a.materials == b.materials && a.samplers == b.samplers && textures()
}
