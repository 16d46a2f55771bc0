// Makes the table `sky_light`: what the sun sends to the eye's altitude, what the sky sends to a level plane there, and how bright the
// ground is in the light of both. The ground far away is taken to be as bright as that below the eye.

#import "shared/lights.wgsl"
#import "sky/light_table.wgsl"
#import "sky/transmittance_table.wgsl"
#import "sky/view_table.wgsl"

var light: texture_storage_2d<rgba32float, write>;

struct Params {
    mie_scale: f32,
    // Metres.
    altitude: f32,
    ground_albedo: vec3<f32>,
}

var<uniform> params: Params;

// Rings of elevation, and columns of azimuth on one side of the sun.
const THREADS: u32 = 64u;
const RINGS: u32 = 64u;

var<workgroup> sums: array<vec3<f32>, THREADS>;

@compute @workgroup_size(THREADS)
fn collect(@builtin(local_invocation_index) thread: u32) {
    let altitude = 0.001 * params.altitude;
    let sun_sine = directional_lights[0].direction_to_light.y;
    let azimuth = (f32(thread) + 0.5) * PI / f32(THREADS);
    var sum = vec3<f32>(0.0);
    for (var ring = 0u; ring < RINGS; ring++) {
        let elevation = (f32(ring) + 0.5) * 0.5 * PI / f32(RINGS);
        let sine = sin(elevation);
        let seen = look_up_view(SkyDirection(elevation, false, sin(0.5 * azimuth)), altitude);
        let radiance = seen.even.rgb + seen.mie.rgb * mie_phase(cosine_between(sine, sun_sine, cos(azimuth)));
        // On a level plane; both sides of the sun.
        sum += radiance * (sine * cos(elevation) * 2.0);
    }
    sums[thread] = sum;
    workgroupBarrier();
    if thread > 0u {
        return;
    }
    var sky = vec3<f32>(0.0);
    for (var other = 0u; other < THREADS; other++) {
        sky += sums[other];
    }
    sky *= (PI / f32(THREADS)) * (0.5 * PI / f32(RINGS));
    let sun = sun_transmittance(altitude, sun_sine, params.mie_scale);
    let ground = saturate(params.ground_albedo) / PI * (sky + sun * max(sun_sine, 0.0));
    textureStore(light, vec2<i32>(SUN_HERE, 0), vec4<f32>(sun, altitude));
    textureStore(light, vec2<i32>(SKY_HERE, 0), vec4<f32>(sky, params.mie_scale));
    textureStore(light, vec2<i32>(GROUND_HERE, 0), vec4<f32>(ground, 1.0));
}
