// The share of each piece of a face in the nine coefficients of radiance, in 32-bit floats.
//
// A workgroup takes TEXELS_PER_GROUP texels of a face (y of the workgroup) of a cube (z), in the order of rows. Each invocation adds up its
// own, then halves of the workgroup are added, so that no sum is long.

#import "environment/cube_texel.wgsl"
#import "shared/spherical_harmonics.wgsl"

// Six faces for each cube.
var cube: texture_2d_array<f32>;
// Nine for each workgroup, cube after cube, face after face.
var<storage, read_write> shares: array<vec4<f32>>;

const INVOCATIONS: u32 = 64u;
const TEXELS_PER_GROUP: u32 = 4096u;

var<workgroup> sums: array<array<vec3<f32>, 9>, 64>;

@compute @workgroup_size(64)
fn project(
    @builtin(local_invocation_index) invocation: u32,
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let edge = textureDimensions(cube).x;
    var own: array<vec3<f32>, 9>;
    for (var k = 0u; k < TEXELS_PER_GROUP / INVOCATIONS; k++) {
        let index = group.x * TEXELS_PER_GROUP + k * INVOCATIONS + invocation;
        if index < edge * edge {
            let texel = vec2<u32>(index % edge, index / edge);
            let direction = normalize(cube_direction(group.y, place_on_face(vec2<f32>(texel) + 0.5, f32(edge))));
            let light = textureLoad(cube, texel, 6u * group.z + group.y, 0).rgb * texel_solid_angle(texel, edge);
            let basis = sh_basis(direction);
            for (var i = 0u; i < SH_COUNT; i++) {
                own[i] += light * basis[i];
            }
        }
    }
    sums[invocation] = own;
    for (var half = INVOCATIONS / 2u; half > 0u; half /= 2u) {
        workgroupBarrier();
        if invocation < half {
            for (var i = 0u; i < SH_COUNT; i++) {
                sums[invocation][i] += sums[invocation + half][i];
            }
        }
    }
    workgroupBarrier();
    if invocation < SH_COUNT {
        let place = ((group.z * 6u + group.y) * groups.x + group.x) * SH_COUNT + invocation;
        shares[place] = vec4<f32>(sums[0][invocation], 0.0);
    }
}
