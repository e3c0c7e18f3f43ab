//! The names that expressions read.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::program::{Located, Program};
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_language::{Param, Piece, Tree};
use fretwork_script::free_names;

/// The names that the expressions of `tree` read. An expression that cannot be parsed has none; it
/// is reported when it is evaluated.
pub fn collect_names(tree: &Tree, names: &mut BTreeSet<Arc<str>>) {
    match tree {
        Tree::Text(text) => {
            for piece in fretwork_language::split(text).unwrap_or_default() {
                if let Piece::Expression(expression) = piece {
                    names.extend(
                        free_names(&expression)
                            .unwrap_or_default()
                            .into_iter()
                            .map(Arc::from),
                    );
                }
            }
        }
        Tree::List(items) => items.iter().for_each(|item| collect_names(item, names)),
        Tree::Map(entries) => entries
            .iter()
            .for_each(|(_, value)| collect_names(value, names)),
        Tree::Null | Tree::Bool(_) | Tree::Int(_) | Tree::Float(_) | Tree::Written(_) => {}
    }
}

/// Warnings for the params of the root file that no expression of the spec names. Those of included files
/// may serve other specs.
pub fn unused_params(program: &Program) -> Vec<Diagnostic> {
    let mut used = BTreeSet::new();
    program
        .seed
        .iter()
        .for_each(|seed| collect_names(seed, &mut used));
    let of_root = program.seeds.iter().filter(|own| own.module.is_empty());
    of_root.for_each(|own| collect_names(&own.seed, &mut used));
    program
        .map
        .iter()
        .for_each(|map| collect_names(map, &mut used));
    for located in &program.lets {
        collect_names(&located.item.1, &mut used);
    }
    for (id, located) in &program.entries {
        collect_names(&Tree::Text(id.name.clone()), &mut used);
        collect_names(&located.item.body, &mut used);
        located
            .item
            .seed
            .iter()
            .for_each(|seed| collect_names(seed, &mut used));
    }
    for module in program.modules.values().filter(|m| m.parent.is_empty()) {
        let with = module.uses.with.iter();
        with.for_each(|(_, tree)| collect_names(tree, &mut used));
    }
    let own = program.own_params().filter(|p| p.file == program.root);
    let unused = own.filter(|param| !used.contains(&param.item.name));
    let warning = |param: &Located<Param>| {
        let name = &param.item.name;
        let span = Span::key(&param.file, &["params".into(), name.clone()]);
        Diagnostic::warning(format!("no expression uses the parameter `{name}`"))
            .at(span, "")
            .help(format!(
                "write `\"${{{name}}}\"` where its value belongs, or take it out"
            ))
    };
    unused.map(warning).collect()
}
