//! Where cells are and what they are made of (tables 3.4 and 3.6, geometry).

use starlark::environment::GlobalsBuilder;
use starlark::eval::Evaluator;
use starlark::starlark_module;
use starlark::values::{Value, ValueLike};

use crate::cells;
use crate::script::operators::arguments::{
    Area, area, edge, kind, number, place_value, point_value, vertex, weighted_curves,
};
use crate::script::seeds::plain;
use fretwork_geometry::{Bounds, Curves, Point, Polygon};
use fretwork_script::session::{CurvesValue, curves_value, refuse, session};
use fretwork_script::values::{Cell, RegionValue, is_same_weight};
use fretwork_script::watch::weight;

pub(crate) fn register(builder: &mut GlobalsBuilder) {
    operators(builder);
    boxes(builder);
}

/// The centroid of what `polygons` cover.
fn centroid_of(polygons: &[Polygon]) -> Point {
    let origin = polygons
        .iter()
        .find_map(|p| p.outer.first().copied())
        .unwrap_or(Point::ORIGIN);
    let (mut area, mut moment) = (0.0, Point::ORIGIN);
    for ring in polygons.iter().flat_map(Polygon::rings) {
        for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            let (a, b) = (*a - origin, *b - origin);
            let cross = a.cross(b) / 2.0;
            area += cross;
            moment = moment + (a + b) * (cross / 3.0);
        }
    }
    if area == 0.0 {
        origin
    } else {
        origin + moment * (1.0 / area)
    }
}

/// The centroid of a face or region.
pub(crate) fn center_of(area: &Area, eval: &Evaluator<'_, '_, '_>) -> starlark::Result<Point> {
    match area {
        Area::Face(cell, face) => session(eval).with_map(*cell, |map| map.centroid(*face)),
        Area::Region(region) => Ok(centroid_of(&region.area)),
    }
}

/// The contour of a face or region.
pub(crate) fn contour_of(area: &Area, eval: &Evaluator<'_, '_, '_>) -> starlark::Result<Curves> {
    match area {
        Area::Face(cell, face) => {
            session(eval).know_around(*cell)?;
            session(eval).with_map(*cell, |map| cells::contour(map, *face))
        }
        Area::Region(region) => Ok(region.contour.clone()),
    }
}

/// The weight of curves put one after another.
fn appended_weight(a: &CurvesValue, b: &CurvesValue) -> starlark::Result<f64> {
    if a.is_nothing() {
        return Ok(b.weight);
    }
    if b.is_nothing() || is_same_weight(a.weight, b.weight) {
        return Ok(a.weight);
    }
    Err(refuse(
        "it puts curves that lie somewhere beside curves that go with the cell",
    ))
}

