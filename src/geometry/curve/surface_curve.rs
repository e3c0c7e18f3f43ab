//! Smooth curves on triangle meshes, through points. How ways over a mesh are found is in `mesh::paths`.

use crate::mesh::nearest::{Foot, Nearest};
use crate::mesh::paths::Paths;
use crate::mesh::{Mesh, corner_normals};
use crate::{Point3, SpaceCurve, SpaceCurveError};

/// A curve on a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceCurve {
    /// The curve, with the surface's normals, smoothed.
    pub curve: SpaceCurve,
    /// How far each point had to be moved to the surface.
    pub moved: Vec<f64>,
}

/// Why there is no curve on the surface.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceCurveError {
    /// The mesh has no triangles, or corners that do not exist or are not finite.
    #[error("the surface has no triangles, or broken ones")]
    Broken,
    /// A point is not finite.
    #[error("a point of the curve is not finite")]
    NotFinite,
    /// Too few points.
    #[error("{0} points are too few for a curve")]
    TooFew(usize),
    /// The surface has several parts, and two neighbouring points lie on different ones.
    #[error("no way leads over the surface from point {0} to the next one")]
    Apart(usize),
    /// The points are too near to one another.
    #[error(transparent)]
    Curve(#[from] SpaceCurveError),
}

/// Samples between two points at first.
const FIRST: f64 = 6.0;
/// Samples of the finished curve, about.
const SAMPLES: f64 = 600.0;
/// Steps of smoothing with the first samples; each doubling of their number halves it.
const STEPS: usize = 400;
/// The weight of a step; below an eighth it is stable.
const WEIGHT: f64 = 0.1;
/// Crossings nearer to other points than this part of a step are left out.
const NEAR: f64 = 0.02;
/// Normals are averaged over this part of the curve, to each side.
const WINDOW: f64 = 0.03;

/// The curve of least bending on the surface through `points`, each moved to the surface's nearest place.
///
/// A minimizing spline in a manifold (Hofer, Pottmann 2004): short ways from point to point, sampled ever
/// more finely, are smoothed by steps against the gradient of the sum of squared second differences, and every step is put back
/// onto the surface. Unlike a spline in a planar parameterization it works on closed surfaces, round handles, and for loops round
/// the surface. Between samples the crossed edges are added, so that all of the polyline lies on the surface. Normals
/// are averaged on the sphere of directions (Zhou 2014, section 6.3), so that frames turn smoothly over facets.
///
/// # Errors
/// A broken mesh, points that are too few or not finite, and points between which no way leads.
pub fn surface_curve(
    mesh: &Mesh,
    points: &[Point3],
    closed: bool,
) -> Result<SurfaceCurve, SurfaceCurveError> {
    mesh.validate().map_err(|_| SurfaceCurveError::Broken)?;
    if points.iter().any(|p| !p.is_finite()) {
        return Err(SurfaceCurveError::NotFinite);
    }
    let mesh = mesh.welded();
    let tree = Nearest::new(&mesh);
    let feet: Option<Vec<Foot>> = points.iter().map(|&p| tree.foot(p)).collect();
    let feet = feet.ok_or(SurfaceCurveError::Broken)?;
    let mut knots = feet.clone();
    knots.dedup_by(|a, b| a.at == b.at);
    if closed && knots.len() > 1 && knots[0].at == knots[knots.len() - 1].at {
        knots.pop();
    }
    if knots.len() < if closed { 3 } else { 2 } {
        return Err(SurfaceCurveError::TooFew(knots.len()));
    }
    let paths = Paths::new(&mesh);
    let mut samples = Samples::new(&paths, &knots, closed)?;
    let mut steps = STEPS;
    loop {
        samples.smooth(&tree, steps);
        if samples.feet.len() as f64 >= SAMPLES {
            break;
        }
        samples.double(&tree);
        steps = (steps / 2).max(20);
    }
    let (points, normals) = samples.finish(&mesh, &paths, &tree);
    let curve = SpaceCurve::on_surface(&points, &normals, closed)?;
    Ok(SurfaceCurve {
        curve,
        moved: feet.iter().map(|f| f.distance).collect(),
    })
}

/// Places along a curve; some of them stay.
struct Samples {
    feet: Vec<Foot>,
    stays: Vec<bool>,
    closed: bool,
}

