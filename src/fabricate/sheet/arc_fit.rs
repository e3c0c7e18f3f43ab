//! Arcs and circles found again in polylines. Curves are flattened early, and every step works on
//! polylines; the files get arcs back where the corners of a polyline lie on one.
//!
//! Curves that were never arcs become arcs that come close to them where that makes the file smaller.
//!
//! A run of corners becomes an arc when two things hold. Its corners lie on the arc as nearly as
//! files can say, so that an arc that was flattened is found as it was. And none of its chords
//! leaves the arc by more than flattening would allow, so that a polygon that is meant, such as a
//! hexagon, stays one. The arc with given ends that fits best is the solution of a linear least
//! squares problem in one unknown, the place of its centre on the bisector of the ends (the
//! algebraic fit of Kåsa 1976, with two points held); circles take the same fit with all three
//! unknowns.

use super::fixed_point::Cell;
use fretwork_geometry::Point;

/// How far corners may be from their arc, in steps of the file. Rounding a corner moves it by up to
/// 0.71 steps, and rounding the ends moves the arc by as much: less than 1.4 would miss arcs that
/// are there, more would join what no arc has joined.
const NEAR: f64 = 1.5;
/// How far corners of other curves may be from the arcs that stand for them, in steps of the file: 0.004 mm, so that with
/// the chords of flattening no place is off by more than 0.014 mm. With less, curves stay polylines; with more, what was
/// cut to measure is not.
const CLOSE: f64 = 40.0;
/// How far a chord may be from its arc, in steps of the file: a hundredth of a millimetre, what
/// curves are flattened to. With less, arcs of drawings are missed; with more, polygons turn round.
const SAGITTA: f64 = 100.0;
/// The least number of chords of an arc. An arc takes as many bytes as two or three corners, and
/// through three corners there always is one.
const FEWEST_CHORDS: usize = 4;
/// The least number of chords of a circle.
const FEWEST_SIDES: usize = 8;
/// How far an arc must leave the straight line between its ends, in steps; less is a straight line
/// that was rounded.
const LEAST_RISE: f64 = 4.0;
/// The least radius, in steps: below it rounding decides what is a circle.
const LEAST_RADIUS: f64 = 20.0;
/// The largest share of the radius that half the distance of the ends may be: sin 60°, arcs of
/// 120°. Toward 180° the radius says ever less on where the arc runs: at 120° a rounded radius
/// moves its middle by as much as it was rounded, at 150° by three times that.
const WIDEST: f64 = 0.866;

/// A circle, in cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Circle {
    /// Its centre.
    pub center: Cell,
    /// Above zero.
    pub radius: i64,
}

/// One stretch of a line, from the end of the stretch before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Where it ends.
    pub end: Cell,
    /// The arc that it is; none where it is straight.
    pub arc: Option<Arc>,
}

/// An arc of less than half a circle between two known ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// In steps, at least half the distance of the ends.
    pub radius: i64,
    /// The tangent of a quarter of its angle. Positive where it turns from the x axis toward the y
    /// axis.
    pub bulge: f64,
}

/// The circle that a closed line goes round once, its first corner being also its last.
pub fn circle(line: &[Cell]) -> Option<Circle> {
    let corners = &line[..line.len().checked_sub(1)?];
    let points: Vec<Point> = corners.iter().map(|&c| plain(c)).collect();
    let (center, radius) = circle_through(&points)?;
    let circle = Circle {
        center: (center.x.round() as i64, center.y.round() as i64),
        radius: radius.round() as i64,
    };
    let (center, radius) = (plain(circle.center), circle.radius as f64);
    let is_near = |p: &Point| (p.distance(center) - radius).abs() <= NEAR + 0.5;
    points.iter().all(is_near).then_some(circle)
}

/// Centre and radius of the circle that the corners of a polygon lie on, in the units of the file's
/// steps, without rounding.
pub fn circle_through(corners: &[Point]) -> Option<(Point, f64)> {
    if corners.len() < FEWEST_SIDES {
        return None;
    }
    let (center, radius) = best_circle(corners)?;
    let next = |i: usize| corners[(i + 1) % corners.len()];
    let is_good = |(i, &p): (usize, &Point)| {
        let chord = p.distance(next(i));
        (p.distance(center) - radius).abs() <= NEAR && sagitta(chord, radius) <= SAGITTA
    };
    let is_round = radius >= LEAST_RADIUS && corners.iter().enumerate().all(is_good);
    (is_round && goes_round_once(corners, center)).then_some((center, radius))
}

