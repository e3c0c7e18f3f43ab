//! Where the points of a facade stand in space: in a plane, or along a curve.

use super::divide::divided;
use fretwork_geometry::mesh::Body;
use fretwork_geometry::{Affine3, Facade, FacadeCell, Point3, SpaceCurve};

/// The greatest difference, as a part of its width, between a facade and a curve that it is stretched
/// to. A facade around a closed curve must meet itself, and its width is written with few digits; a
/// larger difference is rather a mistake.
const STRETCH: f64 = 0.01;
/// The greatest distance of a mitred corner from the corner of the curve, in offsets. Without a limit,
/// the corner of a sharp bend would be far away; a lesser one would shorten corners of 30° and more.
const LONGEST_MITER: f64 = 4.0;
/// How far aside a corner's offset goes for one unit: the tangent of half its bend. Lesser ones, up to about 10°, are those of
/// a curve.
const CORNER: f64 = 0.09;

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
    /// The facade would fold over itself on the inside of a bend.
    #[error("the curve bends too sharply for what stands {offset} out of it")]
    TooSharp {
        /// The distance from the curve.
        offset: f64,
    },
}

/// A map from the coordinates of a facade to space: u is to the right, v up, w out of its plane.
#[derive(Clone, Debug)]
pub enum Bend {
    /// The facade lies in a plane.
    Flat(Affine3),
    /// The facade follows a curve: v is along the normal of its plane, w to its right as seen from there.
    Along(Track),
}

/// A curve with its offsets.
#[derive(Clone, Debug)]
pub struct Track {
    points: Vec<Point3>,
    /// The offset of each point for one unit of w.
    outward: Vec<Point3>,
    /// The coordinate u of each point.
    at: Vec<f64>,
    up: Point3,
    is_around: bool,
}

/// What of a facade decides where a mitre ends.
#[derive(Clone, Copy, Debug)]
pub struct Columns<'a> {
    /// The borders between columns, ascending.
    pub borders: &'a [f64],
    /// How far things stand out of the facade, and into it.
    pub reach: [f64; 2],
}

impl Track {
    /// The same with a point of its own where, on the sides next to a corner, the first border between columns comes that lies
    /// beyond the mitre. Offsets go straight out of it.
    fn straightened(self, columns: &Columns<'_>) -> Track {
        let last = self.points.len() - 1;
        let mut made = Track {
            points: Vec::new(),
            outward: Vec::new(),
            at: Vec::new(),
            ..self
        };
        let mut push = |point: Point3, outward: Point3, at: f64| {
            made.points.push(point);
            made.outward.push(outward);
            made.at.push(at);
        };
        for i in 0..last {
            push(self.points[i], self.outward[i], self.at[i]);
            let Some(normal) = self.normal(i) else {
                continue;
            };
            let [from, to] = [self.at[i], self.at[i + 1]];
            let ahead = self.points[i + 1] - self.points[i];
            // How far the mitres go along the side for one unit to the front.
            let along = |end: usize| self.outward[end].dot(ahead) / ahead.length();
            let [after, before] = [along(i), -along(i + 1)];
            // More than what the mitre takes, so that a third of what is cut askew is left.
            let room = |aside: f64| {
                let [out, into] = columns.reach;
                1.5 * (aside * out).max(-aside * into) + 1e-6 * (to - from)
            };
            let (first, end) = (from + room(after), to - room(before));
            let within = |border: &&f64| **border > first && **border < end;
            let first = columns.borders.iter().find(within);
            let end = columns.borders.iter().rfind(within);
            let first = first.filter(|_| after.abs() > CORNER);
            let end = end.filter(|end| before.abs() > CORNER && first != Some(*end));
            for border in first.into_iter().chain(end) {
                let t = (border - from) / (to - from);
                push(self.points[i].lerp(self.points[i + 1], t), normal, *border);
            }
        }
        push(self.points[last], self.outward[last], self.at[last]);
        made
    }

    /// The direction out of a side.
    fn normal(&self, side: usize) -> Option<Point3> {
        (self.points[side + 1] - self.points[side])
            .cross(self.up)
            .unit()
    }
}

impl Bend {
    /// Along the curve of a facade with a back so thick, or `flat` if it has no curve.
    ///
    /// # Errors
    /// The curve is not planar or too short.
    pub fn of(facade: &Facade, flat: Bend, back: f64) -> Result<Bend, BendError> {
        let [out, into] = facade.reach();
        let columns = Columns {
            borders: &facade.layout.x,
            reach: [out, into + back],
        };
        let along = |curve: &SpaceCurve| Bend::along(curve, facade.layout.width, &columns);
        facade.wrap.as_ref().map_or(Ok(flat), along)
    }

    /// Upright: u is x, and v is z, as seen from -y.
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

    /// Along `curve`, from its begin. A facade that is about as wide as the curve is long is stretched to
    /// it. What stands between a corner and the columns next to it is cut askew by the mitre there, and what stands elsewhere
    /// on a straight side is as it is.
    ///
    /// # Errors
    /// The curve is not planar or too short.
    pub fn along(curve: &SpaceCurve, width: f64, columns: &Columns<'_>) -> Result<Bend, BendError> {
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
        let track = Track {
            points,
            outward,
            at,
            up,
            is_around: fits && curve.is_closed(),
        };
        Ok(Bend::Along(track.straightened(columns)))
    }

    /// Whether the end of the facade meets its begin.
    pub fn is_around(&self) -> bool {
        matches!(self, Bend::Along(track) if track.is_around)
    }

