//! Textures, samplers, and how a material refers to them (with KHR_texture_transform).
//!
//! Guarantees: every reference is in range. A texture without a PNG or JPEG source (its image is in an optional extension that
//! is not supported) is left out with a warning.

use super::json::Json;
use crate::asset::{MipFilter, Sampler, TextureUse, Wrap};

/// A checked texture.
#[derive(Clone, Copy)]
pub(super) struct Texture {
    /// Index into the file's images; `None` where only an extension knows.
    image: Option<usize>,
    sampler: Sampler,
}

/// Checks samplers and textures. A broken one is reported, and `None`.
pub(super) fn read_textures(root: &Json<'_>, images: usize) -> Vec<Option<Texture>> {
    let samplers: Vec<Option<Sampler>> = root.objects("samplers").iter().map(read_sampler).collect();
    root.objects("textures").iter().map(|texture| read_texture(texture, images, &samplers)).collect()
}

fn read_texture(json: &Json<'_>, images: usize, samplers: &[Option<Sampler>]) -> Option<Texture> {
    let image = if json.has("source") { Some(json.index("source", "images", images)?) } else { None };
    let sampler = match json.has("sampler") {
        true => (*samplers.get(json.index("sampler", "samplers", samplers.len())?)?)?,
        false => Sampler::default(),
    };
    Some(Texture { image, sampler })
}

fn read_sampler(json: &Json<'_>) -> Option<Sampler> {
    let mag_linear = code(json, "magFilter", 9729, &[(9728, false), (9729, true)]);
    let minification = [
        (9728, (false, MipFilter::None)),
        (9729, (true, MipFilter::None)),
        (9984, (false, MipFilter::Nearest)),
        (9985, (true, MipFilter::Nearest)),
        (9986, (false, MipFilter::Linear)),
        (9987, (true, MipFilter::Linear)),
    ];
    let min = code(json, "minFilter", 9987, &minification);
    let wraps = [(33071, Wrap::ClampToEdge), (33648, Wrap::MirroredRepeat), (10497, Wrap::Repeat)];
    let (wrap_u, wrap_v) = (code(json, "wrapS", 10497, &wraps), code(json, "wrapT", 10497, &wraps));
    let (min_linear, mip) = min?;
    Some(Sampler { mag_linear: mag_linear?, min_linear, mip, wrap_u: wrap_u?, wrap_v: wrap_v? })
}

/// One of OpenGL's codes.
fn code<T: Copy>(json: &Json<'_>, key: &str, default: u64, known: &[(u64, T)]) -> Option<T> {
    let found = if json.has(key) { json.count(key)? } else { default };
    let value = known.iter().find(|(code, _)| *code == found).map(|(_, value)| *value);
    if value.is_none() {
        let codes: Vec<String> = known.iter().map(|(code, _)| code.to_string()).collect();
        json.error_at(key, "gltf::sampler", format_args!("expected one of {}, found {found}", codes.join(", ")));
    }
    value
}

/// A material's use of a texture. The image index is the file's, and `uv_set` any number.
pub(super) fn read_use(json: &Json<'_>, key: &str, textures: &[Option<Texture>]) -> Option<TextureUse> {
    let info = json.object(key)?;
    let texture = (*textures.get(info.required_index("index", "textures", textures.len())?)?)?;
    let Some(image) = texture.image else {
        let problem = "the texture has no PNG or JPEG source, and is ignored";
        info.report().warning("gltf::texture-without-source", info.place(), problem, "export the file with PNG or JPEG textures");
        return None;
    };
    let mut uv_set = uv_set(&info).unwrap_or(0);
    let mut transform = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    if let Some(extension) = info.extension("KHR_texture_transform") {
        let [tx, ty] = extension.numbers("offset").unwrap_or([0.0; 2]);
        let [sx, sy] = extension.numbers("scale").unwrap_or([1.0; 2]);
        let (sin, cos) = extension.number("rotation").unwrap_or(0.0).sin_cos();
        // Scale, then rotation, then offset. The rotation is counter-clockwise as seen on the image, whose v points down.
        transform = [[cos * sx, sin * sy, tx], [-sin * sx, cos * sy, ty]];
        if let Some(over) = self::uv_set(&extension) {
            uv_set = over;
        }
    }
    Some(TextureUse { image, sampler: texture.sampler, uv_set, transform })
}

fn uv_set(json: &Json<'_>) -> Option<u32> {
    let set = json.count("texCoord")?;
    let small = u32::try_from(set).ok();
    if small.is_none() {
        json.error_at("texCoord", "gltf::texcoord", format_args!("{set} is not a set of texture coordinates"));
    }
    small
}
