//! Scheduling and allocation of large graphs from files: `WORKLOAD=FOLDER cargo bench -p luminaire-graph --bench workload` reads
//! every JSON file below the folder (passes with reads, writes and modifies in declared order, resources, outputs), plans it, and
//! prints times and figures. Without `WORKLOAD` it does nothing.
#![allow(clippy::print_stdout, clippy::unwrap_used, clippy::panic)]

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use luminaire_graph::allocate::allocate;
use luminaire_graph::bind::types::Bound;
use luminaire_graph::device::DeviceFacts;
use luminaire_graph::expand::types::*;
use luminaire_graph::format::Format;
use luminaire_graph::lifetime::lifetimes;
use luminaire_graph::plan::{Access, Role, Step, StepKind, Use, Workgroups};
use luminaire_graph::schedule::schedule;
use luminaire_graph::source::Span;
use serde_json::Value as Json;

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "json") {
            found.push(path);
        }
    }
}

fn resource(json: &Json) -> Resource {
    let number = |key: &str| json[key].as_u64().unwrap() as u32;
    let format = match json["format"].as_str().unwrap() {
        "r8" => "r8unorm",
        "r16f" => "r16float",
        "rgba8" => "rgba8unorm",
        "rg16f" => "rg16float",
        "d32" => "depth32float",
        "rg11b10" => "rg11b10ufloat",
        "rgba16f" => "rgba16float",
        other => other,
    };
    let shape = match Format::from_name(format) {
        None => Shape::Buffer { bytes: json["width"].as_u64().unwrap() },
        Some(format) => Shape::Texture(TextureShape {
            dimension: if number("depth") > 1 { Dimension::D3 } else { Dimension::D2 },
            formats: vec![format],
            format_span: Span::NOWHERE,
            width: number("width"),
            height: number("height"),
            depth: number("depth"),
            layers: number("layers"),
            mips: number("mips"),
            samples: 1,
        }),
    };
    Resource { name: json["name"].as_str().unwrap().to_owned(), span: Span::NOWHERE, shape, clear: None, history: None, keep: Keep::Auto }
}

fn bound(json: &Json) -> Bound {
    let resources: Vec<Resource> = json["resources"].as_array().unwrap().iter().map(resource).collect();
    let ids: HashMap<&str, u32> = resources.iter().enumerate().map(|(index, resource)| (resource.name.as_str(), index as u32)).collect();
    let mut latest: HashMap<u32, PassId> = HashMap::new();
    let (mut passes, mut steps) = (Vec::new(), Vec::new());
    for (index, entry) in json["passes"].as_array().unwrap().iter().enumerate() {
        let pass = PassId(index as u32);
        let mut uses = Vec::new();
        for (key, role) in [("reads", Role::Read), ("writes", Role::Produce), ("modifies", Role::Modify)] {
            for name in entry[key].as_array().unwrap() {
                let id = ids[name.as_str().unwrap()];
                let version = if role == Role::Read { latest.get(&id).copied() } else { latest.insert(id, pass).and(None) };
                let (mips, access) = match (&resources[id as usize].shape, role) {
                    (Shape::Texture(shape), Role::Read) => (shape.mips, Access::Sampled),
                    (Shape::Texture(shape), _) => (shape.mips, Access::StorageWrite),
                    (Shape::Buffer { .. }, Role::Read) => (1, Access::StorageRead),
                    (Shape::Buffer { .. }, _) => (1, Access::StorageReadWrite),
                };
                let layers = if let Shape::Texture(shape) = &resources[id as usize].shape { shape.layers } else { 1 };
                let slot = String::new();
                uses.push(Use {
                    resource: ResourceId(id),
                    mips: 0..mips,
                    layers: 0..layers,
                    role,
                    access,
                    version,
                    slot,
                    span: Span::NOWHERE,
                });
            }
        }
        let name = entry["name"].as_str().unwrap().to_owned();
        passes.push(Pass {
            name: name.clone(),
            span: Span::NOWHERE,
            indices: Vec::new(),
            kind: PassKind::Copy,
            shader: None,
            constants: Vec::new(),
            reads: Vec::new(),
            writes: Vec::new(),
            modifies: Vec::new(),
            after: Vec::new(),
            run: Run::OnChange,
            batch: None,
            elements: Vec::new(),
        });
        let kind = StepKind::Compute { entry: String::new(), groups: Workgroups::Fixed([1, 1, 1]) };
        steps.push(Step {
            pass,
            name,
            span: Span::NOWHERE,
            shader: None,
            kind,
            bindings: Vec::new(),
            constants: Vec::new(),
            clears: Vec::new(),
            uses,
            run: Run::OnChange,
            batch: Vec::new(),
            inputs: Vec::new(),
        });
    }
    let output = |name: &Json| Output {
        name: name.as_str().unwrap().to_owned(),
        part: PartRef { resource: ResourceId(ids[name.as_str().unwrap()]), mips: None, layers: None, version: None, span: Span::NOWHERE },
    };
    let outputs = json["outputs"].as_array().unwrap().iter().map(output).collect();
    let formats = resources
        .iter()
        .map(|resource| if let Shape::Texture(shape) = &resource.shape { shape.formats.first().copied() } else { None })
        .collect();
    let expanded = Expanded {
        doc: String::new(),
        params: Vec::new(),
        resources,
        passes,
        spreads: Vec::new(),
        retained_budget: None,
        outputs,
        offered: Vec::new(),
    };
    Bound {
        expanded,
        shaders: Vec::new(),
        steps,
        formats,
        views: Vec::new(),
        draw_lists: Vec::new(),
        inputs: Vec::new(),
        requirements: Vec::new(),
    }
}

