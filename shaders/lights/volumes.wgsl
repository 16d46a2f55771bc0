// Marks the tiles in which a light reaches something: the light's volume is rasterised, and each pixel whose surface it lights sets the
// light's bit in the list of its tile.
//
// A volume is a polyhedron around the sphere, or the cone, in which the light gives anything. Its far sides are drawn where they lie
// behind the surface that the pixel shows, which is right for a camera inside of it, too; then the light itself is asked at the surface.

#import "lights/extent.wgsl"
#import "shared/camera.wgsl"
#import "shared/jitter.wgsl"
#import "shared/light_lists.wgsl"

var<storage, read_write> lists: array<atomic<u32>>;
var surface_depth: texture_depth_2d;

// The sphere: slices around, stacks from pole to pole. Two triangles for each; `vertices` of the pass is 6 times their product.
const SLICES: u32 = 8u;
const STACKS: u32 = 4u;
// A polyhedron with corners on a sphere holds one that is smaller by the cosines of half a slice and half a stack, both pi / 8.
const INSCRIBED: f32 = 0.853553;
// The cone: a pyramid with so many sides, whose base encloses a circle.
const SIDES: u32 = 8u;
const BASE_INSCRIBED: f32 = 0.92388;
// Rounding must not cut into the volume.
const MARGIN: f32 = 1.001;

struct Volume {
    @builtin(position) clip_position: vec4<f32>,
    @location(0) @interpolate(flat) light: u32,
}

// Corner of the sphere's polyhedron; `at` counts slices and stacks.
fn sphere_corner(at: vec2<u32>) -> vec3<f32> {
    let around = f32(at.x) * (2.0 * PI / f32(SLICES));
    let down = f32(at.y) * (PI / f32(STACKS));
    return vec3<f32>(sin(down) * cos(around), cos(down), sin(down) * sin(around));
}

// Vertex of the sphere's triangles, counter-clockwise from outside.
fn sphere_vertex(vertex: u32) -> vec3<f32> {
    let quad = vec2<u32>((vertex / 6u) % SLICES, vertex / (6u * SLICES));
    var corner = vec2<u32>(0u);
    switch vertex % 6u {
        case 1u: { corner = vec2<u32>(1u, 0u); }
        case 2u, 4u: { corner = vec2<u32>(1u, 1u); }
        case 5u: { corner = vec2<u32>(0u, 1u); }
        default: {}
    }
    return sphere_corner(quad + corner);
}

// Vertex of the pyramid with its tip in the origin, along `axis`, whose base is at distance 1 with a circle of `radius` in it. Those
// beyond its triangles fall on the tip.
fn cone_vertex(vertex: u32, axis: vec3<f32>, radius: f32) -> vec3<f32> {
    let side = vertex / 6u;
    let corner = vertex % 6u;
    if side >= SIDES || corner == 0u {
        return vec3<f32>(0.0);
    }
    if corner == 3u {
        return axis;
    }
    let across = normalize(select(vec3<f32>(0.0, -axis.z, axis.y), vec3<f32>(-axis.z, 0.0, axis.x), abs(axis.x) > 0.5));
    let up = cross(axis, across);
    // From the tip the sides run the other way around than the base does from outside.
    let next = corner == 1u || corner == 5u;
    let angle = f32(side + select(0u, 1u, next)) * (2.0 * PI / f32(SIDES));
    return axis + (across * cos(angle) + up * sin(angle)) * (radius / BASE_INSCRIBED);
}

@vertex
fn enclose(@builtin(vertex_index) vertex: u32, @builtin(instance_index) light: u32) -> Volume {
    let end = light_end(light) * MARGIN;
    if is_dark(light) {
        return Volume(vec4<f32>(0.0, 0.0, 0.0, 1.0), light);
    }
    if end <= 0.0 {
        // Without an end: a triangle over the whole image, infinitely far away. Clockwise, as far sides are.
        let corner = vec2<f32>(f32(vertex & 2u) * 2.0 - 1.0, f32((vertex & 1u) * 2u) * 2.0 - 1.0);
        return Volume(vec4<f32>(select(vec2<f32>(0.0), corner, vertex < 3u), 0.0, 1.0), light);
    }
    var offset = vec3<f32>(0.0);
    let cosine = outer_cosine(light);
    if cosine >= NARROW_CONE {
        let tangent = sqrt(max(1.0 - cosine * cosine, 0.0)) / cosine;
        offset = cone_vertex(vertex, local_lights[light].direction, tangent * MARGIN);
    } else {
        offset = sphere_vertex(vertex) / INSCRIBED;
    }
    var clip = jittered(camera.projection_from_world * vec4<f32>(local_lights[light].position + offset * end, 1.0));
    // What lies beyond the far plane is brought onto it: cut off, it would hide the volume's far sides.
    clip.z = max(clip.z, 0.0);
    return Volume(clip, light);
}

@fragment
fn mark(volume: Volume) {
    let texel = vec2<u32>(volume.clip_position.xy);
    let size = textureDimensions(surface_depth);
    let depth = textureLoad(surface_depth, texel, 0);
    if depth == NOTHING_THERE {
        return;
    }
    let uv = unjittered_uv(volume.clip_position.xy / vec2<f32>(size));
    let light = local_illumination(volume.light, position_from_depth(uv, depth));
    if all(light.illuminance <= vec3<f32>(0.0)) {
        return;
    }
    let word = light_list_start(texel, size.x) + volume.light / 32u;
    let bit = 1u << (volume.light % 32u);
    // Most pixels find the bit set; looking costs less than setting it again.
    if (atomicLoad(&lists[word]) & bit) == 0u {
        atomicOr(&lists[word], bit);
    }
}
