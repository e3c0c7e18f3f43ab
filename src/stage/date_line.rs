//! Shapes of a map's plane in longitudes and latitudes, cut at ±180 degrees (RFC 7946, section 3.1.9). Vertices go one by
//! one; a cut lies where the side crosses the date line on the plane, so that it is the same place there.

use fretwork_geometry::polygon::signed_area;
use fretwork_geometry::{Point, Polygon};
use fretwork_source::geo::crs::Transform;

/// Half of the way around the earth in degrees.
const HALF: f64 = 180.0;
/// The way around the earth in degrees.
const TURN: f64 = 360.0;
/// What is nearer to the date line, in degrees, is on it.
const ON_LINE: f64 = 1e-9;
/// Sides over more degrees are followed step by step, to tell which way around they go.
const LONG: f64 = 90.0;
/// The steps of a long side.
const STEPS: usize = 16;

/// The way from a plane to longitudes and latitudes.
pub(super) struct Earth {
    /// From the plane to degrees.
    pub transform: Transform,
}

/// A vertex of a shape. Longitudes run on beyond ±180 where the shape goes around.
#[derive(Clone, Copy, Debug)]
struct Vertex {
    plane: Point,
    degrees: Point,
}

/// The vertices of a path, and of each of its sides in which turn around the earth it lies.
struct Path {
    vertices: Vec<Vertex>,
    turns: Vec<i64>,
}

impl Earth {
    /// The longitude and the latitude of a point, with a longitude in -180 to 180.
    ///
    /// # Errors
    /// With the point if it has none.
    pub fn place(&self, at: Point) -> Result<Point, Point> {
        let place = self.transform.apply(at).ok_or(at)?;
        Ok(Point::new(near(place.x, 0.0), place.y))
    }

    /// The parts of a line, with longitudes in -180 to 180.
    ///
    /// # Errors
    /// With the first point that has no longitude and latitude.
    pub fn lines(&self, points: &[Point]) -> Result<Vec<Vec<Point>>, Point> {
        let path = self.path(self.unwrapped(points)?, 0);
        Ok(path.pieces())
    }

    /// The parts of an area, with longitudes in -180 to 180. One that holds a pole goes along ±180 to it and back.
    ///
    /// # Errors
    /// As of [`Earth::lines`].
    pub fn areas(&self, area: &Polygon) -> Result<Vec<Polygon>, Point> {
        let (mut open, mut closed) = (Vec::new(), Vec::new());
        for (number, ring) in area.rings().enumerate() {
            // What is inside lies on the left of outer rings and of holes, on the plane and on the earth.
            let mut ring = ring.clone();
            if (signed_area(&ring) > 0.0) != (number == 0) {
                ring.reverse();
            }
            self.ring(ring, &mut open, &mut closed)?;
        }
        let mut parts: Vec<Polygon> = joined(open).into_iter().map(outer).collect();
        let mut holes = closed.into_iter();
        if parts.is_empty() {
            parts.extend(holes.next().map(outer));
        }
        for hole in holes {
            let at = hole[0].lerp(hole[1 % hole.len()], 0.5);
            let owner = parts.iter().position(|part| part.contains(at));
            if let Some(part) = parts.get_mut(owner.unwrap_or(0)) {
                part.holes.push(hole);
            }
        }
        Ok(parts)
    }

    /// Adds a ring to the closed ones, or the pieces between the date line and the date line of which it consists.
    fn ring(
        &self,
        mut ring: Vec<Point>,
        open: &mut Vec<Vec<Point>>,
        closed: &mut Vec<Vec<Point>>,
    ) -> Result<(), Point> {
        // A ring that begins and ends in a pole does not go around it.
        let pole = ring.iter().position(|p| self.is_pole(*p));
        if let Some(pole) = pole {
            ring.rotate_left(pole);
        }
        ring.extend(ring.first().copied());
        let mut vertices = self.unwrapped(&ring)?;
        if pole.is_some() {
            vertices.extend(vertices.first().copied());
        }
        let ends = [vertices.first(), vertices.last()].map(|v| v.map_or(0.0, |v| v.degrees.x));
        let winding = ((ends[1] - ends[0]) / TURN).round() as i64;
        let path = self.path(vertices, winding);
        match path.begun_at_cut(winding) {
            Some(path) => open.extend(path.pieces()),
            None => closed.extend(path.pieces().into_iter().map(|mut ring| {
                ring.pop();
                ring
            })),
        }
        Ok(())
    }

    fn is_pole(&self, p: Point) -> bool {
        let place = self.transform.apply(p);
        place.is_some_and(|place| place.y.abs() > 90.0 - ON_LINE)
    }

