//! Labels and borders of cells (table 3.4, labels).

use starlark::environment::GlobalsBuilder;
use starlark::eval::Evaluator;
use starlark::starlark_module;
use starlark::values::dict::DictRef;
use starlark::values::list::ListRef;
use starlark::values::tuple::TupleRef;
use starlark::values::{Value, ValueLike};

use crate::place::similarity;
use crate::relabel::{labelled, relabel};
use crate::script::operators::arguments::{cell, kind, point_value, text, weighted_curves};
use crate::script::operators::unbounded::{beside, seen};
use crate::script::seeds::plain;
use fretwork_diagnostic::nearest;
use fretwork_geometry::{CurveLabels, Curves, EdgeId, FaceId, LabelSet, PlanarMap, VertexId};
use fretwork_language::scalar::Label;
use fretwork_language::value::{Named, OneOrMany};
use fretwork_script::session::{curves_value, refuse, session};
use fretwork_script::values::{Cell, CellKind, RegionValue};

pub(crate) fn register(builder: &mut GlobalsBuilder) {
    operators(builder);
}

fn labels_of(map: &PlanarMap, cell: Cell) -> LabelSet {
    match cell.kind {
        CellKind::Vertex => map.vertex_labels(VertexId(cell.id)),
        CellKind::Edge => map.labels(EdgeId(cell.id)).edge,
        CellKind::Face => map.face_labels(FaceId(cell.id)),
    }
}

/// How deeply lists of cells may be nested in one another.
const DEPTH: usize = 8;

/// Whether the cell, or one of the cells in a list, has the label; lists in lists, `depth` deep, count as one.
fn has(
    value: Value<'_>,
    label: &str,
    depth: usize,
    eval: &Evaluator<'_, '_, '_>,
) -> starlark::Result<bool> {
    if let Some(cell) = value.downcast_ref::<Cell>() {
        let session = session(eval);
        let labels = session.with_map(*cell, |map| labels_of(map, *cell))?;
        return Ok(!labels.is_empty() && session.has_label(labels, label));
    }
    let items = ListRef::from_value(value).map(|list| list.content());
    if let Some(items) = items.or_else(|| TupleRef::from_value(value).map(|tuple| tuple.content()))
    {
        if depth == 0 {
            return Err(refuse(
                "`has_label` takes a list of cells, not lists within lists",
            ));
        }
        session(eval).charge(items.len())?;
        for item in items {
            if has(*item, label, depth - 1, eval)? {
                return Ok(true);
            }
        }
        return Ok(false);
    }
    if let Some(region) = value.downcast_ref::<RegionValue>() {
        return Ok(region
            .0
            .contour
            .iter()
            .any(|curve| curve.labels.left.contains(label)));
    }
    Err(refuse(format!(
        "`has_label` takes a cell or a list of cells, not {}",
        kind(value)
    )))
}

fn boundary(
    value: Value<'_>,
    operator: &str,
    eval: &Evaluator<'_, '_, '_>,
) -> starlark::Result<bool> {
    if value.downcast_ref::<RegionValue>().is_some() {
        return Ok(true);
    }
    let kinds = [CellKind::Vertex, CellKind::Edge, CellKind::Face];
    let cell = cell(value, operator, &kinds, "a cell")?;
    beside(session(eval), cell)?;
    let is_boundary = session(eval).with_map(cell, |map| plain(cell).is_boundary(map))?;
    seen(session(eval), cell, is_boundary)?;
    Ok(is_boundary)
}

/// What to say about a name that curves do not have.
fn missing(operator: &str, what: &str, name: &str, known: &[&str]) -> starlark::Error {
    let near = nearest(name, known.iter().copied());
    let hint = match (near, known) {
        (Some(near), _) => format!("; did you mean `{near}`?"),
        (None, []) => "; they have none".to_owned(),
        (None, known) => {
            format!(
                "; they have {}",
                known
                    .iter()
                    .take(8)
                    .map(|k| format!("`{k}`"))
                    .collect::<Vec<_>>()
                    .join(", ")
            )
        }
    };
    refuse(format!(
        "`{operator}`: the curves have no {what} `{name}`{hint}"
    ))
}

fn names(curves: &Curves) -> Vec<&str> {
    curves
        .named_points()
        .iter()
        .map(|(name, _)| &**name)
        .collect()
}

