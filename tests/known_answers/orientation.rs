//! Which way is up: rows, axes, the camera's direction, and the outputs that describe surfaces.

use glam::DVec3;
use libtest_mimic::Failed;

use crate::Case;
use crate::support::picture::{ALBEDO, Eye, Shot, near, places, texel};

pub const CASES: &[Case] = &[
    ("orientation::row 0 is the top and +X is right", row_zero_is_the_top),
    ("orientation::a turned camera", turned_camera),
    ("orientation::depth is metres along the axis", depth_is_metres),
    ("orientation::normals are the world's", normals_are_the_worlds),
    ("orientation::nothing is zero", nothing_is_zero),
];

/// Four quads in the corners of what the camera at z = 5 sees, red left above, green right above, blue left below, yellow right
/// below.
fn quads(eye: &Eye) -> String {
    let quad = |name: &str, x: f64, y: f64, color: &str| {
        format!(
            "\"{name}\": (shape: Plane(size: (1, 1)), translation: ({x}, {y}, 0), rotation: (90, 0, 0), surface: (base_color: ({color}))),"
        )
    };
    let quads = [
        quad("a", -1.0, 1.0, "1, 0, 0"),
        quad("b", 1.0, 1.0, "0, 1, 0"),
        quad("c", -1.0, -1.0, "0, 0, 1"),
        quad("d", 1.0, -1.0, "1, 1, 0"),
    ];
    format!("({} objects: {{ {} }})", eye.ron(), quads.concat())
}

fn row_zero_is_the_top() -> Result<(), Failed> {
    // The picture shows x and y from -2 to 2.
    let eye = Eye::new([0.0, 0.0, 5.0], [0.0, 0.0, 0.0], 2.0 * (2.0f64 / 5.0).atan().to_degrees());
    let scene = quads(&eye);
    for (pipeline, output) in [("pipelines/pbr.ron", "albedo"), (ALBEDO, "color")] {
        let image = Shot::of(pipeline, [64, 64], &[output]).one(&scene)?;
        for (x, y) in places(&image) {
            // Quads cover pixels 8 to 23 and 40 to 55 both ways.
            let side = |place: u32| if (8..24).contains(&place) { Some(0) } else { (40..56).contains(&place).then_some(1) };
            let expected = match (side(x), side(y)) {
                (Some(0), Some(0)) => [1.0, 0.0, 0.0],
                (Some(1), Some(0)) => [0.0, 1.0, 0.0],
                (Some(0), Some(1)) => [0.0, 0.0, 1.0],
                (Some(1), Some(1)) => [1.0, 1.0, 0.0],
                _ => [0.0; 3],
            };
            // On the edge itself rounding decides.
            let on_edge = |place: u32| [7, 8, 23, 24, 39, 40, 55, 56].contains(&place);
            let found = texel(&image, x, y);
            if !on_edge(x) && !on_edge(y) && found[..3] != expected {
                return Err(format!("{pipeline}: {found:?} at {x}, {y}, not {expected:?}").into());
            }
        }
    }
    Ok(())
}

/// Looking along +X, +Z is right.
fn turned_camera() -> Result<(), Failed> {
    let scene = "(cameras: { \"eye\": (position: (0, 0, 0), target: (4, 0, 0), fov: 60) }, objects: {
        \"right\": (shape: Box(size: (1, 1, 1)), translation: (5, 0, 1.5), surface: (base_color: (1, 0, 0))),
        \"up\": (shape: Box(size: (1, 1, 1)), translation: (5, 1.5, -1.5), surface: (base_color: (0, 1, 0))),
        \"behind\": (shape: Box(size: (1, 1, 1)), translation: (-5, 0, 0), surface: (base_color: (0, 0, 1))) })";
    let image = Shot::of(ALBEDO, [64, 64], &["color"]).one(scene)?;
    // 1.5 m to the right at 5 m, of 2.89 m to the edge: column 48.
    let expected = [((48, 32), [1.0, 0.0, 0.0]), ((15, 15), [0.0, 1.0, 0.0]), ((32, 32), [0.0; 3]), ((15, 48), [0.0; 3])];
    for ((x, y), color) in expected {
        let found = texel(&image, x, y);
        if found[..3] != color {
            return Err(format!("{found:?} at {x}, {y}, not {color:?}").into());
        }
    }
    Ok(())
}

