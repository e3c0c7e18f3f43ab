//! Exemplars drawn here.

use fretwork_geometry::Pixels;

/// An exemplar of `size` pixels a side that is solid where a function of the place in it, from 0 to 1,
/// says so.
fn drawn(size: usize, tileable: bool, is_solid: impl Fn(f64, f64) -> bool) -> Pixels {
    let at = |n: usize| (n as f64 + 0.5) / size as f64;
    let solid: Vec<bool> = (0..size * size)
        .map(|n| is_solid(at(n % size), at(n / size)))
        .collect();
    Pixels {
        width: size,
        rgb: solid
            .iter()
            .map(|s| if *s { [40, 30, 60] } else { [240, 220, 180] })
            .collect(),
        solid,
        pixel_size: 1.0,
        feature_radius: None,
        tileable,
    }
}

/// Dots on a staggered lattice.
pub(crate) fn dots() -> Pixels {
    drawn(64, true, |x, y| {
        let near = |cx: f64, cy: f64| {
            let off = |a: f64, b: f64| (a - b) - (a - b).round();
            off(x * 3.0, cx).powi(2) + off(y * 3.0, cy).powi(2) < 0.06
        };
        near(0.25, 0.25) || near(0.75, 0.75)
    })
}

/// Stripes along x that wander.
pub(crate) fn stripes() -> Pixels {
    drawn(96, true, |x, y| {
        let wave = libm::sin(x * std::f64::consts::TAU) * 0.04;
        ((y + wave) * 6.0).rem_euclid(1.0) < 0.45
    })
}

/// Hooks: arcs of three quarters of a circle with a tail, of alternate hand.
pub(crate) fn hooks() -> Pixels {
    drawn(96, true, |x, y| {
        let cell = [(x * 3.0).floor(), (y * 3.0).floor()];
        let mirror = if (cell[0] + cell[1]) as i64 % 2 == 0 {
            1.0
        } else {
            -1.0
        };
        let [u, v] = [(x * 3.0 - cell[0] - 0.5) * mirror, y * 3.0 - cell[1] - 0.5];
        let ring = ((u * u + (v + 0.08) * (v + 0.08)).sqrt() - 0.28).abs() < 0.1;
        let tail = (u - 0.28).abs() < 0.1 && v > 0.0 && v < 0.42;
        (ring && !(u < 0.0 && v > -0.1)) || tail
    })
}

/// Rectangles of several widths in rows, of an exemplar that does not tile.
pub(crate) fn keys() -> Pixels {
    drawn(80, false, |x, y| {
        let row = (y * 5.0).floor();
        let width = 3.0 + row * 0.7;
        let inside = |a: f64| (0.12..0.88).contains(&a.rem_euclid(1.0));
        inside(x * width + row * 0.3) && inside(y * 5.0)
    })
}

/// Blots: random grey, blurred, and the part of it that is above a threshold near its middle.
pub(crate) fn blots(number: u64) -> Pixels {
    const SIDE: usize = 32;
    let seed = fretwork_geometry::Seed::root(number);
    let mut grey: Vec<f64> = (0..SIDE * SIDE).map(|n| seed.unit(n as u64)).collect();
    for _ in 0..3 {
        let at = |x: usize, y: usize| grey[y % SIDE * SIDE + x % SIDE];
        let around = |n: usize| {
            let (x, y) = (n % SIDE + SIDE, n / SIDE + SIDE);
            let beside = [(x, y), (x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)];
            beside.iter().map(|(x, y)| at(*x, *y)).sum::<f64>() / 5.0
        };
        grey = (0..SIDE * SIDE).map(around).collect();
    }
    let mean = grey.iter().sum::<f64>() / grey.len() as f64;
    let least = mean + 0.04 * (seed.unit(u64::MAX) - 0.5);
    let pixel = |x: f64, y: f64| {
        grey[(y * SIDE as f64) as usize * SIDE + (x * SIDE as f64) as usize] > least
    };
    drawn(SIDE, true, pixel)
}
