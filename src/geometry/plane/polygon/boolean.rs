//! Union, intersection, difference and fill rules of polygons.
//!
//! The crossings are found by the `geo` crate, which works on 32-bit integers. Everything goes to
//! it on one grid, and a vertex that comes back unchanged gets its own coordinates again: what
//! was exact stays exact, and shapes that shared an edge still share it after any number of
//! operations. Only crossings are rounded.

use std::collections::HashMap;

use geo::bool_ops::OpType;
use geo::{BooleanOps, Coord, LineString, MultiPolygon};

use super::{Polygon, Ring, canonical, planar_fill, signed_area};
use crate::planar_map::PlanarMapError;
use crate::{Bounds, FillRule, Point, budget};

/// Beyond this the squares of coordinates would overflow.
const LARGEST: f64 = 1e150;

/// Why areas cannot be computed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum AreaError {
    /// A coordinate is NaN, infinite, or beyond 10^150.
    #[error("the point ({}, {}) is out of range", .0.x, .0.y)]
    OutOfRange(Point),
    /// The tolerance is not a number above zero.
    #[error("the tolerance {0} is not above zero")]
    Tolerance(f64),
    /// So many shapes at once that they go through a planar map, and there is none.
    #[error(transparent)]
    Map(#[from] PlanarMapError),
}

/// What lies in at least one of `polygons`, which may overlap.
pub fn unite(polygons: &[Polygon]) -> Result<Vec<Polygon>, AreaError> {
    Grid::over(polygons.iter().flat_map(Polygon::rings))?.unite(polygons)
}

/// What lies in `a` and in `b`; the polygons of either do not overlap.
pub fn intersect(a: &[Polygon], b: &[Polygon]) -> Result<Vec<Polygon>, AreaError> {
    Grid::over(a.iter().chain(b).flat_map(Polygon::rings))?.combine(a, b, OpType::Intersection)
}

/// What lies in `a` and not in `b`; the polygons of either do not overlap.
pub fn subtract(a: &[Polygon], b: &[Polygon]) -> Result<Vec<Polygon>, AreaError> {
    Grid::over(a.iter().chain(b).flat_map(Polygon::rings))?.combine(a, b, OpType::Difference)
}

/// What `rings` enclose together by `rule`; they may cross themselves and one another.
pub fn fill(rings: &[Ring], rule: FillRule) -> Result<Vec<Polygon>, AreaError> {
    Grid::over(rings)?.fill(rings, rule)
}

/// The width of slivers, in steps of the grid.
const SLIVER: f64 = 4.0;

/// So many points are the most that go to the library at once. Drawings of some ten thousand points are its daily work;
/// heaps of several hundred thousand are where it has not come to an end.
const TRUSTED: usize = 100_000;

/// Steps for each point that goes to the library.
const POINT_STEPS: u64 = 100;

/// Bytes for each point: its copy, and its place in a table that doubles while it is filled.
const POINT: usize = 160;

/// Units of a planar map in a step of the grid; see `planar_map::noding`.
const FINE: f64 = 512.0;

/// The integer grid that all operations on one set of rings share.
pub(crate) struct Grid {
    center: Point,
    /// A power of two between 2^-29 and 2^-28 of the longer side.
    step: f64,
    /// The first point that was rounded to each grid point.
    vertices: HashMap<(i64, i64), Point>,
}

