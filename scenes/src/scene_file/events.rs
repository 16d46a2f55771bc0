//! From what a timeline says to events: in order of time, with nodes in place of names and numbers in range.

use std::ops::Range;

use bevy_ecs::prelude::World;
use glam::{Vec3, Vec4};
use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::syntax::document::Text;

use super::check::{Kind, motion};
use super::checks::{BRIGHT, COLORFUL, FAR, Problems, rotation_of};
use super::document::{ActionDoc, AnimationDoc, EaseDoc, EventDoc, Number, SceneDoc, Seconds, Vector};
use super::names::Names;
use crate::asset::Projection;
use crate::timeline::{Action, Ease, Event, Field, Goal, NodeRef, Property};
use crate::world::{Exposure, Materials};

/// A property of some node.
type OfNode = fn(NodeRef) -> Property;

/// All events by time; those of the same time stay in the order in which they are written. `batches` holds what each event spawns.
pub(super) fn events(
    document: &SceneDoc,
    batches: &[Range<usize>],
    names: &mut Names<'_>,
    world: &World,
    problems: &mut Problems,
) -> Vec<Event> {
    let mut order: Vec<(f64, &EventDoc, Range<usize>)> = document
        .timeline
        .iter()
        .zip(batches)
        .map(|(event, batch)| (problems.seconds("`at` of an event", Some(&event.at)), event, batch.clone()))
        .collect();
    order.sort_by(|(first, ..), (second, ..)| first.total_cmp(second));
    let mut events = Vec::new();
    for (at, event, batch) in order {
        let mut one = One { at, event, document, world, problems, events: &mut events };
        one.resolve(batch, names);
    }
    events
}

/// One event on its way.
struct One<'a, 'b> {
    at: f64,
    event: &'a EventDoc,
    document: &'a SceneDoc,
    world: &'a World,
    problems: &'b mut Problems,
    events: &'b mut Vec<Event>,
}

