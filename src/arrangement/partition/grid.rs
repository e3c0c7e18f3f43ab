//! Grids: a region cut by two families of parallel lines (Loi 2015, section 3.3; rules R5,
//! R7 and R8).

use std::ops::RangeInclusive;

use crate::border::Border;
use crate::error::ArrangementError;
use crate::limit::{CELL, LIMIT, NEGLIGIBLE};
use crate::partition::boundary::{Cutting, add_contour};
use crate::partition::coverage::{Row, Wanted, covered};
use crate::partition::lines::{Lines, Piece};
use crate::partition::period::check_period;
use crate::partition::properties::StripesProperties;
use fretwork_geometry::budget;
use fretwork_geometry::{Bounds, CurveLabels, Curves, LabelSet, Point, Region};

/// The cells that the lines of `across` and `along` cut out of the plane, as `border` says at the
/// border of `region`. Cell (i, j) has the labels of stripe i of `across` and stripe j of `along`;
/// every side of a cell is a curve of its own with the label of its line, oriented along it. Both
/// families are anchored at the lower-left corner of the region's box.
///
/// Time and memory grow with the border and the cells that are made, of which there are at most
/// ten million.
pub fn grid(
    across: &StripesProperties,
    along: &StripesProperties,
    border: Border,
    region: &Region,
    resolution: f64,
) -> Result<Curves, ArrangementError> {
    grid_in([across, along], border, (region, resolution), None)
}

/// The same without curves that do not come into a room, and perhaps some more; all where there is none. Time grows with the
/// cells in the room and with those along the border of the region.
///
/// # Errors
/// Those of [`grid`].
pub(crate) fn grid_in(
    [across, along]: [&StripesProperties; 2],
    border: Border,
    (region, resolution): (&Region, f64),
    room: Option<&Bounds>,
) -> Result<Curves, ArrangementError> {
    let corner = region.page().min;
    let (a, b) = (
        Lines::new(across, across.anchor.unwrap_or(corner), resolution)?,
        Lines::new(along, along.anchor.unwrap_or(corner), resolution)?,
    );
    let turn = a.direction.cross(b.direction);
    if turn.abs() < 1e-9 {
        return Err(ArrangementError::Parallel(across.angle, along.angle));
    }
    if region.bounds().is_empty() {
        return Ok(Curves::new());
    }
    for (lines, properties) in [(&a, across), (&b, along)] {
        lines.check_extent(region.area.iter().flat_map(|p| p.outer.iter().copied()))?;
        lines.check_extent(region.contour.points().iter().copied())?;
        check_period(properties, region)?;
    }
    let grid = Grid {
        faces: FaceLabels::new(&a, &b),
        lines: [a.through(room), b.through(room)],
        a,
        b,
        turn,
    };
    match border {
        Border::Crop => grid.cropped(region, resolution),
        Border::CropAddBoundary => {
            let mut curves = grid.cropped(region, resolution)?;
            let label = |[i, j]: [i64; 2]| grid.faces.of(i, j);
            let cutting = Cutting {
                tolerance: resolution,
                room,
            };
            let families = [&grid.a, &grid.b];
            add_contour(&region.contour, &families, label, cutting, &mut curves);
            Ok(curves)
        }
        Border::KeepInside => grid.kept(region, |covered, whole| {
            whole - covered <= NEGLIGIBLE * whole
        }),
        Border::KeepOutside => grid.kept(region, |covered, whole| covered > NEGLIGIBLE * whole),
    }
}

struct Grid<'a> {
    a: Lines<'a>,
    b: Lines<'a>,
    /// The sine of the angle from the lines of `a` to those of `b`.
    turn: f64,
    faces: FaceLabels,
    /// The lines of both families that are wanted, with one more on either side.
    lines: [RangeInclusive<i64>; 2],
}

/// The labels of cells; they repeat after the cycles of both families.
struct FaceLabels {
    cycles: [i64; 2],
    table: Vec<LabelSet>,
}

impl FaceLabels {
    fn new(a: &Lines, b: &Lines) -> FaceLabels {
        let cycles = [a.face_cycle() as i64, b.face_cycle() as i64];
        let table = (0..cycles[0] * cycles[1])
            .map(|n| {
                a.face_label(n / cycles[1])
                    .union(b.face_label(n % cycles[1]))
            })
            .collect();
        FaceLabels { cycles, table }
    }

