// Makes the table `sky_view`: what comes into a ray from the eye, by the sun directly and by light that was scattered before
// (Hillaire 2020, equations 1 to 4 and 11).

#import "shared/lights.wgsl"
#import "sky/scattering_table.wgsl"
#import "sky/transmittance_table.wgsl"
#import "sky/view_table.wgsl"

var view_even: texture_storage_2d<rgba32float, write>;
var view_mie: texture_storage_2d<rgba32float, write>;

struct Params {
    mie_scale: f32,
    // Metres.
    altitude: f32,
    view_steps: u32,
}

var<uniform> params: Params;

@compute @workgroup_size(8, 8)
fn march(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(view_even);
    if any(id.xy >= size) {
        return;
    }
    let altitude = 0.001 * params.altitude;
    let direction = view_direction(id.xy, size, altitude);
    let sine = sin(direction.elevation);
    let sun_sine = directional_lights[0].direction_to_light.y;
    let sun_cosine = cosine_between(sine, sun_sine, azimuth_cosine(direction));
    var distance: f32;
    if direction.down {
        distance = distance_to_ground(altitude, sine);
    } else {
        distance = distance_to_top(altitude, max(sine, horizon_sine(altitude)));
    }

    let phase = rayleigh_phase(sun_cosine);
    var even = vec3<f32>(0.0);
    var mie = vec3<f32>(0.0);
    var depth = vec3<f32>(0.0);
    var passed = vec3<f32>(0.0);
    for (var k = 0u; k < params.view_steps; k++) {
        let step = step_along(distance, k, params.view_steps);
        let point = point_along(altitude, sine, sun_sine, sun_cosine, step.middle);
        let amounts = densities(point.altitude);
        let rayleigh = amounts.x * RAYLEIGH_SCATTERING;
        let aerosol = vec3<f32>(amounts.y * params.mie_scale * MIE_SCATTERING);
        let sun = sun_transmittance(point.altitude, point.sun_sine, params.mie_scale);
        let before = scattered_before(point.altitude, point.sun_sine);
        let step_depth = extinction(amounts, params.mie_scale) * step.length;
        let seen = step.length * exp(-depth) * mean_transmittance(step_depth);
        even += seen * (rayleigh * phase * sun + (rayleigh + aerosol) * before);
        mie += seen * aerosol * sun;
        depth += step_depth;
        passed += amounts * step.length;
    }
    textureStore(view_even, id.xy, vec4<f32>(even, passed.x));
    textureStore(view_mie, id.xy, vec4<f32>(mie, passed.y));
}
