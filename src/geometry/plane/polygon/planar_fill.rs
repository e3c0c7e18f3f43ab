//! Fill rules and boolean operations by a planar map: winding numbers are carried from the unbounded face over the
//! edges, and the faces inside are put together again.
//!
//! It serves heaps of shapes that are too large for the sweep of the polygon library. There the library changes its
//! method, and on some heaps of 40,000 overlapping shapes it never ends. A planar map has no such limit; it takes
//! about as long and, beside the rounding of crossings, gives the same areas.

use super::{Polygon, Ring, of_faces};
use crate::planar_map::{PlanarMap, PlanarMapError};
use crate::{CurveLabels, Curves};

/// What the rings of two operands enclose, in any position; `inside` says for how often the first and the second operand
/// wind round a place whether it belongs to the result. Points nearer than `resolution`, a power of two, are one.
///
/// # Errors
/// See [`PlanarMap::build`].
pub(super) fn combine(
    operands: [&[Ring]; 2],
    resolution: f64,
    inside: impl Fn([i32; 2]) -> bool,
) -> Result<Vec<Polygon>, PlanarMapError> {
    let mut curves = Curves::new();
    for ring in operands.into_iter().flatten() {
        let closed = ring.iter().chain(ring.first()).copied();
        curves.push(closed, CurveLabels::default());
    }
    let map = PlanarMap::build(&curves, resolution)?;
    let mut windings = vec![None; map.face_count() + 1];
    windings[0] = Some([0; 2]);
    map.spread(&mut windings, |h, known: &[i32; 2]| {
        let mut beyond = *known;
        for (curve, turns) in map.passes(h.edge) {
            // A curve winds once more round what is on its left than round what is on its right.
            let operand = usize::from(curve as usize >= operands[0].len());
            beyond[operand] -= if h.reversed { -turns } else { turns };
        }
        Some(beyond)
    });
    let holds = |winding: &Option<[i32; 2]>| winding.is_some_and(&inside);
    Ok(of_faces(&map, |face| holds(&windings[face.0 as usize])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::{fill, intersect, subtract};
    use crate::{FillRule, Point, Seed};

    fn triangles(seed: Seed, count: u64) -> Vec<Ring> {
        let coordinate = |k: u64| seed.range(k, 0.0, 64.0).round();
        let triangle = |i: u64| {
            let corner = |k: u64| {
                let at = 6 * i + 2 * k;
                Point::new(coordinate(at), coordinate(at + 1))
            };
            vec![corner(0), corner(1), corner(2)]
        };
        (0..count).map(triangle).collect()
    }

    fn area(polygons: &[Polygon]) -> f64 {
        polygons.iter().map(Polygon::area).sum()
    }

    #[test]
    fn agrees_with_the_polygon_library() {
        for case in 0..40 {
            let seed = Seed::root(case);
            let rings = triangles(seed, 2 + case % 9);
            for rule in [FillRule::NonZero, FillRule::EvenOdd] {
                let holds = |[turns, _]: [i32; 2]| match rule {
                    FillRule::NonZero => turns != 0,
                    FillRule::EvenOdd => turns % 2 != 0,
                };
                let ours = combine([&rings, &[]], 2f64.powi(-30), holds).unwrap();
                let theirs = fill(&rings, rule).unwrap();
                assert!((area(&ours) - area(&theirs)).abs() < 1e-5, "case {case}");
            }
            let polygons = |rings: &[Ring]| fill(rings, FillRule::NonZero).unwrap();
            let (a, b) = rings.split_at(1);
            let both = combine([a, b], 2f64.powi(-30), |[a, b]| a != 0 && b != 0).unwrap();
            let theirs = intersect(&polygons(a), &polygons(b)).unwrap();
            assert!((area(&both) - area(&theirs)).abs() < 1e-5, "case {case}");
            let rest = combine([a, b], 2f64.powi(-30), |[a, b]| a != 0 && b == 0).unwrap();
            let theirs = subtract(&polygons(a), &polygons(b)).unwrap();
            assert!((area(&rest) - area(&theirs)).abs() < 1e-5, "case {case}");
        }
    }

    #[test]
    fn edges_that_a_ring_passes_more_than_once_count_as_often() {
        let ring = |points: &[[f64; 2]]| points.iter().map(|p| Point::from(*p)).collect::<Ring>();
        // A spike on its own side; a hole joined to the outline along a side; an end past the start.
        let cases = [
            (
                ring(&[
                    [0.0, 0.0],
                    [10.0, 0.0],
                    [10.0, 5.0],
                    [10.0, 4.0],
                    [10.0, 10.0],
                    [0.0, 10.0],
                ]),
                100.0,
            ),
            (
                ring(&[
                    [0.0, 0.0],
                    [40.0, 0.0],
                    [40.0, 40.0],
                    [0.0, 40.0],
                    [0.0, 0.0],
                    [10.0, 0.0],
                    [10.0, 30.0],
                    [30.0, 30.0],
                    [30.0, 10.0],
                    [10.0, 10.0],
                    [10.0, 0.0],
                ]),
                1200.0,
            ),
            (
                ring(&[
                    [20.0, 10.0],
                    [10.0, 10.0],
                    [10.0, 40.0],
                    [40.0, 40.0],
                    [40.0, 10.0],
                    [19.75, 10.0],
                ]),
                900.0,
            ),
        ];
        for (ring, expected) in cases {
            let found = combine([&[ring], &[]], 2f64.powi(-26), |[turns, _]| turns % 2 != 0);
            assert_eq!(area(&found.unwrap()), expected);
        }
    }
}
