//! The mathematical functions of expressions and scripts: names, numbers of arguments, values.
//! Angles are in radians; transcendental functions come from `libm`, so that every machine gives
//! the same bits. What is not here: operators, and functions of anything but numbers.

use std::cmp::Ordering;

/// A number of an expression: whole numbers stay whole where Starlark keeps them so.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Number {
    /// A whole number.
    Int(i64),
    /// Any other.
    Float(f64),
}

impl Number {
    /// The nearest floating point number.
    pub fn float(self) -> f64 {
        match self {
            Number::Int(i) => i as f64,
            Number::Float(f) => f,
        }
    }

    /// Which of two is greater, exactly for two whole numbers, whose floats may be the same; none
    /// where one is not a number.
    pub(crate) fn order(self, other: Number) -> Option<Ordering> {
        match (self, other) {
            (Number::Int(a), Number::Int(b)) => Some(a.cmp(&b)),
            _ => self.float().partial_cmp(&other.float()),
        }
    }
}

/// A function of one or more numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    /// Absolute value; of a whole number a whole one.
    Abs,
    /// Inverse cosine.
    Acos,
    /// Inverse sine.
    Asin,
    /// Inverse tangent.
    Atan,
    /// The angle of (x, y), `atan2(y, x)`.
    Atan2,
    /// Cube root.
    Cbrt,
    /// The next whole number at or above.
    Ceil,
    /// Cosine.
    Cos,
    /// Hyperbolic cosine.
    Cosh,
    /// Radians to degrees.
    Degrees,
    /// The exponential.
    Exp,
    /// The next whole number at or below.
    Floor,
    /// The length of a vector.
    Hypot,
    /// Natural logarithm, or `log(x, base)`.
    Log,
    /// Logarithm of base 10.
    Log10,
    /// Logarithm of base 2.
    Log2,
    /// The greatest.
    Max,
    /// The least.
    Min,
    /// A power; whole where both arguments are and the second is not negative.
    Pow,
    /// Degrees to radians.
    Radians,
    /// The nearest whole number, halves away from zero; `round(x, digits)` keeps digits after the point.
    Round,
    /// -1, 0 or 1.
    Sign,
    /// Sine.
    Sin,
    /// Hyperbolic sine.
    Sinh,
    /// Square root.
    Sqrt,
    /// Tangent.
    Tan,
    /// Hyperbolic tangent.
    Tanh,
    /// The whole part.
    Trunc,
}

use Function::*;

/// Name, function, least and greatest number of arguments, in the order of the names.
pub const FUNCTIONS: [(&str, Function, usize, usize); 28] = [
    ("abs", Abs, 1, 1),
    ("acos", Acos, 1, 1),
    ("asin", Asin, 1, 1),
    ("atan", Atan, 1, 1),
    ("atan2", Atan2, 2, 2),
    ("cbrt", Cbrt, 1, 1),
    ("ceil", Ceil, 1, 1),
    ("cos", Cos, 1, 1),
    ("cosh", Cosh, 1, 1),
    ("degrees", Degrees, 1, 1),
    ("exp", Exp, 1, 1),
    ("floor", Floor, 1, 1),
    ("hypot", Hypot, 2, 3),
    ("log", Log, 1, 2),
    ("log10", Log10, 1, 1),
    ("log2", Log2, 1, 1),
    ("max", Max, 2, 32),
    ("min", Min, 2, 32),
    ("pow", Pow, 2, 2),
    ("radians", Radians, 1, 1),
    ("round", Round, 1, 2),
    ("sign", Sign, 1, 1),
    ("sin", Sin, 1, 1),
    ("sinh", Sinh, 1, 1),
    ("sqrt", Sqrt, 1, 1),
    ("tan", Tan, 1, 1),
    ("tanh", Tanh, 1, 1),
    ("trunc", Trunc, 1, 1),
];

