// Transformed cosines that stand for the lobe of shared/brdf.wgsl (Heitz, Dupuy, Hill and Neubelt 2016, "Real-Time Polygonal-Light Shading
// with Linearly Transformed Cosines"). examples/fit_ltc.rs made the tables and says what they hold.

#import "shared/linear_clamp.wgsl"
#import "shared/surface_point.wgsl"

var ltc_matrix: texture_2d<f32>;
var ltc_magnitude: texture_2d<f32>;
struct Lobe {
    // Takes directions, in a frame with the normal along z and the eye in the plane of x and z, to where the lobe is a cosine.
    to_cosine: mat3x3<f32>,
    // What is reflected where Fresnel's factor is 1, and with Schlick's weight in its place.
    magnitude: vec2<f32>,
}

fn lobe_of(roughness: f32, n_dot_v: f32) -> Lobe {
    // Texels stand for values at their middles, the first for 0 and the last for 1.
    let edge = f32(textureDimensions(ltc_matrix).x);
    let place = vec2<f32>(roughness, sqrt(max(1.0 - n_dot_v, 0.0)));
    let uv = (place * (edge - 1.0) + 0.5) / edge;
    let m = textureSampleLevel(ltc_matrix, linear_clamp, uv, 0.0);
    var lobe: Lobe;
    lobe.to_cosine = mat3x3<f32>(vec3<f32>(m.x, 0.0, m.z), vec3<f32>(0.0, 1.0, 0.0), vec3<f32>(m.y, 0.0, m.w));
    lobe.magnitude = textureSampleLevel(ltc_magnitude, linear_clamp, uv, 0.0).xy;
    return lobe;
}

// Takes world directions to the frame of a lobe.
fn lobe_from_world(point: SurfacePoint) -> mat3x3<f32> {
    let along = point.to_eye - point.normal * dot(point.normal, point.to_eye);
    var x = along;
    if dot(along, along) < 1.0e-12 {
        // Seen from above the lobe is round, and any direction will do.
        let other = select(vec3<f32>(1.0, 0.0, 0.0), vec3<f32>(0.0, 1.0, 0.0), abs(point.normal.x) > 0.5);
        x = other - point.normal * dot(point.normal, other);
    }
    x = normalize(x);
    return transpose(mat3x3<f32>(x, cross(point.normal, x), point.normal));
}
