//! Fields: scalar functions of the plane, and vectors in space.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::raster::{self, Made};
use super::zone;
use fretwork_action::{Action, ReadLog};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::budget::hold;
use fretwork_geometry::{Field, Point3, Relief};
use fretwork_language::Node;
use fretwork_language::kinds::fields::{
    Derive, Field as Kind, FieldUnit, Formula, Operator, Statistic,
};
use fretwork_language::scalar::Number;
use fretwork_script::ScalarExpression;

/// The function that a field stands for.
///
/// # Errors
/// When its formula is wrong, its file cannot be read, or it is not supported.
pub fn field(action: &Action) -> Result<Field, Vec<Diagnostic>> {
    made(action, &ReadLog::default()).map(|(field, _)| field)
}

/// The function, and warnings. Files beside those that are named are noted in `log`, if this is the first time that the
/// field is put together.
fn made(action: &Action, log: &ReadLog) -> Made {
    let Node::Field(kind) = &action.definition.node else {
        let what = action.definition.node.kind_name();
        return Err(vec![action.unsupported(&format!("`{what}` as a field"))]);
    };
    let plain = |field| (field, Vec::new());
    action.memo.get(action.files.revision(), || match kind {
        Kind::Expression(formula) => expression(action, formula).map(plain),
        Kind::Derive(derive) => derived(action, derive).map(plain),
        Kind::Raster(kind) => raster::field(action, kind, log),
        Kind::Attribute(kind) => zone::attribute(action, kind).map(plain),
        Kind::Zonal(kind) => {
            let from = field(&action.input(&kind.from))?;
            Ok(plain(zone::zonal(action, kind, &from)))
        }
    })
}

/// Whether what a field stands for can be put together; warnings about it. Files beside those that it names are noted in
/// `log`.
///
/// # Errors
/// What is wrong with it.
pub fn prepare(action: &Action, log: &ReadLog) -> Result<Vec<Diagnostic>, Vec<Diagnostic>> {
    match &action.definition.node {
        Node::Field(Kind::Expression(formula)) if formula.value.len() == 3 => {
            space_vectors(action).map(|_| Vec::new())
        }
        _ => {
            let (field, warnings) = made(action, log)?;
            let held = field
                .samples()
                .map(|lattice| lattice.samples().held_bytes());
            // Here and not where they are read: it is by chance which node asks for a block first.
            hold("decoded blocks of a raster", 1, held.unwrap_or(0));
            Ok(warnings)
        }
    }
}

/// What was found to be wrong with the file of a field while its values were asked for.
pub fn fault(action: &Action) -> Option<Diagnostic> {
    let Node::Field(Kind::Raster(kind)) = &action.definition.node else {
        return None;
    };
    let message = field(action).ok()?.samples()?.samples().fault()?;
    let path = &action.definition.files[&kind.file.0];
    let error = Diagnostic::error(format!("cannot read `{path}`: {message}"));
    Some(error.at(action.span(), "in this field"))
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
        .map(|text| compile(action, &text.0, &[]))
        .collect::<Result<Vec<_>, _>>()?;
    let unit = action.definition.own_unit();
    Ok(Arc::new(move |p| {
        std::array::from_fn(|axis| compiled[axis].value(p.x / unit, p.y / unit, p.z / unit))
    }))
}

/// What the numbers of a field are measured in, if it says so.
pub fn unit(action: &Action) -> Option<FieldUnit> {
    let Node::Field(kind) = &action.definition.node else {
        return None;
    };
    match kind {
        Kind::Expression(formula) => formula.unit,
        Kind::Derive(derive) if derive.operator != Operator::Roughness => Some(FieldUnit::Degree),
        Kind::Derive(_) => None,
        Kind::Raster(raster) => raster.unit,
        Kind::Attribute(attribute) => attribute.unit,
        Kind::Zonal(zonal) if zonal.statistic == Statistic::Direction => Some(FieldUnit::Degree),
        Kind::Zonal(zonal) => zonal.unit,
    }
}

/// What the numbers of a field are measured in where they are angles: those of files in degrees, if nothing else is said.
pub fn angle_unit(action: &Action) -> Option<FieldUnit> {
    let of_file = matches!(
        &action.definition.node,
        Node::Field(Kind::Raster(_) | Kind::Attribute(_) | Kind::Zonal(_))
    );
    unit(action).or(of_file.then_some(FieldUnit::Degree))
}

/// What is wrong with the formula of a field, found without evaluating anything.
pub fn check(action: &Action, kind: &Kind) -> Vec<Diagnostic> {
    match kind {
        Kind::Expression(formula) if formula.value.len() == 3 => {
            space_vectors(action).err().unwrap_or_default()
        }
        Kind::Expression(formula) => compiled(action, formula).err().unwrap_or_default(),
        Kind::Derive(_) | Kind::Raster(_) | Kind::Attribute(_) | Kind::Zonal(_) => Vec::new(),
    }
}

