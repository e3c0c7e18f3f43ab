//! A band from its spec: the exemplar's pieces along a curve, as a cutout.

use std::sync::Arc;

use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::cutout::{Carrier, Cutout, Measures, Synthesis};
use fretwork_geometry::neck::narrowest_neck;
use fretwork_geometry::polygon::rounded;
use fretwork_geometry::{Across, Point3, Polygon, Ribbon, SpaceCurve, topology};
use fretwork_language::kinds::bands as kinds;

use crate::exemplar::normalize::Exemplar;
use crate::realize::retry::{Drawn, draw};
use crate::realize::shape::{Bed, Detail, along};
use crate::solve::pattern::{Pattern, Recipe, Room, SLACK, compose, fit};

/// Lines at which the edges of a ring are divided.
const RING_LINES: usize = 720;

/// The cutout of `spec`, whose exemplar covers `area` (drawing plane) and whose curve is `curve`; with warnings. `steps`
/// of the coordinates in files make a unit: the counts hold in these as well.
///
/// # Errors
/// What `Exemplar::new` and `compose` refuse, a direction across the curve that does not exist, and
/// a pattern that overlaps itself when it is bent in place.
pub fn band(
    spec: &kinds::Band,
    area: &[Polygon],
    curve: &SpaceCurve,
    steps: f64,
) -> Result<(Cutout, Vec<Diagnostic>), Vec<Diagnostic>> {
    make(spec, area, curve, steps).map_err(|e| vec![e])
}

fn make(
    spec: &kinds::Band,
    area: &[Polygon],
    curve: &SpaceCurve,
    steps: f64,
) -> Result<(Cutout, Vec<Diagnostic>), Diagnostic> {
    let height = spec.height.0;
    let ribbon = ribbon(spec, curve)?;
    let (exemplar, mut warnings) = Exemplar::new(area)?;
    let closed = curve.is_closed();
    let room = Room {
        length: curve.length(),
        height,
        closed,
        around: spec.closed_pattern,
        slack: SLACK,
    };
    let recipe = Recipe::from(&spec.synthesis);
    let (exemplar, (pattern, more)) = if spec.fit {
        fit(&exemplar, &recipe, room)?
    } else {
        let made = compose(&exemplar, &recipe, room)?;
        (exemplar, made)
    };
    warnings.extend(more);
    let folded = ribbon.fold(height);
    if let Some(fold) = folded {
        let Point3 { x, y, z } = fold.at;
        let place = format!("near ({x:.3}, {y:.3}, {z:.3})");
        warnings.push(
            Diagnostic::warning(format!(
                "the band is higher than the curve's radius of curvature allows {place}"
            ))
            .help(format!(
                "up to a height of {:.3} it does not fold there",
                fold.height
            )),
        );
    }
    let order = Order {
        recipe: &recipe,
        room,
        detail: Detail {
            finest: exemplar.finest(height),
            steps,
        },
    };
    let mut cutout = lay(pattern, &order, ribbon, spec.layout == kinds::Layout::Strip)?;
    let flat = cutout.flat();
    let count = || {
        cutout
            .is_in_place()
            .then(|| topology::count(&rounded(&flat, steps)))
    };
    let (found, neck) = rayon::join(count, || narrowest_neck(&flat));
    cutout.measures.area = flat.iter().map(Polygon::area).sum();
    cutout.measures.min_width = neck.map(|neck| neck.width);
    if let Some(found) = found {
        let wanted = (cutout.components, cutout.holes + cutout.around);
        if found.map(|t| (t.components, t.holes)) != Ok(wanted) {
            let place = found
                .err()
                .and_then(|e| e.place())
                .map_or(String::new(), |p| {
                    format!(" near ({:.3}, {:.3})", p.x, -p.y)
                });
            return Err(Diagnostic::error(format!(
                "bent along the curve, the pattern overlaps itself{place}"
            ))
            .help("lower the band, smooth the curve, or ask for `layout: strip`"));
        }
    }
    Ok((cutout, warnings))
}

fn ribbon(spec: &kinds::Band, curve: &SpaceCurve) -> Result<Arc<Ribbon>, Diagnostic> {
    let across = match spec.across {
        Some(kinds::Across::Plane) => Across::Plane,
        Some(kinds::Across::Normal) => Across::Normal,
        Some(kinds::Across::Surface) => Across::Surface,
        Some(kinds::Across::Direction(d)) => Across::Direction(Point3::from(d.0)),
        None if !curve.normals().is_empty() => Across::Surface,
        None if curve.plane().is_some() => Across::Plane,
        None => Across::Normal,
    };
    let ribbon = Ribbon::new(curve.clone(), across, spec.flip);
    ribbon
        .map(Arc::new)
        .map_err(|e| Diagnostic::error(format!("`across` has no direction: {e}")))
}

/// What a pattern was asked to be.
struct Order<'a> {
    recipe: &'a Recipe,
    room: Room,
    detail: Detail,
}

/// The geometry of a pattern along `ribbon`, not measured yet.
fn lay(
    pattern: Pattern,
    order: &Order,
    ribbon: Arc<Ribbon>,
    is_strip: bool,
) -> Result<Cutout, Diagnostic> {
    let Room {
        length,
        height,
        closed,
        ..
    } = order.room;
    let radius = (length / std::f64::consts::TAU).max(height);
    let mut lines = ribbon.joints().to_vec();
    if closed {
        let step = length / RING_LINES as f64;
        lines.extend((0..RING_LINES).map(|i| step * i as f64));
        lines.sort_by(f64::total_cmp);
        lines.dedup_by(|a, b| *a - *b < 1e-3 * step);
        lines.retain(|&at| at < length - 1e-3 * step);
    }
    let bed = Bed {
        length,
        detail: order.detail,
        radius: closed.then_some(radius),
        lines: &lines,
    };
    let Drawn {
        pattern,
        shaped,
        thinnest,
        is_fragile,
    } = draw(pattern, order.recipe, order.room, &bed)
        .map_err(|e| Diagnostic::error(format!("the pattern could not be drawn: {e}")))?;
    if let Some(neck) = thinnest.filter(|_| is_fragile) {
        let place = format!("{:.3} along the curve", along(neck.middle(), &bed));
        return Err(fragile(neck.width, &place));
    }
    let sequence = &pattern.sequence;
    let carrier = if closed {
        Carrier::Ring { ribbon, radius }
    } else {
        Carrier::Strip(ribbon)
    };
    Ok(Cutout {
        polygons: shaped.polygons,
        components: sequence.components as usize,
        holes: sequence.holes as usize,
        around: sequence.around as usize,
        carrier,
        developed: shaped.developed,
        is_strip,
        measures: Measures {
            length,
            synthesis: Some(synthesis(&pattern)),
            ..Measures::default()
        },
    })
}

/// The error of a pattern that holds nothing together, or keeps nothing apart, at its thinnest place.
pub fn fragile(width: f64, place: &str) -> Diagnostic {
    Diagnostic::error(format!("the pattern would be only {width:.6} thin, {place}: its pieces fit too badly"))
        .help("ask for other counts, `slicing: { uniform: 12 }`, a `min_portal`, or a larger `length_tolerance`")
}

/// What a pattern was made of.
pub fn synthesis(pattern: &Pattern) -> Synthesis {
    Synthesis {
        pieces_in: pattern.parts.pieces.len(),
        pieces_out: pattern.sequence.pieces.len(),
        pieces: pattern.sequence.pieces.clone(),
        seam_cost: pattern.sequence.cost,
    }
}
