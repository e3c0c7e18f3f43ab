//! Arguments of operators: what they must be, and what is said when they are something else.

use std::sync::Arc;

use starlark::eval::Evaluator;
use starlark::values::list::ListRef;
use starlark::values::tuple::TupleRef;
use starlark::values::{UnpackValue, Value, ValueLike, float::UnpackFloat};

use crate::border::Border;
use fretwork_diagnostic::nearest;
use fretwork_geometry::{Curves, EdgeId, FaceId, LabelSet, Point, Region, VertexId};
use fretwork_script::session::{CurvesValue, refuse, session};
use fretwork_script::values::{Callable, Cell, CellKind, PointValue, RegionValue};

/// Constants of borders and what they are in scripts: the names that specs use.
pub(crate) const BORDERS: [(&str, &str); 4] = [
    ("CROP", "crop"),
    ("CROP_ADD_BOUNDARY", "crop_add_boundary"),
    ("KEEP_INSIDE", "keep_inside"),
    ("KEEP_OUTSIDE", "keep_outside"),
];

/// What becomes of cut cells; to crop them is the default.
pub(crate) fn border(value: Option<Value<'_>>) -> starlark::Result<Border> {
    let Some(value) = value else {
        return Ok(Border::Crop);
    };
    let name = value.unpack_str().unwrap_or_default();
    match name {
        "crop" => Ok(Border::Crop),
        "crop_add_boundary" => Ok(Border::CropAddBoundary),
        "keep_inside" => Ok(Border::KeepInside),
        "keep_outside" => Ok(Border::KeepOutside),
        _ => {
            let near =
                nearest(name, BORDERS.map(|b| b.1)).and_then(|n| BORDERS.iter().find(|b| b.1 == n));
            let hint = near.map_or(
                "CROP, CROP_ADD_BOUNDARY, KEEP_INSIDE or KEEP_OUTSIDE",
                |b| b.0,
            );
            let given = if value.unpack_str().is_some() {
                format!("`{name}`")
            } else {
                kind(value)
            };
            Err(refuse(format!(
                "{given} is no border; did you mean {hint}?"
            )))
        }
    }
}

/// Whether `value` can be called: a function of the script, of the language, or an arrangement.
pub(crate) fn is_function(value: Value<'_>) -> bool {
    Callable::from_value(value).is_some() || value.get_type() == "function"
}

/// A function, wanted by `operator` as `what`.
pub(crate) fn function<'v>(
    value: Value<'v>,
    operator: &str,
    what: &str,
) -> starlark::Result<Value<'v>> {
    if is_function(value) {
        return Ok(value);
    }
    let hint = if value.downcast_ref::<CurvesValue>().is_some() {
        "; `lambda region: curves` is one"
    } else {
        ""
    };
    Err(refuse(format!(
        "`{operator}` takes {what}, not {}{hint}",
        kind(value)
    )))
}

/// What `value` is, with its article.
pub(crate) fn kind(value: Value<'_>) -> String {
    if let Some(cell) = value.downcast_ref::<Cell>() {
        return match cell.kind {
            CellKind::Edge => "an edge".into(),
            kind => format!("a {}", kind.name()),
        };
    }
    if Callable::from_value(value).is_some() {
        return "an arrangement".into();
    }
    match value.get_type() {
        "NoneType" => "None".into(),
        "int" => "a number".into(),
        "float" => "a number".into(),
        "curves" => "curves".into(),
        "properties" => "properties".into(),
        other => format!("a {other}"),
    }
}

/// Text, wanted by `operator` as `what`.
pub(crate) fn text<'v>(value: Value<'v>, operator: &str, what: &str) -> starlark::Result<&'v str> {
    value.unpack_str().ok_or_else(|| {
        refuse(format!(
            "`{operator}` takes {what} as text, not {}",
            kind(value)
        ))
    })
}

/// A cell of one of the kinds that `operator` takes, which `wanted` names.
pub(crate) fn cell(
    value: Value<'_>,
    operator: &str,
    kinds: &[CellKind],
    wanted: &str,
) -> starlark::Result<Cell> {
    match value.downcast_ref::<Cell>() {
        Some(cell) if kinds.contains(&cell.kind) => Ok(*cell),
        _ => Err(refuse(format!(
            "`{operator}` takes {wanted}, not {}",
            kind(value)
        ))),
    }
}

