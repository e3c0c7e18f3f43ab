//! Isolines: the lines on which a field has a round value, by marching squares.

use crate::error::ArrangementError;
use crate::limit::LIMIT;
use crate::mask::crop::crop;
use fretwork_geometry::budget;
use fretwork_geometry::{Bounds, CurveLabels, Curves, Field, LabelSet, Point, Region, Tile};

/// Steps for a sample of a field, which may be a formula.
const SAMPLE: u64 = 30;

/// Bytes for a piece of an isoline until it is part of a line that is cropped.
const PIECE: usize = 150;

/// Squares along the longer side of a region, for a field that is not made of samples.
const SQUARES: f64 = 256.0;

/// The lines in `region` on which `field` has a multiple of `every`, which must be positive, each with
/// its value as its edge label and the greater values on its left.
///
/// The field is sampled at the middles of squares of the plane, as wide as the distance of the field's
/// samples, or a 256th of the region's longer side where it has none, and taken for bilinear
/// between four samples; where both diagonals of a square lie on different sides of the value, the bilinear
/// surface decides which corners are connected. There is no line where the field has no value. In a
/// tile the squares are a little smaller, so that they fit it.
///
/// # Errors
/// When a field that is not made of samples is not the same on opposite sides of a tile.
/// When there are too many squares or lines.
pub fn isolines(
    field: &Field,
    every: f64,
    region: &Region,
    resolution: f64,
) -> Result<Curves, ArrangementError> {
    let bounds = region.bounds();
    if bounds.is_empty() {
        return Ok(Curves::new());
    }
    if !(every.is_finite() && every > 0.0) {
        return Err(ArrangementError::Spacing {
            spacing: every,
            least: 0.0,
        });
    }
    let step = field.spacing().unwrap_or(bounds.longer_side() / SQUARES);
    let tile = region.tile();
    if let Some(tile) = tile.filter(|_| field.spacing().is_none()) {
        check_period(field, &tile)?;
    }
    // Squares that fit a tile a whole number of times are the same one period further.
    let fit = |period: f64| period / libm::ceil(period / step);
    let steps = tile.map_or(Point::new(step, step), |t| {
        Point::new(fit(t.period.x), fit(t.period.y))
    });
    let samples = Samples::over(
        |p| field.value(tile.map_or(p, |t| t.wrap(p))),
        &bounds,
        steps,
    )?;
    let mut curves = Curves::new();
    for of_level in samples.segments(every)?.chunk_by(|a, b| a.level == b.level) {
        let label = LabelSet::one(&round_value(of_level[0].level, every));
        for line in join(of_level) {
            let points = line
                .iter()
                .map(|side| samples.crossing(*side, of_level[0].level as f64 * every));
            curves.push(points, CurveLabels::edge(label));
        }
    }
    crop(&curves, region, resolution)
}

/// Fails when the field is not the same one period further, as far as places along two sides of the tile
/// tell.
fn check_period(field: &Field, tile: &Tile) -> Result<(), ArrangementError> {
    let parts = |n: u32| (0..n).map(move |k| f64::from(k) / f64::from(n));
    let left = parts(64).map(|t| {
        (
            Point::new(0.0, t * tile.period.y),
            Point::new(tile.period.x, 0.0),
        )
    });
    let low = parts(64).map(|t| {
        (
            Point::new(t * tile.period.x, 0.0),
            Point::new(0.0, tile.period.y),
        )
    });
    let pairs = left.chain(low).map(|(p, period)| {
        let at = tile.corner + p;
        (at, field.value(at), field.value(at + period))
    });
    let pairs: Vec<(Point, f64, f64)> = pairs.collect();
    let greatest = pairs
        .iter()
        .fold(0.0, |most: f64, (_, a, b)| most.max(a.abs()).max(b.abs()));
    let differs =
        |a: f64, b: f64| a.is_finite() != b.is_finite() || (a - b).abs() > 1e-6 * greatest;
    match pairs
        .into_iter()
        .find(|(_, here, there)| differs(*here, *there))
    {
        Some((at, here, there)) => Err(ArrangementError::FieldPeriod { at, here, there }),
        None => Ok(()),
    }
}

