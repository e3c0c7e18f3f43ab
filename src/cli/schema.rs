//! `fretwork schema`: what a spec may say, for editors and for people.

use super::arguments::Schema;
use super::terminal::{self, Failure};

/// Prints the JSON Schema, or the reference page.
pub fn run(arguments: &Schema) -> Result<(), Failure> {
    if arguments.reference {
        terminal::print(&fretwork_language::reference())
    } else {
        terminal::print_json(&fretwork_language::schema())
    }
}