impl Samples {
    fn new(paths: &Paths, knots: &[Foot], closed: bool) -> Result<Samples, SurfaceCurveError> {
        let count = if closed { knots.len() } else { knots.len() - 1 };
        let ways: Vec<Vec<Point3>> = (0..count)
            .map(|i| {
                paths
                    .short(&knots[i], &knots[(i + 1) % knots.len()])
                    .ok_or(SurfaceCurveError::Apart(i))
            })
            .collect::<Result<_, _>>()?;
        let lengths: Vec<f64> = ways.iter().map(|w| length(w)).collect();
        let mean = lengths.iter().sum::<f64>() / count as f64;
        let mut samples = Samples {
            feet: Vec::new(),
            stays: Vec::new(),
            closed,
        };
        for (i, (way, length)) in ways.iter().zip(&lengths).enumerate() {
            let parts = libm::round(FIRST * length / mean).clamp(2.0, 60.0) as usize;
            samples.feet.push(knots[i]);
            samples.stays.push(true);
            for k in 1..parts {
                let at = at_length(way, length * k as f64 / parts as f64);
                samples.feet.push(Foot {
                    at,
                    triangle: knots[i].triangle,
                    distance: 0.0,
                });
                samples.stays.push(false);
            }
        }
        if !closed {
            samples.feet.push(knots[knots.len() - 1]);
            samples.stays.push(true);
        }
        Ok(samples)
    }

    /// The place `by` samples after number `i`, if there is one.
    fn at(&self, i: usize, by: isize) -> Option<Point3> {
        let n = self.feet.len() as isize;
        let k = i as isize + by;
        let k = if self.closed { k.rem_euclid(n) } else { k };
        (0..n).contains(&k).then(|| self.feet[k as usize].at)
    }

    fn smooth(&mut self, tree: &Nearest, steps: usize) {
        let n = self.feet.len();
        for _ in 0..steps {
            let second = |i: usize| match (self.at(i, -1), self.at(i, 1)) {
                (Some(a), Some(b)) => a + b - self.feet[i].at * 2.0,
                _ => Point3::ORIGIN,
            };
            let bends: Vec<Point3> = (0..n).map(second).collect();
            let bend = |i: usize, by: isize| {
                let k = i as isize + by;
                let k = if self.closed {
                    k.rem_euclid(n as isize)
                } else {
                    k
                };
                usize::try_from(k)
                    .ok()
                    .and_then(|k| bends.get(k))
                    .copied()
                    .unwrap_or(Point3::ORIGIN)
            };
            let moved: Vec<Foot> = (0..n)
                .map(|i| {
                    let gradient = bend(i, -1) + bend(i, 1) - bends[i] * 2.0;
                    let to = self.feet[i].at - gradient * WEIGHT;
                    if self.stays[i] {
                        self.feet[i]
                    } else {
                        tree.foot(to).unwrap_or(self.feet[i])
                    }
                })
                .collect();
            self.feet = moved;
        }
    }

    /// Puts a sample between any two (by the four-point rule of Dyn, Levin, Gregory 1987).
    fn double(&mut self, tree: &Nearest) {
        let n = self.feet.len();
        let (mut feet, mut stays) = (Vec::with_capacity(2 * n), Vec::with_capacity(2 * n));
        for i in 0..n {
            feet.push(self.feet[i]);
            stays.push(self.stays[i]);
            let Some(next) = self.at(i, 1) else { continue };
            let here = self.feet[i].at;
            let before = self.at(i, -1).unwrap_or(here * 2.0 - next);
            let after = self.at(i, 2).unwrap_or(next * 2.0 - here);
            let between = (here + next) * (9.0 / 16.0) - (before + after) * (1.0 / 16.0);
            feet.push(tree.foot(between).unwrap_or(self.feet[i]));
            stays.push(false);
        }
        (self.feet, self.stays) = (feet, stays);
    }

