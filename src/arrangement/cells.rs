//! The cells of a planar map as mappers see them: outlines, neighbours, positions, random values
//! (Loi 2015, table 3.4; rules R11 to R14). Labels and counts are asked of the map itself.

use fretwork_geometry::planar_map::{EdgeId, FaceId, HalfEdge, PlanarMap, VertexId};
use fretwork_geometry::polygon::{self, of_face};
use fretwork_geometry::{Bounds, CurveLabels, Curves, LabelSet, Point, Region, Seed, Snap, Tile};

/// A cell of a planar map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Cell {
    /// A vertex.
    Vertex(VertexId),
    /// An edge.
    Edge(EdgeId),
    /// A face.
    Face(FaceId),
}

impl Cell {
    /// Where the cell is: the location of a vertex, the middle of an edge along its length, the centroid
    /// of a face (NaN for the unbounded one).
    pub fn position(self, map: &PlanarMap) -> Point {
        match self {
            Cell::Vertex(v) => map.location(v),
            Cell::Edge(e) => location_at(map, e, 0.5),
            Cell::Face(f) => map.centroid(f),
        }
    }

    /// Where a field is read for the cell: its position, but a face whose centroid lies outside of it has a place inside.
    pub fn inner(self, map: &PlanarMap) -> Point {
        let at = self.position(map);
        let Cell::Face(face) = self else {
            return at;
        };
        let area = of_face(map, face);
        if area.is_empty() || area.iter().any(|polygon| polygon.contains(at)) {
            return at;
        }
        polygon::inner_point(&area)
    }

    /// The box of the cell; empty for the unbounded face.
    pub fn bounds(self, map: &PlanarMap) -> Bounds {
        match self {
            Cell::Vertex(v) => Bounds::of([map.location(v)]),
            Cell::Edge(e) => Bounds::of(map.points(e)),
            Cell::Face(f) => Bounds::of(map.outer_boundary(f).flat_map(|h| map.points(h.edge))),
        }
    }

    /// The `n`-th random value of the cell, uniform in [0, 1), for a construction with the seed
    /// `construction`. It stays the same while the cell stays in place, rounded by `snap`.
    pub fn random(self, map: &PlanarMap, construction: Seed, snap: Snap, n: u64) -> f64 {
        let kind = match self {
            Cell::Vertex(_) => "vertex",
            Cell::Edge(_) => "edge",
            Cell::Face(_) => "face",
        };
        construction.name(kind).at(self.position(map), snap).unit(n)
    }

    /// Whether the unbounded face is next to the cell: beside an edge, around a vertex, beside an
    /// incident edge of a face.
    pub fn is_boundary(self, map: &PlanarMap) -> bool {
        let beside =
            |e: EdgeId| map.left(e) == FaceId::UNBOUNDED || map.right(e) == FaceId::UNBOUNDED;
        match self {
            Cell::Vertex(_) => incident_faces(map, self).contains(&FaceId::UNBOUNDED),
            Cell::Edge(e) => beside(e),
            Cell::Face(f) => {
                f == FaceId::UNBOUNDED || incident_edges(map, self).into_iter().any(beside)
            }
        }
    }
}

/// The edges with a face on either side (those of holes and dangling ones included), or those that
/// end at a vertex, or the edge itself; each once, ascending.
pub fn incident_edges(map: &PlanarMap, cell: Cell) -> Vec<EdgeId> {
    sorted(match cell {
        Cell::Vertex(v) => map.outgoing(v).map(|h| h.edge).collect(),
        Cell::Edge(e) => vec![e],
        Cell::Face(f) => boundary(map, f).map(|h| h.edge).collect(),
    })
}

/// The ends of the incident edges of a face, or of an edge, or the vertex itself; each once, ascending.
pub fn incident_vertices(map: &PlanarMap, cell: Cell) -> Vec<VertexId> {
    sorted(match cell {
        Cell::Vertex(v) => vec![v],
        Cell::Edge(e) => vec![map.source(e), map.target(e)],
        // Every end of an edge around a face is the origin of a half-edge around it.
        Cell::Face(f) => boundary(map, f).map(|h| map.origin(h)).collect(),
    })
}

