//! The parts of the camera's frustum that the cascades of a directional light are fitted to.
//!
//! What the camera sees of the scene is parted in depth by the practical split scheme: between parts that all double in depth, which is what
//! perspective asks for, and parts of equal depth, which waste less on what is close (Zhang, Sun, Xu and Lun, "Parallel-split shadow maps
//! for large-scale virtual environments", 2006, equation 7). Each part gets a map of its own, fitted as [`super::sun`] does. Accepted
//! downside: a part that is deep and narrow has a sphere, and so a map, as large as it is deep.

use luminaire_graph::published::{CascadeSplit, CascadeView, ViewKind, ViewRequest};

use super::layout::CascadeRow;
use super::projection::{CameraView, single};
use super::sun::SunView;
use crate::world::Aabb;

/// Stands for an end that is never reached, metres.
const VERY_FAR: f32 = 1e30;

/// Metres along the camera's axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Depths {
    pub(super) near: f64,
    pub(super) far: f64,
}

/// Between which depths the camera sees the scene; `None` if it lies behind the camera.
pub(super) fn seen(camera: &CameraView, bounds: Aabb) -> Option<Depths> {
    let forward = camera.forward();
    let depths = bounds.corners().map(|corner| (corner.as_dvec3() - camera.pose.position).dot(forward));
    let nearest = depths.into_iter().fold(f64::INFINITY, f64::min).max(camera.near);
    let farthest = depths.into_iter().fold(f64::NEG_INFINITY, f64::max);
    let farthest = camera.far().map_or(farthest, |limit| limit.min(farthest));
    (nearest < farthest).then_some(Depths { near: nearest, far: farthest })
}

/// Part `index` of what is seen; `None` if nothing is seen up to the greatest distance.
pub(super) fn part(camera: &CameraView, bounds: Aabb, CascadeView { index, split, .. }: CascadeView) -> Option<Depths> {
    let Depths { near, far } = seen(camera, bounds)?;
    let far = far.min(f64::from(split.distance.get()));
    // Without perspective all depths are seen alike.
    let lambda = if camera.far().is_some() { 0.0 } else { f64::from(split.lambda.get()).min(1.0) };
    let at = |index: u32| {
        let fraction = f64::from(index) / f64::from(split.count.max(1));
        let doubling = if lambda > 0.0 { near * (far / near).powf(fraction) } else { 0.0 };
        lambda * doubling + (1.0 - lambda) * (near + (far - near) * fraction)
    };
    (near < far).then(|| Depths { near: at(index), far: at(index + 1) })
}

/// The table `cascades`: of each light up to the last that has some, all of them. What no view shows is zero.
pub(super) fn rows(views: &[ViewRequest], fitted: &[Option<SunView>], camera: &CameraView, bounds: Option<Aabb>) -> Vec<CascadeRow> {
    let of = |view: &ViewRequest| if let ViewKind::Cascade(cascade) = view.kind { Some(cascade) } else { None };
    let mut rows: Vec<CascadeRow> = Vec::new();
    for (cascade, view) in views.iter().zip(fitted).filter_map(|(request, view)| Some((of(request)?, view.as_ref()?))) {
        let CascadeSplit { count, distance, .. } = cascade.split;
        let row = cascade.light as usize * count as usize + cascade.index as usize;
        let all = (cascade.light as usize + 1) * count as usize;
        rows.resize(all.max(rows.len()), <CascadeRow as bytemuck::Zeroable>::zeroed());
        let cut_off = bounds.and_then(|bounds| seen(camera, bounds)).is_some_and(|seen| seen.far > f64::from(distance.get()));
        if let Some(row) = rows.get_mut(row) {
            *row = CascadeRow {
                shadow_from_world: view.table.projection_from_world,
                texel_size: single(view.texel_size),
                depth_range: single(view.depth_range),
                end: bounds.and_then(|bounds| part(camera, bounds, cascade)).map_or(VERY_FAR, |part| single(part.far)),
                fade_end: if cut_off { distance.get() } else { VERY_FAR },
            };
        }
    }
    rows
}