#[starlark_module]
fn operators(builder: &mut GlobalsBuilder) {
    /// Whether a cell, or one of the cells in a list, has the label.
    ///
    /// Fails on what is no cell.
    ///
    /// Example: `is_odd = has_label(left_face(edge), 'odd')`
    fn has_label<'v>(
        #[starlark(require = pos)] cells: Value<'v>,
        #[starlark(require = pos)] label: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<bool> {
        has(cells, text(label, "has_label", "a label")?, DEPTH, eval)
    }

    /// Whether the unbounded face lies beside the cell. Also called `is_outside`.
    ///
    /// Fails on what is no cell.
    ///
    /// Example: `is_rim = is_boundary(edge)`
    fn is_boundary<'v>(
        #[starlark(require = pos)] cell: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<bool> {
        boundary(cell, "is_boundary", eval)
    }

    /// Whether the unbounded face does not lie beside the cell: the opposite of `is_boundary`.
    ///
    /// Fails on what is no cell.
    ///
    /// Example: `is_inner = is_bounded_face(face)`
    fn is_bounded_face<'v>(
        #[starlark(require = pos)] cell: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<bool> {
        Ok(!boundary(cell, "is_bounded_face", eval)?)
    }

    /// The point of this name in curves, as drawings label them.
    ///
    /// Fails where there is none, with the names that there are.
    ///
    /// Example: `tip = point_labeled(leaf, 'tip')`
    fn point_labeled<'v>(
        #[starlark(require = pos)] curves: Value<'v>,
        #[starlark(require = pos)] label: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let (of, label) = (
            weighted_curves(curves, "point_labeled")?,
            text(label, "point_labeled", "a label")?,
        );
        let curves = &of.curves;
        match similarity::point_labeled(curves, label) {
            Some(point) => Ok(point_value(point, of.weight, eval)),
            None => Err(missing("point_labeled", "point", label, &names(curves))),
        }
    }

    /// The curves with this label, with all named points.
    ///
    /// Fails where none has it, with the labels that there are.
    ///
    /// Example: `vein = curve_labeled(leaf, 'vein')`
    fn curve_labeled<'v>(
        #[starlark(require = pos)] curves: Value<'v>,
        #[starlark(require = pos)] label: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let (of, label) = (
            weighted_curves(curves, "curve_labeled")?,
            text(label, "curve_labeled", "a label")?,
        );
        let found = similarity::curve_labeled(&of.curves, label);
        curves_value(found, of.weight, eval)
    }

    /// The curves with other labels. A label or a list of labels is given to all lines in place of their own; a dictionary says
    /// what stands in the place of which labels of lines, sides and ends, with `'*'` for those that it does not name.
    ///
    /// Fails on what are no labels.
    ///
    /// Example: `major = set_labels(contour(face), 'major')`
    fn set_labels<'v>(
        #[starlark(require = pos)] curves: Value<'v>,
        #[starlark(require = pos)] labels: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let of = weighted_curves(curves, "set_labels")?;
        session(eval).charge(of.curves.points().len())?;
        let made = match DictRef::from_value(labels) {
            Some(dict) => relabel(&of.curves, &replacements(&dict)?),
            None => {
                let labels = label_list(labels)?;
                let edge = LabelSet::of(labels.iter().map(|label| &*label.0));
                labelled(&of.curves, |own| CurveLabels { edge, ..own })
            }
        };
        curves_value(made, of.weight, eval)
    }
}

/// What a dictionary puts in the place of labels.
fn replacements(dict: &DictRef<'_>) -> starlark::Result<Named<OneOrMany<Label>>> {
    let entry = |(key, value): (Value<'_>, Value<'_>)| {
        let key = text(key, "set_labels", "a label")?;
        Ok((key.into(), OneOrMany(label_list(value)?)))
    };
    let entries: starlark::Result<Vec<_>> = dict.iter().map(entry).collect();
    Ok(Named(entries?))
}

/// A label, or those of a list.
fn label_list(value: Value<'_>) -> starlark::Result<Vec<Label>> {
    let one = |value: Value<'_>| Ok(Label(text(value, "set_labels", "a label")?.into()));
    match ListRef::from_value(value) {
        Some(list) => list.iter().map(one).collect(),
        None => Ok(vec![one(value)?]),
    }
}
