//! The reference of the functions of scripts, written from the table that registers them, so that none can be missing. What
//! the operators mean in full is in `SEMANTICS.md`.

use starlark::docs::{DocFunction, DocItem, DocMember, DocParams};
use starlark::environment::GlobalsBuilder;

use crate::script::operators::{ALIASES, GROUPS};
use fretwork_script::numbers::{self, Explained};

const INTRODUCTION: &str = "\
# The functions of scripts

This page is made from the table that registers the functions; `fretwork schema --functions` prints it. [Mappers in ten minutes](mappers.md) shows
how they are used. Angles are radians, from +x toward +y; lengths are in the spec's unit; y points down in the plane of drawings, and
north in that of a map. What stands in brackets may be left out.

A picture is what the build makes of the example. What the example gives is orange; the cell that it is given is blue, an edge with its direction;
all else is grey. Labels of lines have colours of their own, and faces with the label `odd` or `big` are shaded. Where an example asks for a yes or no,
the cells with a yes are orange.
Functions that give a number have no picture, nor has `nothing`: there is nothing to be drawn.
";

/// The functions without a picture: what they give cannot be drawn.
const UNPICTURED: [&str; 4] = ["bbox_height", "bbox_width", "nothing", "random"];

/// A function of scripts whose example can be drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pictured {
    /// Its name.
    pub name: String,
    /// A statement that calls it. Which names it may use is up to who draws it.
    pub example: String,
}

/// The functions whose examples have pictures in the reference, in its order.
pub fn pictured_functions() -> Vec<Pictured> {
    let mut all = Vec::new();
    for (_, register) in GROUPS {
        for (name, function) in documented(register) {
            if UNPICTURED.contains(&&*name) {
                continue;
            }
            let (_, details) = texts(&function);
            let example = details.split_once(EXAMPLE).map_or("", |(_, rest)| rest);
            let example = example.trim_end_matches('`').to_owned();
            all.push(Pictured { name, example });
        }
    }
    all
}

/// How the example begins in the text of a function.
const EXAMPLE: &str = "Example: `";

/// The functions of a title, by name.
fn documented(register: fn(&mut GlobalsBuilder)) -> Vec<(String, DocFunction)> {
    let globals = GlobalsBuilder::new().with(register).build();
    let members = globals.documentation().members.into_iter();
    let functions = members.filter_map(|(name, item)| match item {
        DocItem::Member(DocMember::Function(function)) => Some((name, function)),
        _ => None,
    });
    functions.collect()
}

/// What a function does, and on what it fails with its example.
fn texts(function: &DocFunction) -> (&str, &str) {
    let docs = function.docs.as_ref();
    let details = docs.and_then(|docs| docs.details.as_deref());
    (docs.map_or("", |docs| &docs.summary), details.unwrap_or(""))
}

/// The page, in Markdown.
pub fn functions_reference() -> String {
    let mut out = String::from(INTRODUCTION);
    for (title, register) in GROUPS {
        out += &format!("\n## {title}\n");
        for (name, function) in documented(register) {
            let (summary, details) = texts(&function);
            let signature = signature(&name, &function.params);
            out += &format!("\n### `{signature}`\n\n{summary}\n\n{details}\n");
            if !UNPICTURED.contains(&&*name) {
                out += &format!("\n![What the example gives](functions/{name}.svg)\n");
            }
        }
    }
    out += "\n## Other names\n\nThese are the same functions: those of tiled planar maps, and older names.\n\n";
    for (alias, name) in ALIASES {
        out += &format!("- `{alias}`: `{name}`\n");
    }
    for (title, introduction, names) in NAMES {
        out += &format!("\n## {title}\n\n{introduction}\n");
        for name in names {
            out += &explained(name);
        }
    }
    out
}

/// What scripts, `${…}` and formulas know beside the operators.
const NAMES: [(&str, &str, &[Explained]); 3] = [
    (
        "Constants",
        "Numbers with a name, in scripts, in `${…}` and in formulas of fields.",
        &numbers::CONSTANTS,
    ),
    (
        "Numbers",
        "Functions of numbers, in scripts, in `${…}` and in formulas of fields. They fail on what is no number.",
        &numbers::NUMBERS,
    ),
    (
        "Values",
        "Functions of lists, texts and tables, in scripts and in `${…}`; formulas of fields have numbers alone.",
        &numbers::STANDARD,
    ),
];

/// An entry of the page.
fn explained(name: &Explained) -> String {
    let fails = match name.fails {
        "" => "Never fails.".to_owned(),
        fails => format!("Fails on {fails}."),
    };
    format!(
        "\n### `{}`\n\n{}\n\n{fails}\n\nExample: `{}` is `{}`\n",
        name.call, name.summary, name.example, name.value
    )
}

/// A call as it is written.
fn signature(name: &str, params: &DocParams) -> String {
    let mut parts: Vec<String> = Vec::new();
    for param in params.pos_only.iter().chain(&params.pos_or_named) {
        parts.push(match param.default_value {
            None => param.name.clone(),
            Some(_) => format!("[{}]", param.name),
        });
    }
    parts.extend(params.args.iter().map(|args| format!("*{}", args.name)));
    parts.extend(
        params
            .named_only
            .iter()
            .map(|param| format!("[{}]", param.name)),
    );
    format!("{name}({})", parts.join(", "))
}
