//! Shells: synthesis, the structural loop, the finished wall.
//!
//! The source gives 1.1 s for a first synthesis at 256 (55 to 107 thousand voxels), and 14.6, 40 and 52 s for whole
//! jobs with the exemplars keyboard, hooks and waves, on its authors' machine. A synthesizer by example in the plane
//! takes 3 to 5.5 s for 256 × 256 pixels from 64 × 64.

use fretwork::geometry::mesh::revolve;
use fretwork::geometry::shell::Pattern;
use fretwork::geometry::{Mesh, Pixels, Point, Side};
use fretwork::shell::connect::SurfaceGraph;
use fretwork::shell::finish::{Thickness, finish, widened};
use fretwork::shell::reinforce::{Settings, structure};
use fretwork::shell::synthesize::{Options, Synthesizer};
use fretwork::shell::voxelize::{Level, pyramid, voxelize};

use super::super::Bench;

/// A ring of which a picture of waves shows every direction.
fn torus() -> Mesh {
    let point = |n: usize| {
        let angle = std::f64::consts::TAU * n as f64 / 48.0;
        Point::new(35.0 + 15.0 * angle.cos(), 15.0 * angle.sin())
    };
    let section: Vec<Point> = (0..48).map(point).collect();
    revolve(&section, true, 120)
        .expect("a ring can be turned")
        .welded()
}

/// Waving bands that nothing joins: 96 × 96 pixels that tile.
fn waves() -> Pixels {
    let solid: Vec<bool> = (0..96 * 96)
        .map(|n| {
            let (x, y) = ((n % 96) as f64, (n / 96) as f64);
            let bend = 0.15 * (std::f64::consts::TAU * x / 48.0).sin();
            (std::f64::consts::TAU * (y / 16.0 + bend)).sin() > 0.1
        })
        .collect();
    let ink = |solid: &bool| if *solid { [30; 3] } else { [230; 3] };
    Pixels {
        width: 96,
        rgb: solid.iter().map(ink).collect(),
        solid,
        pixel_size: 0.5,
        feature_radius: Some(1.5),
        tileable: true,
    }
}

fn levels(resolution: f64) -> Vec<Level> {
    let mesh = torus();
    let pitch = mesh.bounds().longest_side() / resolution;
    pyramid(voxelize(&mesh, pitch).expect("a ring has voxels"))
}

fn first(levels: &[Level]) -> Pattern {
    let synthesizer = Synthesizer::new(levels, &waves(), &Options::default());
    synthesizer.expect("waves can be synthesized").synthesize()
}

pub fn run(bench: &Bench) {
    for resolution in [128, 256, 512] {
        let levels = || levels(f64::from(resolution));
        bench.run(
            &format!("shell: synthesis at {resolution}"),
            levels,
            |levels| {
                let made = first(levels);
                format!(
                    "{} voxels, {:.3} solid",
                    made.solid.len(),
                    made.solid_fraction()
                )
            },
        );
    }
    bench.run("shell: voxels at 256", torus, |mesh| {
        let pitch = mesh.bounds().longest_side() / 256.0;
        let made = voxelize(mesh, pitch).expect("a ring has voxels");
        format!("{} voxels", made.voxels.len())
    });
    let patterned = || {
        let levels = levels(256.0);
        let pattern = first(&levels);
        (levels, pattern)
    };
    bench.run("shell: one piece at 256", patterned, |(levels, pattern)| {
        let graph = SurfaceGraph::new(&levels[0].surface);
        let settings = Settings {
            geodesic_limit: Some(1.5),
            ..Settings::new(1.5, 2.0, graph.pitch())
        };
        let synthesizer = Synthesizer::new(levels, &waves(), &Options::default());
        let synthesizer = synthesizer.expect("waves can be synthesized");
        let mut current = pattern.clone();
        let kept = vec![false; graph.len()];
        let start = (pattern.solid.clone(), &kept[..]);
        let made = structure(
            &graph,
            start,
            &settings,
            |_| {},
            |forced| {
                current = synthesizer
                    .resynthesize(&current, forced)
                    .expect("it is of this surface");
                current.solid.clone()
            },
        );
        let made = made.expect("nothing is asked of its strength");
        format!("{} rounds, {:?}", made.iterations, made.bridges)
    });
    bench.run(
        "shell: wall of 2 mm at 256",
        patterned,
        |(levels, pattern)| {
            let surface = &levels[0].surface;
            let graph = SurfaceGraph::new(surface);
            let solid = {
                let rim = vec![false; graph.len()];
                widened(&graph, (&pattern.solid, &rim), 1.5 / graph.pitch())
            };
            let thickness = Thickness {
                thickness: 2.0,
                side: Side::Center,
            };
            let made = finish(&torus(), surface, &solid, thickness).expect("waves are solid");
            format!(
                "{} triangles, {} samples",
                made.mesh.triangles.len(),
                made.voxels.len()
            )
        },
    );
}
