//! What is known of where the curves of an arrangement lie on a region, and how those near a room are drawn. What is done
//! with them is not here.

use std::sync::Arc;

use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Bounds, Curve, Curves, Region};

/// The part of the plane in which the curves of an arrangement are wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Room {
    /// The box.
    pub bounds: Bounds,
    /// Whether the whole is drawn, with what is repeated copied, or just applied, as it is in the faces that are filled.
    pub is_drawn: bool,
}

impl Room {
    /// The room with this box.
    pub fn with(self, bounds: Bounds) -> Room {
        Room { bounds, ..self }
    }
}

/// All curves of the whole that come into a room, as they are in the whole and in their order, and perhaps others that do not
/// come into it. None where that would be about as much as the whole.
pub(crate) type Nearby = Result<Option<Arc<Curves>>, Vec<Diagnostic>>;

/// What draws the curves on a region, of a resolution, that come into a room.
pub(crate) type Near = dyn Fn(&Region, f64, Room) -> Nearby + Send + Sync;

/// What is known of an arrangement whose curves can be drawn room by room.
pub(crate) struct Locality {
    /// Draws the curves near a room.
    pub near: Box<Near>,
    /// Where all of its curves lie; none where that is not known.
    pub extent: Option<Hull>,
    /// How large its bounded faces and edges are, where that is known.
    pub cell: Option<CellSize>,
    /// Whether its curves meet at their ends only.
    pub is_noded: bool,
}

/// How large the cells of an arrangement are: those of partitions, or what operators make of such cells one by one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CellSize {
    /// Their diagonals are no longer.
    pub most: f64,
}

impl CellSize {
    /// What holds for both.
    pub fn union(self, other: CellSize) -> CellSize {
        CellSize {
            most: self.most.max(other.most),
        }
    }

    /// The size of what is drawn for such cells.
    pub fn spread(self, by: Spread) -> CellSize {
        CellSize {
            most: self.most + 2.0 * by.of(self.most),
        }
    }
}

/// The box that an arrangement does not leave, on any region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hull {
    /// How far beyond the box of the region curves go; none where nothing depends on the region.
    pub beyond: Option<f64>,
    /// What lies in one place, whatever the region is.
    pub fixed: Bounds,
}

impl Hull {
    /// Curves that leave the box of the region by no more than `beyond`.
    pub fn beyond(beyond: f64) -> Hull {
        Hull {
            beyond: Some(beyond),
            fixed: Bounds::EMPTY,
        }
    }

    /// Curves that lie in a box.
    pub fn fixed(bounds: Bounds) -> Hull {
        Hull {
            beyond: None,
            fixed: bounds,
        }
    }

    /// What holds both.
    pub fn union(self, other: Hull) -> Hull {
        let beyond = match (self.beyond, other.beyond) {
            (Some(a), Some(b)) => Some(a.max(b)),
            (a, b) => a.or(b),
        };
        Hull {
            beyond,
            fixed: self.fixed.union(other.fixed),
        }
    }

    /// The same with curves that go farther by so much.
    pub fn grown(self, by: f64) -> Hull {
        Hull {
            beyond: self.beyond.map(|beyond| beyond + by),
            fixed: grown(self.fixed, by),
        }
    }

    /// The box on a region.
    pub fn on(self, region: &Region) -> Bounds {
        let of_region = self
            .beyond
            .map_or(Bounds::EMPTY, |by| grown(region.bounds(), by));
        of_region.union(self.fixed)
    }
}

/// A box with a margin; an empty one stays empty.
pub(crate) fn grown(bounds: Bounds, by: f64) -> Bounds {
    if bounds.is_empty() {
        bounds
    } else {
        bounds.grown(by)
    }
}

/// What two boxes have in common.
pub(crate) fn common(a: &Bounds, b: &Bounds) -> Bounds {
    use fretwork_geometry::Point;
    Bounds {
        min: Point::new(a.min.x.max(b.min.x), a.min.y.max(b.min.y)),
        max: Point::new(a.max.x.min(b.max.x), a.max.y.min(b.max.y)),
    }
}

/// The curves whose boxes meet a box.
pub(crate) fn reaching(curves: &Curves, room: &Bounds) -> Curves {
    let reaches = |curve: Curve<'_>| Bounds::of(curve.points.iter().copied()).intersects(room);
    curves.filtered(|_, curve| reaches(curve))
}

/// How far from the box of a cell lies what is drawn for it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Spread {
    /// A length.
    pub length: f64,
    /// A part of the diagonal of the box.
    pub share: f64,
    /// Whether what is drawn lies in the closed cell itself.
    pub is_inside: bool,
}

impl Spread {
    /// How far for a cell whose box has this diagonal.
    pub fn of(self, diagonal: f64) -> f64 {
        self.length + self.share * diagonal
    }
}

/// The diagonal of a box.
pub(crate) fn diagonal(bounds: &Bounds) -> f64 {
    if bounds.is_empty() {
        0.0
    } else {
        bounds.min.distance(bounds.max)
    }
}
