//! A panel from its spec (Zhou 2014, section 6.2): the method along x, and with what comes out as the exemplar
//! along y.

use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::cutout::{Cutout, Measures, mapped};
use fretwork_geometry::neck::narrowest_neck;
use fretwork_geometry::{Bounds, Point, Polygon};
use fretwork_language::kinds::panels::Panel;

use crate::band::{fragile, synthesis};
use crate::exemplar::normalize::Exemplar;
use crate::exemplar::slicing::Slicing;
use crate::realize::retry::{Drawn, draw};
use crate::realize::shape::{Bed, Detail};
use crate::solve::pattern::{Pattern, Recipe, Room, SLACK, compose};
use crate::solve::unsolvable::DRIFT;

/// The cutout of `spec`, whose exemplar covers `area` (drawing plane): exactly `width` by `height` from (0, 0). `steps` of
/// the coordinates in files make a unit.
///
/// The counts are asked of the second run; the first one only has to be as connected as it can be: it is
/// asked for one component, and where that is impossible for any number.
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

fn make(
    spec: &Panel,
    area: &[Polygon],
    steps: f64,
) -> Result<(Cutout, Vec<Diagnostic>), Diagnostic> {
    let recipe = Recipe::from(&spec.synthesis);
    let (exemplar, mut warnings) = Exemplar::new(area)?;
    let (width, height) = (spec.width.0, spec.height.0);
    let detail = Detail {
        finest: exemplar.finest(width.max(height)),
        steps,
    };
    let (row, more) = row(&exemplar, &recipe, width, detail)?;
    warnings.extend(more);
    // A quarter turn: up along the row's own v, so that the exemplar of the second run stands on its side.
    let turned = mapped(&row.shaped.polygons, |p| Point::new(p.y, p.x));
    let (turned, more) = Exemplar::new(&turned)?;
    warnings.extend(more);
    let (columns, more) = columns(&turned, &recipe, height, detail)?;
    warnings.extend(more);
    let polygons = upright(&columns.shaped.polygons, width, height);
    let mut synthesis = synthesis(&columns.pattern);
    synthesis.seam_cost += row.pattern.sequence.cost;
    let min_width = narrowest_neck(&polygons).map(|neck| neck.width);
    let mut cutout = Cutout::planar(polygons)
        .map_err(|e| Diagnostic::error(format!("the panel could not be drawn: {e}")))?;
    cutout.measures = Measures {
        length: width,
        min_width,
        synthesis: Some(synthesis),
        ..cutout.measures
    };
    let sequence = &columns.pattern.sequence;
    if (cutout.components, cutout.holes) != (sequence.components as usize, sequence.holes as usize)
    {
        return Err(Diagnostic::error(
            "the panel's polygons have other counts than its pieces",
        ));
    }
    Ok((cutout, warnings))
}

/// The pattern of the first run, along x.
fn row(
    exemplar: &Exemplar,
    recipe: &Recipe,
    width: f64,
    detail: Detail,
) -> Result<(Drawn, Vec<Diagnostic>), Diagnostic> {
    let free = Recipe {
        components: recipe.components.map(|_| 1),
        holes: None,
        ..*recipe
    };
    // In a row the pieces may drift by a tenth of the exemplar's height to either side.
    let room = open(width, 1.2 * exemplar.height);
    let (pattern, warnings) = compose(exemplar, &free, room)
        .or_else(|e| {
            compose(
                exemplar,
                &Recipe {
                    components: None,
                    ..free
                },
                room,
            )
            .map_err(|_| e)
        })
        .map_err(|e| named(e, "the panel's rows"))?;
    Ok((drawn(pattern, &free, room, detail)?, warnings))
}

/// Room along an open line.
fn open(length: f64, height: f64) -> Room {
    Room {
        length,
        height,
        closed: false,
        around: false,
        slack: SLACK,
    }
}

/// Room across the columns, in their widths: as wide as the row, or wider where they drift; the panel is brought to
/// its width in the end.
const WIDTHS: [f64; 2] = [1.1, 4.0];
/// Cuts of the row where those between changes of its topology give no panel, or a poor one.
const CUTS: [usize; 3] = [20, 12, 8];
/// What comes again is this part of the row or more; where that gives no panel, or a poor one, any part.
const REPEATS: [f64; 2] = [0.35, 0.0];
/// What the second run is called.
const COLUMNS: &str = "the panel's columns";
/// Necks below so many times the finest detail are better not cut: they only get thinner.
const PORTAL: f64 = 2.0;
/// More of the height than this in one piece is a stripe.
const MONOTONOUS: f64 = 0.5;

