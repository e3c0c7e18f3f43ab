//! The density of sites at a place: checked, continued beyond the region, wrapped round tiles.

use crate::error::ArrangementError;
use crate::random::properties::Density;
use fretwork_geometry::{Bounds, Point, Polygon, Region, Tile};

/// How far beyond its range in the region a density may go outside of it.
const SLACK: f64 = 16.0;

/// A density for a region, positive everywhere.
///
/// A field is asked for outside of the region too, since cells at the border depend on sites outside.
/// There it is kept within 16 times its range in the region, and where it has no positive value it
/// has the middle of this range.
pub(crate) struct LocalDensity {
    density: Density,
    area: Vec<Polygon>,
    tile: Option<Tile>,
    least: f64,
    greatest: f64,
}

impl LocalDensity {
    /// `density` for `region`. Fails when it is not positive and finite at some place of the region
    /// where it is asked for here or later, and when the region's period is not made of positive
    /// numbers.
    pub fn new(density: &Density, region: &Region) -> Result<LocalDensity, ArrangementError> {
        let tile = region.tile();
        if tile.is_some_and(|t| !(t.period.is_finite() && t.period.x > 0.0 && t.period.y > 0.0)) {
            return Err(ArrangementError::Region);
        }
        let mut local = LocalDensity {
            density: density.clone(),
            area: region.area.clone(),
            tile,
            least: 1.0,
            greatest: 1.0,
        };
        (local.least, local.greatest) = local.survey(&region.bounds())?;
        Ok(local)
    }

    /// The size of the tile.
    pub fn period(&self) -> Option<Point> {
        self.tile.map(|tile| tile.period)
    }

    /// The least and greatest density in the region, for a field as far as samples tell.
    pub fn range(&self) -> (f64, f64) {
        (self.least, self.greatest)
    }

    /// What the density does not fall below anywhere.
    pub fn floor(&self) -> f64 {
        if self.is_constant() {
            self.least
        } else {
            self.least / SLACK
        }
    }

    /// Whether it is the same everywhere.
    pub fn is_constant(&self) -> bool {
        matches!(self.density, Density::Constant(_))
    }

    /// The density at `p`; fails when `p` is in the region and it is not a positive number there.
    pub fn at(&self, p: Point) -> Result<f64, ArrangementError> {
        let Density::Field(field) = &self.density else {
            return Ok(self.least);
        };
        let wrapped = self.wrapped(p);
        let density = field.value(wrapped);
        let is_inside = || {
            self.area
                .iter()
                .any(|polygon| polygon.contains(p) || polygon.contains(wrapped))
        };
        if !is_positive(density) {
            if is_inside() {
                return Err(ArrangementError::Density {
                    density,
                    at: Some(wrapped),
                });
            }
            return Ok((self.least * self.greatest).sqrt());
        }
        let beyond = density < self.least / SLACK || density > self.greatest * SLACK;
        if beyond && !is_inside() {
            return Ok(density.clamp(self.least / SLACK, self.greatest * SLACK));
        }
        Ok(density)
    }

    /// What the density is taken not to exceed in a cell: for a field that knows bounds of its values, as those made of
    /// samples do, the bound; otherwise twice the greatest of 3 × 3 samples. Where the field rises more steeply than
    /// that between two samples, sites are lost; with more samples most of the time would go into them.
    pub fn cap(&self, cell: &Bounds) -> Result<f64, ArrangementError> {
        let Density::Field(field) = &self.density else {
            return Ok(self.least);
        };
        if self.tile.is_none()
            && let Some([least, greatest]) = field.range(cell)
            && least > 0.0
            && greatest.is_finite()
        {
            // A little more, for the rounding of what lies between samples; and beyond the region the density
            // does not fall below this, whatever the field says.
            return Ok((greatest * (1.0 + 1e-9)).max(self.least / SLACK));
        }
        let mut greatest = 0.0_f64;
        for p in lattice(cell, 3) {
            greatest = greatest.max(self.at(p)?);
        }
        Ok(2.0 * greatest)
    }

    /// The range of the density's positive values at corners of the area and 33 × 33 other places.
    fn survey(&self, bounds: &Bounds) -> Result<(f64, f64), ArrangementError> {
        let field = match &self.density {
            Density::Constant(density) if is_positive(*density) => return Ok((*density, *density)),
            Density::Constant(density) => {
                return Err(ArrangementError::Density {
                    density: *density,
                    at: None,
                });
            }
            Density::Field(field) => field,
        };
        let corners = self
            .area
            .iter()
            .flat_map(|polygon| polygon.outer.iter().copied());
        let (mut range, mut bad) = (None, None);
        for p in lattice(bounds, 33).chain(corners) {
            let density = field.value(self.wrapped(p));
            if is_positive(density) {
                let (least, greatest) = range.unwrap_or((density, density));
                range = Some((density.min(least), density.max(greatest)));
            } else {
                bad = Some((density, p));
            }
        }
        match (range, bad) {
            (Some(range), _) => Ok(range),
            (None, Some((density, p))) => Err(ArrangementError::Density {
                density,
                at: Some(p),
            }),
            (None, None) => Ok((1.0, 1.0)),
        }
    }

    fn wrapped(&self, p: Point) -> Point {
        self.tile.map_or(p, |tile| tile.wrap(p))
    }
}

/// `n` × `n` places in a box, its corners among them; none when it is empty.
fn lattice(bounds: &Bounds, n: u32) -> impl Iterator<Item = Point> {
    let bounds = *bounds;
    let part = move |k: u32| f64::from(k) / f64::from(n - 1);
    let at = move |i, j| {
        Point::new(
            bounds.min.x + bounds.width() * part(i),
            bounds.min.y + bounds.height() * part(j),
        )
    };
    let count = if bounds.is_empty() { 0 } else { n };
    (0..count).flat_map(move |i| (0..count).map(move |j| at(i, j)))
}

fn is_positive(density: f64) -> bool {
    density.is_finite() && density > 0.0
}