impl Function {
    /// The function of this name.
    pub fn named(name: &str) -> Option<Function> {
        FUNCTIONS
            .binary_search_by(|entry| entry.0.cmp(name))
            .ok()
            .map(|i| FUNCTIONS[i].1)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        FUNCTIONS[self as usize].0
    }

    /// The least and the greatest number of arguments.
    pub fn arity(self) -> (usize, usize) {
        let (_, _, least, greatest) = FUNCTIONS[self as usize];
        (least, greatest)
    }

    /// The value at `args`, whose number [`Function::arity`] allows; NaN outside the domain.
    pub fn value(self, args: &[f64]) -> f64 {
        let x = args[0];
        match self {
            Abs => x.abs(),
            Acos => libm::acos(x),
            Asin => libm::asin(x),
            Atan => libm::atan(x),
            Atan2 => libm::atan2(x, args[1]),
            Cbrt => libm::cbrt(x),
            Ceil => libm::ceil(x),
            Cos => libm::cos(x),
            Cosh => libm::cosh(x),
            Degrees => x * (180.0 / std::f64::consts::PI),
            Exp => libm::exp(x),
            Floor => libm::floor(x),
            Hypot => args[1..]
                .iter()
                .fold(x.abs(), |length, side| libm::hypot(length, *side)),
            Log if args.len() == 2 => libm::log(x) / libm::log(args[1]),
            Log => libm::log(x),
            Log10 => libm::log10(x),
            Log2 => libm::log2(x),
            Max => args[1..]
                .iter()
                .fold(x, |most, next| if *next > most { *next } else { most }),
            Min => args[1..]
                .iter()
                .fold(x, |least, next| if *next < least { *next } else { least }),
            Pow => libm::pow(x, args[1]),
            Radians => x * (std::f64::consts::PI / 180.0),
            Round if args.len() == 2 => rounded(x, args[1]),
            Round => libm::round(x),
            Sign => f64::from(u8::from(x > 0.0)) - f64::from(u8::from(x < 0.0)),
            Sin => libm::sin(x),
            Sinh => libm::sinh(x),
            Sqrt => x.sqrt(),
            Tan => libm::tan(x),
            Tanh => libm::tanh(x),
            Trunc => libm::trunc(x),
        }
    }

    /// The value at `args`, whole where the function gives whole numbers.
    ///
    /// # Errors
    /// A wrong number of arguments, a value that is not a finite number, a whole number that 64
    /// bits do not hold.
    pub fn call(self, args: &[Number]) -> Result<Number, MathError> {
        let (least, greatest) = self.arity();
        if args.len() < least || args.len() > greatest {
            return Err(MathError::Arguments {
                function: self.name(),
                least,
                greatest,
                given: args.len(),
            });
        }
        if let Some(whole) = self.whole(args) {
            return Ok(Number::Int(whole));
        }
        if let Max | Min = self {
            return Ok(self.extreme(args));
        }
        let floats: Vec<f64> = args.iter().map(|n| n.float()).collect();
        let value = self.value(&floats);
        if !value.is_finite() {
            return Err(MathError::Undefined {
                call: self.described(&floats),
                value,
            });
        }
        match self {
            Floor | Ceil | Trunc | Sign => Self::integer(value, || self.described(&floats)),
            Round if args.len() == 1 => Self::integer(value, || self.described(&floats)),
            _ => Ok(Number::Float(value)),
        }
    }

    /// The value where whole arguments give a whole value without going through floats.
    fn whole(self, args: &[Number]) -> Option<i64> {
        match (self, args) {
            (Abs, [Number::Int(i)]) => i.checked_abs(),
            (Floor | Ceil | Trunc | Round, [Number::Int(i)]) => Some(*i),
            (Sign, [Number::Int(i)]) => Some(i.signum()),
            (Pow, [Number::Int(base), Number::Int(power)]) => {
                base.checked_pow(u32::try_from(*power).ok()?)
            }
            _ => None,
        }
    }

