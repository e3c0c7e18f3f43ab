//! A panel from its spec (Zhou 2014, section 6.2): the method runs along x, and then along y with
//! what came out as the exemplar.

use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::cutout::{Cutout, Measures, mapped};
use fretwork_geometry::neck::narrowest_neck;
use fretwork_geometry::{Bounds, Point, Polygon};
use fretwork_language::kinds::bands::Slicing;
use fretwork_language::kinds::panels::Panel;
use fretwork_language::scalar::Count;

use crate::band::synthesis;
use crate::diagnose::fragile;
use crate::exemplar::ends::Ends;
use crate::exemplar::error::ExemplarWarning;
use crate::exemplar::normalize::Exemplar;
use crate::exemplar::slicing::Cutting;
use crate::parameters::{Parameters, Room};
use crate::realize::bed::{Bed, Detail};
use crate::realize::retry::{Drawn, draw};
use crate::realize::shape::ShapeError;
use crate::solve::pattern::{Pattern, PatternError, SLACK, compose};

/// The cutout of `spec`, whose exemplar covers `area` (drawing plane), with warnings: exactly
/// `width` by `height` from (0, 0). `steps` of the coordinates in files make a unit.
///
/// The counts are asked of the second run. The first run only has to be as connected as it can be:
/// it is asked for one component, and where that is impossible for any number.
///
/// # Errors
/// As for bands, for the row and for the panel.
pub fn panel(
    spec: &Panel,
    area: &[Polygon],
    steps: f64,
) -> Result<(Cutout, Vec<Diagnostic>), Vec<Diagnostic>> {
    make(spec, area, steps).map_err(|e| vec![e])
}

