//! Arrangements and mappers that scripts make, as a spec declares them.

use std::sync::Arc;

use super::combine::planar_map;
use super::{Context, Declared};
use crate::arrangement::{Argument, Arrangement, Mapper, Script};
use crate::diagnostic::{Diagnostic, Label, Span};
use crate::script::{CellKind, Value};
use crate::spec::kinds::arrangements as kinds;
use crate::spec::kinds::arrangements::{Cells, MapCells};
use crate::spec::value::Arguments;
use crate::spec::{Tree, Wanted as _, wants};

/// Every cell replaced by what a script makes of it; `name` is the key of the kind.
///
/// # Errors
/// When the script does not compile or has no such entry.
pub fn map(kind: &MapCells, name: &str, context: &Context<'_>) -> Declared {
    let inline = Inline::of(name, context);
    let mapper = mapper(&kind.with, &inline, context)?;
    let (cells, input) = match &kind.cells {
        Cells::Vertices(input) => (CellKind::Vertex, input),
        Cells::Edges(input) => (CellKind::Edge, input),
        Cells::Faces(input) => (CellKind::Face, input),
    };
    let (input, span) = (context.inputs.arrangement(input), context.span.clone());
    Ok(Arrangement::new(move |region, resolution| {
        let map = Arc::new(planar_map(&*input.apply(region, resolution)?, resolution, &span)?);
        let curves = mapper.map_cells(cells, map, region, resolution);
        curves.map(Arc::new).map_err(|diagnostics| inline.places(&diagnostics))
    }))
}

/// A whole arrangement that a script makes.
///
/// # Errors
/// When the script does not compile or has no such entry.
pub fn script(kind: &kinds::Script, context: &Context<'_>) -> Declared {
    let args = arguments(&kind.args, context);
    let made = compiled(kind, context)?.arrangement(&kind.entry.0, &args, context.seed)?;
    Ok(Arrangement::new(move |region, resolution| made.evaluate(region, resolution)))
}

/// Compiles the scripts of an arrangement without calling anything in them.
///
/// # Errors
/// What is wrong with their syntax, with names, or at their tops.
pub fn check(kind: &kinds::Arrangement, context: &Context<'_>) -> Result<(), Vec<Diagnostic>> {
    let entered = |script: &kinds::Script| compiled(script, context)?.check_entry(&script.entry.0);
    match kind {
        kinds::Arrangement::Script(script) => entered(script),
        kinds::Arrangement::Map(map) | kinds::Arrangement::Vary(map) => match &map.with {
            kinds::Mapper::Script(script) => entered(script),
            inline @ kinds::Mapper::Inline(_) => mapper(inline, &Inline::of(kind.kind(), context), context).map(drop),
        },
        _ => Ok(()),
    }
}

fn mapper(with: &kinds::Mapper, inline: &Inline, context: &Context<'_>) -> Result<Mapper, Vec<Diagnostic>> {
    match with {
        kinds::Mapper::Script(kind) => {
            compiled(kind, context)?.mapper(&kind.entry.0, &arguments(&kind.args, context), context.seed)
        }
        kinds::Mapper::Inline(text) => Script::compile(context.span.file(), &text.0, context.inputs.host())
            .and_then(|script| script.inline_mapper(context.seed))
            .map_err(|diagnostics| inline.places(&diagnostics)),
    }
}

fn compiled(kind: &kinds::Script, context: &Context<'_>) -> Result<Script, Vec<Diagnostic>> {
    let (file, text) = context.inputs.script(&kind.file)?;
    Script::compile(&file, &text, context.inputs.host())
}

fn arguments(arguments: &Arguments, context: &Context<'_>) -> Vec<(Arc<str>, Argument)> {
    arguments.0.iter().map(|(name, tree)| (name.clone(), argument(tree, context))).collect()
}

/// The value of an argument: text that names a node stands for the node's value.
fn argument(tree: &Tree, context: &Context<'_>) -> Argument {
    match tree {
        Tree::Text(text) => match context.inputs.argument(text, wants::Argument::TYPES) {
            Some(Named::Element(curves)) => Argument::Curves(curves),
            Some(Named::Field(field)) => Argument::Field(field),
            Some(Named::Arrangement(arrangement)) => Argument::Arrangement(arrangement),
            None => Argument::Value(plain(tree)),
        },
        Tree::List(items) => Argument::List(items.iter().map(|item| argument(item, context)).collect()),
        tree => Argument::Value(plain(tree)),
    }
}

/// A value in which names stand for themselves.
fn plain(tree: &Tree) -> Value {
    match tree {
        Tree::Null => Value::None,
        Tree::Bool(b) => Value::Bool(*b),
        Tree::Int(n) => Value::Int(*n),
        Tree::Float(x) => Value::Float(x.get()),
        Tree::Text(text) => Value::Text(text.clone()),
        Tree::List(items) => Value::List(items.iter().map(plain).collect()),
        Tree::Map(entries) => Value::Dict(entries.iter().map(|(k, v)| (Value::Text(k.clone()), plain(v))).collect()),
    }
}

/// What the name of a node stands for among a script's arguments.
pub enum Named {
    /// An element.
    Element(Arc<crate::geometry::Curves>),
    /// A function of the plane.
    Field(crate::geometry::Field),
    /// A function of regions.
    Arrangement(Arrangement),
}

/// The place of a script that stands in a spec.
struct Inline {
    file: Arc<str>,
    path: Vec<Arc<str>>,
}

impl Inline {
    fn of(kind: &str, context: &Context<'_>) -> Inline {
        let entry = match &context.span {
            Span::Name { path, .. } => path.as_slice(),
            Span::File(_) | Span::Text { .. } | Span::Bytes { .. } => &[],
        };
        let path = entry.iter().cloned().chain([kind.into(), "with".into()]).collect();
        Inline { file: context.span.file().clone(), path }
    }

    /// The same diagnostics where bytes of the script are bytes of the value that holds it.
    fn places(&self, diagnostics: &[Diagnostic]) -> Vec<Diagnostic> {
        let moved = |label: &Label| match &label.span {
            Span::Bytes { file, start, end } if *file == self.file => {
                let span = Span::Text { file: file.clone(), path: self.path.clone(), start: *start, end: *end };
                Label { span, text: label.text.clone() }
            }
            Span::File(file) if *file == self.file => {
                Label { span: Span::key(file, &self.path), text: label.text.clone() }
            }
            _ => label.clone(),
        };
        diagnostics.iter().map(|d| Diagnostic { labels: d.labels.iter().map(moved).collect(), ..d.clone() }).collect()
    }
}
