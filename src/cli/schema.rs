//! `fretwork schema`: what a spec may say, for editors and for people.

use super::arguments::Schema;
use super::terminal::{self, Failure};

/// Prints the JSON Schema, the reference page, or that of the functions of scripts.
pub fn run(arguments: &Schema) -> Result<(), Failure> {
    if arguments.functions {
        terminal::print(&fretwork_engine::functions_reference())
    } else if arguments.reference {
        terminal::print(&fretwork_language::reference())
    } else {
        terminal::print_json(&fretwork_language::schema())
    }
}
