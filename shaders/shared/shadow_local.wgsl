// The shadows of point and spot lights, from the cube maps in slot `local_shadow`: depth, six layers per light in the order of
// `local_lights`, in WebGPU's order of faces. The map is seen as an array of images, since single texels must be looked at.
//
// Guarantees: see shared/shadow.wgsl; edges between faces make no seam. A light without a map shadows nothing.

#import "shared/cube.wgsl"
#import "shared/lights.wgsl"
#import "shared/shadow.wgsl"

var local_shadow: texture_depth_2d_array;

// Where a receiver stands, as one light sees it.
struct LocalReceiver {
    light: u32,
    // From the light to the receiver, metres.
    from_light: vec3<f32>,
    geometric_normal: vec3<f32>,
    // The face that it falls on.
    face: u32,
    // Texels along an edge of a face.
    size: f32,
    // Metres of a texel at the receiver's distance.
    texel_size: f32,
}

struct LocalTap {
    occluder: f32,
    plane: f32,
}

// Metres from the light along the face's axis, from what the map holds. The shadow view's depth is
// far (z - near) / (z (far - near)); in this form of the inverse nothing cancels.
fn local_distance(light: u32, depth: f32) -> f32 {
    return 1.0 / ((1.0 - depth) / local_lights[light].shadow_near + depth / local_lights[light].shadow_far);
}

// One texel. `texel` may lie one beyond the edge of the face: then its place is found on the face that continues there.
fn local_tap(receiver: LocalReceiver, texel: vec2<f32>) -> LocalTap {
    var face = receiver.face;
    var inside = texel;
    if any(texel < vec2<f32>(0.0)) || any(texel >= vec2<f32>(receiver.size)) {
        let beyond = cube_direction(face, (texel + 0.5) * (2.0 / receiver.size) - 1.0);
        face = cube_face(beyond);
        let there = into_cube_face(face, beyond);
        let place = (there.xy / there.z * 0.5 + 0.5) * receiver.size;
        inside = clamp(floor(place), vec2<f32>(0.0), vec2<f32>(receiver.size - 1.0));
    }
    let ray = cube_direction(face, (inside + 0.5) * (2.0 / receiver.size) - 1.0);
    let depth = textureLoad(local_shadow, vec2<i32>(inside), i32(receiver.light * 6u + face), 0);

    var tap = LocalTap(VERY_FAR, VERY_FAR);
    if depth < 1.0 {
        tap.occluder = local_distance(receiver.light, depth) / receiver.texel_size;
    }
    // The plane is where dot(normal, x - receiver) = 0. A ray that does not fall on its front never meets it.
    let falling = dot(receiver.geometric_normal, ray);
    if falling < 0.0 {
        tap.plane = dot(receiver.geometric_normal, receiver.from_light) / falling / receiver.texel_size;
    }
    return tap;
}

// How much of the light arrives at a point of a surface with this geometric normal: 0 to 1.
fn local_visibility(light: u32, position: vec3<f32>, geometric_normal: vec3<f32>) -> f32 {
    if light * 6u + 5u >= textureNumLayers(local_shadow) {
        return 1.0;
    }
    var receiver: LocalReceiver;
    receiver.light = light;
    receiver.from_light = position - local_lights[light].position;
    receiver.geometric_normal = geometric_normal;
    if dot(geometric_normal, receiver.from_light) >= 0.0 {
        return 0.0;
    }
    receiver.face = cube_face(receiver.from_light);
    receiver.size = f32(textureDimensions(local_shadow).x);
    let in_face = into_cube_face(receiver.face, receiver.from_light);
    receiver.texel_size = 2.0 * in_face.z / receiver.size;

    let place = (in_face.xy / in_face.z * 0.5 + 0.5) * receiver.size - 0.5;
    let corner = floor(place);
    let a = local_tap(receiver, corner);
    let b = local_tap(receiver, corner + vec2<f32>(1.0, 0.0));
    let c = local_tap(receiver, corner + vec2<f32>(0.0, 1.0));
    let d = local_tap(receiver, corner + vec2<f32>(1.0, 1.0));

    var taps: ShadowTaps;
    taps.occluder = vec4<f32>(a.occluder, b.occluder, c.occluder, d.occluder);
    taps.plane = vec4<f32>(a.plane, b.plane, c.plane, d.plane);
    taps.receiver = in_face.z / receiver.texel_size;
    // A step of 32-bit floats just below 1 is 2^-24, which at distance z is z^2 / near of it in metres; projecting costs a few.
    taps.uncertainty = square(in_face.z) / local_lights[light].shadow_near * exp2(-22.0) / receiver.texel_size;
    taps.place = place - corner;
    return shadow_visibility(taps);
}
