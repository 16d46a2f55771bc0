// How the environment cube stands in the world: its turn, its unit, and the constant sky that is added to it.
//
// The cube holds the image of the sky in the image's own frame, so that a turn or another strength is no other cube; or the physical sky,
// in the frame of the world.

#import "shared/environment.wgsl"
#import "skybox/sky_image.wgsl"

override sky_is_physical: bool = false;

// A direction of the world in the frame of the cube.
fn in_environment(direction: vec3<f32>) -> vec3<f32> {
    if sky_is_physical {
        return direction;
    }
    return in_sky_image(direction);
}

// From the units of the cube to radiance / light_unit, with the same light from everywhere.
fn environment_light(in_cube: vec3<f32>) -> vec3<f32> {
    if sky_is_physical {
        return in_cube;
    }
    let strength = environment.sky_strength * environment.sky_unit;
    return (in_cube * strength + environment.sky_radiance) * environment.inverse_light_unit;
}
