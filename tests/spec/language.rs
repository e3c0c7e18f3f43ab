//! The fragments in `tests/language/` are the language's contract: all of them must be read without
//! complaint, and the schema must accept them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use fretwork::diagnostic::{Diagnostic, Span};
use fretwork::language::{
    DecodeContext, Decoded, Document, Section, Tree, decode, decode_each, parse, reference, schema,
    substitute,
};

/// The files of a folder beside this one, in order.
pub fn files(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests")
        .join(folder);
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|p| p.is_file())
        .collect();
    files.sort();
    files
}

/// Enough of an evaluator for the fragments: names and a few formulas.
fn evaluate(expression: &str, path: &[Arc<str>]) -> Result<Tree, Diagnostic> {
    match expression {
        "size" => Ok(Tree::Int(2000)),
        "wrist" => Ok(Tree::Int(165)),
        "half" | "size / 2" => Ok(Tree::from(100.0)),
        "wrist / (2 * pi)" => Ok(Tree::from(165.0 / std::f64::consts::TAU)),
        other => Err(
            Diagnostic::error(format!("the tests do not know `{other}`"))
                .at(Span::value(&"".into(), path), ""),
        ),
    }
}

/// All entries of a document, decoded.
pub fn decode_all(file: &Arc<str>, document: &Document) -> Vec<Decoded> {
    let decode_entry = |entry: &fretwork::language::Entry| {
        let context = DecodeContext {
            file: file.clone(),
            path: entry.path(),
            file_units: document.units,
            spec_units: document.units,
            is_scaled: false,
            modules: Default::default(),
        };
        let body = match substitute(&entry.body, file, &mut entry.path(), &mut evaluate) {
            Ok(body) => body,
            Err(diagnostics) => {
                return Decoded {
                    node: None,
                    references: Vec::new(),
                    files: Vec::new(),
                    diagnostics,
                };
            }
        };
        let each = body
            .get("each")
            .map_or(Ok(Vec::new()), |each| decode_each(each, &context));
        let mut decoded = decode(entry.section, &body, &context);
        decoded.diagnostics.extend(each.err().into_iter().flatten());
        decoded
    };
    document.entries.iter().map(decode_entry).collect()
}

#[test]
fn every_fragment_is_read_without_complaint() {
    for path in files("language") {
        let file: Arc<str> = path.file_name().unwrap().to_string_lossy().into();
        let text = std::fs::read_to_string(&path).unwrap();
        let parsed = parse(&file, &text);
        assert_eq!(parsed.diagnostics, [], "{file}");
        for decoded in decode_all(&file, &parsed.document) {
            assert_eq!(decoded.diagnostics, [], "{file}");
            assert!(decoded.node.is_some());
        }
    }
}

#[test]
fn the_schema_accepts_every_fragment() {
    let validator = jsonschema::draft7::new(&schema()).unwrap();
    for path in files("language") {
        let text = std::fs::read_to_string(&path).unwrap();
        let value: serde_json::Value = serde_yaml::from_str(&text).unwrap();
        let errors: Vec<String> = validator
            .iter_errors(&value)
            .map(|e| format!("{}: {e}", e.instance_path()))
            .collect();
        assert_eq!(errors, Vec::<String>::new(), "{}", path.display());
    }
}

/// A file of `schemas/` says what the types say.
#[track_caller]
fn check_generated(name: &str, command: &str, expected: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("schemas")
        .join(name);
    if std::env::var_os("UPDATE_SCHEMAS").is_some() {
        std::fs::write(&path, expected).unwrap();
    }
    let found = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        found == expected,
        "schemas/{name} is stale: run `fretwork {command} > schemas/{name}`, or the tests with UPDATE_SCHEMAS=1"
    );
}

#[test]
fn the_schema_in_the_repository_is_current() {
    let schema = serde_json::to_string_pretty(&schema()).unwrap() + "\n";
    check_generated("fretwork.schema.json", "schema", &schema);
}

#[test]
fn the_reference_in_the_repository_is_current() {
    check_generated("reference.md", "schema --reference", &reference());
}

#[test]
fn the_reference_of_functions_in_the_repository_is_current() {
    let page = fretwork::arrangement::functions_reference();
    check_generated("functions.md", "schema --functions", &page);
}

#[test]
fn the_examples_of_the_reference_have_every_kind() {
    let file: Arc<str> = "examples.yaml".into();
    let text = include_str!("../../src/language/examples.yaml");
    let parsed = parse(&file, text);
    assert_eq!(parsed.diagnostics, []);
    let mut found: Vec<(Section, &str)> = Vec::new();
    for decoded in decode_all(&file, &parsed.document) {
        assert_eq!(decoded.diagnostics, []);
        let node = decoded.node.unwrap();
        found.push((node.section(), node.kind_name()));
    }
    for section in Section::ALL {
        assert!(
            found.iter().any(|(of, _)| of == section),
            "no example of {}",
            section.name()
        );
        for kind in section.kinds() {
            assert!(
                found.contains(&(*section, *kind)),
                "no example of {}: {kind}",
                section.name()
            );
        }
    }
    let value: serde_json::Value = serde_yaml::from_str(text).unwrap();
    assert!(jsonschema::draft7::new(&schema()).unwrap().is_valid(&value));
}

#[test]
fn what_the_schema_can_see_it_refuses() {
    // These are wrong in ways that a schema does not see: YAML's own rules, names, expressions.
    let unseen = [
        "bad_reference",
        "bad_repeat",
        "duplicate_key",
        "unclosed_expression",
        "unquoted_expression",
        "control_characters",
        "param_expression",
    ];
    let validator = jsonschema::draft7::new(&schema()).unwrap();
    let mut seen = 0;
    for path in files("bad") {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let value = std::fs::read(&path)
            .ok()
            .and_then(|bytes| serde_yaml::from_slice::<serde_json::Value>(&bytes).ok());
        let Some(value) = value.filter(|_| !unseen.contains(&&*name)) else {
            continue;
        };
        seen += 1;
        assert!(!validator.is_valid(&value), "{name}");
    }
    assert!(seen > 12, "{seen}");
}
