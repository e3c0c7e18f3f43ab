//! A strip along a space curve: which way is across it at every place, and where a point of the
//! strip lies in space. Frames are rotation-minimizing; corners are mitred.

use serde::{Deserialize, Serialize};

use crate::{Point3, SpaceCurve};

/// The direction across a curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Across {
    /// In the curve's plane: to the left of an open curve, outward on a closed one. On a spatial curve, sideways in the
    /// rotation-minimizing frame.
    Plane,
    /// Out of the curve's plane. On a spatial curve, upward in the rotation-minimizing frame; on a surface, out of it.
    Normal,
    /// In the surface that the curve lies on.
    Surface,
    /// As near to this direction as the curve allows.
    Direction(Point3),
}

/// A place in the strip: an orthonormal frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The point of the curve.
    pub origin: Point3,
    /// Along the curve.
    pub tangent: Point3,
    /// Across it, the strip's own up.
    pub across: Point3,
    /// Out of the strip: `tangent` × `across`.
    pub normal: Point3,
}

/// Why there is no strip.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RibbonError {
    /// The curve lies on no surface.
    #[error("the curve lies on no surface")]
    NoSurface,
    /// The curve runs in the direction that should be across it.
    #[error("at ({}, {}, {}) the curve runs in the direction that should be across it", .0.x, .0.y, .0.z)]
    Parallel(Point3),
}

/// Where the strip folds over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fold {
    /// The place on the curve.
    pub at: Point3,
    /// The height of a strip that would not fold there.
    pub height: f64,
}

/// The strip along a curve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ribbon {
    curve: SpaceCurve,
    /// For each point of the curve, what one unit across is; longer than one at corners.
    across: Vec<Point3>,
    /// Out of the strip, of length one.
    normals: Vec<Point3>,
    /// The plane's normal, when the strip lies in a plane.
    plane: Option<Point3>,
}

/// Mitres are at most this long: sharper corners are cut short.
const LONGEST_MITRE: f64 = 4.0;

impl Ribbon {
    /// The strip along `curve` with its up pointing `across`, or to the other side where `flip` says so.
    ///
    /// # Errors
    /// [`RibbonError`] where there is no such direction.
    pub fn new(curve: SpaceCurve, across: Across, flip: bool) -> Result<Ribbon, RibbonError> {
        let tangents = tangents(&curve);
        let plane = curve.plane();
        let mut sideways = match across {
            Across::Surface if curve.normals().is_empty() => return Err(RibbonError::NoSurface),
            Across::Surface => project(curve.normals(), &tangents, &curve)?
                .iter()
                .zip(&tangents)
                .map(|(n, t)| n.cross(*t))
                .collect(),
            Across::Normal if !curve.normals().is_empty() => {
                project(curve.normals(), &tangents, &curve)?
            }
            Across::Direction(d) => project(&vec![d; tangents.len()], &tangents, &curve)?,
            Across::Plane | Across::Normal => {
                let up = plane.map_or_else(
                    || minimal(&curve, &tangents),
                    |normal| vec![normal; tangents.len()],
                );
                let level = matches!(across, Across::Plane);
                let outward =
                    level && curve.is_closed() && plane.is_some_and(|n| winding(&curve, n) > 0.0);
                let left =
                    |(n, t): (&Point3, &Point3)| if outward { t.cross(*n) } else { n.cross(*t) };
                if level {
                    up.iter().zip(&tangents).map(left).collect()
                } else {
                    up
                }
            }
        };
        for ((s, &t), &at) in sideways.iter_mut().zip(&tangents).zip(curve.lengths()) {
            *s = s.turned(t, curve.twist_at(at)) * if flip { -1.0 } else { 1.0 };
        }
        let normals: Vec<Point3> = tangents
            .iter()
            .zip(&sideways)
            .map(|(t, s)| t.cross(*s))
            .collect();
        let flat = plane.filter(|n| sideways.iter().all(|s| s.dot(*n).abs() < 1e-9));
        let across = mitred(&curve, &sideways);
        Ok(Ribbon {
            curve,
            across,
            normals,
            plane: flat,
        })
    }

    /// The curve in its middle.
    pub fn curve(&self) -> &SpaceCurve {
        &self.curve
    }

    /// The normal of the plane that the strip lies in, if it lies in one.
    pub fn plane(&self) -> Option<Point3> {
        self.plane
    }

    /// The point of space at `u` along the curve, `v` across it, and `w` out of the strip. On a closed curve u
    /// counts round and round; beyond the ends of an open one the strip goes on straight.
    pub fn place(&self, u: f64, v: f64, w: f64) -> Point3 {
        let (i, t) = self.locate(u);
        let at = |k: usize| self.curve.points()[k] + self.across[k] * v + self.normals[k] * w;
        at(i).lerp(at(i + 1), t)
    }

