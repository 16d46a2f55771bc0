//! The program as users run it: exit status, messages, and files that are written whole or not at all.

#[path = "support/mod.rs"]
mod support;

use std::path::Path;

use libtest_mimic::{Arguments, Failed, Trial};
use luminaire::passes::Adapter;
use support::program::{done, luminaire, refused, run};
use support::{shared, trial};

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
        (render("pipelines/pbrr.ron", scene, &[]), &["load::missing-file", "pipelines/pbr.ron"]),
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
    refused(&with("/proc/out.png"), &["output::write", "the folder `/proc` takes no file"], folder.path())?;
    refused(&with("Cargo.toml/out.png"), &["output::write", "`Cargo.toml` is no folder"], folder.path())?;
    let same: Vec<&str> = with("same.png").into_iter().chain(["--stats", "same.png"]).collect();
    refused(&same, &["output::same-path", "same.png"], folder.path())?;
    Ok(())
}

/// What is wrong with a path is said in terms of what was meant; what is wrong with scene and pipeline is said at once.
fn wrong_paths() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let (pbr, cornell) = ("pipelines/pbr.ron", "scenes/cornell.ron");
    let binary = folder.path().with_extension("ron");
    std::fs::write(&binary, [0_u8, 159, 146, 150, 255])?;
    let binary_path = binary.to_str().ok_or("a path")?;
    let cases: &[(&[&str], &[&str])] = &[
        (&["plan", cornell], &["compile::is-scene", "`scenes/cornell.ron` is a scene", "--scene", pbr]),
        (&["plan", pbr, "--scene", pbr], &["scene::is-pipeline", "`pipelines/pbr.ron` is a pipeline", cornell]),
        (&["plan", "nope", "--scene", "nowhere"], &["there is no scene `nowhere`", cornell, "load::missing-file", pbr]),
        (&["plan", pbr, "--scene", "scenes/cornel.ron"], &["scene::unreadable", "did you mean `scenes/cornell.ron`?"]),
        (&["plan", "pipelines"], &["load::missing-file", "it is a folder"]),
        (&["plan", pbr, "--set", "exposure=nan", "--set", "foo=1"], &["expand::bad-set", "expand::unknown-param"]),
        (&["plan", pbr, "--size", "4294967295x1"], &["expand::size-over-limit"]),
        (&["check", "scenes/nowhere_to_be_found.ron"], &["scene::unreadable", cornell]),
        (&["check", "none.ron", "none.wgsl", "none.glb", "none"], &["none.ron", "none.wgsl", "none.glb", "check::kind"]),
        (&["check", binary_path], &["not UTF-8 at byte 1"]),
    ];
    let result = cases.iter().try_for_each(|(arguments, expected)| refused(arguments, expected, folder.path()));
    std::fs::remove_file(&binary)?;
    result
}

/// What a scene holds, now and later, for people and for programs.
fn scenes() -> Result<(), Failed> {
    let scene = "scenes/wall_removed.ron";
    let said = |arguments: &[&str], expected: &[&str]| -> Result<String, Failed> {
        let text = String::from_utf8(run(arguments)?.stdout)?;
        match expected.iter().find(|expected| !text.contains(**expected)) {
            Some(missing) => Err(format!("{arguments:?} does not say `{missing}`:\n{text}").into()),
            None => Ok(text),
        }
    };
    let text = said(&["scene", scene], &["outer wall", "point light, 60 cd", "EV100 3.5", "spawn group `blast`", "memory", "bounds"])?;
    if text.contains("rubble 1   ") {
        return Err("rubble lies there before the wall falls".into());
    }
    let later = said(&["scene", scene, "--time", "3"], &["rubble 1   ", "time       3 s"])?;
    if later.contains("outer wall   ") {
        return Err("the wall still stands".into());
    }
    let json: serde_json::Value = serde_json::from_str(&said(&["scene", scene, "--format", "json"], &[])?)?;
    if json["timeline"][0]["at"] != 2.0 || json["nodes"].as_array().is_none_or(Vec::is_empty) {
        return Err(format!("the JSON lacks something: {json}").into());
    }
    let folder = tempfile::tempdir()?;
    refused(&["scene", "scenes/nowhere_to_be_found.ron"], &["scene::unreadable", "scenes/cornell.ron"], folder.path())?;
    refused(&["scene", scene, "--time", "nan"], &["world::bad-time"], folder.path())
}

