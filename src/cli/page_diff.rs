//! The changes since a revision on the page of a report: what differs, how much, and the states laid over one another.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, html};

use super::diff::change::{Change, Status};
use super::diff::comparison::Comparison;
use super::diff::text::{arrow, counts, in_order, in_words};
use fretwork_engine::difference::picture;

/// The most bytes of one picture, and of all of them.
const LARGEST: usize = 2 << 20;
const ALL: usize = 4 << 20;

/// What differs, with pictures.
pub struct Changes {
    /// How many artifacts have which status.
    summary: String,
    cards: Vec<Card>,
}

struct Card {
    path: String,
    status: Status,
    amounts: Option<String>,
    measures: Vec<(String, String)>,
    /// The address and the size of the file.
    picture: Option<(String, usize)>,
}

impl Changes {
    /// Those of a comparison.
    pub fn of(comparison: &Comparison) -> Changes {
        let mut room = ALL;
        let shown = in_order(comparison).filter(|change| change.status != Status::Redrawn);
        Changes {
            summary: counts(comparison),
            cards: shown.map(|change| card(change, &mut room)).collect(),
        }
    }

    /// How many bytes the pictures have.
    pub fn size(&self) -> usize {
        let pictures = self.cards.iter().filter_map(|card| card.picture.as_ref());
        pictures.map(|(_, bytes)| bytes).sum()
    }

    /// The section of the page.
    pub fn section(&self) -> Markup {
        html! {
            section #changes {
                h2 { "Changes" }
                p { (self.summary) }
                div.cards { @for card in &self.cards { (shown_card(card)) } }
            }
        }
    }
}

fn card(change: &Change, room: &mut usize) -> Card {
    let files = change.overlay.as_ref().map(picture::files);
    let files = files.and_then(Result::ok).into_iter().flatten();
    let pictures = files.filter_map(|(extension, bytes)| match extension {
        "svg" => Some(("image/svg+xml", bytes)),
        "png" => Some(("image/png", bytes)),
        _ => None,
    });
    let mut fitting = pictures.filter(|(_, bytes)| bytes.len() <= LARGEST.min(*room));
    let picture = fitting.next().map(|(media, bytes)| {
        let address = format!("data:{media};base64,{}", STANDARD.encode(&bytes));
        (address, bytes.len())
    });
    *room -= picture.as_ref().map_or(0, |(_, bytes)| *bytes);
    let measures = change.measures.iter();
    Card {
        path: change.path.clone(),
        status: change.status,
        amounts: change.geometry.as_ref().map(in_words),
        measures: measures
            .map(|(name, pair)| (name.clone(), arrow(pair)))
            .collect(),
        picture,
    }
}

fn shown_card(card: &Card) -> Markup {
    html! {
        article data-diff=(card.path) data-status=(card.status.word()) {
            @match &card.picture {
                Some((address, _)) => {
                    div.picture { img alt=(card.path) loading="lazy" src=(address); }
                }
                None => div.picture.none { "no picture" },
            }
            h4 { (card.path) " " span.tag { (card.status.word()) } }
            @if let Some(amounts) = &card.amounts { p { (amounts) } }
            @if !card.measures.is_empty() {
                details open[card.status == Status::Changed] {
                    summary { "measures" }
                    table {
                        @for (name, pair) in &card.measures { tr { th { (name) } td { (pair) } } }
                    }
                }
            }
        }
    }
}
