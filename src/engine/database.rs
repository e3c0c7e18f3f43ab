//! The salsa database: what is an input, and what the queries may ask for besides.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use salsa::Setter as _;

use super::cache::Cache;
use super::content::FileContent;
use super::world::{World, WorldReader};
use fretwork_action::{Common, EngineChoice, ReadError, Reader};
use fretwork_geometry::budget::{Budget, Limits};
use fretwork_store::{Digest, LocalStore};

/// A file that something has asked for.
#[salsa::input(debug)]
pub struct SourceFile {
    /// The path from the project root.
    #[returns(ref)]
    pub path: Arc<str>,
    /// What is in it.
    #[returns(ref)]
    pub content: Result<FileContent, ReadError>,
}

/// How a value was come by, for reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Provenance {
    /// It was computed.
    Evaluated,
    /// It was found in the store.
    Cached,
}

/// What queries need besides salsa.
#[salsa::db]
pub trait Db: salsa::Database {
    /// The file at `path`, read when it is first asked for.
    fn file(&self, path: &Arc<str>) -> SourceFile;
    /// The files of the project.
    fn world(&self) -> Arc<dyn World>;
    /// What stages read by themselves.
    fn reader(&self) -> Arc<dyn Reader>;
    /// The store of earlier results, unless it is switched off.
    fn store(&self) -> Option<&LocalStore>;
    /// The version of a room.
    fn version(&self, room: &str) -> &str;
    /// What the nodes of a build may use.
    fn budget(&self) -> &Budget;
    /// What the windows of an artifact have in common that are built together.
    fn common(&self, key: &Digest) -> Common;
    /// Which engines arrangements are drawn by.
    fn engine(&self) -> EngineChoice;
    /// Whether every value is checked.
    fn checks_values(&self) -> bool;
    /// Notes that the store could not be written; the build goes on without it.
    fn store_failed(&self, error: std::io::Error);
    /// Notes how the value of a job was come by, since `started`.
    fn evaluated(&self, job: &super::Job, provenance: Provenance, started: Instant);
}

/// One event of a build.
#[derive(Clone, Debug)]
pub struct Event {
    /// Of what.
    pub job: super::Job,
    /// How.
    pub provenance: Provenance,
    /// When it began.
    pub started: Instant,
    /// How long it took.
    pub time: Duration,
    /// The number of the thread, from 0 in the order of their first events.
    pub thread: usize,
}

/// The database of a process.
#[salsa::db]
#[derive(Clone)]
pub struct Database {
    storage: salsa::Storage<Self>,
    shared: Arc<Shared>,
}

struct Shared {
    world: Arc<dyn World>,
    cache: Option<Cache>,
    checks_values: bool,
    budget: Budget,
    engine: EngineChoice,
    files: Mutex<BTreeMap<Arc<str>, SourceFile>>,
    commons: Mutex<BTreeMap<Digest, Common>>,
    events: Mutex<Vec<Event>>,
    threads: Mutex<Vec<std::thread::ThreadId>>,
    store_error: Mutex<Option<String>>,
    reader: Arc<WorldReader>,
    executed: Arc<Mutex<Vec<salsa::DatabaseKeyIndex>>>,
}

const UNPOISONED: &str = "no code panics while it holds this lock";

impl Database {
    /// A database over `world`, with or without a cache, that checks every value or trusts the stages.
    pub fn new(world: Arc<dyn World>, cache: Option<Cache>, checks_values: bool) -> Database {
        let executed: Arc<Mutex<Vec<salsa::DatabaseKeyIndex>>> = Arc::default();
        let log = executed.clone();
        let storage = salsa::Storage::new(Some(Box::new(move |event: salsa::Event| {
            // A process that builds again and again would remember it all.
            if cfg!(test)
                && let salsa::EventKind::WillExecute { database_key } = event.kind
            {
                log.lock().expect(UNPOISONED).push(database_key);
            }
        })));
        let shared = Shared {
            reader: Arc::new(WorldReader::new(world.clone())),
            world,
            cache,
            checks_values,
            budget: Budget::default(),
            engine: EngineChoice::Auto,
            files: Mutex::default(),
            commons: Mutex::default(),
            events: Mutex::default(),
            threads: Mutex::default(),
            store_error: Mutex::default(),
            executed,
        };
        Database {
            storage,
            shared: Arc::new(shared),
        }
    }

    /// Lets a node use `limits`. Nobody may have a clone of the database yet.
    pub fn limit(&mut self, limits: Limits) {
        let shared = Arc::get_mut(&mut self.shared);
        shared.expect("nobody has a clone yet").budget = Budget::new(limits);
    }

