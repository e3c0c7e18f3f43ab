//! Room for the beam: outlines moved outward by half of its width, holes inward, so that what is
//! left has the size that was drawn.

use super::layer::{Item, Layer, Sheet};
use super::lines::is_closed;
use super::style::Role;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::drawing::Join;
use fretwork_geometry::polygon::{fill, offset, unite};
use fretwork_geometry::{FillRule, Polygon, Ring};

/// How far a corner may reach, in half widths of the beam, before it is cut off.
const MITER_LIMIT: f64 = 4.0;
/// How exact round corners are, in millimetres.
const TOLERANCE_MM: f64 = 1e-3;

/// The sheet with its cut layers compensated for a beam that is `kerf_mm` wide; other layers stay
/// as they are. The closed lines of a layer together enclose an area by the even-odd rule. Warns
/// where a hole is too narrow for the beam, and where parts are too near to one another.
///
/// Errors: an open line on a cut layer (it has no side to move to), a width that is not a number
/// of zero or more, coordinates out of range.
pub fn compensate(sheet: &Sheet, kerf_mm: f64) -> Result<(Sheet, Vec<Diagnostic>), Diagnostic> {
    if !(kerf_mm.is_finite() && kerf_mm >= 0.0) {
        return Err(Diagnostic::error(format!(
            "the kerf cannot be {kerf_mm} mm"
        )));
    }
    if kerf_mm == 0.0 {
        return Ok((sheet.clone(), Vec::new()));
    }
    let mut warnings = Vec::new();
    let mut layers = Vec::with_capacity(sheet.layers.len());
    for layer in &sheet.layers {
        layers.push(match layer.role {
            Role::Cut => compensate_layer(layer, kerf_mm, sheet.unit_mm, &mut warnings)?,
            _ => layer.clone(),
        });
    }
    Ok((
        Sheet {
            layers,
            ..sheet.clone()
        },
        warnings,
    ))
}

