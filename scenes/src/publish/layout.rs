//! The rows of published tables as they stand in memory.
//!
//! Each struct is `repr(C)` without implicit padding and follows WGSL's layout rules: a `vec3<f32>` is aligned to 16 bytes, and
//! what follows it may take the fourth word. The tests of [`super::schema`] hold them against naga's layout.

use bytemuck::{Pod, Zeroable};

/// A matrix, column by column.
pub type Columns = [[f32; 4]; 4];

/// Uniform `camera`: the camera that renders. Depth is reversed: 1 on the near plane, 0 infinitely far away.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)]
pub struct CameraTable {
    pub projection_from_world: Columns,
    pub world_from_projection: Columns,
    pub view_from_world: Columns,
    pub world_from_view: Columns,
    pub position: [f32; 3],
    /// Factor on radiance before tone mapping.
    pub exposure: f32,
    pub forward: [f32; 3],
    pub near: f32,
}

/// Uniform `view`: where a pass draws from. All but the camera's run from 0 on the near plane to 1 on the far plane.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)]
pub struct ViewTable {
    pub projection_from_world: Columns,
    pub position: [f32; 3],
    pub near: f32,
    pub forward: [f32; 3],
    /// 0 where there is no far plane.
    pub far: f32,
}

/// Uniform `environment`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)]
pub struct EnvironmentTable {
    pub sky_radiance: [f32; 3],
    /// A power of two: half floats hold radiance divided by it.
    pub light_unit: f32,
    pub inverse_light_unit: f32,
    /// Rows of `directional_lights`.
    pub directional_count: u32,
    /// Rows of `local_lights`.
    pub local_count: u32,
    /// Rows of `rectangle_lights`.
    pub rectangle_count: u32,
    /// Factor on the image of the sky; 0 where there is none.
    pub sky_strength: f32,
    /// By how much that is turned about +Y, radians.
    pub sky_rotation: f32,
    /// A power of two: the image's brightest texel divided by it is at most 32,768.
    pub sky_unit: f32,
    /// 1 where the image holds the six faces of a cube, 0 where it is equirectangular.
    pub sky_has_faces: u32,
}

/// An element of `directional_lights`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)]
pub struct DirectionalRow {
    pub direction_to_light: [f32; 3],
    /// Metres along one texel of the shadow map; 0 without a shadow view, as are the other shadow members.
    pub shadow_texel_size: f32,
    /// Lux on a surface that faces the light, linear Rec.709.
    pub illuminance: [f32; 3],
    /// Metres between depth 0 and depth 1.
    pub shadow_depth_range: f32,
    pub shadow_from_world: Columns,
    /// How many cascades it has; 0 is none. Cascade c of light l is row `l * cascades + c` of `cascades`.
    pub cascades: u32,
    pub pad: [u32; 3],
}

/// An element of `cascades`, and of `whole_scenes`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)]
pub struct CascadeRow {
    pub shadow_from_world: Columns,
    /// Metres along one texel of the map; 0 where there is no map.
    pub texel_size: f32,
    /// Metres between depth 0 and depth 1.
    pub depth_range: f32,
    /// Metres along the camera's axis to where this part of the frustum ends.
    pub end: f32,
    /// Metres along the camera's axis to where shadows end; very far where the scene ends first.
    pub fade_end: f32,
}

/// An element of `local_lights`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)]
pub struct LocalRow {
    pub position: [f32; 3],
    /// Metres; 0 is without end.
    pub range: f32,
    /// Candela, linear Rec.709.
    pub intensity: [f32; 3],
    /// Metres beyond which it gives no light; 0 is without end.
    pub reach: f32,
    /// Along the light's axis.
    pub direction: [f32; 3],
    /// Which shadow map is its own: row k of `point_lights` as k, row k of `spot_lights` as -1 - k.
    pub shadow: i32,
    /// Cone attenuation is `saturate(cos * spot_scale + spot_offset)^2`; 0 and 1 for point lights.
    pub spot_scale: f32,
    pub spot_offset: f32,
    pub pad: [f32; 2],
}

