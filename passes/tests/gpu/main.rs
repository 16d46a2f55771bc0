//! Plans made by hand, run on a Vulkan device (software is enough) and on wgpu's noop device.
//!
//! Without a Vulkan device the tests that need one are shown as ignored; where `CI` is set, its absence is a failure.

// Tests without the harness of `cargo test`, which clippy does not know for tests.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod clear;
mod compute;
mod copy;
mod draw;
mod fullscreen;
mod materials;
mod problems;
mod support;

use libtest_mimic::{Arguments, Failed, Trial};
use luminaire_passes::Gpu;

type Check = fn(&Gpu);

fn main() {
    let arguments = Arguments::from_args();
    let device = support::open();
    let missing = device.is_none();
    let mut trials: Vec<Trial> = Vec::new();
    for (name, check) in checks() {
        let device = device.clone();
        let trial = Trial::test(name, move || match &device {
            Some(gpu) => {
                check(gpu);
                Ok(())
            }
            None => Err(Failed::from("there is no Vulkan device")),
        });
        trials.push(trial.with_ignored_flag(missing && std::env::var_os("CI").is_none()));
    }
    for (name, check) in noop_checks() {
        trials.push(Trial::test(name, move || {
            check();
            Ok(())
        }));
    }
    libtest_mimic::run(&arguments, trials).exit();
}

fn checks() -> Vec<(&'static str, Check)> {
    vec![
        ("fullscreen::top_left_is_zero", fullscreen::top_left_is_zero),
        ("fullscreen::locations_may_go_nowhere", fullscreen::locations_may_go_nowhere),
        ("fullscreen::blending", fullscreen::blending),
        ("fullscreen::views_of_mips_and_layers", fullscreen::views_of_mips_and_layers),
        ("fullscreen::built_in_samplers", fullscreen::built_in_samplers),
        ("fullscreen::four_samples", fullscreen::four_samples),
        ("compute::fills_a_volume", compute::fills_a_volume),
        ("compute::buffers_live_in_arenas", compute::buffers_live_in_arenas),
        ("compute::frames_are_equal_and_counted", compute::frames_are_equal_and_counted),
        ("copy::levels_and_layers", copy::levels_and_layers),
        ("copy::bytes", copy::bytes),
        ("clear::every_way", clear::every_way),
        ("clear::parts", clear::parts),
        ("clear::before_a_step", clear::before_a_step),
        ("draw::winding", draw::winding),
        ("draw::depth_compare", draw::depth_compare),
        ("draw::read_only_depth_is_sampled", draw::read_only_depth_is_sampled),
        ("draw::nothing_still_clears", draw::nothing_still_clears),
        ("materials::textures_follow_batches", materials::textures_follow_batches),
        ("materials::tables_are_updated", materials::tables_are_updated),
        ("problems::validation_names_the_pass", problems::validation_names_the_pass),
        ("problems::a_lost_device_is_an_error", problems::lost),
        ("problems::an_output_of_another_name", problems::an_output_of_another_name),
    ]
}

fn noop_checks() -> Vec<(&'static str, fn())> {
    vec![
        ("noop::a_plan_prepares_and_runs", problems::noop_runs),
        ("noop::limits_are_checked_first", problems::noop_limits),
        ("noop::the_budget_is_checked_first", problems::noop_budget),
        ("noop::a_lost_device_is_an_error", problems::noop_lost),
        ("noop::scenes_are_checked", problems::noop_scene),
        ("noop::validation_names_every_pass", problems::noop_validation),
    ]
}
