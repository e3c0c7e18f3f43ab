//! A Poisson process of the plane that any window shows the same part of: the source of the sites
//! of irregular partitions.
//!
//! The process lives in the plane times the marks above 0 and has one point per unit of area and
//! mark. Where the density of candidates is D(x), those with a mark up to D(x) count: a Poisson
//! process of density D. Raising D anywhere adds candidates there and changes no other.
//!
//! Marks fall into levels, level k from 4^(k-1) to 4^k, and levels into slices. A level has its own
//! lattice of square cells, half as wide as those of the level before; how many candidates a cell
//! has in a slice, and where, is a hash of its place in the lattice, never of the window.

use rayon::prelude::*;

use crate::error::ArrangementError;
use crate::limit::LIMIT;
use crate::random::density::LocalDensity;
use fretwork_geometry::budget;
use fretwork_geometry::{Bounds, Point, Seed};

/// Marks below this many levels under D(x) are ignored at x, which loses a part of 4^-12 of all.
const DEPTH: i32 = 12;

/// A candidate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Candidate {
    /// Where it is.
    pub position: Point,
    /// Its mark.
    pub mark: f64,
    /// The density of sites there.
    pub density: f64,
    /// What it is known by in every window; the same one period further.
    pub key: Seed,
}

/// The process, thinned to the candidates of a density.
pub(crate) struct Candidates<'a> {
    /// Density of sites; candidates are `ratio` times as dense.
    pub density: &'a LocalDensity,
    /// Candidates per site.
    pub ratio: f64,
    /// Slices of a level.
    pub slices: u32,
    /// Side of the cells of level 0.
    pub side: f64,
    /// The root of all hashes.
    pub seed: Seed,
}

/// A cell of a level's lattice; the density is taken not to exceed `cap` in it.
#[derive(Clone, Copy)]
struct LatticeCell {
    i: i64,
    j: i64,
    cap: f64,
}

/// The lattice of one level.
#[derive(Clone, Copy)]
struct Lattice {
    side: Point,
    /// Cells in a period, if there is one.
    wrap: Option<[i64; 2]>,
}

/// The marks that are looked at together: one of the equal parts that a level is cut into.
#[derive(Clone, Copy)]
struct Slice {
    level: i32,
    /// Which part, from 0.
    number: u32,
    /// The lattice of the level.
    lattice: Lattice,
}

/// Bytes that a site takes until its cell is drawn, and steps that a candidate takes.
const SITE: usize = 2000;
const CANDIDATE: u64 = 10;

/// Who the candidates are for.
pub(crate) trait Visitor: Sync {
    /// Whether no candidate in `cell`, where no density exceeds `cap`, is of use any more.
    fn has_covered(&self, cell: &Bounds, cap: f64) -> bool;

    /// Whether a candidate of this density is of no use any more.
    fn refuses(&self, position: Point, density: f64) -> bool;

    /// Takes the next candidates, which are sorted by mark; earlier ones had lesser marks.
    fn take(&mut self, candidates: &[Candidate]) -> Result<(), ArrangementError>;
}