/// An element of `point_lights`: a light whose shadows need a cube.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)]
pub struct PointRow {
    pub position: [f32; 3],
    /// Near plane of the cube faces, metres.
    pub near: f32,
    /// Far plane of the cube faces, metres; 0 where there is no light.
    pub far: f32,
    /// Row of `local_lights`.
    pub light: u32,
    pub pad: [u32; 2],
}

/// An element of `spot_lights`: a light whose shadows need one map.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)]
pub struct SpotRow {
    pub shadow_from_world: Columns,
    /// Near plane, metres along the light's axis.
    pub near: f32,
    /// Far plane, metres along the light's axis; 0 where there is no light.
    pub far: f32,
    /// Half the map's width, a metre from the light.
    pub half_width: f32,
    /// Row of `local_lights`.
    pub light: u32,
}

/// An element of `rectangle_lights`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)]
pub struct RectangleRow {
    /// The middle.
    pub position: [f32; 3],
    /// 1 where it emits to both sides, else 0.
    pub two_sided: u32,
    /// From the middle to the end of its width, metres. It faces along the cross product of this and `half_height`.
    pub half_width: [f32; 3],
    /// From the middle to a corner, metres.
    pub radius: f32,
    /// From the middle to the end of its height, metres.
    pub half_height: [f32; 3],
    /// Square metres.
    pub area: f32,
    /// Nits, linear Rec.709, the same in all directions.
    pub radiance: [f32; 3],
    /// Near plane of the faces of its shadow cube, metres.
    pub near: f32,
    /// Far plane of the faces, metres; 0 where there is no light.
    pub far: f32,
    pub pad: [f32; 3],
}

/// An element of `reflection_probes`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)]
pub struct ProbeRow {
    /// From where it captures: the middle of its box.
    pub position: [f32; 3],
    /// Near plane of the cube faces, metres.
    pub near: f32,
    /// World to the box, whose corners are at -1 and 1.
    pub box_from_world: Columns,
    /// Far plane of the faces, metres; 0 where there is no probe.
    pub far: f32,
    pub pad: [f32; 3],
}

/// An element of `instances`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)]
pub struct InstanceRow {
    pub world_from_object: Columns,
    /// First column of the inverse transpose; `w` is +1, or -1 where the transform mirrors.
    pub normal_from_object_0: [f32; 4],
    pub normal_from_object_1: [f32; 4],
    pub normal_from_object_2: [f32; 4],
    /// Row of `materials`.
    pub material: u32,
    /// The object's stable number: its own row.
    pub object: u32,
    pub pad0: u32,
    pub pad1: u32,
}

/// An element of `materials`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)]
pub struct MaterialRow {
    pub base_color: [f32; 4],
    pub emissive: [f32; 3],
    pub metallic: f32,
    pub roughness: f32,
    pub normal_scale: f32,
    pub occlusion_strength: f32,
    pub alpha_cutoff: f32,
    pub specular_color: [f32; 3],
    pub specular: f32,
    pub ior: f32,
    /// See [`flags`].
    pub flags: u32,
    /// Bit i: texture i is sampled with the second set of texture coordinates.
    pub uv_sets: u32,
    pub alpha_unused: f32,
    /// For texture i: rows 2i and 2i+1 are (a, b, tx, 0) and (c, d, ty, 0).
    pub uv_transforms: [[f32; 4]; 2 * TEXTURES],
}

/// Textures of a material.
pub const TEXTURES: usize = 7;

/// Bits of [`MaterialRow::flags`].
pub mod flags {
    /// Alpha below the cutoff is not drawn.
    pub const MASKED: u32 = 1;
    /// Seen from both sides.
    pub const DOUBLE_SIDED: u32 = 2;
    /// Shown as its base color.
    pub const UNLIT: u32 = 4;
    /// Blended over what is behind.
    pub const BLEND: u32 = 8;
    /// Has a normal texture.
    pub const NORMAL_TEXTURE: u32 = 16;
}
