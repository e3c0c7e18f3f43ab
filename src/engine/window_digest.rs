//! What stands for curves of which an artifact shows a window: those that come into it, whether the whole was drawn or only
//! what is near the window. So the same window has the same origin from every build.

use fretwork_action::Window;
use fretwork_geometry::{Bounds, Curves, Point};
use fretwork_store::{Digest, Hasher};

/// A digest of the curves that come into a window, in any order.
pub fn in_window(curves: &Curves, window: Window) -> Digest {
    let window = Bounds {
        min: window.low().into(),
        max: window.high().into(),
    };
    let mut sum = 0u128;
    for curve in curves.iter() {
        let mut segments = curve.points.windows(2);
        if !segments.any(|ends| meets(ends[0], ends[1], &window)) {
            continue;
        }
        let mut hasher = Hasher::new("curve");
        for point in curve.points {
            let coordinates = [point.x, point.y].map(f64::to_le_bytes);
            hasher.part(&coordinates.concat());
        }
        for label in curve.labels.edge.names().iter() {
            hasher.part(label.as_bytes());
        }
        let digest = hasher.digest();
        let (low, _) = digest.as_bytes().split_at(16);
        let low = <[u8; 16]>::try_from(low).expect("half of 32 bytes");
        sum = sum.wrapping_add(u128::from_le_bytes(low));
    }
    let mut hasher = Hasher::new("curves in a window");
    hasher.part(&sum.to_le_bytes());
    hasher.digest()
}

/// Whether a segment has a point in a closed box.
fn meets(a: Point, b: Point, window: &Bounds) -> bool {
    if !Bounds::of([a, b]).intersects(window) {
        return false;
    }
    // All corners on one side of the line through the segment: the box lies beside it.
    let (min, max) = (window.min, window.max);
    let corners = [min, Point::new(max.x, min.y), max, Point::new(min.x, max.y)];
    let sides = corners.map(|corner| (b - a).cross(corner - a));
    a == b || !(sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::CurveLabels;

    #[test]
    fn what_does_not_come_into_the_window_does_not_count() {
        let lines = |ends: &[[[f64; 2]; 2]]| {
            let mut curves = Curves::new();
            for pair in ends {
                curves.push(pair.map(Point::from), CurveLabels::default());
            }
            curves
        };
        let window = Window::new([0.0, 0.0], [2.0, 2.0]).expect("a window");
        let (inside, other) = ([[1.0, 1.0], [5.0, 1.0]], [[0.5, 0.0], [0.5, 9.0]]);
        // Its box meets the window, which lies beside it.
        let beside = [[-9.0, 3.0], [3.0, 30.0]];
        let digest = |ends: &[[[f64; 2]; 2]]| in_window(&lines(ends), window);
        assert_eq!(digest(&[inside, other]), digest(&[other, beside, inside]));
        assert_ne!(digest(&[inside, other]), digest(&[inside]));
        assert_ne!(digest(&[inside, inside]), digest(&[]));
    }
}
