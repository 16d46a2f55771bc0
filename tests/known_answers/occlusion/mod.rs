//! Ambient occlusion of `pipelines/blocks/ambient_occlusion.ron` against closed forms, what it does where nothing is hidden, and what
//! `shared/specular_occlusion.wgsl` makes of it.

mod open;
mod runs;
mod specular;
mod walls;

use crate::Case;
use crate::support::picture::Shot;

pub const CASES: &[Case] = &[
    ("occlusion::a floor along a wall", walls::floor_along_a_wall),
    ("occlusion::a floor between two walls", walls::corner),
    ("occlusion::the floor of a pit", walls::pit),
    ("occlusion::bent normals turn away from a wall", walls::bent_normals),
    ("occlusion::what is convex hides nothing of itself", open::convex),
    ("occlusion::what is farther than the radius hides nothing", open::beyond_the_radius),
    ("occlusion::a mirrored scene gives the mirrored picture", open::mirrored),
    ("occlusion::samples converge", open::samples_converge),
    ("occlusion::a camera that moves runs it, a light does not", runs::what_reads_it),
    ("occlusion::reflections and bounces at their limits", specular::limits),
    ("occlusion::cones have in common what they have", specular::cones),
];

/// Square pictures of the pipeline `occlusion`.
fn shot(edge: u32, outputs: &[&str]) -> Shot {
    Shot::of("pipelines/occlusion.ron", [edge, edge], outputs)
}

/// With so many slices and steps that few errors are left but those of the method, and without an end of what counts.
fn fine(edge: u32, outputs: &[&str]) -> Shot {
    shot(edge, outputs).set("occlusion.radius", "1000.0").set("occlusion.slices", 8).set("occlusion.steps", 64).set("occlusion.blur", false)
}
