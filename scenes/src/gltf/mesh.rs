//! Meshes and primitives as they stand in the file: which accessor is which attribute.
//!
//! Guarantees: every attribute has a type that the format (or KHR_mesh_quantization, always taken as on) allows and as many elements as POSITION.
//! Primitives of points and lines and those without POSITION are left out, with a warning. No vertex has been read yet.

use std::collections::BTreeMap;

use super::accessor::Accessor;
use super::element::{Component, Kind};
use super::json::Json;

/// How vertices form triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mode {
    List,
    Strip,
    Fan,
}

/// A checked mesh.
pub(super) struct MeshSource<'a> {
    pub(super) name: String,
    /// Default weights of the morph targets.
    pub(super) weights: Vec<f32>,
    pub(super) primitives: Vec<Primitive<'a>>,
}

/// A checked primitive of triangles.
pub(super) struct Primitive<'a> {
    /// The JSON path, for messages.
    pub(super) place: String,
    pub(super) mode: Mode,
    pub(super) material: Option<usize>,
    pub(super) indices: Option<&'a Accessor<'a>>,
    pub(super) position: &'a Accessor<'a>,
    pub(super) normal: Option<&'a Accessor<'a>>,
    pub(super) tangent: Option<&'a Accessor<'a>>,
    pub(super) color: Option<&'a Accessor<'a>>,
    /// TEXCOORD_n by n.
    pub(super) uvs: BTreeMap<u32, &'a Accessor<'a>>,
    /// JOINTS_n and WEIGHTS_n, in pairs.
    pub(super) influences: Vec<(&'a Accessor<'a>, &'a Accessor<'a>)>,
    pub(super) targets: Vec<Target<'a>>,
}

/// What a morph target adds.
pub(super) struct Target<'a> {
    pub(super) position: Option<&'a Accessor<'a>>,
    pub(super) normal: Option<&'a Accessor<'a>>,
}

/// What an accessor is used as, which decides its allowed types.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Semantic {
    Position,
    Normal,
    Tangent,
    TangentDelta,
    TexCoord,
    Color,
    Joints,
    Weights,
    Indices,
    InverseBindMatrices,
}

impl Semantic {
    fn allows(self, accessor: &Accessor<'_>) -> bool {
        let (kind, component, normalized) = (accessor.kind, accessor.component, accessor.normalized);
        let float = component == Component::F32;
        let small = matches!(component, Component::I8 | Component::U8 | Component::I16 | Component::U16);
        let signed = matches!(component, Component::I8 | Component::I16) && normalized;
        let unsigned = matches!(component, Component::U8 | Component::U16);
        match self {
            Semantic::Position => kind == Kind::Vec3 && (float || small),
            Semantic::Normal | Semantic::TangentDelta => kind == Kind::Vec3 && (float || signed),
            Semantic::Tangent => kind == Kind::Vec4 && (float || signed),
            Semantic::TexCoord => kind == Kind::Vec2 && (float || small),
            Semantic::Color => matches!(kind, Kind::Vec3 | Kind::Vec4) && (float || unsigned && normalized),
            Semantic::Joints => kind == Kind::Vec4 && unsigned && !normalized,
            Semantic::Weights => kind == Kind::Vec4 && (float || unsigned && normalized),
            Semantic::Indices => kind == Kind::Scalar && (unsigned || component == Component::U32) && !normalized,
            Semantic::InverseBindMatrices => kind == Kind::Mat4 && float,
        }
    }

    fn expected(self) -> &'static str {
        match self {
            Semantic::Position => "VEC3 of FLOAT, or of 8 or 16 bit integers",
            Semantic::Normal | Semantic::TangentDelta => "VEC3 of FLOAT, or of normalized BYTE or SHORT",
            Semantic::Tangent => "VEC4 of FLOAT, or of normalized BYTE or SHORT",
            Semantic::TexCoord => "VEC2 of FLOAT, or of 8 or 16 bit integers",
            Semantic::Color => "VEC3 or VEC4 of FLOAT, or of normalized UNSIGNED_BYTE or UNSIGNED_SHORT",
            Semantic::Joints => "VEC4 of UNSIGNED_BYTE or UNSIGNED_SHORT",
            Semantic::Weights => "VEC4 of FLOAT, or of normalized UNSIGNED_BYTE or UNSIGNED_SHORT",
            Semantic::Indices => "SCALAR of UNSIGNED_BYTE, UNSIGNED_SHORT or UNSIGNED_INT",
            Semantic::InverseBindMatrices => "MAT4 of FLOAT",
        }
    }
}

/// The accessor that a reference names, if its type suits its use.
pub(super) fn resolve<'a>(json: &Json<'_>, accessors: &'a [Option<Accessor<'a>>], semantic: Semantic) -> Option<&'a Accessor<'a>> {
    let accessor = accessors.get(json.as_index("accessors", accessors.len())?)?.as_ref()?;
    if semantic.allows(accessor) {
        return Some(accessor);
    }
    let problem = format!("expected {}, found {} ({})", semantic.expected(), accessor.shown(), accessor.place);
    json.error("gltf::attribute-type", problem);
    None
}

/// Checks every mesh.
pub(super) fn read_meshes<'a>(root: &Json<'_>, accessors: &'a [Option<Accessor<'a>>], materials: usize) -> Vec<MeshSource<'a>> {
    root.objects("meshes").iter().enumerate().map(|(index, mesh)| read_mesh(mesh, index, accessors, materials)).collect()
}

