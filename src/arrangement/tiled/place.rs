//! The face of an arrangement at a place, and the nearest curve (rule E8); in constant time where there are tiles.

use std::sync::Arc;

use crate::function::Arrangement;
use crate::near::border::sides;
use crate::near::locality::common;
use crate::tiled::conversion::{Division, LEAST};
use crate::tiled::regularity::{Irregular, Regularity};
use crate::tiled::tile::{Tile, origin};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::planar_map::{self, FaceId, PlanarMap, PlanarMapError};
use fretwork_geometry::{Bounds, Curves, LabelSet, Point, Region};

/// So many diagonals of a tile around a place are drawn, one window after the other.
const WINDOWS: [f64; 3] = [1.0, FARTHEST, 16.0];
/// Where all is repeated, what leaves so many tiles goes on for ever.
const FARTHEST: f64 = 4.0;
/// What is nearer to the side of a window than so many resolutions may be cut by it: a planar map moves points by about one.
const SIDE: f64 = 16.0;
/// So many tiles are drawn at most for a place far away.
const MOST: f64 = 1e6;

/// So many tiles wide is a large page.
const PAGE: f64 = 1e3;

/// What is at a place.
#[derive(Clone, Debug, PartialEq)]
pub struct AtPlace {
    /// The bounded face there: its labels, area and centroid.
    pub face: Option<(LabelSet, f64, Point)>,
    /// The distance of the nearest curve, if there is any.
    pub distance: Option<f64>,
}

impl AtPlace {
    /// What curves of a resolution have at a place.
    ///
    /// # Errors
    /// When the curves form no planar map.
    pub fn of(curves: &Curves, resolution: f64, at: Point) -> Result<AtPlace, PlanarMapError> {
        let map = PlanarMap::build(curves, resolution)?;
        Ok(AtPlace::in_map(&map, curves, at))
    }

    /// The same of their planar map.
    pub(crate) fn in_map(map: &PlanarMap, curves: &Curves, at: Point) -> AtPlace {
        let face = map.face_at(at);
        let is_bounded = face != FaceId::UNBOUNDED;
        let face = is_bounded.then(|| {
            (
                map.face_labels(face),
                map.face_area(face),
                map.centroid(face),
            )
        });
        AtPlace {
            face,
            distance: distance(curves, at),
        }
    }
}

/// The distance of the nearest curve.
fn distance(curves: &Curves, at: Point) -> Option<f64> {
    let to_piece = |ends: &[Point]| {
        let d = ends[1] - ends[0];
        let along = (at - ends[0]).dot(d) / d.dot(d);
        let part = if along.is_finite() {
            along.clamp(0.0, 1.0)
        } else {
            0.0
        };
        at.distance(ends[0] + d * part)
    };
    let pieces = curves
        .iter()
        .flat_map(|curve| curve.points.windows(2).map(to_piece));
    pieces.reduce(f64::min)
}

/// How an arrangement is drawn on a page.
#[derive(Clone, Debug, PartialEq)]
pub enum Engine {
    /// By tiles with these periods and so many vertices, edges and faces each.
    Tiled {
        /// The periods.
        periods: [Point; 2],
        /// Cells of a tile.
        cells: usize,
    },
    /// Cell by cell.
    General(Irregular),
}

impl Arrangement {
    /// How the arrangement is drawn on a page with this box; small regions, and what lies near a border, are drawn by the
    /// general engine all the same.
    pub fn engine(&self, page: Bounds, resolution: f64) -> Engine {
        let tile = match (self.varied(), self.parts()) {
            (Some(varied), _) => varied.tile(page, resolution).map(|varied| varied.tile),
            (None, Some(parts)) => {
                for part in parts {
                    if let Engine::General(reason) = part.engine(page, resolution) {
                        return Engine::General(reason);
                    }
                }
                Tile::of(self, page, resolution)
            }
            (None, None) => Tile::of(self, page, resolution),
        };
        match tile {
            Ok(tile) => Engine::Tiled {
                periods: tile.lattice.periods,
                cells: cells(&tile, resolution),
            },
            Err(reason) => Engine::General(reason),
        }
    }

    /// How the arrangement is drawn on large pages; `resolution` is that of all pages, if they have the same.
    pub fn engine_anywhere(&self, resolution: Option<f64>) -> Engine {
        let input = self.varied().map_or(self, |varied| &varied.input);
        let lattice = input.regularity().map_err(Irregular::clone);
        let lattice = match lattice.and_then(Regularity::lattice) {
            Ok(lattice) => lattice,
            Err(reason) => return Engine::General(reason),
        };
        let side = PAGE * lattice.diagonal();
        let page = Bounds::of([Point::ORIGIN, Point::new(side, side)]);
        self.engine(
            page,
            resolution.unwrap_or_else(|| planar_map::resolution(side)),
        )
    }

    /// What is at a place of `region`.
    ///
    /// # Errors
    /// Those of [`Arrangement::apply`], and when the curves form no planar map.
    pub fn at(
        &self,
        region: &Region,
        resolution: f64,
        at: Point,
    ) -> Result<AtPlace, Vec<Diagnostic>> {
        if let Some(found) = self.at_in_tiles(region, resolution, at) {
            return Ok(found);
        }
        if let Some(found) = self.at_near(region, resolution, at)? {
            return Ok(found);
        }
        let curves: Arc<Curves> = self.draw(region, resolution)?;
        AtPlace::of(&curves, resolution, at)
            .map_err(|error| vec![Diagnostic::error(error.to_string())])
    }

