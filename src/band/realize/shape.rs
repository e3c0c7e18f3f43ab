//! From a sequence of pieces to polygons, whose components and holes are counted again by a sweep
//! that knows nothing of pieces (rule B7). A difference is an error, never a result.

use fretwork_geometry::budget;
use fretwork_geometry::cutout::roll;
use fretwork_geometry::neck::{self, Neck};
use fretwork_geometry::polygon::rounded;
use fretwork_geometry::{Point, Polygon, Topology, TopologyError, topology};

use super::assemble::{Linking, assemble};
use super::bed::Bed;
use super::placed::{Layout, Placed};
use super::warp::place;
use crate::exemplar::ends::EndPieces;
use crate::solve::pattern::Pattern;
use crate::solve::task::Sequence;

/// The polygons of a pattern.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// In the coordinates of the strip, or of the ring.
    pub polygons: Vec<Polygon>,
    /// The strip of a ring, cut open; empty for an open pattern.
    pub developed: Vec<Polygon>,
}

/// Why a sequence has no valid geometry.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ShapeError {
    /// The outlines cross.
    #[error(transparent)]
    Outline(#[from] TopologyError),
    /// The counts are not those of the sequence.
    #[error(
        "the final polygons have {components} components and {holes} holes, which were to be {wanted:?}"
    )]
    Counts {
        /// Components that were counted.
        components: usize,
        /// Holes that were counted.
        holes: usize,
        /// Components and holes of the sequence.
        wanted: (usize, usize),
    },
    /// Two pieces of the sequence cannot be neighbours.
    #[error("the sequence is broken")]
    Broken,
}

impl ShapeError {
    /// The place, if there is one.
    fn place(&self) -> Option<Point> {
        match self {
            ShapeError::Outline(error) => error.place(),
            ShapeError::Counts { .. } | ShapeError::Broken => None,
        }
    }
}

/// The geometry of a pattern, and the seams to blame where it is thin or invalid.
#[derive(Clone, Debug, PartialEq)]
pub struct Attempt {
    /// The polygons.
    pub shape: Result<Shape, ShapeError>,
    /// The narrowest place, if that is finer than it may be; also where no seam is to blame.
    pub thinnest: Option<Neck>,
    /// Pairs of pieces that should not follow one another, the worst first.
    pub weak: Vec<(usize, usize)>,
}

/// How many rounds leave only the seams unturned that are in the way, before all are. More rounds
/// keep more seams smooth; each costs as much as the first drawing.
const MENDINGS: usize = 4;

/// Bytes for a point of a piece while a pattern is drawn, and steps.
const POINT: usize = 200;
const POINT_STEPS: u64 = 100;

/// The polygons of `pattern`.
///
/// At first the tangents are made to agree at every seam. Where that lets outlines cross or come
/// too near to each other, the seams there are left unturned: their outlines stay as the map of
/// `warp` leaves them, which cannot cross. What is still thin is so because the pieces fit badly,
/// or because the exemplar is.
pub fn shape(pattern: &Pattern, bed: &Bed) -> Attempt {
    let closed = bed.radius.is_some();
    let Some(alignment) = pattern.alignment(closed) else {
        return Attempt {
            shape: Err(ShapeError::Broken),
            thinnest: None,
            weak: Vec::new(),
        };
    };
    let layout = Layout {
        pieces: &pattern.parts.pieces,
        sequence: &pattern.sequence.pieces,
        seams: &alignment.joints,
        offsets: &alignment.offsets,
        length: bed.length,
        closed,
        end_pieces: pattern.parts.end_pieces,
    };
    let points = |&piece: &usize| {
        let chains = &pattern.parts.pieces[piece].chains;
        chains.iter().map(|chain| chain.points.len()).sum::<usize>()
    };
    let points = pattern.sequence.pieces.iter().map(points).sum();
    budget::make("points of pieces", points, POINT);
    let mut turned = vec![true; alignment.joints.len()];
    if layout.end_pieces == EndPieces::Bars {
        // The two halves of a bar are level where they meet, and stay so.
        turned.iter_mut().take(1).for_each(|t| *t = false);
        turned.iter_mut().rev().take(1).for_each(|t| *t = false);
    }
    let mut mendings = 0;
    loop {
        budget::spend("points of pieces", POINT_STEPS * points as u64);
        let placed = place(&layout, &turned);
        let polygons = link(&placed, bed);
        let judged = judge(&polygons, &pattern.sequence, bed);
        let faults: Vec<f64> = match &judged {
            Ok(thin) => thin.iter().map(|neck| bed.along(neck.middle())).collect(),
            Err(error) => error.place().map(|p| bed.along(p)).into_iter().collect(),
        };
        if faults.is_empty() || turned.iter().all(|t| !t) {
            let thinnest = judged.as_ref().ok().and_then(|thin| thin.first().copied());
            return Attempt {
                weak: weak_pairs(&layout, &placed, &faults),
                shape: judged.map(|_| finish(placed, polygons, bed)),
                thinnest,
            };
        }
        mendings += 1;
        let before = turned.clone();
        for &at in &faults {
            leave_unturned(&mut turned, &placed, at);
        }
        if mendings >= MENDINGS || turned == before {
            turned.fill(false);
        }
    }
}