/// The pattern of the second run, along y, and warnings: the first of all trials that is thick enough and no stripe, else the
/// best of them. Where one is thick enough, others are only tried with the slicing that was asked for, and wider room only where
/// the narrow one gave none. Of the errors that one is told which knows what could be had.
fn columns(
    row: &Exemplar,
    recipe: &Recipe,
    height: f64,
    detail: Detail,
) -> Result<(Drawn, Vec<Diagnostic>), Diagnostic> {
    let mut best: Option<(Rank, (Drawn, Vec<Diagnostic>))> = None;
    let mut errors = Vec::new();
    let asked = recipe.slicing;
    let mut left = trials(recipe, detail);
    for width in WIDTHS {
        let room = open(height, width * row.height);
        for recipe in std::mem::take(&mut left) {
            if best.as_ref().is_some_and(|b| b.0.is_thick()) && recipe.slicing != asked {
                continue;
            }
            let trial = compose(row, &recipe, room).and_then(|(pattern, warnings)| {
                Ok((drawn(pattern, &recipe, room, detail)?, warnings))
            });
            match trial {
                Ok(trial) => {
                    let rank = rank(&trial.0, row);
                    if rank == Rank::default() {
                        return Ok(trial);
                    }
                    if !rank.is_thick() {
                        left.push(recipe);
                    }
                    if best.as_ref().is_none_or(|b| rank < b.0) {
                        best = Some((rank, trial));
                    }
                }
                Err(error) => {
                    // With large parts alone not all counts can be had that are told.
                    if recipe.least_repeat == 0.0 {
                        errors.push(error);
                    }
                    left.push(recipe);
                }
            }
        }
    }
    match best {
        Some((rank, trial)) if !rank.is_fragile => Ok(trial),
        Some((_, (drawn, _))) => {
            let width = drawn.thinnest.map_or(0.0, |neck| neck.width);
            Err(named(fragile(width, "at best"), COLUMNS))
        }
        None => Err(named(told(errors), COLUMNS)),
    }
}

/// How the row is cut and repeated, in the order in which it is tried: in large parts, then in any; cut as asked for, then uniformly;
/// in each case also through wide necks only.
fn trials(recipe: &Recipe, detail: Detail) -> Vec<Recipe> {
    let portals = [
        recipe.min_portal,
        recipe.min_portal.max(PORTAL * detail.finest),
    ];
    let mut trials = Vec::new();
    for least_repeat in REPEATS {
        for slicing in std::iter::once(recipe.slicing).chain(CUTS.map(Slicing::Uniform)) {
            trials.extend(portals.map(|min_portal| Recipe {
                slicing,
                min_portal,
                least_repeat,
                ..*recipe
            }));
        }
    }
    trials
}

/// What is wrong with a panel, the worst first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Rank {
    is_fragile: bool,
    is_thin: bool,
    is_stripe: bool,
    leans: bool,
}

impl Rank {
    fn is_thick(&self) -> bool {
        !self.is_fragile && !self.is_thin
    }
}

fn rank(drawn: &Drawn, row: &Exemplar) -> Rank {
    let Pattern { parts, sequence } = &drawn.pattern;
    let mut shares = vec![0.0; parts.count()];
    sequence
        .pieces
        .iter()
        .for_each(|&p| shares[p] += parts.pieces[p].width);
    let most = shares.into_iter().fold(0.0, f64::max);
    Rank {
        is_fragile: drawn.is_fragile,
        is_thin: drawn.thinnest.is_some(),
        is_stripe: most > MONOTONOUS * sequence.length,
        leans: extent(&drawn.shaped.polygons).height() > WIDTHS[0] * row.height,
    }
}

/// The error that knows most. A panel has no height to be raised: its columns stand side by side.
fn told(mut errors: Vec<Diagnostic>) -> Diagnostic {
    let drifts = |e: &Diagnostic| e.message.contains(DRIFT);
    let told = errors.iter().position(|e| !drifts(e)).unwrap_or(0);
    let error = errors.swap_remove(told);
    let help = "ask for other counts, a wider panel, or `slicing: { uniform: 20 }`";
    if drifts(&error) {
        error.help(help)
    } else {
        error
    }
}

fn named(mut error: Diagnostic, what: &str) -> Diagnostic {
    error.message = format!("{what}: {}", error.message);
    error
}

fn drawn(
    pattern: Pattern,
    recipe: &Recipe,
    room: Room,
    detail: Detail,
) -> Result<Drawn, Diagnostic> {
    let bed = Bed {
        length: room.length,
        detail,
        radius: None,
        lines: &[],
    };
    draw(pattern, recipe, room, &bed)
        .map_err(|e| Diagnostic::error(format!("the panel could not be drawn: {e}")))
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