impl One<'_, '_> {
    fn resolve(&mut self, batch: Range<usize>, names: &mut Names<'_>) {
        let at = self.at;
        match &self.event.action {
            ActionDoc::Move { node, to, during, ease } => {
                let to = self.problems.position(&format!("`to` of the move of `{node}`"), to);
                let timing = self.timing(during.as_ref(), *ease);
                if let Some(node) = names.find(node, at, self.problems) {
                    self.change(Property::Translation(node), Goal::Value(to.extend(0.0)), timing);
                }
            }
            ActionDoc::Rotate { node, to, during, ease } => {
                let to = self.problems.angles(&format!("`to` of the rotation of `{node}`"), Some(to));
                let timing = self.timing(during.as_ref(), *ease);
                if let Some(node) = names.find(node, at, self.problems) {
                    self.change(Property::Rotation(node), Goal::Rotation(rotation_of(to).into()), timing);
                }
            }
            ActionDoc::Turn { node, by, during, ease } => {
                let by = self.problems.angles(&format!("`by` of the turn of `{node}`"), Some(by));
                let timing = self.timing(during.as_ref(), *ease);
                if let Some(node) = names.find(node, at, self.problems) {
                    self.change(Property::Rotation(node), Goal::Turn(by), timing);
                }
            }
            ActionDoc::Scale { node, to, during, ease } => {
                let to = self.problems.vector(&format!("`to` of the scaling of `{node}`"), Some(to), Vec3::ONE, -FAR..=FAR);
                let timing = self.timing(during.as_ref(), *ease);
                if let Some(node) = names.find(node, at, self.problems) {
                    names.scale(node, at + timing.0, to.to_array().contains(&0.0));
                    self.change(Property::Scale(node), Goal::Value(to.extend(0.0)), timing);
                }
            }
            ActionDoc::Light { light, intensity, color, during, ease } => {
                let of = format!("the change of light `{light}`");
                let values = [
                    intensity.as_ref().map(|value| (Property::Intensity as OfNode, self.scalar("intensity", &of, value, 0.0..=BRIGHT))),
                    color.as_ref().map(|value| (Property::Color as OfNode, self.color("color", &of, value, COLORFUL))),
                ];
                let timing = self.timing(during.as_ref(), *ease);
                let node = names.find(light, at, self.problems).filter(|node| self.is_light(names, *node, light));
                self.changes(node, light, "`intensity` or `color`", values, timing);
            }
            ActionDoc::Camera { camera, ev100, exposure, fov, during, ease } => {
                let of = format!("the change of camera `{camera}`");
                let fov_value = fov.as_ref().map(|value| self.problems.number(&format!("`fov` of {of}"), Some(value), 45.0, 1.0..=170.0));
                let values = [
                    ev100.as_ref().map(|value| (Property::Exposure as OfNode, self.scalar("ev100", &of, value, -40.0..=40.0))),
                    exposure.as_ref().map(|value| (Property::Exposure as OfNode, self.scalar("exposure", &of, value, 0.0..=BRIGHT))),
                    fov_value.map(|fov| (Property::FieldOfView as OfNode, Vec4::new(fov.to_radians(), 0.0, 0.0, 0.0))),
                ];
                let timing = self.timing(during.as_ref(), *ease);
                let node = names.find(camera, at, self.problems);
                let node = node.filter(|node| self.is_camera(names, *node, camera, [ev100.is_some(), exposure.is_some(), fov.is_some()]));
                self.changes(node, camera, "`ev100`, `exposure` or `fov`", values, timing);
            }
            ActionDoc::Animate { file, clip, speed, again } => {
                let entry = AnimationDoc { clip: clip.clone(), speed: *speed, start: None, again: *again };
                let Some(node) = names.find(file, at, self.problems) else { return };
                match names.file(node).filter(|_| node.inside.is_none()) {
                    Some(asset) => {
                        let play = motion::play(asset, &format!("file `{file}`"), file.span, &entry, at, self.problems);
                        self.events.extend(play.map(|play| Event { at, action: Action::Animate { node, play } }));
                    }
                    None => self.problems.add(
                        Diagnostic::error("scene::wrong-kind", format!("`{file}` is no glTF file"))
                            .at(file.span, "must be an entry of `files`"),
                    ),
                }
            }
            ActionDoc::Sky { radiance, during, ease } => {
                let radiance = self.color("radiance", "the change of the sky", radiance, BRIGHT);
                let timing = self.timing(during.as_ref(), *ease);
                self.change(Property::Sky, Goal::Value(radiance), timing);
            }
            ActionDoc::Material { .. } => self.material(names),
            ActionDoc::Spawn { .. } => {
                names.declare(batch.clone(), at, self.problems);
                self.events.push(Event { at, action: Action::Spawn(batch) });
            }
            ActionDoc::Remove { node: name } => {
                if let Some(node) = names.find(name, at, self.problems) {
                    names.remove(node, at, name.span);
                    self.events.push(Event { at, action: Action::Remove(node) });
                }
            }
            ActionDoc::Hide { node } | ActionDoc::Show { node } => {
                let shown = matches!(self.event.action, ActionDoc::Show { .. });
                if let Some(node) = names.find(node, at, self.problems) {
                    self.events.push(Event { at, action: Action::Show { node, shown } });
                }
            }
            ActionDoc::Reparent { node: name, parent, keep_place } => {
                let node = names.find(name, at, self.problems);
                let above = match parent {
                    Some(parent) => names.find(parent, at, self.problems).map(Some),
                    None => Some(None),
                };
                if let (Some(node), Some(parent)) = (node, above) {
                    let keep_place = keep_place.unwrap_or(true);
                    if keep_place && parent.is_some_and(|parent| names.is_flat(parent, at)) {
                        let message = format!("`{name}` can't keep its place below a parent whose scale is zero");
                        self.problems.add(
                            Diagnostic::error("scene::flat-parent", message)
                                .at(name.span, "keeps its place")
                                .hint("let it take its place from the parent, with `keep_place: false`"),
                        );
                    }
                    names.reparent(node, parent, name, self.problems);
                    let action = Action::Reparent { node, parent, keep_place };
                    self.events.push(Event { at, action });
                }
            }
        }
    }

    fn material(&mut self, names: &Names<'_>) {
        let ActionDoc::Material { material, base_color, metallic, roughness, emissive, specular, during, ease } = &self.event.action else {
            return;
        };
        let of = format!("the change of material `{material}`");
        let values = [
            base_color.as_ref().map(|value| (Field::BaseColor, self.color("base_color", &of, value, 1.0))),
            metallic.as_ref().map(|value| (Field::Metallic, self.scalar("metallic", &of, value, 0.0..=1.0))),
            roughness.as_ref().map(|value| (Field::Roughness, self.scalar("roughness", &of, value, 0.0..=1.0))),
            emissive.as_ref().map(|value| (Field::Emissive, self.color("emissive", &of, value, BRIGHT))),
            specular.as_ref().map(|value| (Field::Specular, self.scalar("specular", &of, value, 0.0..=1.0))),
        ];
        let timing = self.timing(during.as_ref(), *ease);
        let rows = self.rows(names, material);
        if values.iter().all(Option::is_none) {
            self.nothing(material, "a field such as `base_color`");
        }
        for row in rows {
            for (field, value) in values.iter().flatten() {
                self.change(Property::Material(row, *field), Goal::Value(*value), timing);
            }
        }
    }