    /// The sign of `w` on the outer side of the strip, 1 or -1. O(n).
    ///
    /// The outer side of a flat strip is that to which the normal of its plane points, which is up where
    /// it can be. A strip in a surface has its outer side out of the surface. Any other stands along its
    /// curve, and its outer side faces away from the middle of the curve: a strip round a wrist has the
    /// wrist inside. Where the curve bends to no side, `w` itself points outward.
    pub fn outward(&self) -> f64 {
        if let Some(up) = self.plane {
            return sign(self.normals.iter().map(|n| n.dot(up)).sum());
        }
        let surface = self.curve.normals();
        let out: f64 = surface
            .iter()
            .zip(&self.normals)
            .map(|(s, n)| s.dot(*n))
            .sum();
        if out.abs() > 0.5 * self.normals.len() as f64 {
            return sign(out);
        }
        let (points, length) = (self.curve.points(), self.curve.length());
        let pieces = || {
            points
                .windows(2)
                .map(|w| (w[0].lerp(w[1], 0.5), w[0].distance(w[1])))
        };
        let sum = pieces().fold(Point3::new(0.0, 0.0, 0.0), |sum, (at, l)| sum + at * l);
        let middle = sum * (1.0 / length);
        let away = |((at, l), n): ((Point3, f64), &[Point3])| (at - middle).dot(n[0] + n[1]) * l;
        let away: f64 = pieces().zip(self.normals.windows(2)).map(away).sum();
        // Less is rounding: the curve is straight, or bends as much to one side as to the other.
        if away.abs() < 1e-9 * length * length {
            return 1.0;
        }
        sign(away)
    }

    /// The orthonormal frame at `u`.
    pub fn frame(&self, u: f64) -> Frame {
        let (i, t) = self.locate(u);
        let points = self.curve.points();
        let tangent = (points[i + 1] - points[i])
            .unit()
            .unwrap_or(Point3::new(1.0, 0.0, 0.0));
        let across = self.across[i].lerp(self.across[i + 1], t);
        let across = (across - tangent * tangent.dot(across))
            .unit()
            .unwrap_or(across);
        Frame {
            origin: points[i].lerp(points[i + 1], t),
            tangent,
            across,
            normal: tangent.cross(across),
        }
    }

    /// The places where the strip bends or is joined: between them it is ruled. In order, from 0 to the length.
    pub fn joints(&self) -> &[f64] {
        self.curve.lengths()
    }

    /// Where a strip of `height` folds over worst because the curve turns too sharply.
    pub fn fold(&self, height: f64) -> Option<Fold> {
        let points = self.curve.points();
        let mut worst: Option<Fold> = None;
        for i in 0..points.len() - 1 {
            let step = points[i + 1] - points[i];
            // The step at v across is step + v·change; it turns back where that has no part along the step.
            let rate = (self.across[i + 1] - self.across[i]).dot(step).abs() / step.dot(step);
            let most = if rate > 0.0 {
                2.0 / rate
            } else {
                f64::INFINITY
            };
            if most < height && worst.is_none_or(|w| most < w.height) {
                worst = Some(Fold {
                    at: points[i].lerp(points[i + 1], 0.5),
                    height: most,
                });
            }
        }
        worst
    }

    /// The piece of the curve at `u`, and how far along it that is.
    fn locate(&self, u: f64) -> (usize, f64) {
        let lengths = self.curve.lengths();
        let total = self.curve.length();
        let u = if self.curve.is_closed() {
            u - total * libm::floor(u / total)
        } else {
            u
        };
        let i = lengths
            .partition_point(|&s| s <= u)
            .clamp(1, lengths.len() - 1)
            - 1;
        (i, (u - lengths[i]) / (lengths[i + 1] - lengths[i]))
    }
}

fn sign(x: f64) -> f64 {
    if x < 0.0 { -1.0 } else { 1.0 }
}

/// On a surface, a direction is that of the chord over this part of the curve's length to either side.
const CHORD: f64 = 0.004;

/// The directions of a curve on a surface, whose polyline has a corner at every edge of the mesh.
fn chords(curve: &SpaceCurve) -> Option<Vec<Point3>> {
    let (points, lengths, total) = (curve.points(), curve.lengths(), curve.length());
    let at = |s: f64| {
        let s = if curve.is_closed() {
            s - total * libm::floor(s / total)
        } else {
            s.clamp(0.0, total)
        };
        let i = lengths
            .partition_point(|&l| l <= s)
            .clamp(1, lengths.len() - 1);
        points[i - 1].lerp(
            points[i],
            (s - lengths[i - 1]) / (lengths[i] - lengths[i - 1]),
        )
    };
    lengths
        .iter()
        .map(|&s| (at(s + CHORD * total) - at(s - CHORD * total)).unit())
        .collect()
}

