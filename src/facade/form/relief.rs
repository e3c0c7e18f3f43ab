//! Facades as solids to be made: everything stands on a back.

use std::ops::Range;

use super::bend::Bend;
use super::error::{FormError, MOST_RECTANGLES};
use super::moulding;
use super::ridge::ridges;
use super::run::{is_ring, runs};
use super::scene::in_facade;
use super::terrace::{Patch, PatchHeight, Terrace};
use fretwork_geometry::mesh::{Body, Mesh, Model};
use fretwork_geometry::{Affine3, Facade, FacadeBody, FacadeCell, FacadeShape, Point3, Polygon};

/// How deep meshes are sunk into what is below them, as a part of the back's thickness. Bodies that only
/// touch would stay two when they are united; sunk deeper, a thin mesh would visibly lose height.
const SUNK: f64 = 0.05;
/// Lines that are nearer than this part of the side are one: they differ by rounding only.
const SAME_LINE: f64 = 1e-7;

/// The solid of a facade, flat on its back and seen from above, or along its curve. Boxes and planes with
/// their lines make one body on a back, which is `plate` thick behind the deepest shape. Meshes must be
/// closed; each is a body of its own. Where no shape stands, the back lies in the facade's plane.
///
/// # Errors
/// The curve does not fit, a mesh is open, or the facade has too many rectangles.
pub fn relief(facade: &Facade, plate: f64) -> Result<Model, FormError> {
    let areas = facade.visible_areas()?;
    if areas.iter().all(Vec::is_empty) {
        return Err(FormError::Empty);
    }
    let bend = Bend::of(facade, Bend::lying(), plate)?;
    let mut ground = Ground::new(facade, &bend, &areas)?;
    ground.add_ridges(&areas)?;
    let lowest = ground.lowest().min(0.0);
    ground.terrace.base = lowest - plate;
    let highest = ground.terrace.heights.iter().copied().fold(0.0, f64::max);
    let width = [0.0, facade.layout.width];
    bend.check(width, ground.terrace.base)?;
    bend.check(width, highest)?;
    let terrace = bend.moved(Body::plain(ground.terrace.solid()?));
    let mut model = Model::of("facade", terrace.mesh);
    let runs = runs(facade, &areas);
    let sunk = Affine3::translation(Point3::new(0.0, 0.0, -SUNK * plate));
    for (number, cell) in facade.layout.cells.iter().enumerate() {
        let Some(shape) = facade.shape(number).filter(|_| !areas[number].is_empty()) else {
            continue;
        };
        let layer = &facade.layout.layers[cell.layer as usize];
        let name = format!("{layer} {}{}", cell.symbol_x, cell.symbol_y);
        match &shape.body {
            FacadeBody::Mesh(own) => {
                let place = in_facade(shape, cell).then(&sunk);
                for part in &own.parts {
                    let mesh = closed(shape, own.mesh(part))?;
                    let body = bend.bent(Body::plain(mesh.transformed(&place)))?;
                    model.push(&*name, body.mesh);
                }
            }
            FacadeBody::Moulding(moulding) => {
                let Some(run) = runs.get(&number) else {
                    continue;
                };
                let is_ring = is_ring(facade, &bend, run);
                let columns = bend.columns(run);
                let mesh = moulding::body(shape, moulding, run, &columns, is_ring)?;
                let body = bend.bent(Body::plain(mesh.transformed(&sunk)))?;
                model.push(&*name, closed(shape, body.mesh)?);
            }
            FacadeBody::Plane | FacadeBody::Box { .. } => {}
        }
    }
    Ok(model)
}

/// The mesh of a shape, if it is closed: with the corners in one place joined, or else as it is, where bodies that touch
/// along an edge have corners of their own.
fn closed(shape: &FacadeShape, mesh: Mesh) -> Result<Mesh, FormError> {
    let welded = mesh.welded();
    match welded.check_closed() {
        Ok(_) => Ok(welded),
        Err(_) if mesh.check_closed().is_ok() => Ok(mesh),
        Err(error) => Err(FormError::Mesh {
            shape: shape.name.to_string(),
            error,
        }),
    }
}

/// The heights over the canvas, and the number of the cell that each belongs to.
struct Ground<'a> {
    facade: &'a Facade,
    terrace: Terrace,
    owner: Vec<Option<u32>>,
}

