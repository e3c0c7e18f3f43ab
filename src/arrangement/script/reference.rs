//! The reference of the functions of scripts, written from the table that registers them, so that none can be missing. What
//! the operators mean in full is in `SEMANTICS.md`.

use starlark::docs::{DocItem, DocMember, DocParams};
use starlark::environment::GlobalsBuilder;

use crate::script::operators::{ALIASES, GROUPS};
use fretwork_script::numbers::{self, Explained};

const INTRODUCTION: &str = "\
# The functions of scripts

This page is made from the table that registers the functions; `fretwork schema --functions` prints it. [Mappers in ten minutes](mappers.md) shows
how they are used. Angles are radians, from +x toward +y; lengths are in the spec's unit; y points down in the plane of drawings, and
north in that of a map. What stands in brackets may be left out.
";

/// The page, in Markdown.
pub fn functions_reference() -> String {
    let mut out = String::from(INTRODUCTION);
    for (title, register) in GROUPS {
        out += &format!("\n## {title}\n");
        let globals = GlobalsBuilder::new().with(register).build();
        for (name, item) in globals.documentation().members {
            if let DocItem::Member(DocMember::Function(function)) = item {
                let docs = function.docs.as_ref();
                let summary = docs.map_or("", |docs| &docs.summary);
                let details = docs.and_then(|docs| docs.details.as_deref()).unwrap_or("");
                let signature = signature(&name, &function.params);
                out += &format!("\n### `{signature}`\n\n{summary}\n\n{details}\n");
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
