// What a rectangle sends to a surface and the surface to the eye, integrated over the rectangle: exact for the diffuse part but for
// Fresnel's factor, which is that of the mean direction of the light; the lobe by a transformed cosine.

#import "area/ltc.wgsl"
#import "area/polygon.wgsl"
#import "area/rectangles.wgsl"
#import "shared/brdf.wgsl"

// Nits towards the eye, if nothing stands between. 0 where the rectangle is behind the triangle or behind the shading normal; one that
// crosses their horizons is cut there.
fn integrated_rectangle(point: SurfacePoint, light: RectangleLight) -> vec3<f32> {
    let side = lit_side(light, point.position);
    let n_dot_v = dot(point.normal, point.to_eye);
    if side == 0.0 || n_dot_v <= 0.0 {
        return vec3<f32>(0.0);
    }
    let frame = lobe_from_world(point);
    let middle = frame * (light.position - point.position);
    let width = frame * light.half_width;
    let height = frame * light.half_height * side;
    var seen: Polygon;
    seen.count = 4u;
    seen.corners[0] = middle - width - height;
    seen.corners[1] = middle - width + height;
    seen.corners[2] = middle + width + height;
    seen.corners[3] = middle + width - height;
    let up = vec3<f32>(0.0, 0.0, 1.0);
    seen = clipped(clipped(seen, frame * point.geometric_normal), up);
    if seen.count == 0u {
        return vec3<f32>(0.0);
    }

    let flux = vector_form_factor(seen);
    let to_light = flux * inverseSqrt(max(dot(flux, flux), 1.0e-30));
    let halfway = normalize(to_light + frame * point.to_eye);
    let fresnel = point.specular_weight * schlick_fresnel(point.dielectric_f0, saturate(dot(to_light, halfway)));
    let diffuse = point.base_color * ((1.0 - point.metallic) * (1.0 - largest(fresnel)) * max(flux.z, 0.0));

    let lobe = lobe_of(point.roughness, n_dot_v);
    let cosine = max(vector_form_factor(clipped(transformed(seen, lobe.to_cosine), up)).z, 0.0);
    let reflected = point.specular_weight * (point.dielectric_f0 * (lobe.magnitude.x - lobe.magnitude.y) + lobe.magnitude.y);
    let metal = point.base_color * (lobe.magnitude.x - lobe.magnitude.y) + lobe.magnitude.y;
    return light.radiance * (diffuse + mix(reflected, metal, point.metallic) * cosine);
}
