//! Time goes on.

use bevy_ecs::prelude::World;
use glam::{Vec3, Vec4};
use luminaire_graph::diagnostic::Diagnostic;

use super::events::{Action, Event, NodeRef, Property, Timeline};
use super::hierarchy;
use super::property::{read, write};
use super::segment::{Goal, Segment};
use crate::scene_file::{play_clip, spawn};
use crate::world::Hidden;

/// Brings the world to a time: stops at every event on the way, where `settle` brings all that moves by itself to that time
/// first (and what the timeline moves is brought there if something gets another parent), and leaves running changes at `now`. A scene
/// without a timeline stays as it is. Returns what events could not do, each by itself: one that can't happen changes nothing, and keeps
/// no other from happening.
/// Errors: `world::time-backwards` behind an event that has happened; nothing has changed then.
pub(crate) fn advance(world: &mut World, now: f64, mut settle: impl FnMut(&mut World, f64)) -> Result<Vec<Diagnostic>, Diagnostic> {
    let Some(mut timeline) = world.remove_resource::<Timeline>() else { return Ok(Vec::new()) };
    let done = timeline.advance(world, now, &mut settle);
    world.insert_resource(timeline);
    done
}

impl Timeline {
    fn advance(&mut self, world: &mut World, now: f64, settle: &mut dyn FnMut(&mut World, f64)) -> Result<Vec<Diagnostic>, Diagnostic> {
        if let Some(last) = self.happened.checked_sub(1).and_then(|last| self.events.get(last)).filter(|last| last.at > now) {
            let message = format!("time can't go back to {now} s, for what happens in the scene at {} s has happened", last.at);
            return Err(Diagnostic::error("world::time-backwards", message).hint("load the scene again, and go forward from 0"));
        }
        let mut failed = Vec::new();
        while let Some(event) = self.events.get(self.happened).filter(|event| event.at <= now).cloned() {
            let is_first_of_moment =
                self.happened.checked_sub(1).and_then(|last| self.events.get(last)).is_none_or(|last| last.at < event.at);
            if is_first_of_moment {
                // Where things stand matters to no other event: a change of what is running goes on from its own value.
                let moment = self.events.iter().skip(self.happened).take_while(|other| other.at == event.at);
                if moment.into_iter().any(|other| matches!(other.action, Action::Reparent { .. })) {
                    self.evaluate(world, event.at);
                }
                settle(world, event.at);
            }
            self.happened += 1;
            failed.extend(self.happen(world, &event).err().map(|problem| problem.note(format!("an event at {} s", event.at))));
        }
        self.evaluate(world, now);
        Ok(failed)
    }

    fn happen(&mut self, world: &mut World, event: &Event) -> Result<(), Diagnostic> {
        match &event.action {
            Action::Change { property, goal, during, ease } => {
                let begin = |from: Vec4, goal: Goal| Segment { start: event.at, during: *during, ease: *ease, from, goal };
                let from = read(world, self, *property).ok_or_else(|| self.missing(*property))?;
                // Kept apart from here on, so that no product has to be taken apart again.
                for other in partners(*property) {
                    if let Some(value) = read(world, self, other).filter(|_| !self.running.contains_key(&other)) {
                        self.running.insert(other, Segment::constant(event.at, value));
                    }
                }
                let from = self.running.get(property).map_or(from, |running| running.at(event.at));
                self.running.insert(*property, begin(from, *goal));
                self.evaluate_one(world, *property, event.at);
            }
            Action::Spawn(range) => {
                let above = self.parents.get(range.clone()).unwrap_or_default().iter().flatten();
                for parent in above.filter(|parent| !range.contains(&parent.declaration)) {
                    self.living(world, *parent)?;
                }
                spawn(world, &self.declarations, range.clone(), &self.parents, &self.files, &mut self.spawned);
            }
            Action::Remove(node) => {
                let entity = self.living(world, *node)?;
                // What changes it ends when it is written next.
                hierarchy::remove(world, entity);
            }
            Action::Show { node, shown } => {
                let mut entity =
                    self.entity(*node).and_then(|entity| world.get_entity_mut(entity).ok()).ok_or_else(|| gone(&self.name(*node)))?;
                match shown {
                    true => entity.remove::<Hidden>(),
                    false => entity.insert(Hidden),
                };
            }
            Action::Animate { node, play } => {
                let entity = self.living(world, *node)?;
                play_clip(world, entity, play);
            }
            Action::Reparent { node, parent, keep_place } => {
                let entity = self.living(world, *node)?;
                let parent = parent.map(|parent| self.living(world, parent)).transpose()?;
                hierarchy::reparent(world, &self.name(*node), entity, parent, *keep_place)?;
                for property in [Property::Translation(*node), Property::Rotation(*node), Property::Scale(*node)] {
                    self.running.remove(&property);
                }
            }
        }
        Ok(())
    }

    /// Writes all running changes as they are at a time. One that has ended is written once more, and then left alone.
    fn evaluate(&mut self, world: &mut World, now: f64) {
        if now < self.evaluated {
            self.active = self.running.keys().copied().map(written_with).collect();
        }
        self.evaluated = now;
        let active: Vec<Property> = self.active.iter().copied().collect();
        for property in active {
            self.evaluate_one(world, property, now);
        }
    }

    fn evaluate_one(&mut self, world: &mut World, property: Property, now: f64) {
        let property = written_with(property);
        let parts = partners(property);
        let running = |part: &Property| self.running.get(part);
        let Some(value) = running(&property).map(|segment| segment.at(now)) else { return };
        let scale = parts.last().and_then(running).map_or(Vec3::ONE, |scale| scale.at(now).truncate());
        let has_ended = parts.iter().filter_map(running).all(|segment| segment.has_ended(now));
        let node = node_of(property);
        let entity = node.and_then(|node| self.entity(node)).filter(|entity| world.get_entity(*entity).is_ok());
        if node.is_some() && entity.is_none() {
            self.active.remove(&property);
            for part in parts {
                self.running.remove(&part);
            }
            return;
        }
        write(world, entity, property, value, scale);
        if has_ended {
            self.active.remove(&property);
        } else {
            self.active.insert(property);
        }
    }

    fn living(&self, world: &World, node: NodeRef) -> Result<bevy_ecs::prelude::Entity, Diagnostic> {
        let entity = self.entity(node).filter(|entity| world.get_entity(*entity).is_ok());
        entity.ok_or_else(|| gone(&self.name(node)))
    }

    fn missing(&self, property: Property) -> Diagnostic {
        gone(&node_of(property).map_or_else(|| "environment".to_owned(), |node| self.name(node)))
    }
}

fn gone(name: &str) -> Diagnostic {
    Diagnostic::error("world::unknown-node", format!("the timeline changes `{name}`, which something else has removed"))
}

/// What is written at once: a rotation and a scale share a matrix.
fn partners(property: Property) -> Vec<Property> {
    match property {
        Property::Rotation(node) | Property::Scale(node) => vec![Property::Rotation(node), Property::Scale(node)],
        other => vec![other],
    }
}

/// The one of its partners by which it is written.
fn written_with(property: Property) -> Property {
    match property {
        Property::Scale(node) => Property::Rotation(node),
        other => other,
    }
}

fn node_of(property: Property) -> Option<NodeRef> {
    match property {
        Property::Translation(node)
        | Property::Rotation(node)
        | Property::Scale(node)
        | Property::Intensity(node)
        | Property::Color(node)
        | Property::Exposure(node)
        | Property::FieldOfView(node) => Some(node),
        Property::Sky | Property::Material(..) => None,
    }
}
