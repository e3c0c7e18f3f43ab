//! Fields: scalar functions of the plane, and vectors in space.

use std::collections::BTreeMap;
use std::sync::Arc;

use fretwork_action::Action;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Field, Point, Point3, Raster, Relief};
use fretwork_language::Node;
use fretwork_language::kinds::fields::{
    Derive, Field as Kind, FieldUnit, Formula, Interpolation, Operator, Raster as RasterKind,
};
use fretwork_script::ScalarExpression;
use fretwork_source::image;

/// The function that a field stands for.
///
/// # Errors
/// When its formula is wrong, its picture cannot be read, or it is not supported.
pub fn field(action: &Action) -> Result<Field, Vec<Diagnostic>> {
    let Node::Field(kind) = &action.definition.node else {
        let what = action.definition.node.kind_name();
        return Err(vec![action.unsupported(&format!("`{what}` as a field"))]);
    };
    action.memo.get(action.files.revision(), || match kind {
        Kind::Expression(formula) => expression(action, formula),
        Kind::Derive(derive) => derived(action, derive),
        Kind::Raster(raster) => picture(action, raster),
        Kind::Attribute(_) => Err(vec![action.unsupported("the field `attribute`")]),
    })
}

/// Whether what a field stands for can be put together.
///
/// # Errors
/// What is wrong with it.
pub fn prepare(action: &Action) -> Result<(), Vec<Diagnostic>> {
    match &action.definition.node {
        Node::Field(Kind::Expression(formula)) if formula.value.len() == 3 => {
            space_vectors(action).map(|_| ())
        }
        _ => field(action).map(|_| ()),
    }
}

/// A function of space that gives vectors.
pub type SpaceVectors = Arc<dyn Fn(Point3) -> [f64; 3] + Send + Sync>;

/// The vectors in space that a field with three formulas of x, y and z stands for.
///
/// # Errors
/// When a formula is wrong, or there are not three.
pub fn space_vectors(action: &Action) -> Result<SpaceVectors, Vec<Diagnostic>> {
    let three = match &action.definition.node {
        Node::Field(Kind::Expression(formula)) => <[_; 3]>::try_from(formula.value.to_vec()).ok(),
        _ => None,
    };
    let Some(three) = three else {
        let message = "a vector in space is needed, of three formulas";
        let error = Diagnostic::error(message).at(action.span(), "in this field");
        return Err(vec![error.help("write `value: [\"-y\", \"x\", \"0\"]`")]);
    };
    let compiled = three
        .iter()
        .map(|text| compile(action, &text.0))
        .collect::<Result<Vec<_>, _>>()?;
    Ok(Arc::new(move |p| {
        std::array::from_fn(|axis| compiled[axis].value(p.x, p.y, p.z))
    }))
}

/// What the numbers of a field are measured in, if it says so.
pub fn unit(action: &Action) -> Option<FieldUnit> {
    match &action.definition.node {
        Node::Field(Kind::Expression(formula)) => formula.unit,
        Node::Field(Kind::Derive(derive)) if derive.operator != Operator::Roughness => {
            Some(FieldUnit::Degree)
        }
        _ => None,
    }
}

/// What is wrong with the formula of a field, found without evaluating anything.
pub fn check(action: &Action, kind: &Kind) -> Vec<Diagnostic> {
    match kind {
        Kind::Expression(formula) if formula.value.len() == 3 => {
            space_vectors(action).err().unwrap_or_default()
        }
        Kind::Expression(formula) => expression(action, formula).err().unwrap_or_default(),
        Kind::Derive(_) | Kind::Raster(_) | Kind::Attribute(_) => Vec::new(),
    }
}

fn expression(action: &Action, formula: &Formula) -> Result<Field, Vec<Diagnostic>> {
    let [text] = &formula.value[..] else {
        return Err(vec![action.unsupported("a field of vectors")]);
    };
    let compiled = compile(action, &text.0)?;
    let span = action.definition.field(&["expression", "value"]);
    if compiled.uses_z() {
        let message = "a field of the plane has no z";
        return Err(vec![Diagnostic::error(message).at(span, "in this formula")]);
    }
    let digest = blake3::hash(&[b"formula\0", text.0.as_bytes()].concat());
    Ok(Field::new(*digest.as_bytes(), move |p| {
        compiled.value(p.x, p.y, 0.0)
    }))
}

/// A formula of x, y and z.
fn compile(action: &Action, text: &str) -> Result<ScalarExpression, Vec<Diagnostic>> {
    let span = action.definition.field(&["expression", "value"]);
    ScalarExpression::compile(text, &BTreeMap::new()).map_err(|error| {
        let diagnostic = Diagnostic::error(error.message).at(span, "in this formula");
        let default = "a formula knows x and y; other values stand in it as `${…}`".to_string();
        vec![diagnostic.help(error.help.unwrap_or(default))]
    })
}

/// The luma of a picture: over the box of a region, or one unit a pixel from the origin.
fn picture(action: &Action, raster: &RasterKind) -> Result<Field, Vec<Diagnostic>> {
    let failed =
        |message: String| vec![Diagnostic::error(message).at(action.span(), "in this field")];
    let (path, bytes) = action.file(&raster.file.0)?;
    if path
        .rsplit_once('.')
        .is_some_and(|(_, e)| e.eq_ignore_ascii_case("tif") || e.eq_ignore_ascii_case("tiff"))
    {
        return Err(vec![action.unsupported("a GeoTIFF")]);
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
        let bounds = action.input(region).bounds();
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

fn derived(action: &Action, derive: &Derive) -> Result<Field, Vec<Diagnostic>> {
    let from = field(&action.input(&derive.from))?;
    let relief = match derive.operator {
        Operator::Slope => Relief::Slope,
        Operator::Aspect => Relief::Aspect,
        Operator::Roughness => Relief::Roughness,
    };
    let spacing = from.spacing().unwrap_or(STEP);
    Ok(from.relief(relief, spacing))
}