    /// The same from a window around the place. None where that does not tell.
    fn at_in_tiles(&self, region: &Region, resolution: f64, at: Point) -> Option<AtPlace> {
        let (tile, cells, own) = match self.varied() {
            Some(varied) => {
                let varied = varied.tile(region.page(), resolution).ok()?;
                (varied.tile, varied.cells.len(), varied.hull)
            }
            None => {
                let tile = self.tile_on(region, resolution)?;
                let (cells, own) = (tile.curves.len(), tile.hull);
                (tile, cells, own)
            }
        };
        let division = Division::of(region, &tile, cells, LEAST)?;
        let around = Around {
            arrangement: self,
            region,
            resolution,
            hull: region.page().grown(own.width() + own.height()),
        };
        let size = tile.lattice.diagonal();
        for factor in WINDOWS {
            let window = Bounds::of([at]).grown(factor * size);
            let (mut found, is_whole) = around.seen(&window, at)?;
            let is_endless = factor == FARTHEST && division.is_deep(&window);
            let is_near = found.distance.is_some_and(|d| d <= factor * size);
            if is_near && (is_whole || is_endless) {
                found.face = found.face.filter(|_| is_whole);
                return Some(found);
            }
        }
        around.far(at, size)
    }
}

/// An arrangement around places of a region, with the box that its curves do not leave.
struct Around<'a> {
    arrangement: &'a Arrangement,
    region: &'a Region,
    resolution: f64,
    hull: Bounds,
}

impl Around<'_> {
    /// What a window has at a place in it, and whether the whole has the same face there: one that the window does not cut,
    /// or the one around all faces, which is reached from there without leaving the window but where the hull ends.
    fn seen(&self, window: &Bounds, at: Point) -> Option<(AtPlace, bool)> {
        let curves = self.drawn(window)?;
        let mut closed = (*curves).clone();
        closed.append(&sides(window, Some(&self.hull)));
        let map = PlanarMap::build(&closed, self.resolution).ok()?;
        let face = map.face_at(at);
        let around = map.outer_boundary(face);
        let bounds = Bounds::of(around.flat_map(|h| map.points(h.edge)));
        // Whatever else bounds the face would lie in its box.
        let inner = window.grown(-SIDE * self.resolution);
        let is_inside = inner.contains(bounds.min) && inner.contains(bounds.max);
        let is_whole = face == FaceId::UNBOUNDED || is_inside;
        Some((AtPlace::in_map(&map, &curves, at), is_whole))
    }

    /// What is at a place outside of the hull: no face, and the nearest of the curves that lie no farther than some curve
    /// near to where the hull is nearest. `size` is that of a tile.
    fn far(&self, at: Point, size: f64) -> Option<AtPlace> {
        if self.hull.contains(at) {
            return None;
        }
        let (min, max) = (self.hull.min, self.hull.max);
        let foot = Point::new(at.x.clamp(min.x, max.x), at.y.clamp(min.y, max.y));
        for factor in WINDOWS {
            let curves = self.drawn(&Bounds::of([foot]).grown(factor * size))?;
            let Some(some) = distance(&curves, at) else {
                continue;
            };
            // Where a disc about the place meets the hull.
            let gap = at - foot;
            let half = [gap.y, gap.x].map(|gap| (some * some - gap * gap).max(0.0).sqrt());
            let half = Point::new(half[0], half[1]);
            let disc = Bounds::of([at - half, at + half]).grown(size);
            let lens = common(&self.hull, &disc);
            if lens.width() * lens.height() > MOST * size * size {
                return None;
            }
            let curves = self.drawn(&lens)?;
            return Some(AtPlace {
                face: None,
                distance: distance(&curves, at),
            });
        }
        None
    }

    fn drawn(&self, window: &Bounds) -> Option<Arc<Curves>> {
        let drawn = self
            .arrangement
            .draw_in(self.region, self.resolution, window);
        drawn.ok()
    }
}

/// How many vertices, edges and bounded faces belong to one tile.
fn cells(tile: &Tile, resolution: f64) -> usize {
    let Ok(map) = PlanarMap::build(&tile.around, resolution) else {
        return 0;
    };
    let count = |places: Vec<Point>| {
        let deep: Vec<Point> = places
            .into_iter()
            .filter(|p| tile.deep.contains(*p))
            .collect();
        let origin = origin(&tile.lattice, tile.origin, deep.iter().copied());
        // The origin is moved by up to a tile, so that one further back lies in the middle for certain.
        let k = tile.lattice.tile(tile.deep.center(), origin);
        let own = deep.iter();
        own.filter(|p| tile.lattice.tile(**p, origin) == k).count()
    };
    let vertices = map.vertices().map(|v| map.location(v)).collect();
    let edges = map
        .edges()
        .map(|e| crate::cells::location_at(&map, e, 0.5))
        .collect();
    let faces = map.bounded_faces().map(|f| map.centroid(f)).collect();
    count(vertices) + count(edges) + count(faces)
}