/// The faces around a vertex, or that in which it stands alone, or beside an edge, the unbounded one included, or the face itself; each
/// once, ascending.
pub fn incident_faces(map: &PlanarMap, cell: Cell) -> Vec<FaceId> {
    sorted(match cell {
        Cell::Vertex(v) => {
            let around: Vec<FaceId> = map.outgoing(v).map(|h| map.face(h)).collect();
            match around.is_empty() {
                true => vec![map.face_at(map.location(v))],
                false => around,
            }
        }
        Cell::Edge(e) => vec![map.left(e), map.right(e)],
        Cell::Face(f) => vec![f],
    })
}

/// The point at the part `s` (0 to 1) of the length of an edge.
pub fn location_at(map: &PlanarMap, e: EdgeId, s: f64) -> Point {
    let mut rest = s.clamp(0.0, 1.0) * map.edge_length(e);
    let mut at = map.location(map.target(e));
    for (a, b) in map.points(e).zip(map.points(e).skip(1)) {
        let length = a.distance(b);
        if rest < length {
            return a.lerp(b, rest / length);
        }
        (rest, at) = (rest - length, b);
    }
    at
}

/// An edge as a curve with all it carries.
pub fn to_curve(map: &PlanarMap, e: EdgeId) -> Curves {
    let mut curves = Curves::new();
    curves.push(map.points(e), map.labels(e));
    curves
}

/// The outline of a bounded face: one curve for every edge that has it on one side only, with the
/// face on its left, and so counter-clockwise outside and clockwise around holes. Edge and vertex
/// labels are kept, the left side has the labels of the face, the right none. Edges that dangle into
/// the face are left out.
pub fn contour(map: &PlanarMap, f: FaceId) -> Curves {
    let mut curves = Curves::new();
    for h in boundary(map, f).filter(|h| map.face(h.twin()) != f) {
        let labels = CurveLabels {
            edge: map.labels(h.edge).edge,
            left: map.face_labels(f),
            right: LabelSet::EMPTY,
            start: map.vertex_labels(map.origin(h)),
            end: map.vertex_labels(map.origin(h.twin())),
        };
        curves.push(map.half_edge_points(h), labels);
    }
    curves
}

/// A bounded face as a region, a piece of `tile` if there is one; the unbounded one gives an empty region.
pub fn face_region(map: &PlanarMap, f: FaceId, tile: Option<Tile>) -> Region {
    if f == FaceId::UNBOUNDED {
        return Region::of_area(Vec::new());
    }
    Region {
        area: of_face(map, f),
        contour: contour(map, f),
        period: None,
        within: tile,
        whole: None,
        features: Vec::new(),
        columns: Vec::new(),
    }
}

/// All half-edges around a face.
fn boundary(map: &PlanarMap, f: FaceId) -> impl Iterator<Item = HalfEdge> + '_ {
    map.outer_boundary(f)
        .chain(map.inner_boundaries(f).flatten())
}

