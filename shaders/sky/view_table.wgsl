// The sky from one place in all directions: the table `sky_view`, and looking it up.
//
// Layer 0 has what air molecules and repeated scattering send, layer 1 what aerosols send, without their phase function: that is far
// too peaked towards the sun for a table, and is applied to the exact direction. Both are radiance in parts of the sun's
// illuminance outside of the air. The sun itself is in neither. Alpha has the amounts of air and aerosols from the eye to the ground.
//
// The upper rows have the sky from the zenith down to the horizon, the lower ones go on to the nadir; they share no texel, so that
// nothing blurs the horizon. Rows are densest near it (Hillaire 2020, section 5.3), columns near the sun. Since both
// sides of the sun's vertical plane are equal, columns show one of them.

#import "sky/interpolate.wgsl"
#import "sky/shell.wgsl"

var sky_view: texture_2d_array<f32>;

// A direction as the table has it.
struct SkyDirection {
    // Radians above the level.
    elevation: f32,
    // Whether it meets the ground.
    down: bool,
    // Sine of half the angle between its azimuth and the sun's.
    half_azimuth_sine: f32,
}

fn sky_direction(direction: vec3<f32>, to_sun: vec3<f32>, altitude: f32) -> SkyDirection {
    let level = length(direction.xz);
    let sun_level = length(to_sun.xz);
    var half_chord = 0.0;
    // At the zenith all azimuths are one.
    if level > 1.0e-6 && sun_level > 1.0e-6 {
        half_chord = 0.5 * distance(direction.xz / level, to_sun.xz / sun_level);
    }
    let elevation = atan2(direction.y, level);
    return SkyDirection(elevation, elevation < -horizon_dip(altitude), saturate(half_chord));
}

// Cosine of the angle between the azimuths, 1 towards the sun.
fn azimuth_cosine(direction: SkyDirection) -> f32 {
    return 1.0 - 2.0 * square(direction.half_azimuth_sine);
}

// How many of a table's rows show the sky. The others show the ground, over which light has no edges.
fn sky_rows(rows: u32) -> u32 {
    return clamp(rows * 7u / 10u, 1u, max(rows, 2u) - 1u);
}

fn view_direction(texel: vec2<u32>, size: vec2<u32>, altitude: f32) -> SkyDirection {
    let above = sky_rows(size.y);
    let dip = horizon_dip(altitude);
    let down = texel.y >= above;
    let last = select(above, size.y - above, down) - 1u;
    let along = f32(select(above - 1u - texel.y, texel.y - above, down)) / f32(max(last, 1u));
    let range = select(0.5 * PI + dip, dip - 0.5 * PI, down);
    return SkyDirection(range * square(along) - dip, down, f32(texel.x) / f32(max(size.x - 1u, 1u)));
}

// Where a direction is looked up, in its part of the table, as for `interpolate`: 0 at the first row.
fn view_place(direction: SkyDirection, altitude: f32) -> vec2<f32> {
    let dip = horizon_dip(altitude);
    let from_horizon = direction.elevation + dip;
    let range = select(0.5 * PI + dip, dip - 0.5 * PI, direction.down);
    let along = sqrt(saturate(from_horizon / range));
    return vec2<f32>(direction.half_azimuth_sine, select(1.0 - along, along, direction.down));
}

struct SkyView {
    // What air molecules and repeated scattering send, and alpha.
    even: vec4<f32>,
    // What aerosols send, without their phase function, and alpha.
    mie: vec4<f32>,
}

fn view_texel(texel: vec2<i32>) -> SkyView {
    return SkyView(textureLoad(sky_view, texel, 0, 0), textureLoad(sky_view, texel, 1, 0));
}

fn mix_views(a: SkyView, b: SkyView, part: f32) -> SkyView {
    return SkyView(mix(a.even, b.even, part), mix(a.mie, b.mie, part));
}

fn look_up_view(direction: SkyDirection, altitude: f32) -> SkyView {
    let size = textureDimensions(sky_view);
    let above = sky_rows(size.y);
    let rows = select(above, size.y - above, direction.down);
    var cell = table_cell(vec2<u32>(size.x, rows), view_place(direction, altitude));
    let first = select(0, i32(above), direction.down);
    cell.corner.y += first;
    cell.next.y += first;
    let upper = mix_views(view_texel(cell.corner), view_texel(vec2<i32>(cell.next.x, cell.corner.y)), cell.part.x);
    let lower = mix_views(view_texel(vec2<i32>(cell.corner.x, cell.next.y)), view_texel(cell.next), cell.part.x);
    return mix_views(upper, lower, cell.part.y);
}
