//! Labelled polylines, points that stand alone, and named points: what an arrangement gives for a region, and what a
//! planar map is built from.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use rayon::prelude::*;

use crate::{Affine, Bounds, LabelSet, Point, budget};

/// The labels that a curve carries for the cells it will bound (Loi 2015, section 3.2): its own,
/// those of the faces on either side, those of the vertices at its ends. Left of the direction
/// (dx, dy) is (-dy, dx).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct CurveLabels {
    /// Of the edges along the curve.
    pub edge: LabelSet,
    /// Of the faces on its left.
    pub left: LabelSet,
    /// Of the faces on its right.
    pub right: LabelSet,
    /// Of the vertex at its first point.
    pub start: LabelSet,
    /// Of the vertex at its last point.
    pub end: LabelSet,
}

impl CurveLabels {
    /// Labels of the edges only.
    pub fn edge(edge: LabelSet) -> CurveLabels {
        CurveLabels {
            edge,
            ..CurveLabels::default()
        }
    }

    /// The labels of the same curve run backwards.
    pub fn reversed(self) -> CurveLabels {
        CurveLabels {
            edge: self.edge,
            left: self.right,
            right: self.left,
            start: self.end,
            end: self.start,
        }
    }
}

/// One curve of a [`Curves`]: a polyline of two or more points, closed when the first and the
/// last are the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve<'a> {
    /// The polyline.
    pub points: &'a [Point],
    /// What it carries.
    pub labels: CurveLabels,
}

/// A list of oriented, labelled polylines, labelled points that stand alone, and named points. Stored flat: a curve costs its
/// points and 24 bytes. The order of the curves is part of the value.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Curves {
    points: Vec<Point>,
    ends: Vec<u32>,
    labels: Vec<CurveLabels>,
    named: Vec<(Arc<str>, Point)>,
    lone: Vec<(Point, LabelSet)>,
}

impl Curves {
    /// No curves.
    pub fn new() -> Curves {
        Curves::default()
    }

    /// No curves, with room for so many curves of so many points in all.
    pub fn with_capacity(curves: usize, points: usize) -> Curves {
        Curves {
            points: Vec::with_capacity(points),
            ends: Vec::with_capacity(curves),
            labels: Vec::with_capacity(curves),
            named: Vec::new(),
            lone: Vec::new(),
        }
    }

    /// The curves of all of these, in order; of points with one name the first stays. Room is made for all of them at
    /// once: a list that grows takes half as much again whenever it is moved.
    pub fn concatenated(parts: &[Arc<Curves>]) -> Curves {
        let count = |of: fn(&Curves) -> usize| parts.iter().map(|part| of(part)).sum();
        let points = count(|part| part.points.len());
        budget::hold("points put together", points, size_of::<Point>());
        let mut all = Curves::with_capacity(count(Curves::len), points);
        parts.iter().for_each(|part| all.append(part));
        all
    }

