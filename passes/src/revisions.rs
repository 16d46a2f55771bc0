//! Revisions of what a scene publishes: equal bytes are the same revision, and bytes that nobody reads are no matter.
//!
//! What a draw list shows is its batches with the rows that they show; where those stand in their tables is no matter. States of a scene
//! share what did not change, so that an update costs what did: changed rows are found once, and each list is asked whether it shows one
//! of them. Accepted: a change of any geometry counts for every list, one of any texture for every list that samples some, an object
//! that gets another material counts whatever that material is, and an input that a plan in between did not have is new.

use std::collections::HashMap;
use std::sync::Arc;

use luminaire_graph::plan::{DrawReads, Input, Plan};
use luminaire_graph::published::{DrawBatch, PublishedGeometry, PublishedMaterials, PublishedScene, PublishedTexture, RowReads, Table};

use crate::scene_data::same_texture;

/// The content and revision of every input of the plan.
#[derive(Debug, Clone, Default)]
pub(crate) struct Revisions {
    known: HashMap<Input, (Content, u64)>,
    /// All geometry has one revision; so have all textures with their samplers.
    shared: Shared,
    next: u64,
    /// As of the last update.
    geometry: Arc<PublishedGeometry>,
    materials: Arc<PublishedMaterials>,
    rows: Rows,
}

/// Revisions of what all lists share.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Shared {
    geometry: u64,
    textures: u64,
}

/// What an input is.
#[derive(Debug, Clone)]
enum Content {
    Nothing,
    Table(Table),
    Bytes(Vec<u8>),
    Texture(Arc<PublishedTexture>),
    Draws(Shown),
}

/// The tables in which draw lists find what they show.
#[derive(Debug, Clone, Default)]
struct Rows {
    instances: Table,
    slots: Table,
    materials: Table,
}

/// Rows that are others than in the update before, with the tables of both.
struct ChangedRows<'a> {
    before: &'a Rows,
    now: &'a Rows,
    instances: Vec<u32>,
    materials: Vec<u32>,
    /// Whether any list may stand for other rows.
    slots: bool,
}

/// What a draw list shows.
#[derive(Debug, Clone)]
struct Shown {
    shared: Shared,
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

    fn changed<'a>(&'a self, before: &'a Rows) -> ChangedRows<'a> {
        ChangedRows {
            before,
            now: self,
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
        if self.geometry != scene.geometry {
            self.shared.geometry += 1;
            self.geometry = Arc::clone(&scene.geometry);
        }
        if self.materials != scene.materials {
            self.shared.textures += 1;
            self.materials = Arc::clone(&scene.materials);
        }
        let before = std::mem::replace(&mut self.rows, Rows::of(scene));
        let rows = self.rows.clone();
        let changed = rows.changed(&before);
        let mut standing = std::mem::take(&mut self.known);
        let mut found = Vec::with_capacity(plan.inputs.len());
        for input in &plan.inputs {
            let known = standing.remove(input);
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
        changed: &ChangedRows<'_>,
        input: &Input,
        before: &Content,
    ) -> Option<Content> {
        if let (Input::Draws(filter, view, reads), Content::Draws(shown)) = (input, before) {
            let batches = scene.draw_list(*filter, *view).cloned().unwrap_or_default();
            let untouched = Arc::ptr_eq(&shown.batches, &batches) && !changed.slots;
            let same_objects = untouched || same_batches(&shown.batches, &batches) && shown.slots == rows.shown(&batches);
            if same_objects && self.shared.same_for(shown.shared, reads) && !shown.shows_changed(changed, reads) {
                return None;
            }
            return Some(self.content(plan, scene, rows, input));
        }
        let content = self.content(plan, scene, rows, input);
        let same = match (input, &content, before) {
            (Input::Table(_, reads), Content::Table(now), Content::Table(before)) => same_table(reads, now, before),
            (Input::Row(.., reads), Content::Bytes(now), Content::Bytes(before)) => reads.agree(now, before),
            (_, Content::Texture(now), Content::Texture(before)) => same_texture(before, now),
            (_, Content::Bytes(now), Content::Bytes(before)) => now == before,
            (_, Content::Nothing, Content::Nothing) => true,
            _ => false,
        };
        (!same).then_some(content)
    }

    fn content(&self, plan: &Plan, scene: &PublishedScene, rows: &Rows, input: &Input) -> Content {
        match input {
            Input::Table(name, _) => Content::Table(scene.tables.get(name).cloned().unwrap_or_default()),
            Input::Row(name, row, _) => {
                let row = scene.tables.get(name).and_then(|table| table.row(*row as usize));
                Content::Bytes(row.unwrap_or_default().to_vec())
            }
            Input::Texture(name) => scene.textures.get(name).map_or(Content::Nothing, |texture| Content::Texture(Arc::clone(texture))),
            Input::View(view) => {
                let place = plan.views.iter().position(|known| known == view);
                Content::Bytes(place.and_then(|place| scene.views.get(place)).cloned().unwrap_or_default())
            }
            Input::Draws(filter, view, _) => {
                let batches = scene.draw_list(*filter, *view).cloned().unwrap_or_default();
                let slots = rows.shown(&batches);
                Content::Draws(Shown { shared: self.shared, members: members(&slots), slots, batches })
            }
            Input::Param(_) => Content::Nothing,
        }
    }
}

impl Shared {
    fn same_for(self, before: Shared, reads: &DrawReads) -> bool {
        self.geometry == before.geometry && (!reads.textures || self.textures == before.textures)
    }
}

impl Shown {
    /// Whether a row that is shown changed in what is read of it.
    fn shows_changed(&self, changed: &ChangedRows<'_>, reads: &DrawReads) -> bool {
        let differs = |table: &str, at: u32, before: &Table, now: &Table| {
            reads.rows.get(table).is_some_and(|reads| !reads.agree(row(before, at), row(now, at)))
        };
        let has = |row: &u32| self.members.get(*row as usize / 64).is_some_and(|bits| bits >> (row % 64) & 1 == 1);
        let instance = |row: &u32| has(row) && differs("instances", *row, &changed.before.instances, &changed.now.instances);
        let material = |row: &u32| {
            let shows = || self.batches.iter().any(|batch| batch.material as u32 == *row);
            differs("materials", *row, &changed.before.materials, &changed.now.materials) && shows()
        };
        changed.instances.iter().any(instance) || changed.materials.iter().any(material)
    }
}

/// A row that is not there has no bytes.
fn row(table: &Table, at: u32) -> &[u8] {
    table.row(at as usize).unwrap_or_default()
}

/// Whether tables agree in what is read of them.
fn same_table(reads: &RowReads, now: &Table, before: &Table) -> bool {
    now == before
        || (*reads != RowReads::Whole
            && (now.len(), now.stride()) == (before.len(), before.stride())
            && now.changed_rows(before).into_iter().all(|changed| reads.agree(row(now, changed), row(before, changed))))
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
