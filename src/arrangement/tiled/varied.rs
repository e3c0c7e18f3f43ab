//! A last, random mapper over a tiled arrangement (Loi 2015, section 4.2.4): it is called on a cell of the tile for every
//! copy of the cell. Its random values follow from the place of the copy, so that they are those of `map` (rule E5).

use std::sync::Arc;

use crate::function::Arrangement;
use crate::near::locality::reaching;
use crate::script::mapping::{Items, Reach, cells_of};
use crate::script::program::{Mapper, Task};
use crate::script::seeds::plain;
use crate::tiled::conversion::{Division, moves};
use crate::tiled::lattice::{TileNumber, around, tiles};
use crate::tiled::regularity::Irregular;
use crate::tiled::tile::{Tile, origin};
use crate::tiled::zone;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::planar_map::PlanarMap;
use fretwork_geometry::{Bounds, Curves, Point, Region};
use fretwork_script::values::{Cell, CellKind};
use fretwork_script::watch::Watch;

/// A mapper and what it is called on.
pub(crate) struct Varied {
    pub kind: CellKind,
    pub input: Arrangement,
    pub mapper: Mapper,
    /// Puts diagnostics of the mapper in their place.
    pub place: Arc<dyn Fn(&[Diagnostic]) -> Vec<Diagnostic> + Send + Sync>,
}

/// The cells of a tile.
pub(crate) struct VariedTile {
    /// The tile of the input, whose origin suits the places of the cells.
    pub tile: Tile,
    map: Arc<PlanarMap>,
    /// The cells that belong to tile (0, 0).
    pub cells: Vec<u32>,
    /// The box of these cells, grown by what a mapper promises not to reach beyond it: the diagonal of
    /// its box, or a length.
    pub hull: Bounds,
}

/// Where a cell of a kind is.
fn place(map: &PlanarMap, kind: CellKind, id: u32) -> Point {
    plain(Cell { kind, map: 0, id }).position(map)
}

impl VariedTile {
    fn watch(&self) -> Watch {
        Watch {
            allows_random: true,
            deep: self.tile.deep,
        }
    }
}

impl Varied {
    /// The tile on a page with this box.
    ///
    /// # Errors
    /// Why there is none.
    pub fn tile(&self, page: Bounds, resolution: f64) -> Result<VariedTile, Irregular> {
        let mut tile = Tile::of(&self.input, page, resolution)?;
        let map = PlanarMap::build(&tile.around, resolution)
            .map_err(|error| Irregular::new(error.to_string()))?;
        let patch = crate::patch::Patch {
            deep: tile.deep,
            room: tile.deep.grown(0.5 * tile.depth),
        };
        patch.check(&map).map_err(Irregular::new)?;
        let places: Vec<(u32, Point)> = cells_of(&map, self.kind)
            .map(|id| (id, place(&map, self.kind, id)))
            .collect();
        let deep = places.iter().map(|(_, p)| *p);
        let deep = deep.filter(|p| tile.deep.contains(*p));
        tile.origin = origin(&tile.lattice, page.min, deep);
        let of_tile = |k: TileNumber| {
            let own = places.iter();
            let own = own.filter(|(_, p)| tile.lattice.tile(*p, tile.origin) == k);
            own.map(|(id, _)| *id).collect::<Vec<u32>>()
        };
        let cells = of_tile([0, 0]);
        let others = [[-1, 0], [0, -1], [-1, -1]];
        if others.iter().any(|k| of_tile(*k).len() != cells.len()) {
            return Err(Irregular::new("what it draws differs from tile to tile"));
        }
        let boxes = cells.iter().map(|id| {
            let own = plain(Cell {
                kind: self.kind,
                map: 0,
                id: *id,
            });
            let bounds = own.bounds(&map);
            bounds.grown(match self.mapper.reach() {
                Reach::Length(length) => length,
                Reach::Any | Reach::Diagonal => bounds.min.distance(bounds.max),
            })
        });
        let hull = boxes.fold(Bounds::EMPTY, Bounds::union);
        let map = Arc::new(map);
        let varied = VariedTile {
            tile,
            map,
            cells,
            hull,
        };
        self.try_once(&varied, page, resolution)?;
        Ok(varied)
    }

    /// Calls the mapper on every cell of the tile: what it must not ask for shows at once.
    fn try_once(
        &self,
        varied: &VariedTile,
        page: Bounds,
        resolution: f64,
    ) -> Result<(), Irregular> {
        let region = Region {
            whole: Some(page),
            ..Region::of_area(Vec::new())
        };
        let task = Task {
            kind: self.kind,
            map: varied.map.clone(),
            items: Items::Some(varied.cells.clone()),
            watch: Some(varied.watch()),
            known: None,
        };
        let tried = self.mapper.map_cells(task, &region, resolution);
        match tried {
            Ok(_) => Ok(()),
            Err(errors) => Err(Irregular::refused(&(self.place)(&errors))),
        }
    }

