//! How much a scene file makes of a few lines: copies, and files that stand many times.
//!
//! A scene of a million copies loads for seconds and draws for longer, and one of a thousand million never ends. Such a number is a slip,
//! or worse, and is refused before anything is made.

use bevy_ecs::prelude::World;
use glam::UVec3;
use luminaire_graph::diagnostic::Diagnostic;

use super::assets::UsedFile;
use super::check::{Declaration, Kind};
use super::checks::Problems;
use crate::world::Meshes;

/// Most entities that a scene file makes, with all that its timeline spawns.
const MAX_ENTITIES: u64 = 1 << 18;
/// Most triangles that they have, each as often as it stands.
const MAX_TRIANGLES: u64 = 1 << 28;

/// Most probes in all volumes.
const MAX_PROBES: u64 = 1 << 20;

/// Says which declaration is the first that makes too much. The meshes of everything are in the world.
pub(super) fn check_size(declarations: &[Declaration], files: &[Option<UsedFile>], world: &World, problems: &mut Problems) {
    let meshes = world.get_resource::<Meshes>().map_or(&[][..], |meshes| &meshes.0);
    let triangles = |mesh: usize| meshes.get(mesh).map_or(0, |mesh| mesh.indices.len() as u64 / 3);
    let mut entities = Sum { of: "nodes", what: "copies and nodes of files", limit: MAX_ENTITIES, sum: 0 };
    let mut drawn = Sum { of: "triangles", what: "those of copies and files", limit: MAX_TRIANGLES, sum: 0 };
    let mut probes = Sum { of: "probes", what: "those of all volumes", limit: MAX_PROBES, sum: 0 };
    for declaration in declarations {
        if let Kind::ProbeVolume(volume) = &declaration.kind {
            probes.add(product(volume.counts), declaration, problems);
        }
        let (made, shown) = match &declaration.kind {
            Kind::Object { mesh, repeat: None, .. } | Kind::Rectangle { mesh, .. } => (0, triangles(*mesh)),
            Kind::Object { mesh, repeat: Some(repeat), .. } => {
                let copies = product(repeat.count);
                (copies, copies.saturating_mul(triangles(*mesh)))
            }
            Kind::File(used) => files.get(*used).and_then(Option::as_ref).map_or((0, 0), |file| {
                let instances = file.asset.mesh_rows();
                (file.asset.nodes().len() as u64 + instances.clone().count() as u64, instances.map(triangles).sum())
            }),
            _ => (0, 0),
        };
        entities.add(made.saturating_add(1), declaration, problems);
        if entities.sum <= entities.limit {
            drawn.add(shown, declaration, problems);
        }
    }
}

fn product(counts: UVec3) -> u64 {
    counts.to_array().into_iter().fold(1, |product, count| product.saturating_mul(count.into()))
}

/// What there is so far of something.
struct Sum {
    of: &'static str,
    what: &'static str,
    limit: u64,
    sum: u64,
}

impl Sum {
    fn add(&mut self, more: u64, declaration: &Declaration, problems: &mut Problems) {
        let before = self.sum;
        self.sum = before.saturating_add(more);
        if before > self.limit || self.sum <= self.limit {
            return;
        }
        let (of, what, name) = (self.of, declaration.kind.what(), &declaration.name);
        let hint = match &declaration.kind {
            Kind::Object { repeat: Some(_), .. } => "give its `repeat` a smaller `count`, or the shape fewer sectors and stacks",
            Kind::ProbeVolume(_) => "give it smaller `counts`",
            Kind::File(_) => "let the file stand less often, or simplify it",
            _ => "let the scene hold less: most copies cost most",
        };
        problems.add(
            Diagnostic::error(
                "scene::too-much",
                format!("the scene has too many {of}: {before}, and {more} of the {what} `{}`", name.value),
            )
            .at(name.span, format!("at most {} are allowed, {} among them", self.limit, self.what))
            .hint(hint),
        );
    }
}
