//! Facades: symbols, patterns and layers collected by name, laid out by their room, and its problems
//! put where their causes stand.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{Stage, StageResult};
use crate::build::definition::Definition;
use crate::build::value::{Data, Value};
use crate::diagnostic::Span;
use crate::facade::{self, Part, PatternText, Problem, Range, lay_out};
use crate::graph::NodeId;
use crate::spec::kinds::facades::Facade;
use crate::spec::kinds::layers::Layer;
use crate::spec::kinds::patterns::Pattern;
use crate::spec::{Node, Ref, Section, wants};

/// Lays the facade out.
pub fn facade(stage: &Stage<'_>, kind: &Facade) -> StageResult {
    let mut parts = Parts { stage, files: BTreeMap::new() };
    let input = parts.collect(kind);
    let told =
        |problems: Vec<Problem>| problems.iter().map(|p| p.diagnostic(|part| parts.place(part))).collect::<Vec<_>>();
    match lay_out(&input) {
        Ok((layout, warnings)) => Ok((Value::Data(Data::Facade(Arc::new(layout))), told(warnings))),
        Err(problems) => Err(told(problems)),
    }
}

/// The definitions that a facade is made of, and the files that they stand in.
struct Parts<'a> {
    stage: &'a Stage<'a>,
    files: BTreeMap<NodeId, Arc<str>>,
}

impl Parts<'_> {
    fn collect(&mut self, kind: &Facade) -> facade::Facade {
        let symbols = self.symbols();
        let layers = kind.layers.iter().map(|name| self.layer(name)).collect();
        facade::Facade {
            canvas: [kind.canvas.width.0, kind.canvas.height.0],
            symbols,
            counters: kind
                .counters
                .0
                .iter()
                .map(|(c, range)| (c.0, Range { min: range.min, max: range.max }))
                .collect(),
            layers,
        }
    }

    /// Patterns name symbols by their letters, so a facade sees all symbols of its spec.
    fn symbols(&mut self) -> BTreeMap<char, facade::Symbol> {
        let mut symbols = BTreeMap::new();
        for id in self.stage.job.nodes_of(self.stage.db, Section::Symbols) {
            let Some(definition) = self.definition(&id) else { continue };
            let (Node::Symbol(symbol), Some(letter)) = (&definition.node, id.name.chars().next()) else { continue };
            let attributes = facade::Symbol {
                size: symbol.size.as_ref().map(|size| size.0),
                opaque: symbol.opaque,
                attached: symbol.attached,
                unoccludable: symbol.unoccludable,
                fixed: symbol.fixed,
                weight: symbol.weight.0,
            };
            symbols.insert(letter, attributes);
        }
        symbols
    }

    fn layer(&mut self, name: &Ref<wants::Layer>) -> facade::Layer {
        let definition = self.of(self.stage.definition, name);
        let Node::Layer(layer) = &definition.node else { unreachable!("the graph checks that it is a layer") };
        let Layer { x, y, visible, group } = layer;
        let seen = |axis: Option<&crate::spec::value::List<crate::spec::scalar::Letter>>| {
            axis.map(|letters| letters.iter().map(|letter| letter.0).collect())
        };
        let visible = visible.as_ref();
        facade::Layer {
            name: definition.id.name.clone(),
            patterns: [self.pattern(&definition, x), self.pattern(&definition, y)],
            groups: [group.x.0.clone(), group.y.0.clone()],
            visible: [seen(visible.and_then(|v| v.x.as_ref())), seen(visible.and_then(|v| v.y.as_ref()))],
        }
    }

    fn pattern(&mut self, layer: &Definition, name: &Ref<wants::Pattern>) -> PatternText {
        let definition = self.of(layer, name);
        let Node::Pattern(pattern) = &definition.node else { unreachable!("the graph checks that it is a pattern") };
        let name = definition.id.name.clone();
        match pattern {
            Pattern::Plain(text) => PatternText { name, control: text.0.clone(), content: None },
            Pattern::Substituted(pattern) => PatternText {
                name,
                control: pattern.control.0.clone(),
                content: Some(pattern.content.iter().map(|(letter, text)| (letter.0, text.0.clone())).collect()),
            },
        }
    }

    fn of<T: crate::spec::Wanted>(&mut self, from: &Definition, name: &Ref<T>) -> Arc<Definition> {
        self.definition(from.target(name)).expect("a stage runs only when all its inputs have values")
    }

    fn definition(&mut self, id: &NodeId) -> Option<Arc<Definition>> {
        let definition = self.stage.job.of(id, None).definition(self.stage.db)?;
        self.files.insert(id.clone(), definition.file.clone());
        Some(definition)
    }

    /// The place of a part.
    fn place(&self, part: &Part) -> Span {
        let own = &self.stage.definition.id;
        match part {
            Part::Facade => self.stage.definition.span(),
            Part::Canvas(side) => self.span(own, &["canvas", side]),
            Part::Counter(letter) => self.span(own, &["counters", &letter.to_string()]),
            Part::Symbol(letter, field) => self.span(&node(Section::Symbols, &letter.to_string()), field.as_slice()),
            Part::Layer(name, field) => self.span(&node(Section::Layers, name), field.as_slice()),
            Part::Pattern { name, content, .. } => {
                let id = node(Section::Patterns, name);
                match content.map(|letter| letter.to_string()) {
                    Some(letter) => self.span(&id, &["content", &letter]),
                    None => self.span(&id, &[]),
                }
            }
        }
    }

    fn span(&self, id: &NodeId, steps: &[&str]) -> Span {
        let file = self.files.get(id).unwrap_or(&self.stage.definition.file);
        let path = [id.section.name(), &*id.name].into_iter().chain(steps.iter().copied());
        Span::value(file, &path.map(Arc::from).collect::<Vec<_>>())
    }
}

fn node(section: Section, name: &str) -> NodeId {
    NodeId { section, name: name.into() }
}
