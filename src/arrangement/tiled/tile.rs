//! What an arrangement draws in one of its tiles, found by drawing it around a few tiles.
//!
//! A curve belongs to the tile that its first point lies in. Tiles begin at an origin that no first point is near the
//! sides of a tile for, so that rounding never moves a curve into another tile.
//!
//! How deep the border of a region is seen (rule E4) is found by trying: the arrangement is drawn on a patch that reaches
//! farther than the depth around nine tiles, and four tiles in it must be the same. A mapper whose results lie far from
//! their cells shows by what it draws outside of the patch.

use crate::function::{Arrangement, Manner};
use crate::patch::Patch;
use crate::tiled::lattice::{Lattice, TileNumber};
use crate::tiled::regularity::Irregular;
use fretwork_geometry::{Bounds, Curve, Curves, Point, Region};

/// The first depth that is tried, in sides of a cell of mean area: more than the diagonal of a cell three times as long as
/// wide. A larger one takes longer, also where copies are made, because the border of a region is as deep.
const FIRST_DEPTH: f64 = 2.0;
/// So many times the depth that was found is kept: borders may cut cells elsewhere than that of the patch.
const SAFE: f64 = 1.5;
/// So often the depth is doubled.
const ATTEMPTS: u32 = 4;
/// Places are the same when they are nearer than so many resolutions: each planar map on the way rounds by about one.
const NEAR: f64 = 64.0;
/// The four tiles that are compared.
const COMPARED: [TileNumber; 4] = [[0, 0], [-1, 0], [0, -1], [-1, -1]];

/// A tile of an arrangement on a page.
#[derive(Clone, Debug)]
pub struct Tile {
    /// The moves that repeat it.
    pub lattice: Lattice,
    /// The corner of tile (0, 0).
    pub(crate) origin: Point,
    /// What belongs to tile (0, 0).
    pub(crate) curves: Curves,
    /// Where the first points of these curves are, and their numbers, ascending.
    by_x: Vec<(f64, u32)>,
    /// The box of these curves.
    pub(crate) hull: Bounds,
    /// How far from its border a region has to do with what is drawn.
    pub(crate) depth: f64,
    /// What was drawn around it, and where its cells are as they are everywhere.
    pub(crate) around: Curves,
    pub(crate) deep: Bounds,
    /// Points nearer than this are one.
    pub(crate) near: f64,
}

impl Tile {
    /// The tile of `arrangement` on a page with this box.
    ///
    /// # Errors
    /// Why there is none.
    pub(crate) fn of(
        arrangement: &Arrangement,
        page: Bounds,
        resolution: f64,
    ) -> Result<Tile, Irregular> {
        let regularity = arrangement.regularity().map_err(Irregular::clone)?;
        let lattice = regularity.lattice()?;
        let cell = regularity.cell_area.min(lattice.area()).sqrt();
        let mut depth = (FIRST_DEPTH * cell).min(lattice.diagonal());
        let mut reason = Irregular::new("what it draws differs from tile to tile");
        for _ in 0..ATTEMPTS {
            let attempt = Attempt {
                lattice,
                page,
                depth,
                resolution,
            };
            match attempt.tile(arrangement) {
                Ok(Some(tile)) => return Ok(tile),
                Ok(None) => {}
                Err(refused) => reason = refused,
            }
            depth *= 2.0;
        }
        Err(reason)
    }

    /// Whether `curve` is one of tile (0, 0) moved to tile `k`.
    pub(crate) fn holds(&self, curve: &Curve<'_>, k: TileNumber) -> bool {
        let by = self.lattice.at(k);
        let is_near = |(p, q): (&Point, &Point)| p.distance(*q + by) <= self.near;
        let x = (curve.points[0] - by).x;
        let from = self.by_x.partition_point(|own| own.0 < x - self.near);
        let candidates = self.by_x[from..].iter();
        candidates
            .take_while(|own| own.0 <= x + self.near)
            .map(|own| self.curves.get(own.1 as usize))
            .any(|own| {
                own.points.len() == curve.points.len()
                    && own.labels == curve.labels
                    && curve.points.iter().zip(own.points).all(is_near)
            })
    }