impl Candidates<'_> {
    /// Shows `visitor` all candidates of use in `window`, in ascending order of marks.
    pub fn visit(
        &self,
        window: &Bounds,
        visitor: &mut impl Visitor,
    ) -> Result<(), ArrangementError> {
        let mut level = level_of(self.density.floor() * self.ratio) - DEPTH;
        let mut lattice = self.lattice(level);
        let mut cells = self.cells(lattice, &[lattice.range(window)?], window, visitor)?;
        while !cells.is_empty() {
            for number in 0..self.slices {
                let candidates = self.slice(
                    Slice {
                        level,
                        number,
                        lattice,
                    },
                    &cells,
                    window,
                    visitor,
                )?;
                visitor.take(&candidates)?;
            }
            let finer = self.lattice(level + 1);
            let rising = cells
                .iter()
                .filter(|cell| cell.cap * self.ratio > mark_of(level));
            let children: Vec<_> = rising.map(|cell| lattice.children(cell, finer)).collect();
            cells = self.cells(finer, &children, window, visitor)?;
            (level, lattice) = (level + 1, finer);
        }
        Ok(())
    }

    /// The candidates of one slice of a level in `window`, sorted by mark.
    fn slice(
        &self,
        slice: Slice,
        cells: &[LatticeCell],
        window: &Bounds,
        visitor: &impl Visitor,
    ) -> Result<Vec<Candidate>, ArrangementError> {
        let Slice {
            level,
            number,
            lattice,
        } = slice;
        let height = 0.75 * mark_of(level) / f64::from(self.slices);
        let low = mark_of(level - 1) + height * f64::from(number);
        let counts = PoissonTable::new(lattice.side.x * lattice.side.y * height);
        let root = self.seed.number(level.into()).number(number.into());
        let chunk = |cells: &[LatticeCell]| -> Result<Vec<Candidate>, ArrangementError> {
            let mut found = Vec::new();
            for cell in cells.iter().filter(|cell| cell.cap * self.ratio > low) {
                let of_cell = lattice.key(root, cell);
                for n in 0..counts.draw(of_cell.unit(0)) {
                    let key = of_cell.number(n);
                    let mark = low + height * key.unit(2);
                    let position = lattice.place(cell, key.unit(0), key.unit(1));
                    if mark <= cell.cap * self.ratio && window.contains(position) {
                        let density = self.density.at(position)?.min(cell.cap);
                        let limit = density * self.ratio;
                        let counts = mark <= limit && mark > limit * mark_of(-DEPTH);
                        if counts && !visitor.refuses(position, density) {
                            found.push(Candidate {
                                position,
                                mark,
                                density,
                                key,
                            });
                        }
                    }
                }
            }
            Ok(found)
        };
        let chunks: Vec<Vec<Candidate>> = cells
            .par_chunks(4096)
            .map(chunk)
            .collect::<Result<_, _>>()?;
        let mut found = chunks.concat();
        found.par_sort_by(|a, b| {
            a.mark
                .total_cmp(&b.mark)
                .then(a.position.x.total_cmp(&b.position.x))
        });
        Ok(found)
    }

    fn lattice(&self, level: i32) -> Lattice {
        let side = self.side * libm::exp2(-f64::from(level));
        let Some(period) = self.density.period() else {
            return Lattice {
                side: Point::new(side, side),
                wrap: None,
            };
        };
        // The cells that fit the period a power of two times and are nearest in size.
        let fit = |period: f64| libm::exp2(libm::round(libm::log2(period / side)).max(0.0));
        let (nx, ny) = (fit(period.x), fit(period.y));
        Lattice {
            side: Point::new(period.x / nx, period.y / ny),
            wrap: Some([nx as i64, ny as i64]),
        }
    }

    /// The cells in boxes of indices that meet `window` and are of use, with their caps.
    fn cells(
        &self,
        lattice: Lattice,
        boxes: &[[[i64; 2]; 2]],
        window: &Bounds,
        visitor: &impl Visitor,
    ) -> Result<Vec<LatticeCell>, ArrangementError> {
        let chunk = |boxes: &[[[i64; 2]; 2]]| -> Result<Vec<LatticeCell>, ArrangementError> {
            let mut cells = Vec::new();
            for [low, high] in boxes {
                for (i, j) in
                    (low[0]..=high[0]).flat_map(|i| (low[1]..=high[1]).map(move |j| (i, j)))
                {
                    let mut cell = LatticeCell { i, j, cap: 0.0 };
                    let bounds = Bounds {
                        min: lattice.place(&cell, 0.0, 0.0),
                        max: lattice.place(&cell, 1.0, 1.0),
                    };
                    if bounds.intersects(window) {
                        cell.cap = self.density.cap(&bounds)?;
                        if !visitor.has_covered(&bounds, cell.cap) {
                            cells.push(cell);
                        }
                    }
                }
            }
            Ok(cells)
        };
        let chunks: Vec<Vec<LatticeCell>> = boxes
            .par_chunks(4096)
            .map(chunk)
            .collect::<Result<_, _>>()?;
        let cells = chunks.concat();
        self.check_count(&cells, lattice, window)?;
        Ok(cells)
    }
}

