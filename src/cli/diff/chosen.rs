//! Which specs a comparison is about: all, or those that the command line names, which need not be there any more.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::disk::DiskWorld;
use crate::place::without_dots;
use crate::terminal::Failure;

/// The specs that the command line names, as paths from the root; a folder ends with `/`.
pub struct Chosen(Vec<String>);

impl Chosen {
    /// Those at these paths of the disk; all specs where there is none.
    ///
    /// # Errors
    /// When one lies outside of the project.
    pub fn of(world: &DiskWorld, specs: &[PathBuf]) -> Result<Chosen, Failure> {
        let named = |spec: &PathBuf| {
            let shown = spec.display();
            let path = std::path::absolute(spec)
                .map_err(|e| Failure::usage(format!("cannot find `{shown}`: {e}")))?;
            let path = without_dots(&path);
            // The folders on the way may be links, and the file need not be there any more.
            let real = path.ancestors().find_map(|above| {
                let real = above.canonicalize().ok()?;
                Some(real.join(path.strip_prefix(above).ok()?))
            });
            let real = real.unwrap_or(path);
            let inside = real.strip_prefix(world.root()).ok().and_then(Path::to_str);
            inside
                .map(|inside| inside.replace('\\', "/"))
                .ok_or_else(|| {
                    Failure::usage(format!("`{shown}` lies outside of the project root"))
                })
        };
        specs
            .iter()
            .map(named)
            .collect::<Result<_, _>>()
            .map(Chosen)
    }

    /// Those of `specs` that are meant, and files that are named and that `has` knows.
    pub fn among(&self, specs: Vec<String>, has: impl Fn(&str) -> bool) -> Vec<String> {
        if self.0.is_empty() {
            return specs;
        }
        let is_meant = |spec: &String| self.0.iter().any(|named| is_at(spec, named));
        let mut meant: BTreeSet<String> = specs.into_iter().filter(is_meant).collect();
        let is_spec = |name: &&String| name.ends_with(".yaml") || name.ends_with(".yml");
        meant.extend(
            self.0
                .iter()
                .filter(is_spec)
                .filter(|name| has(name))
                .cloned(),
        );
        meant.into_iter().collect()
    }

    /// Whether each name means a spec of one of the states.
    ///
    /// # Errors
    /// When neither state has a spec that is named.
    pub fn check(&self, before: &[String], after: &[String]) -> Result<(), Failure> {
        let is_known = |named: &&String| before.iter().chain(after).any(|spec| is_at(spec, named));
        match self.0.iter().find(|named| !is_known(named)) {
            None => Ok(()),
            Some(named) => Err(Failure::usage(format!(
                "there is no spec `{named}` before or after"
            ))),
        }
    }
}

/// Whether a spec is the file or lies in the folder at `named`.
fn is_at(spec: &str, named: &str) -> bool {
    let rest = spec.strip_prefix(named);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('/') || named.is_empty())
}
