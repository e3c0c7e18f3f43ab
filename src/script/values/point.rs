//! Points of the plane.

use std::fmt;

use allocative::Allocative;
use starlark::any::ProvidesStaticType;
use starlark::collections::StarlarkHasher;
use starlark::environment::{Methods, MethodsBuilder, MethodsStatic};
use starlark::values::float::UnpackFloat;
use starlark::values::{
    Heap, NoSerialize, StarlarkPagablePanic, StarlarkValue, UnpackValue, Value, ValueError,
    ValueLike,
};
use starlark::{starlark_module, starlark_simple_value};
use starlark_derive::starlark_value;

use fretwork_geometry::Point;

/// A point or vector.
#[derive(
    Clone, Copy, Debug, PartialEq, ProvidesStaticType, NoSerialize, StarlarkPagablePanic, Allocative,
)]
pub struct PointValue(#[allocative(skip)] pub Point);

starlark_simple_value!(PointValue);

impl fmt::Display for PointValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "point({}, {})", self.0.x, self.0.y)
    }
}

fn scalar(value: Value<'_>) -> Option<f64> {
    UnpackFloat::unpack_value(value).ok().flatten().map(|f| f.0)
}

#[starlark_value(type = "point")]
impl<'v> StarlarkValue<'v> for PointValue {
    fn add(&self, other: Value<'v>, heap: Heap<'v>) -> Option<starlark::Result<Value<'v>>> {
        let other = other.downcast_ref::<Self>()?;
        Some(Ok(heap.alloc(PointValue(self.0 + other.0))))
    }

    fn sub(&self, other: Value<'v>, heap: Heap<'v>) -> starlark::Result<Value<'v>> {
        match other.downcast_ref::<Self>() {
            Some(point) => Ok(heap.alloc(PointValue(self.0 - point.0))),
            None => ValueError::unsupported_with(self, "-", other),
        }
    }

    fn mul(&self, factor: Value<'v>, heap: Heap<'v>) -> Option<starlark::Result<Value<'v>>> {
        Some(Ok(heap.alloc(PointValue(self.0 * scalar(factor)?))))
    }

    fn rmul(&self, factor: Value<'v>, heap: Heap<'v>) -> Option<starlark::Result<Value<'v>>> {
        Some(Ok(heap.alloc(PointValue(self.0 * scalar(factor)?))))
    }

    fn div(&self, divisor: Value<'v>, heap: Heap<'v>) -> starlark::Result<Value<'v>> {
        match scalar(divisor) {
            Some(0.0) => Err(ValueError::DivisionByZero.into()),
            Some(d) => Ok(heap.alloc(PointValue(Point::new(self.0.x / d, self.0.y / d)))),
            None => ValueError::unsupported_with(self, "/", divisor),
        }
    }

    fn minus(&self, heap: Heap<'v>) -> starlark::Result<Value<'v>> {
        Ok(heap.alloc(PointValue(-self.0)))
    }

    fn plus(&self, heap: Heap<'v>) -> starlark::Result<Value<'v>> {
        Ok(heap.alloc(*self))
    }

    fn equals(&self, other: Value<'v>) -> starlark::Result<bool> {
        Ok(other.downcast_ref::<Self>() == Some(self))
    }

    fn write_hash(&self, hasher: &mut StarlarkHasher) -> starlark::Result<()> {
        use std::hash::Hash;
        // Adding 0 makes one zero of the two, which are equal.
        ((self.0.x + 0.0).to_bits(), (self.0.y + 0.0).to_bits()).hash(hasher);
        Ok(())
    }

    fn get_methods() -> Option<&'static Methods> {
        static METHODS: MethodsStatic = MethodsStatic::new("point", methods);
        Some(METHODS.methods())
    }
}

#[starlark_module]
fn methods(builder: &mut MethodsBuilder) {
    #[starlark(attribute)]
    fn x(this: &PointValue) -> starlark::Result<f64> {
        Ok(this.0.x)
    }

    #[starlark(attribute)]
    fn y(this: &PointValue) -> starlark::Result<f64> {
        Ok(this.0.y)
    }

    fn length(this: &PointValue) -> starlark::Result<f64> {
        Ok(this.0.length())
    }

    fn dot(
        this: &PointValue,
        #[starlark(require = pos)] other: &PointValue,
    ) -> starlark::Result<f64> {
        Ok(this.0.dot(other.0))
    }
}
