//! The full analysis of thin shells: balls of five voxels' thickness with the holes of a cellular pattern,
//! standing on their lowest tenth. Beside it, on 857,000 voxels, an algebraic multigrid takes 25 times
//! the processor and 11 times the memory, and a direct solver 24 times the processor.

use fretwork::geometry::voxel::{Lattice, Voxel, Voxels};
use fretwork::geometry::{Point3, Seed};
use fretwork::shell::analyse::{Body, Case, Material, MemoryLimit, Model, Summary, Zone};

use crate::Bench;

/// The width of the ball in voxels, for about 200,000 and 700,000 of them.
const WIDTHS: [(u16, &str); 2] = [(128, "200k"), (240, "700k")];

/// The mean width of a cell, and of the bars between holes, in voxels.
const CELL: f64 = 24.0;
const BAR: f64 = 9.0;

/// Runs the benchmarks named `analyse/...`.
pub fn run(bench: &Bench) {
    for (width, name) in WIDTHS {
        bench.run(
            &format!("analyse/shell_{name}"),
            || shell(width),
            |voxels| format!("{} voxels, {}", voxels.len(), analyse(voxels)),
        );
    }
    for (width, name) in WIDTHS {
        bench.run(
            &format!("analyse/sweep_{name}"),
            || shell(width),
            |voxels| format!("{} voxels, {}", voxels.len(), sweep(voxels)),
        );
    }
}

/// The weight of a body that stands.
fn standing() -> Case<'static> {
    Case {
        gravity: [0.0, 0.0, -9.81],
        loads: Vec::new(),
    }
}

fn set_up(voxels: &Voxels, limit: MemoryLimit) -> Model {
    let body = Body {
        voxels,
        metres_per_unit: 1e-3,
    };
    let material = Material {
        youngs_modulus: 2.3e9,
        poisson_ratio: 0.35,
        density: 1040.0,
        yield_strength: None,
        across_layers: None,
    };
    let bounds = body.bounds();
    let foot = Zone::Lowest(0.1 * bounds.size().z);
    let is_held = |p: Point3| foot.contains(p, &bounds);
    Model::new(&body, &material, &is_held, limit).expect("it is held")
}

/// Sets up and solves one load case.
fn analyse(voxels: &Voxels) -> String {
    let begin = processor_seconds();
    let model = set_up(voxels, MemoryLimit::default());
    let setup = processor_seconds() - begin;
    let found = model.analyse(&standing()).expect("it is one piece").summary;
    format!(
        "{} unknowns, {} iterations, setup {setup:.1} s, all {:.1} s of processor, {:.0} MB, \
         p99 {:.4e} Pa, residual {:.1e}, error {:.1e}",
        model.unknown_count(),
        found.iterations,
        processor_seconds() - begin,
        peak_megabytes(),
        found.stress_sums.p99,
        found.residual,
        found.energy_error,
    )
}

/// Bytes a voxel that are enough for one load case after the other, and not for four together.
const ONE_BY_ONE: u64 = 1150;

/// Sets up once, then solves one load case, and gravity from fourteen directions: one after the other, as where
/// memory is short, and together.
fn sweep(voxels: &Voxels) -> String {
    let apart = set_up(voxels, MemoryLimit(voxels.len() as u64 * ONE_BY_ONE));
    let begin = processor_seconds();
    apart.sweep(&standing()).expect("it is one piece");
    let one_by_one = processor_seconds() - begin;
    drop(apart);
    let model = set_up(voxels, MemoryLimit::default());
    let begin = processor_seconds();
    model.analyse(&standing()).expect("it is one piece");
    let one = processor_seconds() - begin;
    let (_, swept) = model.sweep(&standing()).expect("it is one piece");
    let all = processor_seconds() - begin - one;
    let stress = |(_, summary): &&([f64; 3], Summary)| summary.stress_sums.p99;
    let directions = swept.directions.iter();
    let worst = directions.max_by(|a, b| stress(a).total_cmp(&stress(b)));
    let worst = worst.expect("there are fourteen");
    format!(
        "without setup one case {one:.1} s, 14 directions {all:.1} s of processor, one by one {one_by_one:.1} s \
         ({:.2} times), {:.0} MB, worst {:?} p99 {:.4e} Pa",
        one_by_one / all,
        peak_megabytes(),
        worst.0,
        worst.1.stress_sums.p99,
    )
}

