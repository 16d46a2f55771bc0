//! Shadows of every kind of light against closed forms, by the pipeline `shadow`: areas, penumbras, falloff, cascades in motion and their
//! seams.

mod areas;
mod cascades;
mod penumbras;
mod spots;

use crate::Case;
use crate::support::picture::Shot;

pub const CASES: &[Case] = &[
    ("shadow_kinds::areas of a sphere's shadow", areas::of_a_sphere),
    ("shadow_kinds::falloff of a spot", spots::falloff),
    ("shadow_kinds::a spot that is too wide for a map has a cube", spots::wide),
    ("shadow_kinds::penumbras of a straight edge", penumbras::of_an_edge),
    ("shadow_kinds::edges stand still under a moving camera", cascades::stand_still),
    ("shadow_kinds::seams between cascades", cascades::have_no_seams),
    ("shadow_kinds::shadows end at the greatest distance", cascades::end_at_the_distance),
];

/// Square pictures of the pipeline `shadow`.
fn shot(edge: u32, outputs: &[&str]) -> Shot {
    Shot::of("pipelines/shadow.ron", [edge, edge], outputs)
}

/// An orthographic camera just above the plane y = 0, which looks straight down: what stands higher does not hide the plane. `middle` is
/// the place below it along x and z.
fn below(middle: [f64; 2], height: f64) -> String {
    let [x, z] = middle;
    format!("cameras: {{ \"eye\": (position: ({x}, 0.05, {z}), target: ({x}, 0, {z}), ortho: {height}, near: 0.01, far: 1) }},")
}
