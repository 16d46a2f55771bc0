// The rows of maps that hold the whole scene, in a buffer that goes where shared/shadow_cascades.wgsl wants the table `cascades`: such a map is
// a light's only cascade.

#import "shared/shadow_cascades.wgsl"

var<storage, read> whole_scenes: array<Cascade>;
var<storage, read_write> rows: array<Cascade>;

@compute @workgroup_size(64)
fn pass_on(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < min(arrayLength(&rows), arrayLength(&whole_scenes)) {
        rows[id.x] = whole_scenes[id.x];
    }
}
