//! Which meshes of a file are lamps: glTF has no area lights, and authors draw a rectangle that glows.
//!
//! The rule: two triangles that make a rectangle and face the same way, of an opaque material that emits light, the same all over (no
//! emissive texture). A double-sided material emits to both sides. Accepted: what glows and has another shape is seen, and lights nothing.

use glam::{Affine3A, Mat3, Vec2, Vec3};

use super::RectangleLight;
use crate::asset::{AlphaMode, Asset, Material, Mesh};

/// Corners may be off by so much of the diagonal.
const TOLERANCE: f32 = 1.0e-3;

/// A rectangle in the space of its mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Panel {
    /// To the middle, with the width along x, the height along y and the front along -z.
    pub(crate) place: Affine3A,
    /// Width and height, metres.
    pub(crate) size: Vec2,
}

/// Whether some mesh of an asset is a lamp.
pub(crate) fn glowing_rectangles(asset: &Asset) -> bool {
    let glows = |mesh: &Mesh| asset.materials.get(mesh.material).is_some_and(|material| light(material, Vec2::ONE).is_some());
    asset.meshes.iter().any(|mesh| glows(mesh) && panel(mesh).is_some())
}

/// The light of a rectangle of this material.
pub(super) fn light(material: &Material, size: Vec2) -> Option<RectangleLight> {
    let emissive = Vec3::from(material.emissive);
    let luminance = emissive.max_element();
    let plain = material.alpha_mode == AlphaMode::Opaque && !material.unlit && material.emissive_texture.is_none();
    let glows = plain && luminance > 0.0 && emissive.is_finite();
    glows.then(|| RectangleLight { color: emissive / luminance, luminance, size, two_sided: material.double_sided })
}

/// The rectangle that a mesh is.
pub(super) fn panel(mesh: &Mesh) -> Option<Panel> {
    let [a, b, c, d, e, f] = <[u32; 6]>::try_from(mesh.indices.as_slice()).ok()?;
    let corner = |index: u32| mesh.vertices.get(index as usize).map(|vertex| Vec3::from(vertex.position));
    let first = [corner(a)?, corner(b)?, corner(c)?];
    let second = [corner(d)?, corner(e)?, corner(f)?];
    // The corner of each triangle that is not on the diagonal.
    let own = |triangle: [Vec3; 3], other: [Vec3; 3]| triangle.into_iter().find(|corner| !other.contains(corner));
    let (near, far) = (own(first, second)?, own(second, first)?);
    let diagonal: Vec<Vec3> = first.into_iter().filter(|corner| second.contains(corner)).collect();
    let &[p, q] = diagonal.as_slice() else { return None };
    let (right, up) = (p - near, q - near);
    let tolerance = TOLERANCE * (far - near).length();
    let front = (first[1] - first[0]).cross(first[2] - first[0]);
    let other_front = (second[1] - second[0]).cross(second[2] - second[0]);
    let square = (near + far - p - q).length() <= tolerance && right.dot(up).abs() <= tolerance * right.length().max(up.length());
    if !square || front.dot(other_front) <= 0.0 {
        return None;
    }
    let (right, up) = if right.cross(up).dot(front) > 0.0 { (up, right) } else { (right, up) };
    let (x, y) = (right.try_normalize()?, up.try_normalize()?);
    let axes = Mat3::from_cols(x, y, x.cross(y).try_normalize()?);
    Some(Panel { place: Affine3A::from_mat3_translation(axes, 0.5 * (p + q)), size: Vec2::new(right.length(), up.length()) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::Vertex;

    fn mesh(corners: &[[f32; 3]], indices: &[u32]) -> Mesh {
        let vertex = |position: &[f32; 3]| Vertex { position: *position, ..bytemuck::Zeroable::zeroed() };
        Mesh { name: String::new(), vertices: corners.iter().map(vertex).collect(), indices: indices.to_vec(), material: 0 }
    }

    #[test]
    fn a_rectangle_is_found_with_its_front() {
        // In the plane y = 1, 2 along x and 1 along z, counter-clockwise from above: it faces +Y.
        let corners = [[0.0, 1.0, 1.0], [2.0, 1.0, 1.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        for indices in [[0, 1, 2, 0, 2, 3], [1, 2, 3, 3, 0, 1], [2, 0, 1, 3, 0, 2]] {
            let Panel { place, size } = panel(&mesh(&corners, &indices)).unwrap();
            assert_eq!(Vec3::from(place.translation), Vec3::new(1.0, 1.0, 0.5));
            assert!((Vec3::from(place.matrix3.z_axis) + Vec3::Y).length() < 1e-6);
            assert!((place.matrix3.determinant() - 1.0).abs() < 1e-6);
            assert_eq!([size.max_element(), size.min_element()], [2.0, 1.0]);
        }
        // The other way round it faces -Y.
        let below = panel(&mesh(&corners, &[0, 2, 1, 0, 3, 2])).unwrap();
        assert!((Vec3::from(below.place.matrix3.z_axis) - Vec3::Y).length() < 1e-6);
    }

    #[test]
    fn what_is_no_rectangle_is_none() {
        let corners = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let wrong: [(&[[f32; 3]], &[u32]); 6] = [
            (&corners, &[0, 1, 2]),
            (&corners, &[0, 1, 2, 0, 1, 2]),
            // One of the two triangles faces away.
            (&corners, &[0, 1, 2, 0, 3, 2]),
            (&[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.5, 1.0, 0.0], [0.5, 1.0, 0.0]], &[0, 1, 2, 0, 2, 3]),
            (&[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.5], [0.0, 1.0, 0.0]], &[0, 1, 2, 0, 2, 3]),
            (&[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [4.0, 0.0, 0.0], [2.0, 0.0, 0.0]], &[0, 1, 2, 0, 2, 3]),
        ];
        for (corners, indices) in wrong {
            assert_eq!(panel(&mesh(corners, indices)), None, "{corners:?} {indices:?}");
        }
    }
}
