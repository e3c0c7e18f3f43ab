//! The steps of shells as nodes of their own: `shells.lamp.voxels` is one of `shells.lamp`. No entry has
//! a point in its name, so that the names of steps are free.

use std::sync::Arc;

use fretwork_action::Definition;
use fretwork_graph::NodeId;
use fretwork_language::kinds::shells::{Orientation, PatternStep, Shell, step_of};
use fretwork_language::{Node, Ref, Section, TypeSet, Wanted, wants};

/// The shell and the name of the step, where `id` is the name of one.
pub fn split(id: &NodeId) -> Option<(NodeId, Arc<str>)> {
    let (name, step) = id.name.rsplit_once('.')?;
    let whole = NodeId {
        section: Section::Shells,
        name: name.into(),
    };
    let is_step = id.section == Section::Shells && Shell::STEPS.contains(&step);
    is_step.then(|| (whole, step.into()))
}

/// The steps of the shell `id`; none of another node.
pub fn steps(id: &NodeId) -> impl Iterator<Item = NodeId> {
    let is_shell = id.section == Section::Shells;
    let all = Shell::STEPS.into_iter().filter(move |_| is_shell);
    all.map(|step| node_of(&step_of(&id.name, step)))
}

/// The definition of a step, from that of its shell. It holds what the step depends on and no more.
pub fn definition(whole: &Definition, id: NodeId, step: &str) -> Option<Arc<Definition>> {
    let Node::Shell(Shell::Whole(shell)) = &whole.node else {
        return None;
    };
    let kind = shell.step(&whole.id.name, step)?;
    let mut part = Definition {
        id,
        node: Node::Shell(kind.clone()),
        inputs: Default::default(),
        ..whole.clone()
    };
    let mut inputs = Inputs {
        whole,
        part: &mut part,
    };
    match &kind {
        Shell::Whole(_) => {}
        Shell::Voxels(kind) => inputs.entry(&kind.surface),
        Shell::Pattern(kind) => inputs.pattern(kind),
        Shell::Structure(kind) => {
            inputs.pattern(&kind.pattern);
            inputs.step(&kind.from);
            kind.force_profile
                .iter()
                .for_each(|profile| inputs.entry(profile));
        }
    }
    Some(Arc::new(part))
}

/// The steps whose results a whole shell is made of, as inputs of the shell `id`.
pub fn inputs(id: &NodeId) -> [((Arc<str>, TypeSet), NodeId); 3] {
    Shell::STEPS.map(|step| {
        let step = step_of(&id.name, step);
        ((step.name.clone(), step.wants()), node_of(&step))
    })
}

fn node_of(step: &Ref<wants::ShellStep>) -> NodeId {
    NodeId {
        section: Section::Shells,
        name: step.name.clone(),
    }
}

/// The inputs of a step as they are found.
struct Inputs<'a> {
    whole: &'a Definition,
    part: &'a mut Definition,
}

impl Inputs<'_> {
    /// What an entry of the spec gives.
    fn entry<T: Wanted>(&mut self, reference: &Ref<T>) {
        let target = self.whole.target(reference).clone();
        self.part
            .inputs
            .insert((reference.name.clone(), T::TYPES), target);
    }

    /// What another step gives.
    fn step(&mut self, reference: &Ref<wants::ShellStep>) {
        let key = (reference.name.clone(), reference.wants());
        self.part.inputs.insert(key, node_of(reference));
    }

    fn pattern(&mut self, kind: &PatternStep) {
        self.entry(&kind.surface);
        self.entry(&kind.exemplar);
        self.step(&kind.voxels);
        match &kind.orientation {
            Some(Orientation::Stress(profile)) => self.entry(profile),
            Some(Orientation::Field(field)) => self.entry(field),
            Some(Orientation::Up(_)) | None => {}
        }
    }
}
