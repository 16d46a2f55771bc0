// The physical sky, for passes that read what blocks/sky.ron makes: slots `sky_view`, `sky_light` and `transmittance`, of which
// a shader needs those alone whose functions it calls.
//
// The convention: `lux` of the scene's first directional light is what arrives outside of the air. The air takes its part away.
// All radiance is in nits, in linear Rec.709; +Y is up. The eye is at the altitude that the block was given, wherever the camera is.

#import "shared/lights.wgsl"
#import "sky/light_table.wgsl"
#import "sky/transmittance_table.wgsl"
#import "sky/view_table.wgsl"

// Lux outside of the air.
fn sun_outside() -> vec3<f32> {
    return directional_lights[0].illuminance;
}

// Lux on a surface that faces the sun, near the ground: 0 by night, reddish by a low sun.
fn sun_illuminance() -> vec3<f32> {
    return sun_outside() * sky_light_texel(SUN_HERE).rgb;
}

// Lux from the sky, without the sun, on a level plane.
fn sky_illuminance() -> vec3<f32> {
    return sun_outside() * sky_light_texel(SKY_HERE).rgb;
}

// Nits of the sky, and of the hazy ground below the horizon. Without the sun's disc.
fn sky_radiance(direction: vec3<f32>) -> vec3<f32> {
    let to_sun = directional_lights[0].direction_to_light;
    let altitude = sky_light_texel(SUN_HERE).a;
    let place = sky_direction(direction, to_sun, altitude);
    let seen = look_up_view(place, altitude);
    var radiance = seen.even.rgb + seen.mie.rgb * mie_phase(dot(direction, to_sun));
    if place.down {
        // Below the ozone, as all places near the ground are.
        let amounts = vec3<f32>(seen.even.a, seen.mie.a, 0.0);
        radiance += sky_light_texel(GROUND_HERE).rgb * exp(-extinction(amounts, sky_light_texel(SKY_HERE).a));
    }
    return sun_outside() * radiance;
}

// How the sun's brightness falls off towards its limb: the cosine to its surface to these powers (Hillaire 2016, "Physically Based Sky,
// Atmosphere and Cloud Rendering in Frostbite", after Neckel). Over the disc its mean is 2 / (2 + power).
const LIMB_POWERS: vec3<f32> = vec3<f32>(0.397, 0.503, 0.652);

// Nits of the sun's disc in a direction; 0 beside it, and where the ground hides it.
fn sun_disc_radiance(direction: vec3<f32>) -> vec3<f32> {
    let chord = distance(direction, directional_lights[0].direction_to_light);
    let place = chord / SUN_SINE;
    let altitude = sky_light_texel(SUN_HERE).a;
    if place >= 1.0 || direction.y < horizon_sine(altitude) {
        return vec3<f32>(0.0);
    }
    let mean = sun_outside() / (PI * square(SUN_SINE));
    let limb = pow(vec3<f32>(sqrt(1.0 - square(place))), LIMB_POWERS) * (1.0 + 0.5 * LIMB_POWERS);
    return mean * limb * transmittance_to_top(altitude, direction.y, sky_light_texel(SKY_HERE).a);
}