/// A vertex.
pub(crate) fn vertex(value: Value<'_>, operator: &str) -> starlark::Result<(Cell, VertexId)> {
    let cell = cell(value, operator, &[CellKind::Vertex], "a vertex")?;
    Ok((cell, VertexId(cell.id)))
}

/// An edge.
pub(crate) fn edge(value: Value<'_>, operator: &str) -> starlark::Result<(Cell, EdgeId)> {
    let cell = cell(value, operator, &[CellKind::Edge], "an edge")?;
    Ok((cell, EdgeId(cell.id)))
}

/// A bounded face, or a region of several pieces.
pub(crate) enum Area {
    Face(Cell, FaceId),
    Region(Arc<Region>),
}

/// A bounded face or region.
pub(crate) fn area(value: Value<'_>, operator: &str) -> starlark::Result<Area> {
    if let Some(region) = value.downcast_ref::<RegionValue>() {
        return Ok(Area::Region(region.0.clone()));
    }
    let cell = cell(value, operator, &[CellKind::Face], "a face")?;
    if cell.id == FaceId::UNBOUNDED.0 {
        return Err(refuse(format!(
            "`{operator}` takes a bounded face, not the unbounded one"
        )));
    }
    Ok(Area::Face(cell, FaceId(cell.id)))
}

/// Curves.
pub(crate) fn curves<'v>(value: Value<'v>, operator: &str) -> starlark::Result<&'v Arc<Curves>> {
    weighted_curves(value, operator).map(|value| &value.curves)
}

/// Curves with their weight.
pub(crate) fn weighted_curves<'v>(
    value: Value<'v>,
    operator: &str,
) -> starlark::Result<&'v CurvesValue> {
    match value.downcast_ref::<CurvesValue>() {
        Some(curves) => Ok(curves),
        None => Err(refuse(format!(
            "`{operator}` takes curves, not {}",
            kind(value)
        ))),
    }
}

/// A point with its weight.
pub(crate) fn point(value: Value<'_>, operator: &str) -> starlark::Result<PointValue> {
    match value.downcast_ref::<PointValue>() {
        Some(point) => Ok(*point),
        None => Err(refuse(format!(
            "`{operator}` takes a point, not {}",
            kind(value)
        ))),
    }
}

/// A finite number.
pub(crate) fn number(value: Value<'_>, operator: &str) -> starlark::Result<f64> {
    match UnpackFloat::unpack_value(value).ok().flatten() {
        Some(number) if number.0.is_finite() => Ok(number.0),
        Some(number) => Err(refuse(format!(
            "`{operator}` takes a finite number, not {}",
            number.0
        ))),
        None => Err(refuse(format!(
            "`{operator}` takes a number, not {}",
            kind(value)
        ))),
    }
}

/// The items of lists and tuples among `values`, in place of those.
pub(crate) fn flat<'v>(values: &[Value<'v>]) -> Vec<Value<'v>> {
    let mut out = Vec::with_capacity(values.len());
    for value in values {
        if let Some(list) = ListRef::from_value(*value) {
            out.extend(list.iter());
        } else if let Some(tuple) = TupleRef::from_value(*value) {
            out.extend(tuple.iter());
        } else {
            out.push(*value);
        }
    }
    out
}

/// A label.
pub(crate) fn label(value: Value<'_>, operator: &str) -> starlark::Result<LabelSet> {
    match value.unpack_str() {
        Some(text) if !text.is_empty() => Ok(LabelSet::one(text)),
        Some(_) => Err(refuse(format!("`{operator}`: a label is not empty"))),
        None => Err(refuse(format!(
            "`{operator}` takes labels, not {}",
            kind(value)
        ))),
    }
}

/// A new point of a weight.
pub(crate) fn point_value<'v>(at: Point, weight: f64, eval: &Evaluator<'v, '_, '_>) -> Value<'v> {
    eval.heap().alloc(PointValue { at, weight })
}

/// A new point where a cell is.
pub(crate) fn place_value<'v>(at: Point, eval: &Evaluator<'v, '_, '_>) -> Value<'v> {
    point_value(at, session(eval).weight(), eval)
}
