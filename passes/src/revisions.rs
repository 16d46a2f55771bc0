//! Revisions of what a scene publishes: equal bytes are the same revision.
//!
//! What a draw list shows is its batches with the rows that they show; where those stand in their tables is no matter. States of a scene
//! share what did not change, so that an update costs what did: changed rows are found once, and each list is asked whether it shows one
//! of them. Accepted: a change of any geometry or texture counts for every list, and an input that a plan in between did not have is new.

use std::collections::HashMap;
use std::sync::Arc;

use luminaire_graph::plan::{Input, Plan};
use luminaire_graph::published::{DrawBatch, PublishedGeometry, PublishedMaterials, PublishedScene, Table};

/// The content and revision of every input of the plan.
#[derive(Debug, Clone, Default)]
pub(crate) struct Revisions {
    known: HashMap<Input, (Content, u64)>,
    /// Geometry, textures, samplers and materials: one revision for all.
    shared: u64,
    next: u64,
    /// As of the last update.
    geometry: Arc<PublishedGeometry>,
    materials: Arc<PublishedMaterials>,
    rows: Rows,
}

/// What an input is.
#[derive(Debug, Clone)]
enum Content {
    Nothing,
    Table(Table),
    Bytes(Vec<u8>),
    Draws(Shown),
}

/// The tables in which draw lists find what they show.
#[derive(Debug, Clone, Default)]
struct Rows {
    instances: Table,
    slots: Table,
    materials: Table,
}

/// Rows that are others than in the update before.
struct ChangedRows {
    instances: Vec<u32>,
    materials: Vec<u32>,
    /// Whether any list may stand for other rows.
    slots: bool,
}

/// What a draw list shows.
#[derive(Debug, Clone)]
struct Shown {
    shared: u64,
    batches: Arc<Vec<DrawBatch>>,
    /// Rows of `instances`, in order.
    slots: Vec<u32>,
    /// The same as a set: a bit for each row.
    members: Vec<u64>,
}

impl Rows {
    fn of(scene: &PublishedScene) -> Rows {
        let [instances, slots, materials] =
            ["instances", "instance_slots", "materials"].map(|name| scene.tables.get(name).cloned().unwrap_or_default());
        Rows { instances, slots, materials }
    }

    fn changed(&self, before: &Rows) -> ChangedRows {
        ChangedRows {
            instances: self.instances.changed_rows(&before.instances),
            materials: self.materials.changed_rows(&before.materials),
            slots: self.slots != before.slots,
        }
    }

    /// The rows of `instances` that batches show.
    fn shown(&self, batches: &[DrawBatch]) -> Vec<u32> {
        let places = batches.iter().flat_map(|batch| batch.first_instance..batch.first_instance.saturating_add(batch.instance_count));
        places.map_while(|place| self.slots.row(place as usize)?.try_into().ok().map(u32::from_le_bytes)).collect()
    }
}

impl Revisions {
    /// Takes a scene over; returns the revisions of a plan's inputs, in order.
    pub(crate) fn update(&mut self, plan: &Plan, scene: &PublishedScene) -> Vec<u64> {
        if self.geometry != scene.geometry || self.materials != scene.materials {
            self.shared += 1;
            (self.geometry, self.materials) = (Arc::clone(&scene.geometry), Arc::clone(&scene.materials));
        }
        let rows = Rows::of(scene);
        let changed = rows.changed(&self.rows);
        let mut before = std::mem::take(&mut self.known);
        let mut found = Vec::with_capacity(plan.inputs.len());
        for input in &plan.inputs {
            let known = before.remove(input);
            let (content, revision) = match known {
                Some((content, revision)) => match self.renewed(plan, scene, &rows, &changed, input, &content) {
                    None => (content, revision),
                    Some(content) => (content, self.fresh()),
                },
                None => (self.content(plan, scene, &rows, input), self.fresh()),
            };
            found.push(revision);
            self.known.insert(input.clone(), (content, revision));
        }
        self.rows = rows;
        found
    }

    fn fresh(&mut self) -> u64 {
        self.next += 1;
        self.next
    }

    /// The content of an input if it is another than before.
    fn renewed(
        &self,
        plan: &Plan,
        scene: &PublishedScene,
        rows: &Rows,
        changed: &ChangedRows,
        input: &Input,
        before: &Content,
    ) -> Option<Content> {
        if let (Input::Draws(filter, view), Content::Draws(shown)) = (input, before) {
            let batches = scene.draw_list(*filter, *view).cloned().unwrap_or_default();
            let same = shown.shared == self.shared && !shown.shows_changed(changed);
            let untouched = Arc::ptr_eq(&shown.batches, &batches) && !changed.slots;
            if same && (untouched || same_batches(&shown.batches, &batches) && shown.slots == rows.shown(&batches)) {
                return None;
            }
            return Some(self.content(plan, scene, rows, input));
        }
        let content = self.content(plan, scene, rows, input);
        let same = match (&content, before) {
            (Content::Table(now), Content::Table(before)) => now == before,
            (Content::Bytes(now), Content::Bytes(before)) => now == before,
            (Content::Nothing, Content::Nothing) => true,
            _ => false,
        };
        (!same).then_some(content)
    }

    fn content(&self, plan: &Plan, scene: &PublishedScene, rows: &Rows, input: &Input) -> Content {
        match input {
            Input::Table(name) => Content::Table(scene.tables.get(name).cloned().unwrap_or_default()),
            Input::Row(name, row) => {
                let row = scene.tables.get(name).and_then(|table| table.row(*row as usize));
                Content::Bytes(row.unwrap_or_default().to_vec())
            }
            Input::View(view) => {
                let place = plan.views.iter().position(|known| known == view);
                Content::Bytes(place.and_then(|place| scene.views.get(place)).cloned().unwrap_or_default())
            }
            Input::Draws(filter, view) => {
                let batches = scene.draw_list(*filter, *view).cloned().unwrap_or_default();
                let slots = rows.shown(&batches);
                Content::Draws(Shown { shared: self.shared, members: members(&slots), slots, batches })
            }
            Input::Param(_) => Content::Nothing,
        }
    }
}

impl Shown {
    fn shows_changed(&self, changed: &ChangedRows) -> bool {
        let has = |slot: &u32| self.members.get(*slot as usize / 64).is_some_and(|bits| bits >> (slot % 64) & 1 == 1);
        let material = |batch: &DrawBatch| changed.materials.binary_search(&(batch.material as u32)).is_ok();
        changed.instances.iter().any(has) || (!changed.materials.is_empty() && self.batches.iter().any(material))
    }
}

fn members(slots: &[u32]) -> Vec<u64> {
    let mut bits = vec![0; slots.iter().max().map_or(0, |most| *most as usize / 64 + 1)];
    for slot in slots {
        bits[*slot as usize / 64] |= 1 << (slot % 64);
    }
    bits
}

/// Whether batches are the same, wherever their slots stand.
fn same_batches(a: &[DrawBatch], b: &[DrawBatch]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| DrawBatch { first_instance: 0, ..*a } == DrawBatch { first_instance: 0, ..*b })
}
