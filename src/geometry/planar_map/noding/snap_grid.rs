//! The integer grid: from points of the plane to sites and back. Which sites are merged is not
//! decided here but in `noding`.

use crate::planar_map::PlanarMapError;
use crate::{Bounds, Curves, Point};

/// Grid units in one resolution. The grid is finer than what is merged, so that rounding a site to it (half a
/// unit) does not tear apart what is at one place, not even where hundreds of curves cross there.
pub(in crate::planar_map) const RESOLUTION: f64 = 512.0;

/// Farthest site from the origin of the plane, in grid units, and largest extent of a map: up to here sites, their
/// sums and differences and their products with the unit are exact; products of two differences fit 2^104.
const REACH: f64 = (1u64 << 52) as f64;

/// A point of the grid relative to the map's corner; both numbers are integers in
/// [0, 2^52], which f64 holds exactly.
pub(in crate::planar_map) type Site = [f64; 2];

/// The grid of one map: a power of two as the unit, and the corner that sites are relative to.
#[derive(Clone, Copy, Debug)]
pub(in crate::planar_map) struct SnapGrid {
    unit: f64,
    per_unit: f64,
    corner: Site,
}

impl SnapGrid {
    /// The grid for `curves`, or why there is none.
    pub fn fit(curves: &Curves, resolution: f64) -> Result<SnapGrid, PlanarMapError> {
        let unit = resolution / RESOLUTION;
        let exponent = (resolution.to_bits() >> 52) as i64 - 1023;
        if resolution.to_bits() << 12 != 0 || !(-900..=900).contains(&exponent) {
            return Err(PlanarMapError::Resolution(resolution));
        }
        let bounds = curves.bounds();
        let grid = SnapGrid {
            unit,
            per_unit: 1.0 / unit,
            corner: [0.0; 2],
        };
        if bounds.is_empty() && curves.is_empty() {
            return Ok(grid);
        }
        let corner = grid.snap(bounds.min);
        let far = grid.snap(bounds.max);
        let inside = |v: f64| v.abs() <= REACH;
        let fits = corner.iter().chain(&far).all(|v| inside(*v))
            && (0..2).all(|k| far[k] - corner[k] <= REACH);
        // A box hides NaN (comparisons with it are false), hence the second look at every point.
        if !fits || curves.points().iter().any(|p| !p.is_finite()) {
            return Err(offender(curves, &grid, bounds, resolution));
        }
        Ok(SnapGrid { corner, ..grid })
    }

    /// The nearest site; halves go up, so that translations by whole units commute with it.
    pub fn snap(&self, p: Point) -> Site {
        // Dividing by a power of two is exact.
        let round = |v: f64, corner: f64| (v * self.per_unit + 0.5).floor() - corner;
        [round(p.x, self.corner[0]), round(p.y, self.corner[1])]
    }

    /// The point of a site, exactly.
    pub fn point(&self, s: Site) -> Point {
        Point::new(
            (s[0] + self.corner[0]) * self.unit,
            (s[1] + self.corner[1]) * self.unit,
        )
    }

    /// Like [`SnapGrid::snap`] for any point of the plane; beyond the grid's reach it stops at the border.
    pub fn clamped(&self, p: Point) -> Site {
        self.snap(p).map(|v| {
            if v.is_nan() {
                -1.0
            } else {
                v.clamp(-1.0, 2.0 * REACH)
            }
        })
    }
}

/// The error for the first point to blame.
fn offender(curves: &Curves, grid: &SnapGrid, bounds: Bounds, resolution: f64) -> PlanarMapError {
    let points = || {
        curves
            .iter()
            .enumerate()
            .flat_map(|(i, c)| c.points.iter().map(move |p| (i, *p)))
    };
    if let Some((curve, point)) = points().find(|(_, p)| !p.is_finite()) {
        return PlanarMapError::NotFinite { curve, point };
    }
    let middle = grid.snap(bounds.center());
    let (curve, point) = points()
        .find(|(_, p)| {
            let s = grid.snap(*p);
            (0..2).any(|k| !(s[k].abs() <= REACH && (s[k] - middle[k]).abs() <= REACH / 2.0))
        })
        .unwrap_or((0, bounds.max));
    PlanarMapError::OutOfRange {
        curve,
        point,
        resolution,
    }
}
