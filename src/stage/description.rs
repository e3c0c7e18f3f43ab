//! Facades as their room takes them: symbols, patterns and layers collected by name, and the places
//! of what is wrong with them. Also what can be said about patterns before anything is laid out.

use std::collections::BTreeMap;
use std::sync::Arc;

use fretwork_action::{Action, Definition, Described, Input};
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_facade::{self as facade, Part, PatternPart, PatternText, Problem, Range};
use fretwork_graph::NodeId;
use fretwork_language::kinds::facades::{CounterRange, Facade, ShapeKey};
use fretwork_language::kinds::layers::Layer;
use fretwork_language::kinds::patterns::Pattern;
use fretwork_language::scalar::Letter;
use fretwork_language::value::List;
use fretwork_language::{Node, Section, wants};

/// A facade's description, and the files that its parts stand in.
pub struct Description {
    /// What the room is given.
    pub facade: facade::Description,
    own: NodeId,
    span: Span,
    files: BTreeMap<NodeId, Arc<str>>,
}

/// The mistakes in the patterns of the action's facade, or in the action's own pattern, that do not need
/// a layout. Of its values an action needs only those that are definitions.
pub fn check(action: &Action) -> Vec<Diagnostic> {
    let file = |_: &NodeId| action.definition.file.clone();
    match &action.definition.node {
        Node::Pattern(kind) => {
            let problems = facade::pattern_mistakes(&pattern(&action.definition.id.name, kind));
            let told = problems
                .iter()
                .map(|p| p.diagnostic(|part| place(part, &file)));
            told.collect()
        }
        Node::Facade(kind) => {
            let description = Description::new(action, kind);
            let mut diagnostics: Vec<Diagnostic> = facade::check(&description.facade)
                .iter()
                .map(|problem| description.tell(problem))
                .collect();
            let unknown = unknown_letters(&description, &action.definition, kind);
            if unknown.is_empty() {
                diagnostics.extend(idle_shapes(&description, &action.definition, kind));
            }
            diagnostics.extend(unknown);
            diagnostics
        }
        _ => Vec::new(),
    }
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
    let tell = |key: &ShapeKey| {
        let message = format!("the shape `{key}` names a symbol that is not there");
        Diagnostic::error(message).at(key_span(definition, key), "")
    };
    unknown.map(|(key, _)| tell(key)).collect()
}

/// Warnings for keys of shapes that match no cell.
fn idle_shapes(
    description: &Description,
    definition: &Definition,
    kind: &Facade,
) -> Vec<Diagnostic> {
    let idle = facade::idle_shapes(&description.facade, &kind.shapes);
    let warning = |number: usize| {
        let key = &kind.shapes.0[number].0;
        Diagnostic::warning(format!("the shape `{key}` matches no cell of the facade"))
            .at(key_span(definition, key), "")
            .help("the first letter is the symbol along x, the second the one along y")
    };
    idle.into_iter().map(warning).collect()
}

/// The place of a shape's key.
fn key_span(definition: &Definition, key: &ShapeKey) -> Span {
    let key = key.to_string();
    let path = [
        definition.id.section.name(),
        &*definition.id.name,
        "shapes",
        &*key,
    ];
    Span::key(&definition.file, &path.map(Arc::from))
}

impl Description {
    /// The description of the facade `kind`.
    pub fn new(action: &Action, kind: &Facade) -> Description {
        let definition = &action.definition;
        let mut files = BTreeMap::from([(definition.id.clone(), definition.file.clone())]);
        let symbols = symbols(action, &mut files);
        let layers = kind
            .layers
            .iter()
            .map(|name| {
                let layer = action.input(name);
                let patterns = [&layer.kind.x, &layer.kind.y].map(|name| layer.action.input(name));
                self::layer(&layer, patterns, &mut files)
            })
            .collect();
        let range = |(letter, range): &(Letter, CounterRange)| {
            let (min, max) = (range.min, range.max);
            (letter.0, Range { min, max })
        };
        let facade = facade::Description {
            canvas: [kind.canvas.width.0, kind.canvas.height.0],
            symbols,
            counters: kind.counters.0.iter().map(range).collect(),
            layers,
        };
        Description {
            facade,
            own: definition.id.clone(),
            span: definition.span(),
            files,
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

/// Patterns name symbols by their letters, so a facade sees all symbols of its spec.
fn symbols(
    action: &Action,
    files: &mut BTreeMap<NodeId, Arc<str>>,
) -> BTreeMap<char, facade::Symbol> {
    let mut symbols = BTreeMap::new();
    for value in action.values.values() {
        let Some(Described { action, kind }) = <wants::Symbol as Input>::of(value) else {
            continue;
        };
        let definition = &action.definition;
        files.insert(definition.id.clone(), definition.file.clone());
        let attributes = facade::Symbol {
            size: kind.size.as_ref().map(|size| size.0),
            opaque: kind.opaque,
            attached: kind.attached,
            unoccludable: kind.unoccludable,
            fixed: kind.fixed,
            weight: kind.weight.0,
        };
        symbols.extend(
            definition
                .own_name()
                .chars()
                .next()
                .map(|letter| (letter, attributes)),
        );
    }
    symbols
}

fn layer(
    Described { action, kind }: &Described<Layer>,
    patterns: [Described<Pattern>; 2],
    files: &mut BTreeMap<NodeId, Arc<str>>,
) -> facade::Layer {
    let [x, y] = &patterns;
    for part in [action, &x.action, &y.action] {
        let definition = &part.definition;
        files.insert(definition.id.clone(), definition.file.clone());
    }
    let letters = |axis: &List<Letter>| axis.iter().map(|letter| letter.0).collect();
    let visible = kind.visible.as_ref();
    facade::Layer {
        name: action.definition.id.name.clone(),
        patterns: patterns.map(|p| pattern(&p.action.definition.id.name, &p.kind)),
        groups: [kind.group.x.0.clone(), kind.group.y.0.clone()],
        visible: [
            visible.and_then(|v| v.x.as_ref()).map(letters),
            visible.and_then(|v| v.y.as_ref()).map(letters),
        ],
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