    fn of(&self, i: i64, j: i64) -> LabelSet {
        self.table[(i.rem_euclid(self.cycles[0]) * self.cycles[1] + j.rem_euclid(self.cycles[1]))
            as usize]
    }
}

impl Grid<'_> {
    /// Where line `i` of the first family crosses line `j` of the second.
    fn vertex(&self, i: i64, j: i64) -> Point {
        let (from_a, from_b) = (self.a.offset(i), self.b.offset(j));
        // The normal of b along the direction of a is minus the sine of the angle between them.
        let t = (from_b - from_a * self.a.normal.dot(self.b.normal)) / -self.turn;
        self.a.anchor + self.a.direction * t + self.a.normal * from_a
    }

    /// Labels of the side between cells `left` and `right` on a line labelled `edge`.
    fn labels(
        &self,
        edge: LabelSet,
        left: Option<[i64; 2]>,
        right: Option<[i64; 2]>,
    ) -> CurveLabels {
        let face =
            |cell: Option<[i64; 2]>| cell.map_or(LabelSet::EMPTY, |[i, j]| self.faces.of(i, j));
        CurveLabels {
            left: face(left),
            right: face(right),
            ..CurveLabels::edge(edge)
        }
    }

    /// The lines inside the region, cut at every crossing.
    fn cropped(&self, region: &Region, resolution: f64) -> Result<Curves, ArrangementError> {
        let mut curves = Curves::new();
        let [in_a, in_b] = &self.lines;
        let (of_a, of_b) = (
            self.a.clip(region, resolution, in_a)?,
            self.b.clip(region, resolution, in_b)?,
        );
        check_count(&of_a, (&self.b, in_b))?;
        check_count(&of_b, (&self.a, in_a))?;
        for piece in of_a {
            let i = piece.line;
            let edge = self.a.edge_label(i);
            cut(
                piece.from,
                piece.to,
                (&self.b, in_b),
                |j| self.vertex(i, j),
                |p, q, j| {
                    curves.push([p, q], self.labels(edge, Some([i, j]), Some([i - 1, j])));
                },
            );
        }
        for piece in of_b {
            let j = piece.line;
            let edge = self.b.edge_label(j);
            cut(
                piece.from,
                piece.to,
                (&self.a, in_a),
                |i| self.vertex(i, j),
                |p, q, i| {
                    curves.push([p, q], self.labels(edge, Some([i, j]), Some([i, j - 1])));
                },
            );
        }
        Ok(curves)
    }

    /// The sides of the cells for which `keep(covered area, whole area)` holds, as far as they are wanted. Cells beyond those
    /// that are wanted may lack neighbours; no side of a wanted one does.
    fn kept(
        &self,
        region: &Region,
        keep: impl Fn(f64, f64) -> bool,
    ) -> Result<Curves, ArrangementError> {
        let [columns, rows] = &self.lines;
        let wanted = Wanted { columns, rows };
        Ok(self.sides(&covered(region, [&self.a, &self.b], wanted, keep)?))
    }

    /// The sides of the kept cells, each once, row by row.
    fn sides(&self, rows: &[Row]) -> Curves {
        let mut curves = Curves::new();
        let mut below: Option<&Row> = None;
        for row in rows {
            if let Some(gap) = below.filter(|b| b.row + 1 != row.row) {
                self.row_line(gap.row + 1, &gap.runs, &[], &mut curves);
                below = None;
            }
            self.row_line(
                row.row,
                below.map_or(&[], |b| &b.runs),
                &row.runs,
                &mut curves,
            );
            self.column_sides(row, &mut curves);
            below = Some(row);
        }
        if let Some(last) = below {
            self.row_line(last.row + 1, &last.runs, &[], &mut curves);
        }
        curves
    }

    /// The sides on line `j` of the second family, between the kept cells of the rows beside it.
    fn row_line(&self, j: i64, below: &[(i64, i64)], above: &[(i64, i64)], curves: &mut Curves) {
        let edge = self.b.edge_label(j);
        let mut ends = [self.vertex(0, j); 2];
        let mut reached = i64::MIN;
        for_each_of(below, above, |i, is_below, is_above| {
            ends = [
                if reached == i {
                    ends[1]
                } else {
                    self.vertex(i, j)
                },
                self.vertex(i + 1, j),
            ];
            reached = i + 1;
            let labels = self.labels(
                edge,
                is_above.then_some([i, j]),
                is_below.then_some([i, j - 1]),
            );
            // Lines of the second family meet those of the first in ascending order when they turn left of them.
            curves.push(
                if self.turn > 0.0 {
                    ends
                } else {
                    [ends[1], ends[0]]
                },
                labels,
            );
        });
    }

    /// The sides on lines of the first family beside the kept cells of `row`.
    fn column_sides(&self, row: &Row, curves: &mut Curves) {
        let j = row.row;
        for &(from, to) in &row.runs {
            for i in from..=to {
                let ends = [self.vertex(i, j), self.vertex(i, j + 1)];
                let (left, right) = ((i < to).then_some([i, j]), (i > from).then_some([i - 1, j]));
                let labels = self.labels(self.a.edge_label(i), left, right);
                curves.push(
                    if self.turn < 0.0 {
                        ends
                    } else {
                        [ends[1], ends[0]]
                    },
                    labels,
                );
            }
        }
    }
}

