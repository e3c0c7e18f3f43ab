//! Arrangements and mappers that scripts make, as a spec declares them.

use std::sync::Arc;

use crate::from_spec::argument::arguments;
use crate::from_spec::combine::mapped;
use crate::from_spec::context::{Context, Declared};
use crate::function::{Arrangement, Manner};
use crate::near::operators::{Mapped, mapped as mapped_near};
use crate::script::mapping::{Items, Reach};
use crate::script::program::{Mapper, Script, Task};
use crate::tiled::regularity::Irregular;
use crate::tiled::varied::Varied;
use fretwork_diagnostic::{Diagnostic, Label, Span};
use fretwork_language::kinds::arrangements as kinds;
use fretwork_language::kinds::arrangements::{Cells, MapCells};
use fretwork_script::CellKind;
use fretwork_script::watch::Watch;

/// Every cell replaced by what a script makes of it; `name` is the key of the kind.
///
/// # Errors
/// When the script does not compile or has no such entry.
pub fn map(kind: &MapCells, name: &str, context: &Context<'_>) -> Declared {
    let site = Site::of(name, context);
    let mapper = mapper(&kind.with, context)
        .map_err(|diagnostics| site.places(&diagnostics))?
        .in_steps(context.step)
        .within(reach(kind, name, context.unit));
    let (cells, input) = match &kind.cells {
        Cells::Vertices(input) => (CellKind::Vertex, input),
        Cells::Edges(input) => (CellKind::Edge, input),
        Cells::Faces(input) => (CellKind::Face, input),
    };
    let (input, span) = (context.inputs.arrangement(input), context.span.clone());
    let of_input = input.regularity().cloned().map_err(Irregular::clone);
    let site = Arc::new(site);
    let near = Mapped {
        input: input.clone(),
        kind: cells,
        mapper: mapper.clone(),
        span: span.clone(),
        place: {
            let own = site.clone();
            Arc::new(move |diagnostics: &[Diagnostic]| own.places(diagnostics))
        },
    };
    let (own, varied) = (site.clone(), name == "vary");
    let last = Varied {
        kind: cells,
        input: input.clone(),
        mapper: mapper.clone(),
        place: Arc::new(move |diagnostics: &[Diagnostic]| own.places(diagnostics)),
    };
    let regularity = match varied {
        true => Err(Irregular::new("it varies what is repeated").at(&span)),
        false => of_input,
    };
    let made = Arrangement::with(regularity, move |region, resolution, manner| {
        let drawn = input.apply_as(region, resolution, manner)?;
        let map = Arc::new(mapped(&drawn, resolution, manner, &span)?);
        let watch = match manner {
            Manner::Free => None,
            Manner::Regular(patch) => Some(Watch {
                allows_random: false,
                deep: patch.deep,
            }),
        };
        let task = Task {
            kind: cells,
            map,
            items: Items::All,
            watch,
            known: None,
        };
        let curves = mapper.map_cells(task, region, resolution);
        curves
            .map(Arc::new)
            .map_err(|diagnostics| site.places(&diagnostics))
    });
    let made = made.local_by(mapped_near(near));
    Ok(if varied { made.varying(last) } else { made })
}

/// What `map` or `vary`, whichever is the `name`, promises of its curves.
fn reach(kind: &MapCells, name: &str, unit: f64) -> Reach {
    match kind.reach {
        Some(length) => Reach::Length(length.0 / unit),
        None if name == "vary" => Reach::Diagonal,
        None => Reach::Any,
    }
}

/// A whole arrangement that a script makes.
///
/// # Errors
/// When the script does not compile or has no such entry.
pub fn script(kind: &kinds::Script, context: &Context<'_>) -> Declared {
    let site = Site::of("script", context);
    let args = arguments(&kind.args, context);
    let made = compiled(kind, context)
        .and_then(|script| script.arrangement(&kind.entry.0, &args, context.seed));
    let made = made
        .map_err(|diagnostics| site.places(&diagnostics))?
        .in_steps(context.step);
    let regularity = made.regularity().map_err(|why| why.at(&context.span));
    Ok(Arrangement::with(
        regularity,
        move |region, resolution, manner| {
            made.evaluate_as(region, resolution, manner)
                .map_err(|diagnostics| site.places(&diagnostics))
        },
    ))
}

/// Compiles the scripts of an arrangement without calling anything in them.
///
/// # Errors
/// What is wrong with their syntax, with names, or at their tops.
pub fn check(kind: &kinds::Arrangement, context: &Context<'_>) -> Result<(), Vec<Diagnostic>> {
    let entered = |script: &kinds::Script| compiled(script, context)?.check_entry(&script.entry.0);
    let checked = match kind {
        kinds::Arrangement::Script(script) => entered(script),
        kinds::Arrangement::Map(map) | kinds::Arrangement::Vary(map) => match &map.with {
            kinds::Mapper::Script(script) => entered(script),
            inline @ kinds::Mapper::Inline(_) => mapper(inline, context).map(drop),
        },
        _ => Ok(()),
    };
    checked.map_err(|diagnostics| Site::of(kind.kind(), context).places(&diagnostics))
}

fn mapper(with: &kinds::Mapper, context: &Context<'_>) -> Result<Mapper, Vec<Diagnostic>> {
    match with {
        kinds::Mapper::Script(kind) => compiled(kind, context)?.mapper(
            &kind.entry.0,
            &arguments(&kind.args, context),
            context.seed,
        ),
        kinds::Mapper::Inline(text) => {
            Script::compile(context.span.file(), &text.0, context.inputs.host())
                .and_then(|script| script.inline_mapper(context.seed))
        }
    }
}

fn compiled(kind: &kinds::Script, context: &Context<'_>) -> Result<Script, Vec<Diagnostic>> {
    let (file, text) = context.inputs.script(&kind.file)?;
    Script::compile(&file, &text, context.inputs.host())
}

/// Where a script is used: the entry that names it, or holds it.
struct Site {
    entry: Span,
    /// Where a script that stands in the entry itself is.
    text: Vec<Arc<str>>,
}

impl Site {
    fn of(kind: &str, context: &Context<'_>) -> Site {
        let entry = match &context.span {
            Span::Name { path, .. } => path.as_slice(),
            Span::File(_) | Span::Text { .. } | Span::Bytes { .. } => &[],
        };
        let text = entry
            .iter()
            .cloned()
            .chain([kind.into(), "with".into()])
            .collect();
        Site {
            entry: context.span.clone(),
            text,
        }
    }

    /// The same diagnostics where bytes of an inline script are bytes of the value that holds it, what
    /// has no place in a script stands at the entry, and the entry is among the places.
    fn places(&self, diagnostics: &[Diagnostic]) -> Vec<Diagnostic> {
        let file = self.entry.file();
        let moved = |label: &Label| {
            let span = match &label.span {
                Span::Bytes {
                    file: script,
                    start,
                    end,
                } if script == file => Span::Text {
                    file: file.clone(),
                    path: self.text.clone(),
                    start: *start,
                    end: *end,
                },
                Span::File(_) => self.entry.clone(),
                other => other.clone(),
            };
            Label {
                span,
                text: label.text.clone(),
            }
        };
        let placed = |diagnostic: &Diagnostic| {
            let placed = Diagnostic {
                labels: diagnostic.labels.iter().map(moved).collect(),
                ..diagnostic.clone()
            };
            if placed.labels.iter().any(|label| label.span.file() == file) {
                placed
            } else {
                placed.at(self.entry.clone(), "in this arrangement")
            }
        };
        diagnostics.iter().map(placed).collect()
    }
}
