//! Room for the beam: outlines of parts moved outward by half of its width, those of openings
//! inward, so that what is left has the size that was drawn.
//!
//! What is a part and what is an opening follows from how deep an outline lies in all others that
//! are cut, whatever part of the spec each came from: an outline in none is that of a part, one in
//! a part is that of an opening, one in an opening is that of a part again.

use rayon::prelude::*;

use super::arc_fit;
use super::fixed_point::{self, Cell};
use super::layer::{Item, Layer, Sheet};
use super::lines::{is_closed, rings};
use super::nesting::Nesting;
use super::style::Role;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::STEPS_PER_MM;
use fretwork_geometry::drawing::Join;
use fretwork_geometry::polygon::{AreaError, fill, offset, signed_area};
use fretwork_geometry::{Bounds, FillRule, Point, Polygon, Ring};

/// How far a corner may reach, in half widths of the beam, before it is cut off. Corners down to 29
/// degrees stay sharp; a higher limit lets needles cut far into the waste.
const MITER_LIMIT: f64 = 4.0;
/// How exact round corners are, in millimetres.
const TOLERANCE_MM: f64 = 1e-3;
/// The step of the polygon kernel's grid as a share of the extent is 2^-28 at most; sums of areas
/// may differ by this share of the extent for each length of outline.
const AREA_STEP: f64 = 4e-9;

/// The sheet with its cut layers compensated for a beam that is `kerf_mm` wide; other layers stay
/// as they are. Warns where outlines cross, where an opening is too narrow for the beam, and where
/// parts are too near to one another.
///
/// # Errors
/// An open line on a cut layer (it has no side to move to), a width that is not a number of zero or
/// more, coordinates out of range.
pub fn compensate(sheet: &Sheet, kerf_mm: f64) -> Result<(Sheet, Vec<Diagnostic>), Diagnostic> {
    if !(kerf_mm.is_finite() && kerf_mm >= 0.0) {
        return Err(Diagnostic::error(format!(
            "the kerf cannot be {kerf_mm} mm"
        )));
    }
    if kerf_mm == 0.0 {
        return Ok((sheet.clone(), Vec::new()));
    }
    let outlines = outlines(sheet)?;
    let nesting = Nesting::new(outlines.iter().map(|outline| &outline.cells[..]));
    let around = |outline: &Outline| nesting.around(&outline.cells).len().is_multiple_of(2);
    let is_part: Vec<bool> = outlines.par_iter().map(around).collect();
    let beam = Beam {
        half: 0.5 * kerf_mm / sheet.unit_mm,
        unit_mm: sheet.unit_mm,
    };
    let moved: Vec<Vec<Ring>> = outlines
        .par_iter()
        .zip(&is_part)
        .map(|(outline, is_part)| beam.moved(&outline.ring, *is_part))
        .collect::<Result<_, _>>()
        .map_err(|e| unusable(&e))?;
    let found = Found {
        outlines: &outlines,
        nesting: &nesting,
        is_part: &is_part,
        moved: &moved,
    };
    let warnings = found.warnings(sheet, kerf_mm)?;
    Ok((with_outlines(sheet, &outlines, &moved)?, warnings))
}

fn unusable(error: &AreaError) -> Diagnostic {
    Diagnostic::error(format!("what is cut cannot be compensated: {error}"))
}

/// One closed line that is cut.
struct Outline {
    layer: usize,
    item: usize,
    /// Without the first point at its end.
    ring: Ring,
    /// As the file has it, the first point at its end too.
    cells: Vec<Cell>,
}

