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
pub struct CurvesValue(#[allocative(skip)] pub Arc<Curves>);

starlark_simple_value!(CurvesValue);

impl fmt::Display for CurvesValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "<{} curves, {} points>",
            self.0.len(),
            self.0.points().len()
        )
    }
}

#[starlark_value(type = "curves")]
impl<'v> StarlarkValue<'v> for CurvesValue {}
