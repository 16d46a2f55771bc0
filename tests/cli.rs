//! The program as users run it: exit status, messages, and files that are written whole or not at all.

#[path = "support/mod.rs"]
mod support;

use std::path::Path;
use std::process::{Command, Output};

use libtest_mimic::{Arguments, Failed, Trial};
use luminaire::passes::Adapter;
use support::{shared, trial};

fn luminaire(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_luminaire"));
    command.args(arguments).current_dir(env!("CARGO_MANIFEST_DIR"));
    command
}

fn run(arguments: &[&str]) -> Result<Output, Failed> {
    let output = luminaire(arguments).output()?;
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    if errors.contains("panicked") || output.status.code().is_none() {
        return Err(format!("{arguments:?} panicked or was killed:\n{errors}").into());
    }
    Ok(output)
}

/// Runs a command that must fail with status 1 and a message that holds each of `expected`, and must leave `folder` empty.
fn refused(arguments: &[&str], expected: &[&str], folder: &Path) -> Result<(), Failed> {
    let output = run(arguments)?;
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    if output.status.code() != Some(1) {
        return Err(format!("{arguments:?} ended with {:?}:\n{errors}", output.status.code()).into());
    }
    for text in expected {
        if !errors.contains(text) {
            return Err(format!("{arguments:?} does not say `{text}`:\n{errors}").into());
        }
    }
    if errors.contains('\u{1b}') {
        return Err("colours without a terminal".into());
    }
    let left: Vec<_> = std::fs::read_dir(folder)?.flatten().map(|entry| entry.file_name()).collect();
    if left.is_empty() { Ok(()) } else { Err(format!("{arguments:?} left {left:?}").into()) }
}

fn bad_input() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let out = folder.path().join("out.png");
    let out = out.to_str().ok_or("a path")?;
    let scene = "scenes/cornell.ron";
    let pbr = "pipelines/pbr.ron";
    let small = ["--size", "32x32"];
    let render = |pipeline: &'static str, scene: &'static str, more: &[&'static str]| -> Vec<String> {
        let fixed = ["render", pipeline, "--scene", scene, "-o", out];
        fixed.iter().chain(&small).chain(more).map(|text| (*text).to_owned()).collect()
    };
    let cases: Vec<(Vec<String>, &[&str])> = vec![
        (render("pipelines/pbrr.ron", scene, &[]), &["compile::missing-file", "pipelines/pbr.ron"]),
        (render(pbr, "scenes/none.gltf", &[]), &["scenes/none.gltf"]),
        (render(pbr, scene, &["--set", "tone_mapping=acse"]), &["expand::bad-set", "`aces`"]),
        (render(pbr, scene, &["--set", "exposur=1"]), &["expand::unknown-param", "did you mean `exposure`?"]),
        (render(pbr, scene, &["--set", "sun_shadow_texels=1"]), &["expand::bad-set", "16 to 8192"]),
        (render(pbr, scene, &["--output", "colour"]), &["expand::unknown-output", "did you mean `color`?"]),
        (render(pbr, scene, &["--camera", "nobody"]), &["nobody"]),
        (render(pbr, scene, &["--size", "0x10"]), &["expand::size-zero"]),
        (render(pbr, scene, &["--size", "70000x10"]), &["expand::size-over-limit"]),
        (render(pbr, scene, &["--memory-budget", "1"]), &["budget"]),
        (render("pipelines/albedo.ron", scene, &["--output", "radiance"]), &["expand::unknown-output"]),
    ];
    for (arguments, expected) in &cases {
        // The last of two equal options wins.
        let mut arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        if arguments.iter().filter(|argument| **argument == "--size").count() > 1 {
            arguments.drain(6..8);
        }
        refused(&arguments, expected, folder.path())?;
    }
    let elsewhere = ["render", pbr, "--scene", scene, "-o"];
    let with = |path: &'static str| elsewhere.iter().copied().chain([path]).collect::<Vec<_>>();
    refused(&with("/nonexistent/out.png"), &["output::write", "/nonexistent/out.png"], folder.path())?;
    refused(&with("out.bmp"), &["output::format", ".png"], folder.path())?;
    Ok(())
}

