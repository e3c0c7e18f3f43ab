//! The natives that the rewritten text calls in place of operators and methods: each charges the
//! budget, then does what Starlark does.

use starlark::environment::GlobalsBuilder;
use starlark::eval::Evaluator;
use starlark::starlark_module;
use starlark::values::Value;
use starlark::values::tuple::TupleRef;

use crate::sandbox::checks::{
    check_comparison, check_membership, check_percent, check_product, check_repetition, numbers,
};
use crate::sandbox::measure::{charge, measure, size};
use crate::values::bounded::BoundedMethod;

/// Puts the natives among the globals.
pub(crate) fn register(builder: &mut GlobalsBuilder) {
    passing(builder);
    operators(builder);
    equality(builder);
    order(builder);
    augmented(builder);
}

#[starlark_module]
fn passing(builder: &mut GlobalsBuilder) {
    fn _bounded<'v>(
        value: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        charge(eval, size(value))?;
        Ok(value)
    }

    fn _bounded_tuple<'v>(
        value: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        // A tuple of tuples is hashed as often as it is reached: towers of shared ones must stay small.
        let nested = TupleRef::from_value(value)
            .is_some_and(|t| t.iter().any(|v| TupleRef::from_value(v).is_some()));
        if nested {
            charge(eval, measure(value)?)?;
        }
        Ok(value)
    }

    fn _bounded_method<'v>(
        value: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let kind = value.get_type();
        if !matches!(kind, "string" | "list" | "dict" | "set") {
            return Ok(value);
        }
        charge(eval, size(value))?;
        Ok(eval.heap().alloc(BoundedMethod::new(value)))
    }
}

#[starlark_module]
fn operators(builder: &mut GlobalsBuilder) {
    fn _bounded_add<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        if !numbers(a, b) {
            charge(eval, size(a).saturating_add(size(b)))?;
        }
        a.add(b, eval.heap())
    }

    fn _bounded_multiply<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        if !numbers(a, b) {
            check_repetition(a, b, eval)?;
        }
        a.mul(b, eval.heap())
    }

    fn _bounded_percent<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        check_percent(a, b, eval)?;
        a.percent(b, eval.heap())
    }

    fn _bounded_shift<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        check_product(a, b)?;
        a.left_shift(b, eval.heap())
    }

    fn _bounded_or<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        charge(eval, size(a).saturating_add(size(b)))?;
        a.bit_or(b, eval.heap())
    }
}

#[starlark_module]
fn equality(builder: &mut GlobalsBuilder) {
    fn _bounded_equal<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<bool> {
        check_comparison(a, b, eval)?;
        a.equals(b)
    }

    fn _bounded_unequal<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<bool> {
        check_comparison(a, b, eval)?;
        Ok(!a.equals(b)?)
    }

    fn _bounded_in<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<bool> {
        check_membership(a, b, eval)?;
        b.is_in(a)
    }

    fn _bounded_not_in<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<bool> {
        check_membership(a, b, eval)?;
        Ok(!b.is_in(a)?)
    }
}

#[starlark_module]
fn order(builder: &mut GlobalsBuilder) {
    fn _bounded_less<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<bool> {
        check_comparison(a, b, eval)?;
        Ok(a.compare(b)?.is_lt())
    }

    fn _bounded_at_most<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<bool> {
        check_comparison(a, b, eval)?;
        Ok(a.compare(b)?.is_le())
    }

    fn _bounded_greater<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<bool> {
        check_comparison(a, b, eval)?;
        Ok(a.compare(b)?.is_gt())
    }

    fn _bounded_at_least<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<bool> {
        check_comparison(a, b, eval)?;
        Ok(a.compare(b)?.is_ge())
    }
}

/// The right sides of augmented assignments: checked against the old value, and handed back.
#[starlark_module]
fn augmented(builder: &mut GlobalsBuilder) {
    fn _bounded_adding<'v>(
        old: Value<'v>,
        new: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        if !numbers(old, new) {
            charge(eval, size(old).saturating_add(size(new)))?;
        }
        Ok(new)
    }

    fn _bounded_multiplying<'v>(
        old: Value<'v>,
        new: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        check_repetition(old, new, eval)?;
        Ok(new)
    }

    fn _bounded_filling<'v>(
        old: Value<'v>,
        new: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        check_percent(old, new, eval)?;
        Ok(new)
    }

    fn _bounded_shifting<'v>(old: Value<'v>, new: Value<'v>) -> starlark::Result<Value<'v>> {
        check_product(old, new)?;
        Ok(new)
    }

    fn _bounded_joining<'v>(
        old: Value<'v>,
        new: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        charge(eval, size(old).saturating_add(size(new)))?;
        Ok(new)
    }
}
