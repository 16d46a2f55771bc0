//! Index lists, strips and fans to a list of triangles.
//!
//! Guarantees: three corners for each triangle, every index below the number of vertices, and winding as glTF 2.0, section
//! 3.7.2.1, defines it. Triangles without area are kept: they are drawn as nothing, and counts match what other tools say.

use super::mesh::{Mode, Primitive};
use super::report::Report;

/// Triangles and vertices that all meshes of a file together may have.
const MOST_TRIANGLES: usize = 1 << 24;
const MOST_VERTICES: usize = 1 << 24;
/// Elements that morph targets and skins may read: vertices times targets, and times sets of joints.
const MOST_DEFORMED: usize = 1 << 28;
/// Key times and values that all animations of a file together may have.
const MOST_KEYS: usize = 1 << 24;

/// What is left of the limits.
pub(super) struct Budget {
    triangles: usize,
    vertices: usize,
    deformed: usize,
    keys: usize,
}

impl Budget {
    /// The limits for one file.
    pub(super) fn new() -> Budget {
        Budget { triangles: MOST_TRIANGLES, vertices: MOST_VERTICES, deformed: MOST_DEFORMED, keys: MOST_KEYS }
    }

    /// Takes triangles, or reports that there are too many.
    pub(super) fn take_triangles(&mut self, count: usize, place: &str, report: &Report) -> Option<()> {
        take(&mut self.triangles, count, MOST_TRIANGLES, "triangles", place, report)
    }

    /// Takes vertices, or reports that there are too many.
    pub(super) fn take_vertices(&mut self, count: usize, place: &str, report: &Report) -> Option<()> {
        take(&mut self.vertices, count, MOST_VERTICES, "vertices", place, report)
    }

    /// Takes key times or values, or reports that there are too many.
    pub(super) fn take_keys(&mut self, count: usize, place: &str, report: &Report) -> Option<()> {
        take(&mut self.keys, count, MOST_KEYS, "animation keys", place, report)
    }

    /// Takes elements of morph targets and skins, or reports that there are too many.
    pub(super) fn take_deformed(&mut self, count: usize, place: &str, report: &Report) -> Option<()> {
        take(&mut self.deformed, count, MOST_DEFORMED, "morphed or skinned elements", place, report)
    }
}

fn take(left: &mut usize, count: usize, most: usize, what: &str, place: &str, report: &Report) -> Option<()> {
    match left.checked_sub(count) {
        Some(rest) => {
            *left = rest;
            Some(())
        }
        None => {
            let problem = format!("with {count} more {what} the file has more than {most}");
            report.error("gltf::too-large", place, problem, "split the file, or simplify what it holds");
            None
        }
    }
}

/// The corners of a primitive's triangles. `None` where there are none, which the report explains.
pub(super) fn triangles(primitive: &Primitive<'_>, budget: &mut Budget, report: &Report) -> Option<Vec<u32>> {
    let place = &primitive.place;
    let vertices = primitive.position.count;
    let count = primitive.indices.map_or(vertices, |indices| indices.count);
    let triangles = if primitive.mode == Mode::List { count / 3 } else { count.saturating_sub(2) };
    if triangles == 0 {
        report.warning("gltf::no-triangle", place, format_args!("has {count} corners, too few for a triangle; it is left out"), "");
        return None;
    }
    if primitive.mode == Mode::List && !count.is_multiple_of(3) {
        report.warning("gltf::odd-corners", place, format_args!("has {count} corners, not a multiple of three; the rest is ignored"), "");
    }
    budget.take_triangles(triangles, place, report)?;
    let corner = |at: usize| match primitive.indices {
        Some(indices) => {
            let [index] = indices.integers(at);
            index
        }
        // In range: the budget is far below 2^32.
        None => at as u32,
    };
    let mut list = Vec::with_capacity(triangles * 3);
    for triangle in 0..triangles {
        list.extend(corners(primitive.mode, triangle).map(corner));
    }
    match list.iter().find(|index| **index as usize >= vertices) {
        None => Some(list),
        Some(index) => {
            let problem = format!("index {index} is out of range: there are {vertices} vertices");
            report.error("gltf::vertex-out-of-range", format_args!("{place}.indices"), problem, "export the file again");
            None
        }
    }
}

/// Which corners form a triangle.
fn corners(mode: Mode, triangle: usize) -> [usize; 3] {
    match mode {
        Mode::List => [3 * triangle, 3 * triangle + 1, 3 * triangle + 2],
        // Every other triangle of a strip is turned, so that all face the same way.
        Mode::Strip => [triangle, triangle + 1 + triangle % 2, triangle + 2 - triangle % 2],
        Mode::Fan => [triangle + 1, triangle + 2, 0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_keep_the_winding_of_the_format() {
        let all = |mode, count| (0..count).map(|triangle| corners(mode, triangle)).collect::<Vec<_>>();
        assert_eq!(all(Mode::List, 2), [[0, 1, 2], [3, 4, 5]]);
        assert_eq!(all(Mode::Strip, 3), [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
        assert_eq!(all(Mode::Fan, 3), [[1, 2, 0], [2, 3, 0], [3, 4, 0]]);
    }
}