    /// The point with the coordinates (u, v, w).
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

    /// The values of u between `from` and `to` at which the facade bends; those very near to the two are
    /// left out.
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

    /// The left and right sides of a cell, and the values of u between them at which the facade bends.
    pub fn columns(&self, cell: &FacadeCell) -> Vec<f64> {
        let (left, right) = (cell.x, cell.x + cell.width);
        std::iter::once(left)
            .chain(self.cuts(left, right))
            .chain(std::iter::once(right))
            .collect()
    }

    /// Checks that the surface at distance `w` keeps its order along the curve between two coordinates.
    ///
    /// # Errors
    /// The surface folds over itself.
    pub fn check(&self, [from, to]: [f64; 2], w: f64) -> Result<(), BendError> {
        let Bend::Along(track) = self else {
            return Ok(());
        };
        for i in 0..track.points.len() - 1 {
            let along = track.points[i + 1] - track.points[i];
            let moved = along + (track.outward[i + 1] - track.outward[i]) * w;
            let is_met = track.at[i] < to && track.at[i + 1] > from;
            if is_met && moved.dot(along) <= 0.0 {
                return Err(BendError::TooSharp { offset: w });
            }
        }
        Ok(())
    }

    /// A body in the facade's coordinates, moved to where it stands in space, and divided where the facade
    /// bends.
    ///
    /// # Errors
    /// It would fold over itself.
    pub fn bent(&self, body: Body) -> Result<Body, BendError> {
        let bounds = body.mesh.bounds();
        let across = [bounds.min.x, bounds.max.x];
        for w in [bounds.min.z, bounds.max.z] {
            self.check(across, w)?;
        }
        let cuts = self.cuts(bounds.min.x, bounds.max.x);
        Ok(self.moved(divided(body, &cuts)))
    }

    /// A body in the facade's coordinates whose triangles cross no bend, moved to where it stands in space.
    pub fn moved(&self, mut body: Body) -> Body {
        for p in &mut body.mesh.positions {
            *p = self.place(p.x, p.y, p.z);
        }
        body
    }
}

/// The offset of each point for one unit to the right. Corners are mitred, so that faces stay parallel.
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

    fn columns(borders: &[f64]) -> Columns<'_> {
        Columns {
            borders,
            reach: [0.6, 0.4],
        }
    }

    #[test]
    fn a_circle_is_walked_with_its_outside_in_front() {
        let circle = SpaceCurve::circle(10.0).unwrap();
        let bend = Bend::along(&circle, 62.8, &columns(&[0.0, 31.45, 62.8])).unwrap();
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
        let check = |w: f64| bend.check([0.0, 62.8], w);
        assert!(check(-9.9).is_ok() && check(-10.1).is_err() && check(99.0).is_ok());
        assert_eq!(bend.cuts(0.0, 62.8).len(), 719);
    }

    #[test]
    fn corners_are_mitred() {
        let corner = [[0., 0., 0.], [4., 0., 0.], [4., 3., 0.]].map(Point3::from);
        let bend =
            Bend::along(&SpaceCurve::new(corner, false).unwrap(), 7.0, &columns(&[])).unwrap();
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
    fn what_stands_away_from_corners_of_a_polygon_is_as_it_is() {
        let square = [[0., 0.], [6., 0.], [6., 4.], [0., 4.], [0., 0.]];
        let square = square.map(|[x, y]| Point3::new(x, y, 0.0));
        let curve = SpaceCurve::new(square, true).unwrap();
        let borders: Vec<f64> = (0..=20).map(f64::from).collect();
        for w in [-0.4, 0.6] {
            let bend = Bend::along(&curve, 20.0, &columns(&borders)).unwrap();
            for u in [1.0, 2.3, 5.0] {
                let at = Point3::new(u, -w, 0.0);
                assert!(bend.place(u, 0.0, w).distance(at) < 1e-12, "{u} {w}");
            }
            for u in [7.0, 8.5, 9.0] {
                let at = Point3::new(6.0 + w, u - 6.0, 0.0);
                assert!(bend.place(u, 0.0, w).distance(at) < 1e-12, "{u} {w}");
            }
            // Corners are mitred, and what is between is cut askew.
            assert!(
                bend.place(6.0, 0.0, w)
                    .distance(Point3::new(6.0 + w, -w, 0.0))
                    < 1e-12
            );
            assert!(bend.place(20.0, 0.0, w).distance(Point3::new(-w, -w, 0.0)) < 1e-12);
            let between = Point3::new(0.5 - 0.5 * w, -w, 0.0);
            assert!(bend.place(0.5, 0.0, w).distance(between) < 1e-12);
            assert!(bend.check([0.0, 20.0], w).is_ok());
        }
    }

    #[test]
    fn curves_that_do_not_fit_are_refused() {
        let circle = SpaceCurve::circle(10.0).unwrap();
        assert!(matches!(
            Bend::along(&circle, 70.0, &columns(&[])),
            Err(BendError::TooLong { .. })
        ));
        assert!(
            !Bend::along(&circle, 30.0, &columns(&[]))
                .unwrap()
                .is_around()
        );
        let twisted = [[0., 0., 0.], [4., 0., 0.], [4., 3., 0.], [4., 3., 9.]].map(Point3::from);
        assert_eq!(
            Bend::along(
                &SpaceCurve::new(twisted, false).unwrap(),
                7.0,
                &columns(&[])
            )
            .err(),
            Some(BendError::NotPlanar)
        );
    }
}
