//! The cells of an arrangement that come into question for a room, as they are in the whole.
//!
//! The arrangement is drawn on a larger room, the surroundings. A cell that lies in them, away from their border, is a cell of
//! the whole: all curves of the whole that come there are drawn. When some cell that matters goes on to the border, the
//! surroundings are enlarged.
//!
//! A cell matters when what is drawn for it may come into the room. Also one whose box meets the room although it lies
//! beside it, around a corner: such a cell is seen when the surroundings are deeper than any cell is large. That is known
//! of partitions; of other arrangements the largest of the cells that matter is taken, twice.

use std::sync::Arc;

use crate::cells::{Cell, incident_edges};
use crate::from_spec::combine::planar_map;
use crate::function::Arrangement;
use crate::near::border::{face_on_all_sides, sides, sides_without};
use crate::near::corridor::Open;
use crate::near::locality::{CellSize, Nearby, Room, Spread, common, diagonal, grown};
use crate::script::mapping::cells_of;
use crate::script::seeds::plain;
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::planar_map::{EdgeId, FaceId, PlanarMap};
use fretwork_geometry::{Bounds, Curves, Point, Region, VertexId};
use fretwork_script::known::KnownCells;
use fretwork_script::values::{self, CellKind};

/// So often the surroundings are enlarged.
const ATTEMPTS: u32 = 10;
/// Surroundings that cover more than this part of the whole are not worth while.
const MOST: f64 = 0.5;
/// Cells nearer to the border of the surroundings than so many resolutions are not known: a planar map moves points by about
/// one, and merges what is as near.
const BORDER: f64 = 16.0;
/// The first surroundings are deeper than the room by this part of it, or more.
const FIRST: f64 = 1.0 / 16.0;

/// What is asked.
pub(crate) struct Request<'a> {
    /// The arrangement whose cells are wanted.
    pub input: &'a Arrangement,
    /// What it is applied to.
    pub region: &'a Region,
    /// Points nearer than this are one.
    pub resolution: f64,
    /// Where what is drawn for cells is wanted.
    pub room: Room,
    /// How far from a cell that lies.
    pub spread: Spread,
    /// Which cells.
    pub kind: CellKind,
    /// The entry that asks.
    pub span: &'a Span,
}

/// The cells that were found.
pub(crate) struct Found {
    /// A planar map of which a part is known.
    pub map: Arc<PlanarMap>,
    /// Which part.
    pub known: Arc<KnownCells>,
    /// The cells that matter, ascending; all of them are known.
    pub cells: Vec<u32>,
    /// Where everything is known.
    pub inner: Bounds,
}

/// What is made of cells; none when more of the surroundings must be known.
pub(crate) type Made = Result<Option<Curves>, Vec<Diagnostic>>;

