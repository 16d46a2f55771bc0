//! Pictures whose pixels are known from formulas: light, materials, shadows, reflections, tone mapping, orientation; and what runs leave
//! behind.
//!
//! Each rendering is at most 256 by 256 pixels. Tolerances stand near the errors that were measured on Mesa's software driver, which
//! each test states. Half floats, in which light is accumulated, are good to 2^-10 = 0.098 %: that driver rounds them towards zero.

#![allow(clippy::print_stdout, clippy::panic, clippy::expect_used, reason = "a test says what it measured, and may panic")]

#[path = "../support/mod.rs"]
mod support;

mod antialiasing;
mod area;
mod brdf;
mod changes;
mod environment;
mod forward;
mod irradiance;
mod many_lights;
mod masks;
mod materials;
mod noon;
mod occlusion;
mod orientation;
mod reflection_probes;
mod runs;
mod shadow_kinds;
mod shadows;
mod sky;
mod sky_image;
mod steady;
mod supersample;
mod tone_mapping;

use libtest_mimic::{Arguments, Failed, Trial};

/// A test: its name and what it does.
type Case = (&'static str, fn() -> Result<(), Failed>);

fn main() {
    let arguments = Arguments::from_args();
    let missing = if support::picture::adapter().is_some() { None } else { Some("a Vulkan adapter") };
    let groups: [&[Case]; 22] = [
        antialiasing::CASES,
        area::CASES,
        brdf::CASES,
        changes::CASES,
        environment::CASES,
        forward::CASES,
        irradiance::CASES,
        many_lights::CASES,
        masks::CASES,
        materials::CASES,
        noon::CASES,
        occlusion::CASES,
        orientation::CASES,
        reflection_probes::CASES,
        runs::CASES,
        shadow_kinds::CASES,
        shadows::CASES,
        sky::CASES,
        sky_image::CASES,
        steady::CASES,
        supersample::CASES,
        tone_mapping::CASES,
    ];
    let mut trials: Vec<Trial> = groups.concat().into_iter().map(|(name, run)| support::trial(name, missing, run)).collect();
    let missing = missing.or(if support::shared().is_some() { None } else { Some("the reference data") });
    trials.push(support::trial("brdf::agrees with the reference tables", missing, brdf::agrees_with_the_tables));
    libtest_mimic::run(&arguments, trials).exit();
}
