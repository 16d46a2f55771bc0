// What one point of a rectangle sends, as if it stood for all of it: the mean over many points is the truth.

#import "area/rectangles.wgsl"
#import "shared/brdf.wgsl"

// Nits towards the eye from the point of the rectangle at `place`, two numbers from 0 to 1 that are distributed evenly, if nothing
// stands between.
fn sampled_rectangle(point: SurfacePoint, light: RectangleLight, place: vec2<f32>) -> vec3<f32> {
    let side = lit_side(light, point.position);
    let at = 2.0 * place - 1.0;
    let away = light.position + at.x * light.half_width + at.y * light.half_height - point.position;
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
