//! `fretwork schema`: what a spec may say, for editors and for people.

use super::arguments::Schema;
use super::terminal::{self, Failure};
use crate::spec;

/// Prints the JSON Schema, or the reference page.
pub fn run(arguments: &Schema) -> Result<(), Failure> {
    if arguments.reference {
        terminal::print(&spec::reference())
    } else {
        terminal::print_json(&spec::schema())
    }
}
