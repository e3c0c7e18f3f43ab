//! Whether the face around what is drawn of a room is the outermost one of the whole: proved by a way out through gaps, or not
//! at all. A ring of shapes that touch one another may close the same face far away, where nobody has looked.
//!
//! From the room a corridor a few cells wide goes straight to each side of the box of all curves, until one is found in which
//! no curve parts the face from the outside. Beyond the box there is nothing, so the face goes round everything. Where
//! there is no such corridor the face counts as not known.
//!
//! A corridor costs its length, not the area that it crosses. It is drawn in one piece: what it is drawn from, such as shapes
//! that are shrunk once more, then goes beyond all curves too, and needs no corridor of its own. On a sheet of so many cells
//! that it is hardly drawn as a whole a corridor would take longer than a window may, and shapes that lie apart are taken to
//! lie in the open.

use crate::near::border::runs_along;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::planar_map::FaceId;
use fretwork_geometry::{Bounds, PlanarMap, Point};

/// The widths that are tried, in parts of the largest: most gaps lead on through a narrow corridor, which costs less.
const WIDTHS: [f64; 2] = [0.25, 1.0];
/// A corridor begins so far within the room, in parts of its width.
const OVERLAP: f64 = 0.25;
/// Where each side of the hull is farther away than so many of the largest widths, some 500 cells, the face is taken to go out.
const LONGEST: f64 = 64.0;
/// Gaps between curves that are narrower than this part of the corridor are passed over, so that rounding, which may close
/// them, does not matter.
const NARROW: f64 = 1e-3;

/// What draws a box, closed by those of its sides that lie in the box of all curves; none where it does not.
pub(crate) type Draw<'a> = dyn Fn(&Bounds) -> Result<Option<PlanarMap>, Vec<Diagnostic>> + 'a;

/// A face of what is drawn of a room.
pub(crate) struct Open<'a> {
    /// The planar map of the room, with its sides.
    pub map: &'a PlanarMap,
    /// The face.
    pub face: FaceId,
    /// The room.
    pub room: &'a Bounds,
    /// Beyond it there are no curves.
    pub hull: &'a Bounds,
    /// How wide a corridor is at most.
    pub width: f64,
}

/// The lower, right, upper or left side of a box, as numbers from 0.
type Side = usize;

impl Open<'_> {
    /// Whether a corridor proves that the face goes on to where no curves are, or would be too long to be drawn.
    ///
    /// # Errors
    /// Those of drawing a corridor.
    pub fn goes_out(&self, draw: &Draw<'_>) -> Result<bool, Vec<Diagnostic>> {
        let (room, hull) = (self.room, self.hull);
        let distances = [
            room.min.y - hull.min.y,
            hull.max.x - room.max.x,
            hull.max.y - room.max.y,
            room.min.x - hull.min.x,
        ];
        let mut sides: Vec<Side> = (0..4).filter(|side| distances[*side] > 0.0).collect();
        sides.sort_by(|a, b| distances[*a].total_cmp(&distances[*b]));
        let longest = LONGEST * self.width;
        if sides.first().is_some_and(|side| distances[*side] > longest) {
            return Ok(true);
        }
        for side in sides {
            for width in WIDTHS {
                if self.leads_out(side, width * self.width, draw)? {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// Whether the face goes on through the corridor to a side. The sides of the corridor are closed, but for what of them lies
    /// beyond all curves; so what of it is in the outermost face goes on to there.
    fn leads_out(&self, side: Side, width: f64, draw: &Draw<'_>) -> Result<bool, Vec<Diagnostic>> {
        let width = width.min(self.room.width()).min(self.room.height());
        let corridor = self.corridor(side, width);
        let mut places = self.gaps(side, width);
        places.retain(|place| corridor.contains(*place));
        if places.is_empty() {
            return Ok(false);
        }
        let map = draw(&corridor)?;
        let is_outside = |map: PlanarMap| {
            let mut places = places.iter();
            places.any(|place| map.face_at(*place) == FaceId::UNBOUNDED)
        };
        Ok(map.is_some_and(is_outside))
    }

    /// The corridor from within the room to a side of the hull, and beyond.
    fn corridor(&self, side: Side, width: f64) -> Bounds {
        let (room, hull) = (self.room, self.hull);
        let mut corridor = Bounds::of([room.center()]).grown(width / 2.0);
        let back = OVERLAP * width;
        match side {
            0 => (corridor.min.y, corridor.max.y) = (hull.min.y - back, room.min.y + back),
            1 => (corridor.min.x, corridor.max.x) = (room.max.x - back, hull.max.x + back),
            2 => (corridor.min.y, corridor.max.y) = (room.max.y - back, hull.max.y + back),
            _ => (corridor.min.x, corridor.max.x) = (hull.min.x - back, room.min.x + back),
        }
        corridor
    }

    /// Places in the gaps through which the face goes on across a side of the room.
    fn gaps(&self, side: Side, width: f64) -> Vec<Point> {
        let map = self.map;
        let edges = map.edges().filter(|e| {
            (map.left(*e) == self.face || map.right(*e) == self.face)
                && runs_along(map.points(*e), self.room) == Some(side)
        });
        let middle = |e| {
            let [from, to] = [map.source(e), map.target(e)].map(|v| map.location(v));
            (from.distance(to) > NARROW * width).then(|| from.lerp(to, 0.5))
        };
        edges.filter_map(middle).collect()
    }
}
