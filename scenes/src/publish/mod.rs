//! What a scene publishes to passes: tables, textures, geometry and draw lists, by name.
//!
//! Guarantees: equal worlds and requests give equal bytes, whatever was published before; tables follow stable slots, and none is empty;
//! no published number is NaN. A [`Publisher`] that is asked again works on what changed, and shares all else with what it published
//! before: geometry while no mesh comes, textures while images and materials stay, pages of tables, draw lists.
//! Accepted downside: every object's ticks are looked at, lights are read anew, and a view that moves tests the bounds of all
//! objects.

mod cascades;
mod casters;
mod counts;
mod coverage;
mod cube;
mod draws;
mod environment;
mod frustum;
mod geometry;
mod layout;
mod lights;
mod materials;
mod mips;
mod objects;
mod probes;
mod projection;
mod publisher;
mod reach;
mod rectangles;
mod request;
mod schema;
mod sky_image;
mod spot;
mod sun;
mod texture_cache;
mod textures;
mod visible;

#[cfg(test)]
mod tests;

pub use counts::counts;
pub use layout::{
    CameraTable, CascadeRow, Columns, DirectionalRow, EnvironmentTable, InstanceRow, LocalRow, MaterialRow, PointRow, ProbeRow,
    RectangleRow, SpotRow, TEXTURES, ViewTable, flags,
};
pub use publisher::Publisher;
pub use request::{PublishRequest, Published};
pub use schema::{COUNT_NAMES, TEXTURE_NAMES, schema};
