//! Any bytes as a small body with a material, supports and loads: its analysis must end without a panic, with
//! figures or with a reason.
//!
//! `RUSTC_BOOTSTRAP=1 cargo fuzz run -s none --fuzz-dir tests/fuzz force_profile`
#![no_main]

use fretwork::geometry::Point3;
use fretwork::geometry::voxel::{Lattice, Voxels};
use fretwork::shell::analyse::{Body, Case, Load, Material, analyse};
use libfuzzer_sys::fuzz_target;

/// Numbers out of bytes: most are of a sensible size, some are not.
struct Numbers<'a>(&'a [u8]);

impl Numbers<'_> {
    fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.0.split_first() else {
            return 0;
        };
        self.0 = rest;
        *first
    }

    fn number(&mut self) -> f64 {
        match (self.byte(), self.byte()) {
            (255, odd) => [0.0, -1.0, f64::NAN, f64::INFINITY, 1e300, 1e-300][usize::from(odd) % 6],
            (size, part) => f64::from(part) / 16.0 * 10f64.powi(i32::from(size % 24) - 8),
        }
    }

    fn vector(&mut self) -> [f64; 3] {
        [self.number(), self.number(), self.number()]
    }
}

fuzz_target!(|bytes: &[u8]| {
    let mut numbers = Numbers(bytes);
    let material = Material {
        youngs_modulus: numbers.number(),
        poisson_ratio: numbers.number() / 16.0,
        density: numbers.number(),
        yield_strength: Some(numbers.number()),
        across_layers: None,
    };
    let (gravity, force) = (numbers.vector(), numbers.vector());
    let (foot, top) = (f64::from(numbers.byte() % 8), f64::from(numbers.byte() % 8));
    let metres_per_unit = numbers.number();
    // What is left is the body, a bit a voxel of 6 × 6 × 6.
    let is_solid = |n: u16| bytes.get(usize::from(n) / 8 + 24).is_some_and(|b| b >> (n % 8) & 1 == 1);
    let cells = (0..216).filter(|n| is_solid(*n)).map(|n| [n % 6, n / 6 % 6, n / 36]);
    let lattice = Lattice { origin: Point3::ORIGIN, pitch: 1.0 };
    let voxels = Voxels::new(lattice, cells.collect());
    let body = Body { voxels: &voxels, metres_per_unit };
    let at = move |p: Point3| p.z >= top;
    let case = Case { gravity, loads: vec![Load { at: &at, force }] };
    match analyse(&body, &material, &move |p: Point3| p.z <= foot, &[case]) {
        Ok(found) => {
            let summary = &found[0].summary;
            assert!(summary.largest_displacement.is_finite() && summary.stress_sums.max.is_finite());
            assert!(summary.stress_sums.median <= summary.stress_sums.p99);
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
