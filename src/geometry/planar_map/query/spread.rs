//! Values of faces that follow from those of their neighbours.

use crate::planar_map::PlanarMap;
use crate::planar_map::query::queries::{EdgeId, HalfEdge};

impl PlanarMap {
    /// Gives a value to every face that can be reached from a face that has one; `values` are numbered like the faces.
    /// `across(h, known)` says what lies on the right of the half-edge `h`, given what is known of the face on its
    /// left, or nothing where the way is closed. A face keeps the first value that it gets, so the value
    /// should not depend on the way. O(E log E).
    ///
    /// ```
    /// use fretwork_geometry::planar_map::{PlanarMap, resolution};
    /// use fretwork_geometry::{Point, Region};
    /// let square = Region::rectangle(Point::new(0.0, 0.0), Point::new(1.0, 1.0)).contour;
    /// let map = PlanarMap::build(&square, resolution(1.0)).unwrap();
    /// let mut depths = [Some(0), None];
    /// map.spread(&mut depths, |_, depth| Some(depth + 1));
    /// assert_eq!(depths, [Some(0), Some(1)]);
    /// ```
    pub fn spread<T>(&self, values: &mut [Option<T>], across: impl Fn(HalfEdge, &T) -> Option<T>) {
        let mut sides: Vec<(u32, EdgeId, u32)> = Vec::with_capacity(2 * self.edge_count());
        for e in self.edges() {
            let (left, right) = (self.left(e).0, self.right(e).0);
            if left != right {
                sides.push((left, e, right));
                sides.push((right, e, left));
            }
        }
        sides.sort_unstable();
        let known = |face: &u32| values[*face as usize].is_some();
        let mut waiting: Vec<u32> = (0..values.len() as u32).filter(known).collect();
        while let Some(face) = waiting.pop() {
            let from = sides.partition_point(|side| side.0 < face);
            for &(_, edge, other) in sides[from..].iter().take_while(|side| side.0 == face) {
                let h = HalfEdge {
                    edge,
                    reversed: self.left(edge).0 != face,
                };
                if values[other as usize].is_none()
                    && let Some(known) = &values[face as usize]
                    && let Some(value) = across(h, known)
                {
                    values[other as usize] = Some(value);
                    waiting.push(other);
                }
            }
        }
    }
}
