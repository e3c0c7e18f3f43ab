//! Bands and panels from their text to the drawing and its measures, nothing remembered. The paper needs
//! 0.13 to 9.9 s for open curves of 56 to 130 pieces, and 143 s and 62 s for closed ones of 190 and 147, on its authors'
//! machine. The solver alone, on 24 random exemplars with results of 50, 100 and 200 pieces, runs beside a plain C++ version
//! of the paper's table: 2.1, 4.4 and 8.7 ms on average, 14, 31 and 55 ms at worst; with both counters asked for 0.49,
//! 1.8 and 7.4 s at worst.

use std::sync::Arc;
use std::time::Instant;

use fretwork::band::{Cutting, Exemplar, Parameters, Parts, Room};
use fretwork::engine::{Compiler, MemoryWorld, Progress, Request, Settings, Steps};
use fretwork::language::kinds::bands::Slicing;

use crate::Bench;

#[path = "../support/random_exemplar.rs"]
mod random_exemplar;

use random_exemplar::{Sample, contours};

/// The exemplars that the specs for users have.
const DRAWINGS: [(&str, &str); 2] = [
    ("vines", include_str!("../../specs/assets/vines.svg")),
    (
        "bobbin-lace",
        include_str!("../../specs/assets/bobbin-lace.svg"),
    ),
];

/// Nobody hears of it.
struct Silent;

impl Progress for Silent {
    fn total(&self, _: usize) {}
    fn started(&self, _: &str, _: &Arc<Steps>) {}
    fn finished(&self, _: &str) {}
}

/// Runs the benchmarks named `band/...`.
pub fn run(bench: &Bench) {
    for counters in [false, true] {
        for count in [50, 100, 200] {
            let name = if counters {
                "both_counters"
            } else {
                "one_component"
            };
            bench.run(
                &format!("band/solver/{name}_{count}"),
                || inputs(count, counters),
                |list| solve(list),
            );
        }
    }
    for (drawing, _) in DRAWINGS {
        let time = |name: &str, fields: &str, curve: &str| {
            let spec = spec(
                drawing,
                &format!("bands:\n  b: {{ exemplar: e, curve: c, height: 30, {fields} }}"),
                curve,
            );
            bench.run(
                &format!("band/{drawing}/{name}"),
                || spec.clone(),
                |spec| build(drawing, spec),
            );
        };
        let line = |length: u32| format!("polyline: {{ points: [[0, 0], [{length}, 0]] }}");
        for length in [300, 600, 1200, 2400] {
            time(&format!("open_{length}"), "components: 1", &line(length));
        }
        time(
            "open_1200_variety",
            "components: 1, variety: 0.4",
            &line(1200),
        );
        time("open_1200_holes", "components: 1, holes: 40", &line(1200));
        time(
            "closed_1200",
            "components: 1",
            "circle: { radius: 190.986 }",
        );
        time(
            "closed_1200_variety",
            "components: 1, variety: 0.4",
            "circle: { radius: 190.986 }",
        );
        time(
            "upright_1200",
            "components: 1, across: normal",
            "circle: { radius: 190.986 }",
        );
        let panel = spec(
            drawing,
            "panels:\n  b: { exemplar: e, width: 200, height: 200, variety: 0.2 }",
            &line(1),
        );
        bench.run(
            &format!("band/{drawing}/panel_200"),
            || panel.clone(),
            |spec| build(drawing, spec),
        );
    }
}

/// What the solver is asked for: pieces, and what is to be made of them.
type Input = (Parts, Parameters, Room);

/// 24 random exemplars of 10 to 20 pieces with 2 to 6 portals, for results of `count` pieces; with `counters` also
/// three holes more are asked for than the cheapest result has.
fn inputs(count: usize, counters: bool) -> Vec<Input> {
    let parameters = Parameters {
        least_repeat: 0.0,
        components: Some(1),
        holes: None,
        cutting: Cutting {
            slicing: Slicing::Topology,
            event_tolerance: 0.02,
            min_portal: 0.0,
        },
        variety: 0.0,
        tangent_weight: 0.2,
        length_tolerance: 0.05,
    };
    let input = |seed: u64| -> Option<Input> {
        let sample = Sample {
            columns: 12,
            rows: 3 + 2 * (seed as usize % 5),
            filled: 0.3,
            jitter: [0.3, 0.3],
        };
        let exemplar = Exemplar::from_contours(contours(sample, seed));
        let (parts, _) = Parts::new(&exemplar, &parameters).ok()?;
        if !(10..=20).contains(&parts.count()) {
            return None;
        }
        let length = exemplar.width / parts.count() as f64 * count as f64;
        let room = Room {
            length,
            height: 1e9,
            closed: false,
            around: false,
            slack: 0.0,
        };
        let free = parts.arrange(&parameters, room).ok()?;
        let holes = counters.then_some(free.holes + 3);
        Some((
            parts,
            Parameters {
                holes,
                ..parameters
            },
            room,
        ))
    };
    (0..).filter_map(input).take(24).collect()
}

/// Runs the solver on each; notes its mean and its longest time, and how many were solved.
fn solve(inputs: &[Input]) -> String {
    let (mut sum, mut worst, mut solved) = (0.0, 0f64, 0);
    for (parts, parameters, room) in inputs {
        let start = Instant::now();
        solved += usize::from(std::hint::black_box(parts.arrange(parameters, *room)).is_ok());
        let took = start.elapsed().as_secs_f64() * 1e3;
        sum += took;
        worst = worst.max(took);
    }
    format!(
        "{solved} solved, mean {:.2} ms, slowest {worst:.2} ms",
        sum / inputs.len() as f64
    )
}

fn spec(drawing: &str, pattern: &str, curve: &str) -> String {
    format!(
        "fretwork: 1\nexemplars:\n  e: {{ vector: {{ file: {drawing}.svg }} }}\ncurves:\n  c: {{ {curve} }}\n{pattern}\n\
         artifacts:\n  b.svg: {{ from: b }}\n  b.json: {{ from: b }}\n"
    )
}

/// Builds once; notes the sequence and the counts.
fn build(drawing: &str, spec: &str) -> String {
    let text = DRAWINGS.iter().find(|d| d.0 == drawing).map_or("", |d| d.1);
    let mut world = MemoryWorld::default();
    world.files.insert("s.yaml".into(), spec.into());
    world.files.insert(format!("{drawing}.svg"), text.into());
    let compiler = Compiler::new(Arc::new(world), None, false);
    let request = Request {
        specs: vec!["s.yaml".into()],
        settings: Settings::default(),
        only: Vec::new(),
        windows: Vec::new(),
        threads: 1,
        progress: &Silent,
    };
    let report = compiler.build(&request);
    let json = report
        .artifacts
        .iter()
        .find(|a| a.path.ends_with(".json"))
        .and_then(|a| compiler.bytes(a).ok());
    let Some(json) = json else {
        return report
            .diagnostics
            .iter()
            .map(|d| d.message.clone())
            .collect::<Vec<_>>()
            .join("; ");
    };
    let measures: serde_json::Value = serde_json::from_slice(&json).unwrap_or_default();
    let of = |name: &str| measures[name].to_string();
    format!(
        "{} of {} pieces, {} components, {} holes",
        of("pieces_out"),
        of("pieces_in"),
        of("components"),
        of("holes")
    )
}
