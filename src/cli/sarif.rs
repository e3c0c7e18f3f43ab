//! Diagnostics as a SARIF 2.1.0 log (OASIS, Static Analysis Results Interchange Format), which code hosts and
//! editors take.

use serde_json::{Value, json};

use super::placed::Placed;
use fretwork_diagnostic::{Code, Severity};
use fretwork_store::Digest;

/// The most results of a log; errors stay rather than warnings.
const MOST: usize = 5000;

/// The log.
pub fn log(diagnostics: &[Placed]) -> Value {
    let mut worst: Vec<&Placed> = diagnostics.iter().collect();
    worst.sort_by_key(|d| d.severity);
    worst.truncate(MOST);
    let rule =
        |code: &Code| json!({ "id": code.name(), "shortDescription": { "text": code.about() } });
    let rules: Vec<Value> = Code::ALL.iter().map(rule).collect();
    let results: Vec<Value> = worst.into_iter().map(result).collect();
    json!({
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": { "name": "fretwork", "version": env!("CARGO_PKG_VERSION"), "rules": rules } },
            "columnKind": "unicodeCodePoints",
            "originalUriBaseIds": { "%SRCROOT%": { "description": { "text": "The root of the project." } } },
            "results": results,
        }],
    })
}

fn result(diagnostic: &Placed) -> Value {
    let level = match diagnostic.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    };
    let help = diagnostic.help.iter().map(|help| format!("\nhelp: {help}"));
    let text = format!("{}{}", diagnostic.message, help.collect::<String>());
    let rule = Code::ALL
        .iter()
        .position(|code| code.name() == diagnostic.code);
    let mut result = json!({
        "ruleId": diagnostic.code,
        "ruleIndex": rule,
        "level": level,
        "message": { "text": text },
        "partialFingerprints": { "fretwork/v1": fingerprint(diagnostic) },
    });
    if let Some(file) = &diagnostic.file {
        let mut place =
            json!({ "artifactLocation": { "uri": uri(file), "uriBaseId": "%SRCROOT%" } });
        if let (Some(line), Some(column)) = (diagnostic.line, diagnostic.column) {
            place["region"] = json!({
                "startLine": line,
                "startColumn": column,
                "endLine": diagnostic.end_line.unwrap_or(line),
                "endColumn": diagnostic.end_column.unwrap_or(column),
            });
        }
        result["locations"] = json!([{ "physicalLocation": place }]);
    }
    result
}

/// What makes two results the same finding: its code and the names that lead to it, and where there are none its
/// message. Lines that move do not change it.
fn fingerprint(diagnostic: &Placed) -> String {
    let file = diagnostic.file.as_deref().unwrap_or_default();
    let mut parts = vec![diagnostic.code, file];
    if diagnostic.path.is_empty() {
        parts.push(&diagnostic.message);
    }
    parts.extend(diagnostic.path.iter().map(|step| &**step));
    Digest::of(parts.join("\0").as_bytes()).to_string()
}

/// A path as a relative reference: all but unreserved characters and `/` are escaped (RFC 3986).
fn uri(path: &str) -> String {
    let escaped = |byte: u8| match byte {
        b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' => {
            char::from(byte).to_string()
        }
        _ => format!("%{byte:02X}"),
    };
    path.bytes().map(escaped).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn placed(line: usize) -> Placed {
        Placed {
            code: "field",
            severity: Severity::Warning,
            message: "m".into(),
            file: Some("specs/ä b.yaml".into()),
            line: Some(line),
            column: Some(2),
            end_line: Some(line),
            end_column: Some(4),
            help: None,
            path: vec!["regions".into(), "page".into()],
        }
    }

    #[test]
    fn moved_lines_stay_the_same_result() {
        let of = |line| log(&[placed(line)])["runs"][0]["results"][0].clone();
        let (one, other) = (of(3), of(80));
        assert_eq!(one["partialFingerprints"], other["partialFingerprints"]);
        let place = &one["locations"][0]["physicalLocation"];
        assert_eq!(place["artifactLocation"]["uri"], "specs/%C3%A4%20b.yaml");
        assert_eq!(place["region"]["startLine"], 3);
        assert_eq!(one["ruleIndex"], 1);
    }

    #[test]
    fn of_too_many_results_the_worst_stay() {
        let mut all = vec![placed(1); MOST];
        all.push(Placed {
            severity: Severity::Error,
            ..placed(2)
        });
        let log = log(&all);
        let results = log["runs"][0]["results"].as_array().expect("results");
        assert_eq!(results.len(), MOST);
        assert_eq!(results[0]["level"], "error");
    }
}