/// The outlines of all cut layers. A line that crosses itself is that of the area that it encloses
/// by the even-odd rule.
fn outlines(sheet: &Sheet) -> Result<Vec<Outline>, Diagnostic> {
    let mut outlines = Vec::new();
    let layers = sheet.layers.iter().enumerate();
    for (number, layer) in layers.filter(|(_, layer)| layer.role == Role::Cut) {
        for (item, what) in layer.items.iter().enumerate() {
            let areas = match what {
                Item::Area(polygon) => vec![polygon.clone()],
                Item::Line(points) if is_closed(points) => {
                    fill(std::slice::from_ref(points), FillRule::EvenOdd)
                        .map_err(|e| unusable(&e))?
                }
                Item::Line(_) => return Err(open_line(layer)),
            };
            let of_item = areas.iter().flat_map(rings).map(|line| Outline {
                layer: number,
                item,
                cells: fixed_point::cells(&line, sheet.unit_mm),
                ring: line[..line.len() - 1].to_vec(),
            });
            outlines.extend(of_item.filter(|outline| outline.cells.len() > 3));
        }
    }
    Ok(outlines)
}

fn open_line(layer: &Layer) -> Diagnostic {
    let message = format!(
        "the layer `{}` has an open line, which has no side to leave the kerf on",
        layer.name
    );
    Diagnostic::error(message).help("set `kerf: 0`, close the line, or give it another role")
}

/// Half the width of the beam, in units of `unit_mm` millimetres.
struct Beam {
    half: f64,
    unit_mm: f64,
}

impl Beam {
    /// The outline moved into the waste: outward around a part, inward in an opening.
    fn moved(&self, ring: &Ring, is_part: bool) -> Result<Vec<Ring>, AreaError> {
        let distance = if is_part { self.half } else { -self.half };
        if let Some(circle) = self.moved_circle(ring, distance) {
            return Ok(circle);
        }
        let mut outer = ring.clone();
        if signed_area(&outer) < 0.0 {
            outer.reverse();
        }
        let polygon = Polygon {
            outer,
            holes: Vec::new(),
        };
        let moved = offset(
            &[polygon],
            distance,
            Join::Miter(MITER_LIMIT),
            TOLERANCE_MM / self.unit_mm,
        )?;
        Ok(moved.iter().flat_map(Polygon::rings).cloned().collect())
    }

    /// A circle with another radius, where the outline is one: moved like a polygon it would be too
    /// large by what its corners are farther out than its sides.
    fn moved_circle(&self, ring: &Ring, distance: f64) -> Option<Vec<Ring>> {
        let steps = STEPS_PER_MM * self.unit_mm;
        let scaled: Vec<Point> = ring.iter().map(|p| *p * steps).collect();
        let (center, radius) = arc_fit::circle_through(&scaled)?;
        let moved = radius + distance * steps;
        if moved <= 0.0 {
            return Some(Vec::new());
        }
        let at =
            |p: &Point| (center + (*p - center) * (moved / p.distance(center))) * (1.0 / steps);
        let mut ring: Ring = scaled.iter().map(at).collect();
        if signed_area(&ring) < 0.0 {
            ring.reverse();
        }
        Some(vec![ring])
    }
}

/// The sheet with the moved outlines in the places of those that they came from.
fn with_outlines(
    sheet: &Sheet,
    outlines: &[Outline],
    moved: &[Vec<Ring>],
) -> Result<Sheet, Diagnostic> {
    let mut layers = sheet.layers.clone();
    for layer in layers.iter_mut().filter(|layer| layer.role == Role::Cut) {
        layer.items.clear();
    }
    let of_items = outlines.chunk_by(|a, b| (a.layer, a.item) == (b.layer, b.item));
    let mut next = 0;
    for of_item in of_items {
        let rings: Vec<Ring> = moved[next..next + of_item.len()].concat();
        next += of_item.len();
        let layer = &mut layers[of_item[0].layer];
        if layer.style.fill.is_some() {
            let areas = fill(&rings, FillRule::EvenOdd).map_err(|e| unusable(&e))?;
            layer.items.extend(areas.into_iter().map(Item::Area));
        } else {
            let closed = rings.into_iter().map(|mut ring| {
                ring.extend(ring.first().copied());
                Item::Line(ring)
            });
            layer.items.extend(closed);
        }
    }
    Ok(sheet.with(layers))
}

/// What was made of the outlines.
struct Found<'a> {
    outlines: &'a [Outline],
    nesting: &'a Nesting,
    is_part: &'a [bool],
    moved: &'a [Vec<Ring>],
}