/// The value of a level in at most twelve digits, so that 3 · 0.1 is 0.3.
fn round_value(level: i64, every: f64) -> String {
    let value = level as f64 * every;
    let digits = 11 - libm::floor(libm::log10(value.abs().max(1e-300))) as i32;
    let factor = libm::exp10(f64::from(digits.clamp(-250, 250)));
    let rounded = libm::round(value * factor) / factor;
    format!(
        "{}",
        if rounded.is_finite() && rounded != 0.0 {
            rounded
        } else {
            value + 0.0
        }
    )
}

/// A side between neighbouring samples: twice the number of the first, plus 1 when the other is above it.
type GridSide = usize;

/// A piece of an isoline through a square.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Segment {
    level: i64,
    from: GridSide,
    to: GridSide,
}

/// A square between four samples.
#[derive(Clone, Copy)]
struct Square {
    /// The number of the sample at its lower left corner.
    first: usize,
    /// The values at its corners, counter-clockwise.
    corners: [f64; 4],
}

/// Samples of a field on a lattice.
struct Samples {
    origin: Point,
    step: Point,
    columns: usize,
    values: Vec<f64>,
}

impl Samples {
    fn over(
        value: impl Fn(Point) -> f64,
        bounds: &Bounds,
        step: Point,
    ) -> Result<Samples, ArrangementError> {
        let index = |v: f64, step: f64| (v / step - 0.5).floor();
        let (low, high) = (bounds.min, bounds.max);
        let first = Point::new(index(low.x, step.x), index(low.y, step.y));
        let (columns, rows) = (
            index(high.x, step.x) - first.x + 2.0,
            index(high.y, step.y) - first.y + 2.0,
        );
        let too_many = columns * rows > LIMIT as f64;
        if too_many || !(columns * rows).is_finite() {
            return Err(ArrangementError::TooMany {
                what: "squares of an isoline's lattice",
                count: columns * rows,
            });
        }
        let origin = Point::new((first.x + 0.5) * step.x, (first.y + 0.5) * step.y);
        let (columns, rows) = (columns as usize, rows as usize);
        budget::make("squares of a lattice", columns * rows, size_of::<f64>());
        budget::spend("squares of a lattice", SAMPLE * (columns * rows) as u64);
        let mut samples = Samples {
            origin,
            step,
            columns,
            values: Vec::new(),
        };
        samples.values = (0..columns * rows).map(|i| value(samples.at(i))).collect();
        Ok(samples)
    }

    fn at(&self, i: usize) -> Point {
        let (column, row) = ((i % self.columns) as f64, (i / self.columns) as f64);
        self.origin + Point::new(column * self.step.x, row * self.step.y)
    }

    /// Where the field has `value` between two samples; the same for the squares on either side.
    fn crossing(&self, side: GridSide, value: f64) -> Point {
        let (i, j) = (
            side / 2,
            side / 2
                + if side.is_multiple_of(2) {
                    1
                } else {
                    self.columns
                },
        );
        let part = (value - self.values[i]) / (self.values[j] - self.values[i]);
        self.at(i).lerp(self.at(j), part.clamp(0.0, 1.0))
    }

