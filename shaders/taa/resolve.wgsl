// Blends what a pixel shows now with what it showed before, where that can still be true.
//
// Where the pixel's surface was on the screen of the frame before comes from its depth and the camera of that frame. The history found
// there is moved into the range of colours around the pixel, which removes most of what is no longer to be seen.

#import "shared/camera.wgsl"
#import "shared/color.wgsl"
#import "shared/jitter.wgsl"
#import "shared/math.wgsl"

// Radiance / light_unit of this frame.
var light: texture_2d<f32>;
var surface_depth: texture_depth_2d;
// What this pass left in the frame before; alpha is 0 where it left nothing.
var history: texture_2d<f32>;
// projection_from_world of the frame before, column by column.
var<storage, read> seen: array<vec4<f32>>;
var linear_clamp: sampler;

// How much of the current frame enters. Ten frames weigh two thirds.
const CURRENT: f32 = 0.1;
// Width of the colour box in standard deviations (Salvi 2016).
const BOX: f32 = 1.25;

struct Targets {
    resolved: vec4<f32>,
}

// Luma and two differences of colour: boxes along these axes hold less than along red, green and blue.
fn to_ycocg(color: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        dot(color, vec3<f32>(0.25, 0.5, 0.25)),
        dot(color, vec3<f32>(0.5, 0.0, -0.5)),
        dot(color, vec3<f32>(-0.25, 0.5, -0.25)),
    );
}

fn from_ycocg(color: vec3<f32>) -> vec3<f32> {
    let base = color.x - color.z;
    return vec3<f32>(base + color.y, color.x + color.z, base - color.y);
}

fn current_at(texel: vec2<i32>) -> vec3<f32> {
    let inside = clamp(texel, vec2<i32>(0), vec2<i32>(textureDimensions(light)) - 1);
    return to_ycocg(textureLoad(light, inside, 0).rgb);
}

// The nearest surface of nine pixels and where it is: an edge moves as what stands in front does.
fn nearest_texel(texel: vec2<i32>) -> vec3<f32> {
    var nearest = vec3<f32>(vec2<f32>(texel), -1.0);
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let at = clamp(texel + vec2<i32>(x, y), vec2<i32>(0), vec2<i32>(textureDimensions(light)) - 1);
            let depth = textureLoad(surface_depth, at, 0);
            if depth > nearest.z {
                nearest = vec3<f32>(vec2<f32>(at), depth);
            }
        }
    }
    return nearest;
}

// Where on the screen of the frame before something was, for a place and a depth of this one. Nothing there is infinitely far away.
fn place_before(uv: vec2<f32>, depth: f32) -> vec2<f32> {
    let world = camera.world_from_projection * vec4<f32>(uv.x * 2.0 - 1.0, 1.0 - uv.y * 2.0, depth, 1.0);
    let clip = mat4x4<f32>(seen[0], seen[1], seen[2], seen[3]) * world;
    return vec2<f32>(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w);
}

// Catmull-Rom interpolation in five bilinear fetches (Jimenez 2016, "Filmic SMAA"); the four corners weigh least and are left out.
fn history_at(uv: vec2<f32>) -> vec4<f32> {
    let size = vec2<f32>(textureDimensions(history));
    let place = uv * size;
    let middle = floor(place - 0.5) + 0.5;
    let f = place - middle;
    let w0 = f * (-0.5 + f * (1.0 - 0.5 * f));
    let w1 = 1.0 + f * f * (-2.5 + 1.5 * f);
    let w2 = f * (0.5 + f * (2.0 - 1.5 * f));
    let w3 = f * f * (-0.5 + 0.5 * f);
    let w12 = w1 + w2;
    let at0 = (middle - 1.0) / size;
    let at12 = (middle + w2 / w12) / size;
    let at3 = (middle + 2.0) / size;
    let sum = textureSampleLevel(history, linear_clamp, vec2<f32>(at12.x, at0.y), 0.0) * (w12.x * w0.y)
        + textureSampleLevel(history, linear_clamp, vec2<f32>(at0.x, at12.y), 0.0) * (w0.x * w12.y)
        + textureSampleLevel(history, linear_clamp, at12, 0.0) * (w12.x * w12.y)
        + textureSampleLevel(history, linear_clamp, vec2<f32>(at3.x, at12.y), 0.0) * (w3.x * w12.y)
        + textureSampleLevel(history, linear_clamp, vec2<f32>(at12.x, at3.y), 0.0) * (w12.x * w3.y);
    let weight = w12.x * w0.y + w0.x * w12.y + w12.x * w12.y + w3.x * w12.y + w12.x * w3.y;
    return sum / weight;
}

// Moves a colour straight towards the middle of a box until it is in it.
fn clip_to_box(color: vec3<f32>, middle: vec3<f32>, half_size: vec3<f32>) -> vec3<f32> {
    let offset = color - middle;
    let beyond = largest(abs(offset) / max(half_size, vec3<f32>(1.0e-5)));
    return select(color, middle + offset / beyond, beyond > 1.0);
}

@fragment
fn resolve(@builtin(position) place: vec4<f32>, @location(0) uv: vec2<f32>) -> Targets {
    let texel = vec2<i32>(place.xy);
    let size = vec2<f32>(textureDimensions(light));
    let current = current_at(texel);
    var mean = vec3<f32>(0.0);
    var mean_square = vec3<f32>(0.0);
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let near = current_at(texel + vec2<i32>(x, y));
            mean += near / 9.0;
            mean_square += near * near / 9.0;
        }
    }
    let half_size = BOX * sqrt(max(mean_square - mean * mean, vec3<f32>(0.0)));

    let nearest = nearest_texel(texel);
    let nearest_uv = (nearest.xy + 0.5) / size;
    let before = uv + place_before(unjittered_uv(nearest_uv), nearest.z) - unjittered_uv(nearest_uv);
    let known = history_at(before);
    let seen_before = all(before >= vec2<f32>(0.0)) && all(before <= vec2<f32>(1.0)) && known.a > 0.5;
    var result = current;
    if seen_before {
        let old = clip_to_box(to_ycocg(known.rgb), mean, half_size);
        result = mix(old, current, CURRENT);
    }
    return Targets(vec4<f32>(fit_half(from_ycocg(result)), 1.0));
}
