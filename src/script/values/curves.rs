//! Curves: what mappers and arrangements give.

use std::fmt;
use std::sync::Arc;

use allocative::Allocative;
use starlark::any::ProvidesStaticType;
use starlark::starlark_simple_value;
use starlark::values::{NoSerialize, StarlarkPagablePanic, StarlarkValue};
use starlark_derive::starlark_value;

use fretwork_geometry::Curves;

/// A list of labelled curves with named points.
#[derive(Clone, Debug, ProvidesStaticType, NoSerialize, StarlarkPagablePanic, Allocative)]
pub struct CurvesValue {
    /// The curves.
    #[allocative(skip)]
    pub curves: Arc<Curves>,
    /// How much of a translation of the plane they take part in; see [`PointValue`](crate::values::PointValue).
    pub weight: f64,
}

starlark_simple_value!(CurvesValue);

impl fmt::Display for CurvesValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "<{} curves, {} points>",
            self.curves.len(),
            self.curves.points().len()
        )
    }
}

impl CurvesValue {
    /// Curves that do not move with the plane.
    pub fn fixed(curves: Arc<Curves>) -> CurvesValue {
        CurvesValue {
            curves,
            weight: 0.0,
        }
    }

    /// Whether nothing is in them, so that their weight has no meaning.
    pub fn is_nothing(&self) -> bool {
        self.curves.is_empty() && self.curves.named_points().is_empty()
    }
}

#[starlark_value(type = "curves")]
impl<'v> StarlarkValue<'v> for CurvesValue {}