fn read_mesh<'a>(json: &Json<'_>, index: usize, accessors: &'a [Option<Accessor<'a>>], materials: usize) -> MeshSource<'a> {
    json.required("primitives");
    let list = json.objects("primitives");
    if list.is_empty() && json.has("primitives") {
        json.warning_at("primitives", "gltf::empty-mesh", "is empty");
    }
    let primitives: Vec<Primitive<'a>> = list.iter().filter_map(|primitive| read_primitive(primitive, accessors, materials)).collect();
    let weights: Vec<f32> = json.list("weights").iter().filter_map(Json::as_number).collect();
    let targets = primitives.iter().map(|primitive| primitive.targets.len()).max().unwrap_or(0);
    if json.has("weights") && weights.len() != targets && !primitives.is_empty() {
        json.warning_at("weights", "gltf::morph-weights", format_args!("has {} weights for {targets} morph targets", weights.len()));
    }
    MeshSource { name: json.name_or("mesh", index), weights, primitives }
}

fn read_primitive<'a>(json: &Json<'_>, accessors: &'a [Option<Accessor<'a>>], materials: usize) -> Option<Primitive<'a>> {
    let mode = read_mode(json);
    let material = json.index("material", "materials", materials);
    let indices = json.get("indices").and_then(|indices| resolve(&indices, accessors, Semantic::Indices));
    json.required("attributes");
    let mut found = BTreeMap::new();
    for (name, attribute) in json.members("attributes") {
        if let Some(semantic) = semantic_of(name) {
            found.insert(name, resolve(&attribute, accessors, semantic).map(|accessor| (attribute, accessor)));
        }
    }
    let targets: Vec<Target<'a>> = json.objects("targets").iter().map(|target| read_target(target, &found, accessors)).collect();
    let Some(position) = found.get("POSITION") else {
        if json.has("attributes") {
            json.report().warning("gltf::no-position", json.place(), "has no POSITION, and is left out", "");
        }
        return None;
    };
    let position = position.as_ref()?.1;
    for (attribute, accessor) in found.values().flatten() {
        same_count(attribute, accessor, position);
    }
    // An optional compression has a fallback in the plain accessors; without one they have no data.
    if let Some((name, _)) = json.members("extensions").iter().find(|(name, _)| name.ends_with("_mesh_compression"))
        && position.is_implied()
    {
        let problem = format!("its vertices are only in the extension {name}, which is not supported");
        json.report().error(
            "gltf::unsupported-extension",
            json.place(),
            problem,
            "export the file without mesh compression, or decompress it",
        );
        return None;
    }
    let get = |name: &str| found.get(name).and_then(|entry| entry.as_ref()).map(|(_, accessor)| *accessor);
    let numbered = |prefix: &str| {
        let number = |name: &str| name.strip_prefix(prefix)?.parse().ok();
        found.iter().filter_map(|(name, entry)| Some((number(name)?, entry.as_ref()?.1))).collect::<BTreeMap<u32, _>>()
    };
    let weights = numbered("WEIGHTS_");
    let influences = numbered("JOINTS_").into_iter().filter_map(|(set, joints)| Some((joints, *weights.get(&set)?))).collect();
    Some(Primitive {
        place: json.place().to_owned(),
        mode: mode?,
        material,
        indices,
        position,
        normal: get("NORMAL"),
        tangent: get("TANGENT"),
        color: get("COLOR_0"),
        uvs: numbered("TEXCOORD_"),
        influences,
        targets,
    })
}

fn read_mode(json: &Json<'_>) -> Option<Mode> {
    let code = if json.has("mode") { json.count("mode")? } else { 4 };
    match code {
        0..=3 => {
            let what = if code == 0 { "points" } else { "lines" };
            json.warning_at("mode", "gltf::not-triangles", format_args!("{what} are not drawn; the primitive is left out"));
            None
        }
        4 => Some(Mode::List),
        5 => Some(Mode::Strip),
        6 => Some(Mode::Fan),
        _ => {
            json.error_at("mode", "gltf::mode", format_args!("expected 0 to 6, found {code}"));
            None
        }
    }
}

type Found<'j, 'a> = BTreeMap<&'j str, Option<(Json<'j>, &'a Accessor<'a>)>>;

fn read_target<'a>(json: &Json<'_>, attributes: &Found<'_, 'a>, accessors: &'a [Option<Accessor<'a>>]) -> Target<'a> {
    let position = attributes.get("POSITION").and_then(|entry| entry.as_ref()).map(|(_, accessor)| *accessor);
    let read = |key: &str, semantic: Semantic| {
        let member = json.get(key)?;
        let accessor = resolve(&member, accessors, semantic)?;
        position.is_none_or(|position| same_count(&member, accessor, position)).then_some(accessor)
    };
    // Checked and not kept: morphed tangents are derived again.
    read("TANGENT", Semantic::TangentDelta);
    Target { position: read("POSITION", Semantic::Position), normal: read("NORMAL", Semantic::Normal) }
}

fn semantic_of(name: &str) -> Option<Semantic> {
    let numbered = |prefix: &str| name.strip_prefix(prefix).is_some_and(|rest| rest.parse::<u32>().is_ok());
    Some(match name {
        "POSITION" => Semantic::Position,
        "NORMAL" => Semantic::Normal,
        "TANGENT" => Semantic::Tangent,
        _ if numbered("TEXCOORD_") => Semantic::TexCoord,
        _ if numbered("COLOR_") => Semantic::Color,
        _ if numbered("JOINTS_") => Semantic::Joints,
        _ if numbered("WEIGHTS_") => Semantic::Weights,
        // An attribute of the application.
        _ => return None,
    })
}

fn same_count(json: &Json<'_>, accessor: &Accessor<'_>, position: &Accessor<'_>) -> bool {
    if accessor.count != position.count {
        json.error("gltf::attribute-count", format_args!("has {} elements, but POSITION has {}", accessor.count, position.count));
    }
    accessor.count == position.count
}