impl Found<'_> {
    fn warnings(&self, sheet: &Sheet, kerf_mm: f64) -> Result<Vec<Diagnostic>, Diagnostic> {
        let mut warnings = Vec::new();
        let lost = self.moved.iter().filter(|rings| rings.is_empty()).count();
        if lost > 0 {
            let layers = self.outlines.iter().zip(self.moved);
            let first = layers
                .filter(|(_, rings)| rings.is_empty())
                .map(|(o, _)| o.layer);
            let name = first.min().map_or("", |layer| &sheet.layers[layer].name);
            let holes = if lost == 1 {
                "a hole is narrower than the kerf".to_owned()
            } else {
                format!("{lost} holes are narrower than the kerf")
            };
            let end = if lost == 1 {
                "is not cut"
            } else {
                "are not cut"
            };
            warnings.push(Diagnostic::warning(format!(
                "in the layer `{name}` {holes} of {kerf_mm} mm and {end}"
            )));
        }
        let numbers = (0..self.outlines.len()).filter(|i| !self.nesting.is_repeated(*i as u32));
        let drawn = numbers
            .clone()
            .map(|i| (&self.outlines[i].ring, self.is_part[i]));
        let is_nested = |rings: Vec<(&Ring, bool)>| is_nested(&rings).map_err(|e| unusable(&e));
        if !is_nested(drawn.collect())? {
            warnings.push(self.crossing(sheet));
            return Ok(warnings);
        }
        let beams = numbers.flat_map(|i| self.moved[i].iter().map(move |ring| (ring, i)));
        // A part that closes in on itself has openings: their sense shows what they are.
        let beams = beams.map(|(ring, i)| (ring, self.is_part[i] == (signed_area(ring) > 0.0)));
        if !is_nested(beams.collect())? {
            warnings.push(Diagnostic::warning(format!(
                "parts are nearer to one another than the kerf of {kerf_mm} mm"
            )));
        }
        Ok(warnings)
    }

    fn crossing(&self, sheet: &Sheet) -> Diagnostic {
        let name = |outline: u32| &sheet.layers[self.outlines[outline as usize].layer].name;
        let which = match self.nesting.crossing() {
            Some((a, b, cell)) => {
                let (a, b) = (a.min(b), a.max(b));
                let p = fixed_point::point(cell, sheet.unit_mm);
                let place = format!("near ({:.3}, {:.3})", p.x, p.y);
                if name(a) == name(b) {
                    format!("outlines of `{}` cross {place}", name(a))
                } else {
                    format!(
                        "the outlines of `{}` and `{}` cross {place}",
                        name(a),
                        name(b)
                    )
                }
            }
            None => "outlines that are cut overlap".to_owned(),
        };
        let message = format!("{which}: on which side of them to leave the kerf cannot be told");
        Diagnostic::warning(message).help("unite what overlaps in one region, or move it apart")
    }
}

