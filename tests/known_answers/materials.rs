//! glTF materials: what faces away, what is mirrored, unlit, blended, tinted by vertices, glowing.

use std::f64::consts::PI;

use libtest_mimic::Failed;
use luminaire::image_file::LinearImage;
use serde_json::json;

use crate::Case;
use crate::support::gltf::Gltf;
use crate::support::picture::{Shot, near, places, texel};

pub const CASES: &[Case] = &[
    ("materials::a back face is lit from its own side", back_faces),
    ("materials::a mapped normal turns with its back face", mapped_back_face),
    ("materials::culling spares double-sided surfaces", culling),
    ("materials::a mirrored instance looks mirrored", mirrored_instance),
    ("materials::unlit takes no light", unlit),
    ("materials::blended surfaces cover what is behind", blended),
    ("materials::vertex colours multiply", vertex_colors),
    ("materials::emission adds", emission_adds),
];

/// Purely diffuse, with this base colour.
fn lambert(color: [f64; 4]) -> serde_json::Value {
    json!({
        "pbrMetallicRoughness": { "baseColorFactor": color, "metallicFactor": 0 },
        "extensions": { "KHR_materials_specular": { "specularFactor": 0 } }
    })
}

/// A camera at z = 3 that sees the quad of 2 m at the origin and something around it.
fn scene() -> Gltf {
    let mut scene = Gltf::default();
    scene.camera([0.0, 0.0, 3.0], 60.0);
    scene
}

fn shot(outputs: &[&str]) -> Shot {
    Shot::pbr(64, outputs)
}

/// The middle pixel's radiance. It looks at (0.027, -0.027, 0).
fn middle(image: &LinearImage) -> [f64; 4] {
    texel(image, 32, 32)
}

/// Radiance in the middle of a white surface from a lamp of 10 cd, straight in front and 2 m away.
fn straight(albedo: f64) -> f64 {
    let offset = 3.0 * 30f64.to_radians().tan() / 64.0;
    let squared = 4.0 + 2.0 * offset * offset;
    albedo / PI * 10.0 * 2.0 / squared.powf(1.5)
}

fn back_faces() -> Result<(), Failed> {
    for (lamp, expected) in [(2.0, straight(0.5)), (-2.0, 0.0)] {
        let mut scene = scene();
        let mut material = lambert([0.5, 0.5, 0.5, 1.0]);
        material["doubleSided"] = true.into();
        let material = scene.material(material);
        let quad = scene.quad(material, None);
        // Half a turn about +Y: its front looks away from the camera.
        scene.node(json!({ "mesh": quad, "rotation": [0, 1, 0, 0] }));
        scene.point_light(10.0, [0.0, 0.0, lamp]);
        let images = shot(&["radiance", "normal"]).take_world(&mut scene.world()?)?;
        // Measured: 0.052 %; half floats, see main.rs.
        near(&format!("lamp at {lamp}"), middle(&images["radiance"])[0], expected, 0.0012)?;
        let normal = middle(&images["normal"]);
        if (normal[2] - 1.0).abs() > 1e-3 {
            return Err(format!("the normal is {normal:?}, away from the camera").into());
        }
    }
    Ok(())
}

/// glTF 2.0, section 3.9.5: on a back face the whole mapped normal turns, not only its part along the surface's normal.
fn mapped_back_face() -> Result<(), Failed> {
    let mapped = glam::DVec3::new(166.0, 90.0, 230.0) / 255.0 * 2.0 - 1.0;
    let [x, y, z] = mapped.normalize().to_array();
    // Half a turn about +Y takes x and z to the other side; the back face then turns all three.
    for (rotation, expected) in [([0, 0, 0, 1], [x, y, z]), ([0, 1, 0, 0], [x, -y, z])] {
        let mut scene = scene();
        let map = scene.texture(2, true, |_, _| [166, 90, 230, 255]);
        let mut material = lambert([0.5, 0.5, 0.5, 1.0]);
        (material["normalTexture"], material["doubleSided"]) = (json!({ "index": map }), true.into());
        let material = scene.material(material);
        let quad = scene.quad(material, None);
        scene.node(json!({ "mesh": quad, "rotation": rotation }));
        let images = shot(&["normal"]).take_world(&mut scene.world()?)?;
        let found = middle(&images["normal"]);
        // Half floats towards zero.
        if (0..3).any(|axis| (found[axis] - expected[axis]).abs() > 0.001) {
            return Err(format!("the normal is {found:?}, not {expected:?}").into());
        }
    }
    Ok(())
}

/// A back face is drawn only where the material is double-sided; a mirrored instance's front stays its front.
fn culling() -> Result<(), Failed> {
    for (double_sided, turned, mirrored, drawn) in [
        (false, false, false, true),
        (false, true, false, false),
        (true, true, false, true),
        (false, false, true, true),
        (false, true, true, false),
    ] {
        let mut scene = scene();
        let mut material = lambert([0.5, 0.5, 0.5, 1.0]);
        material["doubleSided"] = double_sided.into();
        let material = scene.material(material);
        let quad = scene.quad(material, None);
        let rotation = if turned { [0, 1, 0, 0] } else { [0, 0, 0, 1] };
        scene.node(json!({ "mesh": quad, "rotation": rotation, "scale": [if mirrored { -1 } else { 1 }, 1, 1] }));
        let image = shot(&["albedo"]).take_world(&mut scene.world()?)?;
        let found = middle(&image["albedo"])[0] == 0.5;
        if found != drawn {
            return Err(format!("double-sided {double_sided}, turned {turned}, mirrored {mirrored}: drawn is {found}").into());
        }
    }
    Ok(())
}

