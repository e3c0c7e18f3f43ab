//! Polygons with holes, in floating point: the areas of regions, drawings and cutouts.

mod boolean;
mod faces;
mod gap;
mod offset;
mod planar_fill;
mod stroke;
mod widest;

use serde::{Deserialize, Serialize};

use crate::{Bounds, Point};

pub(crate) use boolean::Grid;
pub use boolean::{AreaError, fill, intersect, subtract, unite};
pub use faces::{of_face, of_faces};
pub use gap::{Gap, gap};
pub use offset::offset;
pub use stroke::outlines as stroke_outlines;
pub use widest::widest_place;

/// A closed polyline; the edge from the last point to the first is implied.
pub type Ring = Vec<Point>;

/// An outer ring, counter-clockwise (+x toward +y), and its holes, clockwise. Rings do not cross.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Polygon {
    /// The outer ring.
    pub outer: Ring,
    /// The holes.
    pub holes: Vec<Ring>,
}

impl Polygon {
    /// The rings, the outer one first.
    #[inline]
    pub fn rings(&self) -> impl Iterator<Item = &Ring> + Clone {
        std::iter::once(&self.outer).chain(&self.holes)
    }

    /// The area without the holes.
    #[inline]
    pub fn area(&self) -> f64 {
        self.rings().map(|ring| signed_area(ring)).sum()
    }

    /// Whether `p` lies inside, by the even-odd rule; on the border either answer is given.
    #[inline]
    pub fn contains(&self, p: Point) -> bool {
        let crosses = |a: Point, b: Point| {
            (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
        };
        let crossings = |ring: &Ring| {
            (0..ring.len())
                .filter(|&i| crosses(ring[i], ring[(i + 1) % ring.len()]))
                .count()
        };
        self.rings().map(crossings).sum::<usize>() % 2 == 1
    }

    /// Whether `p` lies inside, or exactly on the border.
    pub fn holds(&self, p: Point) -> bool {
        let is_on =
            |a: Point, b: Point| (b - a).cross(p - a) == 0.0 && Bounds::of([a, b]).contains(p);
        let borders =
            |ring: &Ring| (0..ring.len()).any(|i| is_on(ring[i], ring[(i + 1) % ring.len()]));
        self.contains(p) || self.rings().any(borders)
    }

    /// The box of the outer ring.
    #[inline]
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.outer.iter().copied())
    }
}

/// The centroid of the area of `polygons`; the middle of their box where that is 0.
pub fn centroid(polygons: &[Polygon]) -> Point {
    let bounds = polygons
        .iter()
        .fold(Bounds::EMPTY, |b, p| b.union(p.bounds()));
    let origin = bounds.center();
    let (mut area, mut moment) = (0.0, Point::ORIGIN);
    for ring in polygons.iter().flat_map(Polygon::rings) {
        for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            let (a, b) = (*a - origin, *b - origin);
            let cross = a.cross(b);
            area += cross;
            moment = moment + (a + b) * cross;
        }
    }
    if area == 0.0 {
        origin
    } else {
        origin + moment * (1.0 / (3.0 * area))
    }
}

/// A point inside of `polygons`: their centroid or, if that lies outside, the middle of the widest piece of the horizontal
/// line through it; the centroid again where that line meets nothing.
pub fn inner_point(polygons: &[Polygon]) -> Point {
    let middle = centroid(polygons);
    if polygons.iter().any(|polygon| polygon.contains(middle)) {
        return middle;
    }
    let mut crossings = Vec::new();
    for ring in polygons.iter().flat_map(Polygon::rings) {
        for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            if (a.y > middle.y) != (b.y > middle.y) {
                crossings.push(a.x + (middle.y - a.y) / (b.y - a.y) * (b.x - a.x));
            }
        }
    }
    crossings.sort_by(f64::total_cmp);
    let widest = crossings
        .chunks_exact(2)
        .max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
    widest.map_or(middle, |piece| {
        Point::new((piece[0] + piece[1]) / 2.0, middle.y)
    })
}

/// The area that `ring` goes round, positive where it runs from +x toward +y.
pub fn signed_area(ring: &[Point]) -> f64 {
    let Some(&origin) = ring.first() else {
        return 0.0;
    };
    // Measured from the first point, which keeps the digits of a small ring far from (0, 0).
    ring.windows(2)
        .map(|w| (w[0] - origin).cross(w[1] - origin))
        .sum::<f64>()
        / 2.0
}

/// The same polygons in the one order and sense that equal areas have: outer rings
/// counter-clockwise, holes clockwise, each from its least point, everything sorted by least
/// point; rings without area are dropped.
pub fn canonical(mut polygons: Vec<Polygon>) -> Vec<Polygon> {
    polygons.retain_mut(|polygon| {
        orient(&mut polygon.outer, true);
        polygon
            .holes
            .iter_mut()
            .for_each(|hole| orient(hole, false));
        polygon.holes.retain(|hole| signed_area(hole) < 0.0);
        polygon.holes.sort_by(compare);
        signed_area(&polygon.outer) > 0.0
    });
    polygons.sort_by(|a, b| compare(&a.outer, &b.outer));
    polygons
}

