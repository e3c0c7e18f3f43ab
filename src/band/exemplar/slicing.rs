//! Where an exemplar is cut (Zhou 2014, sections 3.3 and 5): midway between the places where its
//! topology changes, or at equal distances. The cutting itself is in `piece`.

use fretwork_geometry::Bounds;
use fretwork_geometry::polygon::signed_area;
use fretwork_language::kinds::bands::Slicing;

use super::error::{ExemplarWarning, SlicingError};
use super::normalize::Exemplar;
use super::piece::{CutError, Piece, cut};

/// How an exemplar is cut into pieces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cutting {
    /// Midway between events, or at equal distances.
    pub slicing: Slicing,
    /// Events closer than this part of the exemplar's width are one group; topology slicing only.
    pub event_tolerance: f64,
    /// Cuts through portals narrower than this are not made.
    pub min_portal: f64,
}

/// How many cuts an exemplar without inner events gets: eight pieces are enough to meet a length
/// within 5 %, and few enough to keep long runs of the exemplar together.
pub const FALLBACK_CUTS: usize = 7;
/// A table of the solver keeps the choice of the next piece in a byte, of which it needs two values
/// for itself; a few more are left free.
pub const MOST_PIECES: usize = 250;

/// Cuts `exemplar` into pieces.
///
/// Topology slicing (section 5.2) takes the local extrema of the outline along u, which is where a
/// column of the shape splits, merges, begins or ends. They are found on the polygons, not in an
/// image. Events closer than the tolerance are grouped (5.2.2). A cut stands midway between the
/// means of neighbouring groups, but always between the last event of the one and the first event
/// of the other. A group that changes nothing in sum is noise, and is left out. A component that
/// would lie within one piece is cut through its middle. An exemplar without an event between its
/// ends is cut uniformly, with a warning.
///
/// # Errors
/// More pieces than there may be.
pub fn slice(
    exemplar: &Exemplar,
    cutting: &Cutting,
) -> Result<(Vec<Piece>, Vec<ExemplarWarning>), SlicingError> {
    let mut warnings = Vec::new();
    let cuts = match cutting.slicing {
        Slicing::Uniform(lines) => uniform_cuts(exemplar, lines.0 as usize)?,
        Slicing::Topology => match topological_cuts(exemplar, cutting.event_tolerance) {
            Some(cuts) => cuts,
            None => {
                warnings.push(ExemplarWarning::Unchanging(FALLBACK_CUTS));
                uniform_cuts(exemplar, FALLBACK_CUTS)?
            }
        },
    };
    if cuts.len() >= MOST_PIECES {
        return Err(SlicingError::TooManyPieces {
            pieces: cuts.len() + 1,
            most: MOST_PIECES,
        });
    }
    let (cuts, pieces) = cut_beside(exemplar, cuts);
    let portals = pieces.iter().skip(1).map(Piece::narrowest_left_portal);
    let wide: Vec<f64> = cuts
        .iter()
        .zip(portals)
        .filter(|(_, portal)| *portal >= cutting.min_portal)
        .map(|(&c, _)| c)
        .collect();
    if wide.len() == cuts.len() {
        return Ok((pieces, warnings));
    }
    if wide.is_empty() {
        warnings.push(ExemplarWarning::NoWideCut(cutting.min_portal));
    }
    Ok((cut_beside(exemplar, wide).1, warnings))
}

/// Events that are close together: their extent and their mean.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Group {
    first: f64,
    last: f64,
    mean: f64,
}

/// The local extrema of the contours along u, in ascending order. A run of points with one u is a
/// single extremum.
fn events(exemplar: &Exemplar) -> Vec<f64> {
    let mut events = Vec::new();
    for contour in &exemplar.contours {
        let n = contour.len();
        let rises = |i: usize| contour[(i + 1) % n].x.partial_cmp(&contour[i % n].x);
        let moves = |i: usize| rises(i).is_some_and(|o| o.is_ne());
        let Some(start) = (0..n).find(|&i| moves(i)) else {
            continue;
        };
        let mut direction = rises(start);
        for i in start + 1..=start + n {
            if moves(i) && rises(i) != direction {
                direction = rises(i);
                events.push(contour[i % n].x);
            }
        }
    }
    events.sort_by(f64::total_cmp);
    events
}

/// Groups of events, each within `reach` of the one before it.
fn group(events: &[f64], reach: f64) -> Vec<Group> {
    let of = |run: &[f64]| Group {
        first: run[0],
        last: run[run.len() - 1],
        mean: run.iter().sum::<f64>() / run.len() as f64,
    };
    events.chunk_by(|a, b| b - a <= reach).map(of).collect()
}

