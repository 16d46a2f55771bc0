//! What a loader hands over: meshes, materials, images, lights, cameras, animations and a node tree, all checked.
//!
//! Guarantees: every index is in range, every number is finite (unless its field says otherwise), the nodes form a forest in
//! which parents stand before their children, and each mesh has at least one triangle.
//! Units: metres, seconds, radians, candela (point, spot), lux (directional), nits (emission); colours are linear Rec.709.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::{Affine3A, Quat, Vec2, Vec3, Vec4};

/// One vertex, as it stands in the geometry buffer: 64 bytes, all members 32-bit floats.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Vertex {
    /// Object space, metres.
    pub position: [f32; 3],
    /// Unit length, object space.
    pub normal: [f32; 3],
    /// `xyz` unit length, `w` the sign of the bitangent (glTF's convention).
    pub tangent: [f32; 4],
    /// TEXCOORD_0, or zero.
    pub uv0: [f32; 2],
    /// TEXCOORD_1, or zero.
    pub uv1: [f32; 2],
    /// COLOR_0, linear, packed as unorm8x4 (little endian, red first); white where the mesh has none.
    pub color: [u8; 4],
    /// Zero; pads the vertex to 64 bytes.
    pub padding: u32,
}

/// Triangles of one material.
#[derive(Debug, Clone)]
pub struct Mesh {
    /// For messages and dumps.
    pub name: String,
    /// Never empty.
    pub vertices: Vec<Vertex>,
    /// A triangle list; a multiple of three, every index in range.
    pub indices: Vec<u32>,
    /// Index into [`Asset::materials`].
    pub material: usize,
}

/// How alpha is used (glTF `alphaMode`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AlphaMode {
    /// Alpha is ignored.
    Opaque,
    /// Fully transparent below the cutoff, opaque at or above it.
    Mask {
        /// glTF's `alphaCutoff`.
        cutoff: f32,
    },
    /// Blended over what is behind.
    Blend,
}

/// A texture as a material uses it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TextureUse {
    /// Index into [`Asset::images`].
    pub image: usize,
    /// Filtering and addressing.
    pub sampler: Sampler,
    /// 0 or 1: which set of texture coordinates.
    pub uv_set: u32,
    /// KHR_texture_transform as a 2x3 affine matrix, applied to (u, v, 1): rows `[a, b, tx]`, `[c, d, ty]`.
    pub transform: [[f32; 3]; 2],
}

/// Filtering and addressing of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Sampler {
    /// Linear magnification (else nearest).
    pub mag_linear: bool,
    /// Linear minification (else nearest).
    pub min_linear: bool,
    /// Which mip levels are used.
    pub mip: MipFilter,
    /// Along u.
    pub wrap_u: Wrap,
    /// Along v.
    pub wrap_v: Wrap,
}

impl Default for Sampler {
    fn default() -> Sampler {
        Sampler { mag_linear: true, min_linear: true, mip: MipFilter::Linear, wrap_u: Wrap::Repeat, wrap_v: Wrap::Repeat }
    }
}

/// How mip levels are used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MipFilter {
    /// Level 0 alone.
    None,
    /// The nearest level.
    Nearest,
    /// Between two levels.
    Linear,
}

/// What happens outside of 0..1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The edge texel goes on.
    ClampToEdge,
    /// Every other tile is mirrored.
    MirroredRepeat,
    /// Tiles.
    Repeat,
}