    /// The places with all crossed edges between them, and smooth normals.
    fn finish(&self, mesh: &Mesh, paths: &Paths, tree: &Nearest) -> (Vec<Point3>, Vec<Point3>) {
        let n = self.feet.len();
        // Smoothing has left no triangle numbers at samples that never moved.
        let feet: Vec<Foot> = self
            .feet
            .iter()
            .map(|f| tree.foot(f.at).unwrap_or(*f))
            .collect();
        let corners = corner_normals(mesh, -1.0);
        let mut points: Vec<Point3> = Vec::new();
        let mut normals: Vec<Point3> = Vec::new();
        for i in 0..n {
            points.push(feet[i].at);
            normals.push(normal_at(mesh, &corners, &feet[i]));
            if i + 1 < n || self.closed {
                let next = &feet[(i + 1) % n];
                let crossings = paths.crossings(&feet[i], next).unwrap_or_default();
                let (a, b) = (normals[normals.len() - 1], normal_at(mesh, &corners, next));
                for p in crossings {
                    let t = p.distance(feet[i].at)
                        / (p.distance(feet[i].at) + p.distance(next.at)).max(1e-300);
                    // Crossings near a corner of the mesh would be the same place over and over.
                    let apart = NEAR * feet[i].at.distance(next.at);
                    if p.distance(points[points.len() - 1]) > apart && p.distance(next.at) > apart {
                        points.push(p);
                        normals.push(a.lerp(b, t));
                    }
                }
            }
        }
        let smooth = smoothed(&points, &normals, self.closed);
        (points, smooth)
    }
}

/// The surface's smooth normal at a place.
fn normal_at(mesh: &Mesh, corners: &[[Point3; 3]], foot: &Foot) -> Point3 {
    let [a, b, c] = mesh.corners(mesh.triangles[foot.triangle as usize]);
    let area = |p: Point3, q: Point3, r: Point3| (q - p).cross(r - p).length();
    let (x, y, z) = (
        area(foot.at, b, c),
        area(foot.at, c, a),
        area(foot.at, a, b),
    );
    let [p, q, r] = corners[foot.triangle as usize];
    (p * x + q * y + r * z).unit().unwrap_or(p)
}

/// The normals averaged along the curve, with weights that fall off linearly.
fn smoothed(points: &[Point3], normals: &[Point3], closed: bool) -> Vec<Point3> {
    let n = points.len();
    let mut lengths = vec![0.0];
    let last = if closed { n } else { n - 1 };
    for i in 0..last {
        lengths.push(lengths[i] + points[i].distance(points[(i + 1) % n]));
    }
    let total = lengths[last];
    let reach = WINDOW * total;
    // Each sample stands for the length up to its neighbours.
    let share = |k: usize| {
        let after = if k < last {
            lengths[k + 1] - lengths[k]
        } else {
            0.0
        };
        let before = match k.checked_sub(1) {
            Some(before) => lengths[k] - lengths[before],
            None if closed => total - lengths[n - 1],
            None => 0.0,
        };
        0.5 * (after + before)
    };
    let mean = |i: usize| {
        let mut sum = normals[i] * share(i).max(1e-300);
        for step in [1, n - 1] {
            let mut k = i;
            loop {
                let next = k + step;
                if !closed && (next == n && step == 1 || k == 0 && step != 1) {
                    break;
                }
                k = next % n;
                let apart = (lengths[k] - lengths[i]).abs();
                let apart = if closed {
                    apart.min(total - apart)
                } else {
                    apart
                };
                if apart >= reach || k == i {
                    break;
                }
                sum = sum + normals[k] * (share(k) * (1.0 - apart / reach));
            }
        }
        sum.unit().unwrap_or(normals[i])
    };
    (0..n).map(mean).collect()
}

fn length(way: &[Point3]) -> f64 {
    way.windows(2).map(|w| w[0].distance(w[1])).sum()
}

