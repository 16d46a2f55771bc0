// All shadow maps side by side, in rows from the upper left: cascades, spots, and the faces of cubes. Nearer to the light is darker.

#import "shared/shadow_cascades.wgsl"
#import "shared/shadow_point.wgsl"
#import "shared/shadow_spot.wgsl"

struct Targets {
    shown: vec4<f32>,
}

// Between maps, as a part of a map.
const GAP: f32 = 0.02;

@fragment
fn show(@builtin(position) pixel: vec4<f32>, @location(0) uv: vec2<f32>) -> Targets {
    let of_cascades = textureNumLayers(cascade_maps);
    let of_spots = textureNumLayers(spot_maps);
    let count = of_cascades + of_spots + textureNumLayers(point_maps);
    // As large as they fit.
    let extent = pixel.xy / uv;
    var columns = 1u;
    while f32(columns) * extent.y / extent.x * f32(columns) < f32(count) && columns < count {
        columns += 1u;
    }
    let rows = (count + columns - 1u) / columns;
    let edge = min(extent.x / f32(columns), extent.y / f32(rows));
    let place = pixel.xy / edge;
    let cell = vec2<u32>(place);
    let index = cell.y * columns + cell.x;
    let inside = (fract(place) - GAP) / (1.0 - 2.0 * GAP);
    if cell.x >= columns || index >= count || any(inside < vec2<f32>(0.0)) || any(inside >= vec2<f32>(1.0)) {
        return Targets(vec4<f32>(0.0, 0.02, 0.05, 1.0));
    }
    return Targets(vec4<f32>(vec3<f32>(nearness(index, of_cascades, of_spots, inside)), 1.0));
}

// Depth of a map: along the view's axis, over its far plane where there is perspective.
fn nearness(index: u32, of_cascades: u32, of_spots: u32, place: vec2<f32>) -> f32 {
    if index < of_cascades {
        return textureLoad(cascade_maps, texel_at(place, textureDimensions(cascade_maps)), index, 0);
    }
    let local = index - of_cascades;
    if local < of_spots {
        let depth = textureLoad(spot_maps, texel_at(place, textureDimensions(spot_maps)), local, 0);
        return spot_distance(local, depth) / spot_lights[local].far;
    }
    let layer = local - of_spots;
    let depth = textureLoad(point_maps, texel_at(place, textureDimensions(point_maps)), layer, 0);
    return point_distance(layer / 6u, depth) / point_lights[layer / 6u].far;
}

fn texel_at(place: vec2<f32>, size: vec2<u32>) -> vec2<i32> {
    return vec2<i32>(place * vec2<f32>(size));
}
