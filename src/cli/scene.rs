//! `luminaire scene`: what a scene holds.

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::source::SourceMap;
use luminaire_scenes::describe::{describe, text};
use luminaire_scenes::world::set_time;

use super::arguments::{SceneArguments, SceneFormat};
use super::{print, report};
use crate::session::load_scene;

pub(super) fn run(arguments: &SceneArguments) -> bool {
    let mut loaded = match load_scene(&arguments.scene, arguments.asset_root.as_deref()) {
        Ok(loaded) => loaded,
        Err((problems, sources)) => return report(&problems, &sources),
    };
    report(&loaded.diagnostics, &loaded.sources);
    if let Some(seconds) = arguments.time
        && let Err(problems) = set_time(&mut loaded.world, seconds)
    {
        return report(&problems, &SourceMap::default());
    }
    let description = describe(&mut loaded.world);
    match arguments.format {
        SceneFormat::Text => print(&text(&description)),
        SceneFormat::Json => match serde_json::to_string_pretty(&description) {
            Ok(json) => print(&format!("{json}\n")),
            Err(error) => {
                report(&[Diagnostic::error("output::json", format!("the description can't be written: {error}"))], &SourceMap::default())
            }
        },
    }
}
