//! Fields: scalar functions of the plane.

use std::collections::BTreeMap;

use super::{Stage, StageResult};
use crate::build::value::Value;
use crate::diagnostic::{Diagnostic, Span};
use crate::geometry::{Field, Relief};
use crate::script::ScalarExpression;
use crate::spec::kinds::fields::{Derive, Field as Kind, Formula, Operator};
use crate::store::Hasher;

/// Puts the function together.
pub fn field(stage: &Stage<'_>, kind: &Kind) -> StageResult {
    let field = match kind {
        Kind::Expression(formula) => expression(stage, formula)?,
        Kind::Derive(derive) => derived(stage, derive)?,
        Kind::Raster(_) | Kind::Attribute(_) => {
            return Err(vec![stage.unsupported(&format!("the field `{}`", kind.kind()))]);
        }
    };
    Ok((Value::Field(field), Vec::new()))
}

fn expression(stage: &Stage<'_>, formula: &Formula) -> Result<Field, Vec<Diagnostic>> {
    let [text] = &formula.value[..] else { return Err(vec![stage.unsupported("a field of vectors")]) };
    let at = |steps: &[&str]| {
        let id = &stage.definition.id;
        let path = [id.section.name(), &*id.name].into_iter().chain(steps.iter().copied());
        Span::value(&stage.definition.file, &path.map(std::sync::Arc::from).collect::<Vec<_>>())
    };
    let span = at(&["expression", "value"]);
    let compiled = ScalarExpression::compile(&text.0, &BTreeMap::new()).map_err(|error| {
        let diagnostic = Diagnostic::error(error.message).at(span.clone(), "in this formula");
        let default = "a formula knows x and y; other values stand in it as `${…}`".to_string();
        vec![diagnostic.help(error.help.unwrap_or(default))]
    })?;
    if compiled.uses_z() {
        let message = "a field of the plane has no z";
        return Err(vec![Diagnostic::error(message).at(span, "in this formula")]);
    }
    let digest = Hasher::new("formula").part(text.0.as_bytes()).digest();
    Ok(Field::new(*digest.as_bytes(), move |p| compiled.value(p.x, p.y, 0.0)))
}

/// How far apart the samples of a field without samples of its own are taken for its slope.
const STEP: f64 = 1e-3;

fn derived(stage: &Stage<'_>, derive: &Derive) -> Result<Field, Vec<Diagnostic>> {
    let Value::Field(from) = stage.input(&derive.from) else {
        unreachable!("the graph checks that it is a field");
    };
    let relief = match derive.operator {
        Operator::Slope => Relief::Slope,
        Operator::Aspect => Relief::Aspect,
        Operator::Roughness => Relief::Roughness,
    };
    let spacing = from.spacing().unwrap_or(STEP);
    Ok(from.relief(relief, spacing))
}
