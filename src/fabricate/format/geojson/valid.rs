//! Areas as readers of Simple Features want them: rings that do not touch themselves, lie side by side or in one another,
//! and touch one another at single points.
//!
//! The face of a map that meets itself at a corner has one ring through that corner twice, a window cuts an area along a side
//! that another corner of it lies on, and rounding can lay a corner on a side that it was beside. Such areas are resolved
//! by even and odd. All others, nearly all, are left as they are: whether one is, is decided on the whole
//! numbers that the file holds, without rounding.

use std::cmp::Ordering;

use crate::sheet::fixed_point::Cell;
use fretwork_geometry::polygon::{self, AreaError};
use fretwork_geometry::{FillRule, Point, Ring};

/// A resolved area is rounded again, which can lay a corner on a side once more; so often that is resolved too.
const ROUNDS: usize = 4;

/// A side of a ring, from its lesser end to its greater one.
type Side = [Cell; 2];

/// The areas that these rings enclose by even and odd, each the outer ring and its holes, not closed. Rings that are
/// valid come back as they are.
///
/// # Errors
/// When what invalid rings enclose cannot be computed.
pub fn valid(rings: Vec<Vec<Cell>>) -> Result<Vec<Vec<Vec<Cell>>>, AreaError> {
    let mut areas = vec![rings];
    for _ in 0..ROUNDS {
        if areas.iter().all(|area| are_apart(area)) {
            break;
        }
        let mut resolved = Vec::new();
        for area in areas {
            match are_apart(&area) {
                true => resolved.push(area),
                false => resolved.extend(enclosed(&area)?),
            }
        }
        areas = resolved;
    }
    Ok(areas)
}

/// A ring without the repetition of its first cell. None if it has no area.
pub fn open(mut cells: Vec<Cell>) -> Option<Vec<Cell>> {
    while cells.len() > 1 && cells.first() == cells.last() {
        cells.pop();
    }
    (cells.len() > 2 && doubled_area(&cells) != 0).then_some(cells)
}

/// Twice the area of a ring, above 0 if it runs counter-clockwise.
pub fn doubled_area(cells: &[Cell]) -> i128 {
    let next = cells.iter().cycle().skip(1);
    let cross = |((ax, ay), (bx, by)): (&Cell, &Cell)| {
        i128::from(*ax) * i128::from(*by) - i128::from(*ay) * i128::from(*bx)
    };
    cells.iter().zip(next).map(cross).sum()
}

/// What rings enclose by even and odd, on the same numbers.
fn enclosed(rings: &[Vec<Cell>]) -> Result<Vec<Vec<Vec<Cell>>>, AreaError> {
    let Some(&(x0, y0)) = rings.iter().flatten().min() else {
        return Ok(Vec::new());
    };
    let point = |&(x, y): &Cell| Point::new((x - x0) as f64, (y - y0) as f64);
    let points: Vec<Ring> = rings
        .iter()
        .map(|r| r.iter().map(point).collect())
        .collect();
    let cell = |p: &Point| (p.x.round() as i64 + x0, p.y.round() as i64 + y0);
    let cells = |ring: &Ring| {
        let mut cells: Vec<Cell> = ring.iter().map(cell).collect();
        cells.dedup();
        open(cells)
    };
    let areas = polygon::fill(&points, FillRule::EvenOdd)?;
    let rings =
        |area: &polygon::Polygon| -> Vec<Vec<Cell>> { area.rings().filter_map(cells).collect() };
    Ok(areas
        .iter()
        .map(rings)
        .filter(|area| !area.is_empty())
        .collect())
}

/// Whether no ring comes to a corner twice, and no two sides meet but in a corner of both.
/// O(n log n) for n sides of which few lie beside one another.
fn are_apart(rings: &[Vec<Cell>]) -> bool {
    let mut sides: Vec<Side> = rings.iter().flat_map(|ring| sides(ring)).collect();
    sides.sort_unstable();
    let mut open: Vec<Side> = Vec::new();
    for side in sides {
        open.retain(|other| other[1].0 >= side[0].0);
        if open.iter().any(|other| !may_stand(*other, side)) {
            return false;
        }
        open.push(side);
    }
    rings.iter().all(|ring| {
        let mut corners = ring.clone();
        corners.sort_unstable();
        corners.windows(2).all(|pair| pair[0] != pair[1])
    })
}

fn sides(ring: &[Cell]) -> impl Iterator<Item = Side> {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(&a, &b)| [a.min(b), a.max(b)])
}

/// Whether two sides do not meet, or in one end of both alone.
fn may_stand([a, b]: Side, [c, d]: Side) -> bool {
    let ys = |p: Cell, q: Cell| (p.1.min(q.1), p.1.max(q.1));
    let ((low, high), (other_low, other_high)) = (ys(a, b), ys(c, d));
    if high < other_low || other_high < low || b.0 < c.0 || d.0 < a.0 {
        return true;
    }
    let (ca, cb) = (turn(c, d, a), turn(c, d, b));
    let (ac, ad) = (turn(a, b, c), turn(a, b, d));
    let shared = [a, b].iter().filter(|p| [c, d].contains(p)).count();
    match shared {
        0 => ca == cb && ca != Ordering::Equal || ac == ad && ac != Ordering::Equal,
        // From the shared corner the other ends lie in different directions.
        1 if ca == Ordering::Equal && cb == Ordering::Equal => a == d || b == c,
        1 => true,
        _ => false,
    }
}

