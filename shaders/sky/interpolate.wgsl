// Bilinear interpolation in tables of 32-bit floats, which devices need not filter. Tables hold the ends of their ranges in their
// outermost texels: `place` is (0, 0) in the middle of the first texel and (1, 1) in the middle of the last.

// The texel before a place, and how far behind it the place is.
struct Cell {
    corner: vec2<i32>,
    next: vec2<i32>,
    part: vec2<f32>,
}

fn table_cell(size: vec2<u32>, place: vec2<f32>) -> Cell {
    let last = vec2<f32>(size) - 1.0;
    let scaled = clamp(place, vec2<f32>(0.0), vec2<f32>(1.0)) * last;
    let corner = min(floor(scaled), max(last - 1.0, vec2<f32>(0.0)));
    return Cell(vec2<i32>(corner), vec2<i32>(min(corner + 1.0, last)), scaled - corner);
}

fn interpolate(table: texture_2d<f32>, place: vec2<f32>) -> vec4<f32> {
    let cell = table_cell(textureDimensions(table), place);
    let upper = mix(textureLoad(table, cell.corner, 0), textureLoad(table, vec2<i32>(cell.next.x, cell.corner.y), 0), cell.part.x);
    let lower = mix(textureLoad(table, vec2<i32>(cell.corner.x, cell.next.y), 0), textureLoad(table, cell.next, 0), cell.part.x);
    return mix(upper, lower, cell.part.y);
}
