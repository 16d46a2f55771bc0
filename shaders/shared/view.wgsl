// The view that a Draw draws from: the published table `view`. It is the camera, a light's shadow view or a face of a probe's
// cube, as the pass says in its pipeline; a vertex shader that uses `view` serves them all.

#import "shared/eye.wgsl"

struct View {
    projection_from_world: mat4x4<f32>,
    position: vec3<f32>,
    near: f32,
    forward: vec3<f32>,
    far: f32,
}

var<uniform> view: View;

// Unit vector from `position` to the view's eye.
fn direction_to_view(position: vec3<f32>) -> vec3<f32> {
    return direction_to_eye(view.projection_from_world, view.position, view.forward, position);
}
