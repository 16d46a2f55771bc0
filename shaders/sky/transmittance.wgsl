// Makes the table `transmittance`: integrates densities from a place to where the air ends.

#import "sky/transmittance_table.wgsl"

var amounts: texture_storage_2d<rgba32float, write>;

struct Params {
    transmittance_steps: u32,
}

var<uniform> params: Params;

@compute @workgroup_size(8, 8)
fn integrate(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(amounts);
    if any(id.xy >= size) {
        return;
    }
    let ray = transmittance_ray(vec2<f32>(id.xy) / vec2<f32>(size - 1u));
    let distance = distance_to_top(ray.altitude, ray.sine);
    var sum = vec3<f32>(0.0);
    for (var k = 0u; k < params.transmittance_steps; k++) {
        let step = step_along(distance, k, params.transmittance_steps);
        sum += densities(altitude_along(ray.altitude, ray.sine, step.middle)) * step.length;
    }
    textureStore(amounts, id.xy, vec4<f32>(sum, 1.0));
}
