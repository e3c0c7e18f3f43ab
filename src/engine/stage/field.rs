//! Fields: scalar functions of the plane.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{Stage, StageResult};
use crate::value::Value;
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::{Field, Point, Raster, Relief};
use fretwork_language::kinds::fields::{
    Derive, Field as Kind, Formula, Interpolation, Operator, Raster as RasterKind,
};
use fretwork_script::ScalarExpression;
use fretwork_source::image;
use fretwork_store::Hasher;

/// Puts the function together.
pub fn field(stage: &Stage<'_>, kind: &Kind) -> StageResult {
    let field = match kind {
        Kind::Expression(formula) => expression(stage, formula)?,
        Kind::Derive(derive) => derived(stage, derive)?,
        Kind::Raster(raster) => picture(stage, raster)?,
        Kind::Attribute(_) => return Err(vec![stage.unsupported("the field `attribute`")]),
    };
    Ok((Value::Field(field), Vec::new()))
}

/// What is wrong with the formula of a field, found without evaluating anything.
pub fn check(stage: &Stage<'_>, kind: &Kind) -> Vec<Diagnostic> {
    match kind {
        Kind::Expression(formula) => expression(stage, formula).err().unwrap_or_default(),
        Kind::Derive(_) | Kind::Raster(_) | Kind::Attribute(_) => Vec::new(),
    }
}

fn expression(stage: &Stage<'_>, formula: &Formula) -> Result<Field, Vec<Diagnostic>> {
    let [text] = &formula.value[..] else {
        return Err(vec![stage.unsupported("a field of vectors")]);
    };
    let at = |steps: &[&str]| {
        let id = &stage.definition.id;
        let path = [id.section.name(), &*id.name]
            .into_iter()
            .chain(steps.iter().copied());
        Span::value(
            &stage.definition.file,
            &path.map(Arc::from).collect::<Vec<_>>(),
        )
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
    Ok(Field::new(*digest.as_bytes(), move |p| {
        compiled.value(p.x, p.y, 0.0)
    }))
}

/// The luma of a picture: over the box of a region, or one unit a pixel from the origin.
fn picture(stage: &Stage<'_>, raster: &RasterKind) -> Result<Field, Vec<Diagnostic>> {
    let failed = |message: String| {
        vec![Diagnostic::error(message).at(stage.definition.span(), "in this field")]
    };
    let (path, bytes) = stage.file(&raster.file.0)?;
    if path
        .rsplit_once('.')
        .is_some_and(|(_, e)| e.eq_ignore_ascii_case("tif") || e.eq_ignore_ascii_case("tiff"))
    {
        return Err(vec![stage.unsupported("a GeoTIFF")]);
    }
    if raster.band.0 != 1 {
        return Err(failed(format!(
            "a picture has one band, its luma, and no band {}",
            raster.band.0
        )));
    }
    let luma = image::luma(&bytes).map_err(|e| failed(format!("cannot read `{path}`: {e}")))?;
    let (black, white) = (raster.black.0, raster.white.0);
    let values = luma
        .values
        .iter()
        .map(|v| black + (white - black) * v)
        .collect();
    let mut samples = Raster {
        origin: Point::ORIGIN,
        step: Point::new(1.0, 1.0),
        width: luma.width,
        values,
    };
    if let Some(region) = &raster.region {
        let bounds = stage.region(region).bounds();
        let (columns, rows) = (samples.width as f64, samples.height() as f64);
        samples.origin = bounds.min;
        samples.step = Point::new(bounds.width() / columns, bounds.height() / rows);
    }
    Ok(Field::raster(
        Arc::new(samples),
        raster.interpolate == Interpolation::Bilinear,
    ))
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