/// Kåsa's fit: the centre and the radius for which the squares of the distances differ least.
fn best_circle(points: &[Point]) -> Option<(Point, f64)> {
    let count = points.len() as f64;
    let sum = |f: &dyn Fn(Point) -> f64| points.iter().map(|&p| f(p)).sum::<f64>();
    let mean = Point::new(sum(&|p| p.x) / count, sum(&|p| p.y) / count);
    let moment = |f: &dyn Fn(Point) -> f64| sum(&|p| f(p - mean));
    let (xx, xy, yy) = (
        moment(&|d| d.x * d.x),
        moment(&|d| d.x * d.y),
        moment(&|d| d.y * d.y),
    );
    let (p, q) = (
        moment(&|d| d.x * d.dot(d)) / 2.0,
        moment(&|d| d.y * d.dot(d)) / 2.0,
    );
    let determinant = xx * yy - xy * xy;
    if determinant <= 1e-9 * xx * yy {
        return None;
    }
    let offset = Point::new(p * yy - q * xy, q * xx - p * xy) * (1.0 / determinant);
    let radius = (offset.dot(offset) + (xx + yy) / count).sqrt();
    Some((mean + offset, radius))
}

/// Whether all sides turn about the centre in one sense, and all together once.
fn goes_round_once(corners: &[Point], center: Point) -> bool {
    let (mut quarters, mut sense) = (0, 0.0);
    for (i, &p) in corners.iter().enumerate() {
        let (from, to) = (p - center, corners[(i + 1) % corners.len()] - center);
        let turn = from.cross(to);
        if turn == 0.0 || turn * sense < 0.0 {
            return false;
        }
        sense = turn;
        quarters += i32::from(quadrant(from) != quadrant(to));
    }
    // Sides are too short to leave out a quadrant, so once round is four changes.
    quarters == 4
}

fn quadrant(p: Point) -> (bool, bool) {
    (p.x >= 0.0, p.y >= 0.0)
}

/// How far a chord is from its arc.
fn sagitta(chord: f64, radius: f64) -> f64 {
    let half = 0.5 * chord;
    if half >= radius {
        return f64::INFINITY;
    }
    half * half / (radius + (radius * radius - half * half).sqrt())
}

/// The line with arcs where its corners lie on them, from its first corner on. Every arc is as long
/// as it can be from where it begins. Between arcs that were flattened, other curves get arcs that come close to
/// them. O(n log n) for n corners.
pub fn stretches(line: &[Cell]) -> Vec<Stretch> {
    let exact = fitted(line, NEAR);
    let mut out = Vec::with_capacity(exact.len());
    let mut at = 0;
    for run in exact.chunk_by(|a, b| a.0.arc.is_none() && b.0.arc.is_none()) {
        let chords: usize = run.iter().map(|stretch| stretch.1).sum();
        if run[0].0.arc.is_none() {
            out.extend(fitted(&line[at..=at + chords], CLOSE));
        } else {
            out.extend(run);
        }
        at += chords;
    }
    out.into_iter().map(|stretch| stretch.0).collect()
}

/// The line with arcs that its corners are this near to; with each stretch the number of chords that it stands for.
fn fitted(line: &[Cell], near: f64) -> Vec<(Stretch, usize)> {
    let mut out = Vec::new();
    let mut at = 0;
    while at + 1 < line.len() {
        let (end, arc) = match longest_arc(&line[at..], near) {
            Some((count, arc)) => (at + count, Some(arc)),
            None => (at + 1, None),
        };
        let stretch = Stretch {
            end: line[end],
            arc,
        };
        out.push((stretch, end - at));
        at = end;
    }
    out
}

/// The arc over the most chords from the beginning of the line, and how many they are.
fn longest_arc(line: &[Cell], near: f64) -> Option<(usize, Arc)> {
    let most = line.len() - 1;
    let try_arc = |chords: usize| arc_through(&line[..=chords], near);
    if most < FEWEST_CHORDS {
        return None;
    }
    let (mut good, mut arc) = (FEWEST_CHORDS, try_arc(FEWEST_CHORDS)?);
    let mut bad = most + 1;
    let mut next = 2 * good;
    while good < most {
        let chords = next.min(most);
        match try_arc(chords) {
            Some(found) => (good, arc, next) = (chords, found, 2 * chords),
            None => {
                bad = chords;
                break;
            }
        }
    }
    while bad - good > 1 {
        let middle = (good + bad) / 2;
        match try_arc(middle) {
            Some(found) => (good, arc) = (middle, found),
            None => bad = middle,
        }
    }
    Some((good, arc))
}

