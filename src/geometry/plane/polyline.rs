//! Lines of several pieces in the plane, and whether they cross themselves.

use crate::Point;
use crate::index::{BoxTree, Extent};

/// A place where pieces of a line meet that do not follow one another, if there is one. Piece i leads from point i to the next; on a
/// closed line the last one leads back to the first point. Only pieces that are `wanted` are looked at. O(n log n) where few boxes of
/// pieces meet.
///
/// ```
/// use fretwork_geometry::{Point, polyline};
/// let eight = [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]].map(Point::from);
/// assert_eq!(polyline::crossing(&eight, false, |_| true), Some(Point::new(1.0, 1.0)));
/// assert_eq!(polyline::crossing(&eight, false, |piece| piece != 0), None);
/// ```
pub fn crossing(points: &[Point], closed: bool, wanted: impl Fn(usize) -> bool) -> Option<Point> {
    let count = points.len();
    let pieces = if closed {
        count
    } else {
        count.saturating_sub(1)
    };
    let ends = |i: usize| [points[i], points[(i + 1) % count]];
    let wanted: Vec<usize> = (0..pieces).filter(|i| wanted(*i)).collect();
    let boxes: Vec<Extent<2>> = wanted
        .iter()
        .map(|i| {
            let [a, b] = ends(*i);
            Extent::from([a.x, a.y]).union(&Extent::from([b.x, b.y]))
        })
        .collect();
    let follow = |i: usize, j: usize| {
        i.abs_diff(j) <= 1 || closed && i.min(j) == 0 && i.max(j) + 1 == pieces
    };
    let pairs = BoxTree::new(&boxes).meeting_pairs();
    let mut pairs: Vec<[usize; 2]> = pairs
        .iter()
        .map(|pair| pair.map(|k| wanted[k as usize]))
        .filter(|[i, j]| !follow(*i, *j))
        .collect();
    pairs.sort_unstable();
    pairs
        .into_iter()
        .find_map(|[i, j]| meeting(ends(i), ends(j)))
}

/// Where two segments meet that are not parallel.
fn meeting([a, b]: [Point; 2], [c, d]: [Point; 2]) -> Option<Point> {
    let (way, other) = (b - a, d - c);
    let across = way.cross(other);
    if across == 0.0 {
        return None;
    }
    let (t, u) = ((c - a).cross(other) / across, (c - a).cross(way) / across);
    let is_on = |part: f64| (0.0..=1.0).contains(&part);
    (is_on(t) && is_on(u)).then(|| a.lerp(b, t))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_closed_line_meets_itself_at_its_beginning_without_crossing() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(Point::from);
        assert_eq!(crossing(&square, true, |_| true), None);
        assert_eq!(crossing(&square, false, |_| true), None);
        let bow = [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]].map(Point::from);
        assert_eq!(crossing(&bow, true, |_| true), Some(Point::new(1.0, 1.0)));
        assert_eq!(crossing(&[], true, |_| true), None);
    }

    #[test]
    fn a_line_that_touches_itself_meets_itself() {
        let hook = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [1.0, 0.0]].map(Point::from);
        assert_eq!(crossing(&hook, false, |_| true), Some(Point::new(1.0, 0.0)));
    }
}
