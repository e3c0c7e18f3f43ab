//! Samples of a georeferenced raster: read one by one from wherever they lie, and the values, the
//! gradients and the roughness between them. What the samples are read from is for whoever makes them.

use std::sync::Arc;

use crate::{Affine, Point};

/// Samples in columns and rows.
pub trait Samples: Send + Sync {
    /// How many columns and rows there are.
    fn size(&self) -> [usize; 2];

    /// The sample of a column and a row below [`Samples::size`]; NaN where there is none.
    fn sample(&self, column: usize, row: usize) -> f64;

    /// The most bytes that are held of what the samples are read from, where that is not all of it.
    fn held_bytes(&self) -> usize {
        0
    }

    /// What was found to be wrong with the samples that were asked for so far.
    fn fault(&self) -> Option<String> {
        None
    }
}

/// How the plane and a raster's own plane, which is another one, lie to one another.
#[derive(Clone)]
pub struct Place {
    /// The place in the raster's plane that a point is; NaN where there is none.
    pub into: Arc<dyn Fn(Point) -> Point + Send + Sync>,
    /// Back.
    pub back: Arc<dyn Fn(Point) -> Point + Send + Sync>,
    /// The difference of two x in the raster's plane that are one place: the way around the earth, in degrees.
    pub turn: Option<f64>,
}

/// Samples that lie somewhere in the plane. A sample stands in the middle of its pixel; beyond the pixels there is no value.
#[derive(Clone)]
pub struct Lattice {
    samples: Arc<dyn Samples>,
    /// From columns and rows, counted from the outer corner of the first pixel, to the raster's own plane.
    frame: Affine,
    /// Back.
    columns: Affine,
    /// From the plane to the raster's own, where that is another one.
    place: Option<Place>,
}

/// Half of the distance over which the map into the raster's own plane is taken for linear.
const SPREAD: f64 = 0.5;

impl Lattice {
    /// The lattice of `samples` that `frame` brings from columns and rows (from the outer corner of the first pixel) into the
    /// raster's own plane, and `place` from the plane into that. None where `frame` has no inverse.
    pub fn new(samples: Arc<dyn Samples>, frame: Affine, place: Option<Place>) -> Option<Lattice> {
        let determinant = frame.determinant();
        let [a, b, c, d, e, f] = frame.0;
        let columns = Affine([
            d / determinant,
            -b / determinant,
            -c / determinant,
            a / determinant,
            (c * f - d * e) / determinant,
            (b * e - a * f) / determinant,
        ]);
        let is_sound = columns.0.iter().all(|v| v.is_finite()) && determinant != 0.0;
        is_sound.then_some(Lattice {
            samples,
            frame,
            columns,
            place,
        })
    }

    /// The length of the shorter step between samples, on the plane, around the middle of the raster; none where that has no
    /// place on it.
    pub fn spacing(&self) -> Option<f64> {
        let [width, height] = self.samples.size();
        let (i, j) = (width / 2, height / 2);
        let middle = self.middle(i, j);
        let step = |i, j| self.middle(i, j).distance(middle);
        let shorter = step(i + 1, j).min(step(i, j + 1));
        (shorter.is_finite() && shorter > 0.0).then_some(shorter)
    }

    /// The sample of the pixel that holds `p`.
    pub fn nearest(&self, p: Point) -> f64 {
        let at = self.column_and_row(p);
        self.pixel(at)
            .map_or(f64::NAN, |[i, j]| self.samples.sample(i, j))
    }

    /// The four samples around `p`, weighted by nearness along columns and rows. Only where the pixel of `p` has a value;
    /// samples that are missing lose their weight.
    pub fn bilinear(&self, p: Point) -> f64 {
        let Some(around) = self.around(p) else {
            return f64::NAN;
        };
        let (mut sum, mut whole) = (0.0, 0.0);
        for ([i, j], weight) in around.corners() {
            let sample = self.samples.sample(i, j);
            if !sample.is_nan() {
                sum += sample * weight;
                whole += weight;
            }
        }
        sum / whole
    }

    /// The gradient at `p`: Horn's (1981), of 3 × 3 samples, at the four samples around, weighted as in
    /// [`Lattice::bilinear`]; NaN where there is none.
    pub fn gradient(&self, p: Point) -> Point {
        let Some([x, y]) = self.mean(p, horn) else {
            return Point::new(f64::NAN, f64::NAN);
        };
        // The gradient is a covector: it goes back through the transposes of the maps that led here.
        let [a, b, c, d, ..] = self.columns.0;
        let own = Point::new(a * x + b * y, c * x + d * y);
        let Some(place) = &self.place else { return own };
        let into = |x: f64, y: f64| (place.into)(p + Point::new(x, y));
        let difference = |a: Point, b: Point| {
            let whole = a - b;
            let turns = place
                .turn
                .map_or(0.0, |turn| turn * (whole.x / turn).round());
            Point::new(whole.x - turns, whole.y)
        };
        let across = difference(into(SPREAD, 0.0), into(-SPREAD, 0.0));
        let along = difference(into(0.0, SPREAD), into(0.0, -SPREAD));
        Point::new(across.dot(own), along.dot(own)) * (0.5 / SPREAD)
    }

    /// The greatest less the least of 3 × 3 samples, at the four samples around `p`, weighted as in [`Lattice::bilinear`].
    pub fn roughness(&self, p: Point) -> f64 {
        self.mean(p, |window| [spread(window)])
            .map_or(f64::NAN, |[roughness]| roughness)
    }

    /// The middle of a pixel, on the plane.
    pub fn middle(&self, column: usize, row: usize) -> Point {
        let at = Point::new(column as f64 + 0.5, row as f64 + 0.5);
        let own = self.frame.apply(at);
        self.place.as_ref().map_or(own, |place| (place.back)(own))
    }