    /// The tile that a curve belongs to.
    pub(crate) fn number(&self, curve: &Curve<'_>) -> TileNumber {
        self.lattice.tile(curve.points[0], self.origin)
    }
}

/// A patch to be drawn.
struct Attempt {
    lattice: Lattice,
    page: Bounds,
    depth: f64,
    resolution: f64,
}

impl Attempt {
    /// The tile, or nothing where the patch is too small to tell.
    ///
    /// # Errors
    /// What is against it on a patch of this size.
    fn tile(&self, arrangement: &Arrangement) -> Result<Option<Tile>, Irregular> {
        let corner = self.page.min;
        let deep = self.lattice.bounds([-1, -1], [1, 1], corner);
        let patch = deep.grown(self.depth);
        let region = Region {
            whole: Some(self.page),
            ..Region::rectangle(patch.min, patch.max)
        };
        let manner = Manner::Regular(Patch {
            deep,
            room: deep.grown(0.75 * self.depth),
        });
        let drawn = arrangement.apply_as(&region, self.resolution, manner);
        let drawn = drawn.map_err(|errors| Irregular::refused(&errors))?;
        let reached = patch.grown(0.5 * self.depth);
        let bounds = drawn.bounds();
        let is_local = |curve: Curve<'_>| {
            let bounds = Bounds::of(curve.points.iter().copied());
            bounds.longer_side() <= self.depth || !bounds.intersects(&deep)
        };
        let is_within =
            drawn.is_empty() || reached.contains(bounds.min) && reached.contains(bounds.max);
        if !drawn.iter().all(is_local) {
            return Err(Irregular::new("its lines go on from tile to tile"));
        }
        if !is_within {
            return Ok(None);
        }
        Ok(self.taken(&drawn, deep))
    }

    /// What belongs to one tile, if the tiles are the same.
    fn taken(&self, drawn: &Curves, deep: Bounds) -> Option<Tile> {
        let firsts = drawn.iter().map(|curve| curve.points[0]);
        let firsts = firsts.filter(|p| deep.contains(*p));
        let origin = origin(&self.lattice, self.page.min, firsts);
        let of_tile = |k: TileNumber| {
            drawn.filtered(|_, curve| self.lattice.tile(curve.points[0], origin) == k)
        };
        let curves = of_tile([0, 0]);
        let firsts = curves.iter().map(|curve| curve.points[0].x);
        let mut by_x: Vec<(f64, u32)> = firsts.zip(0..).collect();
        by_x.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let tile = Tile {
            by_x,
            lattice: self.lattice,
            origin,
            hull: curves.bounds(),
            curves,
            depth: SAFE * self.depth,
            around: drawn.clone(),
            deep,
            near: NEAR * self.resolution,
        };
        let is_same = |k: TileNumber| {
            let other = of_tile(k);
            other.len() == tile.curves.len() && other.iter().all(|curve| tile.holds(&curve, k))
        };
        COMPARED.into_iter().all(is_same).then_some(tile)
    }
}

/// The corner of tiles that none of `places` is near a side of: in the middle of the widest gap between their coordinates
/// along each period.
pub(crate) fn origin(
    lattice: &Lattice,
    corner: Point,
    places: impl Iterator<Item = Point>,
) -> Point {
    let mut coordinates = [Vec::new(), Vec::new()];
    for place in places {
        let own = lattice.coordinates(place - corner);
        for (all, v) in coordinates.iter_mut().zip(own) {
            all.push(v - libm::floor(v));
        }
    }
    let middles = coordinates.map(|mut all| {
        all.sort_by(f64::total_cmp);
        let Some((first, last)) = all.first().zip(all.last()) else {
            return 0.0;
        };
        // The gap that goes on from the last to the first of the next tile.
        let mut widest = (first + 1.0 - last, (first + 1.0 + last) / 2.0);
        for pair in all.windows(2) {
            let gap = pair[1] - pair[0];
            // Wider by more than rounding, so that the same tile is found for other places of the page.
            if gap > widest.0 + 1e-6 {
                widest = (gap, (pair[0] + pair[1]) / 2.0);
            }
        }
        widest.1 - libm::floor(widest.1)
    });
    corner + lattice.point(middles)
}
