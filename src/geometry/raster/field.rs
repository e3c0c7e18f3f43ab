//! Scalar and vector functions of the plane: constants, closures, rasters, and
//! what is derived from the relief of another field. Values of faces and of points are in `of_features`. Fields say nothing
//! about units.

use std::sync::{Arc, OnceLock};

use crate::raster::extremes::Extremes;
use crate::raster::lattice::Lattice;
use crate::{Bounds, Point, Raster};

/// A function of the plane. Two fields are equal when their digests are.
#[derive(Clone)]
pub struct Field {
    function: Arc<dyn Fn(Point) -> f64 + Send + Sync>,
    digest: [u8; 32],
    spacing: Option<f64>,
    range: Option<Arc<Range>>,
    /// Of a field that is the values of samples, these.
    lattice: Option<Arc<Lattice>>,
    /// Where the samples lie that it is made of.
    grid: Option<Arc<Lattice>>,
}

/// Bounds of the values of a field in a box.
type Range = dyn Fn(&Bounds) -> [f64; 2] + Send + Sync;

/// A vector field by its components.
#[derive(Clone, Debug, PartialEq)]
pub struct VectorField {
    /// Along x.
    pub x: Field,
    /// Along y.
    pub y: Field,
}

impl VectorField {
    /// The vector at `p`.
    pub fn value(&self, p: Point) -> Point {
        Point::new(self.x.value(p), self.y.value(p))
    }
}

/// What a field of heights can be turned into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relief {
    /// Steepness in degrees, 0 to 90.
    Slope,
    /// Direction of descent in degrees from +x toward +y, 0 to 360; 0 where it is flat.
    Aspect,
    /// The greatest less the least height of a sample and the eight around it.
    Roughness,
}

impl Field {
    /// `function`, whose results `digest` stands for: functions that differ have different digests.
    pub fn new(digest: [u8; 32], function: impl Fn(Point) -> f64 + Send + Sync + 'static) -> Field {
        Field {
            function: Arc::new(function),
            digest,
            spacing: None,
            range: None,
            lattice: None,
            grid: None,
        }
    }

    /// The same value everywhere.
    pub fn constant(value: f64) -> Field {
        Field::new(digest("constant", &value.to_le_bytes()), move |_| value)
    }

    /// The field with `function` applied to its values; `name` says what the function is.
    pub fn map(&self, name: &str, function: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Field {
        let inner = self.function.clone();
        let digest = digest(name, &self.digest);
        Field {
            function: Arc::new(move |p| function(inner(p))),
            digest,
            spacing: self.spacing,
            range: None,
            lattice: None,
            grid: self.grid.clone(),
        }
    }

    /// The field magnified about the origin: at `by` times a point it has the value that it had at the point.
    pub fn magnified(&self, by: f64) -> Field {
        let inner = self.function.clone();
        let digest = digest(&format!("magnified {by}"), &self.digest);
        Field {
            spacing: self.spacing.map(|spacing| spacing * by),
            ..Field::new(digest, move |p| inner(p * (1.0 / by)))
        }
    }

    /// The field with `value` where it has none. The samples of which it is made stay as they are.
    pub fn filled(&self, value: f64) -> Field {
        let name = format!("otherwise {value}");
        let filled = move |v: f64| if v.is_nan() { value } else { v };
        Field {
            lattice: self.lattice.clone(),
            ..self.map(&name, filled)
        }
    }

    /// The samples of `lattice`, between which `bilinear` interpolates; else the nearest is taken. `content` stands for the
    /// samples and their places.
    pub fn lattice(lattice: Arc<Lattice>, content: [u8; 32], bilinear: bool) -> Field {
        let name = if bilinear {
            "lattice, bilinear"
        } else {
            "lattice, nearest"
        };
        let samples = lattice.clone();
        let function = move |p| {
            if bilinear {
                samples.bilinear(p)
            } else {
                samples.nearest(p)
            }
        };
        Field {
            spacing: lattice.spacing(),
            grid: Some(lattice.clone()),
            lattice: Some(lattice),
            ..Field::new(digest(name, &content), function)
        }
    }

    /// The lattice of samples that the field is, if it is one.
    pub fn samples(&self) -> Option<&Arc<Lattice>> {
        self.lattice.as_ref()
    }

    /// Where the samples lie that the field is made of, if it is made of some.
    pub fn grid(&self) -> Option<&Arc<Lattice>> {
        self.grid.as_ref()
    }

    /// The field that says of itself that it is made of the samples of `others`: of those that lie closest.
    pub fn over<'a>(mut self, others: impl IntoIterator<Item = &'a Field>) -> Field {
        for other in others {
            let closer = match (self.spacing, other.spacing) {
                (Some(own), Some(theirs)) => theirs < own,
                (None, Some(_)) => true,
                _ => false,
            };
            if closer {
                self.spacing = other.spacing;
                self.grid = other.grid.clone();
            }
        }
        self
    }

