//! A band from its spec: the exemplar's pieces along a curve, as a cutout.

use std::sync::Arc;

use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::cutout::{Carrier, Cutout, Measures, Side, Synthesis};
use fretwork_geometry::neck::narrowest_neck;
use fretwork_geometry::polygon::rounded;
use fretwork_geometry::progress::step;
use fretwork_geometry::{Across, Point3, Polygon, Ribbon, SpaceCurve, topology};
use fretwork_language::kinds::bands as kinds;

use crate::diagnose::{folded, fragile};
use crate::exemplar::ends::Ends;
use crate::exemplar::error::{ExemplarError, ExemplarWarning};
use crate::exemplar::normalize::Exemplar;
use crate::parameters::{Parameters, Room};
use crate::realize::bed::{Bed, Detail};
use crate::realize::retry::{Drawn, draw};
use crate::solve::pattern::{Pattern, PatternError, SLACK, compose, fit};

/// How many lines divide the edges of a ring: every half degree. An edge between two of them is off
/// the circle by 10^-5 of the radius; twice as many only double the files.
const RING_LINES: usize = 720;
/// Lines nearer than this part of their distance are one.
const SAME_LINE: f64 = 1e-3;

/// The areas of the drawings of a band, in the drawing plane.
#[derive(Clone, Copy, Debug)]
pub struct Areas<'a> {
    /// That of its exemplar.
    pub exemplar: &'a [Polygon],
    /// That of the cap at its ends, if it has one.
    pub cap: Option<&'a [Polygon]>,
}

/// An error, and the field of the band that it is about, if it is about one.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// The error.
    pub diagnostic: Diagnostic,
    /// The field.
    pub field: Option<&'static str>,
}

impl Fault {
    /// An error about `ends`.
    fn of_ends(diagnostic: Diagnostic) -> Fault {
        Fault {
            diagnostic,
            field: Some("ends"),
        }
    }
}

impl From<Diagnostic> for Fault {
    fn from(diagnostic: Diagnostic) -> Fault {
        Fault {
            diagnostic,
            field: None,
        }
    }
}

impl From<ExemplarError> for Fault {
    fn from(error: ExemplarError) -> Fault {
        Diagnostic::from(error).into()
    }
}

impl From<PatternError> for Fault {
    fn from(error: PatternError) -> Fault {
        match error {
            PatternError::Ends(_) => Fault::of_ends(error.into()),
            _ => Diagnostic::from(error).into(),
        }
    }
}

/// The cutout of `spec`, whose drawings cover `areas` and whose curve is `curve`, with warnings.
/// `steps` of the coordinates in files make a unit: the counts hold in steps as well.
///
/// # Errors
/// An exemplar that cannot be used or cut, end pieces that a closed curve has no place for or that
/// do not meet the pattern, lengths and counts that cannot be had, a direction across the curve
/// that does not exist, and a pattern that overlaps itself when it is bent in place.
pub fn band(
    spec: &kinds::Band,
    areas: Areas,
    curve: &SpaceCurve,
    steps: f64,
) -> Result<(Cutout, Vec<Diagnostic>), Fault> {
    let height = spec.height.0;
    let ribbon = ribbon(spec, curve)?;
    let room = Room {
        length: curve.length(),
        height,
        closed: curve.is_closed(),
        around: spec.closed_pattern,
        slack: SLACK,
    };
    let parameters = Parameters::from(&spec.synthesis);
    step(|| "looking for a sequence of pieces".to_owned());
    let (ends, of_cap) = ends(spec, areas.cap, room)?;
    let (exemplar, warnings) = Exemplar::new(areas.exemplar)?;
    let (exemplar, pattern, more) = sized(spec, (exemplar, &ends), &parameters, room)?;
    let warnings = warnings.into_iter().chain(of_cap).chain(more);
    let warnings = warnings.map(Diagnostic::from);
    let mut warnings: Vec<Diagnostic> = warnings.collect();
    warnings.extend(ribbon.fold(height).map(folded));
    step(|| "laying the pieces along the curve".to_owned());
    let order = Order {
        parameters: &parameters,
        room,
        detail: Detail {
            finest: exemplar.finest(height),
            steps,
        },
    };
    let mut cutout = lay(pattern, &order, ribbon, spec.layout == kinds::Layout::Strip)?;
    step(|| "looking for the narrowest place".to_owned());
    measure(&mut cutout, steps)?;
    Ok((cutout, warnings))
}

/// The strip along the curve. Without `across`, a band lies in the surface of its curve or else in
/// its plane, and stands up on other curves (rule B1).
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

/// The thickness of a bar is this part of the band's height where the spec gives none: strong
/// enough to be taken by, and thin beside the pattern.
const BAR: f64 = 0.1;

