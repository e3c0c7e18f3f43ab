//! Turned profiles, unrolled: cylinders and cones with all lengths kept, others by arc length along the profile and
//! around at one height. Lengths around are those of the mesh, which is made of flat pieces.

use std::f64::consts::{PI, TAU};

use fretwork_geometry::{Point, Point3, Turned};

use super::{Chart, Deck, Demand, Flap, Room, Stretch, along, crossing, lengths, ring};
use crate::WrapError;

/// A profile is straight where no point is farther from the line between its ends than this part of its length.
const STRAIGHT: f64 = 1e-9;

/// A profile with its lengths, and the place on it that the drawing's middle comes to.
struct Rows<'a> {
    form: &'a Turned,
    /// Its points; where it is closed they begin opposite to the place, `shift` points later.
    profile: Vec<Point>,
    shift: usize,
    /// How far along the profile its points are.
    s: Vec<f64>,
    /// The number of the first corner of each of them.
    starts: Vec<u32>,
    /// The rows of quadrilaterals that are in the chart; those that end in a point on the axis are not.
    rows: std::ops::Range<usize>,
    /// The place along the profile, and the radius there.
    place: f64,
    radius: f64,
    /// How many columns around the place is, and the column at which the chart begins.
    column: f64,
    first: i64,
}

/// The chart of a turned surface.
///
/// # Errors
/// A profile that crosses itself where the drawing lies, and a way around where every piece of the profile ends on the axis, at which there is none.
pub fn chart(form: &Turned, demand: &Demand) -> Result<Chart, WrapError> {
    let rows = Rows::new(form, demand);
    let ends = [demand.extent.min.y, demand.extent.max.y].map(|y| rows.place + y);
    if let Some(at) = crossing(&rows.profile, form.closed, ends) {
        let angle = demand.at.map_or(0.0, |at| libm::atan2(at.y, at.x));
        let (x, y) = (at.x * libm::cos(angle), at.x * libm::sin(angle));
        return Err(WrapError::TurnsBack {
            at: Point3::new(x, y, at.y),
            fits: None,
        });
    }
    match rows.slant() {
        Some(slant) if !demand.in_rows => Ok(rows.cone(slant)),
        _ if rows.rows.is_empty() => Err(WrapError::OnAxis),
        _ => Ok(rows.moved_onto_rows().strip()),
    }
}

/// The point of a closed profile that is nearest to being opposite to a place; the first of an open one.
fn opposite(form: &Turned, p: Point) -> usize {
    if !form.closed {
        return 0;
    }
    let s = lengths(&form.profile, true);
    let whole = s[s.len() - 1];
    let back = (along(&form.profile, true, p) + 0.5 * whole) % whole;
    let apart = |i: &usize| (s[*i] - back).abs();
    let nearest = (0..form.profile.len()).min_by(|a, b| apart(a).total_cmp(&apart(b)));
    nearest.unwrap_or(0)
}

/// The number of the first corner of each point of a profile.
fn starts(form: &Turned) -> Vec<u32> {
    let mut next = 0;
    let mut start = |p: &Point| {
        let start = next;
        next += if p.x == 0.0 { 1 } else { form.segments };
        start
    };
    form.profile.iter().map(&mut start).collect()
}

/// How many columns around an angle is, as its way straight from the axis meets the flat pieces.
fn column(angle: f64, step: f64) -> f64 {
    let whole = libm::floor(angle / step);
    let off = angle - (whole + 0.5) * step;
    whole + 0.5 + 0.5 * libm::tan(off) / libm::tan(0.5 * step)
}

impl<'a> Rows<'a> {
    fn new(form: &'a Turned, demand: &Demand) -> Rows<'a> {
        let asked = demand
            .at
            .map(|at| Point::new(libm::hypot(at.x, at.y), at.z));
        let shift = asked.map_or(0, |p| opposite(form, p));
        let profile: Vec<Point> = (0..form.profile.len())
            .map(|i| form.profile[(i + shift) % form.profile.len()])
            .collect();
        let s = lengths(&profile, form.closed);
        let on_axis = |i: usize| profile[i % profile.len()].x == 0.0;
        let begin = usize::from(on_axis(0));
        let end = s.len() - 1 - usize::from(!form.closed && on_axis(s.len() - 1));
        let rows = begin..end.max(begin);
        let middle = 0.5 * s[s.len() - 1];
        let place = asked.map_or(middle, |p| along(&profile, form.closed, p));
        let angle = demand.at.map_or(0.0, |at| libm::atan2(at.y, at.x));
        let step = TAU / f64::from(form.segments);
        let mut made = Rows {
            form,
            profile,
            shift,
            s,
            starts: starts(form),
            rows,
            place,
            radius: 0.0,
            column: column(angle, step),
            first: libm::round((angle - PI) / step) as i64,
        };
        made.radius = made.radius_at(place);
        made
    }

    /// With the place moved to the nearest one that is on a row of the chart, not at a tip.
    fn moved_onto_rows(mut self) -> Rows<'a> {
        let ends = [self.s[self.rows.start], self.s[self.rows.end]];
        self.place = self.place.clamp(ends[0], ends[1]);
        self.radius = self.radius_at(self.place);
        self
    }

    fn point(&self, i: usize) -> Point {
        self.profile[i % self.profile.len()]
    }

    fn radius_at(&self, s: f64) -> f64 {
        let i = self
            .s
            .partition_point(|l| *l <= s)
            .clamp(1, self.s.len() - 1)
            - 1;
        let t = (s - self.s[i]) / (self.s[i + 1] - self.s[i]);
        self.point(i).x + t * (self.point(i + 1).x - self.point(i).x)
    }

