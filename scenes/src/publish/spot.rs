//! The shadow view of a spot light: one perspective map over its outer cone.
//!
//! The square is a little wider than the cone, so that filters find texels around what is lit. Its size depends on no map, and near and far
//! plane are those of [`super::reach`], so a light that stands still has the same view whatever the camera does. Accepted downside: texels
//! in the middle are coarser the wider the cone is; cones that would waste more than a cube does get one ([`crate::world::Cone::is_wide`]).

use glam::{DMat4, DVec3, DVec4};

use super::frustum::Frustum;
use super::layout::ViewTable;
use super::lights::Lamp;
use super::projection::{columns, single, vector};
use crate::world::look_at;

/// Width of the map over that of the cone.
const MARGIN: f64 = 1.03;
/// The narrowest cone that a map is made for, radians; narrower ones have a map as wide.
const NARROWEST: f64 = 1e-3;

/// The view of a spot.
#[derive(Debug, Clone)]
pub(super) struct SpotView {
    pub(super) table: ViewTable,
    /// Half of the map's width, a metre from the light.
    pub(super) half: f64,
    /// What can throw a shadow into it.
    pub(super) casters: Frustum,
}

impl SpotView {
    pub(super) fn of(lamp: &Lamp) -> SpotView {
        let outer = lamp.cone.map_or(NARROWEST, |cone| f64::from(cone.outer).abs().max(NARROWEST));
        let half = outer.min(f64::from(crate::world::Cone::WIDEST_MAP)).tan() * MARGIN;
        let (right, up, back) = look_at(lamp.axis);
        let (forward, position, [near, far]) = (-back, lamp.position, lamp.reach.planes);
        let row = |axis: DVec3| axis.extend(-axis.dot(position));
        let scale = far / (far - near);
        let projection_from_world =
            DMat4::from_cols(row(right) / half, row(up) / half, row(forward) * scale - DVec4::W * (near * scale), row(forward)).transpose();
        let table = ViewTable {
            projection_from_world: columns(projection_from_world),
            position: vector(position),
            near: single(near),
            forward: vector(forward),
            far: single(far),
        };
        SpotView { table, half, casters: Frustum::pyramid(position, [right, up], forward, half, far) }
    }
}
