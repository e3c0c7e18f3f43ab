//! Regions: shapes of the plane, placed and combined.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::exemplar::{Tolerance, magnification, read, upright};
use super::geodata;
use super::joined::{check_plane, loose_parts, touching_itself};
use super::placement::maps;
use super::text;
use super::tolerance::{default_tolerance, fine_on_object};
use fretwork_action::{Action, Data, ReadLog, StageResult};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::budget;
use fretwork_geometry::drawing::Join;
use fretwork_geometry::polygon::{AreaError, intersect, offset, subtract, unite};
use fretwork_geometry::{Affine, Point, Polygon, Region, Ring};
use fretwork_language::kinds::regions::{Circle, Inset, Rectangle, Region as Kind, Svg};
use fretwork_language::placement::PlanePlacement;
use fretwork_language::{Ref, wants};

/// How far the polygon of a disc or of a rounded corner may be from the circle, as a part of its
/// radius.
const ROUNDNESS: f64 = 1e-4;

/// Bytes for each point of copies that are united: a few of themselves, and those of the planar map.
const COPIED: usize = 500;

type Made = Result<(Region, Vec<Diagnostic>), Vec<Diagnostic>>;

/// Makes a region of any kind.
/// Files beside the one that a map names are noted in `log`.
pub fn region(action: &Action, kind: &Kind, log: &ReadLog) -> StageResult {
    let plain = |region| Ok((region, Vec::new()));
    let (region, warnings) = match kind {
        Kind::Rectangle(rectangle) => self::rectangle(action, rectangle).and_then(plain),
        Kind::Circle(circle) => disc(action, circle).and_then(plain),
        Kind::Svg(svg) => drawn(action, svg),
        Kind::Inset(inset) => self::inset(action, inset).map(|region| {
            let of = std::slice::from_ref(&inset.from);
            let warning = touching_itself(action, of, &region.area);
            (region, Vec::from_iter(warning))
        }),
        Kind::Union(of) => united(action, of),
        Kind::Intersection(of) => combined(action, of, intersect),
        Kind::Difference(of) => combined(action, of, subtract),
        Kind::Text(letters) => text::area(action, letters).and_then(|(area, warnings)| {
            let region = Region::of_area(area);
            Ok((
                placed(action, region, &letters.setting.placement)?,
                warnings,
            ))
        }),
        Kind::Geodata(kind) => geodata::region(action, kind, log).and_then(|(region, warnings)| {
            Ok((placed(action, region, &kind.placement)?, warnings))
        }),
        // Arrangements and solids are known where all rooms are.
        Kind::Faces(_) | Kind::Section(_) | Kind::Slices(_) => {
            unreachable!("regions that are made of values of other rooms have stages of their own")
        }
    }?;
    // Lines and points of a map, which enclose nothing, are of use together with others.
    let contour = &region.contour;
    let has_lines = !contour.is_empty() || !contour.lone().is_empty();
    let has_lines = matches!(kind, Kind::Geodata(_)) && has_lines;
    if region.area.is_empty() && !has_lines {
        return Err(vec![
            Diagnostic::error("the region is empty").at(action.span(), "has no area"),
        ]);
    }
    Ok((Data::Region(Arc::new(region)), warnings))
}

fn rectangle(action: &Action, kind: &Rectangle) -> Result<Region, Vec<Diagnostic>> {
    let size = Point::new(kind.width.0, kind.height.0);
    let mut region = placed(
        action,
        Region::rectangle(Point::ORIGIN, size),
        &kind.placement,
    )?;
    if kind.periodic {
        let corner = Point::new(kind.placement.at.0[0], kind.placement.at.0[1]);
        if region.contour != Region::rectangle(corner, corner + size).contour {
            let message = "a periodic rectangle can be moved but not turned, scaled or repeated";
            return Err(vec![Diagnostic::error(message).at(action.span(), "")]);
        }
        region.period = Some(size);
    }
    Ok(region)
}

fn disc(action: &Action, kind: &Circle) -> Result<Region, Vec<Diagnostic>> {
    let radius = kind.radius.0;
    let magnified = radius * magnification(kind.placement.scale.0);
    let roundness = default_tolerance(magnified, ROUNDNESS, fine(action)) / magnified;
    let corners = (TAU / 2.0 / libm::acos(1.0 - roundness)).ceil() as u32;
    let corner = |i: u32| Point::unit(TAU * f64::from(i) / f64::from(corners)) * radius;
    let outer: Ring = (0..corners).map(corner).collect();
    placed(
        action,
        Region::of_area(vec![Polygon {
            outer,
            holes: Vec::new(),
        }]),
        &kind.placement,
    )
}

