// Real spherical harmonics up to order 2 over the axes of the world, and irradiance from them.
//
// Ramamoorthi and Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps". Order of the nine functions:
// Y00; Y1-1 (y), Y10 (z), Y11 (x); Y2-2 (xy), Y2-1 (yz), Y20 (3 z^2 - 1), Y21 (xz), Y22 (x^2 - y^2); all signs positive.

const SH_COUNT: u32 = 9u;

// 1/2 sqrt(1/pi), sqrt(3/(4 pi)), 1/2 sqrt(15/pi), 1/4 sqrt(5/pi), 1/4 sqrt(15/pi).
const SH_BAND_0: f32 = 0.28209479177387814;
const SH_BAND_1: f32 = 0.4886025119029199;
const SH_BAND_2: f32 = 1.0925484305920792;
const SH_BAND_2_ZONAL: f32 = 0.31539156525252005;
const SH_BAND_2_SQUARES: f32 = 0.5462742152960396;

// The functions in a direction of unit length.
fn sh_basis(d: vec3<f32>) -> array<f32, 9> {
    return array<f32, 9>(
        SH_BAND_0,
        SH_BAND_1 * d.y,
        SH_BAND_1 * d.z,
        SH_BAND_1 * d.x,
        SH_BAND_2 * d.x * d.y,
        SH_BAND_2 * d.y * d.z,
        SH_BAND_2_ZONAL * (3.0 * d.z * d.z - 1.0),
        SH_BAND_2 * d.x * d.z,
        SH_BAND_2_SQUARES * (d.x * d.x - d.y * d.y),
    );
}

// What the clamped cosine leaves of each band, over pi: 1, 2/3, 1/4.
fn sh_cosine_band(index: u32) -> f32 {
    if index == 0u {
        return 1.0;
    }
    return select(0.25, 2.0 / 3.0, index < 4u);
}
