//! A node with its references and files resolved.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use fretwork_diagnostic::Span;
use fretwork_geometry::Seed;
use fretwork_graph::NodeId;
use fretwork_language::kinds::shells::Shell;
use fretwork_language::{Map, Node, Ref, TypeSet, Unit, Wanted};

/// Everything that evaluating a node depends on besides the values of its inputs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Definition {
    /// The node's name.
    pub id: NodeId,
    /// Its typed fields.
    pub node: Node,
    /// The nodes that its references mean, by name and by what fits.
    pub inputs: BTreeMap<(Arc<str>, TypeSet), NodeId>,
    /// Its files: as named, and from the project root.
    pub files: BTreeMap<Arc<str>, Arc<str>>,
    /// The key of its random values.
    pub seed: Seed,
    /// The unit that its lengths are in.
    pub units: Unit,
    /// The unit of what its file does not say one of: of drawings and meshes without a size, of the coordinates of
    /// formulas and scripts. In maps that of the plane.
    pub own_units: Unit,
    /// The plane of a map, in map specs: of it what the node can depend on.
    pub map: Option<Arc<Map>>,
    /// The file that it stands in.
    pub file: Arc<str>,
}

impl Definition {
    /// The node that `reference` means.
    pub fn target<T: Wanted>(&self, reference: &Ref<T>) -> &NodeId {
        self.inputs
            .get(&(reference.name.clone(), reference.wants()))
            .expect("every reference of a node without errors is resolved")
    }

    /// The node that `text` means where something of `wants` may stand, if it means one.
    pub fn named(&self, text: &Arc<str>, wants: TypeSet) -> Option<&NodeId> {
        self.inputs.get(&(text.clone(), wants))
    }

    /// How long one of its own file's units is in the unit that lengths are in.
    pub fn own_unit(&self) -> f64 {
        self.own_units.convert(1.0, self.units)
    }

    /// All nodes that it refers to, in order.
    pub fn targets(&self) -> impl Iterator<Item = &NodeId> {
        self.inputs.values()
    }

    /// Its name in its own file: that of an entry of a module has the module's name before it elsewhere.
    pub fn own_name(&self) -> &str {
        self.id.own_name()
    }

    /// The place of its name.
    pub fn span(&self) -> Span {
        Span::key(&self.file, &self.path(&[]))
    }

    /// The place of the value of a field of it.
    pub fn field(&self, steps: &[&str]) -> Span {
        Span::value(&self.file, &self.path(steps))
    }

    /// The place of the key of a field of it.
    pub fn field_key(&self, steps: &[&str]) -> Span {
        Span::key(&self.file, &self.path(steps))
    }

    /// The way to a field of it in its file. A step on the way to a shell stands where the shell does.
    fn path(&self, steps: &[&str]) -> Vec<Arc<str>> {
        let own_name = match &self.node {
            Node::Shell(shell) if !matches!(shell, Shell::Whole(_)) => {
                let (entry, _) = self.id.name.rsplit_once('.').unwrap_or_default();
                entry.rsplit_once('.').map_or(entry, |(_, own)| own)
            }
            _ => self.own_name(),
        };
        let own = [self.id.section.name(), own_name];
        own.iter()
            .chain(steps)
            .map(|step| Arc::from(*step))
            .collect()
    }
}