    /// All pieces, by level and then by where they begin.
    fn segments(&self, every: f64) -> Result<Vec<Segment>, ArrangementError> {
        let mut segments = Vec::new();
        let rows = self.values.len() / self.columns;
        for (row, column) in (0..rows - 1).flat_map(|r| (0..self.columns - 1).map(move |c| (r, c)))
        {
            let i = row * self.columns + column;
            let corners =
                [i, i + 1, i + self.columns + 1, i + self.columns].map(|k| self.values[k]);
            let (low, high) = corners
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |r, v| {
                    (r.0.min(*v), r.1.max(*v))
                });
            if corners.iter().any(|v| !v.is_finite()) {
                continue;
            }
            let (first, last) = ((low / every).floor(), (high / every).floor());
            let (count, farthest) = (
                last - first + segments.len() as f64,
                first.abs().max(last.abs()),
            );
            if count > 4.0 * LIMIT as f64 || farthest > 1e15 {
                let count = if farthest > 1e15 { farthest } else { count };
                return Err(ArrangementError::TooMany {
                    what: "segments of isolines",
                    count,
                });
            }
            let pieces = (last - first) as usize;
            if pieces > 0 {
                budget::hold("segments of isolines", pieces + segments.len(), PIECE);
                budget::spend("segments of isolines", 4 * pieces as u64);
            }
            for level in first as i64..=last as i64 {
                self.march(Square { first: i, corners }, level, every, &mut segments);
            }
        }
        segments.sort_unstable();
        Ok(segments)
    }

    /// Adds the pieces of one level in a square to `out`.
    fn march(&self, square: Square, level: i64, every: f64, out: &mut Vec<Segment>) {
        let Square { first: i, corners } = square;
        let value = level as f64 * every;
        let above = corners.map(|v| v >= value);
        // Sides in counter-clockwise order, the n-th from corner n to the next.
        let sides = [2 * i, 2 * (i + 1) + 1, 2 * (i + self.columns), 2 * i + 1];
        // A line comes in where the corners change from above to below, and leaves where they change
        // back: so what is above is on its left.
        let goes_down: Vec<usize> = (0..4)
            .filter(|n| above[*n] && !above[(n + 1) % 4])
            .collect();
        let goes_up: Vec<usize> = (0..4)
            .filter(|n| !above[*n] && above[(n + 1) % 4])
            .collect();
        let mut add = |from: usize, to: usize| {
            out.push(Segment {
                level,
                from: sides[from],
                to: sides[to],
            })
        };
        match (goes_down.as_slice(), goes_up.as_slice()) {
            ([down], [up]) => add(*down, *up),
            ([first, second], [_, _]) => {
                let [a, b, c, d] = corners.map(|v| v - value);
                // The bilinear surface's saddle is above when the product of the high diagonal is greater.
                let middle_is_above = (a * c - b * d) / (a + c - b - d) >= 0.0;
                // High corners that are connected have the low ones cut off, each by its two sides.
                for down in [*first, *second] {
                    add(
                        down,
                        if middle_is_above {
                            (down + 1) % 4
                        } else {
                            (down + 3) % 4
                        },
                    );
                }
            }
            _ => {}
        }
    }
}

