// What ambient occlusion (blocks/ambient_occlusion.ron) means for reflections, and for light that bounces between what hides each other.
//
// All of them are 1 where the visibility is 1, 0 where it is 0, and grow with it.

#import "shared/math.wgsl"

// The narrowest cone of reflection, radians: a sharper one would be hidden or seen as a whole, with an edge that visibility is too coarse for.
const LEAST_CONE: f32 = 0.1;

// Solid angle that two cones with one apex have in common, over 2 pi, from their half angles and the angle between their axes: Oat and Sander
// 2007, "Ambient Aperture Lighting", with their smooth curve where neither holds the other.
fn cones_in_common(first: f32, second: f32, between: f32) -> f32 {
    let narrow = min(first, second);
    let overlap = (first + second - between) / max(2.0 * narrow, 1.0e-6);
    return (1.0 - cos(narrow)) * smoothstep(0.0, 1.0, overlap);
}

// The part of a reflection's lobe that is seen, 0 to 1.
//
// `visibility` and `bent_normal` are what the block has found; `reflection` is the mirrored direction of the eye, a unit vector, `roughness`
// perceptual, `n_dot_v` the cosine between the surface's normal and the eye. With a bent normal this is what the cone of the lobe has in
// common with the cone that is seen, over what it has in common with the hemisphere (Jimenez et al. 2016, "Practical Realtime Strategies for
// Accurate Indirect Occlusion", section 7). Both cones hold what is hidden or seen as a whole: the first where half of GGX's energy goes,
// cos = 10^(-alpha^2), the second with the same visibility, sin^2 = visibility. Without a bent normal (zero) it is the fit of
// Lagarde and de Rousiers 2014, "Moving Frostbite to PBR", listing 26.
fn specular_occlusion(visibility: f32, bent_normal: vec3<f32>, reflection: vec3<f32>, roughness: f32, n_dot_v: f32) -> f32 {
    if visibility >= 1.0 {
        return 1.0;
    }
    let alpha = square(roughness);
    let seen = saturate(visibility);
    if all(bent_normal == vec3<f32>(0.0)) {
        let raised = pow(max(saturate(n_dot_v) + seen, 1.0e-6), exp2(-16.0 * alpha - 1.0));
        return saturate(raised - 1.0 + seen);
    }
    let lobe = max(acos(pow(10.0, -square(alpha))), LEAST_CONE);
    let aperture = asin(sqrt(seen));
    let between = acos(clamp(dot(bent_normal, reflection), -1.0, 1.0));
    let before_hemisphere = cones_in_common(0.5 * PI, lobe, between);
    return saturate(cones_in_common(aperture, lobe, between) / max(before_hemisphere, 1.0e-6));
}

// Visibility for each channel when light bounces between surfaces that hide each other, all of this albedo: bright ones are darkened less.
// Jimenez et al. 2016, equation 10, a fit to path traced scenes.
fn multi_bounce(visibility: f32, albedo: vec3<f32>) -> vec3<f32> {
    let a = 2.0404 * albedo - 0.3324;
    let b = -4.7951 * albedo + 0.6417;
    let c = 2.7552 * albedo + 0.6903;
    let bounced = ((visibility * a + b) * visibility + c) * visibility;
    // The fit is off by 0.0004 at 1.
    return min(max(vec3<f32>(visibility), bounced), vec3<f32>(1.0));
}
