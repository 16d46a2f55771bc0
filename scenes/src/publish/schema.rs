//! What shaders may declare by name and get, and how it lies in memory.

use std::mem::{offset_of, size_of};

use indexmap::IndexMap;
use luminaire_graph::published::{
    Collection, PublishedSchema, TableKind, TableMember, TableSchema, VertexAttribute, VertexFormat, VertexSchema,
};

use super::layout::{
    CameraTable, CascadeRow, DirectionalRow, EnvironmentTable, InstanceRow, LocalRow, MaterialRow, PointRow, ProbeRow, RectangleRow,
    SpotRow, TEXTURES, ViewTable,
};
use crate::asset::Vertex;

/// Textures of a material, in the order of the bits of `uv_sets` and the rows of `uv_transforms`.
pub const TEXTURE_NAMES: [&str; TEXTURES] = [
    "base_color_texture",
    "metallic_roughness_texture",
    "normal_texture",
    "occlusion_texture",
    "emissive_texture",
    "specular_texture",
    "specular_color_texture",
];

/// Names of counts, in the order of [`super::counts`].
pub const COUNT_NAMES: [&str; 9] = [
    "directional_lights",
    "point_lights",
    "spot_lights",
    "local_lights",
    "rectangle_lights",
    "reflection_probes",
    "opaque",
    "masked",
    "blended",
];

/// The image of the sky.
pub(super) const SKY_IMAGE: &str = "sky_image";

/// Tables of which a Draw sees what it draws.
const PER_DRAW: [&str; 3] = ["instances", "instance_slots", "materials"];

/// Members with their offsets, which come from the struct itself. What pads it is no member.
macro_rules! members {
    ($row:ty { $($name:ident: $wgsl:literal),* $(,)? }) => {
        vec![$(TableMember {
            name: stringify!($name).to_owned(),
            wgsl: $wgsl.to_owned(),
            offset: offset_of!($row, $name) as u32,
        }),*]
    };
}

/// The schema of every scene: it depends on no world.
pub fn schema() -> PublishedSchema {
    let mut tables = IndexMap::new();
    let mut add = |name: &str, kind, doc: &str, stride: usize, members| {
        let per_draw = PER_DRAW.contains(&name);
        tables.insert(name.to_owned(), TableSchema { kind, doc: doc.to_owned(), members, stride: stride as u32, per_draw });
    };
    add(
        "camera",
        TableKind::Uniform,
        "The camera that renders; reversed depth, 1 near and 0 infinitely far.",
        size_of::<CameraTable>(),
        members!(CameraTable {
            projection_from_world: "mat4x4<f32>",
            world_from_projection: "mat4x4<f32>",
            view_from_world: "mat4x4<f32>",
            world_from_view: "mat4x4<f32>",
            position: "vec3<f32>",
            exposure: "f32",
            forward: "vec3<f32>",
            near: "f32",
        }),
    );
    add(
        "view",
        TableKind::View,
        "Where the pass draws from; all views but the camera's have depth 0 near and 1 far.",
        size_of::<ViewTable>(),
        members!(ViewTable { projection_from_world: "mat4x4<f32>", position: "vec3<f32>", near: "f32", forward: "vec3<f32>", far: "f32" }),
    );
    add(
        "environment",
        TableKind::Uniform,
        "The sky, the unit of light in half floats, and the counts of lights.",
        size_of::<EnvironmentTable>(),
        members!(EnvironmentTable {
            sky_radiance: "vec3<f32>",
            light_unit: "f32",
            inverse_light_unit: "f32",
            directional_count: "u32",
            local_count: "u32",
            rectangle_count: "u32",
            sky_strength: "f32",
            sky_rotation: "f32",
            sky_unit: "f32",
            sky_has_faces: "u32",
        }),
    );
    add(
        "directional_lights",
        TableKind::Storage,
        "Lights from infinitely far away, lux.",
        size_of::<DirectionalRow>(),
        members!(DirectionalRow {
            direction_to_light: "vec3<f32>",
            shadow_texel_size: "f32",
            illuminance: "vec3<f32>",
            shadow_depth_range: "f32",
            shadow_from_world: "mat4x4<f32>",
            cascades: "u32",
        }),
    );
    add(
        "cascades",
        TableKind::Storage,
        "Shadow views of directional lights, each fitted to a part of what the camera sees.",
        size_of::<CascadeRow>(),
        members!(CascadeRow { shadow_from_world: "mat4x4<f32>", texel_size: "f32", depth_range: "f32", end: "f32", fade_end: "f32" }),
    );
    add(
        "whole_scenes",
        TableKind::Storage,
        "Shadow views of directional lights over all of the scene, one for each light.",
        size_of::<CascadeRow>(),
        members!(CascadeRow { shadow_from_world: "mat4x4<f32>", texel_size: "f32", depth_range: "f32", end: "f32", fade_end: "f32" }),
    );
    add(
        "local_lights",
        TableKind::Storage,
        "Point and spot lights, candela.",
        size_of::<LocalRow>(),
        members!(LocalRow {
            position: "vec3<f32>",
            range: "f32",
            intensity: "vec3<f32>",
            reach: "f32",
            direction: "vec3<f32>",
            shadow: "i32",
            spot_scale: "f32",
            spot_offset: "f32",
        }),
    );
    add(
        "point_lights",
        TableKind::Storage,
        "The shadow cubes of point lights, and of spots with a half angle beyond 67.8 degrees.",
        size_of::<PointRow>(),
        members!(PointRow { position: "vec3<f32>", near: "f32", far: "f32", light: "u32" }),
    );
    add(
        "spot_lights",
        TableKind::Storage,
        "The shadow views of spot lights.",
        size_of::<SpotRow>(),
        members!(SpotRow { shadow_from_world: "mat4x4<f32>", near: "f32", far: "f32", half_width: "f32", light: "u32" }),
    );
    add(
        "rectangle_lights",
        TableKind::Storage,
        "Rectangles that glow, nits.",
        size_of::<RectangleRow>(),
        members!(RectangleRow {
            position: "vec3<f32>",
            two_sided: "u32",
            half_width: "vec3<f32>",
            radius: "f32",
            half_height: "vec3<f32>",
            area: "f32",
            radiance: "vec3<f32>",
            near: "f32",
            far: "f32",
        }),
    );
    add(
        "reflection_probes",
        TableKind::Storage,
        "Places from which the scene is captured, each with a box.",
        size_of::<ProbeRow>(),
        members!(ProbeRow { position: "vec3<f32>", near: "f32", box_from_world: "mat4x4<f32>", far: "f32" }),
    );
    add(
        "instances",
        TableKind::Storage,
        "Objects, by their stable slot; slots that nobody holds are zero.",
        size_of::<InstanceRow>(),
        members!(InstanceRow {
            world_from_object: "mat4x4<f32>",
            normal_from_object_0: "vec4<f32>",
            normal_from_object_1: "vec4<f32>",
            normal_from_object_2: "vec4<f32>",
            material: "u32",
            object: "u32",
        }),
    );
    add("instance_slots", TableKind::Storage, "Row of `instances` for each instance index of a draw.", size_of::<u32>(), Vec::new());
    add(
        "materials",
        TableKind::Storage,
        "Metallic-roughness materials of glTF 2.0.",
        size_of::<MaterialRow>(),
        members!(MaterialRow {
            base_color: "vec4<f32>",
            emissive: "vec3<f32>",
            metallic: "f32",
            roughness: "f32",
            normal_scale: "f32",
            occlusion_strength: "f32",
            alpha_cutoff: "f32",
            specular_color: "vec3<f32>",
            specular: "f32",
            ior: "f32",
            flags: "u32",
            uv_sets: "u32",
            uv_transforms: "array<vec4<f32>, 14>",
        }),
    );
    PublishedSchema {
        tables,
        textures: vec![SKY_IMAGE.to_owned()],
        material_textures: TEXTURE_NAMES.map(str::to_owned).to_vec(),
        material_samplers: TEXTURE_NAMES.map(|name| name.replace("_texture", "_sampler")).to_vec(),
        vertex: vertex_schema(),
        counts: COUNT_NAMES.map(str::to_owned).to_vec(),
        collections: ["directional_lights", "point_lights", "spot_lights", "local_lights", "rectangle_lights", "reflection_probes"]
            .map(|table| (table.to_owned(), Collection { table: table.to_owned(), element: table.trim_end_matches('s').to_owned() }))
            .into_iter()
            .collect(),
    }
}