fn no_adapter() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let out = folder.path().join("out.png");
    let out = out.to_str().ok_or("a path")?;
    let arguments = ["render", "pipelines/pbr.ron", "--scene", "scenes/cornell.ron", "-o", out];
    let nowhere = folder.path().join("none.json");
    let output = luminaire(&arguments).env("VK_ICD_FILENAMES", &nowhere).env("VK_DRIVER_FILES", &nowhere).output()?;
    let errors = String::from_utf8_lossy(&output.stderr);
    if output.status.code() == Some(1)
        && errors.contains("device::no-adapter")
        && errors.contains("mesa-vulkan-drivers")
        && !Path::new(out).exists()
    {
        return Ok(());
    }
    Err(format!("{:?}: {errors}", output.status.code()).into())
}

fn check_and_plan() -> Result<(), Failed> {
    let output = run(&[
        "check",
        "pipelines/albedo.ron",
        "pipelines/pbr.ron",
        "scenes/cornell.ron",
        "scenes/materials.ron",
        "shaders/pbr/light.wgsl",
    ])?;
    if output.status.code() != Some(0) {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
    }
    for format in ["text", "json", "dot"] {
        let output = run(&["plan", "pipelines/pbr.ron", "--format", format])?;
        if output.status.code() != Some(0) || output.stdout.is_empty() {
            return Err(format!("plan --format {format}: {}", String::from_utf8_lossy(&output.stderr)).into());
        }
        if format == "json" {
            serde_json::from_slice::<serde_json::Value>(&output.stdout)?;
        }
    }
    let help = run(&["render", "--help"])?;
    if help.status.code() == Some(0) { Ok(()) } else { Err("--help fails".into()) }
}

/// The same command twice gives the same bytes, also in the statistics' counts.
fn same_bytes_twice() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let mut images = Vec::new();
    for name in ["a.exr", "b.exr"] {
        let out = folder.path().join(name);
        let stats = folder.path().join("stats.json");
        let (out, stats) = (out.to_str().ok_or("a path")?, stats.to_str().ok_or("a path")?);
        let output =
            run(&["render", "pipelines/pbr.ron", "--scene", "scenes/materials.ron", "-o", out, "--size", "128x72", "--stats", stats])?;
        if output.status.code() != Some(0) {
            return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
        }
        images.push(std::fs::read(out)?);
        let stats: serde_json::Value = serde_json::from_slice(&std::fs::read(stats)?)?;
        if stats["counts"]["draw_calls"].as_u64().is_none_or(|calls| calls == 0) {
            return Err(format!("no draw calls in {stats}").into());
        }
    }
    if images[0] == images[1] { Ok(()) } else { Err("two runs gave different bytes".into()) }
}

/// Broken models are refused with a message, and what is valid loads: `check` needs no GPU.
fn broken_models() -> Result<(), Failed> {
    let assets = shared().ok_or("the reference data is missing")?.join("assets");
    let mut failures = Vec::new();
    for folder in ["malformed", "unsupported"] {
        for entry in std::fs::read_dir(assets.join(folder))?.flatten() {
            let path = entry.path();
            if !path.extension().is_some_and(|extension| extension == "gltf" || extension == "glb") {
                continue;
            }
            let shown = path.display().to_string();
            let output = run(&["check", &shown])?;
            if output.status.code() == Some(1) && output.stderr.is_empty() {
                failures.push(format!("{shown}: refused without a message"));
            }
        }
    }
    if failures.is_empty() { Ok(()) } else { Err(failures.join("\n").into()) }
}

fn main() {
    let arguments = Arguments::from_args();
    let adapter = Adapter::choose(None).is_err().then_some("a Vulkan adapter");
    let data = shared().is_none().then_some("the reference data");
    let trials: Vec<Trial> = vec![
        trial("bad input is refused", adapter, bad_input),
        trial("a missing adapter is explained", None, no_adapter),
        trial("check and plan need no adapter", None, check_and_plan),
        trial("the same command gives the same bytes", adapter, same_bytes_twice),
        trial("broken models are refused", data, broken_models),
    ];
    libtest_mimic::run(&arguments, trials).exit();
}
