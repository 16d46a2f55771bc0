// White Lambert surfaces in the lights that the pipeline's parameter `light` chooses, shadows included.

#import "shared/color.wgsl"
#import "shared/environment.wgsl"
#import "shared/forward_surface.wgsl"
#import "shared/lights.wgsl"
#import "shared/shadow.wgsl"

struct Params {
    light: u32,
}

var<uniform> params: Params;

const ALL_LIGHTS: u32 = 0u;
const DIRECTIONAL_LIGHTS: u32 = 1u;
const POINT_LIGHTS: u32 = 2u;
const SPOT_LIGHTS: u32 = 3u;

struct Targets {
    // Radiance / light_unit.
    light: vec4<f32>,
    // How much of the light that would arrive does.
    visibility: f32,
    // Which cascade of the first directional light shadows the point, as a colour.
    cascade: vec4<f32>,
}

// What arrives with and without shadows, lux.
struct Arriving {
    shadowed: vec3<f32>,
    unshadowed: vec3<f32>,
}

@vertex
fn transform(vertex: MeshVertex, @builtin(instance_index) instance_index: u32) -> MeshFragment {
    return transform_mesh_vertex(vertex, instance_index);
}

@fragment
fn shade(fragment: MeshFragment, @builtin(front_facing) front_facing: bool) -> Targets {
    let drawn = drawn_surface(fragment, front_facing);
    if is_cut_out(fragment.material, drawn.alpha) {
        discard;
    }
    let point = drawn.point;
    var arriving: Arriving;
    if params.light == ALL_LIGHTS || params.light == DIRECTIONAL_LIGHTS {
        for (var i = 0u; i < environment.directional_count; i++) {
            let lux = falling(point, directional_illumination(i));
            if any(lux > vec3<f32>(0.0)) {
                arriving.unshadowed += lux;
                arriving.shadowed += lux * directional_visibility(i, point);
            }
        }
    }
    for (var i = 0u; i < environment.local_count; i++) {
        let kind = select(SPOT_LIGHTS, POINT_LIGHTS, local_lights[i].shadow >= 0);
        let lux = falling(point, local_illumination(i, point.position));
        if (params.light == ALL_LIGHTS || params.light == kind) && any(lux > vec3<f32>(0.0)) {
            arriving.unshadowed += lux;
            arriving.shadowed += lux * local_visibility(i, point);
        }
    }
    var targets: Targets;
    targets.light = vec4<f32>(arriving.shadowed * (environment.inverse_light_unit / PI), 1.0);
    if any(arriving.unshadowed > vec3<f32>(0.0)) {
        targets.visibility = luminance(arriving.shadowed) / luminance(arriving.unshadowed);
    }
    if environment.directional_count > 0u {
        targets.cascade = vec4<f32>(cascade_color(point) * (0.35 + 0.65 * directional_visibility(0u, point)), 1.0);
    }
    return targets;
}

// Lux on a surface that nothing blocks; exactly 0 where the light stands behind it.
fn falling(point: SurfacePoint, light: Illumination) -> vec3<f32> {
    let facing = select(0.0, 1.0, dot(point.geometric_normal, light.to_light) > 0.0);
    return light.illuminance * (facing * max(dot(point.normal, light.to_light), 0.0));
}

// Red, green, blue, yellow, and over again; grey where no shadow falls.
fn cascade_color(point: SurfacePoint) -> vec3<f32> {
    let choice = choose_cascade(0u, point);
    let grey = vec3<f32>(0.5);
    if choice.count == 0u {
        return grey;
    }
    let color = mix(color_of(choice.index + 1u), color_of(choice.index), choice.weight);
    return mix(grey, color, choice.strength);
}

fn color_of(cascade: u32) -> vec3<f32> {
    switch cascade % 4u {
        case 0u: { return vec3<f32>(0.8, 0.15, 0.1); }
        case 1u: { return vec3<f32>(0.15, 0.6, 0.15); }
        case 2u: { return vec3<f32>(0.1, 0.25, 0.8); }
        default: { return vec3<f32>(0.8, 0.65, 0.1); }
    }
}
