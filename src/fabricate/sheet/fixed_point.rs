//! Coordinates as files hold them: whole ten-thousandths of a millimetre.

use fretwork_geometry::{Point, STEPS_PER_MM};

/// Ten-thousandths of a millimetre.
pub type Cell = (i64, i64);

/// The nearest cell to `p`, a point in units of `unit_mm` millimetres.
pub fn cell(p: Point, unit_mm: f64) -> Cell {
    (whole(p.x * unit_mm), whole(p.y * unit_mm))
}

/// The cells of a polyline, those that follow one another distinct.
pub fn cells(line: &[Point], unit_mm: f64) -> Vec<Cell> {
    let mut cells: Vec<Cell> = line.iter().map(|&p| cell(p, unit_mm)).collect();
    cells.dedup();
    cells
}

/// The polyline of cells.
pub fn points(cells: &[Cell], unit_mm: f64) -> Vec<Point> {
    cells.iter().map(|&c| point(c, unit_mm)).collect()
}

/// The point of a cell, which [`cell`] takes back to it.
pub fn point((x, y): Cell, unit_mm: f64) -> Point {
    Point::new(
        x as f64 / STEPS_PER_MM / unit_mm,
        y as f64 / STEPS_PER_MM / unit_mm,
    )
}

/// Millimetres in ten-thousandths.
pub fn whole(mm: f64) -> i64 {
    (mm * STEPS_PER_MM).round() as i64
}

/// Appends the number of millimetres with no more digits than it has.
pub fn push(out: &mut String, whole: i64) {
    push_scaled(out, whole, 4);
}

/// Appends `whole`, the last `digits` digits of which stand behind the point, with no more digits
/// than it has.
pub fn push_scaled(out: &mut String, whole: i64, mut digits: usize) {
    use std::fmt::Write;
    let one = 10u64.pow(digits as u32);
    let (sign, size) = (if whole < 0 { "-" } else { "" }, whole.unsigned_abs());
    let (units, mut rest) = (size / one, size % one);
    let written = if rest == 0 {
        write!(out, "{sign}{units}")
    } else {
        while rest.is_multiple_of(10) {
            rest /= 10;
            digits -= 1;
        }
        write!(out, "{sign}{units}.{rest:0digits$}")
    };
    written.expect("a string takes all that is written");
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(mm: f64) -> String {
        let mut out = String::new();
        push(&mut out, whole(mm));
        out
    }

    #[test]
    fn numbers_are_as_short_as_they_can_be() {
        let cases = [
            (0.0, "0"),
            (-0.0, "0"),
            (-0.00004, "0"),
            (1.5, "1.5"),
            (-0.0001, "-0.0001"),
            (0.1 + 0.2, "0.3"),
            (100.0, "100"),
            (2.00049, "2.0005"),
            (-12.034, "-12.034"),
            (1e12, "1000000000000"),
        ];
        for (mm, text) in cases {
            assert_eq!(shown(mm), text);
        }
    }

    #[test]
    fn cells_come_back() {
        for n in [-123_456_789_i64, -1, 0, 7, 10_000, 999_999_999_999] {
            for unit_mm in [1.0, 25.4, 10.0, 1000.0, 0.1] {
                assert_eq!(cell(point((n, -n), unit_mm), unit_mm), (n, -n));
            }
        }
    }
}
