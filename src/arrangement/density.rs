//! The density of sites at a place, in a window, and in periodic tiles.

use super::{ArrangementError, Density};
use crate::geometry::{Bounds, Point, Region};

/// A density that has been checked, on the plane or wrapped round a tile.
pub(super) struct LocalDensity {
    density: Density,
    /// The corner and the size of the tile, where there is one.
    tile: Option<(Point, Point)>,
}

impl LocalDensity {
    /// `density` for `region`; fails when it is constant and not a positive number, or when the
    /// region's period is not made of positive numbers.
    pub fn new(density: &Density, region: &Region) -> Result<LocalDensity, ArrangementError> {
        if let Density::Constant(d) = density {
            check(*d, None)?;
        }
        if region.period.is_some_and(|p| !(p.is_finite() && p.x > 0.0 && p.y > 0.0)) {
            return Err(ArrangementError::Region);
        }
        let tile = region.period.map(|period| (region.bounds().min, period));
        Ok(LocalDensity { density: density.clone(), tile })
    }

    /// The size of the tile.
    pub fn period(&self) -> Option<Point> {
        self.tile.map(|(_, period)| period)
    }

    /// The density at `p`; fails when it is not a positive number there.
    pub fn at(&self, p: Point) -> Result<f64, ArrangementError> {
        match &self.density {
            Density::Constant(d) => Ok(*d),
            Density::Field(field) => {
                let p = self.wrapped(p);
                check(field.value(p), Some(p))
            }
        }
    }

    /// What the density is taken not to exceed in a cell: twice the greatest of 3 × 3 samples.
    pub fn cap(&self, cell: &Bounds) -> Result<f64, ArrangementError> {
        if let Density::Constant(d) = self.density {
            return Ok(d);
        }
        Ok(2.0 * self.samples(cell, 3)?.1)
    }

    /// Bounds of the density in a window, for a field those of 17 × 17 samples.
    pub fn range(&self, window: &Bounds) -> Result<(f64, f64), ArrangementError> {
        match self.density {
            Density::Constant(d) => Ok((d, d)),
            Density::Field(_) => self.samples(window, 17),
        }
    }

    fn samples(&self, of: &Bounds, n: u32) -> Result<(f64, f64), ArrangementError> {
        let (mut least, mut greatest) = (f64::INFINITY, 0.0_f64);
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let part = |k: u32| f64::from(k) / f64::from(n - 1);
            let p = Point::new(of.min.x + of.width() * part(i), of.min.y + of.height() * part(j));
            let d = self.at(p)?;
            (least, greatest) = (least.min(d), greatest.max(d));
        }
        Ok((least, greatest))
    }

    fn wrapped(&self, p: Point) -> Point {
        let Some((corner, period)) = self.tile else { return p };
        let turn = |v: f64, from: f64, size: f64| v - ((v - from) / size).floor() * size;
        Point::new(turn(p.x, corner.x, period.x), turn(p.y, corner.y, period.y))
    }
}

fn check(density: f64, at: Option<Point>) -> Result<f64, ArrangementError> {
    if density.is_finite() && density > 0.0 { Ok(density) } else { Err(ArrangementError::Density { density, at }) }
}