/// The lines that the pieces of one level, sorted by where they begin, make up, as the sides that
/// they cross; a closed one repeats its first side.
fn join(segments: &[Segment]) -> Vec<Vec<GridSide>> {
    let next = |side: GridSide| segments.binary_search_by_key(&side, |s| s.from).ok();
    let mut is_continued = vec![false; segments.len()];
    for segment in segments {
        if let Some(n) = next(segment.to) {
            is_continued[n] = true;
        }
    }
    let mut done = vec![false; segments.len()];
    let open = (0..segments.len()).filter(|n| !is_continued[*n]);
    let closed = (0..segments.len()).filter(|n| is_continued[*n]);
    let mut lines = Vec::new();
    for start in open.chain(closed) {
        if done[start] {
            continue;
        }
        let mut line = vec![segments[start].from];
        let mut at = Some(start);
        while let Some(n) = at.filter(|n| !done[*n]) {
            done[n] = true;
            line.push(segments[n].to);
            at = next(segments[n].to);
        }
        lines.push(line);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Raster;
    use fretwork_geometry::planar_map::{PlanarMap, resolution};
    use std::f64::consts::PI;
    use std::sync::Arc;

    fn page(side: f64) -> Region {
        Region::rectangle(Point::ORIGIN, Point::new(side, side))
    }

    fn lines(field: &Field, every: f64, side: f64) -> Curves {
        isolines(field, every, &page(side), resolution(side)).unwrap()
    }

    #[test]
    fn a_cone_has_circles_with_what_is_higher_on_their_left() {
        let middle = Point::new(50.0, 50.0);
        let curves = lines(
            &Field::new([1; 32], move |p| 33.0 - p.distance(middle)),
            10.0,
            100.0,
        );
        // Those of 30 to -10 are whole; -20 and -30 are four arcs each.
        let closed = curves
            .iter()
            .filter(|c| c.points.first() == c.points.last());
        for circle in closed.clone() {
            let value: f64 = circle.labels.edge.names()[0].parse().unwrap();
            let length: f64 = circle.points.windows(2).map(|w| w[0].distance(w[1])).sum();
            assert!((length / (2.0 * PI * (33.0 - value)) - 1.0).abs() < 1e-2);
            assert!(fretwork_geometry::polygon::signed_area(circle.points) > 0.0);
        }
        assert_eq!((closed.count(), curves.len()), (5, 13));
    }

    #[test]
    fn saddles_are_decided_by_the_surface_and_values_on_samples_join() {
        let raster = |values: [f64; 4]| {
            Field::raster(
                Arc::new(Raster {
                    origin: Point::ORIGIN,
                    step: Point::new(1.0, 1.0),
                    width: 2,
                    values: values.to_vec(),
                }),
                true,
            )
        };
        for (values, labels) in [
            ([3.0, 0.0, 0.0, 4.0], 2),
            ([1.2, 0.0, 0.0, 1.2], 2),
            ([1.0, 1.0, 1.0, 1.0], 0),
        ] {
            let field = raster(values);
            let curves = lines(&field, 1.0, 2.0);
            let map = PlanarMap::build(&curves, resolution(2.0)).unwrap();
            let at_one = curves
                .iter()
                .filter(|c| c.labels.edge.contains("1"))
                .count();
            assert!(at_one <= labels, "{values:?}");
            for curve in curves.iter() {
                let value: f64 = curve.labels.edge.names()[0].parse().unwrap();
                for w in curve.points.windows(2) {
                    let left = w[0].lerp(w[1], 0.5) + (w[1] - w[0]).left() * 1e-3;
                    let off = field.value(left) - value;
                    // A chord of a hyperbola lies on one side of it.
                    assert!(off > -0.15, "{values:?} {off}");
                }
            }
            assert_eq!(map.face_count(), 0);
        }
    }

    #[test]
    fn labels_are_round_and_gaps_have_no_lines() {
        let field = Field::new([2; 32], |p| if p.x < 5.0 { p.x } else { f64::NAN });
        let curves = lines(&field, 0.1, 10.0);
        let labels: Vec<String> = curves
            .iter()
            .map(|c| c.labels.edge.names()[0].to_string())
            .collect();
        assert!(
            labels.contains(&"0.3".to_owned()) && labels.contains(&"4.9".to_owned()),
            "{labels:?}"
        );
        assert!(
            curves.bounds().max.x < 5.0
                && labels.len() == 49 + usize::from(labels.contains(&"0".to_owned()))
        );
        assert_eq!(
            (
                round_value(-3, 0.1),
                round_value(0, 20.0),
                round_value(7, 2.5e9)
            ),
            ("-0.3".into(), "0".into(), "17500000000".into())
        );
    }

    #[test]
    fn lines_continue_across_the_sides_of_a_tile() {
        let mut tile = Region::rectangle(Point::new(3.0, 1.0), Point::new(33.0, 21.0));
        tile.period = Some(Point::new(30.0, 20.0));
        let wave =
            |p: Point| libm::sin(2.0 * PI * p.x / 30.0) + libm::cos(2.0 * PI * p.y / 20.0 + 1.0);
        let curves = isolines(&Field::new([4; 32], wave), 0.3, &tile, resolution(30.0)).unwrap();
        let ends: Vec<Point> = curves
            .iter()
            .flat_map(|c| [c.points[0], c.points[c.points.len() - 1]])
            .collect();
        for at in ends.iter().filter(|p| (p.x - 3.0).abs() < 1e-6) {
            assert!(
                ends.iter()
                    .any(|q| q.distance(*at + Point::new(30.0, 0.0)) < 1e-6),
                "{at:?}"
            );
        }
        assert!(
            ends.iter().any(|p| (p.x - 3.0).abs() < 1e-6)
                && ends.iter().any(|p| (p.y - 1.0).abs() < 1e-6)
        );
        let slope = isolines(&Field::new([5; 32], |p| p.x), 1.0, &tile, resolution(30.0));
        assert!(matches!(slope, Err(ArrangementError::FieldPeriod { .. })));
    }

    #[test]
    fn refusals() {
        let field = Field::new([3; 32], |p| 1e6 * p.x);
        for every in [0.0, -1.0, f64::NAN] {
            assert!(isolines(&field, every, &page(1.0), resolution(1.0)).is_err());
        }
        assert!(matches!(
            isolines(&field, 1e-6, &page(1.0), resolution(1.0)),
            Err(ArrangementError::TooMany { .. })
        ));
        assert!(isolines(&field, 1e-300, &page(1.0), resolution(1.0)).is_err());
        let told = isolines(&field, 1e-6, &page(1.0), resolution(1.0)).unwrap_err();
        assert!(
            matches!(told, ArrangementError::TooMany { count, .. } if count > LIMIT as f64),
            "{told}"
        );
        assert!(
            isolines(&Field::constant(5.0), 5.0, &page(1.0), resolution(1.0))
                .unwrap()
                .is_empty()
        );
    }
}