fn compensate_layer(
    layer: &Layer,
    kerf_mm: f64,
    unit_mm: f64,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Layer, Diagnostic> {
    let unusable = |e| {
        Diagnostic::error(format!(
            "the layer `{}` cannot be compensated: {e}",
            layer.name
        ))
    };
    let mut parts: Vec<Polygon> = Vec::new();
    let mut rings: Vec<Ring> = Vec::new();
    for item in &layer.items {
        match item {
            Item::Area(polygon) => parts.push(polygon.clone()),
            Item::Line(points) if is_closed(points) => rings.push(points.clone()),
            Item::Line(_) => {
                let message = format!(
                    "the layer `{}` has an open line, which has no side to leave the kerf on",
                    layer.name
                );
                return Err(Diagnostic::error(message)
                    .help("set `kerf: 0`, close the line, or give it another role"));
            }
        }
    }
    parts.extend(fill(&rings, FillRule::EvenOdd).map_err(unusable)?);
    let (distance, tolerance) = (0.5 * kerf_mm / unit_mm, TOLERANCE_MM / unit_mm);
    let mut moved: Vec<Polygon> = Vec::new();
    let mut lost = 0;
    for part in &parts {
        let grown = offset(
            std::slice::from_ref(part),
            distance,
            Join::Miter(MITER_LIMIT),
            tolerance,
        )
        .map_err(unusable)?;
        let holes: usize = grown.iter().map(|p| p.holes.len()).sum();
        lost += part.holes.len().saturating_sub(holes);
        moved.extend(grown);
    }
    let mut warn = |what: String| {
        warnings.push(Diagnostic::warning(format!(
            "in the layer `{}` {what}",
            layer.name
        )))
    };
    if lost > 0 {
        warn(format!(
            "{lost} holes are narrower than the kerf of {kerf_mm} mm and are not cut"
        ));
    }
    let area = |polygons: &[Polygon]| polygons.iter().map(Polygon::area).sum::<f64>();
    let apart = area(&unite(&moved).map_err(unusable)?);
    if area(&moved) - apart > 1e-6 * apart {
        warn(format!(
            "parts are nearer to one another than the kerf of {kerf_mm} mm"
        ));
    }
    Ok(Layer {
        items: moved.into_iter().map(Item::Area).collect(),
        ..layer.clone()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Style;
    use fretwork_geometry::{Bounds, Point};

    fn square(a: f64, b: f64) -> Ring {
        vec![
            Point::new(a, a),
            Point::new(b, a),
            Point::new(b, b),
            Point::new(a, b),
        ]
    }

    fn sheet(role: Role, items: Vec<Item>) -> Sheet {
        let layers = vec![Layer {
            name: "plate".into(),
            role,
            style: Style::outline(0.1),
            items,
        }];
        Sheet {
            page: None,
            unit_mm: 10.0,
            layers,
        }
    }

    fn frame(hole: f64) -> Item {
        let mut inner = square(5.0 - hole / 2.0, 5.0 + hole / 2.0);
        inner.reverse();
        Item::Area(Polygon {
            outer: square(0.0, 10.0),
            holes: vec![inner],
        })
    }

    fn area(sheet: &Sheet) -> f64 {
        let areas = sheet.layers[0].items.iter().map(|item| match item {
            Item::Area(polygon) => polygon.area(),
            Item::Line(_) => panic!("cut layers hold areas"),
        });
        areas.sum()
    }

    #[test]
    fn outlines_move_outward_and_holes_inward() {
        let (moved, warnings) = compensate(&sheet(Role::Cut, vec![frame(2.0)]), 2.0).unwrap();
        assert_eq!(warnings, []);
        assert!((area(&moved) - (10.2 * 10.2 - 1.8 * 1.8)).abs() < 1e-6);
        let box_of = Bounds {
            min: Point::new(-0.1, -0.1),
            max: Point::new(10.1, 10.1),
        };
        let found = moved.layers[0].bounds();
        assert!(found.min.distance(box_of.min) < 1e-6 && found.max.distance(box_of.max) < 1e-6);
    }

    #[test]
    fn closed_lines_are_outlines_and_holes() {
        let closed = |ring: Ring| Item::Line(ring.iter().chain(ring.first()).copied().collect());
        let lines = vec![closed(square(4.0, 6.0)), closed(square(0.0, 10.0))];
        let (moved, _) = compensate(&sheet(Role::Cut, lines), 2.0).unwrap();
        assert!((area(&moved) - (10.2 * 10.2 - 1.8 * 1.8)).abs() < 1e-6);
    }

    #[test]
    fn open_lines_cannot_be_compensated() {
        let open = || vec![Item::Line(square(0.0, 1.0))];
        let error = compensate(&sheet(Role::Cut, open()), 0.1).unwrap_err();
        assert!(error.is_error() && error.message.contains("open line") && error.help.is_some());
        assert!(compensate(&sheet(Role::Cut, open()), 0.0).is_ok());
        let engraved = sheet(Role::Engrave, open());
        assert_eq!(compensate(&engraved, 0.1).unwrap().0, engraved);
        for bad in [-0.1, f64::NAN, f64::INFINITY] {
            assert!(compensate(&engraved, bad).is_err());
        }
    }

    #[test]
    fn what_gets_lost_or_touches_is_said() {
        let (_, narrow) = compensate(&sheet(Role::Cut, vec![frame(0.1)]), 2.0).unwrap();
        assert!(
            narrow[0].message.contains("1 holes are narrower"),
            "{narrow:?}"
        );
        let neighbour = Item::Area(Polygon {
            outer: square(10.1, 12.0),
            holes: vec![],
        });
        let (moved, near) =
            compensate(&sheet(Role::Cut, vec![frame(2.0), neighbour]), 2.0).unwrap();
        assert!(near[0].message.contains("nearer"), "{near:?}");
        assert_eq!(moved.layers[0].items.len(), 2);
    }
}
