//! What has to be evaluated: a node, or an arrangement on a region.

use std::sync::Arc;

use super::database::{Db, SourceFile};
use super::definition::{definition, linked};
use super::local::{is_local, is_near};
use super::settings::Settings;
use super::tiled::is_tiled;
use fretwork_action::{Definition, Window};
use fretwork_graph::NodeId;
use fretwork_language::kinds::arrangements::{Arrangement, Mapper};
use fretwork_language::kinds::artifacts::{Artifact, Content, Draw};
use fretwork_language::kinds::exemplars::Exemplar;
use fretwork_language::kinds::regions::Region;
use fretwork_language::kinds::wraps::Wrap;
use fretwork_language::{Node, Ref, Section, Tree, ValueType, Wanted, wants};
use fretwork_stage::slack;

/// A unit of evaluation. An arrangement is a function: with a region it stands for the curves on
/// that region, without one for the function itself.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Job {
    /// The root file of the spec.
    pub root: SourceFile,
    /// The values given to parameters.
    pub settings: Settings,
    /// The node.
    pub node: NodeId,
    /// The region that an arrangement is applied to.
    pub region: Option<NodeId>,
    /// The part of the plane that an artifact shows, or that what is drawn by tiles is wanted in, if it is not the whole.
    pub window: Option<Window>,
}

impl Job {
    /// The job for another node of the same spec under the same settings.
    pub fn of(&self, node: &NodeId, region: Option<&NodeId>) -> Job {
        Job {
            node: node.clone(),
            region: region.cloned(),
            window: None,
            ..self.clone()
        }
    }

    /// The definition of its node.
    pub fn definition(&self, db: &dyn Db) -> Option<Arc<Definition>> {
        definition(db, self.root, self.settings.clone(), self.node.clone())
    }

    /// The jobs whose values it needs, in a fixed order, each once.
    pub fn needs(&self, db: &dyn Db) -> Vec<Job> {
        let Some(definition) = self.definition(db) else {
            return Vec::new();
        };
        let mut needs = match &definition.node {
            Node::Artifact(artifact) => self.of_artifact(db, &definition, artifact),
            Node::Arrangement(Arrangement::Connect(connect)) => {
                self.drawn(db, &definition, &connect.input, &connect.region)
            }
            Node::Arrangement(Arrangement::Wrap(wrap)) => self.of_wrap(db, &definition, wrap),
            Node::Region(Region::Faces(faces)) => {
                self.drawn(db, &definition, &faces.of, &faces.region)
            }
            Node::Exemplar(Exemplar::Rasterize(rasterize)) => {
                self.drawn(db, &definition, &rasterize.from, &rasterize.region)
            }
            _ => {
                let is_tiled = self.is_tiled(db);
                let is_near = !is_tiled && self.window.is_some() && self.is_near(db);
                let is_function = |target: &NodeId| {
                    is_tiled || is_near && is_local(db, self.root, self.settings.clone(), target)
                };
                let needs = definition.targets();
                needs
                    .map(|target| match is_function(target) {
                        true => self.of(target, None),
                        false => self.applied(db, &definition, target),
                    })
                    .collect()
            }
        };
        if let Node::Facade(_) = definition.node {
            // Patterns name symbols by their letters.
            let symbols = self.nodes_of(db, Section::Symbols);
            let module = self.node.split().0;
            let own = symbols.iter().filter(|id| id.split().0 == module);
            needs.extend(own.map(|id| self.of(id, None)));
        }
        needs.extend(self.region.iter().map(|region| self.of(region, None)));
        let mut seen = std::collections::HashSet::new();
        needs.retain(|job| seen.insert(job.clone()));
        needs
    }

    /// The jobs for something that is drawn on a region, and for the region.
    fn drawn<T: Wanted>(
        &self,
        db: &dyn Db,
        definition: &Definition,
        from: &Ref<T>,
        region: &Ref<wants::Region>,
    ) -> Vec<Job> {
        let (from, region) = (definition.target(from), definition.target(region));
        let applied = Some(region).filter(|_| self.is_arrangement(db, from));
        vec![self.of(from, applied), self.of(region, None)]
    }

    /// The jobs for what is laid on a surface, on its region where it has one, and for the surface.
    fn of_wrap(&self, db: &dyn Db, definition: &Definition, wrap: &Wrap) -> Vec<Job> {
        let from = definition.target(&wrap.from);
        let region = wrap.region.as_ref().map(|region| definition.target(region));
        let applied = region.filter(|_| self.is_arrangement(db, from));
        let mut needs = vec![self.of(from, applied)];
        needs.extend(region.map(|region| self.of(region, None)));
        needs.push(self.of(definition.target(&wrap.onto), None));
        needs
    }

