//! How much of each cell of a grid a region covers, in time that grows with the border and the
//! cells kept, not with the box around them.
//!
//! In the distances from the two families of lines the cells are rectangles and areas keep their
//! ratios. Every piece of the border inside one cell adds the area to its right in that cell and
//! its height to all cells to the right of it in the row; sums along the rows give exact covers, as
//! in scan conversion with exact coverage.

use std::ops::RangeInclusive;

use crate::error::ArrangementError;
use crate::limit::{CELL, LIMIT};
use crate::partition::lines::Lines;
use fretwork_geometry::budget;
use fretwork_geometry::{Point, Region};

/// The kept cells of one row: columns `from..to`, ascending, not touching.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Row {
    /// The stripe of the second family.
    pub row: i64,
    /// Ranges of stripes of the first family.
    pub runs: Vec<(i64, i64)>,
}

/// All stripes.
const ALL: [i64; 2] = [i64::MIN, i64::MAX];

/// The stripes of both families whose cells are wanted.
#[derive(Clone, Copy)]
pub(crate) struct Wanted<'a> {
    /// Of the first family.
    pub columns: &'a RangeInclusive<i64>,
    /// Of the second.
    pub rows: &'a RangeInclusive<i64>,
}

/// A piece of the border in one cell: its height, and the area to its right in the cell.
struct Fragment {
    row: i64,
    column: i64,
    height: f64,
    area: f64,
}

/// The cells for which `keep(covered area, whole area)` holds, among those that `region` touches, by
/// rows. `columns` are the stripes of the first family, rows those of the second.
pub(crate) fn covered(
    region: &Region,
    [columns, rows]: [&Lines; 2],
    wanted: Wanted<'_>,
    keep: impl Fn(f64, f64) -> bool,
) -> Result<Vec<Row>, ArrangementError> {
    let mut fragments = Vec::new();
    for ring in region.area.iter().flat_map(|polygon| polygon.rings()) {
        let at = |p: &Point| Point::new(columns.distance(*p), rows.distance(*p));
        for (i, b) in ring.iter().enumerate() {
            let a = &ring[if i == 0 { ring.len() - 1 } else { i - 1 }];
            add_segment([at(a), at(b)], columns, (rows, wanted.rows), &mut fragments)?;
        }
    }
    // Stable, so that sums are taken in the order of the border.
    fragments.sort_by_key(|f| (f.row, f.column));
    // Area to the right of the border is positive where it climbs; around a region that is
    // counter-clockwise in these coordinates, that is the part to be taken away.
    let sense = if columns.normal.cross(rows.normal) > 0.0 {
        -1.0
    } else {
        1.0
    };
    let mut kept = Vec::new();
    let mut count = 0;
    for of_row in fragments.chunk_by(|a, b| a.row == b.row) {
        let mut runs = sweep(of_row, columns, rows, sense, &keep);
        let [first, end] = [
            *wanted.columns.start(),
            wanted.columns.end().saturating_add(1),
        ];
        runs.iter_mut()
            .for_each(|run| *run = (run.0.max(first), run.1.min(end)));
        runs.retain(|(from, to)| from < to);
        count += runs.iter().map(|(from, to)| to - from).sum::<i64>();
        if count > LIMIT as i64 {
            return Err(ArrangementError::TooMany {
                what: "cells of a grid",
                count: count as f64,
            });
        }
        budget::hold("cells of a grid", count as usize, CELL);
        if !runs.is_empty() {
            kept.push(Row {
                row: of_row[0].row,
                runs,
            });
        }
    }
    Ok(kept)
}

/// Cuts a segment at the rows, then at the columns.
fn add_segment(
    [a, b]: [Point; 2],
    columns: &Lines,
    (rows, wanted): (&Lines, &RangeInclusive<i64>),
    out: &mut Vec<Fragment>,
) -> Result<(), ArrangementError> {
    let wanted = [*wanted.start(), *wanted.end()];
    for (row, p, q) in split(a, b, (rows, wanted), |p| p.y) {
        if p.y == q.y {
            continue;
        }
        for (column, p, q) in split(p, q, (columns, ALL), |p| p.x) {
            let height = q.y - p.y;
            let area = height * (columns.offset(column + 1) - (p.x + q.x) / 2.0);
            out.push(Fragment {
                row,
                column,
                height,
                area,
            });
        }
        if out.len() > 4 * LIMIT {
            return Err(ArrangementError::TooMany {
                what: "cells along the border",
                count: out.len() as f64,
            });
        }
    }
    Ok(())
}

/// The parts of the segment from `a` to `b` in each stripe of `lines`, where `along` is the
/// coordinate that the lines are levels of.
fn split<'a>(
    a: Point,
    b: Point,
    (lines, wanted): (&'a Lines, [i64; 2]),
    along: impl Fn(Point) -> f64 + 'a,
) -> impl Iterator<Item = (i64, Point, Point)> + 'a {
    let (va, vb) = (along(a), along(b));
    let (first, last) = (lines.stripe(va), lines.stripe(vb));
    let step = if first <= last { 1 } else { -1 };
    let at = move |k: i64| a.lerp(b, ((lines.offset(k) - va) / (vb - va)).clamp(0.0, 1.0));
    let (low, high) = (first.min(last), first.max(last));
    let (low, high) = (low.max(wanted[0]), high.min(wanted[1]));
    let from = if step > 0 { low } else { high };
    (0..high.saturating_sub(low).saturating_add(1).max(0)).map(move |i| {
        let k = from + step * i;
        let (entry, exit) = if step > 0 { (k, k + 1) } else { (k + 1, k) };
        (
            k,
            if k == first { a } else { at(entry) },
            if k == last { b } else { at(exit) },
        )
    })
}

/// The runs of kept cells of one row; `fragments` are those of the row by column.
fn sweep(
    fragments: &[Fragment],
    columns: &Lines,
    rows: &Lines,
    sense: f64,
    keep: &impl Fn(f64, f64) -> bool,
) -> Vec<(i64, i64)> {
    let row = fragments[0].row;
    let height = rows.offset(row + 1) - rows.offset(row);
    let mut runs: Vec<(i64, i64)> = Vec::new();
    let mut add = |from: i64, to: i64| match runs.last_mut() {
        Some(last) if last.1 == from => last.1 = to,
        _ => runs.push((from, to)),
    };
    let mut crossed = 0.0;
    let mut cells = fragments.chunk_by(|a, b| a.column == b.column).peekable();
    while let Some(of_cell) = cells.next() {
        let column = of_cell[0].column;
        let width = columns.offset(column + 1) - columns.offset(column);
        let covered = crossed * width + of_cell.iter().map(|f| f.area).sum::<f64>();
        if keep(sense * covered, width * height) {
            add(column, column + 1);
        }
        crossed += of_cell.iter().map(|f| f.height).sum::<f64>();
        if let Some(next) = cells.peek()
            && next[0].column > column + 1
            && keep(sense * crossed, height)
        {
            add(column + 1, next[0].column);
        }
    }
    runs
}
