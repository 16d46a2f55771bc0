// What holds for the whole scene: the published table `environment`.

struct Environment {
    // Radiance of the sky in every direction, nits.
    sky_radiance: vec3<f32>,
    // Light is accumulated as radiance / light_unit, so that 100,000 lx and half floats go together. A power of two: dividing
    // and multiplying by it loses nothing.
    light_unit: f32,
    inverse_light_unit: f32,
    // Entries in use of `directional_lights`.
    directional_count: u32,
    // Entries in use of `local_lights`.
    local_count: u32,
    // Entries in use of `rectangle_lights`.
    rectangle_count: u32,
    // Factor on the image of the sky, and by how much that is turned about +Y, radians.
    sky_strength: f32,
    sky_rotation: f32,
    // A power of two: the image's brightest texel divided by it is at most 32,768.
    sky_unit: f32,
    // 1 where the image holds the six faces of a cube, 0 where it is equirectangular.
    sky_has_faces: u32,
}

var<uniform> environment: Environment;
