//! What becomes of what the border of a region cuts.

use serde::{Deserialize, Serialize};

/// What becomes of the cells and lines that the border of the region cuts (Loi 2015, figure 3.4).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Border {
    /// They are cut, and nothing is added.
    #[default]
    Crop,
    /// They are cut, and the contour of the region is added.
    CropAddBoundary,
    /// Cells that reach outside are dropped.
    KeepInside,
    /// Cells that reach inside are kept whole.
    KeepOutside,
}
