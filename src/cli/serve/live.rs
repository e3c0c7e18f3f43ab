//! The thread that builds: it waits for files to change and for values to be wanted, builds with the newest of both, and
//! publishes what came of it. A build that is overtaken is given up.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::super::arguments::Watch;
use super::super::build;
use super::super::exhibit::{Exhibit, Scope, measures, stem};
use super::super::follow::{Follower, has_other_specs};
use super::super::outcome::Outcome;
use super::super::session::{Session, settings};
use super::super::terminal::Failure;
use super::board::Board;
use super::feed::Feed;
use super::shown::Shown;
use super::wish::Wishes;
use fretwork_diagnostic::{Code, Diagnostic};
use fretwork_engine::{Artifact, Report, Settings, Versions};

/// Editors write a file in several steps; a build waits until nothing has happened for this long.
const QUIET: Duration = Duration::from_millis(25);
/// So often it is looked whether the folders are still the same.
const LOOK: Duration = Duration::from_secs(1);
/// After so many builds with values that were tried out, or so many bytes of results, the compiler forgets them: nobody
/// comes back to most of them, and those who do find them in the cache.
const TRIALS: usize = 200;
const TRIED: u64 = 512 << 20;

/// Why the thread wakes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wake {
    /// Something has happened to a file.
    File,
    /// Values are wanted.
    Wish,
}

/// The builds of a page.
pub struct Live<'a> {
    session: Session,
    arguments: &'a Watch,
    versions: Versions,
    board: Arc<Board>,
    follower: Option<Follower>,
    /// The files whose change makes a build useless.
    known: Arc<Mutex<BTreeSet<PathBuf>>>,
    trials: usize,
    tried: u64,
}

