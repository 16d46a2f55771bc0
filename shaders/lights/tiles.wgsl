// Marks the lights that may reach anything before the camera in a tile, at whatever distance: for surfaces that no depth buffer knows.
//
// One invocation fills one word, 32 lights of one tile. A light counts where the sphere around what it lights meets the four planes
// through the tile's edges and lies before the camera. Near a tile's corners that is a little generous.

#import "lights/extent.wgsl"
#import "shared/camera.wgsl"
#import "shared/light_lists.wgsl"

struct Params {
    // Extent of the image in pixels.
    width: u32,
    height: u32,
}

var<uniform> params: Params;
var<storage, read_write> lists: array<u32>;

// Samples may be shifted by half a pixel.
const SHIFT: f32 = 1.0;

// Half-space in the world: what it holds has dot(xyz, position) + w >= 0. Unit normal.
fn plane(coefficients: vec4<f32>) -> vec4<f32> {
    return coefficients / max(length(coefficients.xyz), 1.0e-30);
}

// Centre and radius of a sphere around all that a light with an end reaches.
fn enclosing_sphere(light: u32) -> vec4<f32> {
    let end = light_end(light);
    let cosine = outer_cosine(light);
    let position = local_lights[light].position;
    let axis = local_lights[light].direction;
    if cosine <= 0.0 {
        return vec4<f32>(position, end);
    }
    // The smallest sphere around a sector: through tip and rim, or about the rim where the half angle is more than 45 degrees.
    if cosine > sqrt(0.5) {
        let radius = 0.5 * end / cosine;
        return vec4<f32>(position + axis * radius, radius);
    }
    return vec4<f32>(position + axis * (end * cosine), end * sqrt(1.0 - cosine * cosine));
}

@compute @workgroup_size(64)
fn mark(@builtin(global_invocation_id) id: vec3<u32>) {
    let words = light_words();
    let tiles = vec2<u32>(params.width + light_tile - 1u, params.height + light_tile - 1u) / light_tile;
    if id.x >= words * tiles.x * tiles.y {
        return;
    }
    let tile = vec2<u32>((id.x / words) % tiles.x, id.x / words / tiles.x);
    let size = vec2<f32>(f32(params.width), f32(params.height));
    let first = (vec2<f32>(tile * light_tile) - SHIFT) / size;
    let last = (vec2<f32>((tile + 1u) * light_tile) + SHIFT) / size;
    // Rows of the matrix: clip space is x from -w to w, to the right, and y from -w to w, upwards.
    let rows = transpose(camera.projection_from_world);
    let left = plane(rows[0] - rows[3] * (first.x * 2.0 - 1.0));
    let right = plane(rows[3] * (last.x * 2.0 - 1.0) - rows[0]);
    let top = plane(rows[3] * (1.0 - first.y * 2.0) - rows[1]);
    let bottom = plane(rows[1] - rows[3] * (1.0 - last.y * 2.0));

    let begin = (id.x % words) * 32u;
    var bits = 0u;
    for (var light = begin; light < min(begin + 32u, environment.local_count); light++) {
        var meets = !is_dark(light);
        if meets && light_end(light) > 0.0 {
            let sphere = enclosing_sphere(light);
            let centre = vec4<f32>(sphere.xyz, 1.0);
            let inside = vec4<f32>(dot(left, centre), dot(right, centre), dot(top, centre), dot(bottom, centre));
            meets = all(inside >= vec4<f32>(-sphere.w)) && distance_along_axis(sphere.xyz) >= -sphere.w;
        }
        bits |= select(0u, 1u << (light - begin), meets);
    }
    lists[id.x] = bits;
}
