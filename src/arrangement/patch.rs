//! A piece of the plane on which an arrangement is evaluated to learn what is repeated in it, and what must hold of the
//! cells in its middle, which stand for all of their translates.

use fretwork_geometry::{Bounds, PlanarMap};

/// A piece of the plane around some tiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// Where cells stand for others.
    pub deep: Bounds,
    /// Where the cells must lie that reach into `deep`.
    pub room: Bounds,
}

impl Patch {
    /// The patch in which no cell stands for others: mappers are watched, and nothing else is asked of it.
    pub(crate) const NOWHERE: Patch = Patch {
        deep: Bounds::EMPTY,
        room: Bounds::EMPTY,
    };

    /// Fails when an edge or a bounded face of `map` that reaches into the middle of the patch goes on to its border: then
    /// what it is depends on the region.
    ///
    /// # Errors
    /// With a clause that says so.
    pub(crate) fn check(&self, map: &PlanarMap) -> Result<(), &'static str> {
        if self.deep.is_empty() {
            return Ok(());
        }
        let goes_on = |bounds: Bounds| {
            bounds.intersects(&self.deep)
                && !(self.room.contains(bounds.min) && self.room.contains(bounds.max))
        };
        if map.edges().any(|e| goes_on(Bounds::of(map.points(e)))) {
            return Err("its edges go on to the border of the region");
        }
        let of_face = |f| {
            let around = map.outer_boundary(f);
            Bounds::of(around.flat_map(|h| map.points(h.edge)))
        };
        if map.bounded_faces().any(|f| goes_on(of_face(f))) {
            return Err("its faces go on to the border of the region");
        }
        Ok(())
    }
}