/// Why one of the two runs has no pattern.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
enum RunError {
    #[error(transparent)]
    Pattern(#[from] PatternError),
    #[error("the panel could not be drawn: {0}")]
    Shape(#[from] ShapeError),
}

impl RunError {
    fn is_drift(&self) -> bool {
        matches!(self, RunError::Pattern(error) if error.is_drift())
    }
}

impl From<RunError> for Diagnostic {
    fn from(error: RunError) -> Diagnostic {
        match error {
            RunError::Pattern(error) => error.into(),
            RunError::Shape(_) => Diagnostic::error(error.to_string()),
        }
    }
}

/// The pattern of one run with what is to be told about its exemplar.
type Run = (Drawn, Vec<ExemplarWarning>);

fn make(
    spec: &Panel,
    area: &[Polygon],
    steps: f64,
) -> Result<(Cutout, Vec<Diagnostic>), Diagnostic> {
    let parameters = Parameters::from(&spec.synthesis);
    let (exemplar, mut warnings) = Exemplar::new(area)?;
    let (width, height) = (spec.width.0, spec.height.0);
    let detail = Detail {
        finest: exemplar.finest(width.max(height)),
        steps,
    };
    let (row, more) = row(&exemplar, &parameters, width, detail)?;
    warnings.extend(more);
    // A quarter turn: the exemplar of the second run stands on its side.
    let turned = mapped(&row.shape.polygons, |p| Point::new(p.y, p.x));
    let (turned, more) = Exemplar::new(&turned)?;
    warnings.extend(more);
    let (columns, more) = columns(&turned, &parameters, height, detail)?;
    warnings.extend(more);
    let polygons = upright(&columns.shape.polygons, width, height);
    let cutout = measured(polygons, width, &[row.pattern, columns.pattern])?;
    Ok((cutout, warnings.into_iter().map(Diagnostic::from).collect()))
}

/// The panel with its measures; `runs` are the patterns of its row and of its columns.
fn measured(polygons: Vec<Polygon>, width: f64, runs: &[Pattern; 2]) -> Result<Cutout, Diagnostic> {
    let [row, columns] = runs;
    let mut synthesis = synthesis(columns);
    synthesis.seam_cost += row.sequence.cost;
    let min_width = narrowest_neck(&polygons).map(|neck| neck.width);
    let mut cutout = Cutout::planar(polygons)
        .map_err(|e| Diagnostic::error(format!("the panel could not be drawn: {e}")))?;
    cutout.measures = Measures {
        length: width,
        min_width,
        synthesis: Some(synthesis),
        ..cutout.measures
    };
    let sequence = &columns.sequence;
    let wanted = (sequence.components as usize, sequence.holes as usize);
    if (cutout.components, cutout.holes) != wanted {
        return Err(Diagnostic::error(
            "the panel's polygons have other counts than its pieces",
        ));
    }
    Ok(cutout)
}

/// How much higher than the exemplar the room of a row is: its pieces may drift by a tenth of the
/// exemplar's height to either side. With less, tilted exemplars have no row; with more, the
/// columns have to cross wavy rows.
const ROW_HEIGHT: f64 = 1.2;

/// The pattern of the first run, along x.
fn row(
    exemplar: &Exemplar,
    parameters: &Parameters,
    width: f64,
    detail: Detail,
) -> Result<Run, Diagnostic> {
    let free = Parameters {
        components: parameters.components.map(|_| 1),
        holes: None,
        ..*parameters
    };
    let any = Parameters {
        components: None,
        ..free
    };
    let room = open_room(width, ROW_HEIGHT * exemplar.height);
    let (pattern, warnings) = compose(exemplar, &Ends::Free, &free, room)
        .or_else(|e| compose(exemplar, &Ends::Free, &any, room).map_err(|_| e))
        .map_err(|e| named(e.into(), "the panel's rows"))?;
    let drawn = draw_open(pattern, &free, room, detail).map_err(RunError::Shape)?;
    Ok((drawn, warnings))
}

/// Room along an open line.
fn open_room(length: f64, height: f64) -> Room {
    Room {
        length,
        height,
        closed: false,
        around: false,
        slack: SLACK,
    }
}

/// The room across the columns in widths of the row: as wide as the row, or wider where they drift;
/// the panel is brought to its width in the end. In the second room columns lean so far that the
/// panel looks sheared, which is why the first is tried with everything else before.
const WIDTHS: [f64; 2] = [1.1, 4.0];
/// How many cuts the row gets where those between changes of its topology give no panel, or a poor
/// one. More cuts give more to choose from and look less like the exemplar.
const CUTS: [u32; 3] = [20, 12, 8];
/// What is repeated at once is this part of the row or more. Where that gives no panel, or a poor
/// one, it may be any part. Large parts keep the ornament together; above a half hardly a length
/// can be met.
const REPEATS: [f64; 2] = [0.35, 0.0];
/// What the second run is called in errors.
const COLUMNS: &str = "the panel's columns";
/// Necks below this many times the finest detail are better not cut: joining only makes them
/// thinner.
const PORTAL: f64 = 2.0;
/// Where one piece makes up more than this part of the height, the panel is a stripe.
const MONOTONOUS: f64 = 0.5;

/// The pattern of the second run, along y: the first of all trials that is thick enough and no
/// stripe, or else the best of them.
fn columns(
    row: &Exemplar,
    parameters: &Parameters,
    height: f64,
    detail: Detail,
) -> Result<Run, Diagnostic> {
    let mut trials = Trials {
        row,
        height,
        detail,
        asked: parameters.cutting.slicing,
        best: None,
        errors: Vec::new(),
    };
    let mut left = variants(parameters, detail);
    for width in WIDTHS {
        let mut again = Vec::new();
        for variant in left {
            if let Some(run) = trials.take(variant, width, &mut again) {
                return Ok(run);
            }
        }
        left = again;
    }
    match trials.best {
        Some((faults, run)) if !faults.is_fragile => Ok(run),
        Some((_, (drawn, _))) => {
            let width = drawn.thinnest.map_or(0.0, |neck| neck.width);
            Err(named(fragile(width, "at best"), COLUMNS))
        }
        None => Err(named(most_useful(trials.errors), COLUMNS)),
    }
}

/// The ways in which the row is cut and repeated, in the order in which they are tried: in large
/// parts, then in any; cut as asked for, then uniformly; and each of these also through wide necks
/// only.
fn variants(parameters: &Parameters, detail: Detail) -> Vec<Parameters> {
    let asked = parameters.cutting;
    let portals = [
        asked.min_portal,
        asked.min_portal.max(PORTAL * detail.finest),
    ];
    let uniform = CUTS.map(|lines| Slicing::Uniform(Count(lines)));
    let mut variants = Vec::new();
    for least_repeat in REPEATS {
        for slicing in std::iter::once(asked.slicing).chain(uniform) {
            variants.extend(portals.map(|min_portal| Parameters {
                cutting: Cutting {
                    slicing,
                    min_portal,
                    ..asked
                },
                least_repeat,
                ..*parameters
            }));
        }
    }
    variants
}

/// The trials of the second run.
struct Trials<'a> {
    row: &'a Exemplar,
    height: f64,
    detail: Detail,
    /// The slicing that was asked for.
    asked: Slicing,
    best: Option<(Faults, Run)>,
    errors: Vec<RunError>,
}

impl Trials<'_> {
    /// Tries one variant in a room this many times as wide as the row. Returns a run without
    /// faults. What is to be tried in a wider room goes to `again`: whatever gave no panel or a
    /// thin one.
    fn take(
        &mut self,
        variant: Parameters,
        width: f64,
        again: &mut Vec<Parameters>,
    ) -> Option<Run> {
        // Once a panel is thick enough, only the slicing that was asked for is worth another trial.
        let is_thick = self.best.as_ref().is_some_and(|b| b.0.is_thick());
        if is_thick && variant.cutting.slicing != self.asked {
            return None;
        }
        match self.run(&variant, width) {
            Ok(run) => {
                let faults = faults(&run.0, self.row);
                if faults == Faults::default() {
                    return Some(run);
                }
                if !faults.is_thick() {
                    again.push(variant);
                }
                if self.best.as_ref().is_none_or(|b| faults < b.0) {
                    self.best = Some((faults, run));
                }
            }
            Err(error) => {
                // With large parts alone not all the counts that an error lists can be had.
                if variant.least_repeat == 0.0 {
                    self.errors.push(error);
                }
                again.push(variant);
            }
        }
        None
    }

