//! What a body is made of.

use super::error::AnalysisError;

/// A linear elastic material, the same in all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus in pascals.
    pub youngs_modulus: f64,
    /// Poisson's ratio, between -1 and 0.5.
    pub poisson_ratio: f64,
    /// Kilograms a cubic metre.
    pub density: f64,
    /// Where it yields, in pascals, if that is known.
    pub yield_strength: Option<f64>,
    /// How much weaker it is across the layers in which it is printed.
    pub across_layers: Option<AcrossLayers>,
}

/// Layers hold together less well than each of them holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AcrossLayers {
    /// The strength across layers as a part of that within one, above 0.
    pub strength: f64,
    /// The direction in which the layers are stacked, of any length but zero.
    pub direction: [f64; 3],
}

impl Material {
    /// Whether there can be such a material.
    ///
    /// # Errors
    /// Names the first constant that no material has.
    pub fn check(&self) -> Result<(), AnalysisError> {
        let is_size = |x: f64| (1e-6..1e18).contains(&x);
        let nu = self.poisson_ratio;
        let layers = self.across_layers;
        let strength = layers.map_or(1.0, |layers| layers.strength);
        let direction = layers.map_or([1.0, 0.0, 0.0], |layers| layers.direction);
        let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
        let checks = [
            (
                "Young's modulus",
                self.youngs_modulus,
                is_size(self.youngs_modulus),
            ),
            // Closer to 0.5 the element is too stiff for its own results to be believed.
            ("Poisson's ratio", nu, nu > -0.999 && nu < 0.4999),
            ("density", self.density, (0.0..1e9).contains(&self.density)),
            (
                "yield strength",
                self.yield_strength.unwrap_or(1.0),
                is_size(self.yield_strength.unwrap_or(1.0)),
            ),
            ("the strength across layers", strength, is_size(strength)),
            (
                "the length of the layers' direction",
                length,
                is_size(length),
            ),
        ];
        match checks.into_iter().find(|(_, _, holds)| !holds) {
            Some((what, value, _)) => Err(AnalysisError::Value { what, value }),
            None => Ok(()),
        }
    }
}
