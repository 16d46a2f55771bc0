// The scene's lights: the published tables `directional_lights` and `local_lights`, and what each sends to a point.
//
// Units and falloff as in glTF's KHR_lights_punctual: lux for directional lights, candela for points and spots.

#import "shared/environment.wgsl"
#import "shared/math.wgsl"

struct DirectionalLight {
    direction_to_light: vec3<f32>,
    // Of the map that is fitted to all that the camera sees, where a pipeline has one: metres along the edge of a texel.
    shadow_texel_size: f32,
    // Lux on a surface that faces the light.
    illuminance: vec3<f32>,
    // Metres between depth 0 and depth 1 of that map.
    shadow_depth_range: f32,
    // Clip space of that map's view: orthographic.
    shadow_from_world: mat4x4<f32>,
    // How many cascades it has; cascade c of light l is row `l * cascades + c` of `cascades`.
    cascades: u32,
}

struct LocalLight {
    position: vec3<f32>,
    // Metres to where the light ends; 0 is no end.
    range: f32,
    // Candela, on the axis of a spot.
    intensity: vec3<f32>,
    // Metres beyond which a light without a range gives nothing; 0 is no end.
    reach: f32,
    // Axis of a spot, away from the light.
    direction: vec3<f32>,
    // Which shadow map is its own: row k of `point_lights` as k, row k of `spot_lights` as -1 - k.
    shadow: i32,
    // Strength of a spot is saturate(cosine * spot_scale + spot_offset)^2; points have 0 and 1.
    spot_scale: f32,
    spot_offset: f32,
}

var<storage, read> directional_lights: array<DirectionalLight>;
var<storage, read> local_lights: array<LocalLight>;

// What one light sends to a point, shadows aside.
struct Illumination {
    // Unit vector from the point to the light.
    to_light: vec3<f32>,
    // Lux on a surface that faces the light.
    illuminance: vec3<f32>,
}

fn directional_illumination(index: u32) -> Illumination {
    return Illumination(directional_lights[index].direction_to_light, directional_lights[index].illuminance);
}

// Inverse square, brought to 0 at the light's range by glTF's recommended window max(min(1 - (d / range)^4, 1), 0).
fn local_illumination(index: u32, position: vec3<f32>) -> Illumination {
    let to_light = local_lights[index].position - position;
    // A point at the light itself would divide by zero: nothing is nearer than a tenth of a millimetre.
    let distance_squared = max(dot(to_light, to_light), 1.0e-8);
    let direction = to_light * inverseSqrt(distance_squared);

    var window = 1.0;
    let range = local_lights[index].range;
    if range > 0.0 {
        window = saturate(1.0 - square(distance_squared / square(range)));
    }
    let reach = local_lights[index].reach;
    if reach > 0.0 && distance_squared > square(reach) {
        window = 0.0;
    }
    let cosine = dot(local_lights[index].direction, -direction);
    let cone = square(saturate(cosine * local_lights[index].spot_scale + local_lights[index].spot_offset));
    return Illumination(direction, local_lights[index].intensity * (window * cone / distance_squared));
}