    fn run(&self, parameters: &Parameters, width: f64) -> Result<Run, RunError> {
        let room = open_room(self.height, width * self.row.height);
        let (pattern, warnings) = compose(self.row, &Ends::Free, parameters, room)?;
        let drawn = draw_open(pattern, parameters, room, self.detail)?;
        Ok((drawn, warnings))
    }
}

/// What is wrong with a panel, the worst first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Faults {
    is_fragile: bool,
    is_thin: bool,
    is_stripe: bool,
    leans: bool,
}

impl Faults {
    fn is_thick(&self) -> bool {
        !self.is_fragile && !self.is_thin
    }
}

fn faults(drawn: &Drawn, row: &Exemplar) -> Faults {
    let Pattern { parts, sequence } = &drawn.pattern;
    let mut shares = vec![0.0; parts.count()];
    for &piece in &sequence.pieces {
        shares[piece] += parts.pieces[piece].width;
    }
    let most = shares.into_iter().fold(0.0, f64::max);
    Faults {
        is_fragile: drawn.is_fragile,
        is_thin: drawn.thinnest.is_some(),
        is_stripe: most > MONOTONOUS * sequence.length,
        leans: extent(&drawn.shape.polygons).height() > WIDTHS[0] * row.height,
    }
}

/// The error to report when all trials fail: one that lists what could be had if there is one. The
/// advice to raise the band is replaced, because a panel's columns stand side by side.
fn most_useful(mut errors: Vec<RunError>) -> Diagnostic {
    let useful = errors.iter().position(|e| !e.is_drift()).unwrap_or(0);
    let error = errors.swap_remove(useful);
    let drifts = error.is_drift();
    let diagnostic = Diagnostic::from(error);
    if drifts {
        diagnostic.help("ask for other counts, a wider panel, or `slicing: { uniform: 20 }`")
    } else {
        diagnostic
    }
}

fn named(mut error: Diagnostic, what: &str) -> Diagnostic {
    error.message = format!("{what}: {}", error.message);
    error
}

/// The geometry of a pattern along an open line.
fn draw_open(
    pattern: Pattern,
    parameters: &Parameters,
    room: Room,
    detail: Detail,
) -> Result<Drawn, ShapeError> {
    let bed = Bed {
        length: room.length,
        detail,
        radius: None,
        lines: &[],
    };
    draw(pattern, parameters, room, &bed)
}

fn extent(polygons: &[Polygon]) -> Bounds {
    polygons
        .iter()
        .fold(Bounds::EMPTY, |b, p| b.union(p.bounds()))
}

/// Turns the second strip back and stretches it to the panel exactly, y down.
fn upright(strip: &[Polygon], width: f64, height: f64) -> Vec<Polygon> {
    let b = extent(strip);
    let part = |x: f64, low: f64, extent: f64| {
        if extent > 0.0 {
            (x - low) / extent
        } else {
            0.0
        }
    };
    // The strip's u is the row's v, and its v the row's u downward.
    mapped(strip, |p| {
        Point::new(
            width * (1.0 - part(p.y, b.min.y, b.height())),
            height * (1.0 - part(p.x, b.min.x, b.width())),
        )
    })
}
