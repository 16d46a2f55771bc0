//! What a long run leaves behind: nothing. Objects are counted by wgpu, memory by the operating system and the device's allocator.
//!
//! One test after the other, since memory is the whole process's. Without a Vulkan adapter the test that needs one says 'ignored'.

#![allow(clippy::print_stdout, clippy::panic, clippy::expect_used, reason = "a test says what it measured, and may panic")]

mod support;

use libtest_mimic::{Arguments, Failed};
use luminaire::graph::device::DeviceFacts;
use luminaire::passes::Adapter;
use luminaire::scenes::World;
use luminaire::session::Session;

use support::picture::{PBR, Shot, shown, world};

/// What the allocator of the process may keep for itself.
const SLACK: u64 = 1 << 20;

fn main() {
    let arguments = Arguments { test_threads: Some(1), ..Arguments::from_args() };
    let missing = if support::picture::adapter().is_some() { None } else { Some("a Vulkan adapter") };
    let trials = vec![
        support::trial("a lamp that moves for 300 frames", missing, moves_on_a_device),
        support::trial("a lamp that moves for 10,000 frames, without a driver", None, moves_on_noop),
        support::trial("1,000 sizes, without a driver", None, resizes),
    ];
    libtest_mimic::run(&arguments, trials).exit();
}

/// Bytes of the process that are in memory; 0 where the system does not say.
fn resident() -> u64 {
    let statm = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    statm.split_whitespace().nth(1).and_then(|pages| pages.parse::<u64>().ok()).unwrap_or(0) * 4096
}

fn noop() -> Result<Adapter, Failed> {
    Adapter::noop(&DeviceFacts::webgpu_defaults()).map_err(|problems| format!("{problems:?}").into())
}

fn lamp(x: f64) -> Result<World, Failed> {
    world(&format!(
        "(cameras: {{ \"eye\": (position: (0, 1, 4), target: (0, 0, 0)) }},
        lights: {{ \"lamp\": Point(candela: 3, position: ({x}, 1.5, 1)) }},
        objects: {{ \"ball\": (shape: Sphere(radius: 0.6), surface: (roughness: 0.5)) }})"
    ))
}

/// A lamp between two places, frame by frame: what stands after a tenth of the frames stands at the end.
fn moves(adapter: &Adapter, frames: usize) -> Result<(), Failed> {
    let shot = Shot::pbr(32, &["color"]);
    let mut worlds = [lamp(0.5)?, lamp(0.6)?];
    let mut session = Session::on(adapter, &mut worlds[0], &shot.request()).map_err(shown)?;
    let mut before = None;
    for index in 0..frames {
        session.update(&mut worlds[index % 2]).map_err(shown)?;
        let stats = session.render_frame().map_err(shown)?;
        if stats.counts.steps == 0 || stats.counts.submissions != 1 {
            return Err(format!("frame {index}: {stats:?}").into());
        }
        if index % 10 == 9 {
            // As those do who look at the result; else frames pile up.
            session.read_output("color").map_err(shown)?;
        }
        if index == frames / 10 || index == frames - 1 {
            session.read_output("color").map_err(shown)?;
            let now = (stats.created, adapter.objects(), session.gpu().allocated_bytes(), resident());
            let (created, counted, allocated, bytes) = before.get_or_insert_with(|| now.clone()).clone();
            if (now.0, &now.1, now.2) != (created, &counted, allocated) || now.3 > bytes + SLACK {
                return Err(format!("frame {index}: {now:?}, and at first {before:?}").into());
            }
            println!("frame {index}: {} KiB resident, {:?} bytes allocated", now.3 >> 10, now.2);
        }
    }
    Ok(())
}

fn moves_on_a_device() -> Result<(), Failed> {
    moves(&Adapter::choose(None).map_err(|problems| format!("{problems:?}"))?, 300)
}

fn moves_on_noop() -> Result<(), Failed> {
    moves(&noop()?, 10_000)
}

/// Sizes that were never there before, and a frame or two of each: what stands at the end is no more than after the first tenth.
fn resizes() -> Result<(), Failed> {
    for (pipeline, outputs) in [(PBR, vec!["color", "normal"]), ("tests/fixtures/runs/growth.ron", vec!["color"])] {
        let adapter = noop()?;
        let shot = Shot::of(pipeline, [64, 64], &outputs);
        let mut scene = lamp(0.5)?;
        let mut session = Session::on(&adapter, &mut scene, &shot.request()).map_err(shown)?;
        let mut random = 1u64;
        let mut next = |most: u64| {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (random >> 33) % most
        };
        let mut before: Option<(Vec<(&str, usize)>, u64)> = None;
        for index in 0..1000 {
            // Of equally many levels.
            let size = [128 + next(128) as u32, 128 + next(128) as u32];
            session.reload(&mut scene, &Shot { size, ..shot.clone() }.request()).map_err(shown)?;
            for _ in 0..=next(2) {
                session.render_frame().map_err(shown)?;
            }
            if index == 100 || index == 999 {
                session.read_output(outputs[0]).map_err(shown)?;
                let now = (adapter.objects(), resident());
                let (counted, bytes) = before.get_or_insert_with(|| now.clone()).clone();
                let more = now.0.iter().zip(&counted).any(|((_, now), (_, before))| now > before);
                if more || now.1 > bytes + SLACK {
                    return Err(format!("{pipeline}, size {index}: {now:?}, and at first {before:?}").into());
                }
                println!("{pipeline}, size {index}: {} KiB resident, {:?}", now.1 >> 10, now.0);
            }
        }
    }
    Ok(())
}
