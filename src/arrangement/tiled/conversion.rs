//! From a tile to the curves on a region (rule E5): copies where the border of the region is not seen, and the general
//! engine's curves in the zone along it.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::function::{Applied, Arrangement};
use crate::tiled::lattice::{TileNumber, around, tiles};
use crate::tiled::rows::{Rows, Tiling};
use crate::tiled::tile::Tile;
use crate::tiled::zone;
use fretwork_geometry::budget;
use fretwork_geometry::{Bounds, CurveLabels, Curves, Point, Polygon, Region};

/// Fewer copies than about this many are not worth the zone around them.
pub(crate) const LEAST: f64 = 8192.0;
/// So many diagonals of a tile wide is the belt of deep tiles that the general engine draws too.
const BELT: f64 = 1.0;

/// What is drawn how on a region. Whether a tile is copied depends on the region alone.
pub(crate) struct Division<'a> {
    pub region: &'a Region,
    pub tiling: Tiling,
    /// How far from the border of the region, at least, copies are.
    depth: f64,
    /// The length of the diagonal of a tile.
    diagonal: f64,
}

impl Division<'_> {
    /// The division of `region` into copies of `tile`, each of so many cells, and the rest. None where less than about
    /// `least` cells would be copied.
    pub fn of<'a>(
        region: &'a Region,
        tile: &Tile,
        cells: usize,
        least: f64,
    ) -> Option<Division<'a>> {
        if region.period.is_some() || region.within.is_some() {
            return None;
        }
        let division = Division {
            region,
            tiling: Tiling {
                lattice: tile.lattice,
                origin: tile.origin,
            },
            depth: tile.depth,
            diagonal: tile.lattice.diagonal(),
        };
        let area: f64 = region.area.iter().map(Polygon::area).sum();
        let around = region.area.iter().flat_map(Polygon::rings).map(|ring| {
            let ends = ring.iter().zip(ring.iter().cycle().skip(1));
            ends.map(|(a, b)| a.distance(*b)).sum::<f64>()
        });
        let inner = area - around.sum::<f64>() * division.hole_depth();
        let copied = inner / tile.lattice.area() * cells as f64;
        (copied >= least).then_some(division)
    }

    /// How deep tiles are that the general engine is spared.
    fn hole_depth(&self) -> f64 {
        2.0 * self.depth + (BELT + 2.0) * self.diagonal
    }

    /// The tiles that are copied, of all rows or of some.
    pub fn copied(&self, rows: Option<[i64; 2]>) -> Rows {
        self.tiling.deep(self.region, self.depth, rows)
    }

    /// The tiles that are copied but not in the belt, of all rows or of some.
    pub fn beyond_belt(&self, rows: Option<[i64; 2]>) -> Rows {
        let depth = self.depth + BELT * self.diagonal;
        self.tiling.deep(self.region, depth, rows)
    }

    /// Whether all tiles that meet a box are copied.
    pub fn is_deep(&self, window: &Bounds) -> bool {
        let tile = self
            .tiling
            .lattice
            .bounds([0, 0], [0, 0], self.tiling.origin);
        let ends = around(&self.tiling.lattice, &tile, window);
        let copied = self.copied(Some([ends[0][1], ends[1][1]]));
        tiles(ends).all(|k| copied.contains(k))
    }

    /// The part of the region that the general engine draws.
    pub fn zone(&self) -> Region {
        let hole = self.tiling.deep(self.region, self.hole_depth(), None);
        zone::without(self.region, &self.tiling, &hole.blocks())
    }

    /// How far around a window the general engine has to draw for what it gives in the window to be right, when what is
    /// drawn in a tile reaches `reach` beyond it.
    pub fn margin(&self, reach: f64) -> f64 {
        2.0 * self.depth + (BELT + 2.0) * self.diagonal + reach
    }
}

/// The moves to tiles.
pub(crate) fn moves(tile: &Tile, tiles: impl Iterator<Item = TileNumber>) -> Vec<Point> {
    tiles.map(|k| tile.lattice.at(k)).collect()
}

impl Arrangement {
    /// The curves for `region`, as [`Arrangement::apply`] gives them but for rounding and order; what is repeated is copied
    /// where that is worth while.
    ///
    /// # Errors
    /// Those of [`Arrangement::apply`].
    pub fn draw(&self, region: &Region, resolution: f64) -> Applied {
        self.draw_copying(region, resolution, LEAST)
    }

    /// The same, copying where about so many curves would be copied.
    pub(crate) fn draw_copying(&self, region: &Region, resolution: f64, least: f64) -> Applied {
        if let Some(parts) = self.parts() {
            let drawn = parts.iter();
            let drawn = drawn.map(|part| part.draw_copying(region, resolution, least));
            let drawn: Vec<Arc<Curves>> = drawn.collect::<Result<_, _>>()?;
            return Ok(Arc::new(Curves::concatenated(&drawn)));
        }
        let copied = match self.varied() {
            Some(varied) => varied.copied(region, resolution, least),
            None => self.copied(region, resolution, least),
        };
        match copied {
            Some(curves) => Ok(Arc::new(curves)),
            None => self.apply(region, resolution),
        }
    }

    /// Copies and what is drawn in the zone. None where there is no tile, or it is not worth while, or the general engine
    /// differs.
    fn copied(&self, region: &Region, resolution: f64, least: f64) -> Option<Curves> {
        let tile = self.tile_on(region, resolution)?;
        let division = Division::of(region, &tile, tile.curves.len(), least)?;
        let copied = division.copied(None);
        let count = copied.count() as usize;
        budget::make(
            "copied points",
            count.saturating_mul(tile.curves.points().len()),
            size_of::<Point>(),
        );
        budget::make(
            "copied curves",
            count.saturating_mul(tile.curves.len()),
            size_of::<CurveLabels>() + size_of::<u32>(),
        );
        // What is wrong with the arrangement is told by drawing all of it.
        let zone = self.apply(&division.zone(), resolution).ok()?;
        let inner = division.beyond_belt(None);
        let belt = copied.tiles().filter(|k| !inner.contains(*k));
        let rest = rest(&tile, &zone, &copied, belt)?;
        let mut all = tile.curves.copies(&moves(&tile, copied.tiles()))?;
        all.append(&rest);
        Some(all)
    }

    /// The tile on a region.
    pub(crate) fn tile_on(&self, region: &Region, resolution: f64) -> Option<Tile> {
        self.regularity().ok()?;
        Tile::of(self, region.page(), resolution).ok()
    }
}

/// What of the zone is not copied. None where the zone has something else than the copies in the tiles of the belt.
pub(crate) fn rest(
    tile: &Tile,
    zone: &Curves,
    copied: &Rows,
    belt: impl Iterator<Item = TileNumber>,
) -> Option<Curves> {
    let mut in_belt: BTreeMap<TileNumber, usize> = belt.map(|k| (k, 0)).collect();
    let mut is_same = true;
    let rest = zone.filtered(|_, curve| {
        let k = tile.number(&curve);
        if let Some(count) = in_belt.get_mut(&k) {
            *count += 1;
            is_same &= tile.holds(&curve, k);
        }
        !copied.contains(k)
    });
    let all = tile.curves.len();
    (is_same && in_belt.values().all(|count| *count == all)).then_some(rest)
}
