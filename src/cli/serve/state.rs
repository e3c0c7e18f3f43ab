//! `state.json`: all that the page shows, for programs.

use serde_json::{Value, json};

use super::super::exhibit::{Card, Exhibit, File, Finding, Spec};
use fretwork_language::kinds::artifacts::Format;

/// The state of a build of some number that took so many seconds.
pub fn state(exhibit: &Exhibit, build: u64, seconds: f64) -> Value {
    let artifacts = exhibit.files().map(|(card, file)| artifact(card, file));
    json!({
        "build": build,
        "ok": exhibit.is_ok(),
        "seconds": seconds,
        "specs": exhibit.specs.iter().map(spec).collect::<Vec<_>>(),
        "artifacts": artifacts.collect::<Vec<_>>(),
        "diagnostics": findings(&exhibit.findings),
        "nodes": exhibit.nodes,
        "edges": exhibit.edges,
    })
}

/// Diagnostics with their places and their source lines.
pub fn findings(findings: &[Finding]) -> Vec<Value> {
    let one = |finding: &Finding| {
        let mut value = json!(finding.place);
        value["excerpt"] = finding.text.as_str().into();
        value
    };
    findings.iter().map(one).collect()
}

fn spec(spec: &Spec) -> Value {
    json!({ "path": spec.path, "params": spec.params })
}

fn artifact(card: &Card, file: &File) -> Value {
    json!({
        "path": file.path,
        "format": Format::EXTENSIONS[file.format as usize],
        "bytes": file.bytes.len(),
        "blake3": file.blake3,
        "measures": card.measures,
        "checks": [],
        "stale": card.is_stale,
    })
}
