//! Facades as their room takes them: symbols, patterns and layers collected by name, and the places
//! of what is wrong with them. Also what can be said about patterns before anything is laid out.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::database::Db;
use super::definition::Definition;
use super::job::Job;
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_facade::{Part, PatternPart, PatternText, Problem, Range};
use fretwork_graph::NodeId;
use fretwork_language::kinds::facades::Facade;
use fretwork_language::kinds::layers::Layer;
use fretwork_language::kinds::patterns::Pattern;
use fretwork_language::scalar::Letter;
use fretwork_language::value::List;
use fretwork_language::{Node, Ref, Section, Wanted, wants};

/// A facade's description, and the files that its parts stand in.
pub struct Description {
    /// What the room is given.
    pub facade: fretwork_facade::Facade,
    own: NodeId,
    span: Span,
    files: BTreeMap<NodeId, Arc<str>>,
}

/// The mistakes in the patterns, symbols and facades of the spec of `job` (any of its jobs) that do not need a
/// layout.
pub fn check(db: &dyn Db, job: &Job) -> Vec<Diagnostic> {
    let mut diagnostics = Vec::new();
    for id in job.nodes_of(db, Section::Patterns) {
        let Some(definition) = job.of(&id, None).definition(db) else {
            continue;
        };
        let Node::Pattern(kind) = &definition.node else {
            continue;
        };
        let problems = fretwork_facade::pattern_mistakes(&pattern(&id.name, kind));
        diagnostics.extend(
            problems
                .iter()
                .map(|p| p.diagnostic(|part| place(part, &|_| definition.file.clone()))),
        );
    }
    for id in job.nodes_of(db, Section::Facades) {
        let of = job.of(&id, None);
        let Some(definition) = of.definition(db) else {
            continue;
        };
        let Node::Facade(kind) = &definition.node else {
            continue;
        };
        if of
            .needs(db)
            .iter()
            .any(|need| need.definition(db).is_none())
            || !has_all_patterns(db, &of, &definition, kind)
        {
            continue;
        }
        let description = Description::new(db, &of, &definition, kind);
        diagnostics.extend(
            fretwork_facade::check(&description.facade)
                .iter()
                .map(|p| description.tell(p)),
        );
        diagnostics.extend(unknown_letters(&description, &definition, kind));
    }
    diagnostics
}

/// Whether all layers and their patterns could be read.
fn has_all_patterns(db: &dyn Db, job: &Job, definition: &Definition, kind: &Facade) -> bool {
    kind.layers.iter().all(|name| {
        let layer = job.of(definition.target(name), None).definition(db);
        layer.is_some_and(|layer| {
            layer
                .targets()
                .all(|t| job.of(t, None).definition(db).is_some())
        })
    })
}

/// Keys of shapes that name symbols which the spec does not have.
fn unknown_letters(
    description: &Description,
    definition: &Definition,
    kind: &Facade,
) -> Vec<Diagnostic> {
    let known = |letter: &Option<Letter>| {
        letter.is_none_or(|c| description.facade.symbols.contains_key(&c.0))
    };
    let unknown = kind
        .shapes
        .0
        .iter()
        .filter(|(key, _)| !(known(&key.x) && known(&key.y)));
    let tell = |key: String| {
        let path = [
            definition.id.section.name(),
            &*definition.id.name,
            "shapes",
            &*key,
        ]
        .map(Arc::from);
        let message = format!("the shape `{key}` names a symbol that is not there");
        Diagnostic::error(message).at(Span::key(&definition.file, &path), "")
    };
    unknown.map(|(key, _)| tell(key.to_string())).collect()
}

impl Description {
    /// The description of the facade `kind` with this definition. All nodes that it needs must have definitions.
    pub fn new(db: &dyn Db, job: &Job, definition: &Definition, kind: &Facade) -> Description {
        let mut parts = Parts {
            db,
            job,
            files: BTreeMap::from([(definition.id.clone(), definition.file.clone())]),
        };
        let symbols = parts.symbols();
        let layers = kind
            .layers
            .iter()
            .map(|name| parts.layer(definition, name))
            .collect();
        let range = |(c, range): &(Letter, fretwork_language::kinds::facades::CounterRange)| {
            (
                c.0,
                Range {
                    min: range.min,
                    max: range.max,
                },
            )
        };
        let facade = fretwork_facade::Facade {
            canvas: [kind.canvas.width.0, kind.canvas.height.0],
            symbols,
            counters: kind.counters.0.iter().map(range).collect(),
            layers,
        };
        Description {
            facade,
            own: definition.id.clone(),
            span: definition.span(),
            files: parts.files,
        }
    }

    /// The problem at its place.
    pub fn tell(&self, problem: &Problem) -> Diagnostic {
        problem.diagnostic(|part| match part {
            Part::Facade => self.span.clone(),
            Part::Canvas(side) => self.own_span(&["canvas", side]),
            Part::Counter(letter) => self.own_span(&["counters", &letter.to_string()]),
            part => place(part, &|id| {
                self.files.get(id).unwrap_or(self.span.file()).clone()
            }),
        })
    }

