//! The functions that a file defines at its top, and whether arguments fit them.

use starlark::syntax::ast::{AstParameter, AstStmt, ParameterP, Stmt};

use crate::fault::Fault;
use fretwork_diagnostic::nearest;

/// A function as it is defined.
pub(crate) struct Definition {
    pub name: String,
    /// Its parameters, and whether each has a default.
    parameters: Vec<(String, bool)>,
    /// Whether it takes arguments of any name.
    is_open: bool,
}

impl Definition {
    /// What is wrong with arguments of these names, if something is.
    pub fn refuses(&self, names: &[&str]) -> Option<Box<Fault>> {
        let known = || self.parameters.iter().map(|(name, _)| name.as_str());
        if let Some(unknown) = names
            .iter()
            .find(|name| !self.is_open && known().all(|known| known != **name))
        {
            let mut fault = Fault::new(format!("`{}` has no parameter `{unknown}`", self.name));
            let all: Vec<String> = known().map(|name| format!("`{name}`")).collect();
            fault.help(Some(match nearest(unknown, known()) {
                Some(near) => format!("did you mean `{near}`?"),
                None if all.is_empty() => "it has none".to_string(),
                None => format!("it has {}", all.join(", ")),
            }));
            return Some(fault);
        }
        let missing = self
            .parameters
            .iter()
            .find(|(name, has_default)| !has_default && !names.contains(&name.as_str()));
        missing.map(|(name, _)| Fault::new(format!("`{}` needs an argument `{name}`", self.name)))
    }
}

/// What `def` statements at the top define, in order.
pub(crate) fn functions(statement: &AstStmt) -> Vec<Definition> {
    match &statement.node {
        Stmt::Statements(inner) => inner.iter().flat_map(functions).collect(),
        Stmt::Def(def) => {
            let parameter = |p: &AstParameter| match &p.node {
                ParameterP::Normal(name, _, default) => {
                    Some((name.node.ident.clone(), default.is_some()))
                }
                _ => None,
            };
            vec![Definition {
                name: def.name.node.ident.clone(),
                parameters: def.params.iter().filter_map(parameter).collect(),
                is_open: def
                    .params
                    .iter()
                    .any(|p| matches!(p.node, ParameterP::KwArgs(..))),
            }]
        }
        _ => Vec::new(),
    }
}