impl Grid {
    /// A grid that the points of all `rings` fit.
    pub fn over<'a>(rings: impl IntoIterator<Item = &'a Ring> + Clone) -> Result<Grid, AreaError> {
        let points = || rings.clone().into_iter().flatten().copied();
        if let Some(bad) = points().find(|p| !(p.x.abs() <= LARGEST && p.y.abs() <= LARGEST)) {
            return Err(AreaError::OutOfRange(bad));
        }
        let bounds = Bounds::of(points());
        let (_, exponent) = libm::frexp(bounds.longer_side());
        let step = if bounds.longer_side() > 0.0 {
            libm::ldexp(1.0, (exponent - 29).max(-1000))
        } else {
            1.0
        };
        let center = if bounds.is_empty() {
            Point::ORIGIN
        } else {
            bounds.center()
        };
        budget::hold("points of areas", points().count(), POINT);
        let mut grid = Grid {
            center,
            step,
            vertices: HashMap::new(),
        };
        for p in points() {
            grid.vertices.entry(grid.cell(p)).or_insert(p);
        }
        Ok(grid)
    }

    /// See [`fill`].
    pub fn fill<R: AsRef<[Point]>>(
        &self,
        rings: &[R],
        rule: FillRule,
    ) -> Result<Vec<Polygon>, AreaError> {
        let rule = match rule {
            FillRule::NonZero => geo::bool_ops::FillRule::NonZero,
            FillRule::EvenOdd => geo::bool_ops::FillRule::EvenOdd,
        };
        let subject = MultiPolygon(
            rings
                .iter()
                .filter_map(|ring| self.simple(ring.as_ref()))
                .collect(),
        );
        self.resolve(&subject, &MultiPolygon(vec![]), OpType::Union, rule)
    }

    /// What has a positive winding number among `rings`.
    pub fn positive(&self, rings: &[Ring]) -> Result<Vec<Polygon>, AreaError> {
        let subject = MultiPolygon(rings.iter().filter_map(|ring| self.simple(ring)).collect());
        self.resolve(
            &subject,
            &MultiPolygon(vec![]),
            OpType::Union,
            geo::bool_ops::FillRule::Positive,
        )
    }

    /// See [`unite`].
    pub fn unite(&self, polygons: &[Polygon]) -> Result<Vec<Polygon>, AreaError> {
        // Outer rings count one up and holes one down, so a point's number is that of the
        // polygons it lies in.
        self.resolve(
            &self.multi_polygon(polygons),
            &MultiPolygon(vec![]),
            OpType::Union,
            geo::bool_ops::FillRule::Positive,
        )
    }

    /// The operation `op` on the areas of `a` and `b`.
    pub fn combine(
        &self,
        a: &[Polygon],
        b: &[Polygon],
        op: OpType,
    ) -> Result<Vec<Polygon>, AreaError> {
        self.resolve(
            &self.multi_polygon(a),
            &self.multi_polygon(b),
            op,
            geo::bool_ops::FillRule::Positive,
        )
    }

    fn resolve(
        &self,
        a: &MultiPolygon,
        b: &MultiPolygon,
        op: OpType,
        rule: geo::bool_ops::FillRule,
    ) -> Result<Vec<Polygon>, AreaError> {
        let count = |operand: &MultiPolygon| -> usize {
            operand.0.iter().map(|p| p.exterior().0.len()).sum()
        };
        if count(a) + count(b) > TRUSTED {
            return self.resolve_by_map(a, b, op, rule);
        }
        budget::spend(
            "points of areas",
            POINT_STEPS * (count(a) + count(b)) as u64,
        );
        let resolved = a.boolean_op_with_fill_rule(b, op, rule);
        let ring = |line: &LineString| -> Ring {
            line.0.split_last().map_or(Vec::new(), |(_, open)| {
                open.iter().map(|c| self.point(c)).collect()
            })
        };
        let polygons = resolved.0.iter().map(|p| Polygon {
            outer: ring(p.exterior()),
            holes: p.interiors().iter().map(ring).collect(),
        });
        Ok(self.without_slivers(polygons.collect()))
    }

    /// The same by a planar map.
    fn resolve_by_map(
        &self,
        a: &MultiPolygon,
        b: &MultiPolygon,
        op: OpType,
        rule: geo::bool_ops::FillRule,
    ) -> Result<Vec<Polygon>, AreaError> {
        use geo::bool_ops::FillRule as Rule;
        let rings = |operand: &MultiPolygon| -> Vec<Ring> {
            let open = |line: &LineString| {
                line.0
                    .split_last()
                    .map_or(&[][..], |(_, open)| open)
                    .to_vec()
            };
            let ring = |p: &geo::Polygon| {
                open(p.exterior())
                    .iter()
                    .map(|c| Point::new(c.x, c.y))
                    .collect()
            };
            operand.0.iter().map(ring).collect()
        };
        let holds = |turns: i32| match rule {
            Rule::EvenOdd => turns % 2 != 0,
            Rule::NonZero => turns != 0,
            Rule::Positive => turns > 0,
            Rule::Negative => turns < 0,
        };
        let inside = |[a, b]: [i32; 2]| match op {
            OpType::Intersection => holds(a) && holds(b),
            OpType::Union => holds(a) || holds(b),
            OpType::Difference => holds(a) && !holds(b),
            OpType::Xor => holds(a) != holds(b),
        };
        let mut polygons = planar_fill::combine([&rings(a), &rings(b)], 1.0, inside)?;
        for ring in polygons
            .iter_mut()
            .flat_map(|p| std::iter::once(&mut p.outer).chain(&mut p.holes))
        {
            let straight = straightened(ring.iter().map(|p| [p.x, p.y].map(|v| (v * FINE) as i64)));
            *ring = straight
                .into_iter()
                .map(|i| {
                    self.point(&Coord {
                        x: ring[i].x,
                        y: ring[i].y,
                    })
                })
                .collect();
        }
        Ok(self.without_slivers(polygons))
    }

    fn without_slivers(&self, mut polygons: Vec<Polygon>) -> Vec<Polygon> {
        polygons.retain(|polygon| !self.is_sliver(&polygon.outer));
        polygons
            .iter_mut()
            .for_each(|polygon| polygon.holes.retain(|hole| !self.is_sliver(hole)));
        canonical(polygons)
    }

    /// Whether a ring is no wider than the grid is fine: what rounding left between lines that should
    /// have met.
    fn is_sliver(&self, ring: &[Point]) -> bool {
        let around: f64 = ring
            .iter()
            .zip(ring.iter().cycle().skip(1))
            .map(|(a, b)| a.distance(*b))
            .sum();
        signed_area(ring).abs() <= SLIVER * self.step * around
    }

    fn multi_polygon(&self, polygons: &[Polygon]) -> MultiPolygon {
        MultiPolygon(
            polygons
                .iter()
                .flat_map(Polygon::rings)
                .filter_map(|ring| self.simple(ring))
                .collect(),
        )
    }

    fn simple(&self, ring: &[Point]) -> Option<geo::Polygon> {
        let mut coords: Vec<Coord> = ring.iter().map(|&p| self.coord(p)).collect();
        coords.dedup();
        (coords.len() > 2).then(|| geo::Polygon::new(LineString(coords), vec![]))
    }

    fn cell(&self, p: Point) -> (i64, i64) {
        let q = (p - self.center) * (1.0 / self.step);
        (q.x.round() as i64, q.y.round() as i64)
    }

    fn coord(&self, p: Point) -> Coord {
        let (x, y) = self.cell(p);
        Coord {
            x: x as f64,
            y: y as f64,
        }
    }

    /// The point that `coord` was made from, else that at its place.
    fn point(&self, coord: &Coord) -> Point {
        let whole = coord.x.fract() == 0.0 && coord.y.fract() == 0.0;
        match self.vertices.get(&(coord.x as i64, coord.y as i64)) {
            Some(&p) if whole => p,
            _ => self.center + Point::new(coord.x, coord.y) * self.step,
        }
    }
}

