//! The region that a drawing encloses.

use std::collections::BTreeMap;

use super::{Drawing, FillRule, curve_labels};
use crate::planar_map::{self, EdgeId, FaceId, PlanarMap, PlanarMapError};
use crate::polygon::{AreaError, fill};
use crate::{Curves, Point, Region, Ring};

/// Why a drawing bounds no region.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RegionError {
    /// Its curves have no planar map.
    #[error(transparent)]
    Map(#[from] PlanarMapError),
    /// Its outlines enclose no computable area.
    #[error(transparent)]
    Area(#[from] AreaError),
    /// There is no closed outline in it.
    #[error("the drawing encloses nothing")]
    Empty,
}

/// What a drawing encloses.
#[derive(Clone, Debug, PartialEq)]
pub struct Enclosed {
    /// The region.
    pub region: Region,
    /// How many of the curves are wholly outside: they enclose nothing.
    pub loose: usize,
    /// How many rings without fill lie inside of other lines, which they touch nowhere: they make no hole.
    pub nested: usize,
}

/// Lines that cut off at least this part of a hole of what is filled are its outline.
const OUTLINE: f64 = 0.98;

impl Drawing {
    /// What the drawing encloses: the interiors of its filled shapes by their rules, and all that
    /// its lines cut off from the outside, rings included. A hole of what is filled stays one when
    /// lines run along its edge. The width of strokes does not count.
    /// The contour is the pieces of the drawn curves that bound the region, in their order and with
    /// their labels, the region on their left.
    ///
    /// # Errors
    /// [`RegionError`].
    pub fn region(&self) -> Result<Enclosed, RegionError> {
        let (curves, owners) = self.outlines();
        let resolution = planar_map::resolution(curves.bounds().longer_side());
        let map = PlanarMap::build(&curves, resolution)?;
        let faces = self.faces(&map, &owners);
        let inside = &faces.inside;
        let mut contour = Curves::new();
        let mut is_loose = vec![true; curves.len()];
        for e in map.edges() {
            let (left, right) = (
                inside[map.left(e).0 as usize],
                inside[map.right(e).0 as usize],
            );
            if left || right {
                map.sources(e)
                    .for_each(|source| is_loose[source.curve as usize] = false);
            }
            if left && !right {
                contour.push(map.points(e), map.labels(e));
            } else if right && !left {
                contour.push(map.points(e).rev(), map.labels(e).reversed());
            }
        }
        let mut rings: Vec<Ring> = Vec::new();
        for f in map.bounded_faces().filter(|f| inside[f.0 as usize]) {
            let mut ring = Ring::new();
            for h in map.outer_boundary(f) {
                ring.extend(map.half_edge_points(h));
            }
            rings.push(ring);
            rings.extend(
                map.inner_boundaries(f)
                    .map(|hole| hole.flat_map(|h| map.half_edge_points(h)).collect()),
            );
        }
        // Every face inside winds once round its own points, so together they fill the region.
        let area = fill(&rings, FillRule::NonZero)?;
        if area.is_empty() {
            return Err(RegionError::Empty);
        }
        let nested = map.edges().filter(|e| is_nested(&map, &owners, &faces, *e));
        let nested = nested.count();
        let region = Region {
            area,
            contour,
            period: None,
            within: None,
            whole: None,
            features: Vec::new(),
            columns: Vec::new(),
        };
        Ok(Enclosed {
            region,
            loose: is_loose.into_iter().filter(|loose| *loose).count(),
            nested,
        })
    }

    /// The outlines of filled shapes, closed, and all other lines; for each the number of its
    /// shape if that is filled.
    fn outlines(&self) -> (Curves, Vec<Option<usize>>) {
        let mut curves = Curves::new();
        let mut owners = Vec::new();
        for (number, shape) in self.shapes.iter().enumerate() {
            for path in shape.paths.iter().filter(|path| path.len() > 1) {
                let closing = path
                    .first()
                    .filter(|p| shape.filled && path.last() != Some(p));
                let path: Vec<Point> = path.iter().chain(closing).copied().collect();
                let labels = curve_labels(shape.label, &path);
                curves.push(path, labels);
                owners.push(shape.filled.then_some(number));
            }
        }
        (curves, owners)
    }

    /// Which faces of the map of the outlines are filled or enclosed.
    fn faces(&self, map: &PlanarMap, owners: &[Option<usize>]) -> Faces {
        let windings = windings(map, owners);
        let filled = |winding: &BTreeMap<usize, i32>| {
            winding
                .iter()
                .any(|(shape, turns)| match self.shapes[*shape].rule {
                    FillRule::NonZero => *turns != 0,
                    FillRule::EvenOdd => turns % 2 != 0,
                })
        };
        let filled: Vec<bool> = windings.iter().map(filled).collect();
        let mut enclosed = enclosed(map, owners);
        open_outlined_holes(map, &filled, &mut enclosed);
        let both = filled.iter().zip(enclosed);
        Faces {
            inside: both.map(|(filled, enclosed)| *filled || enclosed).collect(),
            filled,
        }
    }
}

/// What is said of the faces of a map, by their numbers.
struct Faces {
    /// Whether a shape fills it.
    filled: Vec<bool>,
    /// Whether it belongs to the region.
    inside: Vec<bool>,
}

/// Opens the holes of what is filled that lines cut off as a whole.
///
/// A hole is a group of faces that are not filled, from which no way over such faces leads outside.
fn open_outlined_holes(map: &PlanarMap, filled: &[bool], enclosed: &mut [bool]) {
    let neighbours = neighbours(map);
    let mut seen = filled.to_vec();
    // The faces around a face that was not seen, over faces that are not filled.
    let mut group = |from: FaceId| {
        let mut found = Vec::new();
        let mut stack = vec![from];
        while let Some(face) = stack.pop() {
            if std::mem::replace(&mut seen[face.0 as usize], true) {
                continue;
            }
            found.push(face);
            let around = neighbours[face.0 as usize].iter();
            stack.extend(around.flat_map(|&e| [map.left(e), map.right(e)]));
        }
        found
    };
    group(FaceId::UNBOUNDED);
    for face in map.bounded_faces() {
        let hole = group(face);
        let area = |face: &&FaceId| map.face_area(**face);
        let whole: f64 = hole.iter().map(|face| area(&face)).sum();
        let cut = hole.iter().filter(|face| enclosed[face.0 as usize]);
        if cut.map(|face| area(&face)).sum::<f64>() >= OUTLINE * whole {
            hole.iter()
                .for_each(|face| enclosed[face.0 as usize] = false);
        }
    }
}

/// The edges around each face.
fn neighbours(map: &PlanarMap) -> Vec<Vec<EdgeId>> {
    let mut neighbours = vec![Vec::new(); map.face_count() + 1];
    for e in map.edges() {
        neighbours[map.left(e).0 as usize].push(e);
        neighbours[map.right(e).0 as usize].push(e);
    }
    neighbours
}

/// Whether an edge is a whole ring of lines alone, in what other lines enclose and away from all else.
fn is_nested(map: &PlanarMap, owners: &[Option<usize>], faces: &Faces, e: EdgeId) -> bool {
    let is_ring = map.source(e) == map.target(e) && map.outgoing(map.source(e)).count() == 2;
    let is_lined = |face: FaceId| faces.inside[face.0 as usize] && !faces.filled[face.0 as usize];
    is_ring
        && is_lined(map.left(e))
        && is_lined(map.right(e))
        && map
            .sources(e)
            .all(|source| owners[source.curve as usize].is_none())
}

/// How often each filled shape winds round each face, carried from the unbounded face over the
/// edges; shapes that do not are left out.
fn windings(map: &PlanarMap, owners: &[Option<usize>]) -> Vec<BTreeMap<usize, i32>> {
    let mut found: Vec<Option<BTreeMap<usize, i32>>> = vec![None; map.face_count() + 1];
    found[0] = Some(BTreeMap::new());
    map.spread(&mut found, |h, known| {
        let mut winding = known.clone();
        for (curve, turns) in map.passes(h.edge) {
            if let Some(shape) = owners[curve as usize] {
                // A curve winds once more round what is on its left than round what is on its right.
                *winding.entry(shape).or_default() -= if h.reversed { -turns } else { turns };
            }
        }
        winding.retain(|_, turns| *turns != 0);
        Some(winding)
    });
    found.into_iter().map(Option::unwrap_or_default).collect()
}

/// Which faces the lines that are no outlines of filled shapes keep apart from the unbounded face.
fn enclosed(map: &PlanarMap, owners: &[Option<usize>]) -> Vec<bool> {
    let mut reached = vec![None; map.face_count() + 1];
    reached[0] = Some(());
    map.spread(&mut reached, |h, ()| {
        let mut sources = map.sources(h.edge);
        let is_open = sources.all(|source| owners[source.curve as usize].is_some());
        is_open.then_some(())
    });
    reached.iter().map(Option::is_none).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Shape, Stroke};
    use crate::polygon::signed_area;
    use crate::{LabelSet, Polygon};

    fn square(a: f64, b: f64) -> Vec<Point> {
        [[a, a], [b, a], [b, b], [a, b], [a, a]]
            .map(Point::from)
            .to_vec()
    }

    fn shape(label: &str, filled: bool, rule: FillRule, paths: Vec<Vec<Point>>) -> Shape {
        let stroke = (!filled).then_some(Stroke::round(1.0));
        Shape {
            label: LabelSet::one(label),
            paths,
            filled,
            rule,
            stroke,
        }
    }

    fn region(shapes: Vec<Shape>) -> Result<Region, RegionError> {
        enclosed(shapes).map(|found| found.region)
    }

    fn enclosed(shapes: Vec<Shape>) -> Result<Enclosed, RegionError> {
        Drawing {
            shapes,
            points: vec![],
        }
        .region()
    }

    fn area(region: &Region) -> f64 {
        region.area.iter().map(Polygon::area).sum()
    }

    #[test]
    fn a_drawn_outline_bounds_its_inside_from_its_own_start() {
        let mut path = square(0.0, 8.0);
        path.reverse();
        path.rotate_left(1);
        path[4] = path[0];
        let found = region(vec![shape(
            "rim",
            false,
            FillRule::NonZero,
            vec![path.clone()],
        )])
        .unwrap();
        assert_eq!((area(&found), found.contour.len()), (64.0, 1));
        path.reverse();
        let rim = found.contour.get(0);
        let (label, none) = (LabelSet::one("rim"), LabelSet::EMPTY);
        assert_eq!((rim.points, rim.labels.edge), (&path[..], label));
        assert_eq!((rim.labels.left, rim.labels.right), (label, none));
    }

    #[test]
    fn fill_rules_and_rings_count() {
        let paths = vec![square(0.0, 8.0), square(2.0, 4.0)];
        let even = region(vec![shape("a", true, FillRule::EvenOdd, paths.clone())]).unwrap();
        assert_eq!((area(&even), even.contour.len()), (60.0, 2));
        // The region is on the left of its hole's curve as well.
        assert_eq!(
            even.contour
                .iter()
                .map(|c| signed_area(c.points))
                .sum::<f64>(),
            60.0
        );
        assert_eq!(
            area(&region(vec![shape("a", true, FillRule::NonZero, paths.clone())]).unwrap()),
            64.0
        );
        assert_eq!(
            area(&region(vec![shape("a", false, FillRule::EvenOdd, paths)]).unwrap()),
            64.0
        );
    }

    #[test]
    fn overlapping_shapes_are_one_region() {
        let shapes = vec![
            shape("a", true, FillRule::NonZero, vec![square(0.0, 4.0)]),
            shape("b", true, FillRule::NonZero, vec![square(2.0, 6.0)]),
        ];
        let found = region(shapes).unwrap();
        assert_eq!(
            (area(&found), found.area.len(), found.contour.len()),
            (28.0, 1, 3)
        );
        let opposed = vec![shape(
            "a",
            true,
            FillRule::EvenOdd,
            vec![square(0.0, 4.0), square(2.0, 6.0)],
        )];
        assert_eq!(area(&region(opposed).unwrap()), 24.0);
    }

    #[test]
    fn lines_enclose_what_they_cut_off() {
        let sides: Vec<Shape> = square(0.0, 4.0)
            .windows(2)
            .map(|side| shape("side", false, FillRule::NonZero, vec![side.to_vec()]))
            .chain([shape(
                "tail",
                false,
                FillRule::NonZero,
                vec![vec![Point::new(4.0, 4.0), Point::new(9.0, 9.0)]],
            )])
            .collect();
        let found = region(sides.clone()).unwrap();
        assert_eq!((area(&found), found.contour.len()), (16.0, 4));
        assert_eq!(region(sides[..3].to_vec()), Err(RegionError::Empty));
        assert_eq!(region(vec![]), Err(RegionError::Empty));
        let open = vec![shape(
            "open",
            true,
            FillRule::NonZero,
            vec![square(0.0, 4.0)[..4].to_vec()],
        )];
        assert_eq!(area(&region(open).unwrap()), 16.0);
    }

    #[test]
    fn a_path_that_runs_over_its_own_edge_fills_as_every_renderer_fills_it() {
        let path = |points: &[[f64; 2]]| {
            let points: Vec<Point> = points.iter().map(|p| Point::from(*p)).collect();
            region(vec![shape("a", true, FillRule::EvenOdd, vec![points])]).unwrap()
        };
        let spike = path(&[
            [0.0, 0.0],
            [10.0, 0.0],
            [10.0, 5.0],
            [10.0, 4.0],
            [10.0, 10.0],
            [0.0, 10.0],
        ]);
        assert_eq!(area(&spike), 100.0);
        let past_start = path(&[
            [20.0, 10.0],
            [10.0, 10.0],
            [10.0, 40.0],
            [40.0, 40.0],
            [40.0, 10.0],
            [19.75, 10.0],
        ]);
        assert_eq!(area(&past_start), 900.0);
        let ring = path(&[
            [0.0, 0.0],
            [40.0, 0.0],
            [40.0, 40.0],
            [0.0, 40.0],
            [0.0, 0.0],
            [10.0, 0.0],
            [10.0, 10.0],
            [30.0, 10.0],
            [30.0, 30.0],
            [10.0, 30.0],
            [10.0, 0.0],
        ]);
        assert_eq!((area(&ring), ring.area[0].holes.len()), (1200.0, 1));
    }

    #[test]
    fn a_drawing_in_survey_coordinates_keeps_its_points() {
        let corner = Point::new(500_010.25, 5_400_010.25);
        let square: Vec<Point> = square(0.0, 10.5).iter().map(|p| *p + corner).collect();
        let far = region(vec![shape(
            "a",
            true,
            FillRule::NonZero,
            vec![square.clone()],
        )])
        .unwrap();
        assert_eq!((area(&far), far.area[0].outer[0]), (110.25, corner));
        assert_eq!(far.contour.get(0).points, &square[..]);
    }

    #[test]
    fn a_hole_that_is_outlined_stays_a_hole() {
        let rings = vec![square(0.0, 8.0), square(2.0, 6.0)];
        let plate = shape("plate", true, FillRule::EvenOdd, rings.clone());
        let line = |paths| shape("line", false, FillRule::NonZero, paths);
        let found = enclosed(vec![plate.clone(), line(rings.clone())]).unwrap();
        assert_eq!((area(&found.region), found.nested), (48.0, 0));
        // The outline is a little off, as one that was flattened in other steps.
        let off = line(vec![square(2.001, 5.999)]);
        assert_eq!(area(&region(vec![plate.clone(), off]).unwrap()), 48.0);
        let sides = square(2.0, 6.0);
        let sides = sides.windows(2).map(|side| line(vec![side.to_vec()]));
        let all: Vec<Shape> = [plate.clone()].into_iter().chain(sides).collect();
        assert_eq!(area(&region(all).unwrap()), 48.0);
        // A ring that is smaller than the hole is an island in it, and one beside the plate is a part.
        let island = line(vec![square(3.0, 5.0)]);
        assert_eq!(area(&region(vec![plate.clone(), island]).unwrap()), 52.0);
        let beside = [[8.0, 0.0], [9.0, 0.0], [9.0, 8.0], [8.0, 8.0], [8.0, 0.0]];
        let beside = line(vec![beside.map(Point::from).to_vec()]);
        assert_eq!(area(&region(vec![plate, beside]).unwrap()), 56.0);
    }

    #[test]
    fn rings_inside_of_lines_are_counted() {
        let line = |a, b| shape("line", false, FillRule::NonZero, vec![square(a, b)]);
        let washer = enclosed(vec![line(0.0, 8.0), line(2.0, 6.0)]).unwrap();
        assert_eq!((area(&washer.region), washer.nested), (64.0, 1));
        let touching = enclosed(vec![line(0.0, 8.0), line(0.0, 6.0)]).unwrap();
        assert_eq!((touching.nested, touching.loose), (0, 0));
        let plate = shape("plate", true, FillRule::NonZero, vec![square(0.0, 8.0)]);
        assert_eq!(enclosed(vec![plate, line(2.0, 6.0)]).unwrap().nested, 0);
    }
}
