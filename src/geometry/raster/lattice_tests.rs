//! Georeferenced samples, and the gradient beside a slow one by the formula.

use std::sync::Arc;

use super::lattice::{Lattice, Place, Samples};
use crate::{Affine, Point, Seed};

struct Table(usize, Vec<f64>);

impl Samples for Table {
    fn size(&self) -> [usize; 2] {
        [self.0, self.1.len() / self.0]
    }

    fn sample(&self, column: usize, row: usize) -> f64 {
        self.1[row * self.0 + column]
    }
}

fn lattice(width: usize, values: Vec<f64>, frame: Affine) -> Lattice {
    Lattice::new(Arc::new(Table(width, values)), frame, None).unwrap()
}

const UP: Affine = Affine([10.0, 0.0, 0.0, -10.0, 1000.0, 2000.0]);

#[test]
fn samples_stand_in_the_middle_and_end_with_their_pixels() {
    let nothing = f64::NAN;
    let raster = lattice(2, vec![1.0, 3.0, 5.0, nothing], UP);
    let at = |x: f64, y: f64| Point::new(1000.0 + x, 2000.0 - y);
    assert_eq!(raster.bilinear(at(5.0, 5.0)), 1.0);
    assert_eq!(raster.bilinear(at(10.0, 5.0)), 2.0);
    // In the outermost half pixel the edge goes on, and outside there is nothing.
    assert_eq!(raster.bilinear(at(0.0, 0.0)), 1.0);
    assert_eq!(raster.nearest(at(9.9, 10.1)), 5.0);
    for (x, y) in [(-0.1, 5.0), (20.1, 5.0), (5.0, -0.1), (5.0, 20.1)] {
        assert!(raster.bilinear(at(x, y)).is_nan() && raster.nearest(at(x, y)).is_nan());
    }
    // The missing sample loses its weight, where the pixel itself has a value.
    assert_eq!(raster.bilinear(at(9.999, 9.999)).round(), 3.0);
    assert!(raster.bilinear(at(10.001, 10.001)).is_nan());
    assert_eq!(raster.middle(1, 1), at(15.0, 15.0));
    assert_eq!(raster.spacing(), Some(10.0));
}

/// Horn's gradient of the pixel in column `i` and row `j`, by the formula on a table that is one wider on all sides.
fn slow_gradient(table: &Table, i: usize, j: usize, step: f64) -> Point {
    let [width, height] = table.size();
    let mut wide = vec![vec![0.0; width + 2]; height + 2];
    for row in 0..height {
        for column in 0..width {
            wide[row + 1][column + 1] = table.sample(column, row);
        }
        let line = &mut wide[row + 1];
        line[0] = 2.0 * line[1] - line[2];
        line[width + 1] = 2.0 * line[width] - line[width - 1];
    }
    let above = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| 2.0 * a - b).collect();
    wide[0] = above(&wide[1], &wide[2]);
    wide[height + 1] = above(&wide[height], &wide[height - 1]);
    let z = |di: usize, dj: usize| wide[j + dj][i + di];
    let east = z(2, 0) + 2.0 * z(2, 1) + z(2, 2) - z(0, 0) - 2.0 * z(0, 1) - z(0, 2);
    let north = z(0, 0) + 2.0 * z(1, 0) + z(2, 0) - z(0, 2) - 2.0 * z(1, 2) - z(2, 2);
    Point::new(east, north) * (0.125 / step)
}

#[test]
fn gradients_at_samples_are_those_of_the_formula_edges_included() {
    let seed = Seed::root(5);
    let values: Vec<f64> = (0..35).map(|k| seed.range(k, 0.0, 100.0)).collect();
    let table = Table(7, values.clone());
    let raster = lattice(7, values, UP);
    for (i, j) in (0..7).flat_map(|i| (0..5).map(move |j| (i, j))) {
        let expected = slow_gradient(&table, i, j, 10.0);
        let found = raster.gradient(raster.middle(i, j));
        assert!(
            found.distance(expected) < 1e-9,
            "{i} {j}: {found:?} {expected:?}"
        );
    }
}

#[test]
fn the_gradient_of_a_plane_is_its_own_however_the_raster_is_turned() {
    let slope = Point::new(0.3, -0.2);
    let frame = Affine::scale(4.0, -2.5)
        .then(Affine::rotation(0.7))
        .then(Affine::translation(Point::new(5e5, 4e6)));
    let middle = |k: usize| frame.apply(Point::new((k % 9) as f64 + 0.5, (k / 9) as f64 + 0.5));
    let origin = middle(40);
    let values = (0..81).map(|k| (middle(k) - origin).dot(slope)).collect();
    let raster = lattice(9, values, frame);
    for k in [0, 8, 13, 40, 72, 80] {
        let found = raster.gradient(middle(k).lerp(origin, 0.03));
        assert!(found.distance(slope) < 1e-7, "{k}: {found:?}");
    }
    // In a plane that is scaled by 2 the same ground rises half as fast.
    let place = Place {
        into: Arc::new(|p: Point| p * 0.5),
        back: Arc::new(|p: Point| p * 2.0),
        turn: None,
    };
    let scaled = Lattice::new(raster.samples().clone(), frame, Some(place)).unwrap();
    assert!(scaled.gradient(origin * 2.0).distance(slope * 0.5) < 1e-7);
    let spread = scaled.spacing().unwrap() / raster.spacing().unwrap();
    assert!((spread - 2.0).abs() < 1e-9);
}

/// A plane whose x goes around after 100, as longitudes do.
#[test]
fn the_gradient_has_no_jump_where_the_way_around_begins_again() {
    let values = (0..40).map(|k| (k % 10) as f64).collect();
    let frame = Affine::scale(10.0, 10.0);
    let place = Place {
        into: Arc::new(|p: Point| Point::new(p.x - 100.0 * (p.x / 100.0 - 0.5).round(), p.y)),
        back: Arc::new(|p: Point| p),
        turn: Some(100.0),
    };
    let round = lattice(10, values, frame);
    let round = Lattice::new(round.samples().clone(), frame, Some(place)).unwrap();
    for x in [99.9, 100.0, 100.1, 200.0] {
        let found = round.gradient(Point::new(x, 20.0));
        assert!(
            found.distance(Point::new(0.1, 0.0)) < 1e-9,
            "{x}: {found:?}"
        );
    }
}

#[test]
fn roughness_is_the_greatest_less_the_least_of_nine() {
    let mut values = vec![1.0; 25];
    values[6] = -4.0;
    values[18] = 7.0;
    values[13] = f64::NAN;
    let raster = lattice(5, values, UP);
    assert_eq!(raster.roughness(raster.middle(2, 2)), 11.0);
    assert_eq!(raster.roughness(raster.middle(4, 0)), 0.0);
    assert!(raster.roughness(raster.middle(3, 2)).is_nan());
}
