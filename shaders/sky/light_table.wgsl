// What arrives near the ground: the table `sky_light` of three texels, in parts of the sun's illuminance outside of the air.

// On a surface that faces the sun. Alpha: the eye's altitude, kilometres.
const SUN_HERE: i32 = 0;
// From the sky on a level plane. Alpha: the scale of aerosols.
const SKY_HERE: i32 = 1;
// Radiance of the level ground in the light of both. Alpha is 1.
const GROUND_HERE: i32 = 2;

var sky_light: texture_2d<f32>;

fn sky_light_texel(index: i32) -> vec4<f32> {
    return textureLoad(sky_light, vec2<i32>(index, 0), 0);
}
