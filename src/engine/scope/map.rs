//! The plane of a spec's map, and the length of a millimetre on its paper.

use super::expression::evaluate_tree;
use super::params::of_params;
use super::values::Scope;
use crate::database::{Db, SourceFile};
use crate::program::program;
use crate::settings::Settings;
use fretwork_diagnostic::Diagnostic;
use fretwork_language::{DecodeContext, Map, Tree, decode_map};
use fretwork_script::Value;

/// The plane of the spec's map, if it is a map, and what is wrong with it. Its expressions see parameters, but
/// no derived values, which may be derived from the map's scale.
pub fn map(db: &dyn Db, root: SourceFile, settings: &Settings) -> (Option<Map>, Vec<Diagnostic>) {
    let program = program(db, root);
    let Some(tree) = &program.map else {
        return (None, Vec::new());
    };
    let context = DecodeContext {
        file: program.root.clone(),
        path: Vec::new(),
        file_units: program.units,
        spec_units: program.measure(),
        is_scaled: false,
        modules: Default::default(),
    };
    let scope = of_params(&program, settings);
    let read = evaluate_tree(db, tree, (&program.root, &["map".into()]), &scope)
        .and_then(|tree| decode_map(&tree, &context));
    let empty = || decode_map(&Tree::Null, &context).ok();
    read.map_or_else(
        |diagnostics| (empty(), diagnostics),
        |map| (Some(map), Vec::new()),
    )
}

/// Adds `paper_mm` where the map has a scale.
pub fn add_paper(db: &dyn Db, root: SourceFile, settings: &Settings, scope: &mut Scope) {
    let (map, diagnostics) = map(db, root, settings);
    let program = program(db, root);
    let mut own = program.lets.iter().filter(|l| l.module.is_empty());
    let has_own = own.any(|l| *l.item.0 == *PAPER);
    if has_own || scope.values.contains_key(PAPER) {
        return;
    }
    if let Some(metres) = map.and_then(|map| map.paper_mm()) {
        scope.values.insert(PAPER.into(), Value::Float(metres));
    } else if !diagnostics.is_empty() {
        scope.failed.insert(PAPER.into());
    }
}

/// The metres of one millimetre on paper, in maps with a scale. A parameter or derived value of that name takes its place.
const PAPER: &str = "paper_mm";
