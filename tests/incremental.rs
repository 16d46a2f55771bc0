//! What runs after which change, for the pipelines that come with the program. No GPU takes part.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs)]

use std::path::Path;

use luminaire::files::DiskFiles;
use luminaire::graph::compile::{CompileInput, compile};
use luminaire::graph::device::DeviceFacts;
use luminaire::graph::harness::Harness;
use luminaire::graph::plan::Input;
use luminaire::graph::published::{SceneCounts, ViewKind};
use luminaire::scenes::publish::schema;

/// A pipeline, what the scene has, and what is asked for.
struct Case<'a> {
    pipeline: &'a str,
    lights: u32,
    sets: &'a [(&'a str, &'a str)],
    outputs: &'a [&'a str],
    size: [u32; 2],
}

impl Case<'_> {
    fn compile<T>(&self, with: impl FnOnce(&CompileInput<'_>) -> T) -> T {
        let counts: SceneCounts = schema().counts.into_iter().map(|name| (name, 1)).collect();
        let counts = counts.into_iter().map(|(name, _)| {
            let count = if name == "local_lights" || name == "point_lights" { self.lights } else { 1 };
            (name, count)
        });
        let sets: Vec<(String, String)> = self.sets.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
        let outputs: Vec<String> = self.outputs.iter().map(|name| (*name).to_owned()).collect();
        with(&CompileInput {
            pipeline: self.pipeline,
            files: &DiskFiles::for_pipeline(Path::new(self.pipeline)),
            published: &schema(),
            counts: &counts.collect(),
            device: &DeviceFacts::webgpu_defaults(),
            output: self.size,
            sets: &sets,
            outputs: Some(&outputs),
        })
    }
}

const PBR: Case<'_> = Case { pipeline: "pipelines/pbr.ron", lights: 2, sets: &[], outputs: &["color"], size: [64, 64] };

const SKY: Case<'_> = Case { pipeline: "pipelines/sky.ron", lights: 0, sets: &[], outputs: &["color"], size: [64, 64] };

/// After its first frame.
fn settled(case: &Case<'_>) -> Harness {
    let mut harness = case.compile(Harness::new).unwrap_or_else(|problems| panic!("{problems}"));
    harness.frame();
    assert!(harness.frame().is_empty(), "an unchanged frame runs nothing");
    harness
}

#[test]
fn a_camera_that_moves_leaves_the_shadow_maps_of_local_lights() {
    let mut harness = settled(&PBR);
    let from_camera = |input: &Input| match input {
        Input::Table(name, _) => name == "camera",
        Input::View(view) => view.kind == ViewKind::Camera,
        Input::Draws(_, view, _) => *view == ViewKind::Camera,
        _ => false,
    };
    assert!(harness.change(from_camera) > 0);
    assert_eq!(harness.frame(), ["gbuffer", "light", "skybox.sky", "compose", "transparent", "display.expose"]);
}

/// A loop that takes turns makes frames depend on each other; one that has a turn for all does not.
#[test]
fn faces_that_all_run_at_once_carry_nothing_over() {
    let carries_over = |faces: &str| {
        let sets = [("faces_per_frame", faces)];
        let case = Case { pipeline: "pipelines/mirror.ron", sets: &sets, ..PBR };
        case.compile(|input| compile(input).plan.map(|plan| plan.carries_over()))
    };
    assert_eq!(["5", "6", "384"].map(carries_over), [Some(true), Some(false), Some(false)]);
}

/// Cascades follow the camera, and no face of a probe reads them.
#[test]
fn a_camera_that_moves_leaves_what_probes_capture() {
    let mut harness = settled(&Case { pipeline: "pipelines/mirror.ron", ..PBR });
    assert!(harness.is_retained("captured.cubes"));
    let from_camera = |input: &Input| match input {
        Input::Table(name, _) => name == "camera" || name == "cascades",
        Input::View(view) => matches!(view.kind, ViewKind::Camera | ViewKind::Cascade(_)),
        Input::Draws(_, view, _) => matches!(view, ViewKind::Camera | ViewKind::Cascade(_)),
        _ => false,
    };
    assert!(harness.change(from_camera) > 0);
    let ran = harness.frame();
    assert!(ran.iter().any(|name| name.starts_with("sun_shadows.")) && ran.iter().any(|name| name == "reflect"), "{ran:?}");
    assert!(!ran.iter().any(|name| name.starts_with("captured.")), "{ran:?}");
}

#[test]
fn a_light_that_moves_draws_its_own_six_faces() {
    let mut harness = settled(&PBR);
    harness.change_table("local_lights");
    harness.change(|input| matches!(input, Input::View(view) if matches!(view.kind, ViewKind::PointLight(1, _))));
    let ran = harness.frame();
    let faces = |light: u32| {
        ran.iter().filter(|name| (0..6).any(|face| name.starts_with(&format!("point_shadows.faces[{}].", 6 * light + face)))).count()
    };
    assert_eq!((faces(0), faces(1)), (0, 12), "opaque and masked surfaces of light 1 alone: {ran:?}");
    assert!(!ran.iter().any(|name| name == "gbuffer"), "{ran:?}");
}