/// The arc from the first to the last of the corners that all of them are near to. Its radius has as few
/// digits as it may.
fn arc_through(corners: &[Cell], near: f64) -> Option<Arc> {
    let (first, last) = (corners[0], *corners.last()?);
    let middle = (plain(first) + plain(last)) * 0.5;
    let chord = plain(last) - plain(first);
    let half = 0.5 * chord.length();
    if half == 0.0 {
        return None;
    }
    let along = chord * (0.5 / half);
    let across = Point::new(-along.y, along.x);
    let local = |c: &Cell| {
        let d = plain(*c) - middle;
        Point::new(d.dot(along), d.dot(across))
    };
    let inner: Vec<Point> = corners[1..corners.len() - 1].iter().map(local).collect();
    let rise = inner.iter().map(|p| p.y.abs()).fold(0.0, f64::max);
    let side = inner[inner.len() / 2].y.signum();
    let is_bowed = inner.iter().all(|p| p.y * side > 0.0) && rise >= LEAST_RISE;
    if !is_bowed || !is_forward(&inner, half) {
        return None;
    }
    let (mut weighted, mut weight) = (0.0, 0.0);
    for p in &inner {
        weighted += p.y * (p.dot(*p) - half * half);
        weight += 2.0 * p.y * p.y;
    }
    let height = weighted / weight;
    let radius = (half * half + height * height).sqrt();
    if height * side > 0.0 || half > WIDEST * radius {
        return None;
    }
    let with = |radius: f64| Candidate { half, side, radius };
    let steps = [1e4, 1e3, 100.0, 10.0, 1.0];
    let plainest = steps
        .iter()
        .map(|step| with((radius / step).round() * step));
    let found = plainest
        .into_iter()
        .find(|arc| half < arc.radius && arc.fits(&inner, near))?;
    Some(Arc {
        radius: found.radius as i64,
        bulge: -side * sagitta(2.0 * half, found.radius) / half,
    })
}

/// Whether the corners between the ends go forward along the chord.
fn is_forward(inner: &[Point], half: f64) -> bool {
    let ends = [-half, half];
    let along = inner.iter().map(|p| p.x);
    let mut before = ends[0];
    let mut all = along.chain([ends[1]]);
    all.all(|x| std::mem::replace(&mut before, x) < x)
}

/// An arc in the frame of its chord.
struct Candidate {
    half: f64,
    side: f64,
    radius: f64,
}

impl Candidate {
    /// Whether the corners are near it, and the chords between them too.
    fn fits(&self, inner: &[Point], near: f64) -> bool {
        let height = (self.radius * self.radius - self.half * self.half).sqrt();
        let center = Point::new(0.0, -self.side * height);
        let is_near = |p: &Point| (p.distance(center) - self.radius).abs() <= near;
        let ends = [Point::new(-self.half, 0.0), Point::new(self.half, 0.0)];
        let mut before = ends[0];
        let mut corners = inner.iter().chain([&ends[1]]);
        inner.iter().all(is_near)
            && corners.all(|&p| {
                let chord = std::mem::replace(&mut before, p).distance(p);
                sagitta(chord, self.radius) <= SAGITTA
            })
    }
}

