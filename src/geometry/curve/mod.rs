//! Curves in space by arc length, curves on a mesh, and the strip along a curve.

mod ribbon;
mod space_curve;
mod surface_curve;

pub use ribbon::{Across, Fold, Frame, Ribbon, RibbonError};
pub use space_curve::{SpaceCurve, SpaceCurveError};
pub use surface_curve::{SurfaceCurve, SurfaceCurveError, surface_curve};