/// The numbers of the points of a ring that are left when those that repeat another, lie on the straight line between
/// their neighbours or are the end of a spike are taken out.
fn straightened(points: impl Iterator<Item = [i64; 2]>) -> Vec<usize> {
    let points: Vec<[i64; 2]> = points.collect();
    let is_straight = |a: usize, b: usize, c: usize| {
        let [a, b, c] = [a, b, c].map(|i| points[i].map(i128::from));
        (b[0] - a[0]) * (c[1] - b[1]) == (b[1] - a[1]) * (c[0] - b[0])
    };
    let mut kept: Vec<usize> = Vec::new();
    for i in 0..points.len() {
        while let [.., a, b] = kept[..]
            && is_straight(a, b, i)
        {
            kept.pop();
        }
        if kept.last().is_none_or(|last| points[*last] != points[i]) {
            kept.push(i);
        }
    }
    // Where the ring closes, points at either end may have become straight.
    let mut from = 0;
    while let [first, second, .., last] = kept[from..]
        && kept.len() - from > 2
    {
        let before = kept[kept.len() - 2];
        if points[last] == points[first] || is_straight(before, last, first) {
            kept.pop();
        } else if is_straight(last, first, second) {
            from += 1;
        } else {
            break;
        }
    }
    kept.split_off(from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn square(x: f64, y: f64, side: f64) -> Polygon {
        let p = |dx, dy| Point::new(x + dx, y + dy);
        Polygon {
            outer: vec![p(0.0, 0.0), p(side, 0.0), p(side, side), p(0.0, side)],
            holes: vec![],
        }
    }

    fn area(polygons: &[Polygon]) -> f64 {
        polygons.iter().map(Polygon::area).sum()
    }

    #[test]
    fn input_vertices_come_back_bit_for_bit() {
        let (a, b) = (square(0.1, 0.2, 0.7), square(0.8, 0.2, 0.7));
        let united = unite(&[a.clone(), b.clone()]).unwrap();
        assert_eq!(united.len(), 1);
        for p in &united[0].outer {
            assert!(a.outer.contains(p) || b.outer.contains(p), "{p:?}");
        }
        assert_eq!(unite(std::slice::from_ref(&a)).unwrap(), [a]);
    }

    #[test]
    fn fill_rules_differ_on_a_ring_that_winds_twice() {
        let (outer, inner) = (square(0.0, 0.0, 4.0).outer, square(1.0, 1.0, 2.0).outer);
        let twice: Ring = [&outer[..], &outer[..1], &inner[..], &inner[..1]].concat();
        assert_eq!(
            area(&fill(std::slice::from_ref(&twice), FillRule::NonZero).unwrap()),
            16.0
        );
        assert_eq!(area(&fill(&[twice], FillRule::EvenOdd).unwrap()), 12.0);
    }

    #[test]
    fn out_of_range_is_an_error() {
        let bad = Polygon {
            outer: vec![
                Point::ORIGIN,
                Point::new(f64::NAN, 0.0),
                Point::new(1.0, 1.0),
            ],
            holes: vec![],
        };
        assert!(matches!(unite(&[bad]), Err(AreaError::OutOfRange(_))));
        assert!(unite(&[]).unwrap().is_empty());
        assert!(unite(&[square(1e100, 0.0, 1.0)]).unwrap().is_empty());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        #[test]
        fn areas_obey_inclusion_and_exclusion(
            a in proptest::array::uniform3(-50.0..50.0f64), b in proptest::array::uniform3(-50.0..50.0f64),
        ) {
            let [x, y, s] = a;
            let (a, [x2, y2, s2]) = (vec![square(x, y, s.abs() + 1.0)], b);
            let b = vec![square(x2, y2, s2.abs() + 1.0)];
            let union = area(&unite(&[a.clone(), b.clone()].concat()).unwrap());
            let both = area(&intersect(&a, &b).unwrap());
            prop_assert!((union + both - area(&a) - area(&b)).abs() < 1e-5);
            prop_assert!((area(&subtract(&a, &b).unwrap()) - (area(&a) - both)).abs() < 1e-5);
        }
    }
}
