//! What entities carry. Hierarchy and names are `bevy_ecs`'s own ([`super::ChildOf`], [`super::Children`], [`super::Name`]).

use bevy_ecs::prelude::Component;
use glam::{Affine3A, UVec3, Vec2, Vec3};

use super::Shown;
use super::slots::{give_back, take};
use crate::asset::Projection;

/// To the space of the parent entity, or of the world where there is none. May be singular.
#[derive(Component, Debug, Clone, Copy, PartialEq, Default)]
#[require(GlobalTransform, Shown)]
pub struct Transform(pub Affine3A);

/// To world space; written by [`super::propagate_transforms`]. Not finite where a product overflowed: such entities publish
/// nothing.
#[derive(Component, Debug, Clone, Copy, PartialEq, Default)]
pub struct GlobalTransform(pub Affine3A);

/// A mesh that is drawn with a material.
#[derive(Component, Debug, Clone, Copy, PartialEq, Eq)]
#[require(Transform)]
pub struct MeshInstance {
    /// Index into [`super::Meshes`].
    pub mesh: usize,
    /// Index into [`super::Materials`].
    pub material: usize,
}

/// Light from infinitely far away along the entity's -Z.
#[derive(Component, Debug, Clone, Copy, PartialEq)]
#[require(Transform)]
pub struct DirectionalLight {
    /// Linear Rec.709.
    pub color: Vec3,
    /// Lux, not negative.
    pub illuminance: f32,
}

/// Light from a point, everywhere or in a cone along the entity's -Z.
#[derive(Component, Debug, Clone, Copy, PartialEq)]
#[require(Transform)]
pub struct LocalLight {
    /// Linear Rec.709.
    pub color: Vec3,
    /// Candela, not negative.
    pub intensity: f32,
    /// Metres; `None` is inverse square without end.
    pub range: Option<f32>,
    /// `None` for a point light.
    pub cone: Option<Cone>,
}

/// The cone of a spot light: half angles in radians, `inner` smaller than `outer`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    /// Where full strength ends.
    pub inner: f32,
    /// Where light ends.
    pub outer: f32,
}

impl Cone {
    /// The widest half angle for one shadow map, the arc tangent of the square root of 6: beyond, the texels in the middle of a map as large
    /// as six faces of a cube are coarser than those of the cube.
    pub const WIDEST_MAP: f32 = 1.183_199_6;

    /// Whether its shadows need a cube. What is no number counts as wide.
    pub fn is_wide(self) -> bool {
        self.outer.is_nan() || self.outer.abs() > Cone::WIDEST_MAP
    }
}

/// Light from a rectangle around the entity's origin that faces along its -Z. The mesh of the same entity shows it, or that of its parent.
/// It is stretched and mirrored with what shows it.
#[derive(Component, Debug, Clone, Copy, PartialEq)]
#[require(Transform)]
pub struct RectangleLight {
    /// Linear Rec.709.
    pub color: Vec3,
    /// Nits, the same in all directions, not negative.
    pub luminance: f32,
    /// Width along x and height along y, metres.
    pub size: Vec2,
    /// Emits to +Z as well.
    pub two_sided: bool,
}

/// Where probes for diffuse light stand: a grid around the entity's origin, along its axes.
#[derive(Component, Debug, Clone, Copy, PartialEq)]
#[require(Transform)]
pub struct ProbeVolume {
    /// Probes along x, y and z, at least 1 each.
    pub counts: UVec3,
    /// From probe to probe, metres, greater than zero.
    pub spacing: Vec3,
}

impl ProbeVolume {
    /// Where the probe of these indices stands, in the entity's space.
    pub fn position(&self, index: UVec3) -> Vec3 {
        (index.as_vec3() - 0.5 * (self.counts.as_vec3() - 1.0)) * self.spacing
    }
}

/// A probe for reflections at the entity's origin.
#[derive(Component, Debug, Clone, Copy, PartialEq)]
#[require(Transform)]
pub struct ReflectionProbe {
    /// Edges of the box around it in which it counts, metres.
    pub size: Vec3,
    /// Nothing nearer is captured, metres.
    pub near: f32,
    /// Nothing farther is captured, metres.
    pub far: f32,
}

/// A box around the entity's origin, along its axes, that techniques can be limited to.
#[derive(Component, Debug, Clone, Copy, PartialEq)]
#[require(Transform)]
pub struct Volume {
    /// Edges, metres.
    pub size: Vec3,
}

/// A camera, looking along the entity's -Z. Scale of its transform is ignored.
#[derive(Component, Debug, Clone, PartialEq)]
#[require(Transform)]
pub struct Camera {
    /// For `--camera NAME`; the entity's name works as well.
    pub name: String,
    /// The vertical extent counts; the horizontal one follows the image.
    pub projection: Projection,
    /// What radiance is multiplied with before it is shown.
    pub exposure: Exposure,
}

/// A factor on radiance. What is not finite counts as [`Exposure::Unchanged`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Exposure {
    /// 1: radiance stays as it is.
    #[default]
    Unchanged,
    /// By an exposure value at ISO 100: `1 / (1.2 * 2^EV100)`.
    Ev100(f32),
    /// By hand: this factor; less than 0 counts as 0.
    Factor(f32),
}

/// Row of a [`MeshInstance`] in the table `instances`.
#[derive(Component, Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[component(on_insert = take::<ObjectSlot>, on_discard = give_back::<ObjectSlot>)]
pub struct ObjectSlot(pub u32);

/// Row of a [`DirectionalLight`] in the table `directional_lights`.
#[derive(Component, Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[component(on_insert = take::<DirectionalSlot>, on_discard = give_back::<DirectionalSlot>)]
pub struct DirectionalSlot(pub u32);

/// Row of a [`RectangleLight`] in the table `rectangle_lights`.
#[derive(Component, Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[component(on_insert = take::<RectangleSlot>, on_discard = give_back::<RectangleSlot>)]
pub struct RectangleSlot(pub u32);

/// Row of a [`ReflectionProbe`] in the table `reflection_probes`.
#[derive(Component, Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[component(on_insert = take::<ProbeSlot>, on_discard = give_back::<ProbeSlot>)]
pub struct ProbeSlot(pub u32);

/// Row of a [`LocalLight`] in the table `local_lights`.
#[derive(Component, Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[component(on_insert = take::<LocalSlot>, on_discard = give_back::<LocalSlot>)]
pub struct LocalSlot(pub u32);

/// Row in the table `point_lights` of a [`LocalLight`] whose shadows need a cube: point lights, and spots with a [wide](Cone::is_wide) cone.
#[derive(Component, Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[component(on_insert = take::<PointSlot>, on_discard = give_back::<PointSlot>)]
pub struct PointSlot(pub u32);

/// Row in the table `spot_lights` of a [`LocalLight`] whose shadows need one map.
#[derive(Component, Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[component(on_insert = take::<SpotSlot>, on_discard = give_back::<SpotSlot>)]
pub struct SpotSlot(pub u32);

/// Order of a [`Camera`] among cameras: the lowest is the default one.
#[derive(Component, Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[component(on_insert = take::<CameraSlot>, on_discard = give_back::<CameraSlot>)]
pub struct CameraSlot(pub u32);