/// A metallic-roughness material of glTF 2.0 with the extensions specular, ior, emissive_strength and unlit.
#[derive(Debug, Clone)]
pub struct Material {
    /// For messages and dumps.
    pub name: String,
    /// Linear, alpha last.
    pub base_color: [f32; 4],
    /// sRGB image; multiplies `base_color`.
    pub base_color_texture: Option<TextureUse>,
    /// 0..1.
    pub metallic: f32,
    /// Perceptual, 0..1.
    pub roughness: f32,
    /// Linear image: green roughness, blue metallic.
    pub metallic_roughness_texture: Option<TextureUse>,
    /// Linear image, tangent space.
    pub normal_texture: Option<TextureUse>,
    /// Scales x and y of the normal.
    pub normal_scale: f32,
    /// Linear image, red.
    pub occlusion_texture: Option<TextureUse>,
    /// 0..1.
    pub occlusion_strength: f32,
    /// Linear, nits: factor times KHR_materials_emissive_strength.
    pub emissive: [f32; 3],
    /// sRGB image.
    pub emissive_texture: Option<TextureUse>,
    /// Opaque, mask or blend.
    pub alpha_mode: AlphaMode,
    /// Drawn from both sides; the normal of the back is turned.
    pub double_sided: bool,
    /// KHR_materials_unlit: shown as `base_color`, takes no light.
    pub unlit: bool,
    /// KHR_materials_specular: strength of the dielectric reflection, 0..1.
    pub specular: f32,
    /// KHR_materials_specular: tint of the dielectric reflection at normal incidence, linear.
    pub specular_color: [f32; 3],
    /// KHR_materials_specular: alpha multiplies `specular`.
    pub specular_texture: Option<TextureUse>,
    /// KHR_materials_specular: sRGB, multiplies `specular_color`.
    pub specular_color_texture: Option<TextureUse>,
    /// KHR_materials_ior, 1.5 by default; 0 means F0 = 1.
    pub ior: f32,
}

impl Default for Material {
    /// glTF's default material: white, metallic 1, roughness 1.
    fn default() -> Material {
        Material {
            name: "default".to_owned(),
            base_color: [1.0; 4],
            base_color_texture: None,
            metallic: 1.0,
            roughness: 1.0,
            metallic_roughness_texture: None,
            normal_texture: None,
            normal_scale: 1.0,
            occlusion_texture: None,
            occlusion_strength: 1.0,
            emissive: [0.0; 3],
            emissive_texture: None,
            alpha_mode: AlphaMode::Opaque,
            double_sided: false,
            unlit: false,
            specular: 1.0,
            specular_color: [1.0; 3],
            specular_texture: None,
            specular_color_texture: None,
            ior: 1.5,
        }
    }
}

/// A decoded image: 8 bits per channel, RGBA, row 0 on top, no mips.
#[derive(Debug, Clone)]
pub struct Image {
    /// For messages and dumps.
    pub name: String,
    /// At least 1.
    pub width: u32,
    /// At least 1.
    pub height: u32,
    /// `width * height * 4` bytes, as stored in the file (sRGB images stay sRGB).
    pub rgba: Arc<[u8]>,
}

/// The shape of a light's emission.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LightKind {
    /// From infinitely far away along the node's -Z; intensity in lux.
    Directional,
    /// From a point; intensity in candela.
    Point,
    /// A point with a cone along the node's -Z; intensity in candela on the axis.
    Spot {
        /// Half angle of the full-strength cone, radians.
        inner: f32,
        /// Half angle at which light ends, radians; greater than `inner`.
        outer: f32,
    },
}

/// A light of KHR_lights_punctual.
#[derive(Debug, Clone)]
pub struct Light {
    /// For messages and dumps.
    pub name: String,
    /// Directional, point or spot.
    pub kind: LightKind,
    /// Linear Rec.709.
    pub color: [f32; 3],
    /// Candela or lux, not negative.
    pub intensity: f32,
    /// Metres, greater than zero; `None` is pure inverse square without end.
    pub range: Option<f32>,
}

/// A projection. The camera looks along its node's -Z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    /// Perspective.
    Perspective {
        /// Vertical field of view, radians.
        yfov: f32,
        /// Near plane, metres, greater than zero.
        near: f32,
        /// Far plane; `None` is infinitely far.
        far: Option<f32>,
    },
    /// Orthographic.
    Orthographic {
        /// Half of the visible height, metres.
        ymag: f32,
        /// Half of the visible width, metres.
        xmag: f32,
        /// Near plane, metres.
        near: f32,
        /// Far plane, metres, greater than `near`.
        far: f32,
    },
}

