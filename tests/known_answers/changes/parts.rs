//! Which published parts of a scene differ between two states, as text: `local_lights[1].intensity`, `view of lamp 1`,
//! `opaque of lamp 1 face 3: 0 4`.

use std::collections::BTreeSet;

use luminaire::graph::plan::Plan;
use luminaire::graph::published::{DrawFilter, PublishedScene, Table, TableMember, ViewKind};
use luminaire::scenes::publish::schema;

/// More members than this of a row are not told one by one.
const MOST_MEMBERS: usize = 4;

/// What differs. Where draw lists stand in `instance_slots` is no part of its own.
pub fn changed_parts(plan: &Plan, before: &PublishedScene, now: &PublishedScene) -> Vec<String> {
    let mut parts = Vec::new();
    for (name, schema) in schema().tables {
        let (Some(before), Some(now)) = (before.tables.get(&name), now.tables.get(&name)) else { continue };
        if name != "instance_slots" {
            let one = before.rows() == 1 && now.rows() == 1 && !schema.members.is_empty() && !name.ends_with('s');
            parts.extend(
                changed_rows(before, now, &schema.members, schema.stride)
                    .into_iter()
                    .map(|(row, members)| if one { format!("{name}{members}") } else { format!("{name}[{row}]{members}") }),
            );
        }
    }
    let others = plan.views.iter().enumerate().filter(|(index, _)| before.views.get(*index) != now.views.get(*index));
    let mut views: Vec<String> = others.map(|(_, view)| view_name(view.kind)).collect();
    // All six faces of a lamp are told at once.
    for lamp in 0..8 {
        let faces: Vec<String> = (0..6).map(|face| view_name(ViewKind::PointLight(lamp, face))).collect();
        if faces.iter().all(|face| views.contains(face)) {
            views.retain(|view| !faces.contains(view));
            views.push(format!("lamp {lamp}"));
        }
    }
    parts.extend(views.into_iter().map(|view| format!("view of {view}")));
    for list in &now.draw_lists {
        let shown = |scene: &PublishedScene| objects(scene, list.filter, list.view);
        let (was, is) = (shown(before), shown(now));
        if was != is {
            let slots: Vec<String> = is.iter().map(u32::to_string).collect();
            parts.push(format!("{:?} of {}: {}", list.filter, view_name(list.view), slots.join(" ")).to_lowercase());
        }
    }
    parts.extend((before.geometry != now.geometry).then(|| "geometry".to_owned()));
    parts.extend((before.materials != now.materials).then(|| "textures".to_owned()));
    parts
}

/// Rows that differ, each with the members that do.
fn changed_rows(before: &Table, now: &Table, members: &[TableMember], stride: u32) -> Vec<(usize, String)> {
    let rows = before.rows().max(now.rows());
    let differs = |row: &usize| before.row(*row) != now.row(*row);
    (0..rows)
        .filter(differs)
        .map(|row| {
            let (Some(old), Some(new)) = (before.row(row), now.row(row)) else { return (row, String::new()) };
            let end = |index: usize| members.get(index + 1).map_or(stride, |next| next.offset) as usize;
            let other = |(index, member): &(usize, &TableMember)| {
                old[member.offset as usize..end(*index)] != new[member.offset as usize..end(*index)]
            };
            let names: Vec<&str> = members.iter().enumerate().filter(other).map(|(_, member)| member.name.as_str()).collect();
            (row, if names.len() > MOST_MEMBERS { String::new() } else { format!(".{}", names.join("+")) })
        })
        .collect()
}

/// The objects that a list shows, by slot.
pub fn objects(scene: &PublishedScene, filter: DrawFilter, view: ViewKind) -> BTreeSet<u32> {
    let slots = scene.tables.get("instance_slots");
    let batches = scene.draw_list(filter, view).into_iter().flat_map(|batches| batches.iter());
    let places = batches.flat_map(|batch| batch.first_instance..batch.first_instance + batch.instance_count);
    places.filter_map(|place| slots?.row(place as usize)?.try_into().ok().map(u32::from_le_bytes)).collect()
}

fn view_name(view: ViewKind) -> String {
    match view {
        ViewKind::Camera => "camera".to_owned(),
        ViewKind::DirectionalLight(light) => format!("sun {light}"),
        ViewKind::Cascade(cascade) => format!("sun {} cascade {}", cascade.light, cascade.index),
        ViewKind::PointLight(light, face) => format!("lamp {light} face {face}"),
        ViewKind::SpotLight(light) => format!("spot {light}"),
        ViewKind::RectangleLight(light, face) => format!("rectangle {light} face {face}"),
        ViewKind::WholeScene(light) => format!("sun {light} whole scene"),
        ViewKind::ReflectionProbe(probe, face) => format!("probe {probe} face {face}"),
    }
}