#[test]
fn exposure_runs_tone_mapping_alone() {
    let mut harness = settled(&PBR);
    Case { sets: &[("exposure", "1.5")], ..PBR }.compile(|input| harness.replan(input)).unwrap();
    assert_eq!(harness.frame(), ["display.expose"]);
    assert!(harness.explain(Some("display.expose")).contains("it has not run as it is"));
}

#[test]
fn a_resize_leaves_what_does_not_depend_on_the_size() {
    let mut harness = settled(&PBR);
    Case { size: [80, 48], ..PBR }.compile(|input| harness.replan(input)).unwrap();
    let ran = harness.frame();
    assert!(ran.iter().any(|name| name == "gbuffer"), "{ran:?}");
    assert!(!ran.iter().any(|name| name.starts_with("point_shadows.")), "{ran:?}");
}

#[test]
fn another_output_runs_what_it_alone_needs() {
    let mut harness = settled(&PBR);
    Case { outputs: &["color", "normal"], ..PBR }.compile(|input| harness.replan(input)).unwrap();
    let ran = harness.frame();
    assert!(ran.iter().any(|name| name == "inspect"), "{ran:?}");
    assert!(!ran.iter().any(|name| name.starts_with("point_shadows.") || name == "display.expose"), "{ran:?}");
}

#[test]
fn a_camera_that_turns_draws_the_same_sky() {
    let mut harness = settled(&SKY);
    assert!(harness.change_table("camera") > 0);
    assert_eq!(harness.frame(), ["draw", "display.expose"]);
}

#[test]
fn a_sun_that_turns_leaves_what_the_air_alone_decides() {
    let mut harness = settled(&SKY);
    assert!(harness.change_table("directional_lights") > 0);
    assert_eq!(harness.frame(), ["sky.look", "sky.gather", "draw", "display.expose"]);
    Case { sets: &[("ground_albedo", "0.6,0.6,0.6")], ..SKY }.compile(|input| harness.replan(input)).unwrap();
    assert_eq!(harness.frame(), ["sky.scatter", "sky.look", "sky.gather", "draw", "display.expose"]);
}

#[test]
fn a_lost_device_runs_everything() {
    let mut harness = settled(&PBR);
    let all: Vec<String> = harness.order().into_iter().map(str::to_owned).collect();
    harness.lose_device();
    assert_eq!(harness.frame(), all);
}

/// The next sample runs what a shift of the image reaches, and no shadow map.
#[test]
fn a_sample_draws_no_shadow_map() {
    let case = Case { sets: &[("samples", "4")], ..PBR };
    let mut harness = case.compile(Harness::new).unwrap_or_else(|problems| panic!("{problems}"));
    assert!(harness.frame().iter().any(|name| name.contains("shadow")));
    for _ in 1..4 {
        let ran = harness.frame();
        assert!(ran.iter().any(|name| name == "gbuffer") && !ran.iter().any(|name| name.contains("shadow")), "{ran:?}");
    }
    harness.settle(2);
    assert!(harness.frame().is_empty(), "all samples are gathered");
}

/// More lights than lists of this device hold are an error that names the list and what decides its size.
#[test]
fn too_many_lights_have_a_message() {
    let counts: SceneCounts = schema().counts.into_iter().map(|name| (name, 20_000_000)).collect();
    let outputs = ["color".to_owned()];
    let input = CompileInput {
        pipeline: "pipelines/pbr.ron",
        files: &DiskFiles::for_pipeline(Path::new("pipelines/pbr.ron")),
        published: &schema(),
        counts: &counts,
        device: &DeviceFacts::webgpu_defaults(),
        output: [1920, 1080],
        sets: &[],
        outputs: Some(&outputs),
    };
    let Err(problems) = Harness::new(&input) else { panic!("20 million lights fit") };
    assert!(problems.contains("light_volumes.lists") && problems.contains("light_tiles.lists"), "{problems}");
}

/// A sun that moves: the sky's tables that know it, its own maps, and what they light. No other map, and not the surfaces.
#[test]
fn a_day_runs_sky_sun_shadows_and_lighting() {
    let case = Case { sets: &[("sky", "physical")], ..PBR };
    let mut harness = settled(&case);
    harness.change(|input| match input {
        Input::Table(name, _) => name == "directional_lights" || name == "cascades",
        Input::View(view) => matches!(view.kind, ViewKind::Cascade(..)),
        _ => false,
    });
    let ran = harness.frame();
    let rest: Vec<&String> = ran.iter().filter(|name| !name.starts_with("sun_shadows.")).collect();
    assert!(rest.len() < ran.len(), "the sun's maps are drawn: {ran:?}");
    assert_eq!(rest, ["air.look", "air.gather", "light", "physical_sky", "compose", "transparent", "display.expose"]);
}