    /// Whether it is an arrangement that is drawn on a region by tiles.
    pub(super) fn is_tiled(&self, db: &dyn Db) -> bool {
        self.region.is_some() && *is_tiled(db, self.root, self.settings.clone(), self.node.clone())
    }

    /// Whether it is an arrangement on a region of which a window is drawn without the whole.
    pub(super) fn is_near(&self, db: &dyn Db) -> bool {
        self.region.is_some() && is_near(db, self.root, self.settings.clone(), &self.node)
    }

    /// The job for an input of this one: an arrangement is applied to this job's region, unless it
    /// is handed on as a function.
    pub fn applied(&self, db: &dyn Db, definition: &Definition, target: &NodeId) -> Job {
        let is_function = self.region.is_none() || functions(definition).contains(&target);
        let region = self
            .region
            .as_ref()
            .filter(|_| !is_function && self.is_arrangement(db, target));
        self.of(target, region)
    }

    fn of_artifact(&self, db: &dyn Db, definition: &Definition, artifact: &Artifact) -> Vec<Job> {
        let region = artifact.region.as_ref().map(|r| definition.target(r));
        let mut needs = Vec::new();
        for from in shown(artifact) {
            let target = definition.target(from);
            let mut need = self.of(target, region.filter(|_| self.is_arrangement(db, target)));
            let is_near = || {
                let is_alone = self.window.is_some_and(|window| !window.is_shared());
                is_alone && shows_lines(artifact) && need.is_near(db)
            };
            // Copies of the whole stand in a window of a preview.
            let is_cut = self.window.is_some() && artifact.repeat.is_none();
            if is_cut && (need.is_tiled(db) || is_near()) {
                let slack = slack(definition, artifact);
                need.window = self.window.map(|window| window.grown(slack));
            }
            needs.push(need);
        }
        needs.extend(region.map(|r| self.of(r, None)));
        needs
    }

    /// The nodes of a section of the spec.
    pub fn nodes_of(&self, db: &dyn Db, section: Section) -> Vec<NodeId> {
        linked(db, self.root, self.settings.clone())
            .targets
            .keys()
            .filter(|id| id.section == section)
            .cloned()
            .collect()
    }

    /// Whether `node` is an arrangement that is a function of regions.
    pub fn is_arrangement(&self, db: &dyn Db, node: &NodeId) -> bool {
        definition(db, self.root, self.settings.clone(), node.clone())
            .is_some_and(|d| is_function_of_regions(&d.node))
    }
}

/// Whether a window of an artifact shows lines alone, each as it is drawn: an area needs all of its outline, and a beam's
/// width is made up for by what is around.
fn shows_lines(artifact: &Artifact) -> bool {
    artifact.draw != Some(Draw::Filled) && artifact.kerf.0 == 0.0
}

/// Whether a node gives other lines on other regions. The drawing of a solid does not.
pub fn is_function_of_regions(node: &Node) -> bool {
    match node {
        Node::Arrangement(arrangement) => arrangement.is_function(),
        node => node.provides() == ValueType::Arrangement,
    }
}

/// What an artifact shows.
pub fn shown(artifact: &Artifact) -> Vec<&Ref<wants::Product>> {
    match &artifact.content {
        Content::From(from) => vec![from],
        Content::Parts(parts) => parts.iter().map(|part| &part.from).collect(),
    }
}

/// The inputs that a node applies to regions of its own, faces above all, and those that it takes
/// on a region of its own choice.
fn functions(definition: &Definition) -> Vec<&NodeId> {
    let Node::Arrangement(arrangement) = &definition.node else {
        return Vec::new();
    };
    let arguments = match arrangement {
        Arrangement::Fill(fill) => return vec![definition.target(&fill.with)],
        Arrangement::Repeat(repeat) => return vec![definition.target(&repeat.from)],
        Arrangement::Map(map) | Arrangement::Vary(map) => match &map.with {
            Mapper::Inline(_) => return Vec::new(),
            Mapper::Script(script) => &script.args,
        },
        Arrangement::Script(script) => &script.args,
        _ => return Vec::new(),
    };
    let mut texts = Vec::new();
    arguments
        .0
        .values()
        .for_each(|value| collect_texts(value, &mut texts));
    texts
        .into_iter()
        .filter_map(|text| definition.named(text, wants::Argument::TYPES))
        .collect()
}

fn collect_texts<'a>(tree: &'a Tree, texts: &mut Vec<&'a Arc<str>>) {
    match tree {
        Tree::Text(text) => texts.push(text),
        Tree::List(items) => items.iter().for_each(|item| collect_texts(item, texts)),
        Tree::Map(entries) => entries
            .iter()
            .for_each(|(_, value)| collect_texts(value, texts)),
        Tree::Null | Tree::Bool(_) | Tree::Int(_) | Tree::Float(_) | Tree::Written(_) => {}
    }
}
