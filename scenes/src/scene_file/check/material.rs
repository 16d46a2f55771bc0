//! Materials, and changes of materials that a glTF file brings.

use glam::Vec3;

use crate::asset::{AlphaMode, Material};
use crate::scene_file::checks::{BRIGHT, Problems};
use crate::scene_file::document::MaterialDoc;

/// What a material of a scene file is where it says nothing: a matt grey.
pub(super) fn plain(name: &str) -> Material {
    Material { name: name.to_owned(), base_color: [0.8, 0.8, 0.8, 1.0], metallic: 0.0, ..Material::default() }
}

/// The material that `entry` makes of `base`: what it does not name stays. `of` is for messages.
pub(in crate::scene_file) fn changed(base: Material, of: &str, entry: &MaterialDoc, problems: &mut Problems) -> Material {
    let [red, green, blue, base_alpha] = base.base_color;
    let color = problems.color(&format!("`base_color` of {of}"), entry.base_color.as_ref(), Vec3::new(red, green, blue), 1.0);
    let alpha = problems.number(&format!("`alpha` of {of}"), entry.alpha.as_ref(), base_alpha, 0.0..=1.0);
    let unit = |problems: &mut Problems, field: &str, value: Option<&_>, default: f32| {
        problems.number(&format!("`{field}` of {of}"), value, default, 0.0..=1.0)
    };
    Material {
        base_color: color.extend(alpha).to_array(),
        metallic: unit(problems, "metallic", entry.metallic.as_ref(), base.metallic),
        roughness: unit(problems, "roughness", entry.roughness.as_ref(), base.roughness),
        emissive: problems.color(&format!("`emissive` of {of}"), entry.emissive.as_ref(), base.emissive.into(), BRIGHT).to_array(),
        specular: unit(problems, "specular", entry.specular.as_ref(), base.specular),
        specular_color: problems
            .color(&format!("`specular_color` of {of}"), entry.specular_color.as_ref(), base.specular_color.into(), 100.0)
            .to_array(),
        ior: entry.ior.as_ref().map_or(base.ior, |ior| problems.number(&format!("`ior` of {of}"), Some(ior), 1.5, 1.0..=10.0)),
        alpha_mode: if entry.alpha.is_some() && alpha < 1.0 { AlphaMode::Blend } else { base.alpha_mode },
        double_sided: entry.double_sided.unwrap_or(base.double_sided),
        unlit: entry.unlit.unwrap_or(base.unlit),
        ..base
    }
}