/// The places where the polygons are too thin, the narrowest first. An error where they are not
/// those of the sequence, as they are or as files will hold them.
fn judge(polygons: &[Polygon], sequence: &Sequence, bed: &Bed) -> Result<Vec<Neck>, ShapeError> {
    let verify_all = || {
        verify(polygons, sequence)?;
        verify(&rounded(polygons, bed.detail.steps), sequence)
    };
    let (verified, mut thin) = rayon::join(verify_all, || neck::below(polygons, bed.detail.finest));
    verified?;
    thin.sort_by(|a, b| a.width.total_cmp(&b.width));
    Ok(thin)
}

/// Counts components and holes again.
fn verify(polygons: &[Polygon], sequence: &Sequence) -> Result<(), ShapeError> {
    let Topology { components, holes } = topology::count(polygons)?;
    let around = sequence.around as usize;
    let wanted = (
        sequence.components as usize,
        sequence.holes as usize + around,
    );
    let encircling = if around > 0 { encircling(polygons) } else { 0 };
    if (components, holes) == wanted && encircling == around {
        return Ok(());
    }
    Err(ShapeError::Counts {
        components,
        holes,
        wanted,
    })
}

/// How many polygons run round the origin.
fn encircling(polygons: &[Polygon]) -> usize {
    let runs_round = |p: &&Polygon| {
        let whole = Polygon {
            outer: p.outer.clone(),
            holes: Vec::new(),
        };
        whole.contains(Point::ORIGIN) && !p.contains(Point::ORIGIN)
    };
    polygons.iter().filter(runs_round).count()
}

/// The pairs of pieces to blame for faults at these places, each pair once.
fn weak_pairs(layout: &Layout, placed: &[Placed], faults: &[f64]) -> Vec<(usize, usize)> {
    let mut weak: Vec<(usize, usize)> = Vec::new();
    for pair in faults.iter().filter_map(|&at| blamed(layout, placed, at)) {
        if !weak.contains(&pair) {
            weak.push(pair);
        }
    }
    weak
}

/// The seams before and after the piece at `u`.
fn seams_at(placed: &[Placed], u: f64) -> [usize; 2] {
    let n = placed.len();
    let k = placed.partition_point(|p| p.span[1] < u).min(n - 1);
    [(k + n - 1) % n, k]
}

/// The two pieces at the dearer seam of the piece at `u`; none where both seams are those of the
/// exemplar itself.
fn blamed(layout: &Layout, placed: &[Placed], u: f64) -> Option<(usize, usize)> {
    let has_cost = |&seam: &usize| layout.seams.get(seam).is_some_and(|s| s.cost > 0.0);
    let candidates = seams_at(placed, u).into_iter().filter(has_cost);
    let dearest =
        candidates.max_by(|&a, &b| layout.seams[a].cost.total_cmp(&layout.seams[b].cost))?;
    let next = (dearest + 1) % placed.len();
    Some((layout.sequence[dearest], layout.sequence[next]))
}

/// Leaves the seams of the piece at `u` unturned.
fn leave_unturned(turned: &mut [bool], placed: &[Placed], u: f64) {
    for seam in seams_at(placed, u) {
        if let Some(t) = turned.get_mut(seam) {
            *t = false;
        }
    }
}

fn finish(placed: Vec<Placed>, polygons: Vec<Polygon>, bed: &Bed) -> Shape {
    let cut_open = Linking {
        period: None,
        divide: &|_, _, _| {},
        map: &|p| p,
    };
    let developed = match bed.radius {
        Some(_) => assemble(&placed, &cut_open),
        None => Vec::new(),
    };
    Shape {
        polygons,
        developed,
    }
}

/// Links the outlines, on the strip or on the ring.
fn link(placed: &[Placed], bed: &Bed) -> Vec<Polygon> {
    let divide = |a: Point, b: Point, out: &mut Vec<Point>| bed.divide(a, b, out);
    let strip = Linking {
        period: None,
        divide: &divide,
        map: &|p| p,
    };
    let Some(radius) = bed.radius else {
        return assemble(placed, &strip);
    };
    let map = |p: Point| roll(p.x, p.y, radius, bed.length);
    let ring = Linking {
        period: Some(bed.length),
        map: &map,
        ..strip
    };
    assemble(placed, &ring)
}