/// A camera.
#[derive(Debug, Clone)]
pub struct Camera {
    /// For `--camera NAME`.
    pub name: String,
    /// Perspective or orthographic.
    pub projection: Projection,
}

/// A transform in parts: scale, then rotation, then translation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Metres.
    pub translation: Vec3,
    /// Unit length.
    pub rotation: Quat,
    /// Per axis; may be zero or negative.
    pub scale: Vec3,
}

impl Default for Pose {
    fn default() -> Pose {
        Pose { translation: Vec3::ZERO, rotation: Quat::IDENTITY, scale: Vec3::ONE }
    }
}

impl Pose {
    /// All parts in one.
    pub fn matrix(&self) -> Affine3A {
        Affine3A::from_scale_rotation_translation(self.scale, self.rotation, self.translation)
    }
}

/// What an animation moves of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Property {
    /// [`Pose::translation`].
    Translation,
    /// [`Pose::rotation`].
    Rotation,
    /// [`Pose::scale`].
    Scale,
}

/// What lies between two keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// The value of the key before.
    Step,
    /// A straight line; for rotations the shorter arc of a great circle, at constant speed.
    Linear,
    /// A cubic Hermite spline; for rotations on the four components, which are normalised afterwards.
    CubicSpline,
}

/// One property of one node over time.
#[derive(Debug, Clone)]
pub struct Channel {
    /// Index into [`Asset::nodes`]; the node has a [`Node::pose`].
    pub node: usize,
    /// What moves.
    pub property: Property,
    /// How values between keys come about.
    pub interpolation: Interpolation,
    /// Keys, seconds: at least one, none before its predecessor. Two at one time are a jump.
    pub times: Arc<[f32]>,
    /// A value for each key; with [`Interpolation::CubicSpline`] three: the tangent towards the key (per second), the value, the
    /// tangent away from it. `xyz` of translations and scales, `xyzw` of rotations.
    pub values: Arc<[Vec4]>,
}

/// Motion of nodes that belongs together.
#[derive(Debug, Clone)]
pub struct Animation {
    /// To choose it by.
    pub name: String,
    /// Seconds from 0 to the last key, of channels that are left out, too.
    pub duration: f32,
    /// Each property of a node stands here once at most. Empty if the animation moves nothing that the scene uses.
    pub channels: Vec<Channel>,
}

/// A place in the hierarchy.
#[derive(Debug, Clone)]
pub struct Node {
    /// For messages, cameras and animation.
    pub name: String,
    /// Index of the parent, always smaller than this node's own index.
    pub parent: Option<usize>,
    /// To the parent's space. May be singular (a scale of zero).
    pub local: Affine3A,
    /// The parts of `local`, where the file gives them apart.
    pub pose: Option<Pose>,
    /// Indices into [`Asset::meshes`]: a glTF mesh is one entry per primitive that holds triangles.
    pub meshes: Vec<usize>,
    /// Index into [`Asset::lights`].
    pub light: Option<usize>,
    /// Index into [`Asset::cameras`].
    pub camera: Option<usize>,
}

/// Everything that one file holds and its default scene uses.
#[derive(Debug, Clone, Default)]
pub struct Asset {
    /// Nodes of the default scene, parents first.
    pub nodes: Vec<Node>,
    /// Triangles.
    pub meshes: Vec<Mesh>,
    /// At least one if there is a mesh.
    pub materials: Vec<Material>,
    /// Decoded images, each once.
    pub images: Vec<Image>,
    /// Lights.
    pub lights: Vec<Light>,
    /// Cameras.
    pub cameras: Vec<Camera>,
    /// In the order of the file.
    pub animations: Vec<Animation>,
}

impl TextureUse {
    /// Applies the texture transform.
    pub fn transformed(&self, uv: Vec2) -> Vec2 {
        let [a, b] = self.transform;
        let uv = Vec3::new(uv.x, uv.y, 1.0);
        Vec2::new(Vec3::from(a).dot(uv), Vec3::from(b).dot(uv))
    }
}
