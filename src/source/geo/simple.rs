//! Whether the rings of a feature cross one another or themselves, or share a side.

use fretwork_geometry::Point;

/// What is unusual about the rings of a feature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unusual {
    /// Two sides cross here.
    Crossing(Point),
    /// Two sides lie on one another here.
    Shared(Point),
}

/// The first crossing of two sides of `rings`, or else the first stretch that two sides share; none of
/// either for rings that are simple and apart. Sides that meet in a corner are no crossing.
///
/// Sides are swept by their least x: O(n log n) and the pairs whose boxes overlap along x.
pub fn unusual(rings: &[Vec<Point>]) -> Option<Unusual> {
    let sides = rings.iter().flat_map(|ring| {
        let ends = ring.iter().cycle().skip(1);
        ring.iter().zip(ends).map(|(a, b)| ordered(*a, *b))
    });
    let mut sides: Vec<[Point; 2]> = sides.collect();
    sides.sort_by(|s, t| {
        key(s[0])
            .partial_cmp(&key(t[0]))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    let mut open: Vec<[Point; 2]> = Vec::new();
    let mut shared = None;
    for side in sides {
        open.retain(|other| other[1].x >= side[0].x);
        for other in &open {
            match met(other, &side) {
                Some(Unusual::Crossing(at)) => return Some(Unusual::Crossing(at)),
                Some(found) => shared = shared.or(Some(found)),
                None => {}
            }
        }
        open.push(side);
    }
    shared
}

fn key(p: Point) -> (f64, f64) {
    (p.x, p.y)
}

fn ordered(a: Point, b: Point) -> [Point; 2] {
    if key(b) < key(a) { [b, a] } else { [a, b] }
}

/// How two sides meet, if it is not in their ends.
fn met(s: &[Point; 2], t: &[Point; 2]) -> Option<Unusual> {
    let span = |s: &[Point; 2]| (s[0].y.min(s[1].y), s[0].y.max(s[1].y));
    let ((low, high), (below, above)) = (span(s), span(t));
    if below > high || above < low {
        return None;
    }
    let side = |s: &[Point; 2], p: Point| (s[1] - s[0]).cross(p - s[0]);
    let (a, b) = (side(s, t[0]), side(s, t[1]));
    let (c, d) = (side(t, s[0]), side(t, s[1]));
    if a == 0.0 && b == 0.0 {
        // On one line, and ordered along it.
        let (from, to) = (
            if key(s[0]) < key(t[0]) { t[0] } else { s[0] },
            if key(s[1]) < key(t[1]) { s[1] } else { t[1] },
        );
        return (key(from) < key(to)).then(|| Unusual::Shared(from.lerp(to, 0.5)));
    }
    let crosses = (a < 0.0) != (b < 0.0) && (c < 0.0) != (d < 0.0);
    let touches = a == 0.0 || b == 0.0 || c == 0.0 || d == 0.0;
    (crosses && !touches).then(|| Unusual::Crossing(t[0].lerp(t[1], a / (a - b))))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[[f64; 2]]) -> Vec<Point> {
        points.iter().map(|p| Point::from(*p)).collect()
    }

    #[test]
    fn crossings_are_found_and_corners_are_none() {
        let bow = ring(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]]);
        assert_eq!(
            unusual(&[bow]),
            Some(Unusual::Crossing(Point::new(1.0, 1.0)))
        );
        let square = ring(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]);
        let hole = ring(&[[0.0, 0.0], [1.0, 2.0], [2.0, 1.0]]);
        assert_eq!(unusual(&[square.clone(), hole]), None);
        let beside = ring(&[[4.0, 1.0], [8.0, 1.0], [8.0, 3.0], [4.0, 3.0]]);
        assert_eq!(
            unusual(&[square, beside]),
            Some(Unusual::Shared(Point::new(4.0, 2.0)))
        );
    }
}
