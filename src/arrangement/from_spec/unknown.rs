//! Labels that a spec asks for and that no cell has: most often a slip of the pen.

use std::collections::{BTreeSet, HashSet};
use std::sync::Arc;

use crate::from_spec::context::Context;
use fretwork_diagnostic::{Diagnostic, Span, nearest};
use fretwork_geometry::{Curves, Region};
use fretwork_language::kinds::arrangements::{Arrangement as Kind, Cells};
use fretwork_language::{Ref, wants};

/// Warnings about the labels under `where`, or of a `relabel`, that nothing in its input has on `region`,
/// each with the nearest label that there is. Cells that fall short of a label by chance are among
/// them, which is why this is no error.
pub fn unknown_labels(
    kind: &Kind,
    context: &Context<'_>,
    region: &Region,
    resolution: f64,
) -> Vec<Diagnostic> {
    let Some((of, field, wanted)) = asked(kind) else {
        return Vec::new();
    };
    // What is wrong with the input itself has been said where it was applied.
    let Ok(curves) = context.inputs.arrangement(of).draw(region, resolution) else {
        return Vec::new();
    };
    let known = labels(&curves);
    let span = match &context.span {
        Span::Name { file, path, .. } => {
            let path: Vec<Arc<str>> = path.iter().cloned().chain(field.map(Arc::from)).collect();
            Span::key(file, &path)
        }
        other => other.clone(),
    };
    let what = format!("nothing in `{}`", of.name);
    let warn = |label| unknown_label(&what, label, &known).at(span.clone(), "");
    let is_known = |label: &&Arc<str>| known.contains(*label);
    let is_table = matches!(kind, Kind::Relabel(_)) && wanted.iter().any(is_known);
    let is_doubtful = |label: &&Arc<str>| {
        // A table of labels may name some that there are elsewhere; a slip of the pen is told.
        let others = || known.iter().filter(|other| !wanted.contains(other));
        let is_slip = || nearest(label, others().map(|other| &**other)).is_some();
        !is_known(label) && (!is_table || (label.parse::<f64>().is_err() && is_slip()))
    };
    let doubtful = wanted.iter().filter(|label| is_doubtful(label));
    match curves.is_empty() {
        true => Vec::new(),
        false => doubtful.map(|label| warn(label)).collect(),
    }
}

/// The input whose labels a node asks for, the field in which it does, and the labels.
type Asked<'a> = (
    &'a Ref<wants::Arrangement>,
    [&'static str; 2],
    Vec<&'a Arc<str>>,
);

fn asked(kind: &Kind) -> Option<Asked<'_>> {
    match kind {
        Kind::Place(place) => {
            let (Cells::Vertices(of) | Cells::Edges(of) | Cells::Faces(of)) = &place.cells;
            let labels = place.r#where.as_ref()?.0.iter().map(|label| &label.0);
            Some((of, ["place", "where"], labels.collect()))
        }
        Kind::Relabel(relabel) => {
            let labels = relabel.labels.iter().map(|(label, _)| label);
            let labels = labels.filter(|label| &***label != "*").collect();
            Some((&relabel.from, ["relabel", "labels"], labels))
        }
        _ => None,
    }
}

/// A warning that `what` has no `label` here, with the nearest of those that are `known`.
pub fn unknown_label(what: &str, label: &str, known: &BTreeSet<Arc<str>>) -> Diagnostic {
    let warning = Diagnostic::warning(format!("{what} is labelled `{label}` here"));
    match nearest(label, known.iter().map(|k| &**k)) {
        Some(near) => warning.help(format!("did you mean `{near}`?")),
        None if known.is_empty() => warning.help("nothing in it has a label"),
        None => warning.help(format!("its labels are {}", listed(known))),
    }
}

/// The first of the labels, for people.
fn listed(known: &BTreeSet<Arc<str>>) -> String {
    let shown: Vec<String> = known
        .iter()
        .take(8)
        .map(|label| format!("`{label}`"))
        .collect();
    if known.len() > shown.len() {
        format!("{}, …", shown.join(", "))
    } else {
        shown.join(", ")
    }
}

/// All labels of edges, sides and ends.
fn labels(curves: &Curves) -> BTreeSet<Arc<str>> {
    let (mut seen, mut known) = (HashSet::new(), BTreeSet::new());
    for curve in curves.iter() {
        let labels = curve.labels;
        for set in [
            labels.edge,
            labels.left,
            labels.right,
            labels.start,
            labels.end,
        ] {
            if seen.insert(set) {
                known.extend(set.names().iter().cloned());
            }
        }
    }
    for (_, set) in curves.lone() {
        known.extend(set.names().iter().cloned());
    }
    known
}