    /// How the radius grows along a straight profile; none where it is not straight.
    fn slant(&self) -> Option<f64> {
        let (first, last) = (self.point(0), self.point(self.form.profile.len() - 1));
        let length = first.distance(last);
        let way = (last - first) * (1.0 / length);
        let off = |p: &Point| (*p - first).cross(way).abs() > STRAIGHT * length;
        let is_straight = !self.form.closed && length > 0.0 && !self.form.profile.iter().any(off);
        is_straight.then_some(way.x)
    }

    /// Unrolled with a step to the right: a cylinder, or any profile by arc length. Rows that end on the axis are left out,
    /// for there nothing goes to the right.
    fn strip(&self) -> Chart {
        let radius = self.radius;
        let low = self.s[self.rows.start];
        let inner = radius.max(0.5 * (self.s[self.rows.end] - low));
        let step = TAU / f64::from(self.form.segments);
        let wide = 2.0 * radius * libm::sin(0.5 * step);
        let place = |columns: f64, i: usize| Point::new(wide * columns, self.s[i] - self.place);
        let plan = |part: f64, i: usize| ring(part, self.s[i] - low, inner);
        let around = |i: usize| self.point(i).x / radius;
        let heights = [self.rows.start, self.rows.end].map(|i| self.s[i] - self.place);
        Chart {
            flaps: self.flaps(self.rows.clone(), place, plan, around),
            others: self.others(),
            deck: Deck::Step(wide * f64::from(self.form.segments)),
            room: Room::Strip(None, heights),
            slack: radius * step / wide,
        }
    }

    /// A cone as a sector: places keep their distance from the apex. A cylinder has no apex.
    fn cone(&self, slant: f64) -> Chart {
        if slant.abs() < STRAIGHT {
            return self.strip();
        }
        let is_above = slant < 0.0;
        let distance = |i: usize| self.point(i).x / slant.abs();
        let apex = self.radius / slant.abs();
        let apex = Point::new(0.0, if is_above { apex } else { -apex });
        // A flat piece of the cone is a triangle with its tip at the apex.
        let step = TAU / f64::from(self.form.segments);
        let wide = 2.0 * libm::asin(slant.abs() * libm::sin(0.5 * step));
        let place = |columns: f64, i: usize| {
            let way = columns * wide;
            let (sin, cos) = (libm::sin(way), libm::cos(way));
            apex + Point::new(sin, if is_above { -cos } else { cos }) * distance(i)
        };
        let plan =
            |part: f64, i: usize| ring(if is_above { -part } else { part }, 0.0, distance(i));
        let last = self.s.len() - 1;
        let ends = [distance(0), distance(last)];
        let turn = wide * f64::from(self.form.segments);
        Chart {
            flaps: self.flaps(0..last, place, plan, |_| 1.0),
            others: Vec::new(),
            deck: Deck::Turn(apex, if is_above { turn } else { -turn }),
            room: Room::Sector(apex, [ends[0].min(ends[1]), ends[0].max(ends[1])], is_above),
            slack: step * slant.abs() / wide,
        }
    }

    /// The triangles of some rows. `place` gives, for a number of columns from the drawing's middle and a point of the profile, the
    /// place in the drawing; `plan` that in the plane of counting for a part of a turn; `around` how long a length around is.
    fn flaps(
        &self,
        rows: std::ops::Range<usize>,
        place: impl Fn(f64, usize) -> Point,
        plan: impl Fn(f64, usize) -> Point,
        around: impl Fn(usize) -> f64,
    ) -> Vec<Flap> {
        let columns = i64::from(self.form.segments);
        let mut flaps = Vec::with_capacity(2 * rows.len() * columns as usize);
        for i in rows {
            let long = [around(i), around(i + 1)];
            let stretch = [long[0], long[0], long[1], long[1]];
            for k in self.first..self.first + columns {
                let corner = |k: i64, i: usize| {
                    let part = k.rem_euclid(columns) as f64 / columns as f64;
                    let drawn = place(k as f64 - self.column, i);
                    (self.number(i, k), drawn, plan(part, i))
                };
                let quad = [
                    corner(k, i),
                    corner(k + 1, i),
                    corner(k + 1, i + 1),
                    corner(k, i + 1),
                ];
                for half in [[0, 1, 2], [0, 2, 3]] {
                    let corners = half.map(|i: usize| quad[i].0);
                    // At a point on the axis one of the halves has no area.
                    if corners[0] != corners[1]
                        && corners[1] != corners[2]
                        && corners[2] != corners[0]
                    {
                        flaps.push(Flap {
                            corners,
                            drawn: half.map(|i| quad[i].1),
                            plan: half.map(|i| quad[i].2),
                            stretch: Stretch::Around(half.map(|i| stretch[i])),
                        });
                    }
                }
            }
        }
        flaps
    }

    /// The number of a corner in the mesh: `mesh::revolve` numbers them ring by ring, and a point on the axis once.
    fn number(&self, i: usize, k: i64) -> u32 {
        let n = i + self.shift;
        let around = if self.point(i).x == 0.0 {
            0
        } else {
            k.rem_euclid(i64::from(self.form.segments))
        };
        self.starts[n % self.starts.len()] + around as u32
    }

    /// The triangles that end in a point on the axis, which come in rows too.
    fn others(&self) -> Vec<u32> {
        let segments = self.form.segments;
        let full = 2 * segments * self.rows.len() as u32;
        let before = if self.rows.start > 0 { segments } else { 0 };
        let after = if self.rows.end + 1 < self.s.len() {
            segments
        } else {
            0
        };
        (0..before)
            .chain(before + full..before + full + after)
            .collect()
    }
}
