//! Families of parallel lines: where each line is, which stripe a point lies in, and what remains
//! of the lines inside a region (rules R5 and R6).
//!
//! Every crossing of a line with a segment is computed by [`Lines::crossing`] alone, so that a line
//! and a contour that are cut at each other end in the same bits.

use std::ops::RangeInclusive;

use crate::error::ArrangementError;
use crate::limit::{CELL, LIMIT};
use crate::partition::properties::StripesProperties;
use fretwork_geometry::budget;
use fretwork_geometry::{Bounds, LabelSet, Point, Region};

/// The lines of a [`StripesProperties`] around an anchor. Line k lies at `offset(k)` along the
/// normal, stripe k between the lines k and k + 1, the anchor in the middle of stripe 0.
pub(crate) struct Lines<'a> {
    /// Unit vector along the lines.
    pub direction: Point,
    /// Unit vector across them, to the left of `direction`.
    pub normal: Point,
    /// The point that offsets are measured from.
    pub anchor: Point,
    /// Offsets of the first lines from line 0, one cycle.
    starts: Vec<f64>,
    cycle: f64,
    properties: &'a StripesProperties,
}

/// What a region leaves of one line; `from` comes before `to` along the line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Piece {
    pub line: i64,
    pub from: Point,
    pub to: Point,
}

/// A crossing of a line with the border: the line, the place along it, the point.
type Crossing = (i64, f64, Point);

impl<'a> Lines<'a> {
    /// Fails for an angle that is not finite, and for spacings that are not above `resolution`.
    pub fn new(
        properties: &'a StripesProperties,
        anchor: Point,
        resolution: f64,
    ) -> Result<Self, ArrangementError> {
        if !properties.angle.is_finite() {
            return Err(ArrangementError::Angle(properties.angle));
        }
        if properties.spacing.is_empty() {
            return Err(ArrangementError::NoSpacing);
        }
        let mut cycle = 0.0;
        let mut starts = Vec::with_capacity(properties.spacing.len());
        for &spacing in &properties.spacing {
            if !(spacing.is_finite() && spacing > resolution.max(0.0)) {
                return Err(ArrangementError::Spacing {
                    spacing,
                    least: resolution,
                });
            }
            starts.push(cycle);
            cycle += spacing;
        }
        if !cycle.is_finite() {
            return Err(ArrangementError::Spacing {
                spacing: cycle,
                least: resolution,
            });
        }
        // Sines of multiples of a quarter turn are 0, not 6e-17, so that such lines are upright.
        let clean = |v: f64| if v.abs() < 1e-15 { 0.0 } else { v };
        let direction = Point::new(
            clean(libm::cos(properties.angle)),
            clean(libm::sin(properties.angle)),
        );
        Ok(Lines {
            direction,
            normal: direction.left(),
            anchor,
            starts,
            cycle,
            properties,
        })
    }

    /// The signed distance of `p` from the anchor along the normal.
    pub fn distance(&self, p: Point) -> f64 {
        self.normal.dot(p - self.anchor)
    }

    /// The signed distance of line `k` from the anchor along the normal.
    pub fn offset(&self, k: i64) -> f64 {
        let n = self.starts.len() as i64;
        k.div_euclid(n) as f64 * self.cycle + self.starts[k.rem_euclid(n) as usize]
            - self.properties.spacing[0] / 2.0
    }

    /// The stripe that holds what is at `distance`; a line belongs to the stripe after it.
    pub fn stripe(&self, distance: f64) -> i64 {
        let from_first = distance + self.properties.spacing[0] / 2.0;
        let turns = (from_first / self.cycle).floor();
        let rest = from_first - turns * self.cycle;
        let within = self.starts.partition_point(|start| *start <= rest).max(1) - 1;
        let mut k = turns as i64 * self.starts.len() as i64 + within as i64;
        // The estimate may be one off by rounding; `offset` decides.
        while self.offset(k) > distance {
            k -= 1;
        }
        while self.offset(k + 1) <= distance {
            k += 1;
        }
        k
    }

    /// The label of line `k`.
    pub fn edge_label(&self, k: i64) -> LabelSet {
        cyclic(&self.properties.edge_labels, k)
    }

    /// The label of stripe `k`.
    pub fn face_label(&self, k: i64) -> LabelSet {
        cyclic(&self.properties.face_labels, k)
    }

    /// The length of the cycle of face labels, at least 1.
    pub fn face_cycle(&self) -> usize {
        self.properties.face_labels.len().max(1)
    }

    /// Fails when `points` are not finite or spread over more stripes than [`LIMIT`].
    pub fn check_extent(
        &self,
        points: impl IntoIterator<Item = Point>,
    ) -> Result<(), ArrangementError> {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for p in points {
            let d = self.distance(p);
            if !d.is_finite() {
                return Err(ArrangementError::Region);
            }
            (low, high) = (low.min(d), high.max(d));
        }
        let count = (high - low).max(0.0) / self.cycle * self.starts.len() as f64;
        if count < LIMIT as f64 {
            budget::make("lines", count as usize, CELL);
            Ok(())
        } else {
            Err(ArrangementError::TooMany {
                what: "lines",
                count,
            })
        }
    }