/// Seconds that this thread has run, since machines are shared; Linux only.
fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    stat.split_whitespace().next().and_then(|nanoseconds| nanoseconds.parse::<f64>().ok()).unwrap_or(f64::NAN) * 1e-9
}

const RUNS: u32 = 5;

fn main() {
    let Some(folder) = std::env::var_os("WORKLOAD") else { return };
    let mut found = Vec::new();
    files(Path::new(&folder), &mut found);
    found.sort();
    let device = DeviceFacts { memory_budget: u64::MAX, ..DeviceFacts::webgpu_defaults() };
    for path in found {
        let json: Json = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
        let bound = bound(&json);
        let retained = luminaire_graph::dirty::retention(&bound).retained;
        let mut spent = [0.0; 2];
        let mut figures = None;
        let mut runs = 0.0;
        // The scheduler's clock is coarse: means of many runs.
        while spent[0] + spent[1] < 0.3 {
            let start = cpu_seconds();
            for _ in 0..RUNS {
                std::hint::black_box(schedule(&bound, &retained));
            }
            let middle = cpu_seconds();
            let (schedule, problems) = schedule(&bound, &retained);
            let schedule = schedule.unwrap_or_else(|| panic!("{:?}", &problems[..1]));
            let again = cpu_seconds();
            for _ in 0..RUNS {
                let spans = lifetimes(&bound, &schedule, retained.clone());
                let allocation = allocate(&bound, &schedule, &spans, &device).unwrap();
                figures = Some((allocation.figures, schedule.order == schedule.declared));
            }
            spent[0] += middle - start;
            spent[1] += cpu_seconds() - again;
            runs += f64::from(RUNS);
        }
        let best = spent.map(|seconds| seconds / runs);
        let (figures, declared) = figures.unwrap();
        let ratio = |bytes: u64| bytes as f64 / figures.declared_bound as f64;
        println!(
            "{:<18} {:>5} passes  schedule {:>8.3} ms  allocate {:>8.3} ms  {:>6.3} us/pass  of the declared bound: bound {:.3} reached {:.3} placed {:.3} none {:.3}{}",
            path.file_stem().unwrap().to_string_lossy(),
            bound.steps.len(),
            best[0] * 1e3,
            best[1] * 1e3,
            (best[0] + best[1]) * 1e6 / bound.steps.len() as f64,
            ratio(figures.bound),
            ratio(figures.reached),
            ratio(figures.placed),
            ratio(figures.without_sharing),
            if declared { "  declared order" } else { "" },
        );
    }
}
