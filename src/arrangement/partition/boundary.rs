//! The contour of a region, cut where the lines of a partition meet it, so that cropped cells keep
//! the labels of the cells they come from even where the contour alone bounds them.

use crate::partition::lines::Lines;
use fretwork_geometry::{Bounds, Curve, CurveLabels, Curves, LabelSet, Point};

/// A cell of the families: its stripe in each (0 where there is only one family).
pub(crate) type GridCell = [i64; 2];

/// How exactly the contour is cut, and where.
#[derive(Clone, Copy)]
pub(crate) struct Cutting<'a> {
    /// Points nearer than this are one.
    pub tolerance: f64,
    /// Pieces that do not come into this box are left out, where there is one.
    pub room: Option<&'a Bounds>,
}

/// Adds `contour` to `out`, cut at every line of `families` that separates two cells along it. The
/// pieces keep edge labels, the ends vertex labels; the left side gets the label of the cell there.
pub(crate) fn add_contour(
    contour: &Curves,
    families: &[&Lines],
    label: impl Fn(GridCell) -> LabelSet,
    cutting: Cutting<'_>,
    out: &mut Curves,
) {
    for curve in contour.iter() {
        let mut cutter = ContourCutter {
            curve,
            points: vec![curve.points[0]],
            cell: None,
            first: true,
            label: &label,
            room: cutting.room,
            out,
        };
        for ends in curve.points.windows(2) {
            cutter.segment(ends[0], ends[1], families, cutting.tolerance);
        }
        cutter.flush(true);
    }
}

struct ContourCutter<'a, F> {
    curve: Curve<'a>,
    /// The piece being built.
    points: Vec<Point>,
    /// The cell on its left, once known.
    cell: Option<GridCell>,
    /// Whether it is the first of its curve.
    first: bool,
    label: &'a F,
    room: Option<&'a Bounds>,
    out: &'a mut Curves,
}

impl<F: Fn(GridCell) -> LabelSet> ContourCutter<'_, F> {
    fn segment(&mut self, a: Point, b: Point, families: &[&Lines], tolerance: f64) {
        let mut cuts: Vec<(f64, Point)> = Vec::new();
        for lines in families {
            let stripes = [a, b].map(|p| lines.stripe(lines.distance(p)));
            cuts.extend(Lines::between(stripes[0], stripes[1]).map(|k| lines.crossing(k, a, b)));
        }
        cuts.sort_by(|x, y| x.0.total_cmp(&y.0));
        cuts.push((1.0, b));
        let length = a.distance(b);
        // A contour that runs along a line has its cell on the left, not on both sides in turn.
        let inward = (b - a).left()
            * (if length > 0.0 {
                tolerance / length
            } else {
                0.0
            });
        let mut from = a;
        for &(_, to) in &cuts {
            if from.distance(to) > tolerance {
                let middle = from.lerp(to, 0.5) + inward;
                let mut cell = [0; 2];
                for (index, lines) in cell.iter_mut().zip(families) {
                    *index = lines.stripe(lines.distance(middle));
                }
                self.enter(cell, from);
            }
            from = to;
        }
        self.points.push(b);
    }

    /// Ends the piece at `at` where another cell begins.
    fn enter(&mut self, cell: GridCell, at: Point) {
        if self.cell.is_some_and(|current| current != cell) {
            if self.points.last() != Some(&at) {
                self.points.push(at);
            }
            self.flush(false);
            self.points.push(at);
        }
        self.cell = Some(cell);
    }

    fn flush(&mut self, last: bool) {
        let of_curve = self.curve.labels;
        let labels = CurveLabels {
            edge: of_curve.edge,
            left: self.cell.map_or(LabelSet::EMPTY, self.label),
            right: LabelSet::EMPTY,
            start: if self.first {
                of_curve.start
            } else {
                LabelSet::EMPTY
            },
            end: if last { of_curve.end } else { LabelSet::EMPTY },
        };
        let comes_into = |room: &Bounds| Bounds::of(self.points.iter().copied()).intersects(room);
        if self.room.is_none_or(comes_into) {
            self.out.push(self.points.drain(..), labels);
        }
        self.points.clear();
        self.first = false;
    }
}
