//! Sequences of images: each frame as it is alone, interrupted ones completed by the same command, and wrong ranges explained.

#[path = "support/mod.rs"]
mod support;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::Duration;

use libtest_mimic::{Arguments, Failed, Trial};
use luminaire::passes::Adapter;
use support::gltf::Gltf;
use support::program::{done, luminaire, refused, run};
use support::trial;

const PBR: &str = "pipelines/pbr.ron";
const CORNELL: &str = "scenes/cornell.ron";
/// Small pictures, quickly.
const SMALL: [&str; 6] = ["--size", "32x32", "--set", "sun_shadow_texels=64", "--set", "local_shadow_texels=64"];

fn text(path: &Path) -> Result<&str, Failed> {
    path.to_str().ok_or_else(|| "a path".into())
}

/// The files of a folder with their bytes, hidden ones too.
fn files(folder: &Path) -> Result<BTreeMap<String, Vec<u8>>, Failed> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(folder)?.flatten() {
        found.insert(entry.file_name().to_string_lossy().into_owned(), std::fs::read(entry.path())?);
    }
    Ok(found)
}

fn same(what: &str, found: &BTreeMap<String, Vec<u8>>, expected: &BTreeMap<String, Vec<u8>>) -> Result<(), Failed> {
    let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    if names(found) != names(expected) {
        return Err(format!("{what}: {:?} and not {:?}", names(found), names(expected)).into());
    }
    match found.iter().find(|(name, bytes)| expected[*name] != **bytes) {
        Some((name, _)) => Err(format!("{what}: `{name}` differs").into()),
        None => Ok(()),
    }
}

fn json(path: &Path) -> Result<serde_json::Value, Failed> {
    Ok(serde_json::from_slice(&std::fs::read(path)?)?)
}

