//! Reflection probes: what their cubes show, how cubes are looked up, and what runs when.

mod faces;
mod mirror;
mod projection;
mod runs;

use glam::DVec3;

use crate::Case;
use crate::support::picture::Shot;

pub const CASES: &[Case] = &[
    ("reflection_probes::each face shows what stands there, the right way up", faces::show_what_stands_there),
    ("reflection_probes::a face is as bright as the camera's image", faces::are_as_bright_as_the_image),
    ("reflection_probes::mips are means", faces::mips_are_means),
    ("reflection_probes::the sky is behind everything", faces::show_the_sky),
    ("reflection_probes::rays end on a turned box", projection::rays_end_on_the_box),
    ("reflection_probes::a mirror shows the room", mirror::shows_the_room),
    ("reflection_probes::faces run for what they see", runs::for_what_they_see),
    ("reflection_probes::faces take turns", runs::in_turns),
];

const MIRROR: &str = "pipelines/mirror.ron";

/// Square pictures of the shipped pipeline `mirror`, `edge` pixels wide, with small maps and faces of that many texels.
fn shot(edge: u32, texels: u32, outputs: &[&str]) -> Shot {
    Shot::of(MIRROR, [edge, edge], outputs).set("sun_shadow_texels", 512).set("local_shadow_texels", 256).set("cube_texels", texels)
}

/// The direction in which the middle of a texel of a face lies, by the table of the Vulkan specification ("Cube Map Face Selection").
fn direction(face: u32, texel: [u32; 2], texels: u32) -> DVec3 {
    let [s, t] = texel.map(|place| (f64::from(place) + 0.5) / f64::from(texels) * 2.0 - 1.0);
    match face {
        0 => DVec3::new(1.0, -t, -s),
        1 => DVec3::new(-1.0, -t, s),
        2 => DVec3::new(s, 1.0, t),
        3 => DVec3::new(s, -1.0, -t),
        4 => DVec3::new(s, -t, 1.0),
        _ => DVec3::new(-s, -t, -1.0),
    }
}
