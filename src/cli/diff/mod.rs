//! `fretwork diff`: what a change of the specs does to the artifacts, in numbers and pictures. Git gives the files of
//! revisions (`git`, `revision`); one compiler builds both states (`sides`), which are compared (`comparison`, `changes`, `change`), shown
//! (`text`) and drawn (`pictures`).

pub mod change;
mod changes;
mod chosen;
pub mod comparison;
mod git;
mod measures;
mod pictures;
mod revision;
mod sides;
pub mod text;

use super::arguments::{Diff, DiffFormat};
use super::github;
use super::terminal::{self, Failure};
use comparison::{Comparison, Wanted};
use fretwork_engine::Versions;

/// Compares two states and prints what differs.
///
/// # Errors
/// When there is no such state, one of them does not build, or, if that was asked for, an artifact differs.
pub fn run(arguments: &Diff, versions: Versions) -> Result<(), Failure> {
    let wanted = Wanted {
        before: &arguments.before,
        after: arguments.after.as_deref(),
        specs: &arguments.specs,
        only: &arguments.only,
        evaluation: &arguments.evaluation,
    };
    let mut comparison = Comparison::of(&wanted, versions)?;
    if let Some(out) = &arguments.out {
        pictures::write(&mut comparison, out, arguments.only.is_empty())?;
    }
    let [(before, old), (after, new)] = &comparison.told;
    let count = old + new;
    terminal::print_errors(&format!("{after}{before}"), count);
    match arguments.format {
        DiffFormat::Human => terminal::print(&text::human(&comparison))?,
        DiffFormat::Json => terminal::print_json(&comparison)?,
        DiffFormat::Github => {
            let notices = text::notices(&comparison);
            terminal::print(&(github::commands(&comparison.errors) + &notices))?;
            github::append(&text::markdown(&comparison));
        }
    }
    if count > 0 {
        return Err(Failure::Build);
    }
    let differs = comparison.artifacts.iter().any(|one| one.status.differs());
    if arguments.exit_code && differs {
        return Err(Failure::Differs);
    }
    Ok(())
}