    /// The vertices of a polyline, each with the longitude that follows from the one before. A pole has two, that of the
    /// vertex before and that of the one after.
    fn unwrapped(&self, points: &[Point]) -> Result<Vec<Vertex>, Point> {
        let mut vertices: Vec<Vertex> = Vec::new();
        let mut poles = Vec::new();
        for &plane in points {
            let mut degrees = self.transform.apply(plane).ok_or(plane)?;
            if degrees.y.abs() > 90.0 - ON_LINE {
                if let Some(last) = vertices.last() {
                    degrees.x = last.degrees.x;
                    vertices.push(Vertex { plane, degrees });
                }
                poles.push(Vertex { plane, degrees });
                continue;
            }
            if let Some(last) = vertices.last() {
                degrees.x = match poles.is_empty() {
                    true => self.following(last, plane, degrees.x),
                    false => near(degrees.x, last.degrees.x),
                };
            }
            degrees.x = on_line(degrees.x);
            for mut pole in poles.drain(..) {
                pole.degrees.x = degrees.x;
                vertices.push(pole);
            }
            vertices.push(Vertex { plane, degrees });
        }
        Ok(vertices)
    }

    /// The longitude of `plane`, which is `longitude` but for whole turns, at the end of the side from `last`.
    fn following(&self, last: &Vertex, plane: Point, longitude: f64) -> f64 {
        let own = near(last.degrees.x, 0.0);
        if (own - longitude).abs() <= LONG {
            return near(longitude, last.degrees.x);
        }
        let end = self.steps(last, plane).last().map(|(_, x)| *x);
        near(longitude, end.unwrap_or(last.degrees.x))
    }

    /// Places along the side from `last` to `plane`, as parts of it, and their longitudes.
    fn steps(&self, last: &Vertex, plane: Point) -> Vec<(f64, f64)> {
        let mut steps = vec![(0.0, last.degrees.x)];
        for k in 1..=STEPS {
            let part = k as f64 / STEPS as f64;
            if let Some(place) = self.transform.apply(last.plane.lerp(plane, part)) {
                let before = steps[steps.len() - 1].1;
                steps.push((part, near(place.x, before)));
            }
        }
        steps
    }

    /// The path with vertices where it crosses the date line. `winding` is how often it goes around if it is closed.
    fn path(&self, vertices: Vec<Vertex>, winding: i64) -> Path {
        let mut all: Vec<Vertex> = Vec::new();
        for vertex in vertices {
            if let Some(last) = all.last().copied() {
                let (a, b) = (last.degrees.x, vertex.degrees.x);
                let mut lines = date_lines(a.min(b), a.max(b));
                if b < a {
                    lines.reverse();
                }
                let cuts = lines.into_iter().map(|line| self.cut(&last, &vertex, line));
                all.extend(cuts);
            }
            all.push(vertex);
        }
        let turn = |pair: &[Vertex]| {
            let (a, b) = (pair[0].degrees.x, pair[1].degrees.x);
            let is_along = a == b && (a - HALF) % TURN == 0.0;
            (!is_along).then(|| (((a + b) * 0.5 + HALF) / TURN).floor() as i64)
        };
        let turns: Vec<Option<i64>> = all.windows(2).map(turn).collect();
        Path {
            turns: filled(&turns, winding),
            vertices: all,
        }
    }

    /// The place where the side between two vertices crosses the date line at this longitude. Either direction gives the
    /// same digits.
    fn cut(&self, a: &Vertex, b: &Vertex, line: f64) -> Vertex {
        let key = |v: &Vertex| (v.plane.x, v.plane.y);
        let (a, b) = if key(b) < key(a) { (b, a) } else { (a, b) };
        let at = |part: f64| a.plane.lerp(b.plane, part);
        let steps = self.steps(a, b.plane);
        let crossing = steps
            .windows(2)
            .find(|s| (s[0].1 < line) != (s[1].1 < line));
        let (mut low, mut high) = crossing.map_or((0.0, 1.0), |s| (s[0].0, s[1].0));
        let is_west = |part: f64| {
            let place = self.transform.apply(at(part));
            place.is_some_and(|place| near(place.x, line) < line)
        };
        let from_west = crossing.is_none_or(|s| s[0].1 < line);
        for _ in 0..64 {
            let middle = (low + high) * 0.5;
            match is_west(middle) == from_west {
                true => low = middle,
                false => high = middle,
            }
        }
        let plane = at((low + high) * 0.5);
        let latitude = self.transform.apply(plane).map_or(a.degrees.y, |p| p.y);
        Vertex {
            plane,
            degrees: Point::new(line, latitude),
        }
    }
}

