//! Curves with other labels.

use std::collections::HashMap;

use fretwork_geometry::{CurveLabels, Curves, LabelSet};
use fretwork_language::scalar::Label;
use fretwork_language::value::{Named, OneOrMany};

/// What stands for all labels that have no entry of their own.
const OTHERS: &str = "*";

/// The curves with other labels: every label that `labels` names is replaced by those that it says, or else by those of `*`
/// where there is such an entry, on edges, their sides and their ends. Named points stay.
pub fn relabel(curves: &Curves, labels: &Named<OneOrMany<Label>>) -> Curves {
    let find = |name: &str| labels.iter().find(|(key, _)| **key == *name);
    let mut known: HashMap<LabelSet, LabelSet> = HashMap::new();
    let mut replaced = |set: LabelSet| {
        *known.entry(set).or_insert_with(|| {
            let names = set.names();
            let new = names
                .iter()
                .flat_map(|name| match find(name).or(find(OTHERS)) {
                    Some((_, labels)) => labels.iter().map(|label| label.0.clone()).collect(),
                    None => vec![name.clone()],
                });
            LabelSet::of(new.collect::<Vec<_>>())
        })
    };
    labelled(curves, |old| CurveLabels {
        edge: replaced(old.edge),
        left: replaced(old.left),
        right: replaced(old.right),
        start: replaced(old.start),
        end: replaced(old.end),
    })
}

/// The curves with the labels that `labels` makes of theirs. Named points stay.
pub(crate) fn labelled(
    curves: &Curves,
    mut labels: impl FnMut(CurveLabels) -> CurveLabels,
) -> Curves {
    let mut made = Curves::with_capacity(curves.len(), curves.points().len());
    for curve in curves.iter() {
        made.push(curve.points.iter().copied(), labels(curve.labels));
    }
    for (name, at) in curves.named_points() {
        made.name_point(name.clone(), *at);
    }
    made
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Point;

    #[test]
    fn labels_are_replaced_on_all_cells() {
        let mut curves = Curves::new();
        let labels = CurveLabels {
            left: LabelSet::of(["a", "b"]),
            ..CurveLabels::edge(LabelSet::of(["a"]))
        };
        let ends = [Point::ORIGIN, Point::new(1.0, 0.0)];
        curves.push(ends, labels);
        curves.push(ends, CurveLabels::default());
        curves.name_point("p", Point::ORIGIN);
        let to = |labels: &[&str]| OneOrMany(labels.iter().map(|l| Label((*l).into())).collect());
        let named = Named(vec![
            ("a".into(), to(&["x", "y"])),
            ("*".into(), to(&["rest"])),
        ]);
        let made = relabel(&curves, &named);
        assert_eq!(made.get(0).labels.edge, LabelSet::of(["x", "y"]));
        assert_eq!(made.get(0).labels.left, LabelSet::of(["x", "y", "rest"]));
        assert!(made.get(1).labels.edge.is_empty());
        assert_eq!(made.point_named("p"), Some(Point::ORIGIN));
        let few = Named(vec![("b".into(), to(&["c"]))]);
        let made = relabel(&curves, &few);
        assert_eq!(made.get(0).labels.left, LabelSet::of(["a", "c"]));
    }
}
