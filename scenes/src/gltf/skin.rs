//! Skins, applied once to the pose at rest.
//!
//! Guarantees: the joints exist, and joint indices of vertices are held against them. A skinned vertex is moved by
//! the weighted sum of its joints' global transform times inverse bind matrix, and the transform of the mesh's own node is ignored
//! (glTF 2.0, section 3.7.3). Downside: the result is a static mesh; skins are not animated.

use glam::{Affine3A, Mat3A, Mat4, Vec3, Vec3A};

use super::accessor::Accessor;
use super::json::Json;
use super::mesh::{Primitive, Semantic, resolve};
use super::node::is_usable;
use super::report::Report;

/// A checked skin.
pub(super) struct SkinSource<'a> {
    /// The JSON path, for messages.
    pub(super) place: String,
    /// The file's indices of nodes.
    pub(super) joints: Vec<usize>,
    inverse_bind: Option<&'a Accessor<'a>>,
}

/// Checks every skin.
pub(super) fn read_skins<'a>(root: &Json<'_>, accessors: &'a [Option<Accessor<'a>>], nodes: usize) -> Vec<SkinSource<'a>> {
    root.objects("skins").iter().map(|skin| read_skin(skin, accessors, nodes)).collect()
}

fn read_skin<'a>(json: &Json<'_>, accessors: &'a [Option<Accessor<'a>>], nodes: usize) -> SkinSource<'a> {
    json.index("skeleton", "nodes", nodes);
    json.required("joints");
    let list = json.list("joints");
    if list.is_empty() && json.has("joints") {
        json.error_at("joints", "gltf::skin", "must name at least one node");
    }
    let joints: Vec<usize> = list.iter().filter_map(|joint| joint.as_index("nodes", nodes)).collect();
    let matrices = json.get("inverseBindMatrices");
    let inverse_bind = matrices.and_then(|matrices| resolve(&matrices, accessors, Semantic::InverseBindMatrices));
    if let Some(matrices) = inverse_bind
        && matrices.count < list.len()
    {
        json.error_at("inverseBindMatrices", "gltf::skin", format_args!("has {} matrices for {} joints", matrices.count, list.len()));
    }
    SkinSource { place: json.place().to_owned(), joints, inverse_bind }
}

/// The matrix of each joint: from the mesh's space to the scene's.
pub(super) fn joint_matrices(skin: &SkinSource<'_>, globals: &[Affine3A], report: &Report) -> Option<Vec<Affine3A>> {
    let mut matrices = Vec::with_capacity(skin.joints.len());
    for (index, joint) in skin.joints.iter().enumerate() {
        let global = globals.get(*joint).copied()?;
        let inverse = match skin.inverse_bind {
            Some(accessor) => Affine3A::from_mat4(Mat4::from_cols_array(&accessor.floats(index))),
            None => Affine3A::IDENTITY,
        };
        let matrix = global * inverse;
        if !is_usable(&matrix) {
            let problem = format!("the matrix of joint {index} is not finite or too large");
            report.error("gltf::skin", &skin.place, problem, "export the file again");
            return None;
        }
        matrices.push(matrix);
    }
    Some(matrices)
}

/// Moves positions and normals. `vertices` are the file's indices of the vertices.
pub(super) fn apply(
    primitive: &Primitive<'_>,
    joints: &[Affine3A],
    vertices: &[u32],
    positions: &mut [Vec3],
    normals: Option<&mut Vec<Vec3>>,
    report: &Report,
) -> Option<()> {
    let mut blended = Vec::with_capacity(vertices.len());
    for vertex in vertices {
        match blend(primitive, joints, *vertex as usize) {
            Ok(matrix) => blended.push(matrix),
            Err(problem) => {
                report.error("gltf::skin", format_args!("{}.attributes", primitive.place), problem, "export the file again");
                return None;
            }
        }
    }
    for (position, matrix) in positions.iter_mut().zip(&blended) {
        *position = matrix.transform_point3(*position);
    }
    for (normal, matrix) in normals.into_iter().flatten().zip(&blended) {
        *normal = (cofactors(&matrix.matrix3) * Vec3A::from(*normal)).into();
    }
    Some(())
}

/// Normals go with the cofactor matrix: the inverse transpose times the determinant, which exists for singular matrices too.
fn cofactors(matrix: &Mat3A) -> Mat3A {
    let (x, y, z) = (matrix.x_axis, matrix.y_axis, matrix.z_axis);
    let sign = if matrix.determinant() < 0.0 { -1.0 } else { 1.0 };
    Mat3A::from_cols(y.cross(z) * sign, z.cross(x) * sign, x.cross(y) * sign)
}

fn blend(primitive: &Primitive<'_>, joints: &[Affine3A], vertex: usize) -> Result<Affine3A, String> {
    let mut sum = [0.0_f32; 12];
    let mut total = 0.0;
    for (joint_accessor, weight_accessor) in &primitive.influences {
        let indices: [u32; 4] = joint_accessor.integers(vertex);
        let weights: [f32; 4] = weight_accessor.floats(vertex);
        for (index, weight) in indices.into_iter().zip(weights) {
            let Some(matrix) = joints.get(index as usize) else {
                return Err(format!("vertex {vertex} names joint {index}, but its skin has {}", joints.len()));
            };
            if !(weight.is_finite() && weight >= 0.0) {
                return Err(format!("vertex {vertex} has the weight {weight}"));
            }
            total += weight;
            for (sum, entry) in sum.iter_mut().zip(matrix.to_cols_array()) {
                *sum += weight * entry;
            }
        }
    }
    // Real files have weights that miss 1 by some rounding, or are all zero.
    if total > 0.0 && total.is_finite() {
        return Ok(Affine3A::from_cols_array(&sum.map(|entry| entry / total)));
    }
    joints.first().copied().ok_or_else(|| "its skin has no joints".to_owned())
}
