// Which point and spot lights may reach which tile of the image: one bit for each light, tile by tile.
//
// Bits rather than numbers, so that the order in which lights are found changes nothing, and no list can overflow. A light whose bit is
// missing gives nothing in the tile; one whose bit is set may still give nothing.

#import "shared/environment.wgsl"

// Whether there are lists; without them every light is looked at.
override lights_are_listed: bool = false;
// Edge of a tile in pixels.
override light_tile: u32 = 16;

// Words of 32 bits for each tile.
fn light_words() -> u32 {
    return (environment.local_count + 31u) / 32u;
}

// The first word of the tile that holds a pixel of an image so wide.
fn light_list_start(texel: vec2<u32>, width: u32) -> u32 {
    let tiles_across = (width + light_tile - 1u) / light_tile;
    let tile = texel / light_tile;
    return (tile.y * tiles_across + tile.x) * light_words();
}
