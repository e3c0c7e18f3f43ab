//! From a sequence of pieces to polygons whose components and holes are counted again, by a
//! sweep that knows nothing of pieces (B7). A difference is an error, never a result.

use fretwork_geometry::cutout::roll;
use fretwork_geometry::neck::{self, Neck};
use fretwork_geometry::polygon::rounded;
use fretwork_geometry::{Point, Polygon, Topology, TopologyError, topology};

use crate::realize::assemble::{Linking, assemble};
use crate::realize::warp::{Layout, Placed, stitch};
use crate::solve::least_squares_offsets::settled;
use crate::solve::pattern::Pattern;
use crate::solve::search::joints;

/// Where a pattern is laid.
#[derive(Clone, Debug, PartialEq)]
pub struct Bed<'a> {
    /// The length of the curve.
    pub length: f64,
    /// How fine it may be.
    pub detail: Detail,
    /// The radius at which a closed curve's strip is laid as a ring; none for an open one.
    pub radius: Option<f64>,
    /// Places along the curve where edges are divided, in order; on a closed one from 0 to before its length.
    pub lines: &'a [f64],
}

/// How fine a pattern may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detail {
    /// Necks and gaps narrower than this are mended where that is possible.
    pub finest: f64,
    /// Steps of the coordinates in files that make a unit: the counts hold in these as well.
    pub steps: f64,
}

/// The polygons of a pattern.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shaped {
    /// In the coordinates of the strip, or of the ring.
    pub polygons: Vec<Polygon>,
    /// The strip of a ring, cut open; empty for an open one.
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
        /// Counted.
        components: usize,
        /// Counted.
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

/// The geometry of a pattern, and the seams that are to blame where it is thin or cannot be.
#[derive(Clone, Debug, PartialEq)]
pub struct Attempt {
    /// The polygons.
    pub shaped: Result<Shaped, ShapeError>,
    /// Its narrowest place, if that is finer than it may be; also where no seam is to blame.
    pub thinnest: Option<Neck>,
    /// Pairs of pieces that should not follow one another, the worst first.
    pub weak: Vec<(usize, usize)>,
}

/// How often seams that are in the way are left unturned before all are.
const MENDINGS: usize = 4;

/// The polygons of `pattern`. Where turned tangents make outlines cross or come too near, those seams keep the
/// outlines as the order-keeping map leaves them.
pub fn shape(pattern: &Pattern, bed: &Bed) -> Attempt {
    let sequence = &pattern.sequence;
    let closed = bed.radius.is_some();
    let Some(seams) = joints(&pattern.parts.seams, &sequence.pieces, closed) else {
        return Attempt {
            shaped: Err(ShapeError::Broken),
            thinnest: None,
            weak: Vec::new(),
        };
    };
    let offsets = settled(&pattern.parts.pieces, &sequence.pieces, &seams, closed);
    let layout = Layout {
        pieces: &pattern.parts.pieces,
        sequence: &sequence.pieces,
        seams: &seams,
        offsets: &offsets,
        length: bed.length,
        closed,
    };
    let mut turned = vec![true; seams.len()];
    let mut mendings = 0;
    loop {
        let placed = stitch(&layout, &turned);
        let polygons = lay(&placed, bed);
        let judged = judged(&polygons, pattern, bed);
        let places: Vec<f64> = match &judged {
            Ok(thin) => thin.iter().map(|neck| along(neck.middle(), bed)).collect(),
            Err(error) => error.place().map(|p| along(p, bed)).into_iter().collect(),
        };
        // What is thin without any turn is so because the pieces fit badly, or in the exemplar.
        if places.is_empty() || turned.iter().all(|t| !t) {
            let mut weak: Vec<(usize, usize)> = Vec::new();
            for pair in places.iter().filter_map(|&at| blamed(&layout, &placed, at)) {
                if !weak.contains(&pair) {
                    weak.push(pair);
                }
            }
            let thinnest = judged.as_ref().ok().and_then(|thin| thin.first().copied());
            return Attempt {
                shaped: judged.map(|_| finish(placed, polygons, bed)),
                thinnest,
                weak,
            };
        }
        mendings += 1;
        let before = turned.clone();
        places
            .iter()
            .for_each(|&at| leave(&mut turned, &placed, at));
        if mendings >= MENDINGS || turned == before {
            turned.fill(false);
        }
    }
}

/// The places where the polygons are too thin, the narrowest first; an error where they, as they are or as files will hold
/// them, are not those of the pattern.
fn judged(polygons: &[Polygon], pattern: &Pattern, bed: &Bed) -> Result<Vec<Neck>, ShapeError> {
    let verify_all = || {
        verify(polygons, pattern)
            .and_then(|()| verify(&rounded(polygons, bed.detail.steps), pattern))
    };
    let (verified, mut thin) = rayon::join(verify_all, || neck::below(polygons, bed.detail.finest));
    verified?;
    thin.sort_by(|a, b| a.width.total_cmp(&b.width));
    Ok(thin)
}