    fn own_span(&self, steps: &[&str]) -> Span {
        let path = [self.own.section.name(), &*self.own.name]
            .into_iter()
            .chain(steps.iter().copied());
        Span::value(self.span.file(), &path.map(Arc::from).collect::<Vec<_>>())
    }
}

/// The place of a part that is an entry of its own, in the file that `file` names.
fn place(part: &Part, file: &dyn Fn(&NodeId) -> Arc<str>) -> Span {
    let span = |section: Section, name: &str, steps: &[&str]| {
        let file = file(&NodeId {
            section,
            name: name.into(),
        });
        let path = [section.name(), name]
            .into_iter()
            .chain(steps.iter().copied());
        Span::value(&file, &path.map(Arc::from).collect::<Vec<_>>())
    };
    match part {
        Part::Symbol(letter, field) => {
            span(Section::Symbols, &letter.to_string(), field.as_slice())
        }
        Part::Layer(name, field) => {
            let steps: Vec<&str> = field.iter().flat_map(|field| field.split('.')).collect();
            span(Section::Layers, name, &steps)
        }
        Part::Pattern { name, text, bytes } => {
            let letter;
            let steps: &[&str] = match text {
                PatternPart::Whole => &[],
                PatternPart::Control => &["control"],
                PatternPart::Content(c) => {
                    letter = c.to_string();
                    &["content", &letter]
                }
            };
            inside(span(Section::Patterns, name, steps), bytes)
        }
        Part::Facade | Part::Canvas(_) | Part::Counter(_) => span(Section::Facades, "", &[]),
    }
}

/// Some bytes of the text that a place is.
fn inside(span: Span, bytes: &std::ops::Range<usize>) -> Span {
    match span {
        Span::Name { file, path, .. } => Span::Text {
            file,
            path,
            start: bytes.start,
            end: bytes.end,
        },
        other => other,
    }
}

/// Reads the definitions that a facade names, and notes their files.
struct Parts<'a> {
    db: &'a dyn Db,
    job: &'a Job,
    files: BTreeMap<NodeId, Arc<str>>,
}

impl Parts<'_> {
    /// Patterns name symbols by their letters, so a facade sees all symbols of its spec.
    fn symbols(&mut self) -> BTreeMap<char, fretwork_facade::Symbol> {
        let mut symbols = BTreeMap::new();
        for id in self.job.nodes_of(self.db, Section::Symbols) {
            let Some(definition) = self.definition(&id) else {
                continue;
            };
            let (Node::Symbol(symbol), Some(letter)) = (&definition.node, id.name.chars().next())
            else {
                continue;
            };
            let attributes = fretwork_facade::Symbol {
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

    fn layer(&mut self, from: &Definition, name: &Ref<wants::Layer>) -> fretwork_facade::Layer {
        let definition = self.of(from, name);
        let Node::Layer(layer) = &definition.node else {
            unreachable!("the graph checks that it is a layer")
        };
        let Layer {
            x,
            y,
            visible,
            group,
        } = layer;
        let seen = |axis: Option<&List<Letter>>| {
            axis.map(|letters| letters.iter().map(|letter| letter.0).collect())
        };
        let visible = visible.as_ref();
        fretwork_facade::Layer {
            name: definition.id.name.clone(),
            patterns: [self.pattern(&definition, x), self.pattern(&definition, y)],
            groups: [group.x.0.clone(), group.y.0.clone()],
            visible: [
                seen(visible.and_then(|v| v.x.as_ref())),
                seen(visible.and_then(|v| v.y.as_ref())),
            ],
        }
    }

    fn pattern(&mut self, layer: &Definition, name: &Ref<wants::Pattern>) -> PatternText {
        let definition = self.of(layer, name);
        let Node::Pattern(kind) = &definition.node else {
            unreachable!("the graph checks that it is a pattern")
        };
        pattern(&definition.id.name, kind)
    }

    fn of<T: Wanted>(&mut self, from: &Definition, name: &Ref<T>) -> Arc<Definition> {
        self.definition(from.target(name))
            .expect("a facade is described only when all it names has definitions")
    }

    fn definition(&mut self, id: &NodeId) -> Option<Arc<Definition>> {
        let definition = self.job.of(id, None).definition(self.db)?;
        self.files.insert(id.clone(), definition.file.clone());
        Some(definition)
    }
}

fn pattern(name: &Arc<str>, kind: &Pattern) -> PatternText {
    match kind {
        Pattern::Plain(text) => PatternText {
            name: name.clone(),
            control: text.0.clone(),
            content: None,
        },
        Pattern::Substituted(pattern) => PatternText {
            name: name.clone(),
            control: pattern.control.0.clone(),
            content: Some(
                pattern
                    .content
                    .iter()
                    .map(|(letter, text)| (letter.0, text.0.clone()))
                    .collect(),
            ),
        },
    }
}
