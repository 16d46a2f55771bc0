// Writes the camera down, for the frame after this one.

#import "shared/camera.wgsl"

var<storage, read_write> seen: array<vec4<f32>>;

@compute @workgroup_size(1)
fn remember() {
    for (var column = 0u; column < 4u; column++) {
        seen[column] = camera.projection_from_world[column];
    }
}