fn plain((x, y): Cell) -> Point {
    Point::new(x as f64, y as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Seed;

    /// The corners of an arc about `center`, `count` chords from the angle `from` over `sweep`.
    fn flattened(center: (f64, f64), radius: f64, angles: (f64, f64), count: usize) -> Vec<Cell> {
        let at = |i: usize| angles.0 + angles.1 * i as f64 / count as f64;
        let corner = |i: usize| {
            let (x, y) = (libm::cos(at(i)) * radius, libm::sin(at(i)) * radius);
            ((center.0 + x).round() as i64, (center.1 + y).round() as i64)
        };
        (0..=count).map(corner).collect()
    }

    const TURN: f64 = std::f64::consts::TAU;

    #[test]
    fn a_hole_is_a_circle_with_its_radius() {
        let seed = Seed::root(3);
        for i in 0..500 {
            let s = seed.number(i);
            let radius = (s.range(0, 500.0, 400_000.0)).round();
            let center = (s.range(1, -1e6, 1e6).round(), s.range(2, -1e6, 1e6).round());
            let least = (TURN / (2.0 * libm::acos(1.0 - 90.0 / radius))).max(12.0);
            let count = s.range(3, least, 3.0 * least) as usize;
            let mut line = flattened(center, radius, (s.range(4, 0.0, 9.0), TURN), count);
            *line.last_mut().unwrap() = line[0];
            let found = circle(&line).unwrap_or_else(|| panic!("{radius} {count}"));
            assert_eq!(found.radius, radius as i64, "{count}");
            assert_eq!(found.center, (center.0 as i64, center.1 as i64));
            line.reverse();
            assert_eq!(circle(&line), Some(found));
        }
    }

    #[test]
    fn polygons_stay_polygons() {
        for (radius, count) in [
            (16_000.0, 6),
            (16_000.0, 12),
            (100_000.0, 24),
            (16_000.0, 27),
        ] {
            let mut line = flattened((0.0, 0.0), radius, (0.1, TURN), count);
            *line.last_mut().unwrap() = line[0];
            assert_eq!(circle(&line), None, "{count}");
            assert!(stretches(&line).iter().all(|s| s.arc.is_none()));
        }
        let twice = flattened((0.0, 0.0), 16_000.0, (0.0, 2.0 * TURN), 400);
        assert_eq!(circle(&twice), None);
        let straight: Vec<Cell> = (0..90).map(|i| (i * 1000, i * 7 + i % 2)).collect();
        assert!(stretches(&straight).iter().all(|s| s.arc.is_none()));
    }

    #[test]
    fn a_rounded_corner_is_one_arc_of_its_radius() {
        let mut line = vec![(-300_000, 0)];
        line.extend(flattened(
            (0.0, 40_000.0),
            40_000.0,
            (-TURN / 4.0, TURN / 4.0),
            20,
        ));
        line.push((40_000, 500_000));
        let found = stretches(&line);
        assert_eq!(found.len(), 3);
        let arc = found[1].arc.unwrap();
        assert_eq!((arc.radius, found[1].end), (40_000, (40_000, 40_000)));
        assert!((arc.bulge - libm::tan(TURN / 16.0)).abs() < 1e-9);
        line.reverse();
        assert!(stretches(&line)[1].arc.unwrap().bulge < 0.0);
    }

    /// How far a point is from an arc with ends `a` and `b`, by trying many of its points.
    fn slow_distance(p: Point, a: Point, b: Point, arc: Option<Arc>) -> f64 {
        let Some(arc) = arc else {
            let t = ((p - a).dot(b - a) / (b - a).dot(b - a)).clamp(0.0, 1.0);
            return p.distance(a.lerp(b, t));
        };
        let angle = 4.0 * libm::atan(arc.bulge);
        let radius = 0.5 * a.distance(b) / libm::sin(angle.abs() / 2.0);
        let normal = Point::new(a.y - b.y, b.x - a.x) * (1.0 / a.distance(b));
        let center = a.lerp(b, 0.5) + normal * (radius * libm::cos(angle / 2.0) * angle.signum());
        let from = libm::atan2(a.y - center.y, a.x - center.x);
        let at = |k: usize| from + angle * k as f64 / 4000.0;
        let on = |k: usize| center + Point::new(libm::cos(at(k)), libm::sin(at(k))) * radius;
        (0..=4000)
            .map(|k| on(k).distance(p))
            .fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn fitted_lines_stay_near_the_polylines() {
        // Spirals, ellipses and waves: curves on which no long run is a circle's.
        let curves: [fn(f64) -> (f64, f64); 3] = [
            |t| (t * 40_000.0 * libm::cos(t), t * 40_000.0 * libm::sin(t)),
            |t| (200_000.0 * libm::cos(t), 90_000.0 * libm::sin(t)),
            |t| (t * 100_000.0, 60_000.0 * libm::sin(t)),
        ];
        for curve in curves {
            let cell = |i: usize| {
                let (x, y) = curve(0.3 + i as f64 * 0.01);
                (x.round() as i64, y.round() as i64)
            };
            let line: Vec<Cell> = (0..600).map(cell).collect();
            let found = stretches(&line);
            assert!(found.len() < line.len() / 4, "{}", found.len());
            assert_eq!(found.last().unwrap().end, line[599]);
            let mut start = 0;
            for stretch in found {
                let end = start
                    + line[start..]
                        .iter()
                        .position(|c| *c == stretch.end)
                        .unwrap();
                for w in line[start..=end].windows(2) {
                    let (a, b) = (plain(line[start]), plain(stretch.end));
                    for p in [plain(w[0]), plain(w[0]).lerp(plain(w[1]), 0.5)] {
                        let away = slow_distance(p, a, b, stretch.arc);
                        assert!(away <= SAGITTA + 2.0 * CLOSE + 40.0, "{away}");
                    }
                }
                let corners = line[start..=end].iter();
                for c in corners.filter(|_| stretch.arc.is_some()) {
                    let (a, b) = (plain(line[start]), plain(stretch.end));
                    // The oracle's own points are up to half their distance apart.
                    let apart = a.distance(b) / 4000.0;
                    let away = slow_distance(plain(*c), a, b, stretch.arc);
                    assert!(away <= CLOSE + apart, "{away}");
                }
                start = end;
            }
        }
    }
}
