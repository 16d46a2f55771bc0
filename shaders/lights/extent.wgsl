// How far point and spot lights reach: what volumes and spheres around them have to enclose.

#import "shared/lights.wgsl"

// Half angles (cosine 0.5: 60 degrees) beyond which a cone is taken for a whole sphere.
const NARROW_CONE: f32 = 0.5;

// Metres to where a light ends; 0 if it has no end.
fn light_end(index: u32) -> f32 {
    let range = local_lights[index].range;
    let reach = local_lights[index].reach;
    if range > 0.0 && reach > 0.0 {
        return min(range, reach);
    }
    return max(range, reach);
}

// Cosine of the half angle outside of which a spot gives nothing; -1 for lights that shine everywhere.
fn outer_cosine(index: u32) -> f32 {
    let scale = local_lights[index].spot_scale;
    if scale <= 0.0 {
        return -1.0;
    }
    return clamp(-local_lights[index].spot_offset / scale, -1.0, 1.0);
}

// A light that is off reaches nothing.
fn is_dark(index: u32) -> bool {
    return all(local_lights[index].intensity <= vec3<f32>(0.0));
}
