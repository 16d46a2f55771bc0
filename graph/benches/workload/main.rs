//! Plans large graphs from files, beside four baselines: `WORKLOAD=FOLDER cargo bench -p luminaire-graph --bench workload`.
//!
//! Reads every JSON file below the folder (or only those named in `FILES`, separated by spaces), and prints for each a line of
//! JSON with the plan and its figures to standard output, and a table of quality and time by class to standard error. Times are
//! those of the thread, medians of several runs, from the declarations in memory to a finished plan. Without `WORKLOAD` it does
//! nothing.
#![allow(clippy::print_stdout, clippy::print_stderr, clippy::unwrap_used, clippy::panic)]

mod baselines;
mod clock;
mod declared;
mod ours;
mod table;

use std::path::{Path, PathBuf};

use serde_json::json;

use baselines::{BASELINES, Baseline};
use clock::{medians, timed};
use declared::{Declared, UNIT};
use table::{Row, print};

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

/// In use by bytes in an order: the largest sum at any pass, and the sum of all.
fn peak_and_sum(declared: &Declared, order: &[usize], outputs: &[bool], ids: &dyn Fn(&str) -> usize) -> (u64, u64) {
    let mut lives: Vec<Option<(usize, usize)>> = vec![None; declared.resources.len()];
    for (step, pass) in order.iter().enumerate() {
        let pass = &declared.passes[*pass];
        for name in pass.reads.iter().chain(&pass.writes).chain(&pass.modifies) {
            let life = &mut lives[ids(name)];
            *life = Some((life.map_or(step, |life| life.0), step));
        }
    }
    let mut change = vec![0i64; order.len() + 1];
    let mut sum = 0;
    for (index, life) in lives.iter().enumerate().filter(|(index, _)| !outputs[*index]) {
        let Some((first, last)) = life else { continue };
        let bytes = declared.resources[index].bytes;
        sum += bytes;
        change[*first] += bytes as i64;
        change[last + 1] -= bytes as i64;
    }
    let peak = change.iter().scan(0, |live, change| {
        *live += change;
        Some(*live)
    });
    (peak.max().unwrap_or(0) as u64, sum)
}

fn main() {
    let Some(folder) = std::env::var_os("WORKLOAD") else { return };
    let mut found = Vec::new();
    match std::env::var("FILES") {
        Ok(names) => found.extend(names.split_whitespace().map(PathBuf::from)),
        Err(_) => files(Path::new(&folder), &mut found),
    }
    found.sort();
    let mut rows = Vec::new();
    for path in found {
        let declared = Declared::read(&path);
        let numbers: std::collections::HashMap<&str, usize> =
            declared.resources.iter().enumerate().map(|(index, resource)| (resource.name.as_str(), index)).collect();
        let ids = |name: &str| numbers[name];
        let mut outputs = vec![false; declared.resources.len()];
        declared.outputs.iter().for_each(|name| outputs[ids(name)] = true);

        let (bound_graph, planned) = ours::plan(&declared);
        let baseline = |baseline| timed(|| baselines::plan(&declared, baseline));
        let [compile, bound_to_plan, placing, exact] = medians([
            &|| timed(|| ours::plan(&declared)),
            &|| timed(|| ours::plan_of(&bound_graph)),
            &|| {
                timed(|| {
                    let (bound, planned) = ours::plan(&declared);
                    (planned.placed(), bound, planned)
                })
            },
            &|| baseline(Baseline::ExactGreedy),
        ]);
        let heap = planned.placed();
        let order: Vec<usize> = heap.order.iter().map(|pass| pass.index()).collect();
        let (bound, none) = peak_and_sum(&declared, &order, &outputs, &ids);
        let mut kept = order.clone();
        kept.sort_unstable();
        let declared_bound = peak_and_sum(&declared, &kept, &outputs, &ids).0;
        // Charged as every planner is: whole units.
        let allocated = planned.allocated(&declared);

        let mut baselines = Vec::new();
        for (kind, _) in BASELINES {
            let bytes: u64 = baselines::plan(&declared, kind).memories.iter().sum();
            let [microseconds] = if kind == Baseline::ExactGreedy { [exact] } else { medians([&|| baseline(kind)]) };
            baselines.push((bytes, microseconds));
        }
        let place: Vec<(u32, u32, u64)> = heap.offsets.iter().map(|(resource, offset)| (resource.0, 0, *offset)).collect();
        println!(
            "{}",
            json!({
                "file": path.file_stem().unwrap().to_string_lossy(),
                "compile_us": placing, "compile_without_placing_us": compile, "declare_us": compile - bound_to_plan,
                "bytes_reached": heap.bytes, "bytes_bound": bound, "bytes_none": none, "passes_kept": order.len(),
                "bytes_allocated": allocated,
                "exact_greedy": { "bytes": baselines[0].0, "compile_us": baselines[0].1 },
                "plan": { "order": order, "place": place, "heaps": [heap.bytes.next_multiple_of(UNIT)] },
            })
        );
        rows.push(Row {
            class: path.parent().and_then(Path::file_name).unwrap().to_string_lossy().into_owned(),
            name: path.file_stem().unwrap().to_string_lossy().into_owned(),
            passes: declared.passes.len(),
            declared_bound,
            bound,
            placed: heap.bytes,
            allocated,
            compile,
            placing,
            bound_to_plan,
            baselines,
        });
    }
    print(&rows);
}
