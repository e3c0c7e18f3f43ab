//! What is drawn in a seamless tile, completed across its sides.

use std::collections::HashMap;
use std::sync::Arc;

use fretwork_geometry::{Bounds, Curve, Curves, Point, Region};

/// Curves are the same when they are as near as this part of the tile's longer side.
const SAME: f64 = 1e-6;
/// An element covers at most so many tiles in a row.
const FARTHEST: f64 = 16.0;

/// The curves of a tile with copies of those that cross a side of it, where the copy is missing on the
/// other side: an element may reach farther into the tile than the cells whose elements were
/// drawn. What lies outside, or along a side, is not repeated. Nothing changes without a period.
///
/// Time grows with the number of curves.
pub(crate) fn closed(curves: Arc<Curves>, region: &Region) -> Arc<Curves> {
    let Some(period) = region.period else {
        return curves;
    };
    let near = SAME * region.bounds().longer_side();
    let inner = region.bounds().grown(-near);
    let mut known = Known {
        near,
        by_corner: HashMap::new(),
    };
    for curve in curves.iter() {
        known.takes(&outline(&curve, Point::ORIGIN));
    }
    let mut copies = Curves::new();
    for curve in curves
        .iter()
        .filter(|curve| reaches(curve, Point::ORIGIN, &inner))
    {
        for by in moves(&outline(&curve, Point::ORIGIN).bounds, &inner, period) {
            if reaches(&curve, by, &inner) && known.takes(&outline(&curve, by)) {
                copies.push(curve.points.iter().map(|p| *p + by), curve.labels);
            }
        }
    }
    if copies.is_empty() {
        return curves;
    }
    let mut all = Curves::clone(&curves);
    all.append(&copies);
    Arc::new(all)
}

/// The moves by whole periods that bring a box to the inside of the tile.
fn moves(bounds: &Bounds, inner: &Bounds, period: Point) -> Vec<Point> {
    let range = |low: f64, high: f64, from: f64, to: f64, period: f64| {
        let [first, last] =
            [(from - high) / period, (to - low) / period].map(|n| n.clamp(-FARTHEST, FARTHEST));
        libm::ceil(first) as i64..=libm::floor(last) as i64
    };
    let columns = range(
        bounds.min.x,
        bounds.max.x,
        inner.min.x,
        inner.max.x,
        period.x,
    );
    let rows = range(
        bounds.min.y,
        bounds.max.y,
        inner.min.y,
        inner.max.y,
        period.y,
    );
    columns
        .flat_map(|i| {
            rows.clone()
                .map(move |j| Point::new(i as f64 * period.x, j as f64 * period.y))
        })
        .collect()
}

/// Whether a segment of the curve, moved, passes through the inside of the tile, as far as boxes tell.
fn reaches(curve: &Curve<'_>, by: Point, inner: &Bounds) -> bool {
    curve
        .points
        .windows(2)
        .any(|ends| Bounds::of(ends.iter().map(|p| *p + by)).intersects(inner))
}

/// What tells curves apart: the box, the first point and the number of points.
struct Outline {
    bounds: Bounds,
    first: Point,
    points: usize,
}

fn outline(curve: &Curve<'_>, by: Point) -> Outline {
    let bounds = Bounds::of(curve.points.iter().map(|p| *p + by));
    Outline {
        bounds,
        first: curve.points.first().map_or(by, |p| *p + by),
        points: curve.points.len(),
    }
}

/// The curves that are there.
struct Known {
    near: f64,
    by_corner: HashMap<[i64; 2], Vec<Outline>>,
}

impl Known {
    /// Adds a curve, if it is not there yet.
    fn takes(&mut self, outline: &Outline) -> bool {
        let corner = |p: Point| [p.x, p.y].map(|v| libm::floor(v / (4.0 * self.near)) as i64);
        let at = corner(outline.bounds.min);
        let is_same = |other: &Outline| {
            let apart = [
                outline.bounds.min.distance(other.bounds.min),
                outline.bounds.max.distance(other.bounds.max),
                outline.first.distance(other.first),
            ];
            other.points == outline.points && apart.iter().all(|d| *d <= self.near)
        };
        let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [at[0] + i, at[1] + j]));
        if around
            .filter_map(|cell| self.by_corner.get(&cell))
            .flatten()
            .any(is_same)
        {
            return false;
        }
        let Outline {
            bounds,
            first,
            points,
        } = *outline;
        self.by_corner.entry(at).or_default().push(Outline {
            bounds,
            first,
            points,
        });
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::{CurveLabels, LabelSet};

    fn tile() -> Region {
        let mut tile = Region::rectangle(Point::new(-5.0, 0.0), Point::new(5.0, 8.0));
        tile.period = Some(Point::new(10.0, 8.0));
        tile
    }

    fn of(lines: &[[[f64; 2]; 2]]) -> Arc<Curves> {
        let mut curves = Curves::new();
        for line in lines {
            curves.push(line.map(Point::from), CurveLabels::edge(LabelSet::one("a")));
        }
        Arc::new(curves)
    }

    #[test]
    fn what_crosses_a_side_is_there_on_both() {
        let crossing = of(&[[[3.0, 4.0], [6.0, 5.0]], [[4.0, 7.0], [7.0, 9.0]]]);
        let whole = closed(crossing.clone(), &tile());
        assert_eq!(
            whole.len(),
            6,
            "one copy of the first line, and three around the corner of the other"
        );
        assert_eq!(
            whole.get(2).points,
            [[-7.0, 4.0], [-4.0, 5.0]].map(Point::from)
        );
        assert!(whole.get(2).labels.edge.contains("a"));
        assert_eq!(
            closed(whole.clone(), &tile()),
            whole,
            "nothing is missing any more"
        );
        assert_eq!(
            closed(
                crossing.clone(),
                &Region {
                    period: None,
                    ..tile()
                }
            ),
            crossing
        );
    }

    #[test]
    fn what_lies_outside_or_along_a_side_is_left_alone() {
        let lines = of(&[
            [[-5.0, 0.0], [-5.0, 8.0]],
            [[5.0, 8.0], [-5.0, 8.0]],
            [[11.0, 3.0], [12.0, 4.0]],
        ]);
        assert_eq!(closed(lines.clone(), &tile()), lines);
        let copies = of(&[[[4.0, 4.0], [6.0, 5.0]], [[-6.0 + 1e-9, 4.0], [-4.0, 5.0]]]);
        assert_eq!(closed(copies.clone(), &tile()), copies);
    }
}