fn vertex_schema() -> VertexSchema {
    let attributes = [
        ("position", VertexFormat::Float32x3, offset_of!(Vertex, position)),
        ("normal", VertexFormat::Float32x3, offset_of!(Vertex, normal)),
        ("tangent", VertexFormat::Float32x4, offset_of!(Vertex, tangent)),
        ("uv0", VertexFormat::Float32x2, offset_of!(Vertex, uv0)),
        ("uv1", VertexFormat::Float32x2, offset_of!(Vertex, uv1)),
        ("color", VertexFormat::Unorm8x4, offset_of!(Vertex, color)),
    ];
    VertexSchema {
        stride: size_of::<Vertex>() as u32,
        attributes: attributes
            .into_iter()
            .map(|(name, format, offset)| (name.to_owned(), VertexAttribute { format, offset: offset as u32 }))
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use std::fmt::Write;

    use super::*;

    #[test]
    fn offsets_and_strides_are_those_of_wgsl() {
        for (name, table) in schema().tables {
            if table.members.is_empty() {
                continue;
            }
            let mut source = String::from("struct Row {\n");
            for member in &table.members {
                writeln!(source, "    {}: {},", member.name, member.wgsl).unwrap();
            }
            source.push_str("}\n@group(0) @binding(0) var<storage, read> rows: array<Row>;\n");
            let module = naga::front::wgsl::parse_str(&source).unwrap();
            let (_, row) = module.types.iter().find(|(_, known)| known.name.as_deref() == Some("Row")).unwrap();
            let naga::TypeInner::Struct { members, .. } = &row.inner else { panic!("{name} is no struct") };
            let expected: Vec<u32> = members.iter().map(|member| member.offset).collect();
            let actual: Vec<u32> = table.members.iter().map(|member| member.offset).collect();
            assert_eq!(actual, expected, "{name}");
            let stride = module.types.iter().find_map(|(_, known)| match known.inner {
                naga::TypeInner::Array { size: naga::ArraySize::Dynamic, stride, .. } => Some(stride),
                _ => None,
            });
            assert_eq!(Some(table.stride), stride, "{name}");
        }
    }

    #[test]
    fn strides_are_as_agreed() {
        let strides: Vec<(String, u32)> = schema().tables.into_iter().map(|(name, table)| (name, table.stride)).collect();
        let expected = [
            ("camera", 288),
            ("view", 96),
            ("environment", 48),
            ("directional_lights", 112),
            ("cascades", 80),
            ("whole_scenes", 80),
            ("local_lights", 64),
            ("point_lights", 32),
            ("spot_lights", 80),
            ("rectangle_lights", 80),
            ("reflection_probes", 96),
            ("instances", 128),
            ("instance_slots", 4),
            ("materials", 304),
        ];
        assert_eq!(strides, expected.map(|(name, stride)| (name.to_owned(), stride)));
        assert_eq!(schema().vertex.stride, 64);
        assert_eq!(schema().material_samplers[6], "specular_color_sampler");
    }
}
