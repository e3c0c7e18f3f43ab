//! Laws that hold for every input, tried on curves from far apart to far below the resolution.

use proptest::prelude::*;

use super::super::noding::snap_grid::RESOLUTION;
use super::super::*;
use crate::{Affine, CurveLabels, Curves, LabelSet, Point};

const FINENESS: f64 = 1.0 / (1u64 << 20) as f64;
const UNIT: f64 = FINENESS / RESOLUTION;

/// Polylines on the grid: within a square of `span` units, at multiples of `step`.
fn polylines() -> impl Strategy<Value = Vec<Vec<Point>>> {
    let spans = prop::sample::select(vec![2u64, 40, 256, 700, 2000, 10_000, 1 << 20, 1 << 42]);
    let steps = prop::sample::select(vec![1u64, 16, 100, 256, u64::MAX]);
    (spans, steps).prop_flat_map(|(span, step)| {
        let step = step.min(span / 4 + 1);
        let coordinate = (0..=span / step).prop_map(move |v| (v * step) as f64 * UNIT);
        let point = (coordinate.clone(), coordinate).prop_map(|(x, y)| Point::new(x, y));
        prop::collection::vec(prop::collection::vec(point, 2..6), 1..14)
    })
}

fn curves_of(lines: &[Vec<Point>]) -> Curves {
    let mut curves = Curves::new();
    for (i, line) in lines.iter().enumerate() {
        let one = |kind: &str| LabelSet::one(&format!("{kind}{}", i % 3));
        let labels = CurveLabels {
            edge: one("e"),
            left: one("l"),
            right: one("r"),
            start: one("s"),
            end: one("t"),
        };
        curves.push(line.iter().copied(), labels);
    }
    curves
}

fn built(curves: &Curves) -> PlanarMap {
    let map = PlanarMap::build(curves, FINENESS).unwrap();
    map.check().unwrap();
    map
}

/// Everything about the cells but the orientation of the edges.
fn cells(map: &PlanarMap) -> impl PartialEq + std::fmt::Debug + use<> {
    let vertices: Vec<_> = map
        .vertices()
        .map(|v| (map.location(v), map.vertex_labels(v)))
        .collect();
    let edges: Vec<_> = map
        .edges()
        .map(|e| {
            let (points, labels) = (map.points(e).collect::<Vec<_>>(), map.labels(e));
            let forward = (points.clone(), map.left(e), map.right(e), labels);
            let backward = (
                points.into_iter().rev().collect(),
                map.right(e),
                map.left(e),
                labels.reversed(),
            );
            // A loop may begin in either direction; of a palindrome the sides decide.
            if (&forward.0, forward.1) <= (&backward.0, backward.1) {
                forward
            } else {
                backward
            }
        })
        .collect();
    let faces: Vec<_> = map
        .bounded_faces()
        .map(|f| (map.face_labels(f), map.inner_boundaries(f).count()))
        .collect();
    (vertices, edges, faces, map.component_count())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_map_of_the_edges_of_a_map_is_the_same_map(lines in polylines()) {
        let map = built(&curves_of(&lines));
        prop_assert_eq!(cells(&map), cells(&built(&map.to_curves())));
    }

    #[test]
    fn order_and_direction_of_the_curves_decide_only_orientations(
        lines in polylines(), flips in prop::collection::vec(any::<bool>(), 14), turn in 0usize..14,
    ) {
        let curves = curves_of(&lines);
        let mut other = Curves::new();
        for k in 0..lines.len() {
            let i = (lines.len() * 2 - k + turn) % lines.len();
            let curve = curves.get(i);
            if flips[i] {
                other.push(curve.points.iter().rev().copied(), curve.labels.reversed());
            } else {
                other.push(curve.points.iter().copied(), curve.labels);
            }
        }
        prop_assert_eq!(cells(&built(&curves)), cells(&built(&other)));
    }

    #[test]
    fn translation_by_grid_units_moves_the_map(lines in polylines(), dx in -1_000_000i32..1_000_000, dy in any::<i32>()) {
        let curves = curves_of(&lines);
        let by = Point::new(f64::from(dx) * UNIT, f64::from(dy) * UNIT);
        let moved = built(&curves.transformed(&Affine::translation(by))).to_curves();
        prop_assert_eq!(built(&curves).to_curves().transformed(&Affine::translation(by)), moved);
    }

    #[test]
    fn every_point_of_a_curve_is_near_the_map(lines in polylines()) {
        let map = built(&curves_of(&lines));
        let total: f64 = lines.iter().flat_map(|l| l.windows(2)).map(|w| w[0].distance(w[1])).sum();
        prop_assert!(map.length() <= total * 1.5 + 1000.0 * FINENESS);
        let first = map.vertices().next().map(|v| map.location(v));
        prop_assert_eq!(first.is_none(), map.edge_count() == 0);
    }
}
