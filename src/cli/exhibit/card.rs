//! Files of one name: what they look like, how large they are, and what they measure.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde_json::Value;

use super::super::session::Session;
use fretwork_engine::{Artifact, View};
use fretwork_language::kinds::artifacts::Format;

/// The files of one name.
#[derive(Clone, Debug)]
pub struct Card {
    /// Their path without its ending.
    pub name: String,
    /// The files.
    pub files: Vec<File>,
    /// What they look like, the best first.
    pub figures: Vec<Figure>,
    /// Their measures, if they are known.
    pub measures: Option<Value>,
    /// Whether the last build could not make them anew.
    pub is_stale: bool,
}

/// An artifact.
#[derive(Clone, Debug)]
pub struct File {
    /// Its path below the output folder.
    pub path: String,
    /// Its format.
    pub format: Format,
    /// Its bytes.
    pub bytes: Arc<[u8]>,
    /// Their BLAKE3 digest.
    pub blake3: String,
    /// The recipe that it names as its origin, if it names one.
    pub recipe: Option<Arc<str>>,
}

/// How a figure is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sort {
    /// As a picture that stays sharp.
    Svg,
    /// As a picture of pixels.
    Png,
    /// As solids that turn.
    Glb,
}

/// What an artifact looks like.
#[derive(Clone, Debug)]
pub struct Figure {
    /// The artifact.
    pub path: String,
    /// How it is shown.
    pub sort: Sort,
    /// Whether these are not the bytes of the artifact itself but of a form of it.
    pub is_view: bool,
    /// What is shown.
    pub bytes: Arc<[u8]>,
    /// Their BLAKE3 digest.
    pub blake3: String,
    /// A picture of solids, a PNG, where it was asked for.
    pub still: Option<Arc<[u8]>>,
}

/// What is wanted of figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// What a page shows that is served.
    Live,
    /// And pictures of solids, for those who run no script.
    Still,
}

impl Sort {
    /// The ending of its files.
    pub fn name(self) -> &'static str {
        match self {
            Sort::Svg => "svg",
            Sort::Png => "png",
            Sort::Glb => "glb",
        }
    }
}

impl Card {
    /// Whether it has the same files with the same bytes.
    pub fn is_same(&self, other: &Card) -> bool {
        let key = |card: &Card| -> Vec<(String, String)> {
            let files = card.files.iter();
            files
                .map(|file| (file.path.clone(), file.blake3.clone()))
                .collect()
        };
        self.name == other.name && key(self) == key(other)
    }
}

/// The cards of all specs, by spec.
pub fn cards(
    session: &Session,
    artifacts: &[Artifact],
    scope: Scope,
) -> BTreeMap<String, Vec<Card>> {
    let mut groups: BTreeMap<(&str, &str), Vec<&Artifact>> = BTreeMap::new();
    for artifact in artifacts {
        let key = (artifact.spec.as_str(), stem(&artifact.path));
        groups.entry(key).or_default().push(artifact);
    }
    let mut cards: BTreeMap<String, Vec<Card>> = BTreeMap::new();
    for ((spec, stem), artifacts) in groups {
        let card = card(session, stem, &artifacts, scope);
        cards.entry(spec.to_string()).or_default().push(card);
    }
    cards
}

/// Adds what stands in `former` and not in `cards`, and is not made anew.
pub fn keep(cards: &mut Vec<Card>, former: &[Card]) {
    for old in former {
        let is_whole = |card: &&mut Card| card.name == old.name;
        match cards.iter_mut().find(is_whole) {
            None => cards.push(Card {
                is_stale: true,
                ..old.clone()
            }),
            Some(card) => {
                let is_missing = |file: &&File| card.files.iter().all(|f| f.path != file.path);
                let missing: Vec<File> = old.files.iter().filter(is_missing).cloned().collect();
                card.is_stale |= !missing.is_empty();
                let is_shown = |f: &&Figure| missing.iter().any(|file| file.path == f.path);
                card.figures
                    .extend(old.figures.iter().filter(is_shown).cloned());
                card.files.extend(missing);
            }
        }
    }
    cards.sort_by(|a, b| a.name.cmp(&b.name));
}

/// The measures of a card whose artifacts are these.
pub fn measures(session: &Session, artifacts: &[&Artifact]) -> Option<Value> {
    let view = artifacts
        .iter()
        .find_map(|artifact| session.compiler.view(artifact, Format::Json))?;
    without_origin(&view.bytes)
}

/// The measures in a file, without its origin.
fn without_origin(bytes: &[u8]) -> Option<Value> {
    let mut measures: Value = serde_json::from_slice(bytes).ok()?;
    if let Some(measures) = measures.as_object_mut() {
        measures.remove("origin");
    }
    Some(measures)
}

/// A path without its ending.
pub fn stem(path: &str) -> &str {
    path.rsplit_once('.').map_or(path, |(stem, _)| stem)
}

fn card(session: &Session, stem: &str, artifacts: &[&Artifact], scope: Scope) -> Card {
    let files: Vec<(File, &Artifact)> = artifacts
        .iter()
        .filter_map(|artifact| Some((file(session, artifact)?, *artifact)))
        .collect();
    let of = |format| files.iter().find(move |(file, _)| file.format == format);
    let own = |(file, _): &(File, &Artifact), sort| Figure {
        path: file.path.clone(),
        sort,
        is_view: false,
        bytes: file.bytes.clone(),
        blake3: file.blake3.clone(),
        still: None,
    };
    let mut figures = Vec::new();
    let solid = [Format::Glb, Format::ThreeMf, Format::Stl].into_iter();
    if let Some(one) = solid.filter_map(of).next() {
        let figure = match one.0.format {
            Format::Glb => Some(own(one, Sort::Glb)),
            _ => seen(session, one.1, Sort::Glb),
        };
        let still = (scope == Scope::Still).then(|| session.compiler.view(one.1, Format::Png));
        let still = still.flatten().map(|view| view.bytes);
        figures.extend(figure.map(|figure| Figure { still, ..figure }));
    }
    figures.extend(of(Format::Svg).map(|one| own(one, Sort::Svg)));
    figures.extend(of(Format::Png).map(|one| own(one, Sort::Png)));
    if figures.is_empty() {
        let drawing = [Format::Dxf, Format::GeoJson].into_iter().find_map(of);
        figures.extend(drawing.and_then(|one| seen(session, one.1, Sort::Svg)));
    }
    let json = of(Format::Json).and_then(|(file, _)| without_origin(&file.bytes));
    Card {
        name: stem.to_string(),
        files: files.into_iter().map(|(file, _)| file).collect(),
        figures,
        measures: json,
        is_stale: false,
    }
}

fn file(session: &Session, artifact: &Artifact) -> Option<File> {
    Some(File {
        path: artifact.path.clone(),
        format: Format::of(&artifact.path)?,
        bytes: session.compiler.bytes(artifact).ok()?,
        blake3: artifact.digest.hex(),
        recipe: session.compiler.recipe(artifact),
    })
}

/// A form of an artifact that is not its own.
fn seen(session: &Session, artifact: &Artifact, sort: Sort) -> Option<Figure> {
    let format = match sort {
        Sort::Svg => Format::Svg,
        Sort::Png => Format::Png,
        Sort::Glb => Format::Glb,
    };
    let View { digest, bytes } = session.compiler.view(artifact, format)?;
    Some(Figure {
        path: artifact.path.clone(),
        sort,
        is_view: true,
        bytes,
        blake3: digest.hex(),
        still: None,
    })
}