/// Whether outlines, each with whether it is that of a part, lie in one another without crossing:
/// then the area that they enclose by the even-odd rule is that of the parts less that of the
/// openings.
fn is_nested(outlines: &[(&Ring, bool)]) -> Result<bool, AreaError> {
    let rings: Vec<Ring> = outlines.iter().map(|(ring, _)| (*ring).clone()).collect();
    let enclosed: f64 = fill(&rings, FillRule::EvenOdd)?
        .iter()
        .map(Polygon::area)
        .sum();
    let signed = |(ring, is_part): &(&Ring, bool)| {
        let area = signed_area(ring).abs();
        if *is_part { area } else { -area }
    };
    let expected: f64 = outlines.iter().map(signed).sum();
    let length: f64 = rings
        .iter()
        .flat_map(|ring| ring.windows(2))
        .map(|w| w[0].distance(w[1]))
        .sum();
    let extent = Bounds::of(rings.iter().flatten().copied()).longer_side();
    Ok((enclosed - expected).abs() <= AREA_STEP * extent * length)
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
        let rings: Vec<Ring> = sheet.layers[0]
            .items
            .iter()
            .map(|item| item.points().collect())
            .collect();
        let areas = fill(&rings, FillRule::EvenOdd).unwrap();
        areas.iter().map(Polygon::area).sum()
    }

    /// A sheet with a layer for each ring, all cut.
    fn parts(rings: &[Ring]) -> Sheet {
        let mut all = sheet(Role::Cut, vec![]);
        let one = all.layers.remove(0);
        for (i, ring) in rings.iter().enumerate() {
            all.layers.push(Layer {
                name: format!("part {i}").into(),
                items: vec![Item::Area(Polygon {
                    outer: ring.clone(),
                    holes: vec![],
                })],
                ..one.clone()
            });
        }
        all
    }

    fn widths(sheet: &Sheet) -> Vec<f64> {
        let width = |layer: &Layer| (layer.bounds().width() * 1e6).round() / 1e6;
        sheet.layers.iter().map(width).collect()
    }

    #[test]
    fn openings_that_are_parts_of_their_own_shrink() {
        // A window in a plate, an island in the window, a part beside them; named in any order.
        let rings = [
            square(4.0, 6.0),
            square(0.0, 9.0),
            square(2.0, 8.0),
            square(20.0, 22.0),
        ];
        let (moved, warnings) = compensate(&parts(&rings), 2.0).unwrap();
        assert_eq!(warnings, []);
        assert_eq!(widths(&moved), [2.2, 9.2, 5.8, 2.2]);
        // What is engraved keeps its size and does not make an opening of what it surrounds.
        let mut engraved = parts(&rings[..2]);
        engraved.layers[1].role = Role::Engrave;
        let (moved, _) = compensate(&engraved, 2.0).unwrap();
        assert_eq!(widths(&moved), [2.2, 9.0]);
    }

    #[test]
    fn round_holes_have_their_radius_less_half_a_beam() {
        let circle = |radius: f64, count: usize| -> Ring {
            let angle = |i: usize| std::f64::consts::TAU * i as f64 / count as f64;
            let corner =
                |a: f64| Point::new(5.0 + radius * libm::cos(a), 5.0 + radius * libm::sin(a));
            (0..count).map(angle).map(corner).collect()
        };
        let (moved, _) = compensate(&parts(&[square(0.0, 10.0), circle(0.16, 32)]), 2.0).unwrap();
        let hole = moved.layers[1].items[0].points();
        for p in hole {
            assert!((p.distance(Point::new(5.0, 5.0)) - 0.06).abs() < 1e-9);
        }
        let (_, warnings) =
            compensate(&parts(&[square(0.0, 10.0), circle(0.09, 32)]), 2.0).unwrap();
        assert!(
            warnings[0].message.contains("a hole is narrower"),
            "{warnings:?}"
        );
    }

    #[test]
    fn outlines_that_cross_are_told() {
        let told = |rings: &[Ring]| {
            let (_, warnings) = compensate(&parts(rings), 1.0).unwrap();
            warnings.into_iter().map(|d| d.message).collect::<Vec<_>>()
        };
        let crossing = told(&[square(0.0, 4.0), square(2.0, 6.0)]);
        assert!(
            crossing[0].contains("`part 0` and `part 1` cross near ("),
            "{crossing:?}"
        );
        // Sides that lie on one another cross nowhere, and yet the areas overlap.
        let beside = vec![[2.0, 0.0], [6.0, 0.0], [6.0, 4.0], [2.0, 4.0]];
        let overlap = told(&[
            square(0.0, 4.0),
            beside.into_iter().map(Point::from).collect(),
        ]);
        assert!(overlap[0].contains("overlap"), "{overlap:?}");
        let touching = told(&[square(0.0, 4.0), square(4.0, 6.0)]);
        assert!(touching[0].contains("nearer"), "{touching:?}");
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
            narrow[0].message.contains("a hole is narrower"),
            "{narrow:?}"
        );
        let neighbour = Item::Area(Polygon {
            outer: square(10.1, 12.0),
            holes: vec![],
        });
        let (moved, near) =
            compensate(&sheet(Role::Cut, vec![frame(2.0), neighbour]), 2.0).unwrap();
        assert!(near[0].message.contains("nearer"), "{near:?}");
        assert_eq!(moved.layers[0].items.len(), 3);
    }
}
