//! `state.json`: all that the page shows, for programs.

use serde_json::{Value, json};

use super::super::exhibit::{Card, File, Finding, Spec};
use super::shown::Shown;
use fretwork_language::kinds::artifacts::Format;

/// The state of a build.
pub fn state(shown: &Shown) -> Value {
    let exhibit = &shown.exhibit;
    let artifacts = exhibit.files().map(|(card, file)| artifact(card, file));
    json!({
        "build": shown.build,
        "ok": shown.is_ok,
        "seconds": shown.seconds,
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