/// A square that an animation moves, a floor, and lights that come and go: frames of one second each differ.
fn moving(folder: &Path) -> Result<PathBuf, Failed> {
    let mut gltf = Gltf::default();
    let red = gltf.material(serde_json::json!({ "pbrMetallicRoughness": { "baseColorFactor": [0.8, 0.1, 0.1, 1.0] } }));
    gltf.quad(red, None);
    gltf.node(serde_json::json!({ "mesh": 0, "name": "square" }));
    gltf.slide(&[0.0, 4.0], &[[-1.0, 1.0, 0.0], [1.0, 1.0, 0.0]]);
    std::fs::write(folder.join("square.gltf"), gltf.text())?;
    let text = "(
        cameras: { \"main\": (position: (0, 1.5, 5), target: (0, 0.8, 0)), \"side\": (position: (4, 2, 3), target: (0, 0.8, 0)) },
        lights: { \"lamp\": Point(candela: 4, position: (-2, 2.5, 1)) },
        objects: { \"floor\": (shape: Plane(size: (8, 8)), surface: (base_color: (0.5, 0.5, 0.5))) },
        files: { \"square\": (path: \"square.gltf\") },
        timeline: [
            (at: 0.5, do: Spawn(lights: { \"second\": Point(candela: 6, position: (2, 2, 2)), \"third\": Point(candela: 2, position: (0, 3, 1)) })),
            (at: 1.5, do: Remove(node: \"second\")),
            (at: 1.5, do: Spawn(lights: { \"sun\": Directional(lux: 2, direction: (-1, -2, -1)) })),
            (at: 2.5, do: Remove(node: \"third\")),
        ],
    )";
    std::fs::write(folder.join("moving.ron"), text)?;
    Ok(folder.join("moving.ron"))
}

/// Frame n has the bytes of the image of its time, whatever came before; the folder is made, and the statistics tell of each frame.
/// Lights that come and go change the plan on the way.
fn frames_as_alone() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let moving = moving(folder.path())?;
    let stats = folder.path().join("stats.json");
    for (extension, scene, range, more) in [
        ("png", text(&moving)?, 0..=4, &[][..]),
        ("exr", text(&moving)?, 1..=3, &["--camera", "side"]),
        ("jump.png", "scenes/spawned.ron", 2..=3, &[]),
    ] {
        let frames = folder.path().join("made/for").join(extension);
        let pattern = frames.join(format!("f%03d.{extension}"));
        let fixed = ["render", PBR, "--scene", scene, "-o"];
        let selection = format!("{}..={}", range.start(), range.end());
        let sequence = ["--frames", &selection, "--fps", "1", "--stats", text(&stats)?];
        done(&[&fixed[..], &[text(&pattern)?], &SMALL, more, &sequence].concat())?;
        let found = files(&frames)?;
        let alone = folder.path().join(format!("alone.{extension}"));
        let mut expected = BTreeMap::new();
        for frame in range.clone() {
            done(&[&fixed[..], &[text(&alone)?], &SMALL, more, &["--time", &frame.to_string()]].concat())?;
            expected.insert(format!("f{frame:03}.{extension}"), std::fs::read(&alone)?);
        }
        same(extension, &found, &expected)?;
        let distinct: BTreeSet<&Vec<u8>> = found.values().collect();
        if distinct.len() != found.len() {
            return Err(format!("{scene}: some of {selection} are equal, so that nothing was compared").into());
        }
        let stats = json(&stats)?;
        let told: Vec<_> = stats["frames"].as_array().into_iter().flatten().map(|f| (f["frame"].as_u64(), f["time"].as_f64())).collect();
        let expected: Vec<_> = range.map(|frame| (Some(frame), Some(frame as f64))).collect();
        if told != expected || stats["carries_over"] != false {
            return Err(format!("the statistics say {stats}").into());
        }
    }
    Ok(())
}

/// What is missing of a sequence can be completed where time can't go back, too: things that came and went are there again.
fn moving_and_completed() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let moving = moving(folder.path())?;
    let frames = folder.path().join("frames");
    let pattern = frames.join("%d.png");
    let command =
        [&["render", PBR, "--scene", text(&moving)?, "-o", text(&pattern)?, "--frames", "0..5", "--fps", "1"][..], &SMALL].concat();
    done(&command)?;
    let whole = files(&frames)?;
    for missing in ["0.png", "2.png", "3.png"] {
        std::fs::remove_file(frames.join(missing))?;
    }
    done(&command)?;
    same("completed", &files(&frames)?, &whole)
}

/// A pipeline that adds 0.2 to its picture each time that it runs, in `folder`.
fn fade(folder: &Path, run: &str) -> Result<PathBuf, Failed> {
    let text = format!(
        "(doc: \"Adds to itself.\", resources: {{\"color\": Texture(format: \"rgba8unorm\", history: (first: Zero))}}, passes: {{\"add\": \
         Fullscreen(shader: \"add.wgsl\", run: {run}, read: {{\"old\": \"previous(color)\"}}, write: {{\"color\": \"color\"}})}}, outputs: \
         {{\"color\": \"color\"}})"
    );
    let shader = "var old: texture_2d<f32>;\nstruct Targets { color: vec4<f32> }\n@fragment fn add(@builtin(position) place: vec4<f32>) -> \
                  Targets { return Targets(textureLoad(old, vec2<i32>(place.xy), 0) + 0.2); }\n";
    std::fs::write(folder.join("add.wgsl"), shader)?;
    std::fs::write(folder.join("fade.ron"), text)?;
    Ok(folder.join("fade.ron"))
}

/// Where a pass runs in every frame, each frame runs once, behind `--warm-up` of them; and to complete a sequence runs it again.
fn frames_that_gather() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let pipeline = fade(folder.path(), "EveryFrame")?;
    let pattern = folder.path().join("out/%d.png");
    let stats = folder.path().join("stats.json");
    let fixed = ["render", text(&pipeline)?, "--scene", CORNELL, "-o", text(&pattern)?, "--size", "4x4", "--stats", text(&stats)?];
    let render = |more: &[&str]| done(&[&fixed[..], more].concat());
    let values = || -> Result<Vec<(String, u8)>, Failed> {
        let mut found = Vec::new();
        for (name, bytes) in files(&folder.path().join("out"))? {
            found.push((name, image::load_from_memory(&bytes)?.into_rgba8().get_pixel(1, 1).0[0]));
        }
        Ok(found)
    };
    let expect = |what: &str, expected: &[(&str, u8)]| -> Result<(), Failed> {
        let found = values()?;
        let expected: Vec<(String, u8)> = expected.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
        if found == expected { Ok(()) } else { Err(format!("{what}: {found:?} and not {expected:?}").into()) }
    };
    // 0.2, 0.4, 0.6 and 0.8 as sRGB.
    render(&["--frames", "0..3"])?;
    expect("from the first frame", &[("0.png", 124), ("1.png", 170), ("2.png", 203)])?;
    render(&["--frames", "0..3", "--overwrite", "--warm-up", "2"])?;
    expect("after two frames", &[("0.png", 203), ("1.png", 231), ("2.png", 255)])?;

    // What exists is not written, and what is missing comes after the same frames as before.
    render(&["--frames", "0..3", "--overwrite"])?;
    std::fs::write(folder.path().join("out/1.png"), std::fs::read(folder.path().join("out/0.png"))?)?;
    std::fs::remove_file(folder.path().join("out/2.png"))?;
    render(&["--frames", "0..3"])?;
    expect("completed", &[("0.png", 124), ("1.png", 124), ("2.png", 203)])?;
    let stats = json(&stats)?;
    let written: Vec<bool> = stats["frames"].as_array().into_iter().flatten().map(|frame| frame["file"].is_string()).collect();
    if written != [false, false, true] || stats["carries_over"] != true {
        return Err(format!("the statistics say {stats}").into());
    }

    // What gathers and comes to an end does so in each frame.
    fade(folder.path(), "Accumulate(4)")?;
    render(&["--frames", "0..3", "--overwrite"])?;
    expect("gathered", &[("0.png", 231), ("1.png", 231), ("2.png", 231)])
}

/// What exists stays, unless all is to be rendered anew; what a killed program left half-written goes.
fn completed_by_the_same_command() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let frames = folder.path().join("frames");
    let pattern = frames.join("%02d.png");
    let command = [&["render", PBR, "--scene", CORNELL, "-o", text(&pattern)?, "--frames", "0..4"][..], &SMALL].concat();
    done(&command)?;
    let whole = files(&frames)?;
    std::fs::remove_file(frames.join("01.png"))?;
    std::fs::write(frames.join(".luminaire-k1LLed"), &whole["01.png"][..20])?;
    std::fs::write(frames.join("02.png"), b"mine")?;
    done(&command)?;
    let mut expected = whole.clone();
    expected.insert("02.png".to_owned(), b"mine".to_vec());
    same("completed", &files(&frames)?, &expected)?;
    done(&[&command[..], &["--overwrite"]].concat())?;
    same("rendered anew", &files(&frames)?, &whole)
}

/// A program that is killed leaves whole frames alone, and the same command ends with what an undisturbed one makes.
fn killed_and_completed() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let (undisturbed, frames) = (folder.path().join("undisturbed"), folder.path().join("killed"));
    let (pattern, pattern_of_killed) = (undisturbed.join("%03d.png"), frames.join("%03d.png"));
    let fixed = [&["render", PBR, "--scene", CORNELL, "--frames", "0..40"][..], &SMALL].concat();
    done(&[&fixed[..], &["-o", text(&pattern)?]].concat())?;
    let expected = files(&undisturbed)?;
    let command = [&fixed[..], &["-o", text(&pattern_of_killed)?]].concat();
    let mut child = luminaire(&command).spawn()?;
    while child.try_wait()?.is_none() && !frames.join("002.png").exists() {
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill()?;
    child.wait()?;
    let left: BTreeMap<_, _> = files(&frames)?.into_iter().filter(|(name, _)| !name.starts_with('.')).collect();
    let whole = expected.iter().filter(|(name, _)| left.contains_key(*name)).map(|(name, bytes)| (name.clone(), bytes.clone())).collect();
    same("after the kill", &left, &whole)?;
    done(&command)?;
    same("completed", &files(&frames)?, &expected)
}

/// What does not belong together is said at once, before anything is loaded or made.
fn wrong_requests() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let path = |name: &str| folder.path().join(name).to_str().map(str::to_owned).ok_or("a path");
    let (one, many) = (path("new/a.png")?, path("new/%04d.png")?);
    let (plain, field) = (path("a.png")?, path("%04d.png")?);
    let (twice, space, inner) = (path("%d-%d.png")?, path("%4d.png")?, path("%04d/a.png")?);
    let (first, bmp) = (path("0000.png")?, path("%04d.bmp")?);
    let cases: &[(&[&str], &[&str])] = &[
        (&["-o", &one, "--frames", "0..3"], &["output::no-field", "is the path of one image", "frames/%04d.png"]),
        (&["-o", &inner, "--frames", "0..3"], &["output::no-field", "stands in a folder"]),
        (&["-o", &twice, "--frames", "0..3"], &["output::several-fields"]),
        (&["-o", &space, "--frames", "0..3"], &["output::bad-field", "`%4d`", "%04d"]),
        (&["-o", &bmp, "--frames", "0..3", "--time", "1"], &["output::format", "render::time-of-sequence"]),
        (&["-o", "Cargo.toml/x/%d.png", "--frames", "0..3"], &["output::write", "`Cargo.toml` is no folder"]),
        (&["-o", "/proc/x/%d.png", "--frames", "0..3"], &["output::write", "/proc"]),
        (&["-o", &field], &["output::field-without-range", "--frames 0..120"]),
        (&["-o", &field, "--frames", "3"], &["output::field-without-range"]),
        (
            &["-o", &plain, "--fps", "24", "--overwrite", "--warm-up", "2"],
            &["render::no-sequence", "`--fps`", "`--overwrite`", "`--warm-up`"],
        ),
        (&["-o", &field, "--frames", "0..3", "--stats", &first], &["output::same-path"]),
        (&["-o", &plain, "--time", "nan"], &["world::bad-time"]),
        (&["-o", &many, "--frames", "5..6", "--fps", "1e-308"], &["world::bad-time"]),
    ];
    for (more, expected) in cases {
        refused(&[&["render", PBR, "--scene", CORNELL, "--size", "8x8"][..], more].concat(), expected, folder.path())?;
    }
    Ok(())
}

/// Ranges that are none are wrong usage, and the message says what is meant.
fn wrong_ranges() -> Result<(), Failed> {
    let cases: &[(&[&str], &str)] = &[
        (&["--frames", "5..3"], "did you mean 3..5?"),
        (&["--frames", ".."], "a range needs its first frame and its end"),
        (&["--frames", "7..7"], "7..=7 is frame 7 alone"),
        (&["--frames", "0"], "at least one frame"),
        (&["--frames", "-3..5"], "`-3` is no whole number"),
        (&["--frames", "0..99999999999"], "99999999999 is more than 4294967295"),
        (&["--frames", "0..4294967295"], "4294967295 frames are more than the 1000000 of a sequence"),
        (&["--frames", "0..3", "--fps", "0"], "greater than zero"),
        (&["--frames", "0..3", "--fps", "-24"], "greater than zero"),
        (&["--frames", "0..3", "--fps", "inf"], "greater than zero"),
        (&["--frames", "0..3", "--warm-up", "-1"], "--warm-up"),
    ];
    for (more, expected) in cases {
        let output = run(&[&["render", PBR, "--scene", CORNELL, "-o", "/nonexistent/%d.png"][..], more].concat())?;
        let errors = String::from_utf8_lossy(&output.stderr);
        if output.status.code() != Some(2) || !errors.contains(expected) {
            return Err(format!("{more:?} ended with {:?}: {errors}", output.status.code()).into());
        }
    }
    Ok(())
}

fn main() {
    let arguments = Arguments::from_args();
    let adapter = Adapter::choose(None).is_err().then_some("a Vulkan adapter");
    let trials: Vec<Trial> = vec![
        trial("a frame has the bytes that it has alone", adapter, frames_as_alone),
        trial("a moving scene is completed", adapter, moving_and_completed),
        trial("frames that gather run once each", adapter, frames_that_gather),
        trial("what is missing is completed", adapter, completed_by_the_same_command),
        trial("a killed sequence is completed", adapter, killed_and_completed),
        trial("wrong requests are refused", None, wrong_requests),
        trial("wrong ranges are explained", None, wrong_ranges),
    ];
    libtest_mimic::run(&arguments, trials).exit();
}
