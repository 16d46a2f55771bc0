//! `luminaire info`: the adapters, what they can do, and what comes with the program.

use std::fmt::Write;

use luminaire_graph::source::SourceMap;
use luminaire_passes::Adapter;

use super::{print, report};
use crate::files::{embedded_pipelines, embedded_scenes};

pub(super) fn run() -> bool {
    let mut text = format!("luminaire {}\n", env!("CARGO_PKG_VERSION"));
    let chosen = Adapter::choose(None);
    if let Ok(adapter) = &chosen {
        text.push_str("\nadapter\n");
        for (name, value) in adapter.describe() {
            // Writing into a string can't fail.
            let _ = writeln!(text, "  {name:<24} {value}");
        }
        let facts = adapter.facts();
        let features: Vec<&str> = facts.features.iter().map(|feature| feature.name()).collect();
        let rows = [
            ("2D textures up to", facts.max_texture_2d.to_string()),
            ("3D textures up to", facts.max_texture_3d.to_string()),
            ("array layers", facts.max_layers.to_string()),
            ("buffers up to", format!("{} MiB", facts.max_buffer_bytes >> 20)),
            ("storage bindings up to", format!("{} MiB", facts.max_storage_binding_bytes >> 20)),
            ("memory budget", format!("{} MiB", facts.memory_budget >> 20)),
            ("features", if features.is_empty() { "none".to_owned() } else { features.join(", ") }),
        ];
        for (name, value) in rows {
            let _ = writeln!(text, "  {name:<24} {value}");
        }
    }
    for (title, names) in [("pipelines", embedded_pipelines()), ("scenes", embedded_scenes())] {
        let _ = writeln!(text, "\n{title} in the program");
        for name in names {
            let _ = writeln!(text, "  {name}");
        }
    }
    let printed = print(&text);
    match chosen {
        Ok(_) => printed,
        Err(problems) => report(&problems, &SourceMap::default()),
    }
}