/// Calls `emit(from, to, stripe)` for the parts of the segment in each stripe of `lines`, in order;
/// `vertex` gives its crossing with a line.
fn cut(
    from: Point,
    to: Point,
    (lines, wanted): (&Lines, &RangeInclusive<i64>),
    vertex: impl Fn(i64) -> Point,
    mut emit: impl FnMut(Point, Point, i64),
) {
    let (first, end) = (
        lines.stripe(lines.distance(from)),
        lines.stripe(lines.distance(to)),
    );
    let (step, ahead) = if first <= end { (1, 1) } else { (-1, 0) };
    let Some([mut stripe, last]) = stripes_among([first, end], wanted) else {
        return;
    };
    let mut start = if stripe == first {
        from
    } else {
        vertex(stripe + 1 - ahead)
    };
    loop {
        let at = if stripe == end {
            to
        } else {
            vertex(stripe + ahead)
        };
        if start != at {
            emit(start, at, stripe);
        }
        if stripe == last {
            return;
        }
        (start, stripe) = (at, stripe + step);
    }
}

/// The first and the last of the stripes on the way from one to another that are wanted.
fn stripes_among([first, last]: [i64; 2], wanted: &RangeInclusive<i64>) -> Option<[i64; 2]> {
    let (low, high) = (first.min(last), first.max(last));
    let (low, high) = (low.max(*wanted.start()), high.min(*wanted.end()));
    let way = if first <= last {
        [low, high]
    } else {
        [high, low]
    };
    (low <= high).then_some(way)
}

/// Calls `visit(i, in first, in second)` for every i in one of two ascending lists of ranges.
fn for_each_of(
    first: &[(i64, i64)],
    second: &[(i64, i64)],
    mut visit: impl FnMut(i64, bool, bool),
) {
    let (mut x, mut y) = (first.iter().peekable(), second.iter().peekable());
    let mut i = i64::MIN;
    loop {
        while x.next_if(|run| run.1 <= i).is_some() {}
        while y.next_if(|run| run.1 <= i).is_some() {}
        let next = [x.peek(), y.peek()].map(|run| run.map(|run| run.0.max(i)));
        let Some(n) = next.into_iter().flatten().min() else {
            return;
        };
        visit(n, next[0] == Some(n), next[1] == Some(n));
        i = n + 1;
    }
}

/// Fails when `lines` cut `pieces` into more than [`LIMIT`] parts.
fn check_count(
    pieces: &[Piece],
    (lines, wanted): (&Lines, &RangeInclusive<i64>),
) -> Result<(), ArrangementError> {
    let stripe = |p: Point| lines.stripe(lines.distance(p));
    let parts = |piece: &Piece| {
        let way = stripes_among([stripe(piece.from), stripe(piece.to)], wanted);
        way.map_or(0, |[first, last]| 1 + (last - first).abs())
    };
    let count: i64 = pieces.iter().map(parts).sum();
    if count > LIMIT as i64 {
        return Err(ArrangementError::TooMany {
            what: "cells of a grid",
            count: count as f64,
        });
    }
    budget::make("cells of a grid", count.unsigned_abs() as usize, CELL);
    Ok(())
}

#[cfg(test)]
mod tests;