impl Ground<'_> {
    fn new<'a>(
        facade: &'a Facade,
        bend: &Bend,
        areas: &[Vec<Polygon>],
    ) -> Result<Ground<'a>, FormError> {
        let layout = &facade.layout;
        let seen = || {
            layout
                .cells
                .iter()
                .zip(areas)
                .filter(|(_, area)| !area.is_empty())
                .map(|(cell, _)| cell)
        };
        let mut x: Vec<f64> = seen().flat_map(|c| [c.x, c.x + c.width]).collect();
        x.extend(bend.cuts(0.0, layout.width));
        let x = lines(x, layout.width);
        let y = lines(
            seen().flat_map(|c| [c.y, c.y + c.height]).collect(),
            layout.height,
        );
        let count = (x.len() - 1) * (y.len() - 1);
        if count > MOST_RECTANGLES {
            return Err(FormError::TooFine(count));
        }
        let terrace = Terrace {
            x,
            y,
            heights: vec![0.0; count],
            is_around: bend.is_around(),
            ..Terrace::default()
        };
        let mut ground = Ground {
            facade,
            terrace,
            owner: vec![None; count],
        };
        for (number, cell) in layout.cells.iter().enumerate() {
            let Some(shape) = facade.shape(number).filter(|_| !areas[number].is_empty()) else {
                continue;
            };
            let (_, height) = shape.extent();
            let [columns, rows] = ground.within(cell);
            for row in rows {
                for at in columns
                    .clone()
                    .map(|column| row * (ground.terrace.x.len() - 1) + column)
                {
                    // Of shapes of one height, the one in the upper layer is visible.
                    if ground.owner[at].is_none() || ground.terrace.heights[at] <= height {
                        ground.terrace.heights[at] = height;
                        ground.owner[at] = Some(number as u32);
                    }
                }
            }
        }
        Ok(ground)
    }

    /// The columns and rows that a cell covers.
    fn within(&self, cell: &FacadeCell) -> [Range<usize>; 2] {
        let nearest = |lines: &[f64], at: f64| {
            let i = lines.partition_point(|line| *line < at);
            if i > 0 && (i == lines.len() || at - lines[i - 1] < lines[i] - at) {
                i - 1
            } else {
                i
            }
        };
        let (x, y) = (&self.terrace.x, &self.terrace.y);
        [
            nearest(x, cell.x)..nearest(x, cell.x + cell.width),
            nearest(y, cell.y)..nearest(y, cell.y + cell.height),
        ]
    }

    /// Adds the lines of fills, in the rectangles where their cell is the highest.
    fn add_ridges(&mut self, areas: &[Vec<Polygon>]) -> Result<(), FormError> {
        for number in self.facade.fills.keys().map(|number| *number as usize) {
            let cell = &self.facade.layout.cells[number];
            let (Some(shape), Some(area)) = (
                self.facade.shape(number),
                ridges(self.facade, number, &areas[number])?,
            ) else {
                continue;
            };
            let height = PatchHeight::Over(shape.relief.height);
            let within = self.owned(number, cell);
            self.terrace.patches.push(Patch {
                area,
                within,
                height,
            });
        }
        Ok(())
    }

    /// The runs of columns, row by row, in which a cell is the highest.
    fn owned(&self, number: usize, cell: &FacadeCell) -> Vec<[Range<usize>; 2]> {
        let [columns, rows] = self.within(cell);
        let mut runs = Vec::new();
        for row in rows {
            let owned =
                |c: &usize| self.owner[row * (self.terrace.x.len() - 1) + c] == Some(number as u32);
            let mut column = columns.start;
            while column < columns.end {
                let end = (column..columns.end)
                    .find(|c| !owned(c))
                    .unwrap_or(columns.end);
                if end > column {
                    runs.push([column..end, row..row + 1]);
                }
                column = end + 1;
            }
        }
        runs
    }

    /// The least height, with grooves in their rectangles.
    fn lowest(&self) -> f64 {
        let columns = self.terrace.x.len() - 1;
        let heights = |[xs, ys]: &[Range<usize>; 2]| {
            let all = ys.clone().flat_map(|row| {
                self.terrace.heights[row * columns + xs.start..row * columns + xs.end].iter()
            });
            all.copied().fold(f64::INFINITY, f64::min)
        };
        let whole = heights(&[0..columns, 0..self.terrace.y.len() - 1]);
        let patches = self
            .terrace
            .patches
            .iter()
            .filter_map(|patch| match patch.height {
                PatchHeight::Over(by) => Some(
                    patch
                        .within
                        .iter()
                        .map(heights)
                        .fold(f64::INFINITY, f64::min)
                        + by,
                ),
                PatchHeight::AtLeast(_) => None,
            });
        patches.fold(whole, f64::min)
    }
}

/// The lines of a grid from 0 to `side`, ascending; those that differ by rounding are one.
fn lines(mut all: Vec<f64>, side: f64) -> Vec<f64> {
    let slack = SAME_LINE * side;
    all.retain(|v| *v > slack && *v < side - slack);
    all.extend([0.0, side]);
    all.sort_by(f64::total_cmp);
    all.dedup_by(|b, a| *b - *a <= slack);
    all
}
