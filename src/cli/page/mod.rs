//! The page of a build as HTML: specs with their pictures, parameters, files and measures, diagnostics with their source
//! lines, the graph's nodes. One function renders it for `report`, where all is in the file and no request leaves it, and for
//! `watch --serve`, where pictures are asked for and the script follows every build.

mod asset;
mod card;
mod content;
mod controls;
mod graph;
mod uri;

use maud::{Markup, html};

pub use asset::asset;
pub use content::{Live, Page};

use super::exhibit::{Finding, Spec};
use super::page_diff::Changes;
use super::terminal::counted;
use fretwork_diagnostic::Severity;
use uri::Room;

/// What every page begins with.
pub const HEAD: &str = "<!DOCTYPE html><html lang=\"en\" data-page=\"fretwork report\">";

/// The page.
pub fn render(page: &Page<'_>) -> String {
    let build = page.live.as_ref().map(|live| live.build.to_string());
    let mut room = Room::new(page.live.is_some());
    room.take(page.changes.as_ref().map_or(0, Changes::size));
    let content = html! {
        head {
            meta charset="utf-8";
            meta name="viewport" content="width=device-width, initial-scale=1";
            (asset::head(page.live.is_some()))
            title { (title(page)) }
        }
        body data-build=[build] {
            (header(page))
            (aside(page))
            main {
                section #findings data-part="findings" {
                    @if !page.exhibit.findings.is_empty() {
                        h2 { "Diagnostics" }
                        @for finding in &page.exhibit.findings { (shown_finding(finding)) }
                    }
                }
                @if let Some(changes) = &page.changes { (changes.section()) }
                @if page.exhibit.specs.iter().all(|spec| spec.cards.is_empty()) {
                    p.empty data-part="empty" { (empty(page)) }
                }
                @for spec in &page.exhibit.specs { (shown_spec(page, spec, &mut room)) }
            }
            (asset::tail(page.live.is_some()))
        }
    };
    format!("{HEAD}{}</html>\n", content.into_string())
}

fn title(page: &Page<'_>) -> String {
    let mark = match &page.live {
        Some(live) if !live.is_ok => "✗ ",
        _ => "",
    };
    let what = match &page.exhibit.specs[..] {
        [only] => name(&only.path),
        _ if page.live.is_some() => "fretwork",
        _ => "fretwork report",
    };
    format!("{mark}{what}")
}

/// A spec without its folder and ending.
fn name(path: &str) -> &str {
    let file = path.rsplit('/').next().unwrap_or(path);
    file.rsplit_once('.').map_or(file, |(stem, _)| stem)
}

fn count(page: &Page<'_>, severity: Severity) -> usize {
    let findings = page.exhibit.findings.iter();
    findings
        .filter(|finding| finding.place.severity == severity)
        .count()
}

fn header(page: &Page<'_>) -> Markup {
    let errors = count(page, Severity::Error);
    let warnings = count(page, Severity::Warning);
    let files = page.exhibit.files().count();
    html! {
        header {
            h1 { a href="#" { "fretwork" } }
            p.status data-part="status" data-ok=[page.live.as_ref().map(|live| live.is_ok.to_string())] {
                @if let Some(live) = &page.live {
                    @if live.build == 0 { span.pill.busy { "building" } }
                    @else {
                        span.pill.ok[live.is_ok].bad[!live.is_ok] { @if live.is_ok { "ok" } @else { "failed" } }
                        span.quiet { "build " (live.build) ", " (format!("{:.2} s", live.seconds)) }
                    }
                }
                span.quiet { (counted(files, "file")) }
                @if errors + warnings > 0 {
                    a href="#findings" data-jump="findings" {
                        @if errors > 0 { span.error { (counted(errors, "error")) } " " }
                        @if warnings > 0 { span.warning { (counted(warnings, "warning")) } }
                    }
                }
            }
            p.progress hidden data-progress {}
        }
    }
}

/// The list of specs, where there are several.
fn aside(page: &Page<'_>) -> Markup {
    let specs = &page.exhibit.specs;
    let folder = |path: &str| -> String {
        let path = path.strip_prefix("specs/").unwrap_or(path);
        path.rsplit_once('/')
            .map_or("", |(folder, _)| folder)
            .to_string()
    };
    let mut sorted: Vec<&Spec> = specs.iter().collect();
    sorted.sort_by_key(|spec| (folder(&spec.path), spec.path.clone()));
    let is_wrong = |spec: &Spec| {
        let mut wrong = page.exhibit.findings.iter().filter(|one| one.is_error());
        wrong.any(|one| one.place.file.as_deref() == Some(&*spec.path))
    };
    html! {
        aside data-part="specs" hidden[specs.len() < 2] {
            @if specs.len() > 8 { input.filter type="search" placeholder="find a spec" aria-label="find a spec" hidden data-filter; }
            nav {
                a href="#" data-goto="" { "all" span.quiet { (specs.len()) } }
                @for group in sorted.chunk_by(|a, b| folder(&a.path) == folder(&b.path)) {
                    @let folder = folder(&group[0].path);
                    @if !folder.is_empty() { h2 { (folder) } }
                    @for spec in group {
                        a.wrong[is_wrong(spec)] href={ "#" (spec.path) } data-goto=(spec.path) { (name(&spec.path)) }
                    }
                }
            }
        }
    }
}

fn empty(page: &Page<'_>) -> &'static str {
    match &page.live {
        Some(live) if live.build == 0 => "The first build is on its way.",
        _ => "There is nothing to see yet.",
    }
}

fn shown_finding(finding: &Finding) -> Markup {
    let place = &finding.place;
    let severity = match place.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    };
    html! {
        details.finding open[finding.is_error()] data-severity=(severity) data-diagnostic=(place.code) {
            summary {
                span class=(severity) { (severity) } " " span.tag { (place.code) } " " (place.message)
                @if let (Some(file), Some(line)) = (&place.file, place.line) { " " span.quiet { (file) ":" (line) } }
            }
            pre { (finding.text.trim_end()) }
        }
    }
}

fn shown_spec(page: &Page<'_>, spec: &Spec, room: &mut Room) -> Markup {
    let trial = page.live.iter().flat_map(|live| &live.trials);
    let trial = trial.filter(|(path, _)| *path == spec.path);
    let line = trial.map(|(_, line)| &**line).next();
    html! {
        section.spec #(spec.path) data-spec-section=(spec.path) {
            h2 { (name(&spec.path)) " " span.quiet { (spec.path) } }
            div.bench {
                div.cards {
                    @for one in &spec.cards { (card::shown(one, &spec.path, room)) }
                }
                @if !spec.params.is_empty() { (controls::shown(spec, page.live.is_some(), line)) }
            }
            (graph::shown(page, &spec.path))
        }
    }
}
