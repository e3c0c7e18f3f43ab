//! What is wrong with a drawing, with the fields of its artifact that are to blame.

use fretwork_action::Action;
use fretwork_diagnostic::Diagnostic;

/// An error about a drawing. Which file the fields stand in is known to who asked for it.
#[derive(Clone, Debug)]
pub struct Fault {
    told: Box<Diagnostic>,
    /// The ways to the fields inside the artifact, each with what is said there.
    fields: Vec<(Vec<String>, &'static str)>,
}

impl From<Diagnostic> for Fault {
    fn from(told: Diagnostic) -> Fault {
        Fault {
            told: Box::new(told),
            fields: Vec::new(),
        }
    }
}

impl Fault {
    /// The same fault, for which a field is to blame.
    pub fn at(mut self, field: Vec<String>, here: &'static str) -> Fault {
        self.fields.push((field, here));
        self
    }

    /// The error at its fields, or at the artifact of the action where no field is to blame.
    pub fn placed(self, action: &Action) -> Diagnostic {
        if self.fields.is_empty() {
            return self.told.at(action.span(), "in this artifact");
        }
        self.fields.iter().fold(*self.told, |told, (field, here)| {
            let steps: Vec<&str> = field.iter().map(String::as_str).collect();
            told.at(action.definition.field(&steps), *here)
        })
    }
}