/// The middle between the means of two groups. It keeps a distance of a quarter of the room between
/// the groups from either of them.
fn middle(a: &Group, b: &Group) -> f64 {
    let quarter = 0.25 * (b.first - a.last);
    (0.5 * (a.mean + b.mean)).clamp(a.last + quarter, b.first - quarter)
}

/// The cuts of topology slicing; none where the exemplar has no event between its ends.
fn topological_cuts(exemplar: &Exemplar, event_tolerance: f64) -> Option<Vec<f64>> {
    let mut groups = group(&events(exemplar), event_tolerance * exemplar.width);
    let cuts_of = |groups: &[Group]| {
        groups
            .windows(2)
            .map(|w| middle(&w[0], &w[1]))
            .collect::<Vec<f64>>()
    };
    let (cuts, pieces) = cut_beside(exemplar, cuts_of(&groups));
    if cuts.len() + 1 != groups.len() {
        return Some(cuts);
    }
    let last = groups.len().saturating_sub(1);
    groups = groups
        .into_iter()
        .enumerate()
        .filter(|&(i, _)| i == 0 || i == last || !pieces[i].is_trivial())
        .map(|(_, g)| g)
        .collect();
    if groups.len() < 3 {
        return None;
    }
    let mut cuts = cuts_of(&groups);
    let (clean, pieces) = cut_beside(exemplar, cuts);
    cuts = clean;
    cuts.extend(island_cuts(&pieces, &cuts));
    cuts.sort_by(f64::total_cmp);
    Some(cuts)
}

/// Cuts through the middle of each component that reaches none of `cuts`.
fn island_cuts(pieces: &[Piece], cuts: &[f64]) -> Vec<f64> {
    let mut through: Vec<f64> = Vec::new();
    for (i, piece) in pieces.iter().enumerate() {
        let left = if i == 0 { 0.0 } else { cuts[i - 1] };
        for ring in piece.rings.iter().filter(|ring| signed_area(ring) > 0.0) {
            let bounds = Bounds::of(ring.iter().copied());
            let (lo, hi) = (left + bounds.min.x, left + bounds.max.x);
            if !through.iter().any(|&c| lo < c && c < hi) {
                through.push(0.5 * (lo + hi));
            }
        }
    }
    through
}

fn uniform_cuts(exemplar: &Exemplar, lines: usize) -> Result<Vec<f64>, SlicingError> {
    if lines >= MOST_PIECES {
        return Err(SlicingError::TooManyLines {
            lines,
            most: MOST_PIECES,
        });
    }
    Ok((1..=lines)
        .map(|i| exemplar.width * i as f64 / (lines + 1) as f64)
        .collect())
}

