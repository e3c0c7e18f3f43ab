//! Fields that have a value for each of some faces or points: what a table says of the features of a map. How a field is
//! read and compared is in `field`.

use crate::index::{BoxTree, Extent};
use crate::raster::field::digest;
use crate::{Bounds, Field, Point, Polygon};

impl Field {
    /// The value of the face that a point lies in, the first one that fits, NaN outside of all.
    pub fn per_face(faces: Vec<(Vec<Polygon>, f64)>) -> Field {
        let mut hasher = blake3::Hasher::new();
        for (area, value) in &faces {
            hasher.update(&value.to_le_bytes());
            for ring in area.iter().flat_map(Polygon::rings) {
                hasher.update(&(ring.len() as u64).to_le_bytes());
                for p in ring {
                    hasher.update(&p.x.to_le_bytes()).update(&p.y.to_le_bytes());
                }
            }
        }
        let extent = |(area, _): &(Vec<Polygon>, f64)| {
            Extent::from(area.iter().fold(Bounds::EMPTY, |b, p| b.union(p.bounds())))
        };
        let tree = BoxTree::new(&faces.iter().map(extent).collect::<Vec<_>>());
        let function = move |p: Point| {
            let near = tree.meeting(&Extent::from([p.x, p.y])).into_iter();
            let holds = |i: &u32| {
                faces[*i as usize]
                    .0
                    .iter()
                    .any(|polygon| polygon.contains(p))
            };
            let first = near.filter(holds).min();
            first.map_or(f64::NAN, |i| faces[i as usize].1)
        };
        Field::new(digest("faces", hasher.finalize().as_bytes()), function)
    }

    /// This field with other values at points: where one is no farther than `near` the nearest of them answers, the first of
    /// those equally near, and this field everywhere else.
    pub fn with_points(self, points: Vec<(Point, f64)>, near: f64) -> Field {
        let mut hasher = blake3::Hasher::new();
        hasher.update(&self.digest()).update(&near.to_le_bytes());
        for (at, value) in &points {
            for number in [at.x, at.y, *value] {
                hasher.update(&number.to_le_bytes());
            }
        }
        let extent = |(at, _): &(Point, f64)| Extent::from(Bounds::of([*at]).grown(near));
        let tree = BoxTree::new(&points.iter().map(extent).collect::<Vec<_>>());
        let own = digest("points", hasher.finalize().as_bytes());
        Field::new(own, move |p: Point| {
            let distance = |i: u32| (points[i as usize].0 - p).length();
            let around = tree.meeting(&Extent::from([p.x, p.y])).into_iter();
            let found = around
                .map(|i| (distance(i), i))
                .filter(|(distance, _)| *distance <= near)
                .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            found.map_or_else(|| self.value(p), |(_, i)| points[i as usize].1)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_have_values_and_fields_compare_by_digest() {
        let square = |a: f64, b: f64| {
            let outer = vec![
                Point::new(a, a),
                Point::new(b, a),
                Point::new(b, b),
                Point::new(a, b),
            ];
            vec![Polygon {
                outer,
                holes: vec![],
            }]
        };
        let field = Field::per_face(vec![(square(0.0, 1.0), 5.0), (square(2.0, 3.0), 7.0)]);
        assert_eq!(field.value(Point::new(2.5, 2.5)), 7.0);
        assert!(field.value(Point::new(1.5, 1.5)).is_nan());
        assert_eq!(
            field,
            Field::per_face(vec![(square(0.0, 1.0), 5.0), (square(2.0, 3.0), 7.0)])
        );
        assert_ne!(
            field,
            Field::per_face(vec![(square(0.0, 1.0), 5.0), (square(2.0, 3.0), 8.0)])
        );
    }

    #[test]
    fn points_have_values_of_their_own() {
        let points = vec![
            (Point::new(1.0, 1.0), 3.0),
            (Point::new(1.0, 1.0), 4.0),
            (Point::new(1.0, 1.5), f64::NAN),
            (Point::new(1.0 + 1e-6, 1.0), 5.0),
        ];
        let field = Field::constant(9.0).with_points(points.clone(), 1e-5);
        assert_eq!(field.value(Point::new(1.0, 1.0)), 3.0);
        assert_eq!(field.value(Point::new(1.0 + 9e-7, 1.0)), 5.0);
        assert_eq!(field.value(Point::new(1.0, 1.0 - 9e-6)), 3.0);
        assert_eq!(field.value(Point::new(1.0, 1.0 - 2e-5)), 9.0);
        assert!(field.value(Point::new(1.0, 1.5)).is_nan());
        assert_ne!(field, Field::constant(8.0).with_points(points, 1e-5));
    }
}