    /// The same as [`Field::map`] for a `function` of positive numbers that falls where its argument grows, which lets bounds
    /// of values pass.
    pub fn map_falling(
        &self,
        name: &str,
        function: impl Fn(f64) -> f64 + Clone + Send + Sync + 'static,
    ) -> Field {
        let range = self.range.clone().map(|range| {
            let function = function.clone();
            let fallen = move |within: &Bounds| match range(within) {
                [least, greatest] if least > 0.0 => [function(greatest), function(least)],
                _ => [f64::NEG_INFINITY, f64::INFINITY],
            };
            Arc::new(fallen) as Arc<Range>
        });
        Field {
            range,
            ..self.map(name, function)
        }
    }

    /// The samples of `raster`, between which `bilinear` interpolates; else the nearest is taken.
    pub fn raster(raster: Arc<Raster>, bilinear: bool) -> Field {
        let digest = digest(
            if bilinear { "bilinear" } else { "nearest" },
            &raster.digest(),
        );
        let spacing = raster.step.x.abs().min(raster.step.y.abs());
        let (pyramid, samples) = (OnceLock::new(), raster.clone());
        let range = move |within: &Bounds| {
            let extremes = pyramid.get_or_init(|| Extremes::of(&samples));
            extremes.within(&samples, within)
        };
        let function = move |p| {
            if bilinear {
                raster.bilinear(p)
            } else {
                raster.nearest(p)
            }
        };
        Field {
            spacing: Some(spacing),
            range: Some(Arc::new(range)),
            ..Field::new(digest, function)
        }
    }

    /// The relief of this field of heights, measured on its samples, or on points `spacing` apart
    /// where it has none; heights and lengths in the same unit.
    ///
    /// Gradients are those of Horn (1981) on 3 × 3 samples. On a lattice they are interpolated between samples, and the
    /// angles are those of the gradient in between, so that an aspect does not jump from 359 to 0.
    pub fn relief(&self, what: Relief, spacing: f64) -> Field {
        let h = self.spacing.unwrap_or(spacing);
        let name = match what {
            Relief::Slope => "slope",
            Relief::Aspect => "aspect",
            Relief::Roughness => "roughness",
        };
        let digest = digest(name, &[&self.digest[..], &h.to_le_bytes()].concat());
        if let Some(lattice) = self.lattice.clone() {
            let function = move |p| match what {
                Relief::Slope => steepness(lattice.gradient(p)),
                Relief::Aspect => aspect(lattice.gradient(p)),
                Relief::Roughness => lattice.roughness(p),
            };
            return Field::new(digest, function).over([self]);
        }
        let heights = self.clone();
        let function = move |p| match what {
            Relief::Slope => steepness(gradient(&heights, p, h)),
            Relief::Aspect => aspect(gradient(&heights, p, h)),
            Relief::Roughness => roughness(&heights, p, h),
        };
        Field::new(digest, function).over([self])
    }

    /// The gradient at `p`, as [`Field::relief`] takes it; NaN where there is none.
    pub fn gradient(&self, p: Point, spacing: f64) -> Point {
        match &self.lattice {
            Some(lattice) => lattice.gradient(p),
            None => gradient(self, p, self.spacing.unwrap_or(spacing)),
        }
    }