/// The pieces at the dearer seam of the piece at `u`; none where both are seams of the exemplar itself.
fn blamed(layout: &Layout, placed: &[Placed], u: f64) -> Option<(usize, usize)> {
    let n = placed.len();
    let k = placed.partition_point(|p| p.span[1] < u).min(n - 1);
    let candidates = [(k + n - 1) % n, k]
        .into_iter()
        .filter(|&seam| layout.seams.get(seam).is_some_and(|s| s.cost > 0.0));
    let dearest =
        candidates.max_by(|&a, &b| layout.seams[a].cost.total_cmp(&layout.seams[b].cost))?;
    Some((layout.sequence[dearest], layout.sequence[(dearest + 1) % n]))
}

/// Leaves the seams of the piece at `u` unturned.
fn leave(turned: &mut [bool], placed: &[Placed], u: f64) {
    let n = placed.len();
    let k = placed.partition_point(|p| p.span[1] < u).min(n - 1);
    for seam in [(k + n - 1) % n, k] {
        if let Some(t) = turned.get_mut(seam) {
            *t = false;
        }
    }
}

fn finish(placed: Vec<Placed>, polygons: Vec<Polygon>, bed: &Bed) -> Shaped {
    let cut_open = Linking {
        period: None,
        divide: &|_, _, _| {},
        map: &|p| p,
    };
    let developed = if bed.radius.is_some() {
        assemble(&placed, &cut_open)
    } else {
        Vec::new()
    };
    Shaped {
        polygons,
        developed,
    }
}

/// Links the outlines, on the strip or on the ring.
fn lay(placed: &[Placed], bed: &Bed) -> Vec<Polygon> {
    let divide = |a: Point, b: Point, out: &mut Vec<Point>| divide(a, b, bed, out);
    match bed.radius {
        Some(radius) => {
            let map = |p: Point| roll(p.x, p.y, radius, bed.length);
            assemble(
                placed,
                &Linking {
                    period: Some(bed.length),
                    divide: &divide,
                    map: &map,
                },
            )
        }
        None => assemble(
            placed,
            &Linking {
                period: None,
                divide: &divide,
                map: &|p| p,
            },
        ),
    }
}

/// Adds the places where the edge from `a` to `b` crosses lines of the bed, which come again in every turn of a loop.
fn divide(a: Point, b: Point, bed: &Bed, out: &mut Vec<Point>) {
    let (low, high) = (a.x.min(b.x), a.x.max(b.x));
    // An edge with a joint within rounding of its end is not divided there.
    let clear = 1e-9 * bed.length;
    let mut places: Vec<f64> = Vec::new();
    let turn = |x: f64| {
        if bed.radius.is_some() {
            (x / bed.length).floor()
        } else {
            0.0
        }
    };
    let mut shift = turn(low) * bed.length;
    while shift <= turn(high) * bed.length {
        let from = bed.lines.partition_point(|&l| l + shift <= low + clear);
        let to = bed.lines.partition_point(|&l| l + shift < high - clear);
        places.extend(bed.lines[from..to.max(from)].iter().map(|l| l + shift));
        shift += bed.length;
    }
    if a.x > b.x {
        places.reverse();
    }
    out.extend(
        places
            .into_iter()
            .map(|x| Point::new(x, a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x))),
    );
}

/// Counts again.
fn verify(polygons: &[Polygon], pattern: &Pattern) -> Result<(), ShapeError> {
    let Topology { components, holes } = topology::count(polygons)?;
    let sequence = &pattern.sequence;
    let wanted = (
        sequence.components as usize,
        (sequence.holes + sequence.around) as usize,
    );
    let encircling = if sequence.around > 0 {
        encircling(polygons)
    } else {
        0
    };
    if (components, holes) == wanted && encircling == sequence.around as usize {
        return Ok(());
    }
    Err(ShapeError::Counts {
        components,
        holes,
        wanted,
    })
}

/// How many polygons run round the origin.
pub fn encircling(polygons: &[Polygon]) -> usize {
    let round = |p: &&Polygon| {
        let whole = Polygon {
            outer: p.outer.clone(),
            holes: Vec::new(),
        };
        whole.contains(Point::ORIGIN) && !p.contains(Point::ORIGIN)
    };
    polygons.iter().filter(round).count()
}

/// The place along the curve of a point of the bed.
pub fn along(p: Point, bed: &Bed) -> f64 {
    if bed.radius.is_none() {
        return p.x;
    }
    let turn = libm::atan2(-p.y, p.x) / std::f64::consts::TAU;
    bed.length * if turn < 0.0 { turn + 1.0 } else { turn }
}
