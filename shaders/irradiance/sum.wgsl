// The nine coefficients of a cube (z of the workgroup), from the shares of its pieces.

#import "shared/spherical_harmonics.wgsl"

var<storage, read> shares: array<vec4<f32>>;
var<storage, read_write> coefficients: array<vec4<f32>>;

// Pieces of a cube.
override pieces: u32 = 1;

@compute @workgroup_size(16)
fn add_up(@builtin(local_invocation_index) index: u32, @builtin(workgroup_id) group: vec3<u32>) {
    if index >= SH_COUNT {
        return;
    }
    var sum = vec4<f32>(0.0);
    for (var piece = 0u; piece < pieces; piece++) {
        sum += shares[(group.z * pieces + piece) * SH_COUNT + index];
    }
    coefficients[group.z * SH_COUNT + index] = sum;
}
