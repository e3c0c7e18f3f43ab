//! The exemplar in the axes of a band (Zhou 2014, section 3.2): u to the right from its left end,
//! v up as drawn from the middle of its height, contours with the interior on their left. Where
//! it is cut is decided elsewhere.

use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::drawing::Join;
use fretwork_geometry::neck;
use fretwork_geometry::polygon::{AreaError, offset, signed_area, unite};
use fretwork_geometry::{Bounds, Point, Polygon, Ring, TopologyError, topology};

/// A vector shape ready to be cut into pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct Exemplar {
    /// Simple rings that do not touch, the interior on their left.
    pub contours: Vec<Ring>,
    /// Extent along u, which begins at 0.
    pub width: f64,
    /// Extent along v, whose middle is 0.
    pub height: f64,
}

impl Exemplar {
    /// The shape of `area`, which is in the drawing plane (y down). Contours that cross are repaired by taking what lies in any
    /// polygon, with a warning.
    ///
    /// # Errors
    /// An exemplar without area, or with coordinates that are not numbers.
    pub fn new(area: &[Polygon]) -> Result<(Exemplar, Vec<Diagnostic>), Diagnostic> {
        let (repaired, warnings) = match topology::count(area) {
            Ok(_) if !is_frail(area, THREAD * MENDED[0] * side(area)) => (None, Vec::new()),
            // Frail parts stay as they are where they cannot be mended.
            Ok(_) => mended(area, None).map_or((None, Vec::new()), |(area, warnings)| {
                (Some(area), warnings)
            }),
            Err(error) => {
                mended(area, Some(error)).map(|(area, warnings)| (Some(area), warnings))?
            }
        };
        let area = repaired.as_deref().unwrap_or(area);
        let bounds = area.iter().fold(Bounds::EMPTY, |b, p| b.union(p.bounds()));
        let total: f64 = area.iter().map(Polygon::area).sum();
        if !(total > 1e-9 * bounds.width() * bounds.height() && total.is_finite()) {
            return Err(Diagnostic::error("the exemplar has no area")
                .help("bands are made of filled shapes or of strokes with a width"));
        }
        let center = bounds.center().y;
        let place = |p: &Point| Point::new(p.x - bounds.min.x, center - p.y);
        let speck = 1e-10 * bounds.width() * bounds.height();
        let contours: Vec<Ring> = area
            .iter()
            .flat_map(Polygon::rings)
            .map(|ring| separated(ring.iter().rev().map(place).collect()))
            .filter(|ring| signed_area(ring).abs() > speck)
            .collect();
        if let Err(error) = topology::count_rings(&contours) {
            return Err(Diagnostic::error(format!(
                "the exemplar cannot be cut into pieces: {error}"
            )));
        }
        Ok((
            Exemplar {
                contours,
                width: bounds.width(),
                height: bounds.height(),
            },
            warnings,
        ))
    }

    /// The same, larger by a factor.
    pub fn scaled(&self, factor: f64) -> Exemplar {
        let ring = |contour: &Ring| contour.iter().map(|&p| p * factor).collect();
        let contours = self.contours.iter().map(ring).collect();
        Exemplar {
            contours,
            width: self.width * factor,
            height: self.height * factor,
        }
    }

    /// The least width that necks and gaps of a pattern in a band of this height should keep: a part of the height, but not
    /// more than most of what the exemplar itself has at its narrowest.
    pub fn finest(&self, height: f64) -> f64 {
        let whole = FRAGILE * height;
        let ring = |contour: &Ring| Polygon {
            outer: contour.clone(),
            holes: Vec::new(),
        };
        let area: Vec<Polygon> = self.contours.iter().map(ring).collect();
        neck::below(&area, whole / KEPT)
            .into_iter()
            .map(|neck| KEPT * neck.width)
            .fold(whole, f64::min)
    }
}

/// Gaps and necks below this part of a band's height are mended where that is possible.
const FRAGILE: f64 = 4e-3;
/// This part of what the exemplar has at its narrowest is enough.
const KEPT: f64 = 0.8;
/// Parts nearer than this part of the drawing's longer side are one after a repair, at first and where that leaves them hanging
/// by a thread.
const MENDED: [f64; 2] = [2e-6, 1e-3];
/// What a repair adds to all outlines, as a part of its reach, so that what touched overlaps.
const GROWN: f64 = 0.4;
/// A thread, in units of what is mended.
const THREAD: f64 = 20.0;

fn side(area: &[Polygon]) -> f64 {
    area.iter()
        .fold(Bounds::EMPTY, |b, p| b.union(p.bounds()))
        .longer_side()
}

/// Whether parts hang together by less than `width`, or are less than that apart.
fn is_frail(area: &[Polygon], width: f64) -> bool {
    !neck::below(area, width).is_empty()
}