/// The largest piece of the pattern on a ball.
fn shell(width: u16) -> Voxels {
    let radius = f64::from(width) / 2.0;
    let range = || 0..width;
    let all = range().flat_map(|x| range().flat_map(move |y| range().map(move |z| [x, y, z])));
    let is_solid = |voxel: &Voxel| {
        let p = voxel.map(|n| f64::from(n) + 0.5 - radius);
        let distance = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        // The pattern is the same through the thickness.
        (radius - 5.0..radius).contains(&distance)
            && between_cells(p.map(|x| x / distance * radius / CELL + 100.0)) * CELL < BAR
    };
    let lattice = Lattice {
        origin: Point3::ORIGIN,
        pitch: 1.0,
    };
    largest_piece(Voxels::new(lattice, all.filter(is_solid).collect()))
}

/// How much farther the second nearest of scattered points is than the nearest.
fn between_cells(p: [f64; 3]) -> f64 {
    let cell = p.map(|x| x.floor() as i64);
    let (mut nearest, mut second) = (f64::MAX, f64::MAX);
    for number in 0..27 {
        let shift = [number / 9 - 1, number / 3 % 3 - 1, number % 3 - 1];
        let [x, y, z] = [0, 1, 2].map(|k| cell[k] + shift[k]);
        let seed = Seed::root(7).number(x).number(y).number(z);
        let along = |k: usize| [x, y, z][k] as f64 + seed.unit(k as u64) - p[k];
        let distance = (0..3).map(|k| along(k).powi(2)).sum::<f64>().sqrt();
        if distance < nearest {
            (nearest, second) = (distance, nearest);
        } else {
            second = second.min(distance);
        }
    }
    second - nearest
}

/// The most voxels that are joined through faces.
fn largest_piece(voxels: Voxels) -> Voxels {
    let mut piece = vec![usize::MAX; voxels.len()];
    let mut sizes: Vec<usize> = Vec::new();
    for first in 0..voxels.len() {
        if piece[first] != usize::MAX {
            continue;
        }
        let (mut open, mut size) = (vec![first], 0);
        piece[first] = sizes.len();
        while let Some(voxel) = open.pop() {
            size += 1;
            for side in 0..6 {
                let mut next = voxels.cells[voxel];
                let along = &mut next[side / 2];
                *along = along.wrapping_add(if side % 2 == 0 { 1 } else { u16::MAX });
                if let Some(next) = voxels.find(next).filter(|next| piece[*next] == usize::MAX) {
                    piece[next] = sizes.len();
                    open.push(next);
                }
            }
        }
        sizes.push(size);
    }
    let best = (0..sizes.len()).max_by_key(|piece| sizes[*piece]);
    let cells = voxels.cells.iter().zip(&piece);
    let kept = cells.filter(|(_, piece)| Some(**piece) == best);
    Voxels::new(voxels.lattice, kept.map(|(cell, _)| *cell).collect())
}

/// The processor seconds of all threads so far, where the system tells.
pub fn processor_seconds() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields = text.rsplit(')').next().unwrap_or("").split_whitespace();
    let ticks = fields
        .skip(11)
        .take(2)
        .filter_map(|x| x.parse::<f64>().ok());
    ticks.sum::<f64>() / 100.0
}

/// The greatest resident size of the process so far, where the system tells.
pub fn peak_megabytes() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmHWM:"));
    let kibibytes = line.and_then(|line| line.split_whitespace().nth(1)?.parse::<f64>().ok());
    kibibytes.unwrap_or(0.0) / 1024.0
}