/// The formula of a field of the plane.
fn compiled(action: &Action, formula: &Formula) -> Result<ScalarExpression, Vec<Diagnostic>> {
    let [text] = &formula.value[..] else {
        return Err(vec![action.unsupported("a field of vectors")]);
    };
    let names: Vec<Arc<str>> = formula
        .fields
        .iter()
        .flat_map(|fields| fields.iter())
        .map(|(name, _)| name.clone())
        .collect();
    let taken = names
        .iter()
        .find(|name| ["x", "y", "z"].contains(&&***name));
    if let Some(name) = taken {
        let span = action.definition.field_key(&["expression", "fields", name]);
        let error = Diagnostic::error(format!("`{name}` is a coordinate")).at(span, "here");
        return Err(vec![
            error.help("give the field another name in the formula"),
        ]);
    }
    if names.len() > 200 {
        return Err(vec![
            action.unsupported("a formula of more than 200 fields"),
        ]);
    }
    let compiled = compile(action, &text.0, &names)?;
    if compiled.uses_z() {
        let span = action.definition.field(&["expression", "value"]);
        let message = "a field of the plane has no z";
        return Err(vec![Diagnostic::error(message).at(span, "in this formula")]);
    }
    Ok(compiled)
}

fn expression(action: &Action, formula: &Formula) -> Result<Field, Vec<Diagnostic>> {
    let compiled = compiled(action, formula)?;
    let named = formula.fields.iter().flat_map(|fields| fields.iter());
    let inputs = named
        .map(|(_, reference)| field(&action.input(reference)))
        .collect::<Result<Vec<Field>, _>>()?;
    let mut hasher = blake3::Hasher::new();
    hasher
        .update(b"formula\0")
        .update(formula.value[0].0.as_bytes());
    if let Some(fields) = &formula.fields {
        for ((name, _), input) in fields.iter().zip(&inputs) {
            hasher
                .update(b"\0")
                .update(name.as_bytes())
                .update(&input.digest());
        }
    }
    // A formula's coordinates are in the unit of its file.
    let unit = action.definition.own_unit();
    if unit != 1.0 {
        hasher.update(b"\0unit").update(&unit.to_le_bytes());
    }
    let digest = *hasher.finalize().as_bytes();
    let made = if inputs.is_empty() {
        Field::new(digest, move |p| {
            known(compiled.value(p.x / unit, p.y / unit, 0.0))
        })
    } else {
        let read = inputs.clone();
        let function = move |p: fretwork_geometry::Point| {
            let mut variables = vec![p.x / unit, p.y / unit, 0.0];
            variables.extend(read.iter().map(|field| field.value(p)));
            if variables.iter().any(|v| v.is_nan()) {
                return f64::NAN;
            }
            known(compiled.value_over(&variables))
        };
        Field::new(digest, function).over(&inputs)
    };
    Ok(otherwise(made, formula.otherwise))
}

/// The value of a formula, none where that is no finite number, as where it divides by zero.
fn known(value: f64) -> f64 {
    if value.is_finite() { value } else { f64::NAN }
}

/// The field with a value where it has none, if one is said.
fn otherwise(field: Field, value: Option<Number>) -> Field {
    match value {
        Some(value) => field.filled(value.0),
        None => field,
    }
}

/// A formula of x, y and z, and of fields of these names.
fn compile(
    action: &Action,
    text: &str,
    fields: &[Arc<str>],
) -> Result<ScalarExpression, Vec<Diagnostic>> {
    let span = action.definition.field(&["expression", "value"]);
    ScalarExpression::compile_over(text, fields, &BTreeMap::new()).map_err(|error| {
        let diagnostic = Diagnostic::error(error.message).at(span, "in this formula");
        let default = "a formula knows x and y, and the fields under `fields:`; other values stand in it as `${…}`";
        vec![diagnostic.help(error.help.unwrap_or(default.to_string()))]
    })
}

/// How long one of a field of heights is, in the unit that lengths are in.
fn height_unit(action: &Action) -> f64 {
    length_unit(action).map_or(1.0, |millimetres| {
        millimetres / action.definition.units.millimetres()
    })
}

/// What the numbers of a field are as lengths, in millimetres: those without a unit are in that of the field's file. None
/// where they are angles.
pub fn length_unit(action: &Action) -> Option<f64> {
    match unit(action) {
        None => Some(action.definition.own_units.millimetres()),
        Some(FieldUnit::Millimetre) => Some(1.0),
        Some(FieldUnit::Centimetre) => Some(10.0),
        Some(FieldUnit::Metre) => Some(1000.0),
        Some(FieldUnit::Inch) => Some(25.4),
        Some(FieldUnit::Degree | FieldUnit::Radian | FieldUnit::Turn) => None,
    }
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
    let relief = match (relief, height_unit(&action.input(&derive.from))) {
        (Relief::Slope, unit) if unit != 1.0 => {
            let steep = from.relief(relief, spacing);
            steep.map(&format!("of heights in {unit}"), move |angle| {
                libm::atan(libm::tan(angle.to_radians()) * unit).to_degrees()
            })
        }
        _ => from.relief(relief, spacing),
    };
    Ok(otherwise(relief, derive.otherwise))
}
