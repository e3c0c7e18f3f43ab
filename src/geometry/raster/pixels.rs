//! A picture whose pixels are solid or empty: an exemplar of a texture.

use serde::{Deserialize, Serialize};

/// Pixels row by row from the top left.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pixels {
    /// Columns, at least 1.
    pub width: usize,
    /// The colours: red, green, blue. Their number is a multiple of `width`.
    pub rgb: Vec<[u8; 3]>,
    /// Which are solid; as many as colours.
    pub solid: Vec<bool>,
    /// The width of a pixel, as a length.
    pub pixel_size: f64,
    /// The radius of the features that must stay whole, as a length; none where it is to be estimated.
    pub feature_radius: Option<f64>,
    /// Whether opposite sides join.
    pub tileable: bool,
}

impl Pixels {
    /// Rows.
    #[inline]
    pub fn height(&self) -> usize {
        self.rgb.len() / self.width.max(1)
    }

    /// The part of the pixels that is solid, from 0 to 1.
    pub fn solid_fraction(&self) -> f64 {
        let solid = self.solid.iter().filter(|solid| **solid).count();
        solid as f64 / self.solid.len().max(1) as f64
    }
}
