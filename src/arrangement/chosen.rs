//! Faces of a planar map chosen by their labels, as one region. What makes regions of other things is not here.

use std::collections::BTreeSet;
use std::sync::Arc;

use rayon::prelude::*;

use crate::border::Border;
use crate::error::ArrangementError;
use crate::function::Arrangement;
use crate::mask;
use crate::place::elements::has_any;
use crate::place::transform::inset;
use fretwork_geometry::budget::Meter;
use fretwork_geometry::planar_map::{FaceId, HalfEdge, PlanarMap};
use fretwork_geometry::polygon::{of_faces, unite};
use fretwork_geometry::{CurveLabels, Curves, LabelSet, Polygon, Region};
use fretwork_language::scalar::Label;

/// Which faces are wanted.
#[derive(Clone, Copy, Debug, Default)]
pub struct Chosen<'a> {
    /// Those with one of these labels; else all.
    pub labels: Option<&'a [Label]>,
    /// The area whose outline the lines are: those that it covers. Holes are none of it.
    pub of: Option<&'a Arc<Region>>,
}

/// The region of the bounded faces that have any of the labels `chosen`, or of all, each with its outline moved inward by `by`
/// (outward where that is below 0).
///
/// Where `by` is 0, faces beside each other are one, and the border keeps the labels of edges, vertices and faces. Where it
/// is above 0, the border of each has the labels of its face inside; where it is below 0, what overlaps is one,
/// without labels. What gets thinner than nothing vanishes. O(n log n) in the edges of the map.
///
/// # Errors
/// When a face is too large or too small for its inset to be computed.
pub fn faces(
    map: &PlanarMap,
    chosen: &Chosen<'_>,
    by: f64,
    resolution: f64,
) -> Result<Region, ArrangementError> {
    let covered: Option<BTreeSet<FaceId>> = chosen.of.map(|area| {
        let outline = Arrangement::outline(area.clone());
        outline.covered(map).into_iter().collect()
    });
    let holds = |f: FaceId| {
        let is_wanted = |labels: &[Label]| has_any(map.face_labels(f), labels);
        f != FaceId::UNBOUNDED
            && covered.as_ref().is_none_or(|covered| covered.contains(&f))
            && chosen.labels.is_none_or(is_wanted)
    };
    if by == 0.0 {
        return Ok(Region {
            contour: border(map, &holds),
            ..Region::of_area(of_faces(map, holds))
        });
    }
    let faces: Vec<FaceId> = map.bounded_faces().filter(|f| holds(*f)).collect();
    let meter = Meter::current();
    let moved: Vec<Vec<Polygon>> = faces
        .par_iter()
        .map(|f| meter.during(|| inset(map, *f, by, resolution)))
        .collect::<Result<_, _>>()?;
    if by < 0.0 {
        return Ok(Region::of_area(unite(&moved.concat())?));
    }
    let mut contour = Curves::new();
    for (f, polygons) in faces.iter().zip(&moved) {
        let labels = CurveLabels {
            left: map.face_labels(*f),
            ..CurveLabels::default()
        };
        for ring in polygons.iter().flat_map(Polygon::rings) {
            contour.push(ring.iter().chain(ring.first()).copied(), labels);
        }
    }
    Ok(Region {
        contour,
        ..Region::of_area(moved.concat())
    })
}

/// The outline of an area in a region, without what lies outside of it, and with the region's own border where that cuts
/// through the area.
///
/// # Errors
/// [`ArrangementError`], where there is too much.
pub fn outline_in(
    area: &Region,
    region: &Region,
    resolution: f64,
) -> Result<Curves, ArrangementError> {
    if area.area == region.area {
        return Ok(area.contour.clone());
    }
    let border = Border::CropAddBoundary;
    mask::by_region(&area.contour, region, border, resolution, true)
}

/// The labels of the bounded faces of `map`.
pub fn face_labels(map: &PlanarMap) -> BTreeSet<Arc<str>> {
    let of = |f: FaceId| map.face_labels(f).names().to_vec();
    map.bounded_faces().flat_map(of).collect()
}

