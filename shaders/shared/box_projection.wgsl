// Looking up what a cube captured elsewhere: the parallax of a box (Bjorke 2004, "Image-Based Lighting", GPU Gems, chapter 19; Lagarde and
// Zanuttini 2012, "Local Image-based Lighting With Parallax-corrected Cubemaps", SIGGRAPH).
//
// A box is given by its matrix `box_from_world`, in whose space its corners are at -1 and 1: turned, stretched and sheared boxes are all
// the same to it, and none needs an axis of its own.

#import "shared/math.wgsl"

// Where a ray moves by less than this part of a box for each of its lengths, it runs along its faces.
const LEAST_STEP: f32 = 1.0e-30;

// The direction in which a cube that was captured at `captured_at` shows what a ray meets that leaves `point` along `direction` (of any
// length). Not of unit length. Exact where all that is seen stands on the faces of the box, for rays that start inside or on it. A ray
// that leaves a box outside of which it starts is looked up where it starts.
fn box_projected(box_from_world: mat4x4<f32>, captured_at: vec3<f32>, point: vec3<f32>, direction: vec3<f32>) -> vec3<f32> {
    let place = (box_from_world * vec4<f32>(point, 1.0)).xyz;
    let step = (box_from_world * vec4<f32>(direction, 0.0)).xyz;
    let runs_along = abs(step) < vec3<f32>(LEAST_STEP);
    // Lengths of the ray to the planes of the three faces towards which it runs: a matrix keeps what part of a ray lies where.
    let to_planes = (sign(step) - place) / select(step, vec3<f32>(1.0), runs_along);
    let to_box = smallest(select(to_planes, vec3<f32>(VERY_FAR), runs_along));
    return point + direction * max(to_box, 0.0) - captured_at;
}

// How much a box holds a point: 1 inside and on its faces, where walls stand, and from there down to 0 at `margin` metres outside.
fn box_weight(box_from_world: mat4x4<f32>, point: vec3<f32>, margin: f32) -> f32 {
    let place = (box_from_world * vec4<f32>(point, 1.0)).xyz;
    // What a coordinate grows by for each metre away from its two faces.
    let rows = transpose(box_from_world);
    let growth = vec3<f32>(length(rows[0].xyz), length(rows[1].xyz), length(rows[2].xyz));
    let outside = largest((abs(place) - 1.0) / growth);
    return saturate(1.0 - outside / max(margin, 1.0e-6));
}
