//! What a change of a project does to its artifacts: each with its status, the measures that changed, and how much geometry
//! was added and removed.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

use serde::Serialize;

use super::change::{Change, Status};
use super::changes::changes;
use super::chosen::Chosen;
use super::git::Repository;
use super::revision::Revision;
use super::sides::{Files, Side, Sides, State};
use crate::arguments::Evaluation;
use crate::disk::DiskWorld;
use crate::placed::Placed;
use crate::session::{CacheAt, Session};
use crate::terminal::Failure;
use fretwork_engine::{Versions, World};

/// Two states of a project compared.
#[derive(Debug, Serialize)]
pub struct Comparison {
    /// What the state before is called.
    pub before: String,
    /// What the state after is called.
    pub after: String,
    /// All artifacts of both, by their paths.
    pub artifacts: Vec<Change>,
    /// What is wrong with either; messages name the revision.
    pub errors: Vec<Placed>,
    /// The same of each state for people, and how many errors it has: before, after.
    #[serde(skip)]
    pub told: [(String, usize); 2],
    /// The root of the project.
    #[serde(skip)]
    pub root: PathBuf,
    /// The specs of both states.
    #[serde(skip)]
    pub specs: Vec<String>,
}

/// What is to be compared.
pub struct Wanted<'a> {
    /// The revision before.
    pub before: &'a str,
    /// The revision after; none for the work tree.
    pub after: Option<&'a str>,
    /// The specs, or folders of specs; all where none is named.
    pub specs: &'a [PathBuf],
    /// Artifacts, or nodes whose artifacts are meant; all where none is named.
    pub only: &'a [String],
    /// How to evaluate.
    pub evaluation: &'a Evaluation,
}

impl Comparison {
    /// Compares two states of the project of the current folder or of the first spec.
    ///
    /// # Errors
    /// When there is no repository or no such revision, or the command line names what neither state has.
    pub fn of(wanted: &Wanted<'_>, versions: Versions) -> Result<Comparison, Failure> {
        let world = project(wanted.specs)?;
        let root = world.root().to_path_buf();
        let (files, before, after) = states(&world, wanted)?;
        let mut sides = sides(world, files, wanted, versions)?;
        let named = |rev: Option<&str>, specs| State {
            rev: rev.map(str::to_string),
            specs,
            ..State::default()
        };
        let mut before = named(Some(wanted.before), before);
        let mut after = named(wanted.after, after);
        build(&mut sides, wanted, &mut before, &mut after)?;
        let artifacts = changes(&mut sides, &before, &after);
        sides.session.settle();
        let specs: BTreeSet<String> = before.specs.into_iter().chain(after.specs).collect();
        Ok(Comparison {
            before: wanted.before.to_string(),
            after: wanted.after.unwrap_or("work tree").to_string(),
            artifacts,
            errors: [after.errors, before.errors].concat(),
            told: [(before.text, before.count), (after.text, after.count)],
            root,
            specs: specs.into_iter().collect(),
        })
    }

    /// How many artifacts have this status.
    pub fn count_of(&self, status: Status) -> usize {
        let of = |change: &&Change| change.status == status;
        self.artifacts.iter().filter(of).count()
    }
}

/// The files of both states, and the specs of each that are meant.
type Found = (Arc<Files>, Vec<String>, Vec<String>);

/// # Errors
/// When there is no such state, or it has none of the specs that are named.
fn states(world: &DiskWorld, wanted: &Wanted<'_>) -> Result<Found, Failure> {
    let repository = Repository::of(world.root())?;
    let old = Revision::of(&repository, wanted.before)?;
    let new = wanted.after.map(|rev| Revision::of(&repository, rev));
    let chosen = Chosen::of(world, wanted.specs)?;
    let before = chosen.among(old.specs(), |spec| old.has(spec));
    let (after, new): (_, Arc<dyn World>) = match new.transpose()? {
        Some(new) => (
            chosen.among(new.specs(), |spec| new.has(spec)),
            Arc::new(new),
        ),
        None => {
            let listed = world.specs().unwrap_or_default();
            let has = |spec: &str| world.root().join(spec).is_file();
            (chosen.among(listed, has), Arc::new(world.clone()))
        }
    };
    chosen.check(&before, &after)?;
    Ok((Arc::new(Files::new(Arc::new(old), new)), before, after))
}

/// The project of the first spec that exists, or of the current folder.
fn project(specs: &[PathBuf]) -> Result<DiskWorld, Failure> {
    let there = specs.iter().find(|spec| spec.exists());
    Session::world_of(&there.cloned().into_iter().collect::<Vec<_>>())
}

fn sides<'a>(
    world: DiskWorld,
    files: Arc<Files>,
    wanted: &Wanted<'a>,
    versions: Versions,
) -> Result<Sides<'a>, Failure> {
    let evaluation = wanted.evaluation;
    let cache = match evaluation.no_cache {
        true => CacheAt::Nowhere,
        false => CacheAt::Folder(evaluation.cache_dir.as_deref(), versions),
    };
    let mut session = Session::over(world, files.clone(), cache)?;
    session.compiler = session.compiler.without_record();
    Ok(Sides {
        session: session
            .with_engine(evaluation.engine.into())
            .with_budget(evaluation.budget),
        files,
        evaluation,
    })
}

/// Builds both states, the newer one first: most of the older one is then known.
fn build(
    sides: &mut Sides<'_>,
    wanted: &Wanted<'_>,
    before: &mut State,
    after: &mut State,
) -> Result<(), Failure> {
    let has_sets = !wanted.evaluation.sets.is_empty();
    if wanted.only.is_empty() && !has_sets {
        sides.build(after, None);
        sides.turn(Side::Before);
        sides.build(before, None);
        return Ok(());
    }
    let paths = chosen(sides, wanted, &before.specs, &after.specs)?;
    let paths = Some(&paths).filter(|_| !wanted.only.is_empty());
    sides.build(before, paths);
    sides.turn(Side::After);
    sides.build(after, paths);
    Ok(())
}

/// The paths that the names on the command line mean in one of the states. Reads the older one in the end.
///
/// # Errors
/// When neither state knows a name or a parameter.
fn chosen(
    sides: &mut Sides<'_>,
    wanted: &Wanted<'_>,
    before: &[String],
    after: &[String],
) -> Result<BTreeSet<String>, Failure> {
    let mut params = sides.params(after);
    let mut named = sides.named(after);
    sides.turn(Side::Before);
    params.extend(sides.params(before));
    for (name, paths) in sides.named(before) {
        named.entry(name).or_default().extend(paths);
    }
    let mut sets = wanted.evaluation.sets.iter();
    if let Some((name, _)) = sets.find(|(name, _)| !params.contains(name)) {
        return Err(Failure::usage(format!("no spec has a parameter `{name}`")));
    }
    let mut chosen = BTreeSet::new();
    for name in wanted.only {
        let Some(paths) = named.get(name) else {
            let message = format!("no artifact is named or needs `{name}`");
            return Err(Failure::usage(message));
        };
        chosen.extend(paths.iter().cloned());
    }
    Ok(chosen)
}