    /// The value at `p`; NaN where there is none.
    pub fn value(&self, p: Point) -> f64 {
        (self.function)(p)
    }

    /// Bounds of the values in a box, but for rounding: what they do not fall below and what they do not exceed. The lower
    /// one is -∞ where a value is missing. Nothing for a field of which no bounds are known without asking everywhere.
    pub fn range(&self, within: &Bounds) -> Option<[f64; 2]> {
        self.range.as_ref().map(|range| range(within))
    }

    /// What stands for the function where values are compared and cached.
    pub fn digest(&self) -> [u8; 32] {
        self.digest
    }

    /// The distance between samples, for a field that is made of samples.
    pub fn spacing(&self) -> Option<f64> {
        self.spacing
    }
}

impl PartialEq for Field {
    fn eq(&self, other: &Field) -> bool {
        self.digest == other.digest
    }
}

impl std::fmt::Debug for Field {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Field({})", blake3::Hash::from(self.digest).to_hex())
    }
}

pub(super) fn digest(kind: &str, bytes: &[u8]) -> [u8; 32] {
    let mut hasher = blake3::Hasher::new();
    hasher.update(kind.as_bytes()).update(&[0]).update(bytes);
    *hasher.finalize().as_bytes()
}

/// Horn's gradient on the eight points `h` around `p`.
fn gradient(heights: &Field, p: Point, h: f64) -> Point {
    let z = |i: i32, j: i32| heights.value(p + Point::new(f64::from(i), f64::from(j)) * h);
    let (nw, n, ne) = (z(-1, 1), z(0, 1), z(1, 1));
    let (w, e) = (z(-1, 0), z(1, 0));
    let (sw, s, se) = (z(-1, -1), z(0, -1), z(1, -1));
    Point::new(
        (ne + 2.0 * e + se) - (nw + 2.0 * w + sw),
        (nw + 2.0 * n + ne) - (sw + 2.0 * s + se),
    ) * (0.125 / h)
}

fn steepness(gradient: Point) -> f64 {
    libm::atan(gradient.length()).to_degrees()
}

/// The direction of descent in degrees, 0 to 360; 0 where it is flat.
pub fn aspect(gradient: Point) -> f64 {
    if gradient == Point::ORIGIN {
        return 0.0;
    }
    let degrees = libm::atan2(-gradient.y, -gradient.x).to_degrees();
    if degrees < 0.0 {
        degrees + 360.0
    } else {
        degrees
    }
}

/// The greatest less the least of the height at `p` and those of the eight points `h` around it.
fn roughness(heights: &Field, p: Point, h: f64) -> f64 {
    let around =
        (-1..=1).flat_map(|i| (-1..=1).map(move |j| Point::new(f64::from(i), f64::from(j)) * h));
    let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
    for by in around {
        let height = heights.value(p + by);
        if height.is_nan() {
            return f64::NAN;
        }
        (least, greatest) = (least.min(height), greatest.max(height));
    }
    greatest - least
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relief_of_a_plane_and_of_a_cone() {
        let plane = Field::new([1; 32], |p| 3.0 - p.x);
        let at = Point::new(2.0, 5.0);
        assert!((plane.relief(Relief::Slope, 0.1).value(at) - 45.0).abs() < 1e-9);
        assert!(plane.relief(Relief::Aspect, 0.1).value(at).abs() < 1e-9);
        assert!((plane.relief(Relief::Roughness, 0.1).value(at) - 0.2).abs() < 1e-12);
        let pit = Field::new([2; 32], |p: Point| p.length());
        assert!(
            (pit.relief(Relief::Aspect, 1e-3).value(Point::new(0.0, 4.0)) - 270.0).abs() < 1e-6
        );
        assert!(
            (pit.relief(Relief::Roughness, 1.0).value(Point::ORIGIN) - 2f64.sqrt()).abs() < 1e-12
        );
    }
}
