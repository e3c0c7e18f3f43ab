//! Shapes around the poles and across the date line, brought back to where they came from.

use super::*;
use fretwork_source::geo::crs::Crs;

fn crs(code: u32) -> Crs {
    Crs::of_epsg(code).unwrap()
}

fn earth(code: u32) -> Earth {
    let transform = Transform::new(crs(code), Crs::wgs84().unwrap());
    Earth { transform }
}

/// The areas of the parts of an area on a plane, brought back to it.
fn kept(code: u32, area: &Polygon) -> (usize, f64) {
    let earth = earth(code);
    let back = earth.transform.inverse();
    let parts = earth.areas(area).unwrap();
    let ring = |ring: &Vec<Point>| -> f64 {
        assert!(ring.iter().all(|p| p.x.abs() <= 180.0 && p.y.abs() <= 90.0));
        let on_plane: Vec<Point> = ring.iter().map(|p| back.apply(*p).unwrap()).collect();
        signed_area(&on_plane).abs()
    };
    let one = |part: &Polygon| {
        assert!(signed_area(&part.outer) > 0.0);
        ring(&part.outer) - part.holes.iter().map(ring).sum::<f64>()
    };
    (parts.len(), parts.iter().map(one).sum())
}

fn circle(x: f64, y: f64, radius: f64, count: usize) -> Vec<Point> {
    let angle = |k: usize| std::f64::consts::TAU * k as f64 / count as f64;
    let point = |k| {
        Point::new(
            x + radius * libm::cos(angle(k)),
            y + radius * libm::sin(angle(k)),
        )
    };
    (0..count).map(point).collect()
}

fn polygon(outer: Vec<Point>, holes: Vec<Vec<Point>>) -> Polygon {
    Polygon { outer, holes }
}

#[test]
fn areas_around_a_pole_and_across_the_date_line_keep_their_size() {
    for code in [3031, 3995] {
        let cases = [
            (1, polygon(circle(0.0, 0.0, 2e6, 37), vec![])),
            (1, polygon(circle(3e5, -4e5, 2e6, 4), vec![])),
            (
                1,
                polygon(circle(0.0, 0.0, 2e6, 36), vec![circle(1e4, 0.0, 1e6, 24)]),
            ),
            (
                1,
                polygon(circle(0.0, 0.0, 2e6, 36), vec![circle(9e5, 0.0, 1e5, 24)]),
            ),
            (2, polygon(circle(0.0, 1e6, 5e5, 36), vec![])),
            (2, polygon(circle(0.0, -1e6, 5e5, 5), vec![])),
            (
                2,
                polygon(circle(0.0, 1e6, 5e5, 36), vec![circle(0.0, 1e6, 1e5, 12)]),
            ),
        ];
        for (number, (_, area)) in cases.iter().enumerate() {
            let whole = signed_area(&area.outer)
                - area.holes.iter().map(|h| signed_area(h).abs()).sum::<f64>();
            let (_, found) = kept(code, area);
            assert!(
                (found - whole).abs() < 1e-6 * whole,
                "EPSG:{code}, case {number}: {found} of {whole}"
            );
        }
    }
}

#[test]
fn sectors_with_a_corner_in_the_pole_keep_their_size() {
    for turn in 0..8 {
        let angle = f64::from(turn) * 0.79;
        let on = |a: f64| Point::new(2e6 * libm::cos(a), 2e6 * libm::sin(a));
        let arc = (0..=10).map(|k| on(angle + f64::from(k) * 0.15));
        let ring: Vec<Point> = arc.chain([Point::ORIGIN]).collect();
        let whole = signed_area(&ring);
        let (_, found) = kept(3031, &polygon(ring, vec![]));
        assert!(
            (found - whole).abs() < 1e-6 * whole,
            "{turn}: {found} of {whole}"
        );
    }
}

#[test]
fn what_crosses_the_date_line_is_cut_there() {
    let back = earth(3832).transform.inverse();
    let on_plane = |points: &[[f64; 2]]| -> Vec<Point> {
        points
            .iter()
            .map(|p| back.apply((*p).into()).unwrap())
            .collect()
    };
    let lines = earth(3832)
        .lines(&on_plane(&[[178.0, 0.0], [182.0, 4.0]]))
        .unwrap();
    let ends: Vec<f64> = lines
        .iter()
        .flatten()
        .map(|p| (p.x * 1e6).round() / 1e6)
        .collect();
    assert_eq!(ends, [178.0, 180.0, -180.0, -178.0]);
    assert!((lines[0][1].y - 2.0).abs() < 2e-3 && lines[0][1].y == lines[1][0].y);
    let square = on_plane(&[[179.0, 0.0], [181.0, 0.0], [181.0, 1.0], [179.0, 1.0]]);
    let parts = earth(3832).areas(&polygon(square, vec![])).unwrap();
    assert_eq!(parts.len(), 2);
}

#[test]
fn what_touches_the_date_line_or_goes_the_long_way_stays_whole() {
    let back = earth(3857).transform.inverse();
    let on_plane = |points: &[[f64; 2]]| -> Vec<Point> {
        points
            .iter()
            .map(|p| back.apply((*p).into()).unwrap())
            .collect()
    };
    for line in [[[170.0, 0.0], [180.0, 4.0]], [[-180.0, 0.0], [-170.0, 4.0]]] {
        let lines = earth(3857).lines(&on_plane(&line)).unwrap();
        assert_eq!(lines.len(), 1, "{lines:?}");
    }
    let world = [
        [-180.0, -80.0],
        [180.0, -80.0],
        [180.0, 80.0],
        [-180.0, 80.0],
    ];
    for west in [0.0, 7.0] {
        let world = on_plane(&world.map(|[x, y]| [x + f64::copysign(west, -x), y]));
        let parts = earth(3857).areas(&polygon(world, vec![])).unwrap();
        assert_eq!(parts.len(), 1, "{parts:?}");
        let width = parts[0].bounds().width();
        assert!((width - 360.0 + 2.0 * west).abs() < 1e-6, "{parts:?}");
    }
}