/// The directions at the points: the mean of those of the neighbouring pieces.
fn tangents(curve: &SpaceCurve) -> Vec<Point3> {
    if let Some(smooth) = Some(curve)
        .filter(|c| !c.normals().is_empty())
        .and_then(chords)
    {
        return smooth;
    }
    let points = curve.points();
    let pieces: Vec<Point3> = points
        .windows(2)
        .filter_map(|w| (w[1] - w[0]).unit())
        .collect();
    let n = pieces.len();
    let around = |i: usize| match (i, curve.is_closed()) {
        (0, true) => (n - 1, 0),
        (0, false) => (0, 0),
        (i, true) if i == n => (n - 1, 0),
        (i, false) if i == n => (n - 1, n - 1),
        (i, _) => (i - 1, i),
    };
    (0..=n)
        .map(|i| {
            let (a, b) = around(i);
            // At a corner that turns right back any direction is as good.
            (pieces[a] + pieces[b]).unit().unwrap_or(pieces[b])
        })
        .collect()
}

/// The parts of `directions` at right angles to the curve.
fn project(
    directions: &[Point3],
    tangents: &[Point3],
    curve: &SpaceCurve,
) -> Result<Vec<Point3>, RibbonError> {
    let part = |((&d, &t), &p): ((&Point3, &Point3), &Point3)| {
        let aside = d - t * t.dot(d);
        let clear = aside.length() > 1e-6 * d.length();
        aside
            .unit()
            .filter(|_| clear)
            .ok_or(RibbonError::Parallel(p))
    };
    directions
        .iter()
        .zip(tangents)
        .zip(curve.points())
        .map(part)
        .collect()
}

/// Rotation-minimizing normals by double reflection (Wang, Jüttler, Zheng, Liu 2008). Around a closed curve what they fail to
/// meet by is spread over the length.
fn minimal(curve: &SpaceCurve, tangents: &[Point3]) -> Vec<Point3> {
    let points = curve.points();
    let t = tangents[0];
    let up = Point3::new(0.0, 0.0, 1.0);
    let guess = if t.dot(up).abs() < 0.999 {
        up
    } else {
        Point3::new(1.0, 0.0, 0.0)
    };
    let mut normal = (guess - t * t.dot(guess)).unit().unwrap_or(guess);
    let mut normals = vec![normal];
    for i in 0..points.len() - 1 {
        let reflect = |x: Point3, mirror: Point3| {
            let c = mirror.dot(mirror);
            if c > 0.0 {
                x - mirror * (2.0 * mirror.dot(x) / c)
            } else {
                x
            }
        };
        let chord = points[i + 1] - points[i];
        let (n, t) = (reflect(normal, chord), reflect(tangents[i], chord));
        let next = reflect(n, tangents[i + 1] - t);
        normal = (next - tangents[i + 1] * tangents[i + 1].dot(next))
            .unit()
            .unwrap_or(normal);
        normals.push(normal);
    }
    if curve.is_closed() {
        let (first, last) = (normals[0], normals[normals.len() - 1]);
        let off = libm::atan2(last.cross(first).dot(tangents[0]), last.dot(first));
        for ((n, &t), &s) in normals.iter_mut().zip(tangents).zip(curve.lengths()) {
            *n = n.turned(t, off * s / curve.length());
        }
    }
    normals
}

/// Twice the area that the curve goes round, positive counter-clockwise about `normal`.
fn winding(curve: &SpaceCurve, normal: Point3) -> f64 {
    let points = curve.points();
    points
        .windows(2)
        .map(|w| (w[0] - points[0]).cross(w[1] - points[0]).dot(normal))
        .sum()
}

/// The directions across, lengthened at corners so that the borders of the strip keep their distance from the curve.
fn mitred(curve: &SpaceCurve, sideways: &[Point3]) -> Vec<Point3> {
    let points = curve.points();
    let n = points.len() - 1;
    let pieces: Vec<Option<Point3>> = points.windows(2).map(|w| (w[1] - w[0]).unit()).collect();
    let lengthen = |(i, &s): (usize, &Point3)| {
        let before = if i > 0 {
            pieces[i - 1]
        } else if curve.is_closed() {
            pieces[n - 1]
        } else {
            None
        };
        let after = if i < n {
            pieces[i]
        } else if curve.is_closed() {
            pieces[0]
        } else {
            None
        };
        let (Some(before), Some(after)) = (before, after) else {
            return s;
        };
        let Some(turn) = (after - before).unit() else {
            return s;
        };
        let half = ((1.0 + before.dot(after)) / 2.0).max(0.0).sqrt();
        s + turn * (s.dot(turn) * ((1.0 / half).min(LONGEST_MITRE) - 1.0))
    };
    sideways.iter().enumerate().map(lengthen).collect()
}

#[cfg(test)]
mod tests;
