//! The scopes of a spec and of the modules that it uses.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::expression::{evaluate_tree, to_value};
use super::lets::add_lets;
use super::map::add_paper;
use super::params::{add_param, of_params, report_unknown};
use super::values::Scope;
use crate::database::{Db, SourceFile};
use crate::modules::Module;
use crate::program::{Program, program};
use crate::settings::Settings;
use fretwork_diagnostic::{Code, Diagnostic, Span};

/// The scope of the spec whose root is `root`, under `settings`.
#[salsa::tracked(returns(clone))]
pub fn scope(db: &dyn Db, root: SourceFile, settings: Settings) -> Arc<Scope> {
    let program = program(db, root);
    let mut scope = of_params(&program, &settings);
    add_paper(db, root, &settings, &mut scope);
    scope.failed.extend(program.unread.names.iter().cloned());
    report_unknown(&program, &settings, &mut scope);
    add_lets(db, &program, "", &settings, &mut scope);
    Arc::new(scope)
}

/// The scope of a module, or of the root where it has no name.
pub fn scope_of(
    db: &dyn Db,
    root: SourceFile,
    settings: Settings,
    module: &Arc<str>,
) -> Arc<Scope> {
    if module.is_empty() {
        scope(db, root, settings)
    } else {
        module_scope(db, root, settings, module.clone())
    }
}

/// The scope of a module under `settings` of the root: its params have the values that it is used with.
#[salsa::tracked(returns(clone))]
pub fn module_scope(
    db: &dyn Db,
    root: SourceFile,
    settings: Settings,
    module: Arc<str>,
) -> Arc<Scope> {
    let program = program(db, root);
    let mut made = Scope::default();
    let Some(user) = program.modules.get(&module) else {
        return Arc::new(made);
    };
    let outer = scope_of(db, root, settings.clone(), &user.parent);
    let own = || program.params.iter().filter(|p| p.module == module);
    let given = add_given(db, &program, (&module, user), &outer, &mut made);
    let unread = program.unread.names.iter();
    let own_unread = unread.filter_map(|name| name.strip_prefix(&*module)?.strip_prefix('.'));
    made.failed.extend(own_unread.map(Arc::from));
    let none = Settings::default();
    own()
        .filter(|param| !given.contains(&param.item.name))
        .for_each(|param| add_param(param, &none, &mut made));
    add_paper(db, root, &settings, &mut made);
    add_lets(db, &program, &module, &none, &mut made);
    Arc::new(made)
}

/// Gives params of a module the values that it is used with, and tells which these are.
fn add_given(
    db: &dyn Db,
    program: &Program,
    (module, user): (&Arc<str>, &Module),
    outer: &Scope,
    made: &mut Scope,
) -> BTreeSet<Arc<str>> {
    let own = || program.params.iter().filter(|p| p.module == *module);
    let mut given = BTreeSet::new();
    for (name, tree) in &user.uses.with {
        given.insert(name.clone());
        let with: Arc<str> = "with".into();
        let path = [&user.uses.at[..], &[with, name.clone()]].concat();
        let Some(param) = own().find(|p| p.item.name == *name) else {
            let known: Vec<&str> = own().map(|p| &*p.item.name).collect();
            let unknown =
                Diagnostic::error(format!("the module `{module}` has no parameter `{name}`"))
                    .about(Code::Reference)
                    .at(Span::key(&user.user.0, &path), "");
            made.diagnostics.push(unknown.suggest(name, known));
            continue;
        };
        let value = evaluate_tree(db, tree, (&user.user.0, &path), outer).and_then(|value| {
            param
                .item
                .accept_from(&value, user.user.1, param.units)
                .map_err(|problem| {
                    let message = format!("parameter `{name}`: {problem}");
                    let declared = Span::key(&param.file, &["params".into(), name.clone()]);
                    let error = Diagnostic::error(message).at(Span::value(&user.user.0, &path), "");
                    vec![error.at(declared, "declared here")]
                })
        });
        match value {
            Ok(value) => {
                made.values.insert(name.clone(), to_value(&value));
            }
            Err(diagnostics) => {
                made.diagnostics.extend(diagnostics);
                made.failed.insert(name.clone());
            }
        }
    }
    given
}
