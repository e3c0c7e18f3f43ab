//! Families of parallel lines that repeat, and the lattice of moves after which all of several families are the same.
//!
//! A move v keeps the lines with unit normal n that repeat after a width c when n·v/c is whole. So a family is the vector
//! g = n/c, and the moves that keep several are those whose products with the lattice that the vectors g generate are
//! whole: they are the lattice dual to it. It exists when every g is a rational combination of two of them.

use crate::tiled::lattice::Lattice;
use fretwork_geometry::Point;
use fretwork_geometry::numeric::lcm;

/// Parallel lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Family {
    /// The unit vector across the lines.
    pub normal: Point,
    /// The width after which they repeat.
    pub width: f64,
}

/// What keeps several families.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Common {
    /// No family: any move.
    All,
    /// Parallel families: any move along the lines, and multiples of the width across them.
    Lines(Family),
    /// A lattice of moves.
    Lattice(Lattice),
}

/// Denominators of ratios are not above this (rule E2).
const DENOMINATOR: u64 = 64;
/// Ratios are rational when they are as near to a fraction as this.
const NEAR: f64 = 1e-9;

/// What keeps all `families`. None when no move but zero does.
pub(crate) fn common(families: &[Family]) -> Option<Common> {
    let mut known: Vec<Family> = Vec::new();
    for family in families {
        known = match known[..] {
            [] => vec![*family],
            [one] => with_one(one, *family)?,
            [a, b] => with_two([a, b], *family)?,
            _ => return None,
        };
    }
    match known[..] {
        [] => Some(Common::All),
        [one] => Some(Common::Lines(one)),
        [a, b] => {
            // Along the lines of one family, as far as the other needs to repeat.
            let (along_b, along_a) = (-b.normal.left(), -a.normal.left());
            let v = along_b * (a.width / a.normal.dot(along_b));
            let w = along_a * (b.width / b.normal.dot(along_a));
            let lattice = Lattice::of([v, w])?;
            let is_plain = families.len() == 2;
            Some(Common::Lattice(if is_plain {
                lattice
            } else {
                lattice.reduced()
            }))
        }
        _ => None,
    }
}

/// A vector as a family.
fn family(g: Point) -> Family {
    let length = g.length();
    Family {
        normal: g * (1.0 / length),
        width: 1.0 / length,
    }
}

fn vector(family: Family) -> Point {
    family.normal * (1.0 / family.width)
}

/// Generators of what one family and another generate.
fn with_one(one: Family, other: Family) -> Option<Vec<Family>> {
    let turn = one.normal.cross(other.normal);
    if turn.abs() > 1e-9 {
        return Some(vec![one, other]);
    }
    let ratio = one.width / other.width * one.normal.dot(other.normal);
    let (_, q) = fraction(ratio)?;
    // The vectors g and p/q g generate g/q, whose lines are q times as far apart.
    Some(vec![Family {
        width: one.width * q as f64,
        ..one
    }])
}

/// Generators of what two families that cross and another one generate.
fn with_two(two: [Family; 2], other: Family) -> Option<Vec<Family>> {
    let ([a, b], g) = (two.map(vector), vector(other));
    let area = a.cross(b);
    let (x, y) = (fraction(g.cross(b) / area)?, fraction(a.cross(g) / area)?);
    let d = lcm(x.1, y.1)? as i64;
    if d == 1 {
        return Some(two.to_vec());
    }
    let row = [x.0 * (d / x.1 as i64), y.0 * (d / y.1 as i64)];
    let [p, q] = generators([[d, 0], [0, d], row]);
    let combined = |[i, j]: [i64; 2]| (a * i as f64 + b * j as f64) * (1.0 / d as f64);
    Some(vec![family(combined(p)), family(combined(q))])
}

/// Two rows that generate what three rows do, by Euclid's algorithm on the first column and then on the second.
fn generators(mut rows: [[i64; 2]; 3]) -> [[i64; 2]; 2] {
    loop {
        rows.sort_by_key(|row| (row[0] == 0, row[0].abs()));
        let [first, second, _] = rows;
        if second[0] == 0 {
            break;
        }
        let turns = second[0].div_euclid(first[0]);
        rows[1] = [second[0] - turns * first[0], second[1] - turns * first[1]];
    }
    let [first, mut second, mut third] = rows.map(|row| row);
    while third[1] != 0 {
        (second, third) = (third, [0, second[1].rem_euclid(third[1])]);
    }
    [first, second]
}

/// The fraction with the least denominator that is near `x`, by continued fractions. None when there is none with a
/// denominator of 64 or less.
fn fraction(x: f64) -> Option<(i64, u64)> {
    if !(x.is_finite() && x.abs() < 1e12) {
        return None;
    }
    (1..=DENOMINATOR).find_map(|q| {
        let p = libm::round(x * q as f64);
        ((x - p / q as f64).abs() <= NEAR * x.abs().max(1.0)).then_some((p as i64, q))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(angle: f64, width: f64) -> Family {
        Family {
            normal: Point::unit(angle.to_radians()).left(),
            width,
        }
    }

    fn periods(families: &[Family]) -> [Point; 2] {
        match common(families) {
            Some(Common::Lattice(lattice)) => lattice.periods,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_grid_repeats_along_its_own_lines() {
        let [v, w] = periods(&[lines(0.0, 10.0), lines(90.0, 20.0)]);
        assert!(v.distance(Point::new(0.0, 10.0)) < 1e-12, "{v:?}");
        assert!(w.distance(Point::new(-20.0, 0.0)) < 1e-12, "{w:?}");
    }

    #[test]
    fn every_common_move_keeps_all_families_and_no_shorter_one_does() {
        let families = [
            lines(0.0, 10.0),
            lines(90.0, 20.0),
            lines(0.0, 4.0),
            lines(90.0, 15.0),
        ];
        let [v, w] = periods(&families);
        assert!((v.cross(w).abs() - 20.0 * 60.0).abs() < 1e-9, "{v:?} {w:?}");
        for family in families {
            for period in [v, w] {
                let turns = family.normal.dot(period) / family.width;
                assert!((turns - turns.round()).abs() < 1e-9);
            }
        }
        let diagonal = [
            lines(0.0, 10.0),
            lines(90.0, 10.0),
            lines(45.0, 10.0 / 2f64.sqrt()),
        ];
        let [v, w] = periods(&diagonal);
        assert!((v.cross(w).abs() - 100.0).abs() < 1e-9);
    }

    #[test]
    fn parallel_lines_have_a_common_width_or_none() {
        let both = common(&[lines(0.0, 6.0), lines(180.0, 4.0)]);
        assert!(matches!(both, Some(Common::Lines(f)) if (f.width - 12.0).abs() < 1e-9));
        assert_eq!(common(&[lines(0.0, 1.0), lines(0.0, 2f64.sqrt())]), None);
        let turned = [lines(0.0, 1.0), lines(90.0, 1.0), lines(45.0, 1.0)];
        assert_eq!(common(&turned), None);
    }
}
