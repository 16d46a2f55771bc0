//! Every shipped pipeline on wgpu's device that runs nothing, with only the features that it declares: under WebGPU's default
//! limits, and under those of Mesa's software driver. No driver is needed.

use luminaire::files::{embedded_pipelines, embedded_scenes};
use luminaire::graph::device::DeviceFacts;
use luminaire::graph::diagnostic::render;
use luminaire::passes::{Adapter, facts};
use luminaire::session::{RenderRequest, Session, load_scene};

/// Also where nothing would run.
#[test]
fn a_lost_device_is_replaced() {
    let adapter = Adapter::noop(&DeviceFacts::webgpu_defaults()).expect("the noop adapter needs no driver");
    let mut loaded = load_scene("scenes/cornell.ron", None).expect("shipped scenes load");
    let request = RenderRequest {
        pipeline: "pipelines/pbr.ron",
        size: [64, 48],
        camera: None,
        sets: &[],
        outputs: None,
        timing: false,
        memory_budget: None,
    };
    let mut session = Session::on(&adapter, &mut loaded.world, &request).expect("a session");
    let first = session.render_frame().expect("a frame");
    assert!(session.render_frame().expect("a frame").settled);
    for losses in 1..4 {
        session.gpu().device().destroy();
        let stats = session.render_frame().expect("a frame on another device");
        assert_eq!((session.recoveries(), stats.counts), (losses, first.counts));
        assert!(session.render_frame().expect("a frame").settled);
        let devices = adapter.objects().into_iter().find(|(kind, _)| *kind == "devices");
        assert_eq!(devices, Some(("devices", 1)), "the lost device is forgotten");
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
