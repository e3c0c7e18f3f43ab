//! What happens when a script calls an arrangement: `texture(face)` gives curves.

use starlark::eval::Evaluator;
use starlark::values::Value;

use crate::script::construction::Construction;
use crate::script::evaluation;
use crate::script::place::Place;
use fretwork_script::session::CurvesValue;
use fretwork_script::values::Operation;
use fretwork_script::watch::weight;

impl Operation for Construction {
    fn name(&self) -> &'static str {
        self.what.name()
    }

    fn call<'v>(
        &self,
        me: Value<'v>,
        argument: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let place = Place::of(argument, eval)?;
        let curves = evaluation::evaluate(me, &place, eval)?;
        let weight = weight(eval);
        Ok(eval.heap().alloc(CurvesValue { curves, weight }))
    }
}
