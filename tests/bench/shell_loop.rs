//! One step of the structural loop beside the assembly of its equations, and how many iterations analyses of walls take.

use std::cell::RefCell;
use std::time::{Duration, Instant};

use fretwork::geometry::{Point3, Side};
use fretwork::shell::analyse::{Body, Case, Material, MemoryLimit, Model, Zone};
use fretwork::shell::connect::SurfaceGraph;
use fretwork::shell::finish::{Thickness, finish, widened};
use fretwork::shell::reinforce::{Kept, Profile, Settings};
use fretwork::shell::synthesize::{Options, Synthesizer};

use super::shell::{levels, torus};
use super::shell_pictures::{PICTURES, Picture, pixels, waves};
use crate::Bench;

const ABS: Material = Material {
    youngs_modulus: 2.3e9,
    poisson_ratio: 0.35,
    density: 1040.0,
    yield_strength: None,
    across_layers: None,
};

/// Steps whose fastest counts.
const STEPS: usize = 8;

/// Runs the benchmarks of this file.
pub fn run(bench: &Bench) {
    bench.run("shell: loop step beside assembly", kept, |kept| {
        let mut kept = kept.borrow_mut();
        let fastest = |work: &mut dyn FnMut()| {
            let mut best = Duration::MAX;
            for _ in 0..STEPS {
                let begin = Instant::now();
                work();
                best = best.min(begin.elapsed());
            }
            best.as_secs_f64()
        };
        let assembly = fastest(&mut || assert!(kept.assemble() > 0));
        let step = fastest(&mut || assert!(!kept.step().is_empty()));
        format!(
            "{} unknowns, step {step:.3} s, assembly from triplets {assembly:.3} s: {:.2} times",
            kept.unknowns(),
            step / assembly
        )
    });
    for resolution in [128, 160, 192, 224, 256] {
        for (name, tiles, picture) in PICTURES {
            bench.run(
                &format!("analyse/wall with {name} at {resolution}"),
                || (),
                |()| iterations(f64::from(resolution), picture, tiles),
            );
        }
    }
}

/// A ring of waves with the model of a thousand nodes, standing on its lowest part.
fn kept() -> RefCell<Kept> {
    let levels = levels(256.0);
    let options = Options::default();
    let synthesizer = Synthesizer::new(&levels, &pixels(waves, true), &options);
    let pattern = synthesizer.expect("waves can be synthesized").synthesize();
    let graph = SurfaceGraph::new(&levels[0].surface);
    let low = torus().bounds().min.z + 5.0;
    let profile = Profile {
        material: ABS,
        metres: 1e-3,
        gravity: Point3::new(0.0, 0.0, -9.81),
        supports: vec![Box::new(move |p| p.z < low)],
        loads: Vec::new(),
        max_stress: None,
    };
    let settings = Settings {
        profile: Some(&profile),
        ..Settings::new(1.5, 2.0, graph.pitch())
    };
    let kept = Kept::new(&graph, &pattern.solid, &settings);
    RefCell::new(kept.expect("it is held"))
}

/// How many iterations the analysis of a ring's wall with a picture on it takes, in one piece or not: each piece is held.
fn iterations(resolution: f64, picture: Picture, tiles: bool) -> String {
    let levels = levels(resolution);
    let synthesizer = Synthesizer::new(&levels, &pixels(picture, tiles), &Options::default());
    let pattern = synthesizer.expect("it can be synthesized").synthesize();
    let surface = &levels[0].surface;
    let graph = SurfaceGraph::new(surface);
    let settings = Settings::new(1.5, 2.0, graph.pitch());
    let joined = fretwork::shell::reinforce::structure(
        &graph,
        (pattern.solid.clone(), &vec![false; graph.len()]),
        &settings,
        |_| {},
        |forced| {
            let solid = pattern.solid.iter().zip(forced);
            solid.map(|(solid, forced)| *solid || *forced).collect()
        },
    );
    let solid = joined.expect("nothing is asked of its strength").solid;
    let rim = vec![false; graph.len()];
    let solid = widened(&graph, (&solid, &rim), 1.5 / graph.pitch());
    let wall = Thickness {
        thickness: 2.0,
        side: Side::Center,
    };
    let made = finish(&torus(), surface, &solid, wall).expect("it is solid");
    let body = Body {
        voxels: &made.voxels,
        metres_per_unit: 1e-3,
    };
    let bounds = body.bounds();
    let foot = Zone::Lowest(5.0);
    let is_held = |p: Point3| foot.contains(p, &bounds);
    let of = (&body, &made.weights[..]);
    let model = match Model::weighted(of, &ABS, &is_held, MemoryLimit::default()) {
        Ok(model) => model,
        Err(error) => return error.to_string(),
    };
    let standing = Case {
        gravity: [0.0, 0.0, -9.81],
        loads: Vec::new(),
    };
    match model.analyse(&standing) {
        Ok(found) => format!(
            "{} voxels, {} iterations, residual {:.1e}",
            made.voxels.len(),
            found.summary.iterations,
            found.summary.residual
        ),
        Err(error) => error.to_string(),
    }
}
