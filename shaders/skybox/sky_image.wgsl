// The sky of the scene in a direction: the same everywhere, and what its image adds.
//
// The image is equirectangular (u = atan2(z, x) / 2 pi + 1/2, v = acos(y) / pi, the top row is up) or has the six faces of a cube, two to a
// row. Texels are mixed here and not by a sampler, since they are 32-bit floats: half floats end at 65,504, and some skies do not.

#import "shared/cube.wgsl"
#import "shared/environment.wgsl"
#import "shared/math.wgsl"

// Nits, before `sky_strength`. One black texel where there is no image.
var sky_image: texture_2d<f32>;

// A direction of the world in the frame of the image.
fn in_sky_image(direction: vec3<f32>) -> vec3<f32> {
    let c = cos(environment.sky_rotation);
    let s = sin(environment.sky_rotation);
    return vec3<f32>(c * direction.x - s * direction.z, direction.y, s * direction.x + c * direction.z);
}

// Where a direction falls among the texels of an equirectangular image: texels from its left upper corner.
fn equirectangular_place(direction: vec3<f32>, size: vec2<f32>) -> vec2<f32> {
    // At a pole every u shows the same; atan2 of two zeros shows anything.
    let level = max(abs(direction.x), abs(direction.z)) > 1.0e-12;
    let around = select(0.0, atan2(direction.z, direction.x), level) / (2.0 * PI) + 0.5;
    // Near the poles acos loses digits, atan2 does not.
    let down = atan2(length(direction.xz), direction.y) / PI;
    return vec2<f32>(around, down) * size;
}

// The texel of an equirectangular image: columns go round, rows end at the poles.
fn equirectangular_texel(at: vec2<i32>) -> vec2<i32> {
    let size = vec2<i32>(textureDimensions(sky_image));
    return vec2<i32>(((at.x % size.x) + size.x) % size.x, clamp(at.y, 0, size.y - 1));
}

// The texel of a face, or of its neighbour where the place lies beside the face. Without a branch: with one, Mesa 22.3's software driver
// loses memory with each draw.
fn sky_face_texel(face: u32, at: vec2<i32>) -> vec2<i32> {
    let edge = max(i32(textureDimensions(sky_image).x) / 2, 1);
    let direction = cube_direction(face, (vec2<f32>(at) + 0.5) * (2.0 / f32(edge)) - 1.0);
    let there = cube_face(direction);
    let on_face = into_cube_face(there, direction);
    let place = vec2<i32>(floor((on_face.xy / on_face.z * 0.5 + 0.5) * f32(edge)));
    return clamp(place, vec2<i32>(0), vec2<i32>(edge - 1)) + edge * vec2<i32>(i32(there % 2u), i32(there / 2u));
}

// The image in a direction of its own frame, nits before `sky_strength`: bilinear.
fn sky_image_radiance(direction: vec3<f32>) -> vec3<f32> {
    let has_faces = environment.sky_has_faces == 1u;
    let face = cube_face(direction);
    let on_face = into_cube_face(face, direction);
    let size = vec2<f32>(textureDimensions(sky_image));
    let place = select(equirectangular_place(direction, size), (on_face.xy / on_face.z * 0.5 + 0.5) * (0.5 * size.x), has_faces) - 0.5;
    let corner = vec2<i32>(floor(place));
    let part = place - floor(place);
    var sum = vec3<f32>(0.0);
    for (var i = 0; i < 4; i++) {
        let offset = vec2<i32>(i & 1, i >> 1u);
        let at = corner + offset;
        let weights = select(1.0 - part, part, offset == vec2<i32>(1));
        let texel = select(equirectangular_texel(at), sky_face_texel(face, at), has_faces);
        let found = textureLoad(sky_image, texel, 0).rgb;
        sum += weights.x * weights.y * found;
    }
    return sum;
}

// Nits, in a direction of the world.
fn scene_sky_radiance(direction: vec3<f32>) -> vec3<f32> {
    return environment.sky_radiance + environment.sky_strength * sky_image_radiance(in_sky_image(direction));
}
