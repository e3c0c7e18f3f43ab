//! Tiled planar maps (Loi 2015, chapter 4): arrangements that are the same one period further, drawn once for a tile
//! and copied.
//!
//! 1. `regularity` is what a definition tells of an arrangement: after which moves its lines are the same again.
//!    `family` finds the moves that are common to all of its parts, and `lattice` is what they form.
//! 2. `tile` draws the arrangement with the general engine on a patch of the plane around a few tiles, watched so that
//!    nothing is asked that differs from tile to tile, and takes what belongs to one tile.
//! 3. `rows` finds the tiles that lie so deep in a region that its border is not seen in them; `zone` is what remains.
//! 4. `conversion` copies the tile to all deep tiles and draws the zone with the general engine; `window` does so for a
//!    window, `varied` with a last random mapper, and `place` for a point.
//!
//! That the copies are what the general engine draws is checked wherever a zone is drawn: in a belt of deep tiles around
//! the zone both must be the same. Where they are not, the general engine draws all of the region.
//!
//! Which nodes are tried, and what is said about it, is decided by callers.

pub(crate) mod conversion;
pub(crate) mod family;
pub(crate) mod lattice;
pub(crate) mod place;
pub(crate) mod regularity;
pub(crate) mod rows;
pub(crate) mod tile;
pub(crate) mod varied;
pub(crate) mod window;
pub(crate) mod zone;

#[cfg(test)]
mod tests;
