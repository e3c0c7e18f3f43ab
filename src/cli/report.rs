//! `fretwork report`: one page about the specs, which needs nothing else to be read. What it looks like is in
//! `page`.

use std::collections::BTreeMap;

use serde_json::Value;

use super::arguments::Report as Arguments;
use super::diff::comparison::{Comparison, Wanted};
use super::own_file::OwnFile;
use super::page::{self, Card, Finding, Page, Picture};
use super::page_diff::Changes;
use super::placed::placed;
use super::progress::Bar;
use super::session::{CacheAt, Session, settings};
use super::terminal::{self, Failure};
use fretwork_diagnostic::{Diagnostic, render};
use fretwork_engine::{Artifact, Report, Request, Versions, threads};
use fretwork_language::kinds::artifacts::Format;

/// The most bytes of one picture, and of all on the page: as text they take a third more.
const LARGEST: usize = 3 << 20;
const ALL: usize = 17 << 20;

/// Evaluates the specs and writes the page.
pub fn run(arguments: &Arguments, versions: Versions) -> Result<(), Failure> {
    let evaluation = &arguments.evaluation;
    let cache = if evaluation.no_cache {
        CacheAt::Nowhere
    } else {
        CacheAt::Folder(evaluation.cache_dir.as_deref(), versions)
    };
    let session = Session::open(&arguments.specs, cache)?.with_budget(evaluation.budget);
    let shown = arguments
        .out
        .clone()
        .unwrap_or_else(|| "out/report.html".into());
    let path = match &arguments.out {
        Some(path) => path.clone(),
        None => session.world.root().join(&shown),
    };
    let file = OwnFile::at(session.world.root(), &path, page::HEAD, "report")?;
    let comparison = against(arguments, versions)?;
    let bar = Bar::new();
    let request = Request {
        specs: session.specs.clone(),
        settings: settings(&evaluation.sets),
        only: Vec::new(),
        windows: Vec::new(),
        threads: threads(evaluation.jobs.map(usize::from)),
        progress: &bar,
    };
    let report = session.compiler.build(&request);
    bar.finish();
    let text = page::render(&page(
        &session,
        &report,
        comparison.as_ref().map(Changes::of),
        arguments.stable,
    ));
    file.write(&text)?;
    session.settle();
    session.print(&report.diagnostics);
    terminal::note(&format!("wrote {} ({} bytes)", shown.display(), text.len()));
    // What is wrong with the work tree has been printed.
    let before = comparison.map(|comparison| comparison.told[0].clone());
    let (text, count) = before.unwrap_or_default();
    terminal::print_errors(&text, count);
    if count > 0 || report.diagnostics.iter().any(Diagnostic::is_error) {
        return Err(Failure::Build);
    }
    Ok(())
}

/// What differs from the revision that is named.
fn against(arguments: &Arguments, versions: Versions) -> Result<Option<Comparison>, Failure> {
    let Some(rev) = &arguments.against else {
        return Ok(None);
    };
    let wanted = Wanted {
        before: rev,
        after: None,
        specs: &arguments.specs,
        only: &[],
        evaluation: &arguments.evaluation,
    };
    Comparison::of(&wanted, versions).map(Some)
}

fn page<'a>(
    session: &Session,
    report: &'a Report,
    changes: Option<Changes>,
    is_stable: bool,
) -> Page<'a> {
    let mut groups: BTreeMap<(&str, &str), Vec<&Artifact>> = BTreeMap::new();
    for artifact in &report.artifacts {
        let key = (artifact.spec.as_str(), stem(&artifact.path));
        groups.entry(key).or_default().push(artifact);
    }
    let mut room = ALL - changes.as_ref().map_or(0, Changes::size);
    let groups = groups.into_iter();
    let cards =
        groups.map(|((spec, stem), artifacts)| card(session, spec, stem, &artifacts, &mut room));
    Page {
        cards: cards.collect(),
        changes,
        findings: findings(session, &report.diagnostics),
        nodes: &report.nodes,
        is_stable,
    }
}

fn stem(path: &str) -> &str {
    path.rsplit_once('.').map_or(path, |(stem, _)| stem)
}

/// What is shown of the files of one name: a picture, their sizes, and the measures if one holds them.
fn card(
    session: &Session,
    spec: &str,
    stem: &str,
    artifacts: &[&Artifact],
    room: &mut usize,
) -> Card {
    let mut card = Card {
        spec: spec.to_string(),
        name: stem.to_string(),
        picture: None,
        files: Vec::new(),
        recipes: BTreeMap::new(),
        measures: None,
    };
    let mut pictures = Vec::new();
    for artifact in artifacts {
        let Ok(bytes) = session.compiler.bytes(artifact) else {
            continue;
        };
        card.files.push((artifact.path.clone(), bytes.len()));
        let recipe = session.compiler.recipe(artifact);
        let recipe = recipe.map(|recipe| (artifact.path.clone(), recipe));
        card.recipes.extend(recipe);
        match Format::of(&artifact.path) {
            Some(Format::Png) => pictures.insert(0, Picture::png(&bytes)),
            Some(Format::Svg) => pictures.push(Picture::svg(&bytes)),
            Some(Format::Json) => card.measures = measures(&bytes),
            _ => {}
        }
    }
    if pictures.is_empty() {
        pictures.extend(artifacts.iter().find_map(|one| preview(session, one)));
    }
    let fitting = |picture: &Picture| picture.bytes.len() <= LARGEST.min(*room);
    card.picture = pictures.into_iter().find(fitting);
    *room -= card
        .picture
        .as_ref()
        .map_or(0, |picture| picture.bytes.len());
    card
}

/// The measures in a file, without its origin.
fn measures(bytes: &[u8]) -> Option<Value> {
    let mut measures: Value = serde_json::from_slice(bytes).ok()?;
    if let Some(measures) = measures.as_object_mut() {
        measures.remove("origin");
    }
    Some(measures)
}

/// A picture of an artifact that is none itself.
fn preview(session: &Session, artifact: &Artifact) -> Option<Picture> {
    match Format::of(&artifact.path)? {
        Format::Dxf | Format::GeoJson => {
            let bytes = session.compiler.shown_as(artifact, Format::Svg)?;
            Some(Picture::svg(&bytes))
        }
        Format::Stl | Format::ThreeMf | Format::Glb => {
            let bytes = session.compiler.shown_as(artifact, Format::Png)?;
            Some(Picture::png(&bytes))
        }
        _ => None,
    }
}

fn findings(session: &Session, diagnostics: &[Diagnostic]) -> Vec<Finding> {
    let sources = session.compiler.sources();
    let finding = |diagnostic: &Diagnostic| {
        let text = render::render(std::slice::from_ref(diagnostic), &sources, false);
        let place = placed(session, std::iter::once(diagnostic))
            .into_iter()
            .next();
        place.map(|place| Finding { place, text })
    };
    diagnostics.iter().filter_map(finding).collect()
}
