//! Any bytes as the text of a force profile, with the analysis of a small bar under it: reading, units, checks and the analysis must
//! end without a panic, every diagnostic must have a place in the text, and no figure may be other than finite. Bytes choose
//! among fields and values that have a meaning, or stand for themselves.
//!
//! `RUSTC_BOOTSTRAP=1 cargo fuzz run -s none --fuzz-dir tests/fuzz force_profile_text`
#![no_main]

use std::sync::Arc;

use fretwork::diagnostic::render::{position, render};
use fretwork::engine::{Compiler, MemoryWorld, Progress, Request, Settings, Steps};
use libfuzzer_sys::fuzz_target;

const PATH: &str = "specs/spec.yaml";

/// The fields of a profile, and what may be meant by each, and some by none.
const FIELDS: [&str; 9] = [
    "material", "gravity", "supports", "loads", "max_stress", "limits", "sweep", "require", "unknown",
];
const VALUES: [&str; 32] = [
    "pla", "{ of: petg, across_layers: 0.6 }", "{ of: abs, across_layers: 0 }", "{ of: pa12, build_direction: [0, 0, 0] }",
    "{ youngs_modulus: 2GPa, poisson_ratio: 0.35, density: 1040, yield_strength: 40MPa }",
    "{ youngs_modulus: 1e300GPa, poisson_ratio: -0.999999, density: 1e-300, yield_strength: 1Pa }",
    "{ youngs_modulus: 1e-300Pa, poisson_ratio: 0.4999999, density: 1e300, yield_strength: 1e300Pa }",
    "{ youngs_modulus: -2GPa, poisson_ratio: 0.5, density: 0, yield_strength: nan }",
    "[0, 0, -1]", "[0, 0, 0]", "[1e300, 0, 0]", "[0m/s2, 0m/s2, 3m/s2]", "[.nan, 0, .inf]",
    "[ { lowest: 10% } ]", "[ { lowest: 100% } ]", "[ { highest: 1mm }, { lowest: 0mm } ]", "[ { box: [[0, 0, 0], [1, 9, 9]] } ]",
    "[ { box: [[9, 9, 9], [-1, -9, -9]] } ]", "[ { sphere: { center: [0, 0, 0], radius: 2 } } ]", "[]",
    "[ { highest: 10%, force: [1, 2, 3] } ]", "[ { highest: 10%, force: [1kN, 0N, 1e9N] } ]",
    "[ { sphere: { center: [99, 0, 0], radius: 1e-9 }, force: [1, 0, 0] } ]",
    "5MPa", "0MPa", "1e-300Pa", "{ safety_factor: 2, max_displacement: 1mm }", "{ safety_factor: 1e300 }", "gravity", "true", "no",
    "${1 / 0}",
];

/// Nobody hears of the build.
struct Silent;

impl Progress for Silent {
    fn total(&self, _: usize) {}
    fn started(&self, _: &str, _: &Arc<Steps>) {}
    fn finished(&self, _: &str) {}
}

/// The fields that the bytes choose, each on a line of its own.
fn fields(bytes: &[u8]) -> String {
    let mut text = String::new();
    let mut rest = bytes;
    while let [field, value, more @ ..] = rest {
        text += &format!("    {}: ", FIELDS[usize::from(*field) % FIELDS.len()]);
        rest = more;
        if usize::from(*value) < 6 * VALUES.len() {
            text += VALUES[usize::from(*value) % VALUES.len()];
        } else {
            let length = usize::from(*value % 24).min(more.len());
            text += &String::from_utf8_lossy(&more[..length]);
            rest = &more[length..];
        }
        text.push('\n');
    }
    text
}

fuzz_target!(|bytes: &[u8]| {
    let spec = format!(
        "fretwork: 1\nsolids: {{ bar: {{ box: {{ size: [2, 2, 8] }} }} }}\nforce_profiles:\n  held:\n{}\nanalyses:\n  bar: {{ of: bar, \
         force_profile: held, voxel: 1 }}\nartifacts:\n  bar.json: {{ from: analyses.bar }}\n",
        fields(bytes)
    );
    let mut world = MemoryWorld::default();
    world.files.insert(PATH.into(), spec.into_bytes());
    let compiler = Compiler::new(Arc::new(world), None, true);
    let request = Request {
        specs: vec![PATH.into()],
        settings: Settings::default(),
        only: Vec::new(),
        windows: Vec::new(),
        threads: 1,
        progress: &Silent,
    };
    let report = compiler.build(&request);
    for label in report.diagnostics.iter().flat_map(|d| &d.labels) {
        assert!(position(&label.span, &compiler.sources()).is_some(), "{label:?} is nowhere");
    }
    render(&report.diagnostics, &compiler.sources(), false);
    for artifact in &report.artifacts {
        let bytes = compiler.bytes(artifact).expect("it was built");
        let text = String::from_utf8_lossy(&bytes);
        assert!(!text.contains("e308") && !text.contains("NaN"), "{text}");
        // Of figures that are not finite the format makes nulls; only where nothing strains the body there are such.
        let strained = !text.contains("\"max\": 0.0");
        assert!(!strained || !text.contains("null"), "{text}");
    }
    let checked = compiler.check(PATH, &Settings::default());
    assert_eq!(checked, compiler.check(PATH, &Settings::default()));
});
