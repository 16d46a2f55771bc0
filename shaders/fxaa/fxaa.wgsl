// Finds edges in a finished picture and shifts what is read across them, so that their steps become slopes.
//
// Lottes 2009, "FXAA" (NVIDIA), in its quality form: the edge's direction from second differences, its ends by a walk along it, and the
// shift from the nearer end; fine detail is blended by how much a pixel differs from its surroundings.

#import "shared/color.wgsl"

// The picture; sampled values are linear.
var picture: texture_2d<f32>;
var linear_clamp: sampler;

struct Params {
    // Least contrast of an edge, as a part of the brightest neighbour.
    threshold: f32,
    // How much single pixels are blended, 0 to 1.
    subpixel: f32,
}

var<uniform> params: Params;

// Contrast below this is not seen in dark places.
const LEAST_CONTRAST: f32 = 0.03;
// Pixels from step to step of the walk, and how many steps: 23 pixels each way.
const STEPS: u32 = 10u;
const STRIDES: array<f32, 10> = array<f32, 10>(1.0, 1.0, 1.0, 1.0, 1.5, 2.0, 2.0, 2.5, 4.0, 7.0);

struct Targets {
    color: vec4<f32>,
}

// Brightness as it is seen: near enough to the display's curve.
fn luma_of(color: vec3<f32>) -> f32 {
    return sqrt(luminance(color));
}

fn luma_at(uv: vec2<f32>) -> f32 {
    return luma_of(textureSampleLevel(picture, linear_clamp, uv, 0.0).rgb);
}

// Pixels from `start` along `step` to where the luma leaves that of the edge by `limit`, or as far as the walk goes; and the difference
// there.
fn walk(start: vec2<f32>, step: vec2<f32>, edge_luma: f32, limit: f32) -> vec2<f32> {
    var distance = 0.0;
    var difference = 0.0;
    for (var i = 0u; i < STEPS; i++) {
        distance += STRIDES[i];
        difference = luma_at(start + step * distance) - edge_luma;
        if abs(difference) >= limit {
            break;
        }
    }
    return vec2<f32>(distance, difference);
}

@fragment
fn smooth_edges(@builtin(position) place: vec4<f32>, @location(0) uv: vec2<f32>) -> Targets {
    let pixel = 1.0 / vec2<f32>(textureDimensions(picture));
    let color = textureLoad(picture, vec2<i32>(place.xy), 0);
    let m = luma_of(color.rgb);
    let n = luma_at(uv + pixel * vec2<f32>(0.0, -1.0));
    let s = luma_at(uv + pixel * vec2<f32>(0.0, 1.0));
    let w = luma_at(uv + pixel * vec2<f32>(-1.0, 0.0));
    let e = luma_at(uv + pixel * vec2<f32>(1.0, 0.0));
    let brightest = max(m, max(max(n, s), max(w, e)));
    let contrast = brightest - min(m, min(min(n, s), min(w, e)));
    if contrast < max(LEAST_CONTRAST, brightest * params.threshold) {
        return Targets(color);
    }
    let nw = luma_at(uv - pixel);
    let se = luma_at(uv + pixel);
    let ne = luma_at(uv + pixel * vec2<f32>(1.0, -1.0));
    let sw = luma_at(uv + pixel * vec2<f32>(-1.0, 1.0));

    // A pixel that stands out from the mean around it is blended into it.
    let around = (2.0 * (n + s + w + e) + nw + ne + sw + se) / 12.0;
    let detail = smoothstep(0.0, 1.0, saturate(abs(around - m) / contrast));
    let blend = detail * detail * params.subpixel;

    let across_rows = abs(nw - 2.0 * w + sw) + 2.0 * abs(n - 2.0 * m + s) + abs(ne - 2.0 * e + se);
    let across_columns = abs(nw - 2.0 * n + ne) + 2.0 * abs(w - 2.0 * m + e) + abs(sw - 2.0 * s + se);
    let level = across_rows >= across_columns;
    let before = select(w, n, level);
    let after = select(e, s, level);
    let normal = select(vec2<f32>(pixel.x, 0.0), vec2<f32>(0.0, pixel.y), level);
    let along = select(vec2<f32>(0.0, pixel.y), vec2<f32>(pixel.x, 0.0), level);
    // The edge lies between this pixel and the neighbour that differs most.
    let to_before = abs(before - m) >= abs(after - m);
    let neighbour = select(after, before, to_before);
    let outwards = select(normal, -normal, to_before);
    let edge_luma = 0.5 * (m + neighbour);
    let limit = 0.25 * abs(neighbour - m);

    let start = uv + outwards * 0.5;
    let forwards = walk(start, along, edge_luma, limit);
    let backwards = walk(start, -along, edge_luma, limit);
    let nearer = select(backwards, forwards, forwards.x < backwards.x);
    // Only the side on which the edge bends towards this pixel is shifted.
    let bends_here = (nearer.y < 0.0) != (m < edge_luma);
    let shift = select(0.0, 0.5 - nearer.x / (forwards.x + backwards.x), bends_here);
    let sampled = textureSampleLevel(picture, linear_clamp, uv + outwards * max(shift, blend), 0.0);
    return Targets(vec4<f32>(sampled.rgb, color.a));
}