/// The edges between a face that holds and one that does not, with the former on their left.
fn border(map: &PlanarMap, holds: &impl Fn(FaceId) -> bool) -> Curves {
    let mut curves = Curves::new();
    for edge in map.edges() {
        let (left, right) = (map.left(edge), map.right(edge));
        if holds(left) == holds(right) {
            continue;
        }
        let h = HalfEdge {
            edge,
            reversed: holds(right),
        };
        let labels = CurveLabels {
            edge: map.labels(edge).edge,
            left: map.face_labels(map.face(h)),
            right: LabelSet::EMPTY,
            start: map.vertex_labels(map.origin(h)),
            end: map.vertex_labels(map.origin(h.twin())),
        };
        curves.push(map.half_edge_points(h), labels);
    }
    curves
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::planar_map::resolution;
    use fretwork_geometry::polygon::subtract;
    use fretwork_geometry::{Point, Seed};

    /// A board of `n` by `n` squares of side 1, dark and light.
    fn board(n: i64) -> PlanarMap {
        let mut curves = Curves::new();
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let corner = Point::new(i as f64, j as f64);
            let label = if (i + j) % 2 == 0 { "dark" } else { "light" };
            let square = Region::rectangle(corner, corner + Point::new(1.0, 1.0));
            curves.append(&square.labelled(LabelSet::one(label)).contour);
        }
        PlanarMap::build(&curves, resolution(n as f64)).unwrap()
    }

    fn area(region: &Region) -> f64 {
        region.area.iter().map(Polygon::area).sum()
    }

    #[test]
    fn faces_are_chosen_by_their_labels_and_moved() {
        let (map, dark) = (board(4), [Label("dark".into())]);
        let at = |labels, by| {
            let chosen = Chosen { labels, of: None };
            faces(&map, &chosen, by, resolution(4.0)).unwrap()
        };
        assert_eq!((at(None, 0.0).area.len(), area(&at(None, 0.0))), (1, 16.0));
        let all_dark = at(Some(&dark), 0.0);
        assert_eq!((all_dark.area.len(), area(&all_dark)), (8, 8.0));
        assert_eq!(all_dark.contour.len(), 32);
        let inset = at(Some(&dark), 0.25);
        assert!((area(&inset) - 8.0 * 0.25).abs() < 1e-6);
        assert!(inset.contour.iter().all(|c| c.labels.left.contains("dark")));
        assert!((area(&at(None, -0.5)) - 25.0).abs() < 1e-6);
        assert!(at(Some(&[Label("red".into())]), 0.0).area.is_empty());
        assert_eq!(face_labels(&map).len(), 2);
    }

    #[test]
    fn of_an_outline_holes_and_what_a_region_leaves_out_are_no_faces() {
        let square = |from: f64, to: f64| {
            let corner = |x: f64| Point::new(x, x);
            Region::rectangle(corner(from), corner(to))
        };
        let frame = subtract(&square(0.0, 10.0).area, &square(3.0, 7.0).area).unwrap();
        let frame = Arc::new(Region::of_area(frame));
        let within = |region: &Region| {
            let lines = outline_in(&frame, region, resolution(10.0)).unwrap();
            let map = PlanarMap::build(&lines, resolution(10.0)).unwrap();
            let chosen = Chosen {
                labels: None,
                of: Some(&frame),
            };
            area(&faces(&map, &chosen, 0.0, resolution(10.0)).unwrap())
        };
        assert!((within(&square(-5.0, 20.0)) - 84.0).abs() < 1e-6);
        assert!((within(&square(0.0, 5.0)) - 21.0).abs() < 1e-6);
        assert!((within(&frame.clone()) - 84.0).abs() < 1e-6);
    }

    #[test]
    fn the_border_bounds_the_area() {
        let map = board(5);
        for case in 0..10 {
            let seed = Seed::root(case);
            let holds = |f: FaceId| f.0 > 0 && seed.unit(u64::from(f.0)) < 0.5;
            let again = PlanarMap::build(&border(&map, &holds), resolution(5.0)).unwrap();
            for f in map.bounded_faces() {
                let inside = again.face_at(map.centroid(f));
                let labelled = !again.face_labels(inside).is_empty();
                assert_eq!(labelled, holds(f), "case {case}");
            }
        }
    }
}
