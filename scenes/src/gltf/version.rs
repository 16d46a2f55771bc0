//! Whether the file is of a version and asks for extensions that this loader understands.
//!
//! Runs before everything else: what a file of another version or with a required extension means can't be judged, and
//! further messages would be noise.

use super::json::{Json, clip};
use luminaire_graph::diagnostic::list_names;

/// The extensions that a file may require.
const SUPPORTED: &[&str] = &[
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Reports a version or a required extension that is not supported.
pub(super) fn check(root: &Json<'_>) {
    check_version(root);
    for extension in root.list("extensionsRequired") {
        match extension.value().as_str() {
            Some(name) if SUPPORTED.contains(&name) => {}
            Some(name) => extension.report().error(
                "gltf::unsupported-extension",
                extension.place(),
                format_args!("the file requires the extension {}, which is not supported", clip(name)),
                &hint(name),
            ),
            None => extension.error("gltf::wrong-type", "expected the name of an extension"),
        }
    }
}

fn check_version(root: &Json<'_>) {
    let Some(asset) = root.required("asset").and_then(|_| root.object("asset")) else { return };
    if asset.required("version").is_none() {
        return;
    }
    let refuse = |key: &str, found: &str| {
        let problem = format!("is {}; glTF 2.0 is supported", clip(found));
        root.report().error("gltf::version", asset.place_of(key), problem, "export or convert the file to glTF 2.0");
    };
    // A later 2.x must load as 2.0, unless `minVersion` says otherwise.
    if let Some(text) = asset.text("version")
        && version(text).is_none_or(|(major, _)| major != 2)
    {
        refuse("version", text);
    }
    if let Some(text) = asset.text("minVersion")
        && version(text).is_none_or(|found| found > (2, 0))
    {
        refuse("minVersion", text);
    }
}

fn version(text: &str) -> Option<(u32, u32)> {
    let (major, minor) = text.split_once('.')?;
    Some((major.parse().ok()?, minor.parse().ok()?))
}

fn hint(extension: &str) -> String {
    match extension {
        "KHR_draco_mesh_compression" | "EXT_meshopt_compression" | "KHR_meshopt_compression" => {
            "export the file without mesh compression, or decompress it".to_owned()
        }
        "KHR_texture_basisu" | "EXT_texture_webp" | "EXT_texture_avif" | "MSFT_texture_dds" => {
            "export the file with PNG or JPEG textures".to_owned()
        }
        _ => format!("export the file without it; supported are {}", list_names(SUPPORTED.iter().copied())),
    }
}
