//! A card: what the files of one name look like, where they are, and what they measure.

use maud::{Markup, html};
use serde_json::Value;

use super::super::exhibit::{Card, Figure, Sort};
use super::uri::{Room, address};

/// A card of a spec.
pub fn shown(card: &Card, spec: &str, room: &mut Room) -> Markup {
    let name = card.name.rsplit('/').next().unwrap_or(&card.name);
    html! {
        article data-card={ (spec) " " (card.name) } data-stale[card.is_stale] {
            div.figures {
                @for (number, figure) in card.figures.iter().enumerate() {
                    div.figure data-figure=(figure.path) hidden[number > 0] { (shown_figure(name, figure, room)) }
                }
                @if card.figures.is_empty() { div.figure.none { "no picture" } }
                @if card.figures.len() > 1 {
                    div.tabs hidden {
                        @for figure in &card.figures { button type="button" data-show=(figure.path) { (ending(&figure.path)) } }
                    }
                }
            }
            h3 {
                (name)
                @if card.is_stale { " " span.tag.old { "of an earlier build" } }
            }
            ul.files {
                @for file in &card.files {
                    li data-artifact=(file.path) {
                        @if room.is_live() {
                            a href=(address(&file.path, &file.blake3, None)) download=(file.path.rsplit('/').next().unwrap_or(&file.path)) { (ending(&file.path)) }
                        } @else { (ending(&file.path)) }
                        " " span.quiet { (size(file.bytes.len())) }
                        @if let Some(recipe) = &file.recipe { " " code.quiet.recipe data-recipe=(recipe) title="recipe" { (recipe) } }
                    }
                }
            }
            @if let Some(Value::Object(measures)) = &card.measures {
                details.measures data-keep={ "measures " (card.name) } {
                    summary { "measures" }
                    table {
                        @for (measure, value) in measures {
                            tr { th { (measure.replace('_', " ")) } td { (shown_value(value)) } }
                        }
                    }
                }
            }
        }
    }
}

fn shown_figure(name: &str, figure: &Figure, room: &mut Room) -> Markup {
    if figure.sort == Sort::Glb {
        return solids(name, figure, room);
    }
    let sort = figure.sort.name();
    html! {
        @match room.figure(figure) {
            Some(uri) => img alt=(name) loading="lazy" draggable="false" data-viewer=(sort) src=(uri);
            None => p.none { "too large for this page" }
        }
    }
}

/// Solids: a canvas for the script, and a picture for those who run none.
fn solids(name: &str, figure: &Figure, room: &mut Room) -> Markup {
    if room.is_live() {
        let uri = room.figure(figure);
        return html! { canvas data-viewer="glb" data-src=[uri] role="img" aria-label=(name) {} };
    }
    let still = figure.still.as_deref().and_then(|png| room.still(png));
    let solids = room.solids(&figure.bytes);
    html! {
        @match still {
            Some(uri) => img.still alt=(name) loading="lazy" draggable="false" data-viewer="png" src=(uri);
            None => p.none { "too large for this page" }
        }
        @if let Some(solids) = solids {
            canvas data-viewer="glb" role="img" aria-label=(name) hidden {}
            template data-solids { (solids) }
        }
    }
}

fn ending(path: &str) -> &str {
    path.rsplit_once('.').map_or(path, |(_, ending)| ending)
}

fn size(bytes: usize) -> String {
    match bytes {
        0..1_000 => format!("{bytes} bytes"),
        1_000..1_000_000 => format!("{:.1} kB", bytes as f64 / 1e3),
        _ => format!("{:.1} MB", bytes as f64 / 1e6),
    }
}

/// A measure for people: numbers in at most four decimals, lists in a line.
fn shown_value(value: &Value) -> String {
    match value {
        Value::Number(number) => match number.as_f64() {
            Some(float) if number.is_f64() => fretwork_language::value::shown_number(float),
            _ => number.to_string(),
        },
        Value::String(text) => text.clone(),
        Value::Array(items) => items.iter().map(shown_value).collect::<Vec<_>>().join(", "),
        Value::Object(entries) => {
            let entry = |(key, value): (&String, &Value)| format!("{key} {}", shown_value(value));
            entries.iter().map(entry).collect::<Vec<_>>().join(", ")
        }
        other => other.to_string(),
    }
}
