//! What a spec hands to a script: plain values, elements, fields, other arrangements.

use std::sync::Arc;

use starlark::eval::Evaluator;
use starlark::values::{Value as Script, ValueLike};

use crate::function::{Arrangement, Manner};
use crate::patch::Patch;
use crate::script::place::Place;
use crate::script::seeds::inner;
use fretwork_geometry::{Curves, Field, Point, VectorField};
use fretwork_script::Value;
use fretwork_script::module::Supplied;
use fretwork_script::session::{CurvesValue, refuse, session};
use fretwork_script::values::{Cell, Operation, PointValue};

/// An argument of an entry function.
#[derive(Clone)]
pub enum Argument {
    /// A number, text, list or dictionary.
    Value(Value),
    /// An element.
    Curves(Arc<Curves>),
    /// A function of the plane; the script calls it on a point or a cell.
    Field(Field),
    /// The same, with points as values.
    VectorField(VectorField),
    /// An arrangement; the script calls it on a face, or hands it to operators.
    Arrangement(Arrangement),
    /// Several of them.
    List(Vec<Argument>),
}

impl Argument {
    pub(crate) fn supplied(&self) -> Supplied {
        match self {
            Argument::Value(value) => Supplied::Plain(value.clone()),
            Argument::Curves(curves) => Supplied::Curves(curves.clone()),
            Argument::Field(field) => Supplied::Function(Arc::new(Scalar(field.clone()))),
            Argument::VectorField(field) => Supplied::Function(Arc::new(Vectors(field.clone()))),
            Argument::Arrangement(given) => Supplied::Function(Arc::new(External(given.clone()))),
            Argument::List(items) => Supplied::List(items.iter().map(Argument::supplied).collect()),
        }
    }
}

/// A scalar field in a script.
#[derive(Debug)]
pub(crate) struct Scalar(pub Field);

/// A vector field in a script.
#[derive(Debug)]
struct Vectors(VectorField);

/// An arrangement from outside in a script.
#[derive(Debug)]
struct External(Arrangement);

/// Where a field is asked for: at a point, or where a cell is.
fn asked(argument: Script<'_>, eval: &Evaluator<'_, '_, '_>) -> starlark::Result<Point> {
    if let Some(point) = argument.downcast_ref::<PointValue>() {
        return Ok(point.at);
    }
    match argument.downcast_ref::<Cell>() {
        Some(cell) => inner(session(eval), *cell),
        None => Err(refuse(format!(
            "a field is asked at a point or a cell, not at a {}",
            argument.get_type()
        ))),
    }
}

impl Operation for Scalar {
    fn name(&self) -> &'static str {
        "field"
    }

    fn call<'v>(
        &self,
        _me: Script<'v>,
        argument: Script<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Script<'v>> {
        session(eval).unwatched("it asks for the value of a field")?;
        let at = asked(argument, eval)?;
        let value = self.0.value(at);
        if value.is_finite() {
            Ok(eval.heap().alloc(value))
        } else {
            Ok(Script::new_none())
        }
    }
}

impl Operation for Vectors {
    fn name(&self) -> &'static str {
        "field"
    }

    fn call<'v>(
        &self,
        _me: Script<'v>,
        argument: Script<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Script<'v>> {
        session(eval).unwatched("it asks for the value of a field")?;
        let at = asked(argument, eval)?;
        let value = self.0.value(at);
        if value.is_finite() {
            Ok(eval.heap().alloc(PointValue::difference(value)))
        } else {
            Err(nowhere(at))
        }
    }
}

fn nowhere(at: Point) -> starlark::Error {
    refuse(format!("the field has no value at ({}, {})", at.x, at.y))
}

impl Operation for External {
    fn name(&self) -> &'static str {
        "arrangement"
    }

    fn call<'v>(
        &self,
        _me: Script<'v>,
        argument: Script<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Script<'v>> {
        let region = Place::of(argument, eval)?.region(eval)?;
        let session = session(eval);
        let manner = match session.watch() {
            Some(_) => Manner::Regular(Patch::NOWHERE),
            None => Manner::Free,
        };
        if session.watch().is_some() && !self.0.goes_along() {
            return Err(refuse("it draws an arrangement that stays where it is"));
        }
        let applied = session.deeper(|| {
            let applied = self.0.apply_as(&region, session.scale().resolution, manner);
            applied.map_err(|errors| {
                refuse(
                    errors
                        .first()
                        .map_or("the arrangement failed", |e| &e.message),
                )
            })
        })?;
        session.draw(&applied)?;
        let (curves, weight) = (applied, session.weight());
        Ok(eval.heap().alloc(CurvesValue { curves, weight }))
    }
}
