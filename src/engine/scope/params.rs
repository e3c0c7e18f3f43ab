//! The values of parameters under settings.

use std::collections::BTreeSet;

use super::expression::to_value;
use super::values::Scope;
use crate::program::{Located, Program};
use crate::settings::{Setting, Settings};
use fretwork_diagnostic::{Code, Diagnostic, Span};
use fretwork_language::{Param, Tree};

/// The value of a param under `settings`.
///
/// # Errors
/// What is wrong with it, in a sentence.
pub fn setting_of(located: &Located<Param>, settings: &Settings) -> Result<Tree, String> {
    let param = &located.item;
    match settings.get(&param.name) {
        None => Ok(param.default.clone()),
        Some(Setting::Text(text)) => param.parse(text, located.units),
        Some(Setting::Value(value)) => param.accept(value, located.units),
    }
}

/// Adds a parameter's value under `settings`, or what is wrong with it.
pub fn add_param(located: &Located<Param>, settings: &Settings, scope: &mut Scope) {
    let param = &located.item;
    match setting_of(located, settings) {
        Ok(value) => {
            scope.values.insert(param.name.clone(), to_value(&value));
        }
        Err(problem) => {
            let span = Span::key(&located.file, &["params".into(), param.name.clone()]);
            let message = format!("parameter `{}`: {problem}", param.name);
            scope
                .diagnostics
                .push(Diagnostic::error(message).at(span, "declared here"));
            scope.failed.insert(param.name.clone());
        }
    }
}

/// The parameters of the root alone.
pub fn of_params(program: &Program, settings: &Settings) -> Scope {
    let mut scope = Scope::default();
    for param in program.own_params() {
        add_param(param, settings, &mut scope);
    }
    scope
}

/// Reports the settings that name no parameter of the spec, and no derived value that may be set.
pub fn report_unknown(program: &Program, settings: &Settings, scope: &mut Scope) {
    let known: Vec<&str> = program.own_params().map(|p| &*p.item.name).collect();
    let mut lets = program.lets.iter().filter(|l| l.module.is_empty());
    let own_lets: BTreeSet<&str> = lets.by_ref().map(|l| &*l.item.0).collect();
    let is_let = |name: &str| own_lets.contains(name);
    for (name, setting) in settings.entries() {
        let is_known = known.contains(&name) || program.unread.names.contains(name);
        if is_known || (is_let(name) && matches!(setting, Setting::Value(_))) {
            continue;
        }
        let unknown =
            Diagnostic::error(format!("the spec has no parameter `{name}`")).about(Code::Reference);
        let unknown = match (name.split_once('.'), &known[..]) {
            (Some((module, own)), _) => unknown.help(format!(
                "parameters of a module are given where it is used: `use: {{ {module}: FILE, with: {{ {own}: … }} }}`"
            )),
            (None, []) => unknown.help("it declares none"),
            (None, known) => unknown.help(format!("its parameters are {}", known.join(", "))),
        };
        scope
            .diagnostics
            .push(unknown.suggest(name, known.iter().copied()));
    }
}
