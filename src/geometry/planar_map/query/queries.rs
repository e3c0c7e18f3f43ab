//! What a planar map answers about its cells and how they are connected. Lengths, areas and
//! point location are in `measures`.

use crate::planar_map::PlanarMap;
use crate::{CurveLabels, Curves, LabelSet, Point};

/// A vertex: 0 to [`PlanarMap::vertex_count`] - 1, by y and then by x; those without edges after all others.
#[derive(Copy, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct VertexId(pub u32);

/// An edge: 0 to [`PlanarMap::edge_count`] - 1, by the first of its two vertices and counter-clockwise around it.
#[derive(Copy, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct EdgeId(pub u32);

/// A face: 0 is unbounded, 1 to [`PlanarMap::face_count`] are bounded, by the first vertex on their outer boundary.
#[derive(Copy, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct FaceId(pub u32);

impl FaceId {
    /// The face that reaches to infinity.
    pub const UNBOUNDED: FaceId = FaceId(0);
}

/// An edge with a direction; it belongs to the face on its left.
#[derive(Copy, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct HalfEdge {
    /// The edge.
    pub edge: EdgeId,
    /// Whether it runs from target to source.
    pub reversed: bool,
}

impl HalfEdge {
    /// The same edge in the other direction.
    #[inline]
    pub fn twin(self) -> HalfEdge {
        HalfEdge {
            reversed: !self.reversed,
            ..self
        }
    }

    pub(in crate::planar_map) fn numbered(h: u32) -> HalfEdge {
        HalfEdge {
            edge: EdgeId(h / 2),
            reversed: h % 2 == 1,
        }
    }

    pub(in crate::planar_map) fn number(self) -> usize {
        2 * self.edge.0 as usize + usize::from(self.reversed)
    }
}

/// A curve that runs along an edge.
#[derive(Copy, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Source {
    /// The number of the curve in the list that the map was built from.
    pub curve: u32,
    /// Whether it runs against the edge.
    pub reversed: bool,
}

/// What stands for the half-edge that leaves a vertex where none does.
pub(in crate::planar_map) const NO_HALF_EDGE: u32 = u32::MAX;

impl PlanarMap {
    /// How many vertices there are.
    #[inline]
    pub fn vertex_count(&self) -> usize {
        self.points.len()
    }

    /// How many edges there are.
    #[inline]
    pub fn edge_count(&self) -> usize {
        self.ends.len()
    }

    /// How many bounded faces there are.
    #[inline]
    pub fn face_count(&self) -> usize {
        self.faces.outer.len()
    }

    /// How many connected components the edges form.
    #[inline]
    pub fn component_count(&self) -> usize {
        self.faces.inner.len()
    }

    /// All vertices.
    #[inline]
    pub fn vertices(&self) -> impl ExactSizeIterator<Item = VertexId> + use<> {
        (0..self.vertex_count() as u32).map(VertexId)
    }

    /// All edges.
    #[inline]
    pub fn edges(&self) -> impl ExactSizeIterator<Item = EdgeId> + use<> {
        (0..self.edge_count() as u32).map(EdgeId)
    }

    /// All faces but the unbounded one.
    #[inline]
    pub fn bounded_faces(&self) -> impl ExactSizeIterator<Item = FaceId> + use<> {
        (1..self.face_count() as u32 + 1).map(FaceId)
    }

    /// Where a vertex is.
    #[inline]
    pub fn location(&self, v: VertexId) -> Point {
        self.points[v.0 as usize]
    }

    /// The labels of the curves' ends at a vertex.
    #[inline]
    pub fn vertex_labels(&self, v: VertexId) -> LabelSet {
        self.labels
            .vertices
            .get(v.0 as usize)
            .copied()
            .unwrap_or_default()
    }

    /// The half-edges that leave a vertex, counter-clockwise (+x toward +y); a loop comes twice,
    /// once in each direction. None leaves a point that stands alone.
    #[inline]
    pub fn outgoing(&self, v: VertexId) -> impl Iterator<Item = HalfEdge> + use<> {
        let first = self.outgoing[v.0 as usize];
        let mut clockwise = Vec::new();
        if first != NO_HALF_EDGE {
            // The half-edge after the twin of one that leaves is the one clockwise of it.
            clockwise.push(first);
            let mut h = self.next[first as usize ^ 1];
            while h != first {
                clockwise.push(h);
                h = self.next[h as usize ^ 1];
            }
        }
        clockwise.into_iter().rev().map(HalfEdge::numbered)
    }

    /// The vertex where an edge begins.
    #[inline]
    pub fn source(&self, e: EdgeId) -> VertexId {
        VertexId(self.ends[e.0 as usize][0])
    }

    /// The vertex where an edge ends.
    #[inline]
    pub fn target(&self, e: EdgeId) -> VertexId {
        VertexId(self.ends[e.0 as usize][1])
    }

    /// The vertex where a half-edge begins.
    #[inline]
    pub fn origin(&self, h: HalfEdge) -> VertexId {
        VertexId(self.ends[h.edge.0 as usize][usize::from(h.reversed)])
    }

    /// The face on the left of an edge.
    #[inline]
    pub fn left(&self, e: EdgeId) -> FaceId {
        FaceId(self.faces.of[2 * e.0 as usize])
    }

    /// The face on the right of an edge.
    #[inline]
    pub fn right(&self, e: EdgeId) -> FaceId {
        FaceId(self.faces.of[2 * e.0 as usize + 1])
    }

