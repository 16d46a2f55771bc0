// The sky of the scene in a direction: the same everywhere, and what its image adds.

#import "shared/environment.wgsl"
#import "shared/math.wgsl"

// Equirectangular: u = atan2(z, x) / 2 pi + 1/2, v = acos(y) / pi, the top row is up. One black texel where there is none.
var sky_image: texture_2d<f32>;
var linear_repeat: sampler;

// Where the image shows a direction.
fn sky_image_place(direction: vec3<f32>) -> vec2<f32> {
    // At a pole every u shows the same; atan2 of two zeros shows anything.
    let level = max(abs(direction.x), abs(direction.z)) > 1.0e-12;
    let angle = select(0.0, atan2(direction.z, direction.x), level) + environment.sky_rotation;
    // The sampler goes round: rows must not, and end at the middles of the outermost ones.
    let half_texel = 0.5 / f32(textureDimensions(sky_image).y);
    // Near the poles acos loses digits, atan2 does not.
    let below = atan2(length(direction.xz), direction.y) / PI;
    return vec2<f32>(fract(angle / (2.0 * PI) + 0.5), clamp(below, half_texel, 1.0 - half_texel));
}

// Nits.
fn scene_sky_radiance(direction: vec3<f32>) -> vec3<f32> {
    // The finest level, whatever the neighbours show: where u goes from 1 to 0 they differ most.
    let image = textureSampleLevel(sky_image, linear_repeat, sky_image_place(direction), 0.0).rgb;
    return environment.sky_radiance + environment.sky_strength * image;
}
