//! Points of the plane, and whether they are places or differences of places.
//!
//! A point carries a weight: 1 for a place, 0 for a difference of places. Weights add up like the points
//! themselves, so that moving the plane by t moves a point of weight w by w·t. Natives give places their weight only where
//! somebody watches (see [`Watch`](crate::watch::Watch)); elsewhere all weights are 0 and nothing is refused.

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

use crate::session::refuse;
use crate::watch::note_text;
use fretwork_geometry::Point;

/// A point or vector.
#[derive(
    Clone, Copy, Debug, PartialEq, ProvidesStaticType, NoSerialize, StarlarkPagablePanic, Allocative,
)]
pub struct PointValue {
    /// Its coordinates.
    #[allocative(skip)]
    pub at: Point,
    /// How much of a translation of the plane it takes part in.
    pub weight: f64,
}

/// Weights that differ by less are the same: they are sums and quotients of a few numbers.
const SAME: f64 = 1e-12;

/// Whether two weights are the same.
pub fn is_same_weight(a: f64, b: f64) -> bool {
    (a - b).abs() < SAME
}

starlark_simple_value!(PointValue);

impl fmt::Display for PointValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.is_difference() {
            note_text();
        }
        write!(f, "point({}, {})", self.at.x, self.at.y)
    }
}

impl PointValue {
    /// A difference of places.
    pub fn difference(at: Point) -> PointValue {
        PointValue { at, weight: 0.0 }
    }

    /// Whether it stays the same where the plane is moved.
    pub fn is_difference(&self) -> bool {
        is_same_weight(self.weight, 0.0)
    }

    /// Its coordinates as numbers.
    ///
    /// # Errors
    /// Where they would be others after a translation.
    fn numbers(&self) -> starlark::Result<Point> {
        if self.is_difference() {
            Ok(self.at)
        } else {
            Err(refuse("it asks where a place lies"))
        }
    }
}

fn scalar(value: Value<'_>) -> Option<f64> {
    UnpackFloat::unpack_value(value).ok().flatten().map(|f| f.0)
}

#[starlark_value(type = "point")]
impl<'v> StarlarkValue<'v> for PointValue {
    fn add(&self, other: Value<'v>, heap: Heap<'v>) -> Option<starlark::Result<Value<'v>>> {
        let other = other.downcast_ref::<Self>()?;
        Some(Ok(heap.alloc(PointValue {
            at: self.at + other.at,
            weight: self.weight + other.weight,
        })))
    }

    fn sub(&self, other: Value<'v>, heap: Heap<'v>) -> starlark::Result<Value<'v>> {
        match other.downcast_ref::<Self>() {
            Some(point) => Ok(heap.alloc(PointValue {
                at: self.at - point.at,
                weight: self.weight - point.weight,
            })),
            None => ValueError::unsupported_with(self, "-", other),
        }
    }

    fn mul(&self, factor: Value<'v>, heap: Heap<'v>) -> Option<starlark::Result<Value<'v>>> {
        let factor = scalar(factor)?;
        Some(Ok(heap.alloc(PointValue {
            at: self.at * factor,
            weight: self.weight * factor,
        })))
    }

    fn rmul(&self, factor: Value<'v>, heap: Heap<'v>) -> Option<starlark::Result<Value<'v>>> {
        self.mul(factor, heap)
    }

    fn div(&self, divisor: Value<'v>, heap: Heap<'v>) -> starlark::Result<Value<'v>> {
        match scalar(divisor) {
            Some(0.0) => Err(ValueError::DivisionByZero.into()),
            Some(d) => Ok(heap.alloc(PointValue {
                at: Point::new(self.at.x / d, self.at.y / d),
                weight: self.weight / d,
            })),
            None => ValueError::unsupported_with(self, "/", divisor),
        }
    }

    fn minus(&self, heap: Heap<'v>) -> starlark::Result<Value<'v>> {
        Ok(heap.alloc(PointValue {
            at: -self.at,
            weight: -self.weight,
        }))
    }

    fn plus(&self, heap: Heap<'v>) -> starlark::Result<Value<'v>> {
        Ok(heap.alloc(*self))
    }

    fn equals(&self, other: Value<'v>) -> starlark::Result<bool> {
        let Some(other) = other.downcast_ref::<Self>() else {
            return Ok(false);
        };
        if !is_same_weight(self.weight, other.weight) {
            return Err(refuse("it asks where a place lies"));
        }
        Ok(self.at == other.at)
    }

    fn write_hash(&self, hasher: &mut StarlarkHasher) -> starlark::Result<()> {
        use std::hash::Hash;
        let at = self.numbers()?;
        // Adding 0 makes one zero of the two, which are equal.
        ((at.x + 0.0).to_bits(), (at.y + 0.0).to_bits()).hash(hasher);
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
        Ok(this.numbers()?.x)
    }

    #[starlark(attribute)]
    fn y(this: &PointValue) -> starlark::Result<f64> {
        Ok(this.numbers()?.y)
    }

    fn length(this: &PointValue) -> starlark::Result<f64> {
        Ok(this.numbers()?.length())
    }

    fn dot(
        this: &PointValue,
        #[starlark(require = pos)] other: &PointValue,
    ) -> starlark::Result<f64> {
        Ok(this.numbers()?.dot(other.numbers()?))
    }
}
