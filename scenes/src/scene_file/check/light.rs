//! Lights.

use glam::{Affine3A, Vec3};
use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::syntax::document::Text;

use super::object::{Primitives, Shape};
use super::{Kind, facing, material, size_of};
use crate::asset::Material;
use crate::scene_file::checks::{BRIGHT, COLORFUL, FAR, Problems, SMALL};
use crate::scene_file::document::{LightDoc, Number, Vector};
use crate::world::{Cone, DirectionalLight, LocalLight, RectangleLight};

/// A light, its place, and its parent's name. A rectangle gets a mesh that glows.
pub(super) fn light(
    name: &str,
    entry: &LightDoc,
    primitives: &mut Primitives,
    materials: &mut Vec<Material>,
    problems: &mut Problems,
) -> (Kind, Affine3A, Option<Text>) {
    let of = format!("light `{name}`");
    match entry {
        LightDoc::Directional { lux, direction, color, parent } => {
            let illuminance = intensity("lux", &of, lux, problems);
            let color = tint(&of, color.as_ref(), problems);
            let direction = problems.direction(&format!("`direction` of {of}"), direction);
            (Kind::Directional(DirectionalLight { color, illuminance }), facing(Vec3::ZERO, direction), parent.clone())
        }
        LightDoc::Point { candela, position, color, range, parent } => {
            let intensity = intensity("candela", &of, candela, problems);
            let color = tint(&of, color.as_ref(), problems);
            let range = reach(&of, range.as_ref(), problems);
            let position = problems.position(&format!("`position` of {of}"), position);
            (Kind::Local(LocalLight { color, intensity, range, cone: None }), Affine3A::from_translation(position), parent.clone())
        }
        LightDoc::Spot { candela, position, direction, inner, outer, color, range, parent } => {
            let intensity = intensity("candela", &of, candela, problems);
            let color = tint(&of, color.as_ref(), problems);
            let range = reach(&of, range.as_ref(), problems);
            let position = problems.position(&format!("`position` of {of}"), position);
            let direction = problems.direction(&format!("`direction` of {of}"), direction);
            let cone = Some(cone(&of, inner.as_ref(), outer, problems));
            (Kind::Local(LocalLight { color, intensity, range, cone }), facing(position, direction), parent.clone())
        }
        LightDoc::Rectangle { luminance, size, position, direction, color, two_sided, parent } => {
            let luminance = intensity("luminance", &of, luminance, problems);
            let color = tint(&of, color.as_ref(), problems);
            let size = size_of(&of, size, problems);
            let position = problems.position(&format!("`position` of {of}"), position);
            let direction = problems.direction(&format!("`direction` of {of}"), direction);
            let light = RectangleLight { color, luminance, size, two_sided: *two_sided };
            materials.push(Material {
                base_color: [0.0, 0.0, 0.0, 1.0],
                specular: 0.0,
                emissive: glow(&light).to_array(),
                double_sided: *two_sided,
                ..material::plain(name)
            });
            let (mesh, material) = (primitives.mesh(name, Shape::Panel(size), materials.len() - 1), materials.len() - 1);
            (Kind::Rectangle { light, mesh, material }, facing(position, direction), parent.clone())
        }
    }
}

fn intensity(field: &str, of: &str, value: &Number, problems: &mut Problems) -> f32 {
    problems.number(&format!("`{field}` of {of}"), Some(value), 0.0, 0.0..=BRIGHT)
}

fn tint(of: &str, color: Option<&Vector>, problems: &mut Problems) -> Vec3 {
    problems.color(&format!("`color` of {of}"), color, Vec3::ONE, COLORFUL)
}

fn reach(of: &str, range: Option<&Number>, problems: &mut Problems) -> Option<f32> {
    range.map(|range| problems.number(&format!("`range` of {of}"), Some(range), 1.0, SMALL..=FAR))
}

fn cone(of: &str, inner: Option<&Number>, outer: &Number, problems: &mut Problems) -> Cone {
    let outer_angle = problems.number(&format!("`outer` of {of}"), Some(outer), 90.0, 0.01..=90.0);
    let inner_angle = problems.number(&format!("`inner` of {of}"), inner, 0.0, 0.0..=90.0);
    if inner_angle >= outer_angle {
        let span = inner.map_or(outer.span, |inner| inner.span);
        let message = format!("`inner` of {of} is {inner_angle}, and `outer` is {outer_angle}");
        problems.add(Diagnostic::error("scene::bad-cone", message).at(span, "must be less than `outer`"));
    }
    Cone { inner: inner_angle.to_radians(), outer: outer_angle.to_radians() }
}

/// The glow of a rectangle's mesh, nits.
pub(crate) fn glow(light: &RectangleLight) -> Vec3 {
    light.color * light.luminance
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;

    #[test]
    fn a_rectangle_glows_as_its_light_says() {
        let light = RectangleLight { color: Vec3::new(1.0, 0.5, 0.0), luminance: 200.0, size: Vec2::ONE, two_sided: false };
        assert_eq!(glow(&light), Vec3::new(200.0, 100.0, 0.0));
    }
}
