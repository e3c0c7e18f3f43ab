//! The narrowest gap between two areas that do not meet.

use super::Polygon;
use crate::index::{BoxTree, Extent};
use crate::{Bounds, Point, budget};

/// Steps for each corner whose nearest place is looked for.
const CORNER: u64 = 40;

/// Where two areas are nearest to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// The place on the border of the first.
    pub from: Point,
    /// The place on the border of the second.
    pub to: Point,
}

impl Gap {
    /// How wide it is.
    pub fn width(&self) -> f64 {
        self.from.distance(self.to)
    }
}

/// The narrowest gap between the borders of `a` and `b`, which do not cross; none where one of them is empty.
///
/// Lines that do not cross are nearest at an end of one of them, so that only corners are looked from. O((n + m) log (n + m))
/// for areas of n and m corners that are spread out; equal gaps are decided by the order of the corners.
///
/// ```
/// use fretwork_geometry::{Point, Region, polygon};
/// let square = |x: f64| Region::rectangle(Point::new(x, 0.0), Point::new(x + 1.0, 1.0)).area;
/// assert_eq!(polygon::gap(&square(0.0), &square(3.0)).unwrap().width(), 2.0);
/// ```
pub fn gap(a: &[Polygon], b: &[Polygon]) -> Option<Gap> {
    let there = nearest_side(a, b);
    let back = nearest_side(b, a).map(|gap| Gap {
        from: gap.to,
        to: gap.from,
    });
    match (there, back) {
        (Some(there), Some(back)) if back.width() < there.width() => Some(back),
        (there, back) => there.or(back),
    }
}

/// The corner of `from` that is nearest to a side of `to`, and the place on that side.
fn nearest_side(from: &[Polygon], to: &[Polygon]) -> Option<Gap> {
    let sides: Vec<[Point; 2]> = to.iter().flat_map(sides).collect();
    let boxes: Vec<Extent<2>> = sides.iter().map(|side| Bounds::of(*side).into()).collect();
    let tree = BoxTree::new(&boxes);
    let mut best: Option<Gap> = None;
    for corner in from.iter().flat_map(Polygon::rings).flatten() {
        budget::spend("corners of outlines", CORNER);
        let at = Extent::from([corner.x, corner.y]);
        let reach = best.map_or(f64::INFINITY, |gap| gap.width());
        tree.nearest_first(
            |node, _| Some(node.distance(&at)),
            reach,
            |number| {
                let found = Gap {
                    from: *corner,
                    to: nearest_on(sides[number as usize], *corner),
                };
                if best.is_none_or(|gap| found.width() < gap.width()) {
                    best = Some(found);
                }
                best.map_or(f64::INFINITY, |gap| gap.width())
            },
        );
    }
    best
}

fn sides(polygon: &Polygon) -> impl Iterator<Item = [Point; 2]> + '_ {
    let of_ring = |ring: &'_ super::Ring| {
        let next = ring.iter().cycle().skip(1);
        let sides = ring.iter().zip(next).map(|(a, b)| [*a, *b]);
        sides.collect::<Vec<_>>()
    };
    polygon.rings().flat_map(of_ring)
}

/// The point of a side that is nearest to `p`.
fn nearest_on([a, b]: [Point; 2], p: Point) -> Point {
    let along = b - a;
    let square = along.dot(along);
    if square == 0.0 {
        return a;
    }
    a.lerp(b, ((p - a).dot(along) / square).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Seed;

    /// A star about `center` with corners at random distances.
    fn star(seed: Seed, center: Point) -> Polygon {
        let corner = |i: u32| {
            let angle = std::f64::consts::TAU * f64::from(i) / 12.0;
            center + Point::unit(angle) * seed.range(u64::from(i), 0.5, 2.0)
        };
        Polygon {
            outer: (0..12).map(corner).collect(),
            holes: Vec::new(),
        }
    }

    #[test]
    fn the_gap_is_that_of_all_corners_and_sides() {
        for case in 0..40 {
            let seed = Seed::root(case);
            let stars = |y: f64, name: &str| -> Vec<Polygon> {
                let of = |i: i64| star(seed.name(name).number(i), Point::new(5.0 * i as f64, y));
                (0..4).map(of).collect()
            };
            let (a, b) = (stars(0.0, "a"), stars(4.5, "b"));
            let found = gap(&a, &b).unwrap();
            let mut least = f64::INFINITY;
            for (from, to) in [(&a, &b), (&b, &a)] {
                for p in from.iter().flat_map(|polygon| &polygon.outer) {
                    for side in to.iter().flat_map(sides) {
                        least = least.min(nearest_on(side, *p).distance(*p));
                    }
                }
            }
            assert_eq!(found.width(), least, "case {case}");
            let turned = gap(&b, &a).unwrap();
            assert_eq!(turned.width(), least, "case {case}");
        }
        assert_eq!(gap(&[], &[]), None);
    }
}