/// Images side by side keep their pixels; what is no image, or of another size, is named.
fn sheets() -> Result<(), Failed> {
    let (folder, empty) = (tempfile::tempdir()?, tempfile::tempdir()?);
    let path = |name: &str| folder.path().join(name).display().to_string();
    let write = |name: &str, width: u32, shade: u8| {
        image::RgbImage::from_fn(width, 4, |x, y| image::Rgb([shade, x as u8, y as u8])).save(folder.path().join(name))
    };
    for (name, width, shade) in [("0.png", 6, 0), ("1.png", 6, 100), ("2.png", 6, 200), ("wide.png", 7, 0)] {
        write(name, width, shade)?;
    }
    std::fs::write(path("text.png"), "no image")?;
    let (a, b, c, wide, text, out) = (path("0.png"), path("1.png"), path("2.png"), path("wide.png"), path("text.png"), path("out.png"));
    done(&["sheet", &a, &b, &c, "-o", &out, "--columns", "2"])?;
    let sheet = image::open(&out)?.into_rgb8();
    if sheet.dimensions() != (16, 12) {
        return Err(format!("the sheet has {:?} pixels", sheet.dimensions()).into());
    }
    for (x, y, pixel) in sheet.enumerate_pixels() {
        let expected = match ((x, y), x % 10, y % 8) {
            ((10.., 8..), ..) | (_, 6.., _) | (_, _, 4..) => [255; 3],
            (_, u, v) => [
                if x >= 10 {
                    100
                } else if y >= 8 {
                    200
                } else {
                    0
                },
                u as u8,
                v as u8,
            ],
        };
        if pixel.0 != expected {
            return Err(format!("({x}, {y}) is {pixel:?} and not {expected:?}").into());
        }
    }
    done(&["sheet", &a, &b, "-o", &out, "--shrink", "2"])?;
    let small = image::open(&out)?.into_rgb8().dimensions();
    if small != (10, 2) {
        return Err(format!("two images of 3 by 2 make {small:?}").into());
    }
    let bad = empty.path().join("bad.png").display().to_string();
    refused(
        &["sheet", &a, &wide, &text, &path("none.png"), "-o", &bad],
        &["sheet::sizes", "wide.png", "text.png", "none.png"],
        empty.path(),
    )?;
    refused(&["sheet", &a, "-o", &bad, "--shrink", "5"], &["sheet::too-small", "6 x 4"], empty.path())?;
    refused(&["sheet", &a, "-o", &bad.replace(".png", ".exr")], &["output::format"], empty.path())
}

/// Wrong usage is status 2, before anything is loaded.
fn usage() -> Result<(), Failed> {
    let render = ["render", "pipelines/pbr.ron", "--scene", "scenes/cornell.ron", "-o", "/nonexistent/out.png"];
    let wrong: [&[&str]; 6] =
        [&["--frames", "0"], &["--size", "x"], &["--size", "4294967296x1"], &["--size", "-1x5"], &["--set", "exposure"], &["--bogus"]];
    for more in wrong {
        let arguments: Vec<&str> = render.iter().chain(more).copied().collect();
        let output = run(&arguments)?;
        if output.status.code() != Some(2) || output.stderr.is_empty() {
            return Err(format!("{more:?} ended with {:?}", output.status.code()).into());
        }
    }
    Ok(())
}

