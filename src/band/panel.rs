//! A panel from its spec (Zhou 2014, section 6.2): the method along x, and with what comes out as the exemplar
//! along y.

use crate::diagnostic::Diagnostic;
use crate::geometry::cutout::{Cutout, Measures, mapped};
use crate::geometry::neck::narrowest_neck;
use crate::geometry::{Bounds, Point, Polygon};
use crate::spec::kinds::panels::Panel;

use super::band::synthesis;
use super::draw::draw;
use super::exemplar::Exemplar;
use super::explain::DRIFT;
use super::recipe::{Pattern, Recipe, Room, SLACK, compose};
use super::shape::{Bed, Detail};
use super::slicing::Slicing;

/// The cutout of `spec`, whose exemplar covers `area` (drawing plane): exactly `width` by `height` from (0, 0).
///
/// The counts are asked of the second run; the first one only has to be as connected as it can be: it is
/// asked for one component, and where that is impossible for any number.
///
/// # Errors
/// As for bands, for the row and for the panel.
pub fn panel(spec: &Panel, area: &[Polygon], steps: f64) -> Result<(Cutout, Vec<Diagnostic>), Vec<Diagnostic>> {
    make(spec, area, steps).map_err(|e| vec![e])
}

fn make(spec: &Panel, area: &[Polygon], steps: f64) -> Result<(Cutout, Vec<Diagnostic>), Diagnostic> {
    let recipe = Recipe::from(&spec.synthesis);
    let (exemplar, mut warnings) = Exemplar::new(area, None)?;
    let (width, height) = (spec.width.0, spec.height.0);
    let detail = Detail { finest: exemplar.finest(width.min(height)), steps };
    let ((row, strip), more) = drawn_row(&exemplar, &recipe, width, detail)?;
    warnings.extend(more);
    // A quarter turn: up along the row's own v, so that the exemplar of the second run stands on its side.
    let turned = mapped(&strip, |p| Point::new(p.y, p.x));
    let (turned, more) = Exemplar::new(&turned, None)?;
    warnings.extend(more);
    let ((pattern, room), more) = columns(&turned, &recipe, height).map_err(|e| named(e, "the panel's columns"))?;
    warnings.extend(more);
    let (pattern, strip) = drawn(pattern, &recipe, room, detail)?;
    let polygons = upright(&strip, width, height);
    let mut synthesis = synthesis(&pattern);
    synthesis.seam_cost += row.sequence.cost;
    let min_width = narrowest_neck(&polygons).map(|neck| neck.width);
    let mut cutout =
        Cutout::planar(polygons).map_err(|e| Diagnostic::error(format!("the panel could not be drawn: {e}")))?;
    cutout.measures = Measures { length: width, min_width, synthesis: Some(synthesis), ..cutout.measures };
    let sequence = &pattern.sequence;
    if (cutout.components, cutout.holes) != (sequence.components as usize, sequence.holes as usize) {
        return Err(Diagnostic::error("the panel's polygons have other counts than its pieces"));
    }
    Ok((cutout, warnings))
}

/// The pattern of the first run, its polygons, and warnings.
fn drawn_row(
    exemplar: &Exemplar,
    recipe: &Recipe,
    width: f64,
    detail: Detail,
) -> Result<((Pattern, Vec<Polygon>), Vec<Diagnostic>), Diagnostic> {
    let free = Recipe { components: recipe.components.map(|_| 1), holes: None, ..*recipe };
    // In a row the pieces may drift by a tenth of the exemplar's height to either side.
    let room = open(width, 1.2 * exemplar.height);
    let (pattern, warnings) = compose(exemplar, &free, room)
        .or_else(|e| compose(exemplar, &Recipe { components: None, ..free }, room).map_err(|_| e))
        .map_err(|e| named(e, "the panel's rows"))?;
    Ok((drawn(pattern, &free, room, detail)?, warnings))
}

/// Room along an open line.
fn open(length: f64, height: f64) -> Room {
    Room { length, height, closed: false, around: false, slack: SLACK }
}

/// Room across the columns, in their widths: as wide as the row, or wider where they drift; the panel is brought to
/// its width in the end.
const WIDTHS: [f64; 2] = [1.1, 4.0];
/// Cuts of the row where those between changes of its topology give no panel.
const CUTS: usize = 20;

/// The sequence along y, and warnings. Of the errors of all attempts that is told which knows what could be had.
fn columns(row: &Exemplar, recipe: &Recipe, height: f64) -> Result<((Pattern, Room), Vec<Diagnostic>), Diagnostic> {
    let mut errors = Vec::new();
    for slicing in [recipe.slicing, Slicing::Uniform(CUTS)] {
        for width in WIDTHS {
            let room = open(height, width * row.height);
            match compose(row, &Recipe { slicing, ..*recipe }, room) {
                Ok((pattern, warnings)) => return Ok(((pattern, room), warnings)),
                Err(error) => errors.push(error),
            }
        }
    }
    let drifts = |e: &Diagnostic| e.message.contains(DRIFT);
    let told = errors.iter().position(|e| !drifts(e)).unwrap_or(0);
    let error = errors.swap_remove(told);
    // A panel has no height to be raised: its columns stand side by side.
    let help = "ask for other counts, a wider panel, or `slicing: { uniform: 20 }`";
    Err(if drifts(&error) { error.help(help) } else { error })
}

fn named(mut error: Diagnostic, what: &str) -> Diagnostic {
    error.message = format!("{what}: {}", error.message);
    error
}

fn drawn(pattern: Pattern, recipe: &Recipe, room: Room, detail: Detail) -> Result<(Pattern, Vec<Polygon>), Diagnostic> {
    let bed = Bed { length: room.length, detail, radius: None, lines: &[] };
    draw(pattern, recipe, room, &bed)
        .map(|(pattern, shaped)| (pattern, shaped.polygons))
        .map_err(|e| Diagnostic::error(format!("the panel could not be drawn: {e}")))
}

/// Turns the second strip back and stretches it to the panel exactly, y down.
fn upright(strip: &[Polygon], width: f64, height: f64) -> Vec<Polygon> {
    let b = strip.iter().fold(Bounds::EMPTY, |b, p| b.union(p.bounds()));
    let part = |x: f64, low: f64, extent: f64| if extent > 0.0 { (x - low) / extent } else { 0.0 };
    // The strip's u is the row's v, and its v the row's u downward.
    mapped(strip, |p| {
        Point::new(width * (1.0 - part(p.y, b.min.y, b.height())), height * (1.0 - part(p.x, b.min.x, b.width())))
    })
}