impl Path {
    /// The closed path from a place on where it goes from one turn into the next; none where it does so nowhere.
    fn begun_at_cut(&self, winding: i64) -> Option<Path> {
        let count = self.turns.len();
        let before = |k: usize| match k {
            0 => self.turns[count - 1] - winding,
            k => self.turns[k - 1],
        };
        let start = (0..count).find(|&k| before(k) != self.turns[k])?;
        let on = |v: &Vertex| Vertex {
            degrees: Point::new(v.degrees.x + winding as f64 * TURN, v.degrees.y),
            ..*v
        };
        let head = self.vertices[1..=start].iter().map(on);
        let turns = self.turns[..start].iter().map(|turn| turn + winding);
        Some(Path {
            vertices: self.vertices[start..].iter().copied().chain(head).collect(),
            turns: self.turns[start..].iter().copied().chain(turns).collect(),
        })
    }

    /// The parts in one turn each, with longitudes in -180 to 180.
    fn pieces(&self) -> Vec<Vec<Point>> {
        let mut pieces: Vec<Vec<Point>> = Vec::new();
        let mut last = None;
        for (pair, turn) in self.vertices.windows(2).zip(&self.turns) {
            let back = |v: &Vertex| Point::new(v.degrees.x - *turn as f64 * TURN, v.degrees.y);
            if last != Some(*turn) {
                pieces.push(vec![back(&pair[0])]);
            }
            last = Some(*turn);
            let piece = pieces.last_mut().expect("a piece was begun above");
            piece.push(back(&pair[1]));
        }
        pieces
    }
}

fn outer(ring: Vec<Point>) -> Polygon {
    Polygon {
        outer: ring,
        holes: Vec::new(),
    }
}

/// Of the longitudes that are `longitude` but for whole turns, the nearest to another one.
fn near(longitude: f64, other: f64) -> f64 {
    longitude + TURN * ((other - longitude) / TURN).round()
}

/// The longitude, on the date line where it is close to it.
fn on_line(longitude: f64) -> f64 {
    let line = near(HALF, longitude);
    if (line - longitude).abs() < ON_LINE {
        line
    } else {
        longitude
    }
}

/// The longitudes of the date line between two longitudes, in order.
fn date_lines(low: f64, high: f64) -> Vec<f64> {
    let first = ((low - HALF) / TURN).floor() as i64 + 1;
    let lines = (first..).map(|k| HALF + TURN * k as f64);
    lines.take_while(|line| *line < high).collect()
}

/// The turns of all sides: those along the date line are in that of the side before, or of the one after.
fn filled(turns: &[Option<i64>], winding: i64) -> Vec<i64> {
    let known = turns.iter().rev().find_map(|turn| *turn);
    let mut last = known.map_or(0, |turn| turn - winding);
    if winding == 0 && turns.first() == Some(&None) {
        last = turns.iter().find_map(|turn| *turn).unwrap_or(0);
    }
    let all = turns.iter().map(|turn| {
        last = turn.unwrap_or(last);
        last
    });
    all.collect()
}

/// The rings that pieces from the date line to the date line bound, each with its inside on the left: from the end of a
/// piece along the line to the next beginning of one, around a pole where there is none on the way.
fn joined(mut open: Vec<Vec<Point>>) -> Vec<Vec<Point>> {
    let mut rings = Vec::new();
    while !open.is_empty() {
        let mut ring = open.remove(0);
        let mut poles = 0;
        loop {
            let end = ring[ring.len() - 1];
            let sign = end.x.signum();
            let ahead = |start: Point| {
                let way = (start.y - end.y) * sign;
                (start.x == end.x && way >= 0.0).then_some(way)
            };
            let own = ahead(ring[0]);
            let others = open.iter().enumerate();
            let next = others.filter_map(|(k, piece)| Some((k, ahead(piece[0])?)));
            let next = next.min_by(|a, b| a.1.total_cmp(&b.1));
            match (own, next) {
                (Some(own), Some((_, other))) if own <= other => break,
                (Some(_), None) => break,
                (_, Some((k, _))) => ring.extend(open.remove(k)),
                (None, None) if poles < 2 => {
                    poles += 1;
                    let latitude = 90.0 * sign;
                    ring.push(Point::new(end.x, latitude));
                    ring.push(Point::new(-end.x, latitude));
                }
                (None, None) => break,
            }
        }
        rings.push(ring);
    }
    rings
}

#[cfg(test)]
mod tests;
