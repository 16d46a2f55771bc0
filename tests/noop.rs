//! Every shipped pipeline on wgpu's device that runs nothing, with only the features that it declares: under WebGPU's default
//! limits, and under those of Mesa's software driver. No driver is needed.

use luminaire::files::{embedded_pipelines, embedded_scenes};
use luminaire::graph::device::DeviceFacts;
use luminaire::graph::diagnostic::render;
use luminaire::graph::source::SourceMap;
use luminaire::passes::{Adapter, facts};
use luminaire::scenes::scene_file::load_scene_text;
use luminaire::session::{RenderRequest, Session, load_scene};

/// A lamp that moves for a long time leaves nothing behind.
#[test]
fn a_long_run_creates_nothing() {
    let scene = |x: f64| {
        format!(
            "(cameras: {{ \"eye\": (position: (0, 1, 4), target: (0, 0, 0)) }},
            lights: {{ \"lamp\": Point(candela: 3, position: ({x}, 1.5, 1)) }},
            objects: {{ \"ball\": (shape: Sphere(radius: 0.6), surface: (roughness: 0.5)) }})"
        )
    };
    let world = |x: f64| {
        let mut sources = SourceMap::default();
        load_scene_text("moving.ron", &scene(x), &mut sources).expect("the scene is right").world
    };
    let mut worlds = [world(0.5), world(0.6)];
    let adapter = Adapter::noop(&DeviceFacts::webgpu_defaults()).expect("the noop adapter needs no driver");
    let request = RenderRequest {
        pipeline: "pipelines/pbr.ron",
        size: [64, 48],
        camera: None,
        sets: &[],
        outputs: None,
        timing: false,
        memory_budget: None,
    };
    let mut session = Session::on(&adapter, &mut worlds[0], &request).expect("a session");
    let mut frame = |index: usize| {
        session.update(&mut worlds[index % 2]).expect("an update");
        session.render_frame().expect("a frame")
    };
    let first = (0..3).map(&mut frame).last().expect("a frame");
    for index in 3..10_000 {
        let next = frame(index);
        assert!(next.counts.steps > 0 && next.counts.submissions == 1);
        assert_eq!(next.created, first.created, "frame {index}");
    }
}

#[test]
fn shipped_pipelines_are_valid() {
    let mut failures = Vec::new();
    for facts in [DeviceFacts::webgpu_defaults(), facts::lavapipe()] {
        for pipeline in embedded_pipelines() {
            for scene in embedded_scenes() {
                let adapter = Adapter::noop(&facts).expect("the noop adapter needs no driver");
                let mut loaded = load_scene(&scene, None).expect("shipped scenes load");
                let request = RenderRequest {
                    pipeline: &pipeline,
                    size: [64, 48],
                    camera: None,
                    sets: &[],
                    outputs: None,
                    timing: false,
                    memory_budget: None,
                };
                let rendered = Session::on(&adapter, &mut loaded.world, &request).and_then(|mut session| {
                    let problems = session.warnings.clone();
                    session.render_frame()?;
                    if problems.0.is_empty() { Ok(()) } else { Err(problems) }
                });
                if let Err((problems, sources)) = rendered {
                    failures.push(format!("{pipeline} with {scene} under {}:\n{}", facts.name, render(&problems, &sources, false)));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