/// The polygons with every coordinate a whole number of steps, `steps` of which make one unit, as files hold them. Spikes
/// that this leaves, and rings without area, are dropped; whether the rings still neither cross nor touch is not
/// looked at.
pub fn rounded(polygons: &[Polygon], steps: f64) -> Vec<Polygon> {
    let whole = |p: &Point| Point::new((p.x * steps).round(), (p.y * steps).round());
    let back = |p: Point| Point::new(p.x / steps + 0.0, p.y / steps + 0.0);
    let ring = |ring: &Ring| {
        without_spikes(ring.iter().map(whole))
            .into_iter()
            .map(back)
            .collect()
    };
    let rounded = |p: &Polygon| Polygon {
        outer: ring(&p.outer),
        holes: p.holes.iter().map(ring).collect(),
    };
    canonical(polygons.iter().map(rounded).collect())
}

/// The ring without repeated points, and without edges that the next edge takes back; coordinates are whole numbers.
fn without_spikes(points: impl Iterator<Item = Point>) -> Ring {
    let spike = |a: Point, b: Point, c: Point| {
        a == b || ((b - a).cross(c - b) == 0.0 && (b - a).dot(c - b) < 0.0)
    };
    let mut ring: Ring = Vec::new();
    for p in points {
        while ring.len() > 1 && spike(ring[ring.len() - 2], ring[ring.len() - 1], p) {
            ring.pop();
        }
        if ring.last() != Some(&p) {
            ring.push(p);
        }
    }
    // The same where the end meets the beginning.
    let mut first = 0;
    while ring.len() - first > 2 {
        let n = ring.len();
        if ring[n - 1] == ring[first] || spike(ring[n - 2], ring[n - 1], ring[first]) {
            ring.pop();
        } else if spike(ring[n - 1], ring[first], ring[first + 1]) {
            first += 1;
        } else {
            break;
        }
    }
    ring.drain(..first);
    ring
}

/// Gives `ring` the asked sense and makes its least point the first.
fn orient(ring: &mut Ring, counter_clockwise: bool) {
    if (signed_area(ring) > 0.0) != counter_clockwise {
        ring.reverse();
    }
    let least = (0..ring.len())
        .min_by(|&i, &j| order(&ring[i], &ring[j]))
        .unwrap_or(0);
    ring.rotate_left(least);
}

fn compare(a: &Ring, b: &Ring) -> std::cmp::Ordering {
    let pairs = a.iter().zip(b).map(|(p, q)| order(p, q));
    pairs
        .fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
        .then(a.len().cmp(&b.len()))
}

fn order(a: &Point, b: &Point) -> std::cmp::Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(a: f64, b: f64) -> Ring {
        vec![
            Point::new(a, a),
            Point::new(b, a),
            Point::new(b, b),
            Point::new(a, b),
        ]
    }

    #[test]
    fn holes_are_taken_from_the_area() {
        let mut hole = square(1.0, 2.0);
        hole.reverse();
        assert_eq!(
            Polygon {
                outer: square(0.0, 4.0),
                holes: vec![hole]
            }
            .area(),
            15.0
        );
    }

    #[test]
    fn rounding_leaves_no_spikes() {
        let ring = |points: &[[f64; 2]]| points.iter().map(|&p| Point::from(p)).collect::<Ring>();
        // The way back from the tip is shorter than the way to it, and has a corner of its own.
        let spiked = [
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 2.01],
            [7.0, 1.99],
            [6.0, 2.0],
            [4.01, 2.02],
            [4.0, 4.0],
            [0.0, 4.0],
        ];
        let plain = ring(&[[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [4.0, 4.0], [0.0, 4.0]]);
        for start in 0..spiked.len() {
            let mut outer = ring(&spiked);
            outer.rotate_left(start);
            let found = rounded(
                &[Polygon {
                    outer,
                    holes: vec![],
                }],
                10.0,
            );
            assert_eq!((found.len(), &found[0].outer), (1, &plain), "from {start}");
        }
        let sliver = Polygon {
            outer: ring(&[[0.0, 0.0], [4.0, 0.01], [2.0, 0.02]]),
            holes: vec![],
        };
        assert_eq!(rounded(&[sliver], 10.0), []);
    }

    #[test]
    fn equal_areas_have_one_form() {
        let turned = |mut ring: Ring, by: usize, back: bool| {
            ring.rotate_left(by);
            if back {
                ring.reverse();
            }
            ring
        };
        let first = Polygon {
            outer: square(0.0, 9.0),
            holes: vec![square(1.0, 2.0), square(3.0, 4.0)],
        };
        let other = Polygon {
            outer: turned(square(0.0, 9.0), 2, true),
            holes: vec![
                turned(square(3.0, 4.0), 1, true),
                turned(square(1.0, 2.0), 3, false),
            ],
        };
        let flat = Polygon {
            outer: vec![Point::ORIGIN, Point::new(1.0, 1.0), Point::ORIGIN],
            holes: vec![],
        };
        let far = Polygon {
            outer: square(20.0, 21.0),
            holes: vec![],
        };
        let (a, b) = (
            canonical(vec![far.clone(), first]),
            canonical(vec![other, flat, far]),
        );
        assert_eq!(a, b);
        assert_eq!(a[0].area(), 79.0);
    }
}