fn sorted<T: Ord>(mut cells: Vec<T>) -> Vec<T> {
    cells.sort();
    cells.dedup();
    cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::planar_map::resolution;

    fn map(lines: &[&[[f64; 2]]]) -> PlanarMap {
        let mut curves = Curves::new();
        for line in lines {
            let labels = CurveLabels {
                left: LabelSet::one("l"),
                start: LabelSet::one("s"),
                ..CurveLabels::edge(LabelSet::one("e"))
            };
            curves.push(line.iter().map(|p| Point::from(*p)), labels);
        }
        PlanarMap::build(&curves, resolution(10.0)).unwrap()
    }

    const SQUARE: &[[f64; 2]] = &[[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [0.0, 8.0], [0.0, 0.0]];
    const HOLE: &[[f64; 2]] = &[[3.0, 3.0], [5.0, 3.0], [5.0, 5.0], [3.0, 5.0], [3.0, 3.0]];
    const BRIDGE: &[[f64; 2]] = &[[0.0, 0.0], [3.0, 3.0]];
    const ANTENNA: &[[f64; 2]] = &[[8.0, 4.0], [6.0, 4.0], [6.0, 5.0]];
    /// Touches the square at a corner from inside.
    const EAR: &[[f64; 2]] = &[[8.0, 8.0], [7.0, 6.0], [6.0, 7.0], [8.0, 8.0]];

    #[test]
    fn regions_of_faces_have_no_dangling_edges_and_simple_rings() {
        for lines in [
            vec![SQUARE, HOLE],
            vec![SQUARE, HOLE, BRIDGE, ANTENNA, EAR],
            vec![ANTENNA, EAR, BRIDGE, HOLE, SQUARE],
        ] {
            let map = map(&lines);
            let f = map.face_at(Point::new(1.0, 6.0));
            let region = face_region(&map, f, None);
            let ear = if lines.len() > 2 { 1.5 } else { 0.0 };
            assert_eq!(region.area.len(), 1);
            assert_eq!(region.area[0].area(), 60.0 - ear);
            assert_eq!(region.area[0].holes.len(), if ear > 0.0 { 2 } else { 1 });
            assert!((map.face_area(f) - (60.0 - ear)).abs() < 1e-9);
            let length: f64 = region
                .contour
                .iter()
                .flat_map(|c| c.points.windows(2))
                .map(|w| w[0].distance(w[1]))
                .sum();
            let of_ear = if ear > 0.0 {
                2.0 * 5f64.sqrt() + 2f64.sqrt()
            } else {
                0.0
            };
            assert!((length - 40.0 - of_ear).abs() < 1e-9);
            for curve in region.contour.iter() {
                assert!(
                    curve.labels.left.contains("l")
                        && curve.labels.right.is_empty()
                        && curve.labels.edge.contains("e")
                );
            }
        }
        let map = map(&[SQUARE]);
        assert!(face_region(&map, FaceId::UNBOUNDED, None).area.is_empty());
    }

    #[test]
    fn neighbours_are_distinct_and_include_the_unbounded_face() {
        let map = map(&[SQUARE, HOLE, ANTENNA]);
        let f = map.face_at(Point::new(1.0, 6.0));
        // The square is cut in two where the antenna begins.
        assert_eq!(incident_edges(&map, Cell::Face(f)).len(), 4);
        assert_eq!(incident_vertices(&map, Cell::Face(f)).len(), 4);
        let corner = map
            .vertices()
            .find(|v| map.location(*v) == Point::ORIGIN)
            .unwrap();
        assert_eq!(
            incident_faces(&map, Cell::Vertex(corner)),
            [FaceId::UNBOUNDED, f]
        );
        let of_hole = map
            .vertices()
            .find(|v| map.location(*v) == Point::new(3.0, 3.0))
            .unwrap();
        assert_eq!(
            incident_edges(&map, Cell::Vertex(of_hole)).len(),
            1,
            "a loop counts once"
        );
        assert!(Cell::Vertex(corner).is_boundary(&map) && !Cell::Vertex(of_hole).is_boundary(&map));
        assert!(Cell::Face(f).is_boundary(&map));
        assert!(!Cell::Face(map.face_at(Point::new(4.0, 4.0))).is_boundary(&map));
        let open = super::tests::map(&[ANTENNA]);
        assert!(
            Cell::Edge(EdgeId(0)).is_boundary(&open),
            "an open stroke lies in the unbounded face"
        );
    }

    #[test]
    fn positions_are_measured_along_edges() {
        let map = map(&[ANTENNA]);
        assert_eq!(location_at(&map, EdgeId(0), 0.5), Point::new(6.5, 4.0));
        assert_eq!(location_at(&map, EdgeId(0), 1.0), Point::new(6.0, 5.0));
        assert_eq!(location_at(&map, EdgeId(0), -3.0), Point::new(8.0, 4.0));
        let snap = Snap::of(&Region::rectangle(Point::ORIGIN, Point::new(10.0, 10.0)));
        let values: Vec<f64> = (0..4)
            .map(|n| Cell::Edge(EdgeId(0)).random(&map, Seed::root(1), snap, n))
            .collect();
        assert!(values.windows(2).all(|w| w[0] != w[1]));
        assert_eq!(
            Cell::Edge(EdgeId(0)).random(&map, Seed::root(1), snap, 2),
            values[2]
        );
    }
}