/// What lies in any polygon, as simple rings that do not touch: slits are closed, and what touches is joined.
fn mended(
    area: &[Polygon],
    error: Option<TopologyError>,
) -> Result<(Vec<Polygon>, Vec<Diagnostic>), Diagnostic> {
    let failed = |e: AreaError| Diagnostic::error(format!("the exemplar cannot be used: {e}"));
    let place = error.and_then(|e| e.place());
    let near = place.map_or(String::new(), |p| format!(" near ({:.3}, {:.3})", p.x, p.y));
    let total = |area: &[Polygon]| area.iter().map(Polygon::area).sum::<f64>();
    let united = unite(area).map_err(failed)?;
    let mut warnings = Vec::new();
    // Touching outlines alone are how areas come out of unions.
    if (total(area) - total(&united)).abs() > 1e-6 * total(&united) {
        let message = format!("the exemplar's outline crosses or touches itself{near}");
        warnings
            .push(Diagnostic::warning(message).help("what lies inside by the fill rule is used"));
    }
    let mut last = None;
    for (round, reach) in MENDED
        .map(|part| part * side(&united))
        .into_iter()
        .enumerate()
    {
        let is_last = round + 1 == MENDED.len();
        let mut mended = united.clone();
        if topology::count(&united).is_ok() && !is_frail(&united, THREAD * reach) {
            return Ok((united, warnings));
        }
        for by in [reach, (GROWN - 1.0) * reach] {
            mended = offset(&mended, by, Join::Miter(4.0), 0.1 * reach).map_err(failed)?;
        }
        if topology::count(&mended).is_err() {
            continue;
        }
        if !is_last && is_frail(&mended, THREAD * reach) {
            last = Some(mended);
            continue;
        }
        if is_last {
            let message = format!("parts of the exemplar touch{near}, or nearly so");
            warnings.push(
                Diagnostic::warning(message)
                    .help("they are joined; let them overlap, or part them"),
            );
        }
        return Ok((mended, warnings));
    }
    let failed = || {
        Diagnostic::error(format!(
            "the exemplar cannot be cut into pieces: its outline touches itself{near}"
        ))
    };
    last.map(|area| (area, warnings)).ok_or_else(failed)
}

/// The ring without repeated points.
fn separated(mut ring: Ring) -> Ring {
    ring.dedup();
    while ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
    ring
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rectangle(x: f64, y: f64, w: f64, h: f64) -> Polygon {
        let corners = [[x, y], [x + w, y], [x + w, y + h], [x, y + h]];
        Polygon {
            outer: corners.map(Point::from).to_vec(),
            holes: vec![],
        }
    }

    #[test]
    fn up_is_up_as_drawn_and_the_interior_is_on_the_left() {
        let (exemplar, warnings) = Exemplar::new(&[rectangle(10.0, 10.0, 30.0, 2.0)]).unwrap();
        let exemplar = exemplar.scaled(2.0);
        assert!(warnings.is_empty());
        assert_eq!((exemplar.width, exemplar.height), (60.0, 4.0));
        assert_eq!(signed_area(&exemplar.contours[0]), 240.0);
        assert!(exemplar.contours[0].contains(&Point::new(0.0, 2.0)));
    }

    #[test]
    fn overlaps_are_united_with_a_warning() {
        let (exemplar, warnings) = Exemplar::new(&[
            rectangle(0.0, 0.0, 10.0, 4.0),
            rectangle(5.0, 1.0, 10.0, 2.0),
        ])
        .unwrap();
        assert_eq!((exemplar.contours.len(), warnings.len()), (1, 1));
        assert_eq!(signed_area(&exemplar.contours[0]), 50.0);
    }

    #[test]
    fn parts_that_touch_in_a_point_are_joined_with_a_warning() {
        let board = [rectangle(0.0, 0.0, 5.0, 5.0), rectangle(5.0, 5.0, 5.0, 5.0)];
        let (exemplar, warnings) = Exemplar::new(&board).unwrap();
        assert_eq!(
            topology::count_rings(&exemplar.contours)
                .unwrap()
                .components,
            1
        );
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        let total: f64 = exemplar.contours.iter().map(|r| signed_area(r)).sum();
        assert!((total - 50.0).abs() < 0.3);
    }

    #[test]
    fn crossing_strokes_are_an_exemplar() {
        // Wheels whose spokes end on their rims: the union's rings touch.
        use fretwork_geometry::drawing::{Drawing, Shape, Stroke};
        use fretwork_geometry::{FillRule, LabelSet};
        let at = |c: f64, r: f64, a: f64| Point::new(c, 9.0) + Point::unit(a) * r;
        let circle = |c: f64, r: f64| {
            (0..=40)
                .map(|i| at(c, r, f64::from(i) * 0.157_079_632_679))
                .collect()
        };
        let mut paths: Vec<Vec<Point>> = Vec::new();
        for k in 0..6 {
            let c = 8.0 + 11.0 * f64::from(k);
            paths.extend([circle(c, 5.0), circle(c, 2.2), circle(c + 5.5, 1.6)]);
            paths.extend(
                (0..5)
                    .map(|j| 1.2566 * f64::from(j) + 0.3 * f64::from(k))
                    .map(|a| vec![at(c, 2.2, a), at(c, 5.0, a)]),
            );
        }
        let shape = Shape {
            label: LabelSet::EMPTY,
            paths,
            filled: false,
            rule: FillRule::NonZero,
            stroke: Some(Stroke::round(0.9)),
        };
        let area = Drawing {
            shapes: vec![shape],
            points: vec![],
        }
        .areas(0.05)
        .unwrap();
        let (exemplar, warnings) = Exemplar::new(&area).unwrap();
        assert_eq!(warnings, []);
        assert_eq!(
            topology::count_rings(&exemplar.contours)
                .unwrap()
                .components,
            1
        );
    }

    #[test]
    fn nothing_is_no_exemplar() {
        assert!(Exemplar::new(&[]).is_err());
        assert!(Exemplar::new(&[rectangle(0.0, 0.0, 4.0, 0.0)]).is_err());
        assert!(Exemplar::new(&[rectangle(0.0, 0.0, f64::NAN, 1.0)]).is_err());
        assert!(Exemplar::new(&[rectangle(0.0, 0.0, f64::INFINITY, 1.0)]).is_err());
    }
}
