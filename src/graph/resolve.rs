//! References to nodes: the node that a name means, and whether its type is allowed there.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use petgraph::graphmap::DiGraphMap;

use super::NodeId;
use super::cycle::find_cycles;
use fretwork_diagnostic::{Code, Diagnostic, Span};
use fretwork_language::{Reference, TypeSet, ValueType, with_article};

/// The part of a node that the graph knows.
#[derive(Clone, Debug, PartialEq)]
pub struct Interface {
    /// The type of its value; all types of its section if errors hide which one it is.
    pub provides: TypeSet,
    /// The references in it, in the order of its text.
    pub references: Vec<Reference>,
    /// The place of its name.
    pub span: Span,
}

/// The graph of a spec.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Linked {
    /// For each node, the node that each of its references means; none if it means no node.
    pub targets: BTreeMap<NodeId, Vec<Option<NodeId>>>,
    /// The nodes in an order in which each comes after those that it refers to. Nodes on a cycle, and
    /// nodes that lead to one, are missing.
    pub order: Vec<NodeId>,
    /// Errors about references that are unknown, ambiguous or of a wrong type, and about cycles.
    pub diagnostics: Vec<Diagnostic>,
}

/// The names that a file defines, but that could not be read. That has been reported, so that nothing is
/// reported about references to them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Unread {
    /// The names.
    pub names: BTreeSet<Arc<str>>,
    /// Whether any other name may be one of them, because a whole section or file is missing.
    pub any: bool,
}

/// The most types that the message about an unknown name lists; more would hide the name.
const FEW_TYPES: usize = 3;

/// The names near to as many unknown ones are looked for: each is compared with all names, and nobody reads more errors.
const SUGGESTIONS: usize = 100;

/// Resolves every reference of `nodes`, in O(references · log nodes).
pub fn link(nodes: &BTreeMap<NodeId, Interface>, unread: &Unread) -> Linked {
    let mut by_name: BTreeMap<&str, Vec<&NodeId>> = BTreeMap::new();
    for id in nodes.keys() {
        by_name.entry(&id.name).or_default().push(id);
    }
    let names = Names { nodes, by_name };
    let mut linked = Linked::default();
    let mut unknown = 0;
    for (id, node) in nodes {
        let mut targets = Vec::with_capacity(node.references.len());
        for reference in &node.references {
            targets.push(match names.find(reference) {
                Some(target) => Some(target.clone()),
                // Text that names nothing is only text there.
                None if !reference.required => None,
                None if names.is_unread(reference, unread) => None,
                None => {
                    unknown += 1;
                    linked
                        .diagnostics
                        .push(names.wrong(reference, unknown <= SUGGESTIONS));
                    None
                }
            });
        }
        linked.targets.insert(id.clone(), targets);
    }
    let (order, cycles) = order(nodes, &linked.targets);
    linked.order = order;
    linked.diagnostics.extend(cycles);
    linked
}

struct Names<'a> {
    nodes: &'a BTreeMap<NodeId, Interface>,
    by_name: BTreeMap<&'a str, Vec<&'a NodeId>>,
}

