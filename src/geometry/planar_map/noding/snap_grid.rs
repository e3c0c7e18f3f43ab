//! The integer grid: from points of the plane to sites and back. Which sites are merged is not
//! decided here but in `noding`.

use crate::planar_map::PlanarMapError;
use crate::{Bounds, Curves, Point};

/// Grid units in one resolution. The grid is finer than what is merged, so that rounding a site to it (half a
/// unit) does not tear apart what is at one place, not even where hundreds of curves cross there.
pub(in crate::planar_map) const RESOLUTION: f64 = 512.0;

/// Largest extent of a map in grid units: up to here sites, their sums and differences and their products with the unit are
/// exact; products of two differences fit 2^104.
const REACH: f64 = (1u64 << 52) as f64;

/// Farthest corner of a map from the origin, in grid units. So far out the numbers that f64 holds are 64 units apart, an
/// eighth of a resolution: sites, which are relative to the corner, stay exact, and a site that is turned
/// into a point is rounded by less than what is merged anyway.
const FARTHEST: f64 = (1u64 << 58) as f64;

/// A map far from the origin may have a coarser resolution than was asked for, up to so many times. Beyond, the
/// coordinates are hardly more than their own rounding.
const COARSEST: i32 = 20;

/// A map that is wider than is within reach has a coarser resolution too, up to 2^3 times: the whole Earth in metres has one
/// of some micrometres. What is wider still has a place that is wrong.
const WIDEST: i32 = 3;

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
        let bounds = curves.bounds();
        let exponent = (resolution.to_bits() >> 52) as i64 - 1023;
        if resolution.to_bits() << 12 != 0 || !(-900..=900).contains(&exponent) {
            return Err(PlanarMapError::Resolution(resolution));
        }
        let unit = unit * coarser(&bounds, unit);
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
        let inside = |v: f64| v.abs() <= FARTHEST;
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
        let round = |v: f64, corner: f64| {
            let units = v * self.per_unit;
            // So far from the origin every number is whole, and a half could not be added.
            let whole = if units.abs() < REACH {
                (units + 0.5).floor()
            } else {
                units
            };
            whole - corner
        };
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

/// The power of two that a unit must be multiplied by for `bounds` to be within reach: 1 unless they are far from the origin
/// or very wide.
fn coarser(bounds: &Bounds, unit: f64) -> f64 {
    let farthest = [bounds.min, bounds.max]
        .iter()
        .fold(0.0, |far: f64, p| far.max(p.x.abs()).max(p.y.abs()));
    // A unit less, because corners are rounded.
    let wide = bounds.width().max(bounds.height()) / (REACH - 2.0);
    let doublings = |length: f64, most: i32| {
        let units = length / unit;
        if !(units.is_finite() && units > 1.0) {
            return 0;
        }
        let (part, exponent) = libm::frexp(units);
        // A power of two is reached as it is.
        (exponent - i32::from(part == 0.5)).min(most)
    };
    let far = doublings(farthest / FARTHEST, COARSEST);
    libm::ldexp(1.0, far.max(doublings(wide, WIDEST)))
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
            (0..2).any(|k| !(s[k].abs() <= FARTHEST && (s[k] - middle[k]).abs() <= REACH / 2.0))
        })
        .unwrap_or((0, bounds.max));
    PlanarMapError::OutOfRange {
        curve,
        point,
        resolution,
    }
}