    /// The rows of a material's name; empty where it is unknown, which is a problem.
    fn rows(&mut self, names: &Names<'_>, name: &Text) -> Vec<usize> {
        if let Some(row) = self.document.materials.get_index_of(name) {
            return vec![row];
        }
        // The material of an object's own, or one of a file.
        if let Some((file, inner)) = name.value.split_once('/') {
            let file = Text::new(file.to_owned(), name.span);
            let Some(node) = names.find(&file, self.at, self.problems) else { return Vec::new() };
            let Some(asset) = names.file(node) else { return Vec::new() };
            let rows = asset.materials();
            let all = self.world.get_resource::<Materials>().and_then(|materials| materials.0.get(rows.clone())).unwrap_or_default();
            let found: Vec<usize> = rows.zip(all).filter(|(_, material)| material.name == inner).map(|(row, _)| row).collect();
            if found.is_empty() {
                let known = || all.iter().map(|material| material.name.as_str());
                self.problems.add_unknown(
                    Diagnostic::error("scene::unknown-material", format!("the file `{file}` has no material `{inner}`"))
                        .at(name.span, "no such material"),
                    "materials of the file",
                    Some(inner),
                    known,
                );
            }
            return found;
        }
        let declared = names.named(&name.value).map(|declaration| &declaration.kind);
        if let Some(Kind::Object { material, .. }) = declared
            && *material >= self.document.materials.len()
        {
            return vec![*material];
        }
        let known = || self.document.materials.keys().map(|known| known.value.as_str());
        self.problems.add_unknown(
            Diagnostic::error("scene::unknown-material", format!("the timeline changes the material `{name}`, which is not defined"))
                .at(name.span, "no such material, and no object with a `surface` of its own"),
            "materials of the scene",
            Some(&name.value),
            known,
        );
        Vec::new()
    }

    fn is_light(&mut self, names: &Names<'_>, node: NodeRef, name: &Text) -> bool {
        let declared = names.declaration(node).map(|declaration| &declaration.kind);
        let inside = node.inside.and_then(|inner| names.file(node)?.nodes().get(inner)).is_some_and(|node| node.light.is_some());
        let fits = inside || matches!(declared, Some(Kind::Directional(_) | Kind::Local(_) | Kind::Rectangle { .. }));
        if !fits {
            self.problems.add(Diagnostic::error("scene::wrong-kind", format!("`{name}` is no light")).at(name.span, "must be a light"));
        }
        fits
    }

    fn is_camera(&mut self, names: &Names<'_>, node: NodeRef, name: &Text, [ev100, factor, fov]: [bool; 3]) -> bool {
        let Some(Kind::Camera { camera, .. }) = names.declaration(node).map(|declaration| &declaration.kind) else {
            let message = format!("`{name}` is no camera of the scene file");
            self.problems.add(Diagnostic::error("scene::wrong-kind", message).at(name.span, "must be an entry of `cameras`"));
            return false;
        };
        let lacks = [
            ("exposure `ev100`", ev100 && !matches!(camera.exposure, Exposure::Ev100(_))),
            ("exposure by a factor", factor && !matches!(camera.exposure, Exposure::Factor(_))),
            ("angle `fov`, being orthographic", fov && matches!(camera.projection, Projection::Orthographic { .. })),
        ];
        for (what, _) in lacks.iter().filter(|(_, missing)| *missing) {
            let message = format!("the camera `{name}` has no {what}, so none can change");
            self.problems.add(Diagnostic::error("scene::wrong-kind", message).at(name.span, format!("needs an {what} from the beginning")));
        }
        !lacks.iter().any(|(_, missing)| *missing)
    }

    fn scalar(&mut self, field: &str, of: &str, value: &Number, range: std::ops::RangeInclusive<f32>) -> Vec4 {
        let default = *range.start();
        Vec4::new(self.problems.number(&format!("`{field}` of {of}"), Some(value), default, range), 0.0, 0.0, 0.0)
    }

    fn color(&mut self, field: &str, of: &str, value: &Vector, limit: f32) -> Vec4 {
        self.problems.color(&format!("`{field}` of {of}"), Some(value), Vec3::ONE, limit).extend(0.0)
    }

    fn timing(&mut self, during: Option<&Seconds>, ease: EaseDoc) -> (f64, Ease) {
        let during = self.problems.seconds("`during` of an event", during);
        let ease = match ease {
            EaseDoc::Linear => Ease::Linear,
            EaseDoc::Smooth => Ease::Smooth,
            EaseDoc::In => Ease::In,
            EaseDoc::Out => Ease::Out,
            EaseDoc::Hold => Ease::Hold,
        };
        (during, ease)
    }

    fn nothing(&mut self, name: &Text, fields: &str) {
        let message = format!("an event of `{name}` changes nothing");
        self.problems.add(Diagnostic::error("scene::no-change", message).at(name.span, "here").hint(format!("give it {fields}")));
    }

    fn changes<const N: usize>(
        &mut self,
        node: Option<NodeRef>,
        name: &Text,
        fields: &str,
        values: [Option<(OfNode, Vec4)>; N],
        timing: (f64, Ease),
    ) {
        if values.iter().all(Option::is_none) {
            self.nothing(name, fields);
        }
        for (property, value) in values.into_iter().flatten() {
            if let Some(node) = node {
                self.change(property(node), Goal::Value(value), timing);
            }
        }
    }

    fn change(&mut self, property: Property, goal: Goal, (during, ease): (f64, Ease)) {
        self.events.push(Event { at: self.at, action: Action::Change { property, goal, during, ease } });
    }
}
