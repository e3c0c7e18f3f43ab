//! A curve that text runs along.

use fretwork_geometry::{Affine, Point, SpaceCurve};

/// A level curve as it is seen from above, with the place where text is aligned.
pub struct Baseline {
    points: Vec<Point>,
    /// The length up to each point.
    lengths: Vec<f64>,
    is_closed: bool,
    /// Where the text is aligned.
    at: f64,
    /// It is read against the direction of the curve, which is on the other side of the letters then.
    is_against: bool,
}

impl Baseline {
    /// The curve of a text that is aligned at the length `at`; letters stand to the left of the way that it is read. None where
    /// the curve is not level.
    pub fn new(curve: &SpaceCurve, at: f64, is_against: bool) -> Option<Baseline> {
        let normal = curve.plane()?;
        (normal.z.abs() > 1.0 - 1e-9).then(|| Baseline {
            // From above, and in the drawing plane, which is mirrored.
            points: curve
                .points()
                .iter()
                .map(|p| Point::new(p.x, -p.y))
                .collect(),
            lengths: curve.lengths().to_vec(),
            is_closed: curve.is_closed(),
            at,
            is_against,
        })
    }

    fn length(&self) -> f64 {
        self.lengths.last().copied().unwrap_or(0.0)
    }

    /// By how much text between `from` and `to` on the baseline goes beyond the curve, if it does; of a closed one by how
    /// much it is longer.
    pub fn over(&self, [from, to]: [f64; 2]) -> Option<f64> {
        let over = if self.is_closed {
            to - from - self.length()
        } else {
            let [a, b] = [self.along(from), self.along(to)];
            (-a.min(b)).max(a.max(b) - self.length())
        };
        (over > 1e-9 * self.length()).then_some(over)
    }

    /// The length along the curve of a place on the baseline.
    fn along(&self, x: f64) -> f64 {
        if self.is_against {
            self.at - x
        } else {
            self.at + x
        }
    }

    /// The map that puts a letter, whose middle is the origin, at `x` on the baseline. It is as steep as the curve is between
    /// the ends of the letter, `advance` apart.
    pub fn place(&self, x: f64, advance: f64) -> Affine {
        let reach = (0.5 * advance).max(1e-6 * self.length());
        let at = self.point(self.along(x));
        let (from, to) = (
            self.point(self.along(x - reach)),
            self.point(self.along(x + reach)),
        );
        let ahead = to - from;
        Affine::rotation(libm::atan2(ahead.y, ahead.x)).then(Affine::translation(at))
    }

    /// The point at a length; an open curve goes on straight at its ends.
    fn point(&self, s: f64) -> Point {
        let length = self.length();
        let s = if self.is_closed {
            s - (s / length).floor() * length
        } else {
            s
        };
        let next = self.lengths.partition_point(|l| *l <= s);
        let next = next.clamp(1, self.points.len() - 1);
        let (from, to) = (self.lengths[next - 1], self.lengths[next]);
        self.points[next - 1].lerp(self.points[next], (s - from) / (to - from))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Point3;

    #[test]
    fn letters_stand_outside_of_a_circle_when_they_are_read_against_it() {
        let circle = SpaceCurve::circle(10.0).unwrap();
        let top = 0.25 * circle.length();
        for (is_against, outside) in [(false, -1.0), (true, 1.0)] {
            let baseline = Baseline::new(&circle, top, is_against).unwrap();
            let map = baseline.place(0.0, 2.0);
            let foot = map.apply(Point::ORIGIN);
            assert!(foot.distance(Point::new(0.0, -10.0)) < 1e-6);
            // The head of a letter is above its foot.
            let head = map.apply(Point::new(0.0, -1.0));
            assert!((head.length() - (10.0 + outside)).abs() < 1e-3, "{head:?}");
            assert_eq!(baseline.over([-3.0, 3.0]), None);
            assert!(baseline.over([-40.0, 40.0]).is_some());
        }
    }

    #[test]
    fn text_beyond_the_end_is_measured() {
        let ends = [Point3::ORIGIN, Point3::new(10.0, 0.0, 0.0)];
        let line = SpaceCurve::new(ends, false).unwrap();
        let baseline = Baseline::new(&line, 4.0, false).unwrap();
        assert_eq!(baseline.over([0.0, 6.0]), None);
        assert!((baseline.over([0.0, 8.0]).unwrap() - 2.0).abs() < 1e-12);
        assert!((baseline.over([-5.0, 1.0]).unwrap() - 1.0).abs() < 1e-12);
        let upright = [
            Point3::ORIGIN,
            Point3::new(0.0, 0.0, 9.0),
            Point3::new(1.0, 0.0, 9.0),
        ];
        let upright = SpaceCurve::new(upright, false).unwrap();
        assert!(Baseline::new(&upright, 0.0, false).is_none());
    }
}
