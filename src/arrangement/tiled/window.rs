//! What an arrangement draws in a window, in time and memory of the window (rules E6 and W3).

use std::sync::Arc;

use crate::function::{Applied, Arrangement};
use crate::near::locality::reaching;
use crate::tiled::conversion::{Division, LEAST, moves, rest};
use crate::tiled::lattice::{TileNumber, around, tiles};
use crate::tiled::tile::Tile;
use crate::tiled::zone;
use fretwork_geometry::{Bounds, Curves, Region};

impl Arrangement {
    /// The curves of [`Arrangement::draw`] that may have points in `window`, and perhaps others. What is repeated costs
    /// only the window; of the rest all is drawn.
    ///
    /// # Errors
    /// Those of [`Arrangement::apply`].
    pub fn draw_in(&self, region: &Region, resolution: f64, window: &Bounds) -> Applied {
        self.draw_in_copying(region, resolution, window, LEAST)
    }

    /// The same, copying where about so many curves would be copied on the whole region.
    pub(crate) fn draw_in_copying(
        &self,
        region: &Region,
        resolution: f64,
        window: &Bounds,
        least: f64,
    ) -> Applied {
        if let Some(parts) = self.parts() {
            let drawn = parts.iter();
            let drawn = drawn.map(|part| part.draw_in_copying(region, resolution, window, least));
            let drawn: Vec<Arc<Curves>> = drawn.collect::<Result<_, _>>()?;
            return Ok(Arc::new(Curves::concatenated(&drawn)));
        }
        let copied = match self.varied() {
            Some(varied) => varied.copied_in(region, resolution, window, least),
            None => self.copied_in(region, resolution, window, least),
        };
        match copied {
            Some(curves) => Ok(Arc::new(curves)),
            None => self.draw_copying(region, resolution, least),
        }
    }

    pub(crate) fn copied_in(
        &self,
        region: &Region,
        resolution: f64,
        window: &Bounds,
        least: f64,
    ) -> Option<Curves> {
        let tile = self.tile_on(region, resolution)?;
        let division = Division::of(region, &tile, tile.curves.len(), least)?;
        let [from, to] = around(&tile.lattice, &tile.hull, window);
        let rows = Some([from[1], to[1]]);
        let copied = division.copied(rows);
        let here = tiles([from, to]).filter(|k| copied.contains(*k));
        let copies = tile.curves.copies(&moves(&tile, here))?;
        let mut all = reaching(&copies, window);
        if tiles([from, to]).any(|k| !copied.contains(k)) {
            let reach = tile.hull.width() + tile.hull.height();
            let drawn = window.grown(division.margin(reach));
            let near = zone::near(region, &drawn);
            if !near.area.is_empty() {
                let zone = self.apply(&near, resolution).ok()?;
                let used = drawn.grown(-division.margin(0.0));
                all.append(&self.rest_in(&tile, &division, &zone, &used)?);
                all = reaching(&all, window);
            }
        }
        Some(all)
    }

    /// What of the zone belongs to tiles that are not copied and meet the box `used`. None where those in the belt differ.
    fn rest_in(
        &self,
        tile: &Tile,
        division: &Division<'_>,
        zone: &Curves,
        used: &Bounds,
    ) -> Option<Curves> {
        let is_used = |k: TileNumber| {
            let bounds = tile.lattice.bounds(k, k, tile.origin);
            bounds.intersects(used)
        };
        let zone = zone.filtered(|_, curve| is_used(tile.number(&curve)));
        let square = tile.lattice.bounds([0, 0], [0, 0], tile.origin);
        let [from, to] = around(&tile.lattice, &square, used);
        let rows = Some([from[1], to[1]]);
        let (copied, inner) = (division.copied(rows), division.beyond_belt(rows));
        let is_in_belt = |k: &TileNumber| is_used(*k) && copied.contains(*k) && !inner.contains(*k);
        rest(tile, &zone, &copied, tiles([from, to]).filter(is_in_belt))
    }
}
