//! Curves: circles, arcs, polylines, splines and drawn paths, moved to their places.

use std::sync::Arc;

use super::exemplar::{Tolerance, magnification, read};
use super::placement::space_place;
use fretwork_action::{Action, Data, StageResult};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Point3, SpaceCurve, SpaceCurveError, surface_curve};
use fretwork_language::kinds::curves::{Curve, OnSurface, Spline, SvgCurve, Twist};
use fretwork_language::placement::SpacePlace;
use fretwork_language::value::SpacePoint;

/// How far the polyline of a drawn curve may be from it, as a part of the drawing's longer side.
const ROUNDNESS: f64 = 1e-5;

/// A curve, and warnings about its drawing.
type Drawn = Result<(SpaceCurve, Vec<Diagnostic>), Vec<Diagnostic>>;

/// Makes a curve of any kind.
pub fn curve(action: &Action, kind: &Curve) -> StageResult {
    let made = |curve: Result<SpaceCurve, SpaceCurveError>| {
        curve
            .map(|c| (c, Vec::new()))
            .map_err(|e| vec![failed(action, e.to_string())])
    };
    let (curve, warnings) = match kind {
        Curve::Circle(circle) => {
            made(SpaceCurve::circle(circle.radius.0)).and_then(placed(action, &circle.placement))
        }
        Curve::Arc(arc) => made(SpaceCurve::arc(arc.radius.0, arc.from.0, arc.to.0))
            .and_then(placed(action, &arc.placement)),
        Curve::Svg(svg) => drawn(action, svg).and_then(placed(action, &svg.placement)),
        Curve::Polyline(line) => made(SpaceCurve::new(points(&line.points), line.closed)),
        Curve::Spline(spline) => self::spline(action, spline).map(|c| (c, Vec::new())),
        Curve::OnSurface(kind) => self::on_surface(action, kind),
    }?;
    Ok((Data::Curve(Arc::new(curve)), warnings))
}

/// Points farther than this part of the surface's longest side from it are refused, or warned of.
const FAR: [f64; 2] = [0.25, 0.05];

fn on_surface(action: &Action, kind: &OnSurface) -> Drawn {
    let mesh = action.input(&kind.surface);
    let points = points(&kind.points);
    let found = surface_curve(&mesh, &points, kind.closed)
        .map_err(|e| vec![failed(action, e.to_string())])?;
    let farthest = (0..points.len()).max_by(|&a, &b| found.moved[a].total_cmp(&found.moved[b]));
    let side = mesh.bounds().longest_side();
    let told = farthest
        .map(|i| (i, found.moved[i]))
        .filter(|(_, moved)| *moved > FAR[1] * side);
    let Some((i, moved)) = told else {
        return Ok((found.curve, Vec::new()));
    };
    let Point3 { x, y, z } = points[i];
    let message = format!("the point ({x}, {y}, {z}) is {moved:.3} from the surface");
    if moved > FAR[0] * side {
        return Err(vec![
            failed(action, message).help("give points on the surface, or near to it"),
        ]);
    }
    let warning = Diagnostic::warning(message).at(action.span(), "in this curve");
    Ok((
        found.curve,
        vec![warning.help("the nearest point of the surface is used")],
    ))
}

fn points(points: &[SpacePoint]) -> Vec<Point3> {
    points.iter().map(|p| Point3::from(p.0)).collect()
}

fn spline(action: &Action, kind: &Spline) -> Result<SpaceCurve, Vec<Diagnostic>> {
    let curve = SpaceCurve::spline(&points(&kind.points), kind.closed);
    let curve = curve.map_err(|e| vec![failed(action, e.to_string())])?;
    let mut twist: Vec<(f64, f64)> = kind
        .twist
        .iter()
        .map(|Twist { at, angle }| (at.0, angle.0))
        .collect();
    if twist.is_empty() {
        return Ok(curve);
    }
    twist.sort_by(|a, b| a.0.total_cmp(&b.0));
    let turns = (twist[twist.len() - 1].1 - twist[0].1) / std::f64::consts::TAU;
    if kind.closed && (turns - libm::round(turns)).abs() > 1e-9 {
        let message = "the twist of a closed curve must come back to where it began";
        return Err(vec![failed(action, message).help(
            "let the last angle differ from the first by whole turns of 360 degrees",
        )]);
    }
    Ok(curve.twisted(twist))
}

/// The one path of a drawing, or of an element of it, in world space.
fn drawn(action: &Action, kind: &SvgCurve) -> Drawn {
    let [x, y, _] = kind.placement.scale.0;
    let tolerance = kind.tolerance.as_ref().map_or(
        Tolerance::Default {
            part: ROUNDNESS,
            magnified: magnification([x, y]),
        },
        |t| Tolerance::Length(t.0),
    );
    let (drawing, warnings) = read(action, &kind.file, kind.id.as_ref(), tolerance)?;
    let mut paths = drawing
        .shapes
        .iter()
        .flat_map(|shape| (0..shape.paths.len()).map(move |i| (shape, i)));
    let paths: Vec<_> = paths
        .by_ref()
        .filter(|(shape, i)| shape.paths[*i].len() > 1)
        .collect();
    let [(shape, i)] = paths[..] else {
        let names: Vec<String> = drawing
            .shapes
            .iter()
            .flat_map(|s| s.label.names().to_vec())
            .map(|n| format!("`{n}`"))
            .collect();
        let error = failed(
            action,
            format!(
                "a curve is one path, and `{}` has {} here",
                kind.file.0,
                paths.len()
            ),
        );
        let help = if names.is_empty() {
            "give the path an id".to_string()
        } else {
            format!("`id` chooses one of {}", names.join(", "))
        };
        return Err(vec![error.help(help)]);
    };
    // The drawing plane's y points down, the world's up.
    let line = shape.paths[i].iter().map(|p| Point3::new(p.x, -p.y, 0.0));
    let curve = SpaceCurve::new(line, shape.is_closed(i))
        .map_err(|e| vec![failed(action, e.to_string())])?;
    Ok((curve, warnings))
}

/// Moves a curve to its place.
fn placed<'a>(
    action: &'a Action,
    placement: &'a SpacePlace,
) -> impl FnOnce((SpaceCurve, Vec<Diagnostic>)) -> Drawn + 'a {
    move |(curve, warnings)| {
        let map = space_place(placement);
        let moved = curve
            .mapped(|p| map.apply(p))
            .map_err(|e| vec![failed(action, e.to_string())])?;
        Ok((moved, warnings))
    }
}

fn failed(action: &Action, message: impl Into<String>) -> Diagnostic {
    Diagnostic::error(message).at(action.span(), "in this curve")
}
