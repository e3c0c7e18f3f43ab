//! Shells: synthesis, the structural loop, the finished wall.
//!
//! The source gives 1.1 s for a first synthesis at 256 (55 to 107 thousand voxels), and 14.6, 40 and 52 s for whole
//! jobs with the exemplars keyboard, hooks and waves, on its authors' machine. A synthesizer by example in the plane
//! takes 3 to 5.5 s for 256 × 256 pixels from 64 × 64.

use fretwork::geometry::mesh::revolve;
use fretwork::geometry::shell::Pattern;
use fretwork::geometry::{Mesh, Point, Side};
use fretwork::shell::connect::SurfaceGraph;
use fretwork::shell::finish::{Thickness, finish, least_width, widened};
use fretwork::shell::reinforce::{Settings, structure};
use fretwork::shell::synthesize::{Options, Synthesizer};
use fretwork::shell::voxelize::{Level, pyramid, voxelize};

use super::analyse::processor_seconds;
use super::shell_pictures::{pixels, waves};
use crate::Bench;

/// A ring of which a picture of waves shows every direction.
pub fn torus() -> Mesh {
    let point = |n: usize| {
        let angle = std::f64::consts::TAU * n as f64 / 48.0;
        Point::new(35.0 + 15.0 * angle.cos(), 15.0 * angle.sin())
    };
    let section: Vec<Point> = (0..48).map(point).collect();
    revolve(&section, true, 120)
        .expect("a ring can be turned")
        .welded()
}

/// The voxels of the ring, and its coarser levels.
pub fn levels(resolution: f64) -> Vec<Level> {
    let mesh = torus();
    let pitch = mesh.bounds().longest_side() / resolution;
    pyramid(voxelize(&mesh, pitch).expect("a ring has voxels"))
}

fn first(levels: &[Level]) -> Pattern {
    let synthesizer = Synthesizer::new(levels, &pixels(waves, true), &Options::default());
    synthesizer.expect("waves can be synthesized").synthesize()
}

pub fn run(bench: &Bench) {
    for resolution in [128, 256, 512] {
        let levels = || levels(f64::from(resolution));
        bench.run(
            &format!("shell: synthesis at {resolution}"),
            levels,
            |levels| {
                let begin = processor_seconds();
                let made = first(levels);
                format!(
                    "{} voxels, {:.3} solid, {:.2} µs of processor a voxel",
                    made.solid.len(),
                    made.solid_fraction(),
                    1e6 * (processor_seconds() - begin) / made.solid.len() as f64
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
        let synthesizer = Synthesizer::new(levels, &pixels(waves, true), &Options::default());
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
    for resolution in [128, 256, 512] {
        let wide = || wide(f64::from(resolution));
        let name = format!("shell: wall of 2 mm at {resolution}");
        bench.run(&name, wide, |(mesh, levels, solid)| {
            let thickness = Thickness {
                thickness: 2.0,
                side: Side::Center,
            };
            let begin = processor_seconds();
            let made = finish(mesh, &levels[0].surface, solid, thickness).expect("it is solid");
            format!(
                "{} triangles, {} samples, {:.2} s of processor",
                made.mesh.triangles.len(),
                made.voxels.len(),
                processor_seconds() - begin
            )
        });
    }
    let pattern = || wide(256.0);
    bench.run(
        "shell: least width at 256",
        pattern,
        |(mesh, levels, solid)| {
            let graph = SurfaceGraph::new(&levels[0].surface);
            let rim = vec![false; graph.len()];
            let (width, _) = least_width((mesh, &graph), (solid, &rim), (1.5, 6.0));
            format!("{width:.3} mm")
        },
    );
}

/// The ring with its voxels and those that are solid of waves whose features are wide enough.
fn wide(resolution: f64) -> (Mesh, Vec<Level>, Vec<bool>) {
    let levels = levels(resolution);
    let pattern = first(&levels);
    let graph = SurfaceGraph::new(&levels[0].surface);
    let rim = vec![false; graph.len()];
    let solid = widened(&graph, (&pattern.solid, &rim), 1.5 / graph.pitch());
    drop(graph);
    (torus(), levels, solid)
}