#[starlark_module]
fn operators(builder: &mut GlobalsBuilder) {
    /// The point (x, y), in the spec's unit, y downward as in drawings.
    ///
    /// Fails on numbers that are not finite.
    ///
    /// Example: `p = point(10, 20)`
    fn point<'v>(
        #[starlark(require = pos)] x: Value<'v>,
        #[starlark(require = pos)] y: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let at = Point::new(number(x, "point")?, number(y, "point")?);
        Ok(point_value(at, 0.0, eval))
    }

    /// Where a vertex is.
    ///
    /// Fails on what is no vertex.
    ///
    /// Example: `p = location(vertex)`
    fn location<'v>(
        #[starlark(require = pos)] vertex: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let (cell, id) = self::vertex(vertex, "location")?;
        Ok(place_value(
            session(eval).with_map(cell, |map| map.location(id))?,
            eval,
        ))
    }

    /// The point at the part `s`, from 0 to 1, of the length of an edge.
    ///
    /// Fails on what is no edge.
    ///
    /// Example: `middle = location_at(edge, 0.5)`
    fn location_at<'v>(
        #[starlark(require = pos)] edge: Value<'v>,
        #[starlark(require = pos)] s: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let (cell, id) = self::edge(edge, "location_at")?;
        let s = number(s, "location_at")?;
        Ok(place_value(
            session(eval).with_map(cell, |map| cells::location_at(map, id, s))?,
            eval,
        ))
    }

    /// The centroid of the area of a face.
    ///
    /// Fails on the unbounded face.
    ///
    /// Example: `p = centroid(face)`
    fn centroid<'v>(
        #[starlark(require = pos)] face: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let face = area(face, "centroid")?;
        Ok(place_value(center_of(&face, eval)?, eval))
    }

    /// The outline of a face, with the face on its left, as curves.
    ///
    /// Fails on what is no face.
    ///
    /// Example: `outline = contour(face)`
    fn contour<'v>(
        #[starlark(require = pos)] face: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let face = area(face, "contour")?;
        curves_value(contour_of(&face, eval)?, weight(eval), eval)
    }

    /// An edge as curves, with all its labels.
    ///
    /// Fails on what is no edge.
    ///
    /// Example: `line = to_curve(edge)`
    fn to_curve<'v>(
        #[starlark(require = pos)] edge: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let (cell, id) = self::edge(edge, "to_curve")?;
        curves_value(
            session(eval).with_map(cell, |map| cells::to_curve(map, id))?,
            weight(eval),
            eval,
        )
    }

    /// The curves of both, those of the first first.
    ///
    /// Fails on what are no curves.
    ///
    /// Example: `both = append(contour(face), leaf)`
    fn append<'v>(
        #[starlark(require = pos)] first: Value<'v>,
        #[starlark(require = pos)] second: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let operator = "append";
        let (a, b) = (
            weighted_curves(first, operator)?,
            weighted_curves(second, operator)?,
        );
        let weight = appended_weight(a, b)?;
        let (a, b) = (&a.curves, &b.curves);
        session(eval).draw_points(a.points().len() + b.points().len())?;
        let mut all = Curves::clone(a);
        all.append(b);
        curves_value(all, weight, eval)
    }

    /// No curves.
    ///
    /// Never fails.
    ///
    /// Example: `empty = nothing()`
    fn nothing<'v>(eval: &mut Evaluator<'v, '_, '_>) -> starlark::Result<Value<'v>> {
        curves_value(Curves::new(), 0.0, eval)
    }
}

/// The box of a cell, a region, or curves.
fn bounds(
    value: Value<'_>,
    operator: &str,
    eval: &Evaluator<'_, '_, '_>,
) -> starlark::Result<Bounds> {
    if let Some(curves) = value.downcast_ref::<CurvesValue>() {
        return Ok(curves.curves.bounds());
    }
    if let Some(region) = value.downcast_ref::<RegionValue>() {
        return Ok(region.0.bounds());
    }
    match value.downcast_ref::<Cell>() {
        Some(cell) => session(eval).with_map(*cell, |map| plain(*cell).bounds(map)),
        None => Err(refuse(format!(
            "`{operator}` takes a cell or curves, not {}",
            kind(value)
        ))),
    }
}

#[starlark_module]
fn boxes(builder: &mut GlobalsBuilder) {
    /// The width of the box around curves or a cell, in the spec's unit.
    ///
    /// Fails where there is nothing.
    ///
    /// Example: `w = bbox_width(leaf)`
    fn bbox_width<'v>(
        #[starlark(require = pos)] of: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<f64> {
        Ok(bounds(of, "bbox_width", eval)?.width())
    }

    /// The height of the box around curves or a cell, in the spec's unit.
    ///
    /// Fails where there is nothing.
    ///
    /// Example: `h = bbox_height(leaf)`
    fn bbox_height<'v>(
        #[starlark(require = pos)] of: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<f64> {
        Ok(bounds(of, "bbox_height", eval)?.height())
    }

    /// The middle of the box around curves or a cell.
    ///
    /// Fails where there is nothing.
    ///
    /// Example: `p = bbox_center(leaf)`
    fn bbox_center<'v>(
        #[starlark(require = pos)] of: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let bounds = bounds(of, "bbox_center", eval)?;
        if bounds.is_empty() {
            return Err(refuse("`bbox_center`: no curves have no centre"));
        }
        let own = of.downcast_ref::<CurvesValue>().map(|curves| curves.weight);
        let weight = own.unwrap_or_else(|| weight(eval));
        Ok(point_value(bounds.center(), weight, eval))
    }
}
