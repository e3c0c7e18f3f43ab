//! Which arrangements are drawn window by window (rule W3): those whose cells are felt no farther than a length that is known.
//! These take such inputs as functions; any other input is drawn on the whole region once, for all windows.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::database::{Db, SourceFile};
use super::definition::definition;
use super::settings::Settings;
use super::tiled::is_tiled;
use fretwork_action::Definition;
use fretwork_graph::NodeId;
use fretwork_language::Node;
use fretwork_language::kinds::arrangements::{Arrangement, Cells, ExtendedCells, MapCells, Masked};
use fretwork_language::kinds::partitions::Partition;

/// An arrangement is put together of at most so many others, one after another.
const DEPTH: usize = 24;

/// Whether what of a node lies in a window is drawn without the whole, given its inputs.
pub fn is_near(db: &dyn Db, root: SourceFile, settings: Settings, node: &NodeId) -> bool {
    let place = Place { db, root, settings };
    place.knows(node, 0) == Some(true)
}

/// Whether that is so of it and of all of its inputs. Regions are as near as can be.
pub fn is_local(db: &dyn Db, root: SourceFile, settings: Settings, node: &NodeId) -> bool {
    let place = Place { db, root, settings };
    place.is_local(node, 0)
}

struct Place<'a> {
    db: &'a dyn Db,
    root: SourceFile,
    settings: Settings,
}

impl Place<'_> {
    fn definition(&self, node: &NodeId) -> Option<Arc<Definition>> {
        definition(self.db, self.root, self.settings.clone(), node.clone()).clone()
    }

    fn is_local(&self, node: &NodeId, depth: usize) -> bool {
        let Some(of_node) = self.definition(node).filter(|_| depth < DEPTH) else {
            return false;
        };
        self.knows(node, depth) == Some(true)
            && inputs(&of_node).all(|input| match self.knows(input, depth) {
                // A region.
                None => true,
                Some(_) => self.is_local(input, depth + 1),
            })
    }

    /// Whether the kind of an arrangement says how far its cells are felt. None for what is no arrangement.
    fn knows(&self, node: &NodeId, depth: usize) -> Option<bool> {
        let of_node = self.definition(node)?;
        Some(match &of_node.node {
            Node::Partition(Partition::Packed(_)) => false,
            Node::Partition(_) => true,
            Node::Arrangement(Arrangement::Map(map)) => map.reach.is_some(),
            // It is drawn in faces, in each one as a whole at most.
            Node::Arrangement(Arrangement::Fill(fill)) => {
                self.keeps_within(of_node.target(&fill.with), depth + 1)
            }
            Node::Arrangement(
                Arrangement::Vary(_)
                | Arrangement::Place(_)
                | Arrangement::Transform(_)
                | Arrangement::Union(_)
                | Arrangement::Inside(_)
                | Arrangement::Outside(_)
                | Arrangement::Relabel(_),
            ) => true,
            Node::Arrangement(_) => false,
            _ => return None,
        })
    }

    /// Whether it is known how far what fills faces goes beyond them.
    fn keeps_within(&self, node: &NodeId, depth: usize) -> bool {
        let of_node = self.definition(node).filter(|_| depth < DEPTH);
        match of_node.as_ref().map(|of_node| &of_node.node) {
            Some(Node::Partition(_)) => true,
            Some(Node::Arrangement(_)) => self.is_local(node, depth),
            _ => false,
        }
    }
}

/// The arrangements that an arrangement is made of on the same region.
fn inputs(definition: &Definition) -> impl Iterator<Item = &NodeId> {
    let all = match &definition.node {
        Node::Arrangement(Arrangement::Map(MapCells { cells, .. }))
        | Node::Arrangement(Arrangement::Vary(MapCells { cells, .. })) => vec![cell_input(cells)],
        Node::Arrangement(Arrangement::Place(place)) => vec![cell_input(&place.cells)],
        Node::Arrangement(Arrangement::Transform(transform)) => match &transform.cells {
            ExtendedCells::Edges(input) | ExtendedCells::Faces(input) => vec![input],
        },
        Node::Arrangement(Arrangement::Fill(fill)) => vec![&fill.faces],
        Node::Arrangement(Arrangement::Union(of)) => of.iter().collect(),
        Node::Arrangement(Arrangement::Inside(masked) | Arrangement::Outside(masked)) => {
            let Masked { input, mask, .. } = masked;
            vec![input, mask]
        }
        Node::Arrangement(Arrangement::Relabel(relabel)) => vec![&relabel.from],
        _ => Vec::new(),
    };
    all.into_iter().map(|input| definition.target(input))
}

fn cell_input(cells: &Cells) -> &fretwork_language::Ref<fretwork_language::wants::Arrangement> {
    let (Cells::Vertices(input) | Cells::Edges(input) | Cells::Faces(input)) = cells;
    input
}

/// The mappers below a node that do not say how far their curves reach, and that are not drawn by tiles.
pub fn without_reach(
    db: &dyn Db,
    root: SourceFile,
    settings: Settings,
    node: &NodeId,
) -> Vec<(NodeId, Arc<Definition>)> {
    let place = Place { db, root, settings };
    let (mut open, mut seen, mut found) = (vec![node.clone()], BTreeSet::new(), Vec::new());
    while let Some(node) = open.pop() {
        let Some(of_node) = place
            .definition(&node)
            .filter(|_| seen.insert(node.clone()))
        else {
            continue;
        };
        let is_open = match &of_node.node {
            Node::Arrangement(Arrangement::Map(map)) => map.reach.is_none(),
            _ => false,
        };
        if is_open && !*is_tiled(db, root, place.settings.clone(), node.clone()) {
            found.push((node, of_node));
            continue;
        }
        open.extend(of_node.targets().cloned());
    }
    found
}
