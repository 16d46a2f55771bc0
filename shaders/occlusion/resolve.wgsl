// From sums over slices to visibility and bent normal, together with the pixels around that show the same surface.
//
// The pattern of slices repeats every 4 pixels (occlusion/pattern.wgsl). Five by five pixels with half weights at the border hold each part
// of it equally often and keep the middle, which 4 by 4 would not.

#import "occlusion/surface.wgsl"

// What occlusion/horizons.wgsl leaves.
var hidden: texture_2d<f32>;
var open: texture_2d<f32>;

struct Params {
    bent_normals: u32,
    blur: u32,
}

var<uniform> params: Params;

// A pixel takes part no more where it lies so far off the plane of the middle, as the sine of the angle...
const MOST_SLOPE: f32 = 0.2;
// ...or where the cosine between shading normals is less than 1 by this: 26 degrees.
const MOST_TURN: f32 = 0.1;

struct Targets {
    // Bent normal in the world, or zero; visibility.
    occlusion: vec4<f32>,
}

// How much of the surface in the middle another pixel shows, 0 to 1.
fn likeness(middle: Surface, other: Surface) -> f32 {
    let between = other.position - middle.position;
    let slope = abs(dot(between, middle.geometric_normal)) / max(length(between), 1.0e-20);
    let turn = 1.0 - dot(middle.normal, other.normal);
    return saturate(1.0 - slope / MOST_SLOPE) * saturate(1.0 - turn / MOST_TURN);
}

@fragment
fn resolve(@builtin(position) place: vec4<f32>) -> Targets {
    let texel = vec2<i32>(place.xy);
    let stored_depth = textureLoad(depth, texel, 0);
    if stored_depth == NOTHING_THERE {
        return Targets(vec4<f32>(0.0, 0.0, 0.0, 1.0));
    }
    let middle = surface_at(texel, stored_depth);
    var all_hidden = textureLoad(hidden, texel, 0);
    var all_open = textureLoad(open, texel, 0).x;
    let reach = select(0, 2, params.blur != 0u);
    for (var y = -reach; y <= reach; y++) {
        for (var x = -reach; x <= reach; x++) {
            let other = texel + vec2<i32>(x, y);
            let is_middle = x == 0 && y == 0;
            if is_middle || any(other < vec2<i32>(0)) || any(other >= vec2<i32>(textureDimensions(depth))) {
                continue;
            }
            let other_depth = textureLoad(depth, other, 0);
            if other_depth == NOTHING_THERE {
                continue;
            }
            let inner = select(0.5, 1.0, abs(x) < 2) * select(0.5, 1.0, abs(y) < 2);
            let weight = inner * likeness(middle, surface_at(other, other_depth));
            all_hidden += weight * textureLoad(hidden, other, 0);
            all_open += weight * textureLoad(open, other, 0).x;
        }
    }
    let part = all_hidden / max(all_open, 1.0e-6);
    let visibility = saturate(1.0 - part.w);
    if params.bent_normals == 0u {
        return Targets(vec4<f32>(0.0, 0.0, 0.0, visibility));
    }
    // The mean of a whole hemisphere weighted by the cosine is two thirds of its normal.
    let bent = middle.normal * (2.0 / 3.0) - part.xyz;
    let bent_length = length(bent);
    // Where next to nothing is left there is no direction either.
    let direction = select(middle.normal, bent / max(bent_length, 1.0e-6), bent_length > 1.0e-3);
    return Targets(vec4<f32>(direction, visibility));
}