/// On which side of the line from `a` to `b` a cell lies.
fn turn(a: Cell, b: Cell, p: Cell) -> Ordering {
    let difference = |p: Cell, q: Cell| (i128::from(p.0 - q.0), i128::from(p.1 - q.1));
    let ((ux, uy), (vx, vy)) = (difference(b, a), difference(p, a));
    (ux * vy - uy * vx).cmp(&0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Seed;

    fn area(areas: &[Vec<Vec<Cell>>]) -> i64 {
        let twice = |ring: &Vec<Cell>| -> i64 {
            let next = ring.iter().cycle().skip(1);
            let crosses = ring.iter().zip(next).map(|(a, b)| a.0 * b.1 - a.1 * b.0);
            crosses.sum::<i64>().abs()
        };
        let whole =
            |rings: &Vec<Vec<Cell>>| twice(&rings[0]) - rings[1..].iter().map(twice).sum::<i64>();
        areas.iter().map(whole).sum()
    }

    #[test]
    fn a_ring_through_a_corner_twice_is_an_outline_and_a_hole() {
        let pinched = vec![vec![
            (0, 0),
            (8, 0),
            (8, 8),
            (0, 8),
            (0, 4),
            (4, 2),
            (4, 6),
            (0, 4),
        ]];
        let found = valid(pinched).unwrap();
        assert_eq!((found.len(), found[0].len(), area(&found)), (1, 2, 2 * 56));
        let bow = vec![vec![(0, 0), (4, 4), (8, 0), (8, 8), (4, 4), (0, 8)]];
        let found = valid(bow).unwrap();
        assert_eq!((found.len(), area(&found)), (2, 2 * 32));
    }

    #[test]
    fn rings_may_touch_at_a_corner() {
        let rings = vec![
            vec![(0, 0), (9, 0), (9, 9), (0, 9)],
            vec![(0, 0), (2, 4), (4, 2)],
        ];
        assert_eq!(valid(rings.clone()).unwrap(), [rings]);
    }

    #[test]
    fn spikes_and_holes_on_a_side_are_resolved() {
        let spike = vec![vec![(0, 0), (9, 0), (5, 0), (5, 5), (0, 5)]];
        assert_eq!(area(&valid(spike).unwrap()), 50);
        let hole = vec![
            vec![(0, 0), (9, 0), (9, 9), (0, 9)],
            vec![(3, 0), (3, 4), (6, 4), (6, 0)],
        ];
        let found = valid(hole).unwrap();
        assert_eq!((found.len(), found[0].len(), area(&found)), (1, 1, 2 * 69));
    }

    #[test]
    fn valid_rings_come_back_as_they_are() {
        let rings = vec![
            vec![(0, 0), (9, 0), (9, 9), (5, 9), (0, 9)],
            vec![(1, 1), (1, 3), (3, 1)],
        ];
        assert_eq!(valid(rings.clone()).unwrap(), [rings]);
    }

    /// Every pair of sides, by rational arithmetic on their parameters.
    fn are_apart_slowly(rings: &[Vec<Cell>]) -> bool {
        let sides: Vec<Side> = rings.iter().flat_map(|ring| sides(ring)).collect();
        let on = |[a, b]: Side, p: Cell| {
            let cross = (b.0 - a.0) * (p.1 - a.1) - (b.1 - a.1) * (p.0 - a.0);
            let dot = (p.0 - a.0) * (p.0 - b.0) + (p.1 - a.1) * (p.1 - b.1);
            cross == 0 && dot <= 0
        };
        let crosses = |[a, b]: Side, [c, d]: Side| {
            let side = |a: Cell, b: Cell, p: Cell| {
                ((b.0 - a.0) * (p.1 - a.1) - (b.1 - a.1) * (p.0 - a.0)).signum()
            };
            side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0
        };
        let twice = |ring: &Vec<Cell>| {
            let again = |p: &Cell| ring.iter().filter(|q| *q == p).count() > 1;
            ring.iter().any(again)
        };
        let passed = |p: &Cell| sides.iter().any(|s| !s.contains(p) && on(*s, *p));
        let pairs = || (0..sides.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        let meet = |(i, j)| crosses(sides[i], sides[j]) || sides[i] == sides[j];
        !rings.iter().any(twice) && !rings.iter().flatten().any(passed) && !pairs().any(meet)
    }

    #[test]
    fn what_meets_is_found_as_by_all_pairs_and_resolved() {
        let mut invalid = 0;
        for round in 0..2000 {
            let seed = Seed::root(round);
            let at = |n: u64| seed.range(n, 0.0, 9.0) as i64;
            let ring = |from: u64, count: u64| -> Vec<Cell> {
                let mut cells: Vec<Cell> = (from..from + count)
                    .map(|n| (at(2 * n), at(2 * n + 1)))
                    .collect();
                cells.dedup();
                while cells.len() > 1 && cells.first() == cells.last() {
                    cells.pop();
                }
                cells
            };
            let rings = vec![ring(0, 3 + round % 4), ring(20, 3)];
            if rings.iter().any(|ring| ring.len() < 3) {
                continue;
            }
            assert_eq!(are_apart(&rings), are_apart_slowly(&rings), "{rings:?}");
            invalid += usize::from(!are_apart(&rings));
            // Rounded crossings may touch once more; on a finer lattice they hardly do.
            let fine = |ring: &Vec<Cell>| ring.iter().map(|&(x, y)| (x * 5040, y * 5040)).collect();
            for resolved in valid(rings.iter().map(fine).collect()).unwrap() {
                let touching = |rings: &[Vec<Cell>]| {
                    rings
                        .iter()
                        .all(|ring| are_apart(std::slice::from_ref(ring)))
                };
                assert!(touching(&resolved), "{rings:?}: {resolved:?}");
            }
        }
        assert!(invalid > 500);
    }
}