/// The table `whole_scenes`: of each light up to the last that has such a view, one row. What no view shows is zero.
pub(super) fn whole_rows(views: &[ViewRequest], fitted: &[Option<SunView>]) -> Vec<CascadeRow> {
    let of = |view: &ViewRequest| if let ViewKind::WholeScene(light) = view.kind { Some(light as usize) } else { None };
    let mut rows: Vec<CascadeRow> = Vec::new();
    for (light, view) in views.iter().zip(fitted).filter_map(|(request, view)| Some((of(request)?, view.as_ref()?))) {
        rows.resize((light + 1).max(rows.len()), <CascadeRow as bytemuck::Zeroable>::zeroed());
        if let Some(row) = rows.get_mut(light) {
            *row = CascadeRow {
                shadow_from_world: view.table.projection_from_world,
                texel_size: single(view.texel_size),
                depth_range: single(view.depth_range),
                end: VERY_FAR,
                fade_end: VERY_FAR,
            };
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};
    use luminaire_graph::published::Positive;

    use super::*;
    use crate::asset::Projection;
    use crate::world::{CameraPose, Exposure, look_at};

    fn camera() -> CameraView {
        let (right, up, back) = look_at(DVec3::NEG_Z);
        let projection = Projection::Perspective { yfov: 0.9, near: 0.5, far: None };
        CameraView::new(CameraPose { position: DVec3::ZERO, right, up, back, projection, exposure: Exposure::Unchanged }, 1.5)
    }

    fn scene(far: f32) -> Aabb {
        Aabb { min: Vec3::new(-10.0, -10.0, -far), max: Vec3::new(10.0, 10.0, 5.0) }
    }

    fn cascade(index: u32, count: u32, distance: f32, lambda: f32) -> CascadeView {
        let split = CascadeSplit { count, distance: Positive::new(distance), lambda: Positive::new(lambda), snap: true };
        CascadeView { light: 0, index, split }
    }

    #[test]
    fn the_practical_scheme_lies_between_its_two_extremes() {
        let ends = |lambda: f32| -> Vec<f64> {
            (0..4).map(|index| part(&camera(), scene(128.0), cascade(index, 4, 1e9, lambda)).unwrap().far).collect()
        };
        // 0.5 to 128 is 256 times; its fourth root is 4.
        assert_eq!(ends(1.0), [2.0, 8.0, 32.0, 128.0]);
        assert_eq!(ends(0.0), [0.5 + 127.5 * 0.25, 0.5 + 127.5 * 0.5, 0.5 + 127.5 * 0.75, 128.0]);
        for ((both, log), even) in ends(0.5).iter().zip(ends(1.0)).zip(ends(0.0)) {
            assert!((both - 0.5 * (log + even)).abs() < 1e-9);
        }
    }

    #[test]
    fn parts_follow_each_other_up_to_the_distance_and_no_farther() {
        for (distance, far) in [(60.0, 60.0), (1e9, 128.0)] {
            let parts: Vec<Depths> = (0..3).map(|index| part(&camera(), scene(128.0), cascade(index, 3, distance, 0.7)).unwrap()).collect();
            assert_eq!(parts[0].near, 0.5);
            assert!(parts.windows(2).all(|pair| pair[0].far == pair[1].near && pair[0].near < pair[0].far));
            assert!((parts[2].far - far).abs() < 1e-9, "{parts:?}");
        }
        assert_eq!(part(&camera(), scene(128.0), cascade(0, 1, 0.25, 0.5)), None, "shadows end before the near plane");
        let behind = Aabb { min: Vec3::new(-1.0, -1.0, 2.0), max: Vec3::new(1.0, 1.0, 3.0) };
        assert_eq!(seen(&camera(), behind), None);
    }
}