impl<'a> Live<'a> {
    /// Builds of a session.
    pub fn new(
        session: Session,
        arguments: &'a Watch,
        versions: Versions,
        board: Arc<Board>,
    ) -> Live<'a> {
        Live {
            session,
            arguments,
            versions,
            board,
            follower: None,
            known: Arc::default(),
            trials: 0,
            tried: 0,
        }
    }

    /// Builds until the process is ended.
    ///
    /// # Errors
    /// When the project cannot be watched.
    pub fn run(mut self, sender: Sender<Wake>, wakes: &Receiver<Wake>) -> Result<(), Failure> {
        let (known, board) = (self.known.clone(), self.board.clone());
        self.follower = Some(Follower::new(move |paths| {
            let known = known.lock().unwrap_or_else(PoisonError::into_inner);
            if paths.iter().any(|path| known.contains(path)) {
                board.overtake();
            }
            // The receiver lives as long as the process.
            let _ = sender.send(Wake::File);
        })?);
        loop {
            let built = self.build();
            self.follow()?;
            if let Some(report) = &built {
                self.measure(report);
            }
            self.wait(wakes, built.is_none())?;
        }
    }

    /// Builds and publishes; none when it was overtaken.
    fn build(&mut self) -> Option<Report> {
        self.forget_trials();
        let started = Instant::now();
        let session = &self.session;
        let (wishes, number) = self.board.begin(session.compiler.stop());
        let wishes = wishes.known(|spec| session.compiler.settable(spec));
        let feed = Feed::new(&self.board);
        let built = session.compiler.unless_stopped(|_| {
            let own = wishes.all();
            let report = build::evaluate(session, &self.arguments.build, &own, &feed);
            let exhibit = Exhibit::of(session, &report, &self.settings(&wishes), Scope::Live);
            (report, exhibit)
        });
        drop(feed);
        self.board.end();
        let (report, mut exhibit) = built?;
        let report = if wishes.is_empty() {
            self.write(report, started)
        } else {
            report
        };
        exhibit.tell(session, &report.diagnostics);
        if !wishes.is_empty() {
            self.trials += 1;
            self.tried += session.compiler.kept();
        }
        self.publish(self.shown(number, started, exhibit, wishes));
        Some(report)
    }

    /// The settings of each spec, where `wishes` are wanted.
    fn settings(&self, wishes: &Wishes) -> impl Fn(&str) -> Settings {
        let given = settings(&self.arguments.build.evaluation.sets);
        let session = &self.session;
        move |spec| {
            let settable = session.compiler.settable(spec);
            let given = given.only(|name| settable.has(name));
            given.and(&wishes.settings(spec))
        }
    }

    /// Brings the files up to date and tells the terminal.
    fn write(&self, report: Report, started: Instant) -> Report {
        let mut more = Vec::new();
        let arguments = &self.arguments.build;
        if self.session.specs.is_empty() {
            let root = self.session.world.root();
            let folder = root.join("specs");
            let message = format!("there is no spec below {}", folder.display());
            more.push(Diagnostic::error(message).about(Code::File));
        }
        let outcome = match build::settle(&self.session, arguments, report.clone()) {
            Ok(outcome) => outcome,
            Err(failure) => {
                more.extend(told(failure));
                Outcome {
                    report,
                    written: Vec::new(),
                }
            }
        };
        let mut outcome = outcome;
        outcome.report.diagnostics.extend(more);
        // A terminal that is gone is no reason to end.
        let _ = build::print(&self.session, arguments, &outcome, started);
        outcome.report
    }

    fn shown(&self, number: u64, started: Instant, mut exhibit: Exhibit, wishes: Wishes) -> Shown {
        let former = self.board.shown();
        if !exhibit.is_ok() {
            exhibit.keep(&former.exhibit);
        }
        exhibit.remember(&former.exhibit);
        let seconds = (started.elapsed().as_secs_f64() * 1e3).round() / 1e3;
        let sets = self.arguments.build.evaluation.sets.clone();
        Shown::new(number, seconds, exhibit).trying(wishes, sets)
    }

    /// Publishes a build. After one that succeeded, values of parameters that are gone are forgotten.
    fn publish(&self, shown: Shown) {
        let is_ok = shown.is_ok;
        let session = &self.session;
        self.board.publish(shown, |wishes| match is_ok {
            true => wishes.known(|spec| session.compiler.settable(spec)),
            false => wishes.clone(),
        });
    }

    /// Measures what the last build has made and publishes it once more, unless something else is wanted meanwhile.
    fn measure(&self, report: &Report) {
        let shown = self.board.shown();
        if !self.board.resume(self.session.compiler.stop()) {
            return;
        }
        let mut exhibit = shown.exhibit.clone();
        let measured = self.session.compiler.unless_stopped(|_| {
            let mut is_new = false;
            let mut cards: BTreeMap<(&str, &str), Vec<&Artifact>> = BTreeMap::new();
            for artifact in &report.artifacts {
                let key = (&*artifact.spec, stem(&artifact.path));
                cards.entry(key).or_default().push(artifact);
            }
            for spec in &mut exhibit.specs {
                for card in spec.cards.iter_mut().filter(|c| c.measures.is_none()) {
                    if let Some(artifacts) = cards.get(&(&*spec.path, &*card.name)) {
                        card.measures = measures(&self.session, artifacts);
                        is_new |= card.measures.is_some();
                    }
                }
            }
            is_new
        });
        self.board.end();
        if measured == Some(true) {
            let measured = Shown::new(shown.build, shown.seconds, exhibit);
            self.publish(measured.trying(shown.wishes.clone(), shown.sets.clone()));
        }
    }

    /// Follows all files that were read.
    fn follow(&mut self) -> Result<bool, Failure> {
        let root = self.session.world.root();
        let files = self.session.compiler.known_files();
        let files = files.iter().map(|file| root.join(&**file));
        *self.known.lock().unwrap_or_else(PoisonError::into_inner) = files.collect();
        match &mut self.follower {
            Some(follower) => follower.follow(&self.session, &self.arguments.build),
            None => Ok(false),
        }
    }

    /// Waits until there is something to build, which is so where the last build was overtaken.
    fn wait(&mut self, wakes: &Receiver<Wake>, is_due: bool) -> Result<(), Failure> {
        if is_due {
            settle(wakes);
        }
        // Looked at first: a file may have changed before its folder was followed.
        while !(self.has_news() || is_due) {
            self.sleep(wakes)?;
        }
        Ok(())
    }

    /// Whether files or specs are others, or values are wanted.
    fn has_news(&mut self) -> bool {
        let has_changed = !self.session.compiler.refresh().is_empty();
        // A folder that cannot be listed holds the specs that it held.
        let is_other = has_other_specs(&mut self.session, &self.arguments.build);
        has_changed || is_other.unwrap_or(false) || self.board.is_wanted()
    }

    /// Waits for something to happen.
    fn sleep(&mut self, wakes: &Receiver<Wake>) -> Result<(), Failure> {
        loop {
            match wakes.recv_timeout(LOOK) {
                Ok(Wake::Wish) => return Ok(()),
                Ok(Wake::File) => {
                    settle(wakes);
                    return Ok(());
                }
                Err(RecvTimeoutError::Timeout) => {
                    if self.follow()? {
                        return Ok(());
                    }
                }
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(Failure::usage("the file watcher has stopped"));
                }
            }
        }
    }

    /// Forgets results of values that were tried out, once there are many.
    fn forget_trials(&mut self) {
        if self.trials < TRIALS && self.tried < TRIED {
            return;
        }
        // Where the project cannot be opened now, the next build says why.
        if let Ok(session) = build::open(&self.arguments.build, self.versions) {
            self.session = session;
            (self.trials, self.tried) = (0, 0);
        }
    }
}

/// Waits until no file changes any more; values that are wanted are not kept waiting.
fn settle(wakes: &Receiver<Wake>) {
    while let Ok(Wake::File) = wakes.recv_timeout(QUIET) {}
}

/// What a failure says, for the page.
fn told(failure: Failure) -> Option<Diagnostic> {
    match failure {
        Failure::Build | Failure::Differs => None,
        Failure::Usage(message) => Some(Diagnostic::error(message).about(Code::Output)),
    }
}