impl Request<'_> {
    /// What `work` makes of the cells that matter.
    pub fn answer(&self, work: impl Fn(&Found) -> Made) -> Nearby {
        let Some(local) = self.input.local() else {
            return Ok(None);
        };
        let hull = local.extent.map(|extent| extent.on(self.region));
        let cell = local.cell.and_then(|cell| self.largest_face(cell));
        let room = grown(self.room.bounds, self.spread.length + self.margin());
        let mut depth = self.first_depth(cell);
        for _ in 0..ATTEMPTS {
            let around = grown(room, depth);
            if !self.is_worth_while(&around, hull.as_ref()) {
                return Ok(None);
            }
            let with = self.room.with(around);
            let Some(curves) = self.input.near(self.region, self.resolution, with)? else {
                return Ok(None);
            };
            let found = self.found(&curves, &around, (hull, cell))?;
            if let Some(found) = found.filter(|found| self.is_deep(depth, found, cell))
                && let Some(made) = work(&found)?
            {
                return Ok(Some(Arc::new(made)));
            }
            depth *= 2.0;
        }
        Ok(None)
    }

    /// The diagonal of the largest face of a partition whose cells are no larger than `cell`: holes of the region are faces too.
    fn largest_face(&self, cell: CellSize) -> Option<CellSize> {
        let [polygon] = &self.region.area[..] else {
            return None;
        };
        let of_hole = |hole: &Vec<Point>| diagonal(&Bounds::of(hole.iter().copied()));
        let holes = polygon.holes.iter().map(of_hole);
        let most = holes.fold(cell.most, |most, hole| most.max(hole + 2.0 * cell.most));
        Some(CellSize { most })
    }

    /// The part of the surroundings along their border that is not known.
    fn margin(&self) -> f64 {
        BORDER * self.resolution
    }

    fn first_depth(&self, cell: Option<CellSize>) -> f64 {
        let needed = cell.map_or(0.0, |cell| match self.spread.is_inside {
            true => cell.most / 2.0,
            false => (1.0 + self.spread.share) * cell.most,
        });
        let part = match cell {
            Some(_) => 0.0,
            None => FIRST * self.room.bounds.longer_side(),
        };
        needed.max(part) + 2.0 * self.margin()
    }

    /// Whether less than about half of the whole is drawn.
    fn is_worth_while(&self, around: &Bounds, hull: Option<&Bounds>) -> bool {
        let page = self.region.page();
        let whole = hull.map_or(page, |hull| page.union(*hull));
        let seen = common(&whole, around);
        let area = |bounds: &Bounds| {
            if bounds.is_empty() {
                0.0
            } else {
                bounds.width() * bounds.height()
            }
        };
        area(&seen) <= MOST * area(&whole)
    }

    /// Whether the surroundings are so deep that no cell that matters lies beyond them.
    fn is_deep(&self, depth: f64, found: &Found, cell: Option<CellSize>) -> bool {
        if self.spread.is_inside {
            return true;
        }
        let largest = cell.map_or_else(
            || {
                let boxes = found.cells.iter();
                let boxes = boxes.map(|id| diagonal(&bounds_of(&found.map, self.kind, *id)));
                2.0 * boxes.fold(0.0, f64::max)
            },
            |cell| cell.most,
        );
        depth >= (1.0 + self.spread.share) * largest
    }

    /// The cells that matter, if all of them are known.
    fn found(
        &self,
        curves: &Curves,
        around: &Bounds,
        (hull, cell): (Option<Bounds>, Option<CellSize>),
    ) -> Result<Option<Found>, Vec<Diagnostic>> {
        let hull = hull.map(|hull| grown(hull, self.margin()));
        let inner = around.grown(-self.margin());
        let mut map = self.closed(curves, &sides(around, hull.as_ref()))?;
        if let Some((hull, cell)) = hull.zip(cell)
            && let Some(border) = self.opened(&map, around, (&hull, cell))?
        {
            map = self.closed(curves, &border)?;
        }
        let known = known_in(&map, &inner);
        let matters = |id: &u32| {
            let bounds = bounds_of(&map, self.kind, *id);
            let by = self.spread.of(diagonal(&bounds)) + self.margin();
            grown(bounds, by).intersects(&self.room.bounds)
        };
        let is_drawn = |id: &u32| !self.is_border(&map, *id, around);
        let ids = cells_of(&map, self.kind).filter(matters);
        let cells: Vec<u32> = ids.filter(is_drawn).collect();
        if !cells.iter().all(|id| known.holds(self.kind, *id)) {
            return Ok(None);
        }
        Ok(Some(Found {
            map: Arc::new(map),
            known: Arc::new(known),
            cells,
            inner,
        }))
    }

    /// The planar map of curves and of the border of what is drawn.
    fn closed(&self, curves: &Curves, border: &Curves) -> Result<PlanarMap, Vec<Diagnostic>> {
        let mut all = curves.clone();
        all.append(border);
        planar_map(&all, self.resolution, self.span)
    }

    /// The border of the surroundings without the parts where the outermost face of the whole goes on beyond them, if a face of
    /// `map` is proved to be a part of that. Only surroundings deeper than any cell is large are looked at, since the others
    /// will have to be enlarged.
    fn opened(
        &self,
        map: &PlanarMap,
        around: &Bounds,
        (hull, cell): (&Bounds, CellSize),
    ) -> Result<Option<Curves>, Vec<Diagnostic>> {
        let width = 2.0 * cell.most;
        let is_deep = around.width().min(around.height()) >= width;
        let Some(face) = face_on_all_sides(map, around).filter(|_| is_deep) else {
            return Ok(None);
        };
        let open = Open {
            map,
            face,
            room: around,
            hull,
            width,
        };
        let draw = |bounds: &Bounds| -> Result<Option<PlanarMap>, Vec<Diagnostic>> {
            let with = self.room.with(*bounds);
            let drawn = self.input.near(self.region, self.resolution, with)?;
            let close = |drawn: Arc<Curves>| self.closed(&drawn, &sides(bounds, Some(hull)));
            drawn.map(close).transpose()
        };
        let is_open = open.goes_out(&draw)?;
        Ok(is_open.then(|| sides_without(map, around, face)))
    }

    /// Whether a cell lies on the border of the surroundings: it may be none of the whole.
    fn is_border(&self, map: &PlanarMap, id: u32, around: &Bounds) -> bool {
        let bounds = bounds_of(map, self.kind, id);
        let inner = around.grown(-self.margin());
        self.kind != CellKind::Face && !bounds.intersects(&inner)
    }
}

/// The box of a cell.
pub(crate) fn bounds_of(map: &PlanarMap, kind: CellKind, id: u32) -> Bounds {
    plain(values::Cell { kind, map: 0, id }).bounds(map)
}

/// The cells of a map that lie in a box, which is drawn completely.
fn known_in(map: &PlanarMap, inner: &Bounds) -> KnownCells {
    let lies = |bounds: Bounds| inner.contains(bounds.min) && inner.contains(bounds.max);
    let edges: Vec<bool> = map
        .edges()
        .map(|e| lies(Bounds::of(map.points(e))))
        .collect();
    let vertex = |v: VertexId| inner.contains(map.location(v));
    let is_known = |e: EdgeId| edges[e.0 as usize];
    let face = |f: FaceId| incident_edges(map, Cell::Face(f)).into_iter().all(is_known);
    let faces = std::iter::once(true).chain(map.bounded_faces().map(face));
    let (vertices, faces) = (map.vertices().map(vertex).collect(), faces.collect());
    KnownCells::new(vertices, edges, faces)
}