fn depth_is_metres() -> Result<(), Failed> {
    // One plane faces the camera, the other is a floor.
    let facing = Eye::new([0.0, 0.0, 5.0], [0.0, 0.0, 0.0], 70.0);
    let above = Eye::new([0.5, 2.0, 3.0], [0.0, 0.0, -1.0], 50.0);
    let cases = [(facing, "rotation: (90, 0, 0), ", DVec3::Z), (above, "", DVec3::Y)];
    for (eye, rotation, normal) in cases {
        let scene = format!("({} objects: {{ \"plane\": (shape: Plane(size: (900, 900)), {rotation}surface: ()) }})", eye.ron());
        let image = Shot::pbr(64, &["depth"]).one(&scene)?;
        let forward = (eye.target - eye.position).normalize();
        for place in places(&image) {
            let point = eye.on_plane(&image, place, DVec3::ZERO, normal).ok_or("the plane fills the picture")?;
            // Measured: 7e-6 of the distance.
            near(&format!("{place:?}"), texel(&image, place.0, place.1)[0], (point - eye.position).dot(forward), 2e-5)?;
        }
    }
    Ok(())
}

/// A turned box shows faces with known normals; a ball shows all of them.
fn normals_are_the_worlds() -> Result<(), Failed> {
    let eye = Eye::new([0.0, 0.0, 6.0], [0.0, 0.0, 0.0], 40.0);
    let scene = format!(
        "({} objects: {{ \"ball\": (shape: Sphere(radius: 1.5, sectors: 256, stacks: 128), scale: (1, 1, 1), rotation: (20, 30, 40), surface: ()) }})",
        eye.ron()
    );
    let image = Shot::pbr(128, &["normal"]).one(&scene)?;
    let mut seen = 0;
    for (x, y) in places(&image) {
        let [nx, ny, nz, drawn] = texel(&image, x, y);
        let ray = eye.ray(&image, x, y).normalize();
        let (b, c) = (eye.position.dot(ray), eye.position.length_squared() - 1.5 * 1.5);
        let under_root = b * b - c;
        if drawn == 0.0 || under_root < 0.1 {
            continue;
        }
        let expected = (eye.position + ray * (-b - under_root.sqrt())).normalize();
        // Half floats and the tessellation; measured: 0.0008.
        let error = (DVec3::new(nx, ny, nz) - expected).length();
        if error > 0.0015 {
            return Err(format!("normal {nx}, {ny}, {nz} at {x}, {y}, not {expected}: {error}").into());
        }
        seen += 1;
    }
    if seen < 3000 {
        return Err(format!("only {seen} pixels of the ball are seen").into());
    }

    let scene = format!("({} objects: {{ \"box\": (shape: Box(size: (2, 2, 2)), rotation: (0, 30, 0), surface: ()) }})", eye.ron());
    let image = Shot::pbr(64, &["normal"]).one(&scene)?;
    // Turned by 30 degrees about +Y: what faced +Z now looks to the right of the camera, what faced -X to its left.
    let (sine, cosine) = 30f64.to_radians().sin_cos();
    for (x, expected) in [(40, [sine, 0.0, cosine]), (20, [-cosine, 0.0, sine])] {
        let found = texel(&image, x, 32);
        if (0..3).any(|axis| (found[axis] - expected[axis]).abs() > 0.001) {
            return Err(format!("{found:?} at column {x}, not {expected:?}").into());
        }
    }
    Ok(())
}

fn nothing_is_zero() -> Result<(), Failed> {
    let images = Shot::pbr(16, &["albedo", "normal", "depth", "radiance", "direct", "indirect"])
        .take("(cameras: { \"eye\": (position: (0, 0, 1), target: (0, 0, 0)) })")?;
    for (name, image) in &images {
        if image.texels.iter().any(|texel| texel[..3] != [0.0; 3]) {
            return Err(format!("`{name}` shows something where nothing is").into());
        }
    }
    Ok(())
}
