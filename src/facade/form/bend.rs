//! Where the points of a facade stand in space: flat, or bent along a curve.

use fretwork_geometry::{Affine3, Point3, SpaceCurve};

/// How far the width of a facade may be from the length of its curve to be stretched to it.
const STRETCH: f64 = 0.01;
/// The farthest that an offset corner may be, in offsets.
const LONGEST_MITER: f64 = 4.0;

/// Why a facade cannot be laid along a curve.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BendError {
    /// The curve leaves its plane.
    #[error("the curve does not lie in a plane")]
    NotPlanar,
    /// The facade is wider than the curve is long.
    #[error("the facade is {width} wide, but the curve is only {length} long")]
    TooLong {
        /// The width of the facade.
        width: f64,
        /// The length of the curve.
        length: f64,
    },
    /// The facade folds over itself on the inside of a bend.
    #[error("the curve bends too sharply for what stands {offset} out of it")]
    TooSharp {
        /// How far out of the curve that is.
        offset: f64,
    },
}

/// From the coordinates of a facade (u to the right, v up, w out of its plane) to space.
#[derive(Clone, Debug)]
pub enum Bend {
    /// In a plane.
    Flat(Affine3),
    /// Along a curve: v is along the normal of its plane, w to its right as seen from there.
    Along(Track),
}

/// A curve with its offsets.
#[derive(Clone, Debug)]
pub struct Track {
    points: Vec<Point3>,
    /// What one unit of w adds at each point.
    outward: Vec<Point3>,
    /// The places of the points along the facade.
    at: Vec<f64>,
    up: Point3,
    is_around: bool,
}

impl Bend {
    /// Upright: u is x, v is z, seen from -y.
    pub fn upright() -> Bend {
        let axes = Affine3::IDENTITY;
        Bend::Flat(Affine3 {
            x: axes.x,
            y: axes.z,
            z: -axes.y,
            origin: Point3::ORIGIN,
        })
    }

    /// Lying on its back: u is x, v is y, w is z.
    pub fn lying() -> Bend {
        Bend::Flat(Affine3::IDENTITY)
    }

    /// Along `curve`, from its begin. A facade about as wide as the curve is long is stretched to it.
    ///
    /// # Errors
    /// The curve is not planar or too short.
    pub fn along(curve: &SpaceCurve, width: f64) -> Result<Bend, BendError> {
        let up = curve.plane().ok_or(BendError::NotPlanar)?;
        let length = curve.length();
        let fits = (length - width).abs() <= STRETCH * width;
        if width > length && !fits {
            return Err(BendError::TooLong { width, length });
        }
        let factor = if fits { width / length } else { 1.0 };
        let points = curve.points().to_vec();
        let mut at: Vec<f64> = curve.lengths().iter().map(|s| s * factor).collect();
        if let Some(last) = at.last_mut().filter(|_| fits) {
            *last = width;
        }
        let outward = outward(&points, up, curve.is_closed());
        Ok(Bend::Along(Track {
            points,
            outward,
            at,
            up,
            is_around: fits && curve.is_closed(),
        }))
    }

    /// Whether the end of the facade is its begin.
    pub fn is_around(&self) -> bool {
        matches!(self, Bend::Along(track) if track.is_around)
    }

    /// Where the point (u, v, w) stands.
    pub fn place(&self, u: f64, v: f64, w: f64) -> Point3 {
        match self {
            Bend::Flat(map) => map.apply(Point3::new(u, v, w)),
            Bend::Along(track) => {
                let last = track.points.len() - 2;
                let i = track
                    .at
                    .partition_point(|s| *s <= u)
                    .saturating_sub(1)
                    .min(last);
                let t = ((u - track.at[i]) / (track.at[i + 1] - track.at[i])).clamp(0.0, 1.0);
                let end = |i: usize| track.points[i] + track.outward[i] * w;
                let foot = match t {
                    0.0 => end(i),
                    1.0 => end(i + 1),
                    _ => end(i).lerp(end(i + 1), t),
                };
                foot + track.up * v
            }
        }
    }

    /// The direction of v.
    pub fn up(&self) -> Point3 {
        match self {
            Bend::Flat(map) => map.y,
            Bend::Along(track) => track.up,
        }
    }

