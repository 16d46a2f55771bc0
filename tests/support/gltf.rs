//! Small glTF files for tests, written as text with everything inside: quads, procedural textures, lights, one camera.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use libtest_mimic::Failed;
use luminaire::scenes::World;
use serde_json::{Value, json};

use super::picture::shown;

/// A glTF file that grows.
#[derive(Debug, Default)]
pub struct Gltf {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    images: Vec<Value>,
    samplers: Vec<Value>,
    textures: Vec<Value>,
    materials: Vec<Value>,
    meshes: Vec<Value>,
    lights: Vec<Value>,
    cameras: Vec<Value>,
    nodes: Vec<Value>,
    animations: Vec<Value>,
}

fn push(list: &mut Vec<Value>, value: Value) -> usize {
    list.push(value);
    list.len() - 1
}

impl Gltf {
    fn accessor(&mut self, kind: &str, components: usize, values: &[f32]) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        let view = push(&mut self.views, json!({ "buffer": 0, "byteOffset": start, "byteLength": values.len() * 4 }));
        let bound = |pick: fn(f32, f32) -> f32, from: f32| -> Vec<f32> {
            (0..components).map(|c| values.iter().skip(c).step_by(components).copied().fold(from, pick)).collect()
        };
        let (least, most) = (bound(f32::min, f32::INFINITY), bound(f32::max, f32::NEG_INFINITY));
        let count = values.len() / components;
        let accessor = json!({ "bufferView": view, "componentType": 5126, "count": count, "type": kind, "min": least, "max": most });
        push(&mut self.accessors, accessor)
    }

    /// A texture from RGBA texels, as a PNG in a data URI. `nearest` keeps texels sharp when magnified.
    pub fn texture(&mut self, edge: u32, nearest: bool, texel: impl Fn(u32, u32) -> [u8; 4]) -> usize {
        let picture = image::RgbaImage::from_fn(edge, edge, |x, y| image::Rgba(texel(x, y)));
        let mut png = std::io::Cursor::new(Vec::new());
        picture.write_to(&mut png, image::ImageFormat::Png).expect("a small picture can be encoded");
        let uri = format!("data:image/png;base64,{}", STANDARD.encode(png.into_inner()));
        let image = push(&mut self.images, json!({ "uri": uri }));
        let sampler =
            if nearest { json!({ "magFilter": 9728, "minFilter": 9728 }) } else { json!({ "magFilter": 9729, "minFilter": 9987 }) };
        let sampler = push(&mut self.samplers, sampler);
        push(&mut self.textures, json!({ "source": image, "sampler": sampler }))
    }

    pub fn material(&mut self, material: Value) -> usize {
        push(&mut self.materials, material)
    }

    /// A square of 2 by 2 m in the plane z = 0 that faces +Z; texture coordinates run from its top left.
    pub fn quad(&mut self, material: usize, color: Option<[f32; 4]>) -> usize {
        let positions = self.accessor("VEC3", 3, &[-1.0, -1.0, 0.0, 1.0, -1.0, 0.0, 1.0, 1.0, 0.0, -1.0, 1.0, 0.0]);
        let normals = self.accessor("VEC3", 3, &[[0.0, 0.0, 1.0]; 4].concat());
        let uv = self.accessor("VEC2", 2, &[0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
        let mut attributes = json!({ "POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uv });
        if let Some(color) = color {
            attributes["COLOR_0"] = self.accessor("VEC4", 4, &[color; 4].concat()).into();
        }
        let start = self.bytes.len();
        self.bytes.extend([0u16, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes()));
        let view = push(&mut self.views, json!({ "buffer": 0, "byteOffset": start, "byteLength": 12 }));
        let indices = push(&mut self.accessors, json!({ "bufferView": view, "componentType": 5123, "count": 6, "type": "SCALAR" }));
        push(&mut self.meshes, json!({ "primitives": [{ "attributes": attributes, "indices": indices, "material": material }] }))
    }

    pub fn node(&mut self, node: Value) {
        self.nodes.push(node);
    }

    /// Moves the last node along straight lines from place to place, at these seconds.
    pub fn slide(&mut self, seconds: &[f32], places: &[[f32; 3]]) {
        let (input, output) = (self.accessor("SCALAR", 1, seconds), self.accessor("VEC3", 3, &places.concat()));
        let channel = json!({ "sampler": 0, "target": { "node": self.nodes.len() - 1, "path": "translation" } });
        push(&mut self.animations, json!({ "channels": [channel], "samplers": [{ "input": input, "output": output }] }));
    }

    /// A point light, candela.
    pub fn point_light(&mut self, candela: f64, position: [f64; 3]) {
        let light = push(&mut self.lights, json!({ "type": "point", "intensity": candela }));
        self.node(json!({ "translation": position, "extensions": { "KHR_lights_punctual": { "light": light } } }));
    }

    /// A directional light along -Z, lux.
    pub fn sun(&mut self, lux: f64) {
        let light = push(&mut self.lights, json!({ "type": "directional", "intensity": lux }));
        self.node(json!({ "extensions": { "KHR_lights_punctual": { "light": light } } }));
    }

    /// A camera that looks along -Z; `fov` in degrees.
    pub fn camera(&mut self, position: [f64; 3], fov: f64) {
        let camera = push(&mut self.cameras, json!({ "type": "perspective", "perspective": { "yfov": fov.to_radians(), "znear": 0.01 } }));
        self.node(json!({ "translation": position, "camera": camera }));
    }

    /// The file's text. Empty lists are left out, as the format asks.
    pub fn text(&self) -> String {
        let mut file = json!({ "asset": { "version": "2.0" }, "scene": 0 });
        file["extensionsUsed"] = json!(["KHR_lights_punctual", "KHR_materials_unlit", "KHR_materials_specular"]);
        file["scenes"] = json!([{ "nodes": (0..self.nodes.len()).collect::<Vec<_>>() }]);
        let data = format!("data:application/octet-stream;base64,{}", STANDARD.encode(&self.bytes));
        file["buffers"] = json!([{ "byteLength": self.bytes.len(), "uri": data }]);
        let lists = [
            ("bufferViews", &self.views),
            ("accessors", &self.accessors),
            ("images", &self.images),
            ("samplers", &self.samplers),
            ("textures", &self.textures),
            ("materials", &self.materials),
            ("meshes", &self.meshes),
            ("cameras", &self.cameras),
            ("nodes", &self.nodes),
            ("animations", &self.animations),
        ];
        for (name, list) in lists {
            if !list.is_empty() {
                file[name] = json!(list);
            }
        }
        if !self.lights.is_empty() {
            file["extensions"] = json!({ "KHR_lights_punctual": { "lights": self.lights } });
        }
        file.to_string()
    }

    /// The world that the loader makes of it, by way of a file. Where there is no light, a dark one keeps the default ones away.
    pub fn world(&mut self) -> Result<World, Failed> {
        if self.lights.is_empty() {
            self.sun(0.0);
        }
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("scene.gltf");
        std::fs::write(&path, self.text())?;
        let loaded = luminaire::session::load_scene(&path.display().to_string(), None).map_err(shown)?;
        if loaded.diagnostics.is_empty() { Ok(loaded.world) } else { Err(shown((loaded.diagnostics, loaded.sources))) }
    }
}
