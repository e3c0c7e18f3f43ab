//! Derived values, each after those that it names.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::expression::{evaluate_tree, size, to_value};
use super::names::collect_names;
use super::values::Scope;
use crate::database::Db;
use crate::program::Program;
use crate::settings::{Setting, Settings};
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_language::Tree;

type Lets<'a> = BTreeMap<Arc<str>, (&'a Arc<str>, &'a Tree)>;

/// A `let` whose value waits for those that it names.
struct Open {
    name: Arc<str>,
    /// The names that it reads and that were not looked at yet.
    needed: Vec<Arc<str>>,
}

/// All derived values of a spec together may have so many elements; see [`size`]. With what the interpreter makes of them
/// that is some hundred megabytes.
const LARGEST: usize = 1 << 22;

/// The derived values of a module, or of the root where it has no name.
pub fn add_lets(
    db: &dyn Db,
    program: &Program,
    module: &str,
    settings: &Settings,
    scope: &mut Scope,
) {
    let own = program.lets.iter().filter(|l| *l.module == *module);
    let lets: Lets<'_> = own
        .map(|l| (l.item.0.clone(), (&l.file, &l.item.1)))
        .collect();
    for name in lets.keys() {
        add_let(db, name, &lets, settings, scope);
    }
}

/// Evaluates a `let` after those that it names. A stack on the heap: chains of lets may be long.
fn add_let(db: &dyn Db, name: &Arc<str>, lets: &Lets<'_>, settings: &Settings, scope: &mut Scope) {
    let mut open: Vec<Open> = Vec::new();
    let mut is_open = BTreeSet::new();
    let mut next = Some(name.clone());
    loop {
        if let Some(name) = next.take() {
            if is_open.contains(&name) {
                scope.diagnostics.push(cycle_of_lets(&open, &name, lets));
                scope.failed.insert(name);
            } else if !scope.values.contains_key(&name) && !scope.failed.contains(&name) {
                if let Some(Setting::Value(value)) =
                    settings.get(&name).filter(|_| lets.contains_key(&name))
                {
                    scope.values.insert(name, to_value(value));
                } else if let Some((_, tree)) = lets.get(&name) {
                    let mut needed = BTreeSet::new();
                    collect_names(tree, &mut needed);
                    is_open.insert(name.clone());
                    open.push(Open {
                        name,
                        needed: needed.into_iter().rev().collect(),
                    });
                }
            }
        }
        let Some(top) = open.last_mut() else { return };
        next = top.needed.pop();
        if next.is_none() {
            is_open.remove(&top.name);
            evaluate_let(db, &top.name, lets, scope);
            open.pop();
        }
    }
}

fn evaluate_let(db: &dyn Db, name: &Arc<str>, lets: &Lets<'_>, scope: &mut Scope) {
    let Some((file, tree)) = lets.get(name) else {
        return;
    };
    let path = ["let".into(), name.clone()];
    match evaluate_tree(db, tree, (file, &path), scope) {
        Ok(value) => {
            scope.size += size(&value);
            if scope.size > LARGEST {
                let message = format!("the values of `let` have more than {LARGEST} elements");
                let error =
                    Diagnostic::error(message).at(Span::key(file, &path), "too many with this");
                if !std::mem::replace(&mut scope.is_full, true) {
                    scope.diagnostics.push(error);
                }
                scope.failed.insert(name.clone());
                return;
            }
            scope.values.insert(name.clone(), to_value(&value));
        }
        Err(diagnostics) => {
            scope.diagnostics.extend(diagnostics);
            scope.failed.insert(name.clone());
        }
    }
}

/// The error for the innermost open `let` naming `name`, which is open.
fn cycle_of_lets(open: &[Open], name: &Arc<str>, lets: &Lets<'_>) -> Diagnostic {
    let start = open.iter().position(|o| o.name == *name).unwrap_or(0);
    let cycle: Vec<&Arc<str>> = open[start..]
        .iter()
        .map(|o| &o.name)
        .chain([name])
        .collect();
    let path: Vec<&str> = cycle.iter().map(|n| &***n).collect();
    let message = format!("a cycle of derived values: {}", path.join(" → "));
    cycle
        .windows(2)
        .fold(Diagnostic::error(message), |diagnostic, step| {
            match lets.get(step[0]) {
                Some((file, _)) => {
                    let span = Span::value(file, &["let".into(), step[0].clone()]);
                    diagnostic.at(span, format!("`{}` needs `{}`", step[0], step[1]))
                }
                None => diagnostic,
            }
        })
}
