//! The planar map of random segments, grids, hatchings, clusters and stars.
//!
//! Exact constructions of CGAL 5.5 took 1.16 s on 20,000 random segments and 1.17 s on the
//! jittered grid, on two cores of a machine where a noding sketch without nesting took 0.31 s and 0.12 s.

use fretwork::geometry::planar_map::{PlanarMap, resolution};
use fretwork::geometry::{CurveLabels, Curves, LabelSet, Point, Seed};

use crate::Bench;

type Segments = Vec<[Point; 2]>;

/// Runs the benchmarks named `planar_map/...`.
pub fn run(bench: &Bench) {
    let time = |name: &str, segments: &dyn Fn() -> Segments| {
        bench.run(&format!("planar_map/{name}"), || curves(segments()), build);
    };
    time("random_10k", &|| random(10_000, 0.05));
    time("random_20k", &|| random(20_000, 0.05));
    time("jittered_grid_300", &|| grid(300, 0.6));
    time("aligned_grid_300", &|| grid(300, 0.0));
    for exponent in 3..=6 {
        let n = 10usize.pow(exponent);
        time(&format!("growth_1e{exponent}"), &|| {
            random(n, 2.0 / (n as f64).sqrt())
        });
    }
    time("hatching_aligned_2000", &|| hatching(2000, 0.0));
    time("hatching_turned_2000", &|| hatching(2000, 0.3));
    time("clusters", &|| {
        let (mut all, dense) = (random(50_000, 0.01), random(50_000, 0.01));
        all.extend(
            dense
                .into_iter()
                .map(|s| s.map(|p| Point::new(0.3, 0.4) + p * 1e-3)),
        );
        all
    });
    time("thicket_near_the_resolution", &|| {
        random(50_000, 0.01)
            .into_iter()
            .map(|s| s.map(|p| Point::new(0.7, 0.4) + p * 1e-5))
            .collect()
    });
    time("few_long_among_million_short", &|| {
        let mut all = random(1_000_000, 0.001);
        all.extend(random(10, 1.0));
        all
    });
    time("star_1000", &|| {
        let arm = |k: usize| Point::unit(k as f64 * std::f64::consts::PI / 1000.0) * 0.5;
        let center = Point::new(0.5, 0.5);
        (0..1000)
            .map(|k| [center - arm(k), center + arm(k)])
            .collect()
    });
    time("brick_wall_1000x1000", &|| bricks(1000));
}

fn build(curves: &Curves) -> String {
    match PlanarMap::build(curves, resolution(1.0)) {
        Ok(map) => format!(
            "V {} E {} F {} C {}",
            map.vertex_count(),
            map.edge_count(),
            map.face_count() + 1,
            map.component_count()
        ),
        Err(error) => error.to_string(),
    }
}

/// One labelled curve per segment.
fn curves(segments: Segments) -> Curves {
    let labels = CurveLabels {
        edge: LabelSet::one("edge"),
        left: LabelSet::one("left"),
        right: LabelSet::one("right"),
        ..CurveLabels::default()
    };
    let mut curves = Curves::new();
    for segment in segments {
        curves.push(segment, labels);
    }
    curves
}

fn random(count: usize, length: f64) -> Segments {
    let seed = Seed::root(1).name("bench");
    let segment = |i: usize| {
        let of = seed.number(i as i64);
        let start = Point::new(of.unit(0), of.unit(1));
        [
            start,
            start + Point::unit(of.range(2, 0.0, std::f64::consts::TAU)) * length,
        ]
    };
    (0..count).map(segment).collect()
}

/// The edges of a grid of squares whose corners are moved by up to half of `jitter` squares.
fn grid(side: i64, jitter: f64) -> Segments {
    let seed = Seed::root(2).name("bench");
    let corner = |x: i64, y: i64| {
        let of = seed.number(x).number(y);
        let moved = |v: i64, n| (v as f64 + jitter * (of.unit(n) - 0.5)) / side as f64;
        Point::new(moved(x, 0), moved(y, 1))
    };
    let mut segments = Vec::new();
    for y in 0..=side {
        for x in 0..=side {
            segments.extend((x < side).then(|| [corner(x, y), corner(x + 1, y)]));
            segments.extend((y < side).then(|| [corner(x, y), corner(x, y + 1)]));
        }
    }
    segments
}

/// `count` lines and `count` lines across.
fn hatching(count: usize, angle: f64) -> Segments {
    let (along, center) = (Point::unit(angle), Point::new(0.5, 0.5));
    let turned = |x: f64, y: f64| center + along * (x - 0.5) + along.left() * (y - 0.5);
    let offset = |i: usize| (i as f64 + 0.5) / count as f64;
    let line = |i: usize| {
        [
            [turned(0.0, offset(i)), turned(1.0, offset(i))],
            [turned(offset(i), 0.0), turned(offset(i), 1.0)],
        ]
    };
    (0..count).flat_map(line).collect()
}

/// Rows of bricks, every other one shifted by half a brick; one curve per side that two bricks share.
fn bricks(side: usize) -> Segments {
    let unit = 1.0 / side as f64;
    let mut segments = Vec::new();
    for row in 0..=side {
        for half in 0..2 * side {
            let point = |h: usize, r: usize| Point::new(h as f64 * unit / 2.0, r as f64 * unit);
            segments.push([point(half, row), point(half + 1, row)]);
            if row < side && half % 2 == row % 2 {
                segments.push([point(half, row), point(half, row + 1)]);
            }
        }
    }
    segments
}