/// A normal map without symmetry on a quad; the node's scale of -1 along x, with the lamp mirrored, mirrors the picture.
fn mirrored_instance() -> Result<(), Failed> {
    let picture = |sign: f64| -> Result<LinearImage, Failed> {
        let mut scene = scene();
        let map = scene.texture(16, true, |x, y| [128 + (x * 5) as u8, 100 + (y * 4) as u8, 220, 255]);
        let mut material = lambert([0.8, 0.8, 0.8, 1.0]);
        material["normalTexture"] = json!({ "index": map });
        let material = scene.material(material);
        let quad = scene.quad(material, None);
        scene.node(json!({ "mesh": quad, "rotation": [0, 0, 0.1 * sign, 0.99f64.sqrt()], "scale": [sign, 0.8, 1] }));
        scene.point_light(10.0, [1.2 * sign, 0.4, 1.0]);
        let mut images = shot(&["radiance"]).take_world(&mut scene.world()?)?;
        images.remove("radiance").ok_or_else(|| "no radiance".into())
    };
    let (image, mirrored) = (picture(1.0)?, picture(-1.0)?);
    let differences = places(&image).map(|(x, y)| {
        let (a, b) = (texel(&image, x, y)[0], texel(&mirrored, 63 - x, y)[0]);
        (a - b).abs() > 0.005 * a.max(b)
    });
    let wrong = differences.filter(|wrong| *wrong).count();
    let lit = image.texels.iter().filter(|texel| texel[0] > 0.0).count();
    println!("{wrong} of {lit} differ");
    // Edges of texels and of the quad may fall to the other side on other drivers; measured: none.
    if lit > 800 && wrong < 30 { Ok(()) } else { Err(format!("{wrong} pixels differ, {lit} are lit").into()) }
}

fn unlit() -> Result<(), Failed> {
    let mut scene = scene();
    let material = scene.material(json!({
        "pbrMetallicRoughness": { "baseColorFactor": [0.25, 0.5, 0.75, 1] },
        "extensions": { "KHR_materials_unlit": {} }
    }));
    let quad = scene.quad(material, None);
    scene.node(json!({ "mesh": quad }));
    scene.point_light(1000.0, [0.0, 0.0, 2.0]);
    let image = shot(&["radiance"]).take_world(&mut scene.world()?)?;
    let found = middle(&image["radiance"]);
    // Base colours have 16 bits with a shared exponent on their way; light is a half float.
    (0..3).try_for_each(|channel| near("unlit", found[channel], [0.25, 0.5, 0.75][channel], 0.0012))
}

/// Over a glowing wall: alpha of the front, the rest of the wall.
fn blended() -> Result<(), Failed> {
    let mut scene = scene();
    let wall = scene.material(json!({ "emissiveFactor": [1, 0.5, 0], "pbrMetallicRoughness": { "baseColorFactor": [0, 0, 0, 1] } }));
    let mut front = lambert([0.8, 0.8, 0.8, 0.25]);
    front["alphaMode"] = "BLEND".into();
    let front = scene.material(front);
    let (wall, front) = (scene.quad(wall, None), scene.quad(front, None));
    scene.node(json!({ "mesh": wall, "translation": [0, 0, -1], "scale": [5, 5, 1] }));
    scene.node(json!({ "mesh": front }));
    scene.point_light(10.0, [0.0, 0.0, 2.0]);
    let image = shot(&["radiance", "direct", "albedo"]).take_world(&mut scene.world()?)?;
    let found = middle(&image["radiance"]);
    for (channel, behind) in [1.0, 0.5, 0.0].into_iter().enumerate() {
        // The wall is black but for 4 % of gloss, which adds a little light: its radiance is what `direct` says, which knows no
        // blended surface.
        let wall = middle(&image["direct"])[channel];
        if (wall - behind).abs() > 0.05 {
            return Err(format!("the wall has {wall}, not about {behind}").into());
        }
        // Half floats twice; measured: 0.06 %.
        near("blended", found[channel], 0.25 * straight(0.8) + 0.75 * wall, 0.0015)?;
    }
    if middle(&image["albedo"])[0] == 0.0 { Ok(()) } else { Err("a blended surface stands in the G-buffer".into()) }
}

fn vertex_colors() -> Result<(), Failed> {
    let mut scene = scene();
    let material = scene.material(lambert([0.5, 0.5, 0.5, 1.0]));
    // Multiples of 1/255, as they are kept.
    let quad = scene.quad(material, Some([0.2, 0.4, 1.0, 1.0]));
    scene.node(json!({ "mesh": quad }));
    scene.point_light(10.0, [0.0, 0.0, 2.0]);
    let images = shot(&["albedo", "radiance"]).take_world(&mut scene.world()?)?;
    for (channel, color) in [0.2, 0.4, 1.0].into_iter().enumerate() {
        near("albedo", middle(&images["albedo"])[channel], 0.5 * color, 0.0005)?;
        near("radiance", middle(&images["radiance"])[channel], straight(0.5) * color, 0.0012)?;
    }
    Ok(())
}

fn emission_adds() -> Result<(), Failed> {
    let mut scene = scene();
    let mut material = lambert([0.5, 0.5, 0.5, 1.0]);
    material["emissiveFactor"] = json!([1, 0.25, 0]);
    let material = scene.material(material);
    let quad = scene.quad(material, None);
    scene.node(json!({ "mesh": quad }));
    scene.point_light(10.0, [0.0, 0.0, 2.0]);
    let images = shot(&["radiance"]).take_world(&mut scene.world()?)?;
    let found = middle(&images["radiance"]);
    [1.0, 0.25, 0.0].into_iter().enumerate().try_for_each(|(channel, own)| near("sum", found[channel], straight(0.5) + own, 0.0012))
}
