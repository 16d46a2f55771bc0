// What filters ask of a map, whatever kind it is of.

#import "shared/shadow_cascades.wgsl"
#import "shared/shadow_point.wgsl"
#import "shared/shadow_spot.wgsl"

// Linear; what is not farther than the map's content is lit.
var compare_less: sampler_comparison;

// What a texel of the receiver's map holds. `texel` is whole.
fn shadow_texel(receiver: ShadowReceiver, texel: vec2<f32>) -> ShadowTexel {
    switch receiver.kind {
        case CASCADE_MAP: { return cascade_texel(receiver, texel); }
        case POINT_MAP: { return point_texel(receiver, texel); }
        default: { return spot_texel(receiver, texel); }
    }
}

// How much of the light a sampler lets through that compares the four nearest texels with one distance: 0 to 1.
fn compared_shadow(receiver: ShadowReceiver, distance: f32) -> f32 {
    let uv = receiver.place / receiver.size;
    switch receiver.kind {
        case CASCADE_MAP: {
            let depth = saturate(cascade_depth(receiver, distance));
            return textureSampleCompareLevel(cascade_maps, compare_less, uv, receiver.row, depth);
        }
        case POINT_MAP: {
            let depth = saturate(point_depth(receiver, distance));
            let direction = cube_direction(receiver.face, uv * 2.0 - 1.0);
            return textureSampleCompareLevel(point_cubes, compare_less, direction, receiver.row, depth);
        }
        default: {
            let depth = saturate(spot_depth(receiver, distance));
            return textureSampleCompareLevel(spot_maps, compare_less, uv, receiver.row, depth);
        }
    }
}