    /// The places strictly between `from` and `to` where the facade bends, with some distance to both.
    pub fn cuts(&self, from: f64, to: f64) -> Vec<f64> {
        let Bend::Along(track) = self else {
            return Vec::new();
        };
        let slack = 1e-6 * (to - from);
        track
            .at
            .iter()
            .copied()
            .filter(|s| *s > from + slack && *s < to - slack)
            .collect()
    }

    /// Whether what stands `w` out of the plane up to the place `width` keeps its order along the curve.
    ///
    /// # Errors
    /// It folds over itself.
    pub fn check(&self, width: f64, w: f64) -> Result<(), BendError> {
        let Bend::Along(track) = self else {
            return Ok(());
        };
        for i in 0..track.points.len() - 1 {
            let along = track.points[i + 1] - track.points[i];
            let moved = along + (track.outward[i + 1] - track.outward[i]) * w;
            if track.at[i] < width && moved.dot(along) <= 0.0 {
                return Err(BendError::TooSharp { offset: w });
            }
        }
        Ok(())
    }
}

/// What one unit of offset to the right adds at each point: corners are mitred, so that faces stay parallel.
fn outward(points: &[Point3], up: Point3, closed: bool) -> Vec<Point3> {
    let sides: Vec<Point3> = points
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).cross(up).unit().unwrap_or_default())
        .collect();
    let joined = |a: Point3, b: Point3| {
        (a + b) * (1.0 / (1.0 + a.dot(b)).max(2.0 / (LONGEST_MITER * LONGEST_MITER)))
    };
    let (first, last) = (sides[0], sides[sides.len() - 1]);
    let ends = if closed {
        [joined(last, first); 2]
    } else {
        [joined(first, first), joined(last, last)]
    };
    let inner = sides.windows(2).map(|pair| joined(pair[0], pair[1]));
    std::iter::once(ends[0])
        .chain(inner)
        .chain(std::iter::once(ends[1]))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_is_walked_with_its_outside_in_front() {
        let circle = SpaceCurve::circle(10.0).unwrap();
        let bend = Bend::along(&circle, 62.8).unwrap();
        assert!(bend.is_around());
        assert!(
            bend.place(0.0, 2.0, 1.0)
                .distance(Point3::new(11.0, 0.0, 2.0))
                < 1e-3
        );
        assert!(
            bend.place(15.7, 0.0, -1.0)
                .distance(Point3::new(0.0, 9.0, 0.0))
                < 1e-3
        );
        assert_eq!(bend.place(62.8, 3.0, 0.5), bend.place(0.0, 3.0, 0.5));
        assert!(
            bend.check(62.8, -9.9).is_ok()
                && bend.check(62.8, -10.1).is_err()
                && bend.check(62.8, 99.0).is_ok()
        );
        assert_eq!(bend.cuts(0.0, 62.8).len(), 719);
    }

    #[test]
    fn corners_are_mitred() {
        let corner = [[0., 0., 0.], [4., 0., 0.], [4., 3., 0.]].map(Point3::from);
        let bend = Bend::along(&SpaceCurve::new(corner, false).unwrap(), 7.0).unwrap();
        assert!(
            bend.place(4.0, 0.0, 1.0)
                .distance(Point3::new(5.0, -1.0, 0.0))
                < 1e-12
        );
        assert!(
            bend.place(0.0, 1.0, 1.0)
                .distance(Point3::new(0.0, -1.0, 1.0))
                < 1e-12
        );
        assert!(
            bend.place(7.0, 0.0, 1.0)
                .distance(Point3::new(5.0, 3.0, 0.0))
                < 1e-12
        );
        assert_eq!(bend.cuts(1.0, 6.0), [4.0]);
    }

    #[test]
    fn curves_that_do_not_fit_are_refused() {
        let circle = SpaceCurve::circle(10.0).unwrap();
        assert!(matches!(
            Bend::along(&circle, 70.0),
            Err(BendError::TooLong { .. })
        ));
        assert!(!Bend::along(&circle, 30.0).unwrap().is_around());
        let twisted = [[0., 0., 0.], [4., 0., 0.], [4., 3., 0.], [4., 3., 9.]].map(Point3::from);
        assert_eq!(
            Bend::along(&SpaceCurve::new(twisted, false).unwrap(), 7.0).err(),
            Some(BendError::NotPlanar)
        );
    }
}