    /// The first of the greatest, or of the least, kept as it is.
    fn extreme(self, args: &[Number]) -> Number {
        args[1..].iter().fold(args[0], |best, next| {
            let wanted = if self == Max {
                Ordering::Greater
            } else {
                Ordering::Less
            };
            if next.order(best) == Some(wanted) {
                *next
            } else {
                best
            }
        })
    }

    fn integer(value: f64, call: impl FnOnce() -> String) -> Result<Number, MathError> {
        const LIMIT: f64 = 9_223_372_036_854_775_808.0;
        if (-LIMIT..LIMIT).contains(&value) {
            Ok(Number::Int(value as i64))
        } else {
            Err(MathError::Undefined {
                call: call(),
                value,
            })
        }
    }

    fn described(self, args: &[f64]) -> String {
        let args: Vec<String> = args.iter().map(f64::to_string).collect();
        format!("{}({})", self.name(), args.join(", "))
    }
}

fn rounded(x: f64, digits: f64) -> f64 {
    let unit = libm::pow(10.0, libm::round(digits).clamp(-300.0, 300.0));
    let scaled = x * unit;
    // Beyond 2^53 every float is whole already.
    if scaled.abs() < 9_007_199_254_740_992.0 {
        libm::round(scaled) / unit
    } else {
        x
    }
}

/// Why a function has no value.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MathError {
    /// Too few or too many arguments.
    #[error("`{function}` takes {}, {given} given", arguments(*least, *greatest))]
    Arguments {
        function: &'static str,
        least: usize,
        greatest: usize,
        given: usize,
    },
    /// The value is not a number, infinite, or beyond 64 bits.
    #[error("{call} is {value}, which is not a usable number")]
    Undefined { call: String, value: f64 },
}

fn arguments(least: usize, greatest: usize) -> String {
    match (least, greatest) {
        (1, 1) => "1 argument".into(),
        (a, b) if a == b => format!("{a} arguments"),
        (a, b) => format!("{a} to {b} arguments"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_sorted_and_agrees_with_the_enum() {
        assert!(FUNCTIONS.windows(2).all(|w| w[0].0 < w[1].0));
        for (i, (name, function, ..)) in FUNCTIONS.iter().enumerate() {
            assert_eq!(*function as usize, i);
            assert_eq!(Function::named(name), Some(*function));
        }
        assert_eq!(Function::named("sinus"), None);
    }

    #[test]
    fn whole_numbers_stay_whole() {
        use Number::{Float, Int};
        assert_eq!(Floor.call(&[Float(-2.5)]), Ok(Int(-3)));
        assert_eq!(Round.call(&[Float(2.5)]), Ok(Int(3)));
        assert_eq!(Round.call(&[Float(2.345), Int(2)]), Ok(Float(2.35)));
        assert_eq!(Pow.call(&[Int(2), Int(10)]), Ok(Int(1024)));
        assert_eq!(Pow.call(&[Int(2), Int(-1)]), Ok(Float(0.5)));
        assert_eq!(Max.call(&[Int(3), Float(2.5), Int(3)]), Ok(Int(3)));
        assert_eq!(Abs.call(&[Int(-7)]), Ok(Int(7)));
    }

    #[test]
    fn whole_numbers_whose_floats_are_the_same_are_told_apart() {
        let (less, most) = (Number::Int(i64::MAX - 7), Number::Int(i64::MAX));
        assert_eq!(Max.call(&[less, most]), Ok(most));
        assert_eq!(Min.call(&[most, less]), Ok(less));
    }

    #[test]
    fn values_outside_the_domain_are_errors() {
        assert!(matches!(
            Sqrt.call(&[Number::Int(-1)]),
            Err(MathError::Undefined { .. })
        ));
        assert!(matches!(
            Exp.call(&[Number::Int(1000)]),
            Err(MathError::Undefined { .. })
        ));
        assert!(matches!(
            Floor.call(&[Number::Float(1e300)]),
            Err(MathError::Undefined { .. })
        ));
        assert_eq!(
            Atan2.call(&[Number::Int(1)]).unwrap_err().to_string(),
            "`atan2` takes 2 arguments, 1 given"
        );
    }
}