    /// Chooses how arrangements are drawn. Nobody may have a clone of the database yet.
    pub fn choose(&mut self, engine: EngineChoice) {
        let shared = Arc::get_mut(&mut self.shared);
        shared.expect("nobody has a clone yet").engine = engine;
    }

    /// Reads every known file again and gives new contents to those whose bytes changed. All other
    /// clones of the database must have been dropped. Gives the paths of the changed files.
    pub fn refresh(&mut self) -> Vec<Arc<str>> {
        let files: Vec<_> = self
            .shared
            .files
            .lock()
            .expect(UNPOISONED)
            .iter()
            .map(|(p, f)| (p.clone(), *f))
            .collect();
        let mut changed = Vec::new();
        for (path, file) in files {
            let known = file.content(self).as_ref().ok();
            let content = FileContent::read(&*self.shared.world, &path, self.store(), known);
            // Setting an equal content would start a new revision and run the parse again.
            if *file.content(self) != content {
                let _old = file.set_content(self).to(content);
                changed.push(path);
            }
        }
        if !changed.is_empty() {
            self.shared.reader.changed();
        }
        changed
    }

    /// The paths of all files that were asked for.
    pub fn known_files(&self) -> Vec<Arc<str>> {
        self.shared
            .files
            .lock()
            .expect(UNPOISONED)
            .keys()
            .cloned()
            .collect()
    }

    /// Lets go of what windows had in common that were built together.
    pub fn forget_commons(&self) {
        self.shared.commons.lock().expect(UNPOISONED).clear();
    }

    /// The events since the last call.
    pub fn take_events(&self) -> Vec<Event> {
        std::mem::take(&mut *self.shared.events.lock().expect(UNPOISONED))
    }

    /// Why the store could not be written, if it could not.
    pub fn take_store_error(&self) -> Option<String> {
        self.shared.store_error.lock().expect(UNPOISONED).take()
    }

    /// The names of the queries executed since the last call.
    pub fn take_executed(&self) -> Vec<String> {
        use salsa::Database as _;
        let keys = std::mem::take(&mut *self.shared.executed.lock().expect(UNPOISONED));
        keys.iter()
            .map(|key| {
                self.ingredient_debug_name(key.ingredient_index())
                    .into_owned()
            })
            .collect()
    }
}

#[salsa::db]
impl salsa::Database for Database {}

#[salsa::db]
impl Db for Database {
    fn file(&self, path: &Arc<str>) -> SourceFile {
        let mut files = self.shared.files.lock().expect(UNPOISONED);
        if let Some(file) = files.get(path) {
            return *file;
        }
        let content = FileContent::read(&*self.shared.world, path, self.store(), None);
        let file = SourceFile::new(self, path.clone(), content);
        files.insert(path.clone(), file);
        file
    }

    fn world(&self) -> Arc<dyn World> {
        self.shared.world.clone()
    }

    fn reader(&self) -> Arc<dyn Reader> {
        self.shared.reader.clone()
    }

    fn store(&self) -> Option<&LocalStore> {
        self.shared.cache.as_ref().map(|cache| &cache.store)
    }

    fn version(&self, room: &str) -> &str {
        let cache = self.shared.cache.as_ref();
        cache.map_or("", |cache| cache.versions.of(room))
    }

    fn budget(&self) -> &Budget {
        &self.shared.budget
    }

    fn common(&self, key: &Digest) -> Common {
        let mut commons = self.shared.commons.lock().expect(UNPOISONED);
        commons.entry(*key).or_default().clone()
    }

    fn engine(&self) -> EngineChoice {
        self.shared.engine
    }

    fn checks_values(&self) -> bool {
        self.shared.checks_values
    }

    fn store_failed(&self, error: std::io::Error) {
        self.shared
            .store_error
            .lock()
            .expect(UNPOISONED)
            .get_or_insert_with(|| error.to_string());
    }

    fn evaluated(&self, job: &super::Job, provenance: Provenance, started: Instant) {
        let time = started.elapsed();
        let thread = {
            let mut threads = self.shared.threads.lock().expect(UNPOISONED);
            let me = std::thread::current().id();
            threads.iter().position(|t| *t == me).unwrap_or_else(|| {
                threads.push(me);
                threads.len() - 1
            })
        };
        self.shared.events.lock().expect(UNPOISONED).push(Event {
            job: job.clone(),
            provenance,
            started,
            time,
            thread,
        });
    }
}
