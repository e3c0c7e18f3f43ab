//! One build as it is served: its page and its state, written when somebody first asks for them, and the bytes of its
//! artifacts by their paths.

use std::sync::{Arc, OnceLock};

use serde_json::json;

use super::super::exhibit::{Exhibit, Finding};
use super::super::page::{self, Live, Page};
use super::state;
use super::wish::{Wishes, command_line};
use fretwork_diagnostic::{Code, Diagnostic};
use fretwork_language::kinds::artifacts::Format;
use fretwork_serve::Piece;

/// A build that is shown.
#[derive(Debug)]
pub struct Shown {
    /// Its number, 0 before the first.
    pub build: u64,
    /// Whether nothing is wrong.
    pub is_ok: bool,
    /// How long it took.
    pub seconds: f64,
    /// What is shown of it.
    pub exhibit: Exhibit,
    /// The values that are tried out.
    pub wishes: Wishes,
    /// The values of the command line, which hold for all specs that have their names.
    pub sets: Vec<(String, String)>,
    page: OnceLock<Arc<[u8]>>,
    state: OnceLock<Arc<[u8]>>,
}

impl Default for Shown {
    fn default() -> Shown {
        Shown::new(0, 0.0, Exhibit::default())
    }
}

impl Shown {
    /// A build without values that are tried out.
    pub fn new(build: u64, seconds: f64, exhibit: Exhibit) -> Shown {
        Shown {
            build,
            is_ok: exhibit.is_ok(),
            seconds,
            exhibit,
            wishes: Wishes::default(),
            sets: Vec::new(),
            page: OnceLock::new(),
            state: OnceLock::new(),
        }
    }

    /// The build with values that are tried out, and those of the command line.
    pub fn trying(mut self, wishes: Wishes, sets: Vec<(String, String)>) -> Shown {
        (self.wishes, self.sets) = (wishes, sets);
        self
    }

    /// What its listeners are told.
    pub fn event(&self) -> String {
        json!({ "build": self.build, "ok": self.is_ok }).to_string()
    }

    /// Its page.
    pub fn page(&self) -> Arc<[u8]> {
        let page = || {
            let live = Live {
                build: self.build,
                is_ok: self.is_ok,
                seconds: self.seconds,
                trials: self.trials(),
            };
            let page = Page {
                changes: None,
                exhibit: &self.exhibit,
                live: Some(live),
                is_stable: false,
            };
            page::render(&page).into_bytes().into()
        };
        self.page.get_or_init(page).clone()
    }

    /// Its state as JSON.
    pub fn state(&self) -> Arc<[u8]> {
        let state = || {
            let state = state::state(&self.exhibit, self.build, self.seconds);
            state.to_string().into_bytes().into()
        };
        self.state.get_or_init(state).clone()
    }

    /// The specs of which values are tried out, and the command lines that would do the same.
    fn trials(&self) -> Vec<(String, String)> {
        let line = |spec: &String| {
            let own = self.wishes.of(spec);
            let given = self.exhibit.specs.iter().find(|one| one.path == *spec);
            let is_kept = |name: &str| {
                own.iter().all(|(known, _)| *known != name)
                    && given.is_some_and(|spec| spec.settable.has(name))
            };
            let sets = self.sets.iter().filter(|(name, _)| is_kept(name));
            let sets = sets.map(|(name, value)| (&**name, &**value));
            let all: Vec<(&str, &str)> = sets.chain(own.iter().copied()).collect();
            (spec.clone(), command_line(spec, &all))
        };
        self.wishes.all().keys().map(line).collect()
    }

    /// The bytes of an artifact, or of a form of it.
    pub fn file(&self, path: &str, digest: Option<&str>, view: Option<&str>) -> Option<Piece> {
        let (card, file) = self.exhibit.files().find(|(_, file)| file.path == path)?;
        let (ending, bytes, blake3) = match view {
            None => {
                let ending = Format::EXTENSIONS[file.format as usize];
                (ending, &file.bytes, &file.blake3)
            }
            Some(view) => {
                let mut views = card.figures.iter().filter(|one| one.is_view);
                let figure = views.find(|one| one.path == path && one.sort.name() == view)?;
                (figure.sort.name(), &figure.bytes, &figure.blake3)
            }
        };
        digest.is_none_or(|digest| digest == blake3).then(|| Piece {
            media: media(ending),
            bytes: bytes.clone(),
        })
    }

    /// Why the values of a spec would be refused.
    pub fn refusals(&self, spec: &str, wishes: &Wishes) -> Vec<Finding> {
        let Some(known) = self.exhibit.specs.iter().find(|one| one.path == spec) else {
            let error = Diagnostic::error(format!("there is no spec `{spec}` on this page"));
            let paths = self.exhibit.specs.iter().map(|one| &*one.path);
            let error = error.about(Code::Reference).suggest(spec, paths);
            return vec![Finding::of(&error, &fretwork_engine::Settable::default())];
        };
        let refused = known.settable.refusals(&wishes.settings(spec));
        let finding = |one| Finding::of(one, &known.settable);
        refused.iter().map(finding).collect()
    }
}

/// The media type of files with an ending.
fn media(ending: &str) -> &'static str {
    match ending {
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "glb" => "model/gltf-binary",
        "stl" => "model/stl",
        "3mf" => "model/3mf",
        "dxf" => "image/vnd.dxf",
        "json" => "application/json",
        "geojson" => "application/geo+json",
        _ => "application/octet-stream",
    }
}