    /// Where line `k` crosses the segment from `a` to `b` and at which part of the segment; an end
    /// of the segment, exactly, when the line passes it by. The same bits for `b` to `a`.
    pub fn crossing(&self, k: i64, a: Point, b: Point) -> (f64, Point) {
        if (b.x, b.y) < (a.x, a.y) {
            let (u, p) = self.crossing(k, b, a);
            return (1.0 - u, p);
        }
        let (da, db) = (self.distance(a), self.distance(b));
        let u = (self.offset(k) - da) / (db - da);
        if u > 0.0 && u < 1.0 {
            (u, a.lerp(b, u))
        } else if (self.offset(k) - da).abs() <= (self.offset(k) - db).abs() {
            (0.0, a)
        } else {
            (1.0, b)
        }
    }

    /// The lines that separate stripes `i` and `j`.
    pub fn between(i: i64, j: i64) -> RangeInclusive<i64> {
        i.min(j) + 1..=i.max(j)
    }

    /// The lines that come into a room, and one more on either side; all where there is none.
    pub fn through(&self, room: Option<&Bounds>) -> RangeInclusive<i64> {
        let Some(room) = room else {
            return i64::MIN..=i64::MAX;
        };
        let Bounds { min, max } = *room;
        let corners = [min, Point::new(max.x, min.y), max, Point::new(min.x, max.y)];
        let stripes = corners.map(|corner| self.stripe(self.distance(corner)));
        let [low, high] = stripes.iter().fold([i64::MAX, i64::MIN], |[low, high], k| {
            [low.min(*k), high.max(*k)]
        });
        low - 1..=high + 2
    }

    /// The parts of some of the lines inside the closed `region`, by line and then along it. Lines that run
    /// within `tolerance` of the border are inside.
    pub fn clip(
        &self,
        region: &Region,
        tolerance: f64,
        some: &RangeInclusive<i64>,
    ) -> Result<Vec<Piece>, ArrangementError> {
        // Even-odd on lines moved a little to either side: whatever touches the region is inside
        // of one of the two, and neither meets a corner by accident twice.
        let mut spans = self.inside(region, tolerance, some)?;
        spans.extend(self.inside(region, -tolerance, some)?);
        spans.sort_by(|(a, _), (b, _)| (a.0).cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let mut pieces: Vec<(Piece, f64)> = Vec::with_capacity(spans.len() / 2);
        for ((line, start, from), (_, end, to)) in spans {
            match pieces.last_mut() {
                Some((last, last_end)) if last.line == line && start <= *last_end + tolerance => {
                    if end > *last_end {
                        (last.to, *last_end) = (to, end);
                    }
                }
                _ => pieces.push((Piece { line, from, to }, end)),
            }
        }
        pieces.retain(|(p, _)| p.from.distance(p.to) > tolerance);
        Ok(pieces.into_iter().map(|(piece, _)| piece).collect())
    }

    /// The pairs of crossings between which each line, moved by `shift`, is inside.
    fn inside(
        &self,
        region: &Region,
        shift: f64,
        some: &RangeInclusive<i64>,
    ) -> Result<Vec<(Crossing, Crossing)>, ArrangementError> {
        let mut crossings: Vec<Crossing> = Vec::new();
        for ring in region.area.iter().flat_map(|polygon| polygon.rings()) {
            let stripes: Vec<i64> = ring
                .iter()
                .map(|p| self.stripe(self.distance(*p) + shift))
                .collect();
            for (i, &b) in ring.iter().enumerate() {
                let j = if i == 0 { ring.len() - 1 } else { i - 1 };
                let lines = Self::between(stripes[j], stripes[i]);
                let lines = *lines.start().max(some.start())..=*lines.end().min(some.end());
                if crossings.len() + lines.clone().count() > 4 * LIMIT {
                    return Err(ArrangementError::TooMany {
                        what: "crossings with the border",
                        count: 4e7,
                    });
                }
                let count = crossings.len() + lines.clone().count();
                budget::hold("crossings with the border", count, size_of::<Crossing>());
                crossings.extend(lines.map(|k| {
                    let (_, p) = self.crossing(k, ring[j], b);
                    (k, self.direction.dot(p - self.anchor), p)
                }));
            }
        }
        crossings.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        // Rings are closed, so every line is crossed an even number of times.
        Ok(crossings
            .chunks_exact(2)
            .map(|pair| (pair[0], pair[1]))
            .collect())
    }
}

fn cyclic(labels: &[LabelSet], k: i64) -> LabelSet {
    if labels.is_empty() {
        LabelSet::EMPTY
    } else {
        labels[k.rem_euclid(labels.len() as i64) as usize]
    }
}