/// The place after a part of a way.
fn at_length(way: &[Point3], mut rest: f64) -> Point3 {
    for w in way.windows(2) {
        let step = w[0].distance(w[1]);
        if rest <= step {
            return if step > 0.0 {
                w[0].lerp(w[1], rest / step)
            } else {
                w[0]
            };
        }
        rest -= step;
    }
    way[way.len() - 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sphere of `n` by `2 n` pieces; poles are corners.
    fn ball(radius: f64, n: u32) -> Mesh {
        let pi = std::f64::consts::PI;
        let at = |i: u32, j: u32| {
            let (a, b) = (
                pi * f64::from(i) / f64::from(n),
                pi * f64::from(j) / f64::from(n),
            );
            Point3::new(
                libm::sin(a) * libm::cos(b),
                libm::sin(a) * libm::sin(b),
                libm::cos(a),
            ) * radius
        };
        let mut mesh = Mesh::default();
        for i in 0..=n {
            mesh.positions.extend((0..2 * n).map(|j| at(i, j)));
        }
        let number = |i: u32, j: u32| i * 2 * n + j % (2 * n);
        for i in 0..n {
            for j in 0..2 * n {
                let (a, b, c, d) = (
                    number(i, j),
                    number(i + 1, j),
                    number(i + 1, j + 1),
                    number(i, j + 1),
                );
                mesh.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        for i in 0..2 * n {
            mesh.positions[i as usize] = Point3::new(0.0, 0.0, radius);
            let last = (n * 2 * n + i) as usize;
            mesh.positions[last] = Point3::new(0.0, 0.0, -radius);
        }
        mesh.welded()
    }

    fn turn(a: f64, z: f64, r: f64) -> Point3 {
        Point3::new(r * libm::cos(a), r * libm::sin(a), z)
    }

    #[test]
    fn all_of_the_curve_lies_on_the_surface_and_frames_are_smooth() {
        let mesh = ball(30.0, 24);
        let points = [
            turn(0.0, -10.0, 30.0),
            turn(1.5, 5.0, 30.0),
            turn(3.0, 15.0, 28.0),
            turn(4.5, 0.0, 30.0),
        ];
        let found = surface_curve(&mesh, &points, false).unwrap();
        let tree = Nearest::new(&mesh);
        let line = found.curve.points();
        for w in line.windows(2) {
            for t in [0.0, 0.5] {
                let p = w[0].lerp(w[1], t);
                assert!(
                    tree.foot(p).unwrap().distance < 0.02,
                    "{p:?} {:?}",
                    tree.foot(p)
                );
            }
        }
        for p in points {
            let near = line
                .iter()
                .map(|q| q.distance(tree.foot(p).unwrap().at))
                .fold(f64::INFINITY, f64::min);
            assert!(near < 1e-9);
        }
        // No corner, and normals that follow.
        let units: Vec<Point3> = line
            .windows(2)
            .filter_map(|w| (w[1] - w[0]).unit())
            .collect();
        assert!(units.windows(2).all(|w| w[0].dot(w[1]) > 0.97));
        assert!(
            found
                .curve
                .normals()
                .windows(2)
                .all(|w| w[0].dot(w[1]) > 0.995)
        );
        for (p, n) in line.iter().zip(found.curve.normals()) {
            assert!(p.unit().unwrap().dot(*n) > 0.99);
        }
    }

    #[test]
    fn a_loop_goes_round_the_surface() {
        let mesh = ball(30.0, 16);
        let points: Vec<Point3> = (0..4)
            .map(|i| turn(f64::from(i) * 1.5, 0.0, 30.0))
            .collect();
        let found = surface_curve(&mesh, &points, true).unwrap();
        assert!(found.curve.is_closed());
        let round = std::f64::consts::TAU * 30.0;
        assert!(
            (0.97..1.01).contains(&(found.curve.length() / round)),
            "{}",
            found.curve.length() / round
        );
        assert!(found.moved.iter().all(|&d| d < 1.0));
    }

    #[test]
    fn refusals() {
        let mesh = ball(5.0, 6);
        let p = turn(0.0, 0.0, 5.0);
        assert_eq!(
            surface_curve(&mesh, &[p, p], false),
            Err(SurfaceCurveError::TooFew(1))
        );
        assert_eq!(
            surface_curve(&mesh, &[p, p * f64::NAN], false),
            Err(SurfaceCurveError::NotFinite)
        );
        assert_eq!(
            surface_curve(&Mesh::default(), &[p, -p], false),
            Err(SurfaceCurveError::Broken)
        );
        let mut two = mesh.clone();
        let far = Point3::new(50.0, 0.0, 0.0);
        two.positions
            .extend(mesh.positions.iter().map(|&q| q + far));
        let n = mesh.positions.len() as u32;
        two.triangles
            .extend(mesh.triangles.iter().map(|t| t.map(|c| c + n)));
        assert_eq!(
            surface_curve(&two, &[p, p + far], false),
            Err(SurfaceCurveError::Apart(0))
        );
    }
}
