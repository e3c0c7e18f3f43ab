//! Elements, and putting them in place (tables 3.4 and 3.6, adjacency and transformations).

use starlark::environment::GlobalsBuilder;
use starlark::eval::Evaluator;
use starlark::starlark_module;
use starlark::values::Value;

use crate::place::similarity;
use crate::script::operators::arguments::{
    Area, area, curves, number, point, text, weighted_curves,
};
use fretwork_script::session::{CurvesValue, curves_value, import, refuse, session};
use fretwork_script::values::is_same_weight;
use fretwork_script::watch::weight;

pub(crate) fn register(builder: &mut GlobalsBuilder) {
    operators(builder);
    files(builder);
}

/// Refuses to match places with differences of places.
fn alike(a: f64, b: f64) -> starlark::Result<()> {
    if is_same_weight(a, b) {
        return Ok(());
    }
    Err(refuse("it takes a place for a difference of places"))
}

#[starlark_module]
fn operators(builder: &mut GlobalsBuilder) {
    /// The curves moved so that the point `source` comes to `target`.
    ///
    /// Fails on what are no points.
    ///
    /// Example: `placed = match_point(leaf, bbox_center(leaf), centroid(face))`
    fn match_point<'v>(
        #[starlark(require = pos)] curves: Value<'v>,
        #[starlark(require = pos)] source: Value<'v>,
        #[starlark(require = pos)] target: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let operator = "match_point";
        let curves = weighted_curves(curves, operator)?;
        let (source, target) = (point(source, operator)?, point(target, operator)?);
        let weight = curves.weight + target.weight - source.weight;
        curves_value(
            similarity::match_point(&curves.curves, source.at, target.at),
            weight,
            eval,
        )
    }

    /// The curves turned, scaled alike in all directions and moved so that two points come to two others.
    ///
    /// Gives nothing where the points of a pair are one.
    ///
    /// Example: `tab = match_points(knob, point_labeled(knob, 'start'), point_labeled(knob, 'end'), location(source_vertex(edge)), location(target_vertex(edge)))`
    fn match_points<'v>(
        #[starlark(require = pos)] curves: Value<'v>,
        #[starlark(require = pos)] source_1: Value<'v>,
        #[starlark(require = pos)] source_2: Value<'v>,
        #[starlark(require = pos)] target_1: Value<'v>,
        #[starlark(require = pos)] target_2: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let operator = "match_points";
        let curves = weighted_curves(curves, operator)?;
        let source = [point(source_1, operator)?, point(source_2, operator)?];
        let target = [point(target_1, operator)?, point(target_2, operator)?];
        for own in source {
            alike(curves.weight, own.weight)?;
        }
        alike(target[0].weight, target[1].weight)?;
        let image =
            similarity::match_points(&curves.curves, source.map(|p| p.at), target.map(|p| p.at));
        curves_value(image, target[0].weight, eval)
    }

    /// The curves scaled and moved so that the circle around them becomes the circle about the centroid of the face that reaches its outline.
    ///
    /// Fails on what is no face.
    ///
    /// Example: `placed = match_face(leaf, face)`
    fn match_face<'v>(
        #[starlark(require = pos)] curves: Value<'v>,
        #[starlark(require = pos)] face: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let curves = self::curves(curves, "match_face")?;
        let Area::Face(cell, face) = area(face, "match_face")? else {
            return Err(refuse(
                "`match_face` takes a face, not a region of several pieces",
            ));
        };
        curves_value(
            session(eval).with_map(cell, |map| similarity::match_face(curves, map, face))?,
            weight(eval),
            eval,
        )
    }

    /// The curves scaled by a factor about the middle of their box.
    ///
    /// Fails on a factor that is not finite.
    ///
    /// Example: `small = scale(contour(face), 0.8)`
    fn scale<'v>(
        #[starlark(require = pos)] curves: Value<'v>,
        #[starlark(require = pos)] factor: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let of = weighted_curves(curves, "scale")?;
        let image = similarity::scale(&of.curves, number(factor, "scale")?);
        curves_value(image, of.weight, eval)
    }

    /// The curves turned by `angle` (radians, from +x toward +y) about the middle of their box.
    ///
    /// Fails on an angle that is not finite.
    ///
    /// Example: `turned = rotate(leaf, pi / 3)`
    fn rotate<'v>(
        #[starlark(require = pos)] curves: Value<'v>,
        #[starlark(require = pos)] angle: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let of = weighted_curves(curves, "rotate")?;
        let image = similarity::rotate(&of.curves, number(angle, "rotate")?);
        curves_value(image, of.weight, eval)
    }

    /// The curves moved by a vector, which is a point.
    ///
    /// Fails on what is no point.
    ///
    /// Example: `moved = translate(leaf, point(6, 15))`
    fn translate<'v>(
        #[starlark(require = pos)] curves: Value<'v>,
        #[starlark(require = pos)] by: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let of = weighted_curves(curves, "translate")?;
        let by = point(by, "translate")?;
        let image = similarity::translate(&of.curves, by.at);
        curves_value(image, of.weight + by.weight, eval)
    }
}

/// How far polylines may be from the curves of a drawing.
fn tolerance_of(value: Value<'_>) -> starlark::Result<f64> {
    match number(value, "import_svg")? {
        tolerance if tolerance > 0.0 => Ok(tolerance),
        tolerance => Err(refuse(format!(
            "`import_svg` takes a positive tolerance, not {tolerance}"
        ))),
    }
}

#[starlark_module]
fn files(builder: &mut GlobalsBuilder) {
    /// The curves of a drawing, by its path from the script. They become polylines that are no farther from them than `tolerance`;
    /// without it than a thousandth of the drawing's longer side, and than 0.01 mm of the object, or of the paper of a map with a scale.
    ///
    /// Fails where the file cannot be read, and for a tolerance that is not positive.
    ///
    /// Example: `leaf = import_svg('leaf.svg')`
    fn import_svg<'v>(
        #[starlark(require = pos)] path: Value<'v>,
        #[starlark(require = named)] tolerance: Option<Value<'v>>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let path = text(path, "import_svg", "the path of a file")?;
        let tolerance = tolerance.map(tolerance_of).transpose()?;
        let curves = import(path, tolerance, eval)?;
        Ok(eval.heap().alloc(CurvesValue::fixed(curves)))
    }

    /// Gives the arrangement back: artifacts of a spec write files. It is there for scripts that were written for other programs.
    ///
    /// Never fails.
    ///
    /// Example: `export_svg(cells)`
    fn export_svg<'v>(
        #[starlark(require = pos)] arrangement: Value<'v>,
        #[starlark(require = pos)] size: Option<Value<'v>>,
    ) -> starlark::Result<Value<'v>> {
        // Files are written by artifacts of a spec; here the arrangement passes through.
        let _ = size;
        Ok(arrangement)
    }
}