    /// `p` in columns and rows, from the outer corner of the first pixel.
    pub fn column_and_row(&self, p: Point) -> Point {
        let own = self.place.as_ref().map_or(p, |place| (place.into)(p));
        self.columns.apply(own)
    }

    /// The samples that the lattice places.
    pub fn samples(&self) -> &Arc<dyn Samples> {
        &self.samples
    }

    /// The pixel in which a place in columns and rows lies. The far borders belong to the last pixels.
    fn pixel(&self, at: Point) -> Option<[usize; 2]> {
        let [width, height] = self.samples.size();
        let index = |v: f64, n: usize| {
            let inside = v >= 0.0 && v <= n as f64 && n > 0;
            inside.then(|| (v as usize).min(n - 1))
        };
        Some([index(at.x, width)?, index(at.y, height)?])
    }

    /// The samples around `p`. None outside of the pixels, and where the sample of the pixel of `p` is missing.
    fn around(&self, p: Point) -> Option<Around> {
        let at = self.column_and_row(p);
        let [i, j] = self.pixel(at)?;
        if self.samples.sample(i, j).is_nan() {
            return None;
        }
        let [width, height] = self.samples.size();
        Some(Around {
            columns: sides(at.x - 0.5, width),
            rows: sides(at.y - 0.5, height),
        })
    }

    /// The mean of what `value` makes of the 3 × 3 samples around each of the four samples around `p`, weighted by nearness.
    fn mean<const N: usize>(&self, p: Point, value: fn(&[f64; 9]) -> [f64; N]) -> Option<[f64; N]> {
        let around = self.around(p)?;
        let (left, top) = (around.columns[0].0, around.rows[0].0);
        let patch = self.patch(left, top);
        let (mut sum, mut whole) = ([0.0; N], 0.0);
        for ([column, row], weight) in around.corners() {
            if let Some(window) = window(&patch, column - left, row - top) {
                let value = value(&window);
                for (sum, value) in sum.iter_mut().zip(value) {
                    *sum += value * weight;
                }
                whole += weight;
            }
        }
        Some(sum.map(|sum| sum / whole))
    }

    /// The 4 × 4 samples of which the second in the second row is the one named, row by row. Beyond the edge they go on straight.
    fn patch(&self, column: usize, row: usize) -> [f64; 16] {
        let [width, height] = self.samples.size();
        let is_inside = column > 0 && row > 0 && column + 2 < width && row + 2 < height;
        std::array::from_fn(|k| {
            let (i, j) = (k % 4, k / 4);
            if is_inside {
                self.samples.sample(column + i - 1, row + j - 1)
            } else {
                self.beyond((column + i) as i64 - 1, (row + j) as i64 - 1)
            }
        })
    }

    /// The sample, or beyond the edge the straight continuation of the outermost two; NaN where one of these is missing.
    fn beyond(&self, column: i64, row: i64) -> f64 {
        let [width, height] = self.samples.size().map(|n| n as i64);
        let outward = |k: i64, n: i64| match k {
            _ if n < 2 => None,
            k if k < 0 => Some((0, 1)),
            k if k >= n => Some((n - 1, n - 2)),
            _ => None,
        };
        if let Some((near, far)) = outward(row, height) {
            2.0 * self.beyond(column, near) - self.beyond(column, far)
        } else if let Some((near, far)) = outward(column, width) {
            2.0 * self.beyond(near, row) - self.beyond(far, row)
        } else if (0..width).contains(&column) && (0..height).contains(&row) {
            self.samples.sample(column as usize, row as usize)
        } else {
            f64::NAN
        }
    }
}

/// The two samples around a place along an axis of `n`, and their weights; at the outermost half pixel the edge goes on.
fn sides(at: f64, n: usize) -> [(usize, f64); 2] {
    let floor = at.floor();
    let part = at - floor;
    let inside = |k: f64| k.clamp(0.0, (n - 1) as f64) as usize;
    [(inside(floor), 1.0 - part), (inside(floor + 1.0), part)]
}

/// The samples around a place along both axes, with their weights.
struct Around {
    columns: [(usize, f64); 2],
    rows: [(usize, f64); 2],
}

impl Around {
    /// The samples that have a weight.
    fn corners(&self) -> impl Iterator<Item = ([usize; 2], f64)> {
        let rows = self.rows.into_iter();
        let columns = self.columns;
        rows.flat_map(move |(row, v)| columns.map(|(column, u)| ([column, row], u * v)))
            .filter(|(_, weight)| *weight > 0.0)
    }
}

/// Of a patch, the 3 × 3 samples around the one that lies `i` columns and `j` rows from its second, if that is there. Missing
/// ones are as the middle, as `gdaldem -compute_edges` has it.
fn window(patch: &[f64; 16], i: usize, j: usize) -> Option<[f64; 9]> {
    let sample = |di: usize, dj: usize| patch[4 * (j + dj) + i + di];
    let middle = sample(1, 1);
    if middle.is_nan() {
        return None;
    }
    Some(std::array::from_fn(|k| {
        let value = sample(k % 3, k / 3);
        if value.is_nan() { middle } else { value }
    }))
}

/// Horn's gradient in columns and rows.
fn horn(w: &[f64; 9]) -> [f64; 2] {
    [
        ((w[2] + 2.0 * w[5] + w[8]) - (w[0] + 2.0 * w[3] + w[6])) * 0.125,
        ((w[6] + 2.0 * w[7] + w[8]) - (w[0] + 2.0 * w[1] + w[2])) * 0.125,
    ]
}

fn spread(window: &[f64; 9]) -> f64 {
    let least = window.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = window.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    greatest - least
}
