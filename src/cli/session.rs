//! What every command that reads a spec begins with: the project, its compiler, its cache.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::cache_folder::{self, Limit};
use super::disk::DiskWorld;
use super::terminal::{self, Failure};
use fretwork_diagnostic::Diagnostic;
use fretwork_engine::{Cache, Compiler, EngineChoice, Settings, Versions, World};
use fretwork_store::LocalStore;

/// A project and a compiler for it.
pub struct Session {
    /// The project on disk.
    pub world: DiskWorld,
    /// The compiler.
    pub compiler: Compiler,
    /// The specs that the command speaks of, as paths from the project root.
    pub specs: Vec<String>,
    /// Why the cache is not used, if it was to be.
    pub warnings: Vec<Diagnostic>,
    /// The cache and its greatest size.
    cache: Option<(LocalStore, Limit)>,
}

/// Where the cache is, if it is used.
pub enum CacheAt<'a> {
    /// Beside the root marker, or in this folder.
    Folder(Option<&'a Path>, Versions),
    /// Not used.
    Nowhere,
}

impl Session {
    /// The session for `specs`, or for every spec of the project of the current folder.
    ///
    /// # Errors
    /// When a spec does not exist, the specs lie in several projects, or there is none.
    pub fn open(specs: &[PathBuf], cache: CacheAt<'_>) -> Result<Session, Failure> {
        let world = Session::world_of(specs)?;
        let specs = if specs.is_empty() {
            found(&world)?
        } else {
            named(&world, specs)?
        };
        Session::of_world(world, specs, cache)
    }

    /// The session for `specs` of the project `world`.
    ///
    /// # Errors
    /// When the size of the cache is given wrongly.
    pub fn of_world(
        world: DiskWorld,
        specs: Vec<String>,
        cache: CacheAt<'_>,
    ) -> Result<Session, Failure> {
        let files = Arc::new(world.clone());
        let session = Session::over(world, files, cache)?;
        Ok(Session { specs, ..session })
    }

    /// The session without specs for a project at the place of `world` whose files are those of `files`.
    ///
    /// # Errors
    /// As [`Session::of_world`].
    pub fn over(
        world: DiskWorld,
        files: Arc<dyn World>,
        cache: CacheAt<'_>,
    ) -> Result<Session, Failure> {
        let (mut warnings, mut known) = (Vec::new(), None);
        let cache = match cache {
            CacheAt::Folder(folder, versions) => match cache_folder::find(world.root(), folder) {
                Ok(folder) => {
                    let store = LocalStore::new(&folder);
                    known = Some((store.clone(), Limit::given()?));
                    Some(Cache { store, versions })
                }
                Err(why) => {
                    warnings.push(why);
                    None
                }
            },
            CacheAt::Nowhere => None,
        };
        let checks_values = std::env::var_os("FRETWORK_CHECK").is_some_and(|value| value == "1");
        let compiler = Compiler::new(files, cache, checks_values);
        Ok(Session {
            world,
            compiler,
            specs: Vec::new(),
            warnings,
            cache: known,
        })
    }

    /// The session with so many times the budget of a build.
    pub fn with_budget(mut self, factor: f64) -> Session {
        self.compiler = self.compiler.with_budget(factor);
        self
    }

    /// The session that draws arrangements by some engine.
    pub fn with_engine(mut self, engine: EngineChoice) -> Session {
        self.compiler = self.compiler.with_engine(engine);
        self
    }

    /// The project of `specs`, or of the current folder.
    ///
    /// # Errors
    /// When the first spec does not exist.
    pub fn world_of(specs: &[PathBuf]) -> Result<DiskWorld, Failure> {
        let start = specs.first().map_or(Path::new("."), PathBuf::as_path);
        DiskWorld::find(start).map_err(|e| unreadable(start, &e))
    }

    /// Keeps the cache at its size.
    pub fn settle(&self) {
        if let Some((store, limit)) = &self.cache {
            // That it cannot be written has been told; that it cannot be made smaller, the next build tells.
            let _ = store.settle(limit.bytes());
        }
    }

    /// The session for exactly one spec.
    ///
    /// # Errors
    /// As [`Session::open`], or the path is a folder of several specs.
    pub fn of_one(spec: &Path, cache: CacheAt<'_>) -> Result<(Session, String), Failure> {
        let session = Session::open(&[spec.to_path_buf()], cache)?;
        match &session.specs[..] {
            [only] => {
                let only = only.clone();
                Ok((session, only))
            }
            several => Err(Failure::usage(format!(
                "`{}` holds {} specs; name one of them",
                spec.display(),
                several.len()
            ))),
        }
    }

    /// Prints diagnostics with their source lines.
    pub fn print(&self, diagnostics: &[fretwork_diagnostic::Diagnostic]) {
        terminal::print_diagnostics(diagnostics, &self.compiler.sources());
    }
}

/// `--set` values as the compiler takes them.
pub fn settings(sets: &[(String, String)]) -> Settings {
    Settings::new(
        sets.iter()
            .map(|(name, value)| (name.as_str(), value.as_str())),
    )
}

fn found(world: &DiskWorld) -> Result<Vec<String>, Failure> {
    let specs = world
        .specs()
        .map_err(|e| Failure::usage(format!("cannot list the specs: {e}")))?;
    if specs.is_empty() {
        let message = format!(
            "there is no spec below {}",
            world.root().join("specs").display()
        );
        return Err(Failure::usage(
            message + "; name one, or make a project with `fretwork init DIR`",
        ));
    }
    Ok(specs)
}

fn named(world: &DiskWorld, specs: &[PathBuf]) -> Result<Vec<String>, Failure> {
    let mut named = Vec::new();
    for spec in specs {
        let names = world.specs_at(spec).map_err(|e| unreadable(spec, &e))?;
        for name in names {
            if !named.contains(&name) {
                named.push(name);
            }
        }
    }
    Ok(named)
}

/// The failure for a spec that cannot be read, with advice where its path is one of Windows.
fn unreadable(path: &Path, error: &dyn std::error::Error) -> Failure {
    let shown = path.display().to_string();
    let advice = if shown.contains('\\') {
        format!(
            "; write `/` between folders: `{}`",
            shown.replace('\\', "/")
        )
    } else {
        String::new()
    };
    Failure::usage(format!("cannot read `{shown}`: {error}{advice}"))
}
