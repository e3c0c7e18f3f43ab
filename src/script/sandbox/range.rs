//! Ranges of bounded length.

use std::num::NonZeroI32;

use starlark::environment::GlobalsBuilder;
use starlark::starlark_module;
use starlark::values::Value;
use starlark::values::range::Range;

use crate::sandbox::measure::{LARGE, i64_of};

/// Puts the bounded form in place of the standard function.
pub(crate) fn register(builder: &mut GlobalsBuilder) {
    functions(builder);
}

#[derive(Debug, thiserror::Error)]
enum RangeError {
    #[error("a range of {0} numbers is too long; at most {LARGE} are allowed")]
    Long(i64),
    #[error("the step of a range cannot be 0")]
    Step,
    #[error("a range takes whole numbers of at most 64 bits")]
    Number,
    #[error("a range takes numbers between -2147483648 and 2147483647")]
    Far,
}

fn bounded_range(start: i64, stop: i64, step: i64) -> Result<Range, RangeError> {
    let span = if step > 0 {
        i128::from(stop) - i128::from(start)
    } else {
        i128::from(start) - i128::from(stop)
    };
    let width = i128::from(step).abs();
    let count = if width == 0 {
        return Err(RangeError::Step);
    } else {
        (span.max(0) + width - 1) / width
    };
    if count > LARGE as i128 {
        return Err(RangeError::Long(i64::try_from(count).unwrap_or(i64::MAX)));
    }
    let short = |n: i64| i32::try_from(n).map_err(|_| RangeError::Far);
    let step = NonZeroI32::new(short(step)?).ok_or(RangeError::Step)?;
    Ok(Range::new(short(start)?, short(stop)?, step))
}

#[starlark_module]
fn functions(builder: &mut GlobalsBuilder) {
    fn range<'v>(
        #[starlark(require = pos)] a: Value<'v>,
        #[starlark(require = pos)] b: Option<Value<'v>>,
        #[starlark(require = pos)] step: Option<Value<'v>>,
    ) -> starlark::Result<Range> {
        let number =
            |v: Value<'v>| i64_of(v).ok_or_else(|| starlark::Error::new_other(RangeError::Number));
        let (start, stop) = match b {
            Some(b) => (number(a)?, number(b)?),
            None => (0, number(a)?),
        };
        bounded_range(start, stop, step.map_or(Ok(1), number)?).map_err(starlark::Error::new_other)
    }
}