impl<'a> Names<'a> {
    /// The one node that `reference` means.
    fn find(&self, reference: &Reference) -> Option<&'a NodeId> {
        match self.fitting(reference)[..] {
            [one] => Some(one),
            _ => None,
        }
    }

    /// What is wrong with a reference that means no node, or several; `suggests` the nearest name where
    /// it is unknown.
    fn wrong(&self, reference: &Reference, suggests: bool) -> Diagnostic {
        match (
            &self.fitting(reference)[..],
            &self.candidates(reference)[..],
        ) {
            ([], []) => self.unknown(reference, suggests),
            ([], all) => self.wrong_type(reference, all),
            (several, _) => self.ambiguous(reference, several),
        }
    }

    /// The nodes of the reference's name whose types may stand there. One that only stands in for others is meant where
    /// none of these has the name.
    fn fitting(&self, reference: &Reference) -> Vec<&'a NodeId> {
        let mut fitting = self.candidates(reference);
        let provides = |id: &NodeId| self.nodes[id].provides;
        fitting.retain(|id| reference.wants.intersects(provides(id)));
        let stands_in = |id: &&NodeId| {
            provides(id)
                .types()
                .all(|ty| reference.stand_ins.contains(ty))
        };
        if !fitting.iter().all(stands_in) {
            fitting.retain(|id| !stands_in(id));
        }
        fitting
    }

    /// Whether the reference is to something that could not be read.
    fn is_unread(&self, reference: &Reference, unread: &Unread) -> bool {
        self.candidates(reference).is_empty()
            && (unread.any || unread.names.contains(&reference.name))
    }

    /// The nodes of the reference's name, in its section if it has one.
    fn candidates(&self, reference: &Reference) -> Vec<&'a NodeId> {
        let ids = self
            .by_name
            .get(&*reference.name)
            .cloned()
            .unwrap_or_default();
        ids.into_iter()
            .filter(|id| {
                reference
                    .section
                    .is_none_or(|section| section == id.section)
            })
            .collect()
    }

    fn unknown(&self, reference: &Reference, suggests: bool) -> Diagnostic {
        let (bare, wants) = (&*reference.name, reference.wants.describe());
        let place = reference
            .section
            .map_or(String::new(), |s| format!(" in `{}`", s.name()));
        let message = match reference.wants.types().count() {
            0..=FEW_TYPES => format!("there is no {wants} `{bare}`{place}"),
            _ => format!("nothing is named `{bare}`{place}"),
        };
        let diagnostic = Diagnostic::error(message)
            .about(Code::Reference)
            .at(reference.span.clone(), "not defined");
        let is_fitting = |id: &NodeId| reference.wants.intersects(self.nodes[id].provides);
        if let Some(id) = self
            .by_name
            .get(bare)
            .into_iter()
            .flatten()
            .find(|id| is_fitting(id))
        {
            return diagnostic.help(format!("did you mean `{id}`?"));
        }
        if !suggests {
            return diagnostic;
        }
        let mut known: Vec<&str> = self
            .nodes
            .keys()
            .filter(|id| is_fitting(id))
            .map(|id| &*id.name)
            .collect();
        known.sort_unstable();
        known.dedup();
        if fretwork_diagnostic::nearest(bare, known.iter().copied()).is_none() {
            return match &known[..] {
                [] if reference.wants.types().count() <= FEW_TYPES => {
                    diagnostic.help(format!("the spec defines no {wants}"))
                }
                [] => diagnostic.help("the spec defines nothing that may stand here"),
                known if known.len() <= 8 => {
                    diagnostic.help(format!("known are: {}", known.join(", ")))
                }
                _ => diagnostic,
            };
        }
        diagnostic.suggest(bare, known)
    }

    fn wrong_type(&self, reference: &Reference, found: &[&NodeId]) -> Diagnostic {
        let id = found[0];
        let node = &self.nodes[id];
        let (found, needed) = (
            with_article(&node.provides.describe()),
            with_article(&reference.wants.describe()),
        );
        let error = Diagnostic::error(format!(
            "`{}` is {found}, but {needed} is needed",
            reference.name
        ))
        .about(Code::Reference)
        .at(reference.span.clone(), format!("must be {needed}"))
        .at(node.span.clone(), format!("`{id}` is {found}"));
        if node.provides == TypeSet::of(&[ValueType::Arrangement])
            && reference.wants.contains(ValueType::Region)
        {
            let faces = format!("faces: {{ of: {}, region: REGION }}", id.name);
            return error.help(format!("its faces are a region: `{{ {faces} }}`"));
        }
        if node.provides == TypeSet::of(&[ValueType::Region])
            && reference.wants == TypeSet::of(&[ValueType::Cutout])
        {
            let wrap = format!("wrap: {{ from: {}, onto: SURFACE }}", id.name);
            return error.help(format!(
                "under `arrangements`, `{{ {wrap} }}` lays it on the surface and is a cutout; \
                 a flat piece of it is made by the solid `extrude`"
            ));
        }
        error
    }

    fn ambiguous(&self, reference: &Reference, several: &[&NodeId]) -> Diagnostic {
        let options: Vec<String> = several.iter().map(|id| format!("`{id}`")).collect();
        let mut diagnostic = Diagnostic::error(format!(
            "`{}` is defined in several sections",
            reference.name
        ))
        .about(Code::Reference)
        .at(reference.span.clone(), "which one?")
        .help(format!("write {}", options.join(" or ")));
        for id in several {
            diagnostic = diagnostic.at(self.nodes[*id].span.clone(), "here");
        }
        diagnostic
    }
}

type Targets = BTreeMap<NodeId, Vec<Option<NodeId>>>;

fn order(nodes: &BTreeMap<NodeId, Interface>, targets: &Targets) -> (Vec<NodeId>, Vec<Diagnostic>) {
    let ids: Vec<&NodeId> = nodes.keys().collect();
    let number: BTreeMap<&NodeId, usize> = ids.iter().enumerate().map(|(i, id)| (*id, i)).collect();
    // An edge carries the number of the reference that makes it, for diagnostics.
    let mut graph: DiGraphMap<usize, usize> = DiGraphMap::new();
    (0..ids.len()).for_each(|i| {
        graph.add_node(i);
    });
    for (id, targets) in targets {
        for (reference, target) in targets.iter().enumerate().rev() {
            if let Some(target) = target {
                graph.add_edge(number[id], number[target], reference);
            }
        }
    }
    let (order, cycles) = find_cycles(&graph);
    let diagnostics = cycles
        .iter()
        .map(|cycle| describe(cycle, &ids, nodes))
        .collect();
    (
        order.into_iter().map(|i| ids[i].clone()).collect(),
        diagnostics,
    )
}

fn describe(
    cycle: &[(usize, usize)],
    ids: &[&NodeId],
    nodes: &BTreeMap<NodeId, Interface>,
) -> Diagnostic {
    let mut path: Vec<Arc<str>> = cycle
        .iter()
        .map(|(node, _)| ids[*node].name.clone())
        .collect();
    path.push(path[0].clone());
    let mut diagnostic = Diagnostic::error(format!("a cycle of references: {}", path.join(" → ")))
        .about(Code::Reference);
    for (i, (node, reference)) in cycle.iter().enumerate() {
        let span = nodes[ids[*node]].references[*reference].span.clone();
        diagnostic = diagnostic.at(span, format!("`{}` needs `{}`", path[i], path[i + 1]));
    }
    diagnostic
}
