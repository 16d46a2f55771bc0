// Cube maps by hand: which face a direction meets and where, and back. For what no sampler does: looking at single texels.
//
// Each function has one return: with more of them, Mesa 22.3's software driver loses memory with each draw.
//
// Faces and orientation as in WebGPU: +X -X +Y -Y +Z -Z; `place` runs from -1 to 1, x to the right and y down the rows.

// The face that a direction meets.
fn cube_face(direction: vec3<f32>) -> u32 {
    let size = abs(direction);
    let along_x = size.x >= size.y && size.x >= size.z;
    let axis = select(select(2u, 1u, size.y >= size.z), 0u, along_x);
    return 2u * axis + select(1u, 0u, direction[axis] >= 0.0);
}

// Coordinates of a vector in the frame of a face: right, down, and outwards.
fn into_cube_face(face: u32, v: vec3<f32>) -> vec3<f32> {
    var found: vec3<f32>;
    switch face {
        case 0u: { found = vec3<f32>(-v.z, -v.y, v.x); }
        case 1u: { found = vec3<f32>(v.z, -v.y, -v.x); }
        case 2u: { found = vec3<f32>(v.x, v.z, v.y); }
        case 3u: { found = vec3<f32>(v.x, -v.z, -v.y); }
        case 4u: { found = vec3<f32>(v.x, -v.y, v.z); }
        default: { found = vec3<f32>(-v.x, -v.y, -v.z); }
    }
    return found;
}

// The direction through a place on a face. Not of unit length: its part along the face's axis is 1.
fn cube_direction(face: u32, place: vec2<f32>) -> vec3<f32> {
    var found: vec3<f32>;
    switch face {
        case 0u: { found = vec3<f32>(1.0, -place.y, -place.x); }
        case 1u: { found = vec3<f32>(-1.0, -place.y, place.x); }
        case 2u: { found = vec3<f32>(place.x, 1.0, place.y); }
        case 3u: { found = vec3<f32>(place.x, -1.0, -place.y); }
        case 4u: { found = vec3<f32>(place.x, -place.y, 1.0); }
        default: { found = vec3<f32>(-place.x, -place.y, -1.0); }
    }
    return found;
}