fn drawn(action: &Action, kind: &Svg) -> Made {
    let (drawing, mut warnings) = read(
        action,
        &kind.file,
        kind.id.as_ref(),
        Tolerance::Default {
            part: 1e-4,
            magnified: magnification(kind.placement.scale.0),
        },
    )?;
    let drawing = upright(action, drawing);
    let enclosed = drawing.region().map_err(|e| vec![failed(action, &e)])?;
    if enclosed.loose > 0 {
        let message = match enclosed.loose {
            1 => "a line encloses nothing and is not in the region".to_string(),
            n => format!("{n} lines enclose nothing and are not in the region"),
        };
        let warning = Diagnostic::warning(message).at(action.span(), "in this region");
        warnings.push(
            warning.help(
                "strokes have no width here; close the lines, or convert the strokes to paths",
            ),
        );
    }
    if enclosed.nested > 0 {
        let message = match enclosed.nested {
            1 => "a ring lies inside of other lines and makes no hole".to_string(),
            n => format!("{n} rings lie inside of other lines and make no holes"),
        };
        let warning = Diagnostic::warning(message).at(action.span(), "in this region");
        warnings.push(warning.help(
            "for a hole, fill the outlines as one path, or take one region from the other: \
             `difference` of two `svg` regions with an `id` each",
        ));
    }
    Ok((placed(action, enclosed.region, &kind.placement)?, warnings))
}

fn inset(action: &Action, kind: &Inset) -> Result<Region, Vec<Diagnostic>> {
    let from = action.input(&kind.from);
    let by = kind.by.0;
    let radius = kind.corner_radius.0;
    let size = by.abs().max(radius).max(from.bounds().longer_side() * 1e-3);
    let tolerance = default_tolerance(size, ROUNDNESS, fine(action));
    let sharp = Join::Miter(10.0);
    let moved = |area: &[Polygon], by: f64, join| offset(area, by, join, tolerance);
    let area = moved(&from.area, -by, sharp)
        // Corners are rounded by a disc that rolls along the inside, and one along the outside.
        .and_then(|area| {
            if radius > 0.0 {
                moved(&area, -radius, sharp)
            } else {
                Ok(area)
            }
        })
        .and_then(|area| {
            if radius > 0.0 {
                moved(&area, 2.0 * radius, Join::Round)
            } else {
                Ok(area)
            }
        })
        .and_then(|area| {
            if radius > 0.0 {
                moved(&area, -radius, Join::Round)
            } else {
                Ok(area)
            }
        });
    area.map(Region::of_area)
        .map_err(|e| vec![failed(action, &e)])
}

type Operation = fn(&[Polygon], &[Polygon]) -> Result<Vec<Polygon>, AreaError>;

fn united(action: &Action, of: &[Ref<wants::Region>]) -> Made {
    check_plane(action, of)?;
    let parts: Vec<Arc<Region>> = of.iter().map(|part| action.input(part)).collect();
    let areas: Vec<Polygon> = parts.iter().flat_map(|part| part.area.clone()).collect();
    let area = unite(&areas).map_err(|e| vec![failed(action, &e)])?;
    let mut warnings = loose_parts(action, of, &parts, &area);
    warnings.extend(touching_itself(action, of, &area));
    Ok((Region::of_area(area), warnings))
}

fn combined(action: &Action, of: &[Ref<wants::Region>], operation: Operation) -> Made {
    check_plane(action, of)?;
    let mut areas = of
        .iter()
        .map(|reference| action.input(reference).area.clone());
    let first = areas.next().unwrap_or_default();
    let area = areas
        .try_fold(first, |a, b| operation(&a, &b))
        .map_err(|e| vec![failed(action, &e)])?;
    let warning = touching_itself(action, of, &area);
    Ok((Region::of_area(area), Vec::from_iter(warning)))
}

/// The region moved to its place, or to all of its places.
fn placed(
    action: &Action,
    region: Region,
    placement: &PlanePlacement,
) -> Result<Region, Vec<Diagnostic>> {
    match &maps(placement)[..] {
        [map] if *map == Affine::IDENTITY => Ok(region),
        [map] => Ok(region.transformed(map)),
        maps => {
            let points: usize = region
                .area
                .iter()
                .flat_map(Polygon::rings)
                .map(Vec::len)
                .sum();
            budget::make(
                "points of copies",
                points.saturating_mul(maps.len()),
                COPIED,
            );
            let copies: Vec<Polygon> = maps
                .iter()
                .flat_map(|map| region.transformed(map).area)
                .collect();
            unite(&copies)
                .map(Region::of_area)
                .map_err(|e| vec![failed(action, &e)])
        }
    }
}

/// What nobody sees of a region that is worked out, which is measured on the ground of a map too: it is a border that others
/// are cut at, and not drawn a thousand times.
fn fine(action: &Action) -> f64 {
    fine_on_object(action.definition.units)
}

fn failed(action: &Action, error: &dyn std::error::Error) -> Diagnostic {
    Diagnostic::error(error.to_string()).at(action.span(), "in this region")
}
