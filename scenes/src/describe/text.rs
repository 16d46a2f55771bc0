//! A description as text, and how numbers are written in it.

use std::fmt::Write;

use glam::Vec3;

use super::{Description, Node};
use crate::asset::{AlphaMode, Material};

/// The description as lines of text, for people.
pub fn text(scene: &Description) -> String {
    let mut text = String::new();
    // Writing into a string can't fail.
    let mut line = |parts: std::fmt::Arguments<'_>| {
        let _ = writeln!(text, "{parts}");
    };
    line(format_args!("time       {} s", seconds(scene.time)));
    line(format_args!("nodes      {}", scene.nodes.len()));
    line(format_args!("meshes     {}, {} triangles", scene.meshes, scene.stored_triangles));
    line(format_args!("drawn      {} triangles", scene.drawn_triangles));
    match scene.bounds {
        Some([min, max]) => line(format_args!("bounds     {} to {} m", vector(min.into()), vector(max.into()))),
        None => line(format_args!("bounds     none")),
    }
    line(format_args!("sky        {} nits", vector(scene.sky.into())));
    let images = if scene.images == 1 { "image" } else { "images" };
    line(format_args!("memory     geometry {}, {} {images} {}", bytes(scene.geometry_bytes), scene.images, bytes(scene.texture_bytes)));
    let counts: Vec<String> = scene.counts.iter().map(|(name, count)| format!("{name} {count}")).collect();
    line(format_args!("counts     {}", counts.join(", ")));
    if !scene.nodes.is_empty() {
        line(format_args!("\nnodes"));
    }
    for (node, times) in gathered(&scene.nodes) {
        let name = node.name.as_deref().unwrap_or("-");
        let indent = 2 + 2 * node.depth.min(40);
        let times = if times > 1 { format!("{times} times ") } else { String::new() };
        let what = if node.parts.is_empty() { "group".to_owned() } else { node.parts.join("; ") };
        let width = 36_usize.saturating_sub(indent);
        line(format_args!("{:indent$}{name:<width$} {times}{what}, at {}", "", vector(node.position.into())));
    }
    if !scene.materials.is_empty() {
        line(format_args!("\nmaterials"));
    }
    for (row, material) in scene.materials.iter().enumerate() {
        line(format_args!("  {row:<4} {:<29} {}, on {}", material.name, material.looks, material.used_by));
    }
    if !scene.timeline.is_empty() {
        line(format_args!("\ntimeline"));
    }
    for event in &scene.timeline {
        line(format_args!("  {:>8} s  {}", seconds(event.at), event.what));
    }
    text
}

/// Nodes with how often they stand: unnamed siblings without children that are the same but for their place count as one.
fn gathered(nodes: &[Node]) -> Vec<(&Node, usize)> {
    let has_children = |index: usize| nodes.get(index + 1).is_some_and(|next| next.parent == Some(index));
    let mut shown: Vec<(&Node, usize)> = Vec::new();
    let mut known: std::collections::BTreeMap<(Option<usize>, &[String]), usize> = std::collections::BTreeMap::new();
    for (index, node) in nodes.iter().enumerate() {
        if node.name.is_none() && !has_children(index) {
            let place = *known.entry((node.parent, &node.parts)).or_insert(shown.len());
            if let Some((_, times)) = shown.get_mut(place) {
                *times += 1;
                continue;
            }
        }
        shown.push((node, 1));
    }
    shown
}

/// What a material is like.
pub(super) fn looks(material: &Material) -> String {
    let [red, green, blue, alpha] = material.base_color;
    let mut looks = format!("{} roughness {}", vector(Vec3::new(red, green, blue)), number(material.roughness));
    let mut say = |given: bool, what: String| {
        if given {
            looks.push_str(&what);
        }
    };
    say(material.metallic > 0.0, format!(" metallic {}", number(material.metallic)));
    say(material.emissive != [0.0; 3], format!(" emits {} nits", vector(material.emissive.into())));
    say(alpha < 1.0, format!(" alpha {}", number(alpha)));
    say(matches!(material.alpha_mode, AlphaMode::Mask { .. }), " masked".to_owned());
    say(material.alpha_mode == AlphaMode::Blend, " blended".to_owned());
    say(material.double_sided, " double-sided".to_owned());
    say(material.unlit, " unlit".to_owned());
    let textures = [
        material.base_color_texture,
        material.metallic_roughness_texture,
        material.normal_texture,
        material.occlusion_texture,
        material.emissive_texture,
        material.specular_texture,
        material.specular_color_texture,
    ];
    let textures = textures.iter().flatten().count();
    say(textures > 0, format!(" textures {textures}"));
    looks
}

/// Three decimals at most.
pub(super) fn number(value: f32) -> String {
    seconds(f64::from(value))
}

/// Three decimals at most; very large and very small numbers with an exponent.
pub(super) fn seconds(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(0.001..1e9).contains(&size) {
        return format!("{value:.3e}");
    }
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

pub(super) fn vector(value: Vec3) -> String {
    format!("({}, {}, {})", number(value.x), number(value.y), number(value.z))
}

/// A light's color, unless it is white.
pub(super) fn color(value: Vec3) -> String {
    if value == Vec3::ONE { String::new() } else { format!(" times {}", vector(value)) }
}

fn bytes(count: u64) -> String {
    match count {
        0..1024 => format!("{count} bytes"),
        1024..1_048_576 => format!("{} KiB", seconds((count as f64 / 102.4).round() / 10.0)),
        _ => format!("{} MiB", seconds((count as f64 / 104_857.6).round() / 10.0)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let cases = [(0.0, "0"), (-0.0, "0"), (0.1, "0.1"), (35.0, "35"), (100000.0, "100000"), (-1.23456, "-1.235"), (1e-5, "1.000e-5")];
        for (value, expected) in cases {
            assert_eq!(number(value), expected);
        }
        assert_eq!(number(-0.0004), "-4.000e-4");
        assert_eq!((bytes(0), bytes(2048), bytes(5 << 20)), ("0 bytes".to_owned(), "2 KiB".to_owned(), "5 MiB".to_owned()));
    }
}
