//! Whole jobs that once took long, from their text to their files, nothing remembered, on one thread: a shade with three
//! carved rings is to take 5 s, a region of 40,000 shapes 5 s, 58,000 cells whose density follows a field 4 s, the
//! shipped chair 3 s.

use std::sync::Arc;

use fretwork::engine::{Compiler, MemoryWorld, Progress, Request, Settings, Steps};
use fretwork::geometry::Seed;

use crate::Bench;

/// Nobody hears of it.
struct Silent;

impl Progress for Silent {
    fn total(&self, _: usize) {}
    fn started(&self, _: &str, _: &Arc<Steps>) {}
    fn finished(&self, _: &str) {}
}

const SHADE: &str = r#"fretwork: 1
exemplars:
  vines: { vector: { file: vines.svg, tolerance: 0.05 } }
curves:
  outline: { spline: { points: [[45, 0], [62, 48], [58, 96], [34, 160]] } }
  low: { on_surface: { surface: shade, closed: true, points: [[62, 0, 40], [0, 62, 40], [-62, 0, 40], [0, -62, 40]] } }
  mid: { on_surface: { surface: shade, closed: true, points: [[62, 0, 80], [0, 62, 80], [-62, 0, 80], [0, -62, 80]] } }
  top: { on_surface: { surface: shade, closed: true, points: [[50, 0, 118], [0, 50, 118], [-50, 0, 118], [0, -50, 118]] } }
surfaces:
  shade: { revolve: { profile: outline, segments: 144 } }
bands:
  b1: { exemplar: vines, curve: low, height: 24, components: any, variety: 0.4 }
  b2: { exemplar: vines, curve: mid, height: 24, components: any, variety: 0.4 }
  b3: { exemplar: vines, curve: top, height: 20, components: any, variety: 0.4 }
solids:
  s1: { carve: { surface: shade, cutout: b1, thickness: 2 } }
  s2: { carve: { surface: shade, cutout: b2, thickness: 2 } }
  s3: { carve: { surface: shade, cutout: b3, thickness: 2 } }
  lampshade: { intersection: [s1, s2, s3] }
artifacts:
  shade.stl: { from: lampshade }
  shade.png: { from: lampshade, width: 900, view: [1, -1.5, 0.6] }
"#;

const HEAP: &str = "fretwork: 1
regions:
  heap: { svg: { file: heap.svg } }
artifacts:
  heap.json: { from: heap }
";

const CELLS: &str = r#"fretwork: 1
regions:
  sheet: { rectangle: { width: 420, height: 297 } }
fields:
  tone: { expression: { value: "0.1 + 0.8 * (0.5 + 0.5 * sin(x / 20) * cos(y / 20))" } }
partitions:
  cells: { uniform: { density: tone } }
artifacts:
  cells.json: { from: cells, region: sheet }
"#;

/// Runs the benchmarks of this file.
pub fn run(bench: &Bench) {
    let vines = include_str!("../../specs/assets/vines.svg");
    let bobbin = include_str!("../../specs/assets/bobbin-lace.svg");
    let chair = include_str!("../../specs/bands/chair.yaml");
    let jobs = [
        ("job/shade with three carved rings", "s.yaml", SHADE),
        ("job/region of 40,000 shapes", "s.yaml", HEAP),
        ("job/58,000 cells by a density", "s.yaml", CELLS),
        ("job/chair", "bands/s.yaml", chair),
    ];
    for (name, path, text) in jobs {
        let world = || {
            let mut world = MemoryWorld::default();
            for (file, text) in [
                (path, text),
                ("vines.svg", vines),
                ("heap.svg", &heap(40_000)),
                ("assets/vines.svg", vines),
                ("assets/bobbin-lace.svg", bobbin),
            ] {
                world.files.insert(file.into(), text.into());
            }
            Arc::new(world)
        };
        bench.run(name, world, |world| build(world, path, 1));
    }
}

/// A drawing of small shapes at random places, about half of which touch others.
fn heap(count: u64) -> String {
    let seed = Seed::root(1);
    let shape = |i: u64| {
        let number = |k: u64, high: f64| seed.range(3 * i + k, 0.0, high);
        let (x, y, r) = (number(0, 1000.0), number(1, 1000.0), number(2, 4.0));
        format!("<path d=\"M{x:.2} {y:.2}l{r:.2} {r:.2}q3 4 -{r:.2} {r:.2}z\"/>")
    };
    let shapes: String = (0..count).map(shape).collect();
    format!("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 1000 1000\">{shapes}</svg>")
}

/// Builds all artifacts of the spec; says how many bytes they have, or what went wrong.
pub fn build(world: &Arc<MemoryWorld>, spec: &str, threads: usize) -> String {
    match built(world, spec, threads) {
        Ok(files) => {
            let count: usize = files.iter().map(|(_, bytes)| bytes.len()).sum();
            format!("{count} bytes")
        }
        Err(said) => said,
    }
}

/// The artifacts of the spec by their paths, or what went wrong.
pub fn built(
    world: &Arc<MemoryWorld>,
    spec: &str,
    threads: usize,
) -> Result<Vec<(String, Vec<u8>)>, String> {
    let compiler = Compiler::new(world.clone(), None, false);
    let report = compiler.build(&Request {
        specs: vec![spec.into()],
        settings: Settings::default(),
        only: Vec::new(),
        windows: Vec::new(),
        threads,
        progress: &Silent,
    });
    let errors = report.diagnostics.iter().filter(|d| d.is_error());
    let errors: Vec<&str> = errors.map(|d| &*d.message).collect();
    if !errors.is_empty() {
        return Err(errors.join("; "));
    }
    let bytes = |artifact| compiler.bytes(artifact).map(|bytes| bytes.to_vec());
    let files = report.artifacts.iter();
    Ok(files
        .map(|artifact| (artifact.path.clone(), bytes(artifact).unwrap_or_default()))
        .collect())
}