impl Candidates<'_> {
    /// Fails when there will be too many sites, or cells of a lattice. Caps of few cells say little of
    /// a field.
    fn check_count(
        &self,
        cells: &[LatticeCell],
        lattice: Lattice,
        window: &Bounds,
    ) -> Result<(), ArrangementError> {
        let overlap = |low: f64, side: f64, from: f64, to: f64| {
            ((low + side).min(to) - low.max(from)).max(0.0)
        };
        let sites = |cell: &LatticeCell| {
            let low = lattice.place(cell, 0.0, 0.0);
            let width = overlap(low.x, lattice.side.x, window.min.x, window.max.x);
            cell.cap * width * overlap(low.y, lattice.side.y, window.min.y, window.max.y)
        };
        let tells = self.density.is_constant() || cells.len() > 1000;
        let count = if tells {
            cells.iter().map(sites).sum()
        } else {
            0.0
        };
        if count > 2.0 * LIMIT as f64 || cells.len() > 8 * LIMIT {
            return Err(ArrangementError::TooMany {
                what: "cells",
                count: f64::max(count, cells.len() as f64),
            });
        }
        budget::make("cells", count as usize, SITE);
        budget::spend("cells", CANDIDATE * (count * self.ratio) as u64 / 2);
        Ok(())
    }
}

impl Lattice {
    /// The first and last indices of cells that meet `window`.
    fn range(&self, window: &Bounds) -> Result<[[i64; 2]; 2], ArrangementError> {
        let index = |p: Point| Point::new((p.x / self.side.x).floor(), (p.y / self.side.y).floor());
        let (low, high) = (index(window.min), index(window.max));
        let count = (high.x - low.x + 1.0) * (high.y - low.y + 1.0);
        if count.is_nan() || count > LIMIT as f64 {
            return Err(ArrangementError::TooMany {
                what: "cells",
                count,
            });
        }
        // Beyond 2^40 cells from the origin too few bits are left for places in a cell.
        if [low, high]
            .iter()
            .any(|p| p.x.abs().max(p.y.abs()) > (1u64 << 40) as f64)
        {
            return Err(ArrangementError::Region);
        }
        Ok([[low.x as i64, low.y as i64], [high.x as i64, high.y as i64]])
    }

    /// The first and last indices of the cells of the next lattice in `cell`.
    fn children(&self, cell: &LatticeCell, finer: Lattice) -> [[i64; 2]; 2] {
        let split = |coarse: f64, fine: f64| if fine < 0.75 * coarse { 2 } else { 1 };
        let (x, y) = (
            split(self.side.x, finer.side.x),
            split(self.side.y, finer.side.y),
        );
        [
            [cell.i * x, cell.j * y],
            [cell.i * x + x - 1, cell.j * y + y - 1],
        ]
    }

    /// The point at parts `u` and `v` of the sides of `cell`.
    fn place(&self, cell: &LatticeCell, u: f64, v: f64) -> Point {
        Point::new(
            (cell.i as f64 + u) * self.side.x,
            (cell.j as f64 + v) * self.side.y,
        )
    }

    fn key(&self, root: Seed, cell: &LatticeCell) -> Seed {
        let [i, j] = match self.wrap {
            Some([nx, ny]) => [cell.i.rem_euclid(nx), cell.j.rem_euclid(ny)],
            None => [cell.i, cell.j],
        };
        root.number(i).number(j)
    }
}

/// The least level whose marks reach `mark`.
fn level_of(mark: f64) -> i32 {
    libm::ceil(libm::log2(mark) / 2.0) as i32
}

/// The greatest mark of a level.
fn mark_of(level: i32) -> f64 {
    libm::exp2(2.0 * f64::from(level))
}

/// Draws numbers that are Poisson distributed.
struct PoissonTable {
    /// The probability of at most n.
    cumulated: Vec<f64>,
}

impl PoissonTable {
    /// For a small `mean`, at most a few dozen.
    fn new(mean: f64) -> PoissonTable {
        let mut cumulated = Vec::new();
        let (mut term, mut sum) = (libm::exp(-mean), 0.0);
        while cumulated.len() < 400 && sum < 1.0 - 1e-15 {
            sum += term;
            cumulated.push(sum);
            term *= mean / cumulated.len() as f64;
        }
        PoissonTable { cumulated }
    }

    fn draw(&self, u: f64) -> i64 {
        self.cumulated.partition_point(|p| *p <= u) as i64
    }
}
