//! The fragments in `tests/language/` are the language's contract: all of them must be read without
//! complaint, and the schema must accept them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use fretwork::diagnostic::Diagnostic;
use fretwork::spec::{DecodeContext, Decoded, Document, Tree, decode, decode_each, parse, schema, substitute};

/// The files of a folder beside this one, in order.
pub fn files(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(folder);
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

/// Enough of an evaluator for the fragments: names and a few formulas.
fn evaluate(expression: &str, _: &[Arc<str>]) -> Result<Tree, Diagnostic> {
    match expression {
        "size" => Ok(Tree::Int(2000)),
        "wrist" => Ok(Tree::Int(165)),
        "wrist / (2 * pi)" => Ok(Tree::from(165.0 / std::f64::consts::TAU)),
        other => Err(Diagnostic::error(format!("the tests do not know `{other}`"))),
    }
}

/// All entries of a document, decoded.
pub fn decode_all(file: &Arc<str>, document: &Document) -> Vec<Decoded> {
    let decode_entry = |entry: &fretwork::spec::Entry| {
        let context = DecodeContext {
            file: file.clone(),
            path: entry.path(),
            file_units: document.units,
            spec_units: document.units,
        };
        let body = substitute(&entry.body, file, &mut entry.path(), &mut evaluate).unwrap();
        if let Some(each) = body.get("each") {
            decode_each(each, &context).unwrap();
        }
        decode(entry.section, &body, &context)
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
        let errors: Vec<String> =
            validator.iter_errors(&value).map(|e| format!("{}: {e}", e.instance_path())).collect();
        assert_eq!(errors, Vec::<String>::new(), "{}", path.display());
    }
}
