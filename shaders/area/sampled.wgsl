// What one point of a rectangle sends, as if it stood for all of it: the mean over many points is the truth.

#import "area/rectangles.wgsl"
#import "shared/brdf.wgsl"

// Nits towards the eye from the point of the rectangle that is `aside` from its middle, metres, if nothing stands between. These points
// must be distributed evenly.
fn sampled_rectangle(point: SurfacePoint, light: RectangleLight, aside: vec3<f32>) -> vec3<f32> {
    let side = lit_side(light, point.position);
    let away = light.position + aside - point.position;
    let distance_squared = dot(away, away);
    let to_light = away * inverseSqrt(max(distance_squared, 1.0e-12));
    if side == 0.0 || dot(point.geometric_normal, to_light) <= 0.0 {
        return vec3<f32>(0.0);
    }
    let front = normalize(cross(light.half_width, light.half_height));
    let solid_angle = light.area * abs(dot(front, to_light)) / max(distance_squared, 1.0e-12);
    let cosine = max(dot(point.normal, to_light), 0.0);
    return surface_brdf(point, to_light) * light.radiance * (solid_angle * cosine);
}
