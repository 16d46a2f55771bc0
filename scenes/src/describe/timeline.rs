//! What a timeline will do, in words.

use glam::{EulerRot, Quat, Vec3, Vec4};

use super::Event;
use super::text::{number, seconds, vector};
use crate::asset::Material;
use crate::timeline::{Action, Ease, Field, Goal, Property, Timeline};

/// All events by time.
pub(super) fn events(timeline: &Timeline, materials: &[Material]) -> Vec<Event> {
    timeline.events.iter().map(|event| Event { at: event.at, what: action(timeline, materials, &event.action) }).collect()
}

fn action(timeline: &Timeline, materials: &[Material], action: &Action) -> String {
    match action {
        Action::Change { property, goal, during, ease } => {
            format!("{}{}", change(timeline, materials, *property, *goal), pace(*during, *ease))
        }
        Action::Spawn(range) => {
            let names = timeline.declarations.get(range.clone()).unwrap_or_default().iter();
            let names: Vec<String> = names.map(|declared| format!("{} `{}`", declared.kind.what(), declared.name.value)).collect();
            format!("spawn {}", names.join(", "))
        }
        Action::Animate { node, play } => format!("play clip {} of `{}`", play.clip, timeline.name(*node)),
        Action::Show { node, shown } => format!("{} `{}`", if *shown { "show" } else { "hide" }, timeline.name(*node)),
        Action::Remove(node) => format!("remove `{}`", timeline.name(*node)),
        Action::Reparent { node, parent, keep_place } => {
            let parent = parent.map_or_else(|| "the world".to_owned(), |parent| format!("`{}`", timeline.name(parent)));
            let place = if *keep_place { ", in its place" } else { "" };
            format!("put `{}` below {parent}{place}", timeline.name(*node))
        }
    }
}

fn change(timeline: &Timeline, materials: &[Material], property: Property, goal: Goal) -> String {
    let of = |node| format!("`{}`", timeline.name(node));
    let (scalar, all) = match goal {
        Goal::Value(value) => (number(value.x), vector(value.truncate())),
        Goal::Rotation(rotation) => (String::new(), degrees(rotation)),
        Goal::Turn(by) => (String::new(), vector(by.map(f32::to_degrees))),
    };
    match (property, goal) {
        (Property::Translation(node), _) => format!("move {} to {all}", of(node)),
        (Property::Rotation(node), Goal::Turn(_)) => format!("turn {} by {all} degrees", of(node)),
        (Property::Rotation(node), _) => format!("rotate {} to {all} degrees", of(node)),
        (Property::Scale(node), _) => format!("scale {} to {all}", of(node)),
        (Property::Intensity(node), _) => format!("intensity of {} to {scalar}", of(node)),
        (Property::Color(node), _) => format!("color of {} to {all}", of(node)),
        (Property::Exposure(node), _) => format!("exposure of {} to {scalar}", of(node)),
        (Property::FieldOfView(node), Goal::Value(value)) => {
            format!("field of view of {} to {} degrees", of(node), number(value.x.to_degrees()))
        }
        (Property::FieldOfView(node), _) => format!("field of view of {}", of(node)),
        (Property::Sky, _) => format!("sky to {all} nits"),
        (Property::Material(row, field), _) => {
            let (field, to) = match field {
                Field::BaseColor => ("base color", all),
                Field::Emissive => ("emission", all),
                Field::Metallic => ("metallic", scalar),
                Field::Roughness => ("roughness", scalar),
                Field::Specular => ("specular", scalar),
            };
            let name = materials.get(row).map_or("", |material| material.name.as_str());
            format!("{field} of material `{name}` to {to}")
        }
    }
}

fn pace(during: f64, ease: Ease) -> String {
    let ease = match ease {
        Ease::Linear => "",
        Ease::Smooth => ", smoothly",
        Ease::In => ", slowly at first",
        Ease::Out => ", slowly at last",
        Ease::Hold => ", at the end",
    };
    if during > 0.0 { format!(" in {} s{ease}", seconds(during)) } else { String::new() }
}

/// A rotation about fixed x, then y, then z.
fn degrees(rotation: Vec4) -> String {
    let (z, y, x) = Quat::from_vec4(rotation).to_euler(EulerRot::ZYX);
    vector(Vec3::new(x, y, z).map(f32::to_degrees))
}
