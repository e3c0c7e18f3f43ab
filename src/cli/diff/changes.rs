//! The artifacts of two states compared with one another, each once.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde_json::Map;

use super::change::{Change, Status};
use super::measures;
use super::sides::{Side, Sides, State};
use crate::session::Session;
use fretwork_engine::difference::{Difference, Shape, compare};
use fretwork_engine::{Artifact, Compared};
use fretwork_language::kinds::artifacts::Format;

/// What is known of an artifact of one state.
#[derive(Default)]
struct Known {
    compared: Compared,
    /// The bytes without their origin, of what has no geometry to compare.
    plain: Option<Arc<[u8]>>,
}

fn known(session: &Session, artifact: &Artifact) -> Known {
    let compared = session.compiler.compared(artifact);
    let format = Format::of(&artifact.path).filter(|_| compared.shape.is_none());
    Known {
        plain: format
            .and_then(|format| session.compiler.view(artifact, format))
            .map(|view| view.bytes),
        compared,
    }
}

/// What has become of each artifact of two states, by their paths.
pub fn changes(sides: &mut Sides<'_>, before: &State, after: &State) -> Vec<Change> {
    let details = details(sides, before, after);
    let mut earlier = Earlier::default();
    let paths: BTreeMap<&String, &String> = before.wanted.iter().chain(&after.wanted).collect();
    let change = |(path, spec): (&String, &String)| {
        let mut change = Change {
            path: path.clone(),
            spec: spec.clone(),
            status: Status::Failed,
            measures: BTreeMap::new(),
            geometry: None,
            pictures: Vec::new(),
            overlay: None,
        };
        if has_failed(before, path, spec) || has_failed(after, path, spec) {
            return change;
        }
        if !differs(before, after, path) {
            change.status = Status::Same;
            return change;
        }
        let of = |side| details.get(&(path.as_str(), side));
        complete(
            &mut change,
            (of(Side::Before), of(Side::After)),
            &mut earlier,
        );
        change
    };
    paths.into_iter().map(change).collect()
}

/// Whether an artifact that a state has, or may have, was not built.
fn has_failed(state: &State, path: &str, spec: &str) -> bool {
    let is_expected = state.wanted.contains_key(path) || state.broken.contains(spec);
    is_expected && !state.artifacts.contains_key(path)
}

fn differs(before: &State, after: &State, path: &str) -> bool {
    let [old, new] = [before, after].map(|state| state.artifacts.get(path).map(|one| one.digest));
    old != new
}

/// What the artifacts that differ are compared by, those first of the state that is read now.
fn details<'a>(
    sides: &mut Sides<'_>,
    before: &'a State,
    after: &'a State,
) -> BTreeMap<(&'a str, Side), Known> {
    let mut details = BTreeMap::new();
    let order = match sides.now() {
        Side::Before => [Side::Before, Side::After],
        Side::After => [Side::After, Side::Before],
    };
    for side in order {
        let state = if side == Side::Before { before } else { after };
        let all = state.artifacts.values();
        for artifact in all.filter(|one| differs(before, after, &one.path)) {
            sides.turn(side);
            let known = known(&sides.session, artifact);
            details.insert((artifact.path.as_str(), side), known);
        }
    }
    details
}

/// What was compared before: one object is often shown in several formats.
#[derive(Default)]
struct Earlier(Vec<(Option<Shape>, Option<Shape>, Difference)>);

impl Earlier {
    fn of(&mut self, old: Option<Shape>, new: Option<Shape>) -> Difference {
        let known = self.0.iter().find(|(a, b, _)| (a, b) == (&old, &new));
        if let Some((_, _, difference)) = known {
            return difference.clone();
        }
        let difference = compare(old.as_ref(), new.as_ref());
        self.0.push((old, new, difference.clone()));
        difference
    }
}

/// Fills in what two states of an artifact differ in.
fn complete(
    change: &mut Change,
    (before, after): (Option<&Known>, Option<&Known>),
    earlier: &mut Earlier,
) {
    let shape = |known: Option<&Known>| -> Option<Shape> { known?.compared.shape.clone() };
    let (old, new) = (shape(before), shape(after));
    let found = earlier.of(old, new);
    let plain = |known: Option<&Known>| known.and_then(|known| known.plain.clone());
    let is_plain_same = plain(before).is_some() && plain(before) == plain(after);
    change.status = match (before, after) {
        (None, _) => Status::Added,
        (_, None) => Status::Removed,
        _ if found.is_same || is_plain_same => Status::Redrawn,
        _ => Status::Changed,
    };
    change.geometry = found.amounts;
    change.overlay = found.overlay.filter(|_| change.status.differs());
    let none = Map::new();
    let [old, new] =
        [before, after].map(|known| known.map_or(&none, |known| &known.compared.measures));
    change.measures = measures::changed(old, new);
}