    /// What the mapper gives for the cells of the tile at each of `to`.
    fn copies(
        &self,
        varied: &VariedTile,
        to: Vec<Point>,
        region: &Region,
        resolution: f64,
    ) -> Option<Curves> {
        if varied.cells.is_empty() {
            return Some(Curves::new());
        }
        let task = Task {
            kind: self.kind,
            map: varied.map.clone(),
            items: Items::Copies {
                cells: varied.cells.clone(),
                moves: to,
            },
            watch: Some(varied.watch()),
            known: None,
        };
        self.mapper.map_cells(task, region, resolution).ok()
    }

    /// Copies and what is drawn in the zone; see [`Arrangement::draw`].
    pub fn copied(&self, region: &Region, resolution: f64, least: f64) -> Option<Curves> {
        self.input.regularity().ok()?;
        let varied = self.tile(region.page(), resolution).ok()?;
        let division = Division::of(region, &varied.tile, varied.cells.len(), least)?;
        let copied = division.copied(None);
        let inner = division.beyond_belt(None);
        let belt = copied.tiles().filter(|k| !inner.contains(*k));
        let zone = Zone {
            region: &division.zone(),
            resolution,
        };
        let rest = self.rest(&varied, &zone, belt.collect(), |k| !copied.contains(k))?;
        let to = moves(&varied.tile, copied.tiles());
        let mut all = self.copies(&varied, to, region, resolution)?;
        all.append(&rest);
        Some(all)
    }

    /// What may have points in a window; see [`Arrangement::draw_in`].
    pub fn copied_in(
        &self,
        region: &Region,
        resolution: f64,
        window: &Bounds,
        least: f64,
    ) -> Option<Curves> {
        self.input.regularity().ok()?;
        let varied = self.tile(region.page(), resolution).ok()?;
        let tile = &varied.tile;
        let division = Division::of(region, tile, varied.cells.len(), least)?;
        let [from, to] = around(&tile.lattice, &varied.hull, window);
        let rows = Some([from[1], to[1]]);
        let copied = division.copied(rows);
        let here = tiles([from, to]).filter(|k| copied.contains(*k));
        let mut all = self.copies(&varied, moves(tile, here), region, resolution)?;
        if tiles([from, to]).any(|k| !copied.contains(k)) {
            let reach = varied.hull.width() + varied.hull.height();
            let drawn = window.grown(division.margin(reach));
            let near = zone::near(region, &drawn);
            let zone = Zone {
                region: &near,
                resolution,
            };
            let inner = division.beyond_belt(rows);
            let is_in_belt = |k: &TileNumber| copied.contains(*k) && !inner.contains(*k);
            let belt = tiles([from, to]).filter(is_in_belt).collect();
            let is_around = |k: TileNumber| {
                (0..2).all(|axis| from[axis] <= k[axis] && k[axis] <= to[axis])
                    && !copied.contains(k)
            };
            if !near.area.is_empty() {
                all.append(&self.rest(&varied, &zone, belt, is_around)?);
            }
        }
        Some(reaching(&all, window))
    }

    /// What the mapper gives in the zone for the cells in tiles that are `wanted`. None where the belt has other cells
    /// than copies of those of the tile.
    fn rest(
        &self,
        varied: &VariedTile,
        zone: &Zone<'_>,
        belt: Vec<TileNumber>,
        wanted: impl Fn(TileNumber) -> bool,
    ) -> Option<Curves> {
        let drawn = self.input.apply(zone.region, zone.resolution).ok()?;
        let map = Arc::new(PlanarMap::build(&drawn, zone.resolution).ok()?);
        let mut in_belt: std::collections::BTreeMap<TileNumber, usize> =
            belt.into_iter().map(|k| (k, 0)).collect();
        let mut cells = Vec::new();
        for id in cells_of(&map, self.kind) {
            let at = place(&map, self.kind, id);
            let k = varied.tile.lattice.tile(at, varied.tile.origin);
            if let Some(count) = in_belt.get_mut(&k) {
                *count += 1;
            }
            if wanted(k) {
                cells.push(id);
            }
        }
        if in_belt.values().any(|count| *count != varied.cells.len()) {
            return None;
        }
        let task = Task {
            kind: self.kind,
            map,
            items: Items::Some(cells),
            watch: None,
            known: None,
        };
        self.mapper
            .map_cells(task, zone.region, zone.resolution)
            .ok()
    }
}

/// Where the general engine draws.
struct Zone<'a> {
    region: &'a Region,
    resolution: f64,
}
