// How much of a light arrives at a surface, from shadow maps: of directional lights in cascades, of point lights in cubes, of spots in one
// map each. A light without a map shadows nothing.
//
// Among cascades the finest takes over that holds the receiver and all that the filter looks at; near its edge the next one fades in, so
// that no seam shows. Beyond the last one's greatest distance shadows have faded out.

#import "shared/camera.wgsl"
#import "shared/shadow_filter.wgsl"
#import "shared/surface_point.wgsl"

// The part of a cascade's width over which the next one fades in.
const SEAM: f32 = 0.1;
// The part of the greatest distance over which shadows fade out.
const FADE: f32 = 0.1;

// How many cascades each directional light has in the slots `cascade_maps` and `cascades`; -1 where these are those of the scene's own
// tables, which say it.
override cascades_each: i32 = -1;

// Which cascade shadows a point.
struct CascadeChoice {
    // Its number, the finest is 0. Without cascades there are none.
    index: u32,
    count: u32,
    // How much of it shows, the rest is the next one's: 0 to 1.
    weight: f32,
    // How much of the shadow is left at the point's distance: 0 to 1.
    strength: f32,
}

fn cascade_count(light: u32) -> u32 {
    if cascades_each >= 0 {
        return u32(cascades_each);
    }
    return directional_lights[light].cascades;
}

fn choose_cascade(light: u32, point: SurfacePoint) -> CascadeChoice {
    var choice = CascadeChoice(0u, cascade_count(light), 1.0, 1.0);
    let first = light * choice.count;
    if choice.count == 0u || first + choice.count > textureNumLayers(cascade_maps) {
        choice.count = 0u;
        return choice;
    }
    var room = 0.0;
    for (; choice.index < choice.count; choice.index++) {
        let receiver = cascade_receiver(first + choice.index, point.position, point.geometric_normal);
        room = texels_inside(receiver) - filter_reach();
        if room >= 0.0 || choice.index + 1u == choice.count {
            choice.weight = saturate(room / (SEAM * receiver.size));
            break;
        }
    }
    if choice.index + 1u < choice.count {
        let next = cascade_receiver(first + choice.index + 1u, point.position, point.geometric_normal);
        choice.weight = select(choice.weight, 1.0, texels_inside(next) < filter_reach());
    } else {
        choice.weight = 1.0;
    }
    let along = distance_along_axis(point.position) / cascades[first + choice.count - 1u].fade_end;
    choice.strength = saturate((1.0 - along) / FADE);
    return choice;
}

// How much of a directional light arrives: 0 to 1.
fn directional_visibility(light: u32, point: SurfacePoint) -> f32 {
    if dot(point.geometric_normal, directional_lights[light].direction_to_light) <= 0.0 {
        return 0.0;
    }
    let choice = choose_cascade(light, point);
    if choice.count == 0u || choice.strength == 0.0 {
        return 1.0;
    }
    let row = light * choice.count + choice.index;
    var visibility = filtered_shadow(cascade_receiver(row, point.position, point.geometric_normal), point.pixel);
    if choice.weight < 1.0 {
        let next = filtered_shadow(cascade_receiver(row + 1u, point.position, point.geometric_normal), point.pixel);
        visibility = mix(next, visibility, choice.weight);
    }
    return mix(1.0, visibility, choice.strength);
}

// How much of a point or spot light arrives: 0 to 1.
fn local_visibility(light: u32, point: SurfacePoint) -> f32 {
    if dot(point.geometric_normal, local_lights[light].position - point.position) <= 0.0 {
        return 0.0;
    }
    let shadow = local_lights[light].shadow;
    if shadow >= 0 {
        let row = u32(shadow);
        if row * 6u + 5u >= textureNumLayers(point_maps) {
            return 1.0;
        }
        return filtered_shadow(point_receiver(row, point.position, point.geometric_normal), point.pixel);
    }
    let row = u32(-1 - shadow);
    if row >= textureNumLayers(spot_maps) || spot_place(row, point.position, 1.0).z <= 0.0 {
        return 1.0;
    }
    return filtered_shadow(spot_receiver(row, point.position, point.geometric_normal), point.pixel);
}
