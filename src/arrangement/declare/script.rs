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

/// Every cell replaced by what a script makes of it.
///
/// # Errors
/// When the script does not compile or has no such entry.
pub fn map(kind: &MapCells, context: &Context<'_>) -> Declared {
    let mapper = mapper(&kind.with, context)?;
    let (cells, input) = match &kind.cells {
        Cells::Vertices(input) => (CellKind::Vertex, input),
        Cells::Edges(input) => (CellKind::Edge, input),
        Cells::Faces(input) => (CellKind::Face, input),
    };
    let (input, span) = (context.inputs.arrangement(input), context.span.clone());
    Ok(Arrangement::new(move |region, resolution| {
        let map = Arc::new(planar_map(&*input.apply(region, resolution)?, resolution, &span)?);
        let curves = mapper.map_cells(cells, map, region, resolution);
        curves.map(Arc::new).map_err(|diagnostics| at_entry(&diagnostics, &span))
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

fn mapper(with: &kinds::Mapper, context: &Context<'_>) -> Result<Mapper, Vec<Diagnostic>> {
    match with {
        kinds::Mapper::Script(kind) => {
            compiled(kind, context)?.mapper(&kind.entry.0, &arguments(&kind.args, context), context.seed)
        }
        kinds::Mapper::Inline(text) => Script::compile(context.span.file(), &text.0, context.inputs.host())
            .and_then(|script| script.inline_mapper(context.seed))
            .map_err(|diagnostics| at_entry(&diagnostics, &context.span)),
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

/// Diagnostics of a script that stands in a spec: their places are bytes of the script's text, which
/// the entry holds, so they are told by line, at the entry.
fn at_entry(diagnostics: &[Diagnostic], span: &Span) -> Vec<Diagnostic> {
    let moved = |label: &Label| match &label.span {
        Span::Bytes { file, .. } if file == span.file() => Label { span: span.clone(), text: label.text.clone() },
        _ => label.clone(),
    };
    diagnostics.iter().map(|d| Diagnostic { labels: d.labels.iter().map(moved).collect(), ..d.clone() }).collect()
}
