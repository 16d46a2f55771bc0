// Tone mapping: from exposed radiance (1 is about paper white) to what a display shows, linear, 0 to 1. The target's sRGB format
// encodes it.

#import "shared/color.wgsl"
#import "shared/math.wgsl"

// In the order of the parameter `tone_mapping`.
const TONE_MAP_NONE: u32 = 0u;
const TONE_MAP_REINHARD: u32 = 1u;
const TONE_MAP_ACES: u32 = 2u;
const TONE_MAP_AGX: u32 = 3u;
const TONE_MAP_NEUTRAL: u32 = 4u;

// Reinhard et al. 2002, "Photographic Tone Reproduction for Digital Images", eq. 3: L / (1 + L), here on luminance, which keeps
// the hue; strongly coloured light clips.
fn tone_map_reinhard(color: vec3<f32>) -> vec3<f32> {
    return color / (1.0 + luminance(color));
}

// The ACES reference rendering and sRGB output transforms as fitted by Stephen Hill (in MJP's BakingLab, 2016): into a space near
// AP1, a rational curve per channel, and back. Film-like: strong contrast, bright colours go to white.
fn tone_map_aces(color: vec3<f32>) -> vec3<f32> {
    let into_curve = mat3x3<f32>(
        vec3<f32>(0.59719, 0.07600, 0.02840),
        vec3<f32>(0.35458, 0.90834, 0.13383),
        vec3<f32>(0.04823, 0.01566, 0.83777),
    );
    let out_of_curve = mat3x3<f32>(
        vec3<f32>(1.60475, -0.10208, -0.00327),
        vec3<f32>(-0.53108, 1.10813, -0.07276),
        vec3<f32>(-0.07367, -0.00605, 1.07602),
    );
    let x = into_curve * color;
    let curved = (x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.4329510) + 0.238081);
    return out_of_curve * curved;
}

// AgX by Troy Sobotka (2022), as approximated by Benjamin Wrensch ("Minimal AgX Implementation", 2023): into wide primaries,
// logarithm over 16.5 stops around middle grey, a polynomial for the S-curve, and back. Its result is encoded for a display of
// gamma 2.2. Very bright light goes to white without turning its hue, over a wide range.
const AGX_LEAST_EV: f32 = -12.47393;
const AGX_MOST_EV: f32 = 4.026069;

fn tone_map_agx(color: vec3<f32>) -> vec3<f32> {
    let inset = mat3x3<f32>(
        vec3<f32>(0.842479062253094, 0.0423282422610123, 0.0423756549057051),
        vec3<f32>(0.0784335999999992, 0.878468636469772, 0.0784336),
        vec3<f32>(0.0792237451477643, 0.0791661274605434, 0.879142973793104),
    );
    let outset = mat3x3<f32>(
        vec3<f32>(1.19687900512017, -0.0528968517574562, -0.0529716355144438),
        vec3<f32>(-0.0980208811401368, 1.15190312990417, -0.0980434501171241),
        vec3<f32>(-0.0990297440797205, -0.0989611768448433, 1.15107367264116),
    );
    let positive = max(inset * color, vec3<f32>(exp2(AGX_LEAST_EV)));
    let stops = clamp(log2(positive), vec3<f32>(AGX_LEAST_EV), vec3<f32>(AGX_MOST_EV));
    let x = (stops - AGX_LEAST_EV) / (AGX_MOST_EV - AGX_LEAST_EV);
    let curved = -0.00232 + x * (0.1191 + x * (0.4298 + x * (-6.868 + x * (31.96 + x * (-40.14 + x * 15.5)))));
    return pow(max(outset * curved, vec3<f32>(0.0)), vec3<f32>(2.2));
}

// Khronos PBR Neutral (2024 specification): base colours under white light come out as they are; highlights above 0.76 are
// compressed and go to white.
const NEUTRAL_F90_OFFSET: f32 = 0.04;
const NEUTRAL_COMPRESSION_START: f32 = 0.8 - 0.04;
const NEUTRAL_DESATURATION: f32 = 0.15;

fn tone_map_neutral(color: vec3<f32>) -> vec3<f32> {
    let low = smallest(color);
    let offset = select(NEUTRAL_F90_OFFSET, low - 6.25 * square(low), low < 2.0 * NEUTRAL_F90_OFFSET);
    let shifted = color - offset;
    let peak = largest(shifted);
    if peak < NEUTRAL_COMPRESSION_START {
        return shifted;
    }
    let room = 1.0 - NEUTRAL_COMPRESSION_START;
    let new_peak = 1.0 - square(room) / (peak + room - NEUTRAL_COMPRESSION_START);
    let whiteness = 1.0 - 1.0 / (NEUTRAL_DESATURATION * (peak - new_peak) + 1.0);
    return mix(shifted * (new_peak / peak), vec3<f32>(new_peak), whiteness);
}

fn tone_map(color: vec3<f32>, curve: u32) -> vec3<f32> {
    switch curve {
        case TONE_MAP_REINHARD: { return saturate(tone_map_reinhard(color)); }
        case TONE_MAP_ACES: { return saturate(tone_map_aces(color)); }
        case TONE_MAP_AGX: { return saturate(tone_map_agx(color)); }
        case TONE_MAP_NEUTRAL: { return saturate(tone_map_neutral(color)); }
        default: { return saturate(color); }
    }
}
