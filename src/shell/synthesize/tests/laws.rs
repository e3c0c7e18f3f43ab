//! What holds for every synthesis: costs add up as the formula says and never rise, threads do not show.

use super::*;
use crate::synthesize::energy::{Problem, State};
use crate::synthesize::label::{DIRECTIONS, SHIFTS, TURNS, direction, label};
use crate::synthesize::optimize::{Schedule, enforce, jitter, pass};
use crate::synthesize::stack::difference;

/// The energy of section 4.2.2 as it is written: over all pairs of voxels, asking for every one whether
/// they are neighbours.
fn energy(problem: &Problem, state: &State) -> u64 {
    let cells = &problem.surface.voxels.cells;
    let normals = &problem.surface.normals;
    let is_near = |v: usize, w: usize| {
        let cosine: f32 = (0..3).map(|axis| normals[v][axis] * normals[w][axis]).sum();
        v != w && (0..3).all(|axis| cells[v][axis].abs_diff(cells[w][axis]) <= 2) && cosine > -0.3
    };
    let mut sum = 0;
    for v in 0..cells.len() {
        let own = state.labels[v];
        sum += u64::from(problem.alone(v, own, problem.phase(v, own)));
        for w in (v + 1..cells.len()).filter(|w| is_near(v, *w)) {
            let other = state.labels[w];
            for at in [v, w] {
                let shown = [own, other].map(|label| problem.shown(at, label));
                sum += u64::from(difference(shown[0], shown[1]));
            }
        }
    }
    sum
}

#[test]
fn costs_are_those_of_the_formula_and_no_pass_raises_them() {
    let levels = levels(&shapes::torus(11.0, 5.0, 48));
    for exemplar in [exemplars::hooks(), exemplars::keys()] {
        let mut exemplar = exemplar;
        exemplar.pixel_size = 0.25;
        let options = Options::default();
        let synthesizer = Synthesizer::new(&levels, &exemplar, &options).unwrap();
        let count = levels[0].surface.voxels.len();
        let bound: Vec<bool> = (0..count).map(|v| v % 97 == 0).collect();
        let problem = synthesizer.problem(0, &bound);
        let schedule = Schedule::of(&levels[0].surface.voxels.cells, |_| true);
        let mut state = problem.state(vec![0; count]);
        jitter(&problem, &mut state, &schedule, (0.5, options.seed));
        enforce(&problem, &mut state, &schedule);
        let mut before = problem.total(&state);
        assert_eq!(before, energy(&problem, &state));
        for number in 0..4 {
            let gain = pass(&problem, &mut state, &schedule, (number, options.seed));
            let after = problem.total(&state);
            assert_eq!(after, before - gain);
            assert_eq!(after, energy(&problem, &state));
            assert!(number > 0 || after < before / 2, "{after} {before}");
            before = after;
            assert!((0..count).all(|v| problem.allows(v, state.labels[v])));
        }
    }
}

/// On each level, from the labels of the one above it, the energy never rises (S3): over random exemplars, some of which do not
/// tile.
#[test]
fn no_pass_raises_the_energy_on_any_level() {
    let levels = levels(&shapes::torus(12.0, 6.0, 48));
    for number in 0..8 {
        let mut exemplar = exemplars::blots(number);
        exemplar.tileable = number % 3 > 0;
        let options = Options {
            seed: fretwork_geometry::Seed::root(number),
            ..Options::default()
        };
        let synthesizer = Synthesizer::new(&levels, &exemplar, &options).unwrap();
        let coarsest = levels.len() - 1;
        let mut above: Vec<u32> = Vec::new();
        let mut fallen = 0;
        for level in (0..=coarsest).rev() {
            let cells = &levels[level].surface.voxels.cells;
            let labels = match level == coarsest {
                true => vec![0; cells.len()],
                false => levels[level]
                    .parents
                    .iter()
                    .map(|p| above[*p as usize])
                    .collect(),
            };
            let problem = synthesizer.problem(level, &[]);
            let schedule = Schedule::of(cells, |_| true);
            let mut state = problem.state(labels);
            let seed = options.seed.number(level as i64);
            jitter(&problem, &mut state, &schedule, (0.1, seed));
            let first = problem.total(&state);
            let mut before = first;
            for pass_number in 0..5 {
                pass(&problem, &mut state, &schedule, (pass_number, seed));
                let after = problem.total(&state);
                assert!(after <= before, "{number}, {level}: {after} after {before}");
                before = after;
            }
            fallen += usize::from(before < first);
            above = state.labels;
        }
        assert!(fallen >= coarsest, "{number}: {fallen} of {}", levels.len());
    }
}

#[test]
fn phases_are_projections() {
    let levels = sphere();
    let exemplar = exemplars::keys();
    let synthesizer = Synthesizer::new(&levels, &exemplar, &Options::default()).unwrap();
    for (level, voxels) in levels.iter().enumerate().take(2) {
        let problem = synthesizer.problem(level, &[]);
        let cells = &voxels.surface.voxels.cells;
        for n in 0..2000u32 {
            let voxel = n as usize * 7 % cells.len();
            let shift = [n % SHIFTS, n / 3 % SHIFTS];
            let label = label(n as usize % DIRECTIONS, shift, n / 5 % TURNS);
            let up = problem.planes.up(label);
            let normal = problem.planes.normals[direction(label)];
            let right = [0, 1, 2].map(|i| {
                let [j, k] = [(i + 1) % 3, (i + 2) % 3];
                f64::from(up[j] * normal[k] - up[k] * normal[j])
            });
            let middle = cells[voxel].map(|c| (f64::from(c) + 0.5) * f64::from(1 << level));
            let x: f64 = (0..3).map(|i| middle[i] * right[i]).sum::<f64>() / 80.0;
            let y: f64 = (0..3).map(|i| middle[i] * f64::from(up[i])).sum::<f64>() / -80.0;
            let phase = problem
                .phase(voxel, label)
                .map(|p| f64::from(p) / 2f64.powi(32));
            for (phase, at, shift) in [(phase[0], x, shift[0]), (phase[1], y, shift[1])] {
                let off = phase - at - f64::from(shift) / 16.0;
                assert!((off - off.round()).abs() < 1e-5, "{label}: {off}");
            }
        }
    }
}

#[test]
fn threads_do_not_show() {
    let levels = sphere();
    let exemplar = exemplars::stripes();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            let options = Options::default();
            let synthesizer = Synthesizer::new(&levels, &exemplar, &options).unwrap();
            let first = synthesizer.synthesize();
            let forced: Vec<bool> = (0..first.solid.len()).map(|v| v % 301 == 0).collect();
            (synthesizer.resynthesize(&first, &forced).unwrap(), first)
        })
    };
    let one = with(1);
    assert!(one == with(2) && one == with(7));
}

#[test]
fn seeds_give_other_textures() {
    let levels = sphere();
    let exemplar = exemplars::hooks();
    let with = |seed: u64| {
        let seed = fretwork_geometry::Seed::root(seed);
        made(
            &levels,
            &exemplar,
            &Options {
                seed,
                ..Options::default()
            },
        )
    };
    let (a, b) = (with(1), with(2));
    let differ = (0..a.solid.len()).filter(|&v| a.solid[v] != b.solid[v]);
    assert!(differ.count() * 10 > a.solid.len());
}