    /// The face that a half-edge belongs to, the one on its left.
    #[inline]
    pub fn face(&self, h: HalfEdge) -> FaceId {
        FaceId(self.faces.of[h.number()])
    }

    /// The half-edge that follows around the face on the left.
    #[inline]
    pub fn next(&self, h: HalfEdge) -> HalfEdge {
        HalfEdge::numbered(self.next[h.number()])
    }

    /// The points of an edge from source to target, two at least; those of a loop begin and end
    /// with the same one.
    #[inline]
    pub fn points(&self, e: EdgeId) -> impl DoubleEndedIterator<Item = Point> + Clone {
        let e = e.0 as usize;
        let [a, b] = self.ends[e].map(|v| self.points[v as usize]);
        let inner = match self.inner_starts.get(e..e + 2) {
            Some(range) => &self.inner[range[0] as usize..range[1] as usize],
            None => &[],
        };
        std::iter::once(a)
            .chain(inner.iter().copied())
            .chain(std::iter::once(b))
    }

    /// The points of a half-edge from its origin on.
    #[inline]
    pub fn half_edge_points(&self, h: HalfEdge) -> Vec<Point> {
        let points = self.points(h.edge);
        if h.reversed {
            points.rev().collect()
        } else {
            points.collect()
        }
    }

    /// What an edge carries: its labels, those of its sides and, where a curve along it starts
    /// or ends at one of its ends, the label that this curve has there. The labels of the cells next to
    /// it may be more: see [`PlanarMap::face_labels`] and [`PlanarMap::vertex_labels`].
    #[inline]
    pub fn labels(&self, e: EdgeId) -> CurveLabels {
        self.labels.tuples[self.labels.edges[e.0 as usize] as usize]
    }

    /// The curves along an edge; the first gave it its orientation and is the first in the list.
    pub fn sources(&self, e: EdgeId) -> impl Iterator<Item = Source> + '_ {
        let from = self.more_sources.partition_point(|m| m.0 < e.0);
        let more = self.more_sources[from..]
            .iter()
            .take_while(move |m| m.0 == e.0);
        let first = Source {
            curve: self.first_source[e.0 as usize],
            reversed: false,
        };
        std::iter::once(first).chain(more.map(|m| Source {
            curve: m.1 / 2,
            reversed: m.1 % 2 == 1,
        }))
    }

    /// How often curves run along an edge, less how often they run against it: pairs of the number of a curve and a number
    /// whose sum over all pairs of that curve counts. A winding number changes by this sum from the right of
    /// the edge to its left. Unlike [`PlanarMap::sources`] it tells a curve that passes three times from one that
    /// passes once.
    pub fn passes(&self, e: EdgeId) -> impl Iterator<Item = (u32, i32)> + '_ {
        let from = self.passes.partition_point(|p| p.0 < e.0);
        let rest = &self.passes[from..];
        let told = &rest[..rest.partition_point(|p| p.0 == e.0)];
        let plain = self
            .sources(e)
            .filter(|s| told.iter().all(|p| p.1 != s.curve))
            .map(|s| (s.curve, if s.reversed { -1 } else { 1 }));
        plain.chain(told.iter().map(|p| (p.1, p.2)))
    }

    /// The labels that the sides facing a face carry, over its whole boundary; none for the unbounded face.
    #[inline]
    pub fn face_labels(&self, f: FaceId) -> LabelSet {
        self.labels
            .faces
            .get(f.0 as usize)
            .copied()
            .unwrap_or_default()
    }

    /// The half-edges around a face, counter-clockwise with the face on the left, the edges that dangle
    /// into it twice; none for the unbounded face.
    #[inline]
    pub fn outer_boundary(&self, f: FaceId) -> impl Iterator<Item = HalfEdge> + '_ {
        let first = (f.0 as usize).checked_sub(1).map(|i| self.faces.outer[i]);
        first.into_iter().flat_map(|h| self.cycle(h))
    }

    /// The components in a face, holes and open curves, each as the half-edges around it,
    /// clockwise with the face on the left.
    #[inline]
    pub fn inner_boundaries(
        &self,
        f: FaceId,
    ) -> impl Iterator<Item = impl Iterator<Item = HalfEdge> + '_> + '_ {
        let from = self.faces.inner.partition_point(|i| i.0 < f.0);
        self.faces.inner[from..]
            .iter()
            .take_while(move |i| i.0 == f.0)
            .map(|i| self.cycle(i.1))
    }

    #[inline]
    fn cycle(&self, first: u32) -> impl Iterator<Item = HalfEdge> + '_ {
        let next = move |h: &u32| Some(self.next[*h as usize]).filter(|n| *n != first);
        std::iter::successors(Some(first), next).map(HalfEdge::numbered)
    }

    /// One curve per edge, in the order of the edges, with what the edge carries.
    #[inline]
    pub fn to_curves(&self) -> Curves {
        let mut curves = Curves::new();
        for e in self.edges() {
            curves.push(self.points(e), self.labels(e));
        }
        for v in self.lone_vertices() {
            curves.push_lone(self.location(v), self.vertex_labels(v));
        }
        curves
    }

    /// The vertices without edges.
    pub fn lone_vertices(&self) -> impl Iterator<Item = VertexId> {
        // They are the last ones.
        let numbers = (0..self.vertex_count() as u32).rev();
        let lone = numbers.take_while(|v| self.outgoing[*v as usize] == NO_HALF_EDGE);
        let first = self.vertex_count() as u32 - lone.count() as u32;
        (first..self.vertex_count() as u32).map(VertexId)
    }
}
