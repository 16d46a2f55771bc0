// The camera that renders: the published table `camera`, and the way from a texel and its depth back into the world.
//
// Right-handed, Y up, metres; the camera looks along -Z of its own space. Depth is reversed: 1 at the near plane, 0 at the far
// plane or at infinity.

#import "shared/eye.wgsl"

struct Camera {
    projection_from_world: mat4x4<f32>,
    world_from_projection: mat4x4<f32>,
    view_from_world: mat4x4<f32>,
    world_from_view: mat4x4<f32>,
    position: vec3<f32>,
    // Factor on radiance before tone mapping.
    exposure: f32,
    forward: vec3<f32>,
    near: f32,
}

var<uniform> camera: Camera;

// What the depth buffer holds where nothing was drawn.
const NOTHING_THERE: f32 = 0.0;

// World position of what stands in a texel. `uv` is (0, 0) at the top left of the image.
fn position_from_depth(uv: vec2<f32>, depth: f32) -> vec3<f32> {
    let projected = vec4<f32>(uv.x * 2.0 - 1.0, 1.0 - uv.y * 2.0, depth, 1.0);
    let homogeneous = camera.world_from_projection * projected;
    return homogeneous.xyz / homogeneous.w;
}

// Unit vector from `position` to the camera.
fn direction_to_camera(position: vec3<f32>) -> vec3<f32> {
    return direction_to_eye(camera.projection_from_world, camera.position, camera.forward, position);
}

// Unit vector from the camera through a place of the image. Taken from infinitely far away (or the far plane), so that it is as good
// anywhere in the world.
fn direction_through(uv: vec2<f32>) -> vec3<f32> {
    let far = camera.world_from_projection * vec4<f32>(uv.x * 2.0 - 1.0, 1.0 - uv.y * 2.0, 0.0, 1.0);
    // One return: with another one before it, Mesa 22.3's software driver loses 0.7 MB with each draw.
    return normalize(select(far.xyz - camera.position * far.w, camera.forward, is_orthographic(camera.projection_from_world)));
}

// Metres from the camera, along the axis on which it looks.
fn distance_along_axis(position: vec3<f32>) -> f32 {
    return dot(position - camera.position, camera.forward);
}
