//! Any bytes as polylines: the map must be built without a panic, be consistent, be the map of its own
//! edges, and not depend on the order and the direction of the curves.
//!
//! `RUSTC_BOOTSTRAP=1 cargo fuzz run -s none --fuzz-dir tests/fuzz planar_map`
#![no_main]

use fretwork::geometry::planar_map::PlanarMap;
use fretwork::geometry::{CurveLabels, Curves, Point};
use libfuzzer_sys::fuzz_target;

/// A power of two, 512 grid units.
const RESOLUTION: f64 = 1.0 / 1024.0;
const UNIT: f64 = RESOLUTION / 512.0;

fuzz_target!(|data: &[u8]| {
    let Some((&[mode, scale], bytes)) = data.split_first_chunk() else { return };
    let lines = if mode % 4 == 0 { raw(bytes) } else { gridded(mode, scale, bytes) };
    let Ok(map) = PlanarMap::build(&curves(lines.iter().cloned()), RESOLUTION) else {
        assert!(mode % 4 == 0, "coordinates within the grid are never refused");
        return;
    };
    map.check().unwrap();
    let again = PlanarMap::build(&map.to_curves(), RESOLUTION).unwrap();
    assert_eq!(map.to_curves(), again.to_curves());
    let turned = lines.into_iter().rev().map(|line| line.into_iter().rev().collect());
    let turned = PlanarMap::build(&curves(turned), RESOLUTION).unwrap();
    let places = |m: &PlanarMap| m.vertices().map(|v| m.location(v)).collect::<Vec<_>>();
    assert_eq!(places(&map), places(&turned));
    assert_eq!((map.edge_count(), map.face_count()), (turned.edge_count(), turned.face_count()));
});

fn curves(lines: impl Iterator<Item = Vec<Point>>) -> Curves {
    let mut curves = Curves::new();
    for line in lines {
        curves.push(line, CurveLabels::default());
    }
    curves
}

/// Coordinates of any bits at all, four points a curve.
fn raw(bytes: &[u8]) -> Vec<Vec<Point>> {
    let numbers: Vec<f64> = bytes.as_chunks().0.iter().map(|c| f64::from_le_bytes(*c)).collect();
    let points: Vec<Point> = numbers.as_chunks().0.iter().map(|[x, y]| Point::new(*x, *y)).collect();
    points.chunks(4).map(<[Point]>::to_vec).collect()
}

/// Coordinates of one byte each, times a step in grid units; a curve ends where both are the same.
fn gridded(mode: u8, scale: u8, bytes: &[u8]) -> Vec<Vec<Point>> {
    let step = f64::from(1u32 << (scale % 24)) * if mode % 4 == 1 { 1.0 } else { f64::from(scale) + 0.5 };
    let point =
        |[x, y]: &[u8; 2]| Point::new((f64::from(*x) * step).floor() * UNIT, (f64::from(*y) * step).floor() * UNIT);
    let pairs = &bytes.as_chunks::<2>().0[..(bytes.len() / 2).min(200)];
    pairs.split(|[x, y]| x == y).map(|line| line.iter().map(point).collect()).collect()
}