    /// How many curves there are.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is no curve (there may be points).
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The curve numbered `i`.
    pub fn get(&self, i: usize) -> Curve<'_> {
        let start = if i == 0 { 0 } else { self.ends[i - 1] as usize };
        Curve {
            points: &self.points[start..self.ends[i] as usize],
            labels: self.labels[i],
        }
    }

    /// The curves in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Curve<'_>> + Clone {
        (0..self.len()).map(|i| self.get(i))
    }

    /// All points of all curves in order.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Adds a curve; one of fewer than two points is dropped.
    pub fn push(&mut self, points: impl IntoIterator<Item = Point>, labels: CurveLabels) {
        let start = self.points.len();
        self.points.extend(points);
        if self.points.len() < start + 2 {
            self.points.truncate(start);
            return;
        }
        self.ends
            .push(u32::try_from(self.points.len()).expect("curves have fewer than 2^32 points"));
        self.labels.push(labels);
    }

    /// Adds a point that is a vertex without edges, with its labels.
    pub fn push_lone(&mut self, at: Point, labels: LabelSet) {
        self.lone.push((at, labels));
    }

    /// The points that stand alone, in order.
    pub fn lone(&self) -> &[(Point, LabelSet)] {
        &self.lone
    }

    /// Names a point; the first of a name wins.
    pub fn name_point(&mut self, name: impl Into<Arc<str>>, at: Point) {
        let name = name.into();
        if self.point_named(&name).is_none() {
            self.named.push((name, at));
        }
    }

    /// The named points in order.
    pub fn named_points(&self) -> &[(Arc<str>, Point)] {
        &self.named
    }

    /// The point named `name`.
    pub fn point_named(&self, name: &str) -> Option<Point> {
        self.named
            .iter()
            .find(|(n, _)| &**n == name)
            .map(|(_, p)| *p)
    }

    /// Adds the curves of `other` after these; of points with one name the first stays.
    pub fn append(&mut self, other: &Curves) {
        let base = u32::try_from(self.points.len()).expect("curves have fewer than 2^32 points");
        self.points.extend_from_slice(&other.points);
        self.ends.extend(other.ends.iter().map(|e| {
            base.checked_add(*e)
                .expect("curves have fewer than 2^32 points")
        }));
        self.labels.extend_from_slice(&other.labels);
        self.lone.extend_from_slice(&other.lone);
        for (name, at) in &other.named {
            self.name_point(name.clone(), *at);
        }
    }

    /// Adds the curves of `other`, moved by `by`, after these; points that are none of theirs are left out.
    pub fn append_moved(&mut self, other: &Curves, by: Point) {
        let base = u32::try_from(self.points.len()).expect("curves have fewer than 2^32 points");
        self.points.extend(other.points.iter().map(|p| *p + by));
        self.ends.extend(other.ends.iter().map(|e| {
            base.checked_add(*e)
                .expect("curves have fewer than 2^32 points")
        }));
        self.labels.extend_from_slice(&other.labels);
    }

    /// A copy of the curves moved by each of `moves`, one after another, without other points; on all threads of the
    /// pool. None where there would be 2^32 points or more. Time and memory grow with the copies.
    ///
    /// ```
    /// use fretwork_geometry::{CurveLabels, Curves, Point};
    /// let mut line = Curves::new();
    /// line.push([Point::ORIGIN, Point::new(1.0, 0.0)], CurveLabels::default());
    /// let rows = line.copies(&[Point::ORIGIN, Point::new(0.0, 2.0)]).unwrap();
    /// assert_eq!(rows.get(1).points, [Point::new(0.0, 2.0), Point::new(1.0, 2.0)]);
    /// ```
    pub fn copies(&self, moves: &[Point]) -> Option<Curves> {
        let (points, curves) = (self.points.len(), self.ends.len());
        let all = points.checked_mul(moves.len())?;
        u32::try_from(all).ok()?;
        let mut copies = Curves {
            points: vec![Point::ORIGIN; all],
            ends: vec![0; curves * moves.len()],
            labels: vec![CurveLabels::default(); curves * moves.len()],
            named: Vec::new(),
            lone: Vec::new(),
        };
        if curves == 0 {
            return Some(copies);
        }
        let of_points = copies.points.par_chunks_exact_mut(points);
        let of_ends = copies.ends.par_chunks_exact_mut(curves);
        let of_labels = copies.labels.par_chunks_exact_mut(curves);
        let of_each = of_points.zip(of_ends).zip(of_labels).zip(moves).enumerate();
        // A copy is small; so many make it worth while to hand work to another thread.
        let of_each = of_each.with_min_len(1 + (1 << 14) / points);
        of_each.for_each(|(n, (((to, ends), labels), by))| {
            let moved = self.points.iter().map(|p| *p + *by);
            to.iter_mut().zip(moved).for_each(|(to, p)| *to = p);
            let base = (n * points) as u32;
            let own = ends.iter_mut().zip(&self.ends);
            own.for_each(|(end, own)| *end = base + own);
            labels.copy_from_slice(&self.labels);
        });
        Some(copies)
    }

    /// The box of the curves and of the points that stand alone; named points do not count.
    pub fn bounds(&self) -> Bounds {
        let lone = self.lone.iter().map(|(p, _)| *p);
        Bounds::of(self.points.iter().copied().chain(lone))
    }

    /// The image under `map`, other points too. Where the map mirrors, left and right labels
    /// change places, so that a label stays on the face it was on.
    pub fn transformed(&self, map: &Affine) -> Curves {
        let mut image = self.clone();
        image.points.iter_mut().for_each(|p| *p = map.apply(*p));
        image.named.iter_mut().for_each(|(_, p)| *p = map.apply(*p));
        image.lone.iter_mut().for_each(|(p, _)| *p = map.apply(*p));
        if map.determinant() < 0.0 {
            image
                .labels
                .iter_mut()
                .for_each(|l| std::mem::swap(&mut l.left, &mut l.right));
        }
        image
    }

    /// Every curve run backwards, in the same order.
    pub fn reversed(&self) -> Curves {
        let mut image = Curves {
            named: self.named.clone(),
            lone: self.lone.clone(),
            ..Curves::default()
        };
        for curve in self.iter() {
            image.push(curve.points.iter().rev().copied(), curve.labels.reversed());
        }
        image
    }

    /// The curves whose index and value satisfy `keep`; other points stay.
    pub fn filtered(&self, mut keep: impl FnMut(usize, Curve<'_>) -> bool) -> Curves {
        let mut kept = Curves {
            named: self.named.clone(),
            lone: self.lone.clone(),
            ..Curves::default()
        };
        for (i, curve) in self.iter().enumerate() {
            if keep(i, curve) {
                kept.push(curve.points.iter().copied(), curve.labels);
            }
        }
        kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_kept_flat_and_in_order() {
        let mut curves = Curves::new();
        curves.push(
            [Point::ORIGIN, Point::new(1.0, 0.0)],
            CurveLabels::edge(LabelSet::one("a")),
        );
        curves.push([Point::ORIGIN], CurveLabels::default());
        let copy = curves.clone();
        curves.append(&copy);
        assert_eq!(curves.len(), 2);
        assert_eq!(curves.get(1).points, [Point::ORIGIN, Point::new(1.0, 0.0)]);
        assert!(curves.get(1).labels.edge.contains("a"));
    }

    #[test]
    fn mirroring_keeps_labels_on_their_faces() {
        let labels = CurveLabels {
            left: LabelSet::one("in"),
            ..CurveLabels::default()
        };
        let mut curves = Curves::new();
        curves.push([Point::ORIGIN, Point::new(1.0, 0.0)], labels);
        let mirrored = curves.transformed(&Affine::scale(1.0, -1.0));
        assert!(
            mirrored.get(0).labels.right.contains("in") && mirrored.get(0).labels.left.is_empty()
        );
    }
}
