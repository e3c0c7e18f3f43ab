//! Points that stand alone, as vertices without edges. They come after the map is there, because nothing else of it depends
//! on them.

use std::collections::BTreeMap;

use crate::planar_map::PlanarMap;
use crate::planar_map::build::labels::unite;
use crate::planar_map::noding::snap_grid::{RESOLUTION, Site};
use crate::planar_map::query::NO_HALF_EDGE;
use crate::{LabelSet, Point};

/// Vertices by the squares of the grid in which they lie, a resolution wide.
type Squares = BTreeMap<[i64; 2], Vec<u32>>;

/// Adds the points to the vertices of the map: where one is nearer than a resolution it gets the labels. Of what is added
/// the order is by y and then by x. O(v log v) for v vertices where there are points at all.
pub(in crate::planar_map) fn add(map: &mut PlanarMap, lone: &[(Point, LabelSet)]) {
    if lone.is_empty() {
        return;
    }
    let mut squares = Squares::new();
    for (number, p) in (0u32..).zip(&map.points) {
        squares
            .entry(square(map.grid.snap(*p)))
            .or_default()
            .push(number);
    }
    let mut sites: Vec<(Site, LabelSet)> = Vec::with_capacity(lone.len());
    sites.extend(lone.iter().map(|(p, labels)| (map.grid.snap(*p), *labels)));
    sites.sort_by(|(a, _), (b, _)| {
        (a[1], a[0])
            .partial_cmp(&(b[1], b[0]))
            .expect("sites are numbers")
    });
    for (site, labels) in sites {
        let number = nearest(map, &squares, site).unwrap_or_else(|| {
            let number = map.points.len() as u32;
            map.points.push(map.grid.point(site));
            map.outgoing.push(NO_HALF_EDGE);
            squares.entry(square(site)).or_default().push(number);
            number
        });
        if !labels.is_empty() {
            unite(&mut map.labels.vertices, number, labels);
        }
    }
}

fn square(site: Site) -> [i64; 2] {
    site.map(|v| (v / RESOLUTION).floor() as i64)
}

/// The nearest vertex that is no farther than a resolution.
fn nearest(map: &PlanarMap, squares: &Squares, site: Site) -> Option<u32> {
    let [column, row] = square(site);
    let distance = |number: u32| {
        let [x, y] = map.grid.snap(map.points[number as usize]);
        (x - site[0]).powi(2) + (y - site[1]).powi(2)
    };
    let around = (-1..=1).flat_map(|j| (-1..=1).map(move |i| [column + i, row + j]));
    around
        .filter_map(|square| squares.get(&square))
        .flatten()
        .map(|number| (distance(*number), *number))
        .filter(|(distance, _)| *distance <= RESOLUTION * RESOLUTION)
        .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
        .map(|(_, number)| number)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planar_map::{FaceId, VertexId, resolution};
    use crate::{Curves, Region};

    #[test]
    fn points_are_vertices_of_their_own_or_label_those_that_are_there() {
        let mut curves = Region::rectangle(Point::ORIGIN, Point::new(4.0, 4.0)).contour;
        let place = |x: f64, y: f64| Point::new(x, y);
        for (at, label) in [
            (place(3.0, 2.0), "late"),
            (place(1.0, 1.0), "tree"),
            (place(1.0, 1.0 + 1e-12), "well"),
            (place(4.0, 0.0), "corner"),
            (place(9.0, 9.0), "outside"),
        ] {
            curves.push_lone(at, LabelSet::one(label));
        }
        let map = PlanarMap::build(&curves, resolution(4.0)).unwrap();
        map.check().unwrap();
        assert_eq!(
            (map.vertex_count(), map.edge_count(), map.face_count()),
            (7, 4, 1)
        );
        let found: Vec<(Point, Vec<String>)> = (4..7)
            .map(|v| (map.location(VertexId(v)), map.vertex_labels(VertexId(v))))
            .map(|(p, labels)| (p, labels.names().iter().map(|n| n.to_string()).collect()))
            .collect();
        let names = |all: &[&str]| all.iter().map(|n| n.to_string()).collect::<Vec<_>>();
        assert_eq!(found[0].1, names(&["tree", "well"]));
        assert_eq!(found[1], (place(3.0, 2.0), names(&["late"])));
        assert_eq!(map.face_at(found[2].0), FaceId::UNBOUNDED);
        let corner = map
            .vertices()
            .find(|v| map.location(*v) == place(4.0, 0.0))
            .unwrap();
        assert!(map.vertex_labels(corner).contains("corner"));
        assert_eq!(
            (
                map.outgoing(corner).count(),
                map.outgoing(VertexId(4)).count()
            ),
            (2, 0)
        );
        // What the map is made of again.
        let again = PlanarMap::build(&map.to_curves(), resolution(4.0)).unwrap();
        assert_eq!(again.to_curves(), map.to_curves());
        assert_eq!(again.vertex_count(), 7);
    }

    #[test]
    fn points_alone_are_a_map_too() {
        let mut curves = Curves::new();
        curves.push_lone(Point::new(-3.0, 5.0), LabelSet::EMPTY);
        curves.push_lone(Point::new(7.0, -5.0), LabelSet::one("a"));
        let map = PlanarMap::build(&curves, resolution(10.0)).unwrap();
        map.check().unwrap();
        assert_eq!((map.vertex_count(), map.edge_count()), (2, 0));
        assert_eq!(map.location(VertexId(0)), Point::new(7.0, -5.0));
        assert!(map.vertex_labels(VertexId(1)).is_empty());
    }
}
