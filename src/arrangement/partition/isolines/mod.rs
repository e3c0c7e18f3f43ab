//! Isolines: the lines on which a field has a round value, by marching squares.

mod blocks;
mod samples;
mod square;
#[cfg(test)]
mod tests;

use crate::error::ArrangementError;
use crate::mask::crop::crop;
use blocks::Blocks;
use fretwork_geometry::{Bounds, CurveLabels, Curves, Field, LabelSet, Point, Region, Tile};
use samples::{Samples, join};

/// Squares along the longer side of a region, for a field that is not made of samples.
const SQUARES: f64 = 256.0;

/// The lines in `region` on which `field` has a multiple of `every`, which must be positive, each with
/// its value as its edge label and the greater values on its left.
///
/// The field is sampled at the middles of squares of the plane, as wide as the distance of the field's
/// samples, or a 256th of the region's longer side where it has none, and taken for bilinear
/// between four samples; where both diagonals of a square lie on different sides of the value, the bilinear
/// surface decides which corners are connected. There is no line where the field has no value; samples have theirs as far as
/// half a square. In a tile the squares are a little smaller, so that they fit it. Every 2048 squares from the lower left corner of the region's
/// box, lines are divided.
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
    let isolines = Isolines::new(field, every, (region, resolution), blocks::SIDE)?;
    isolines.map_or(Ok(Curves::new()), |isolines| isolines.drawn(None))
}

/// The same without lines in blocks of the lattice that do not meet a room; nothing where most of them do, so that the whole
/// costs little more.
///
/// # Errors
/// Those of [`isolines`].
pub(crate) fn isolines_in(
    field: &Field,
    every: f64,
    (region, resolution): (&Region, f64),
    room: &Bounds,
) -> Result<Option<Curves>, ArrangementError> {
    match Isolines::new(field, every, (region, resolution), blocks::SIDE)? {
        None => Ok(Some(Curves::new())),
        Some(isolines) => isolines.near(room),
    }
}

/// Isolines that can be drawn.
struct Isolines<'a> {
    field: &'a Field,
    every: f64,
    region: &'a Region,
    resolution: f64,
    steps: Point,
    blocks: Blocks,
}

impl<'a> Isolines<'a> {
    /// Isolines on a region that is not empty, in blocks with so many squares along a side.
    fn new(
        field: &'a Field,
        every: f64,
        (region, resolution): (&'a Region, f64),
        side: usize,
    ) -> Result<Option<Isolines<'a>>, ArrangementError> {
        let bounds = region.bounds();
        if bounds.is_empty() {
            return Ok(None);
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
        Ok(Some(Isolines {
            field,
            every,
            region,
            resolution,
            steps,
            blocks: Blocks::over(&bounds, steps, side)?,
        }))
    }

    /// The lines in the blocks that meet a room, unless they are more than half of all.
    fn near(&self, room: &Bounds) -> Result<Option<Curves>, ArrangementError> {
        if 2 * self.blocks.meeting_count(room) > self.blocks.count() {
            return Ok(None);
        }
        self.drawn(Some(room)).map(Some)
    }

    /// The lines in the blocks that meet a room, or all.
    fn drawn(&self, room: Option<&Bounds>) -> Result<Curves, ArrangementError> {
        let tile = self.region.tile();
        let value = |p: Point| self.field.value(tile.map_or(p, |t| t.wrap(p)));
        let mut curves = Curves::new();
        let mut pieces = 0;
        for block in self.blocks.meeting(room)? {
            let samples = Samples::of(value, &block, self.steps);
            let reaches = |p: Point| self.field.spacing().map_or(f64::NAN, |_| value(p));
            let segments = samples.segments(reaches, self.every, pieces)?;
            pieces += segments.len();
            for of_level in segments.chunk_by(|a, b| a.level == b.level) {
                let level = of_level[0].level;
                let label = LabelSet::one(&round_value(level, self.every));
                let crossing = |side| samples.crossing(side, level as f64 * self.every);
                for line in join(of_level) {
                    let points = line.into_iter().map(crossing);
                    curves.push(points, CurveLabels::edge(label));
                }
            }
        }
        // As many for a part as for the whole, so that both have one order.
        let tiles = (self.blocks.square_count() / 16.0).clamp(256.0, 1e5) as usize;
        crop(&curves, (self.region, self.resolution), tiles)
    }
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