/// Cuts at `cuts`. A cut that would meet a corner of the outline is moved a little. Returns where
/// the cuts were made, and the pieces, of which there is one more.
fn cut_beside(exemplar: &Exemplar, mut cuts: Vec<f64>) -> (Vec<f64>, Vec<Piece>) {
    // The steps grow and change sides. The cut that has to move farthest moves by 10^-4 of the
    // width, which nobody sees.
    for step in 1..256 {
        match cut(&exemplar.contours, exemplar.width, &cuts) {
            Ok(pieces) => return (cuts, pieces),
            Err(CutError::Corner(bad)) => {
                let shift = exemplar.width
                    * 4e-7
                    * f64::from(step)
                    * if step % 2 == 0 { 1.0 } else { -1.0 };
                cuts.iter_mut()
                    .filter(|c| **c == bad)
                    .for_each(|c| *c += shift);
            }
        }
    }
    // Where there are corners everywhere, the exemplar is not cut.
    cuts.retain(|&c| cut(&exemplar.contours, exemplar.width, &[c]).is_ok());
    let pieces = cut(&exemplar.contours, exemplar.width, &cuts).unwrap_or_default();
    (cuts, pieces)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::{Point, Polygon};
    use fretwork_language::scalar::Count;

    fn polygon(points: &[[f64; 2]], holes: &[&[[f64; 2]]]) -> Polygon {
        let ring = |points: &[[f64; 2]]| points.iter().map(|&p| Point::from(p)).collect();
        Polygon {
            outer: ring(points),
            holes: holes.iter().map(|h| ring(h)).collect(),
        }
    }

    fn exemplar(area: &[Polygon]) -> Exemplar {
        Exemplar::new(area).unwrap().0
    }

    /// A ladder 100 by 10 with holes of width 10 at these places.
    fn ladder(holes: &[f64]) -> Exemplar {
        let rings: Vec<[[f64; 2]; 4]> = holes
            .iter()
            .map(|&x| [[x, 2.0], [x, 8.0], [x + 10.0, 8.0], [x + 10.0, 2.0]])
            .collect();
        let holes: Vec<&[[f64; 2]]> = rings.iter().map(|h| &h[..]).collect();
        exemplar(&[polygon(
            &[[0., 0.], [100., 0.], [100., 10.], [0., 10.]],
            &holes,
        )])
    }

    fn cutting(slicing: Slicing, min_portal: f64) -> Cutting {
        Cutting {
            slicing,
            event_tolerance: 0.02,
            min_portal,
        }
    }

    fn topology(min_portal: f64) -> Cutting {
        cutting(Slicing::Topology, min_portal)
    }

    fn uniform(lines: u32) -> Cutting {
        cutting(Slicing::Uniform(Count(lines)), 0.0)
    }

    fn widths(pieces: &[Piece]) -> Vec<f64> {
        pieces.iter().map(|p| p.width).collect()
    }

    #[test]
    fn cuts_stand_midway_between_events() {
        let (pieces, warnings) = slice(&ladder(&[20.0, 60.0]), &topology(0.0)).unwrap();
        assert!(warnings.is_empty());
        assert_eq!(widths(&pieces), [10.0, 15.0, 20.0, 20.0, 20.0, 15.0]);
        let changes: Vec<_> = pieces
            .iter()
            .map(|p| (p.left.len() / 2, p.right.len() / 2))
            .collect();
        assert_eq!(changes, [(0, 1), (1, 2), (2, 1), (1, 2), (2, 1), (1, 0)]);
    }

    #[test]
    fn near_events_are_grouped_and_cuts_stay_between_groups() {
        // The bar between the holes is 1.5 thick: within the tolerance of 2.
        let (pieces, _) = slice(&ladder(&[20.0, 31.5]), &topology(0.0)).unwrap();
        assert_eq!(widths(&pieces), [10.0, 15.375, 10.75, 34.625, 29.25]);
        let uneven = [
            Group {
                first: 0.0,
                last: 8.0,
                mean: 1.0,
            },
            Group {
                first: 10.0,
                last: 10.0,
                mean: 10.0,
            },
        ];
        assert_eq!(middle(&uneven[0], &uneven[1]), 8.5);
    }

    #[test]
    fn thin_necks_are_not_cut() {
        let (pieces, _) = slice(&ladder(&[20.0, 60.0]), &topology(3.0)).unwrap();
        assert!(
            pieces.iter().all(|p| p.left.len() <= 2),
            "the rails are 2 wide"
        );
        let (one, warnings) = slice(&ladder(&[20.0]), &topology(30.0)).unwrap();
        assert_eq!((one.len(), warnings.len()), (1, 1));
    }

    #[test]
    fn stripes_are_cut_uniformly_with_a_warning() {
        let bar = |y: f64| polygon(&[[0., y], [80., y], [80., y + 2.], [0., y + 2.]], &[]);
        let (pieces, warnings) = slice(&exemplar(&[bar(0.0), bar(5.0)]), &topology(0.0)).unwrap();
        assert_eq!((pieces.len(), warnings.len()), (FALLBACK_CUTS + 1, 1));
        let (pieces, warnings) = slice(&ladder(&[20.0]), &uniform(3)).unwrap();
        assert_eq!((widths(&pieces), warnings.len()), (vec![25.0; 4], 0));
        assert!(slice(&ladder(&[20.0]), &uniform(1000)).is_err());
    }

    #[test]
    fn dots_smaller_than_the_tolerance_are_cut_through() {
        let dot = polygon(&[[50., 4.], [51., 4.], [51., 5.], [50., 5.]], &[]);
        let bar = polygon(&[[0., 0.], [100., 0.], [100., 2.], [0., 2.]], &[]);
        let fork = polygon(&[[30., 7.], [60., 7.], [60., 8.], [30., 8.]], &[]);
        let (pieces, _) = slice(&exemplar(&[bar, dot, fork]), &topology(0.0)).unwrap();
        assert!(pieces.iter().all(|p| p.descriptor.components == 0));
        assert!(pieces.iter().any(|p| p.left.len() == 6));
    }

    #[test]
    fn a_bump_that_changes_nothing_is_no_group() {
        // The outline overhangs at x = 50: a split and a merge one unit apart on the upper side.
        let bump = [
            [0., 0.],
            [100., 0.],
            [100., 4.],
            [50.5, 4.],
            [51.2, 6.],
            [48., 6.],
            [49.5, 4.],
            [0., 4.],
        ];
        let (pieces, warnings) = slice(&exemplar(&[polygon(&bump, &[])]), &topology(0.0)).unwrap();
        assert_eq!((pieces.len(), warnings.len()), (FALLBACK_CUTS + 1, 1));
    }
}