/// Damages shipped files in many places, always in the same way: they are read or refused, and nothing else happens.
fn damaged_files() -> Result<(), Failed> {
    const TOKENS: [&str; 12] = [
        "-1",
        "0",
        "9223372036854775807",
        "1e400",
        "NaN",
        "\"",
        "(",
        "}",
        "/*",
        "r#\"",
        "\"1 / 0\"",
        "\"output.width * 9223372036854775807\"",
    ];
    let folder = tempfile::tempdir()?;
    let mut state = 1_u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below.max(1)
    };
    for name in ["pipelines/pbr.ron", "scenes/materials.ron", "shaders/pbr/light.wgsl", "pipelines/albedo.ron"] {
        let original = std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join(name))?;
        let path = folder.path().join(Path::new(name).file_name().ok_or("a name")?);
        for round in 0..12 {
            let mut bytes = original.clone();
            let at = random(bytes.len());
            match round % 3 {
                0 => bytes[at] = random(256) as u8,
                1 => bytes.truncate(at),
                _ => {
                    let token = TOKENS[random(TOKENS.len())].as_bytes();
                    bytes.splice(at..(at + token.len()).min(original.len()), token.iter().copied());
                }
            }
            std::fs::write(&path, &bytes)?;
            let output = run(&["check", path.to_str().ok_or("a path")?])?;
            let refused = output.status.code() == Some(1) && !output.stderr.is_empty();
            if !refused && output.status.code() != Some(0) {
                return Err(format!("{name}, round {round}: {:?}", output.status.code()).into());
            }
        }
    }
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
        "pipelines/blocks/display.ron",
        "pipelines/blocks/shadow_cascades.ron",
        "pipelines/blocks/shadow_point.ron",
        "pipelines/blocks/shadow_spot.ron",
        "scenes/cornell.ron",
        "scenes/materials.ron",
        "shaders/pbr/light.wgsl",
    ])?;
    if output.status.code() != Some(0) {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
    }
    for format in ["text", "json", "dot", "html"] {
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

/// A picture that settles is rendered until it does; one that never does needs a number of frames, and gets it.
fn frames() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let path = |name: &str| folder.path().join(name).to_str().map(str::to_owned).ok_or("a path");
    let (pipeline, out, stats) = (path("fade.ron")?, path("fade.png")?, path("stats.json")?);
    let text = |run: &str| {
        format!(
            "(doc: \"Adds to itself.\", resources: {{\"color\": Texture(format: \"rgba8unorm\", clear: Zero)}}, passes: {{\"add\": Fullscreen(\
             shader: \"add.wgsl\", run: {run}, blend: {{\"color\": Add}}, modify: {{\"color\": \"color\"}})}}, outputs: {{\"color\": \"color\"}})"
        )
    };
    let shader = "struct Targets { color: vec4<f32> }\n@fragment fn add() -> Targets { return Targets(vec4<f32>(0.2)); }\n";
    std::fs::write(path("add.wgsl")?, shader)?;
    let render = ["render", &pipeline, "--scene", "scenes/cornell.ron", "-o", &out, "--size", "8x8", "--stats", &stats];
    // When it runs, `--frames`, the value that comes out (0.6, 0.2 and 0.4, as sRGB: only what accumulates keeps
    // what it has), and the frames that it takes.
    for (run_kind, count, value, taken) in
        [("Accumulate(3)", None, 203, 3), ("EveryFrame", Some("2"), 124, 2), ("Accumulate(3)", Some("2"), 170, 2)]
    {
        std::fs::write(&pipeline, text(run_kind))?;
        let output = run(&[&render[..], &count.map_or(vec![], |count| vec!["--frames", count])].concat())?;
        if output.status.code() != Some(0) {
            return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
        }
        let pixel = image::open(&out)?.into_rgba8().get_pixel(3, 3).0;
        let frames = serde_json::from_slice::<serde_json::Value>(&std::fs::read(&stats)?)?["frames"].as_u64();
        if pixel != [value, value, value, 255] || frames != Some(taken) {
            return Err(format!("{run_kind} with {count:?}: {pixel:?} after {frames:?} frames").into());
        }
    }
    std::fs::write(&pipeline, text("EveryFrame"))?;
    let output = run(&render)?;
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    if output.status.code() == Some(1) && errors.contains("--frames") { Ok(()) } else { Err(errors.into()) }
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
        trial("wrong paths are explained", None, wrong_paths),
        trial("scenes are described", None, scenes),
        trial("sheets show images side by side", None, sheets),
        trial("wrong usage is status 2", None, usage),
        trial("damaged files are read or refused", None, damaged_files),
        trial("a missing adapter is explained", None, no_adapter),
        trial("check and plan need no adapter", None, check_and_plan),
        trial("the same command gives the same bytes", adapter, same_bytes_twice),
        trial("images settle, or run for so many frames", adapter, frames),
        trial("broken models are refused", data, broken_models),
    ];
    libtest_mimic::run(&arguments, trials).exit();
}