/// What closes the ends of the band, with what is to be told about the cap.
fn ends(
    spec: &kinds::Band,
    cap: Option<&[Polygon]>,
    room: Room,
) -> Result<(Ends, Vec<ExemplarWarning>), Fault> {
    let asked = match &spec.ends {
        kinds::Ends::Free => return Ok((Ends::Free, Vec::new())),
        kinds::Ends::Bar(thickness) => thickness.map_or(BAR * room.height, |t| t.0),
        kinds::Ends::Cap(_) => 0.0,
    };
    if room.closed {
        let error = Diagnostic::error("the curve is closed: the band has no ends");
        return Err(Fault::of_ends(
            error.help("leave `ends` out, or use an open curve"),
        ));
    }
    let Some(area) = cap else {
        return Ok((Ends::Bar(asked), Vec::new()));
    };
    let (cap, warnings) = Exemplar::new(area).map_err(|e| Fault::of_ends(e.into()))?;
    Ok((Ends::Cap(cap), warnings))
}

/// The exemplar at its own size, or at that of the band where `fit` asks for it, with its pattern.
fn sized(
    spec: &kinds::Band,
    (exemplar, ends): (Exemplar, &Ends),
    parameters: &Parameters,
    room: Room,
) -> Result<(Exemplar, Pattern, Vec<ExemplarWarning>), Fault> {
    if !spec.fit {
        let (pattern, warnings) = compose(&exemplar, ends, parameters, room)?;
        return Ok((exemplar, pattern, warnings));
    }
    let (exemplar, (pattern, warnings)) = fit(&exemplar, ends, parameters, room).map_err(|e| {
        let drifts = e.is_drift();
        let mut fault = Fault::from(e);
        if drifts {
            // A higher band would not do here, because the exemplar grows with it.
            fault.diagnostic = fault.diagnostic.help(
                "`fit` scales the exemplar with the band: \
                 draw it level, so that both its ends are at the same height",
            );
        }
        fault
    })?;
    Ok((exemplar, pattern, warnings))
}

/// What a pattern was asked to be.
struct Order<'a> {
    parameters: &'a Parameters,
    room: Room,
    detail: Detail,
}

/// The geometry of a pattern along `ribbon`, without its area and its narrowest neck.
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
    let lines = dividing_lines(&ribbon, &order.room);
    let bed = Bed {
        length,
        detail: order.detail,
        radius: closed.then_some(radius),
        lines: &lines,
    };
    let Drawn {
        pattern,
        shape,
        thinnest,
        is_fragile,
    } = draw(pattern, order.parameters, order.room, &bed)
        .map_err(|e| Diagnostic::error(format!("the pattern could not be drawn: {e}")))?;
    if let Some(neck) = thinnest.filter(|_| is_fragile) {
        let place = format!("{:.3} along the curve", bed.along(neck.middle()));
        return Err(fragile(neck.width, &place));
    }
    let sequence = &pattern.sequence;
    let carrier = if closed {
        Carrier::Ring { ribbon, radius }
    } else {
        Carrier::Strip(ribbon)
    };
    Ok(Cutout {
        polygons: shape.polygons,
        components: sequence.components as usize,
        holes: sequence.holes as usize,
        around: sequence.around as usize,
        carrier,
        developed: shape.developed,
        is_strip,
        side: Side::Center,
        measures: Measures {
            length,
            synthesis: Some(synthesis(&pattern)),
            ..Measures::default()
        },
    })
}

/// The places along the curve where edges are divided: the joints of the strip, and the lines of
/// the ring on which a closed band is laid.
fn dividing_lines(ribbon: &Ribbon, room: &Room) -> Vec<f64> {
    let mut lines = ribbon.joints().to_vec();
    if room.closed {
        let step = room.length / RING_LINES as f64;
        lines.extend((0..RING_LINES).map(|i| step * i as f64));
        lines.sort_by(f64::total_cmp);
        lines.dedup_by(|a, b| *a - *b < SAME_LINE * step);
        lines.retain(|&at| at < room.length - SAME_LINE * step);
    }
    lines
}

/// Measures a cutout, and counts it again where it is cut bent in place.
fn measure(cutout: &mut Cutout, steps: f64) -> Result<(), Diagnostic> {
    let flat = cutout.flat();
    let count = || {
        let in_place = cutout.is_in_place();
        in_place.then(|| topology::count(&rounded(&flat, steps)))
    };
    let (found, neck) = rayon::join(count, || narrowest_neck(&flat));
    cutout.measures.area = flat.iter().map(Polygon::area).sum();
    cutout.measures.min_width = neck.map(|neck| neck.width);
    let Some(found) = found else {
        return Ok(());
    };
    let wanted = (cutout.components, cutout.holes + cutout.around);
    if found.map(|t| (t.components, t.holes)) == Ok(wanted) {
        return Ok(());
    }
    let place = found.err().and_then(|e| e.place());
    let place = place.map_or(String::new(), |p| {
        format!(" near ({:.3}, {:.3})", p.x, -p.y)
    });
    Err(Diagnostic::error(format!(
        "bent along the curve, the pattern overlaps itself{place}"
    ))
    .help("lower the band, smooth the curve, or ask for `layout: strip`"))
}

/// What a pattern was made of.
pub fn synthesis(pattern: &Pattern) -> Synthesis {
    Synthesis {
        pieces_in: pattern.parts.count(),
        pieces_out: pattern.parts.numbers(&pattern.sequence.pieces).len(),
        pieces: pattern.parts.numbers(&pattern.sequence.pieces),
        seam_cost: pattern.sequence.cost,
    }
}
