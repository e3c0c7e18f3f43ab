//! What can be known to fail before anything is evaluated: kinds that the language has, but that no stage
//! makes yet. A build refuses them where an artifact needs them.

use fretwork_action::Definition;
use fretwork_diagnostic::Diagnostic;
use fretwork_language::Node;
use fretwork_language::kinds::fields::Field;

/// The error for a node whose kind cannot be evaluated yet.
pub fn unsupported(definition: &Definition) -> Option<Diagnostic> {
    let what = match &definition.node {
        Node::Field(Field::Expression(formula)) if !matches!(formula.value.len(), 1 | 3) => {
            "a field of vectors"
        }
        _ => return None,
    };
    let message = format!("{what} is not supported yet");
    Some(Diagnostic::error(message).at(definition.span(), "needed here"))
}
