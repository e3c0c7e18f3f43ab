//! The reference page of the language, written from its JSON Schema, so that the page, the schema
//! and the types cannot differ.

use serde_json::{Map, Value, json};

use super::Section;
use super::document::HEAD;
use super::record::{ORDER, listed};
use super::schema::ordered_schema;
use super::types::with_article;

const INTRODUCTION: &str = "\
# The fretwork spec language

This page is made from the types that read a spec; `fretwork schema --reference` prints it. `fretwork schema` prints the JSON Schema that
editors use: put `# yaml-language-server: $schema=PATH` in the first line of a spec.

A spec is a YAML file. It begins with `fretwork: 1`; after the [head](#the-head-of-a-file) come sections, each a map of names to entries:

```yaml
fretwork: 1
regions:
  page: { rectangle: { width: 210, height: 297 } }
artifacts:
  page.svg: { from: page }
```

- In most sections an entry is `name: { kind: { fields } }`; in sections of one kind it is `name: { fields }`.
- Any entry may carry `seed:` (a whole number, the root of its randomness instead of its name) and `doc:` (what it is for).
- A name is made of letters, digits, `_` and `-`, and is unique in its section. To refer to an entry, write its name, or `section.name` where
  entries of that name in several sections would fit.
- `${expression}` may stand in any quoted text; `$${` is a plain `${`. Text that is one expression and nothing else becomes its value.
- A file is relative to the file that names it.
- What expressions make has at most 1,048,576 bytes or elements, and all values of `let` four times as many together. How much work a node may be is
  the [budget](ci.md#what-a-build-may-use) of a build, which `--budget` raises.

In the tables, *required* fields have no default, and a dash means that the field may be left out. Where a type is called *name of …*, the
value is the name of an entry.
";

/// A spec that has an entry of every kind.
const EXAMPLES: &str = include_str!("examples.yaml");

/// The reference page, in Markdown.
pub fn reference() -> String {
    let schema = ordered_schema();
    let mut out = String::from(INTRODUCTION);
    out += "\n## The head of a file\n\n";
    let head = schema["properties"]
        .as_object()
        .cloned()
        .unwrap_or_default();
    out += &table(&head, &json!({ ORDER: HEAD }), &["fretwork"]);
    out += &format!(
        "\nA param is its default alone, or a map of these fields:\n\n{}",
        param_table(&schema)
    );
    out += &format!("\n`map` has these fields:\n\n{}", map_tables(&schema));
    for section in Section::ALL {
        out += &section_text(*section, &schema["properties"][section.name()]);
    }
    out + &types_text(&schema["definitions"])
}

/// The fields of the head `map`, and those of its tiles.
fn map_tables(schema: &Value) -> String {
    let map = &schema["properties"]["map"]["anyOf"][0];
    object_table(map)
}

fn param_table(schema: &Value) -> String {
    let form = &schema["properties"]["params"]["additionalProperties"]["anyOf"][1];
    object_table(form)
}

fn section_text(section: Section, schema: &Value) -> String {
    let entry = &schema["additionalProperties"];
    let gives = with_article(&section.types().describe());
    let example = example(section);
    let mut out = format!(
        "\n## {}\n\n{}\n\nAn entry gives {gives}.\n\n```yaml\n{example}```\n",
        section.name(),
        description(entry)
    );
    if section.kinds().is_empty() {
        out += &fields_or_forms(entry);
        return out;
    }
    for kind in section.kinds() {
        let payload = &entry["properties"][*kind];
        out += &format!(
            "\n### {}: {kind}\n\n{}\n",
            section.name(),
            description(payload)
        );
        out += &fields_or_forms(payload);
    }
    out
}

/// The lines of the example file that belong to a section.
fn example(section: Section) -> String {
    let first = format!("{}:", section.name());
    let mut lines = EXAMPLES.lines().skip_while(|line| *line != first);
    let head = lines.next().into_iter();
    let body = lines.take_while(|line| line.starts_with(' '));
    head.chain(body).map(|line| format!("{line}\n")).collect()
}

/// A table of fields, or what the value is.
fn fields_or_forms(schema: &Value) -> String {
    if schema["properties"].is_object() {
        return format!("\n{}", object_table(schema));
    }
    let value = type_text(schema).unwrap_or_default();
    format!("\nThe value is {value}.\n") + &form_tables(schema)
}

/// The tables of those forms of a value that have fields.
fn form_tables(schema: &Value) -> String {
    let forms = schema["anyOf"].as_array().into_iter().flatten();
    let with_fields = forms.filter(|form| form["properties"].is_object());
    with_fields
        .map(|form| format!("\n{}", object_table(form)))
        .collect()
}

fn object_table(schema: &Value) -> String {
    let required: Vec<&str> = strings(&schema["required"]);
    match schema["properties"].as_object() {
        Some(properties) if !properties.is_empty() && schema[ORDER].is_null() => {
            let names: Vec<String> = properties.keys().map(|name| format!("`{name}`")).collect();
            format!("It may hold {}.\n", names.join(", "))
        }
        Some(properties) if !properties.is_empty() => table(properties, schema, &required),
        _ => "It has no fields.\n".to_owned(),
    }
}

fn strings(value: &Value) -> Vec<&str> {
    value
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(Value::as_str)
        .collect()
}

fn table(properties: &Map<String, Value>, owner: &Value, required: &[&str]) -> String {
    let mut out = String::from("| field | type | default | meaning |\n| --- | --- | --- | --- |\n");
    for name in strings(&owner[ORDER]) {
        let schema = &properties[name];
        let default = match (&schema["default"], alternatives(owner, name)) {
            (Value::Null, Some(names)) => format!("one of {}", listed(&names, "or")),
            (Value::Null, None) if required.contains(&name) => "*required*".to_owned(),
            (Value::Null, None) => "–".to_owned(),
            (default, _) => format!("`{}`", default_text(default)),
        };
        let cells = [
            format!("`{name}`"),
            type_text(schema).unwrap_or_default(),
            default,
            description(schema),
        ];
        out += &format!(
            "| {} |\n",
            cells
                .map(|cell| cell.replace('\n', " ").replace('|', "\\|"))
                .join(" | ")
        );
    }
    out
}

/// The default as it is written in YAML.
fn default_text(default: &Value) -> String {
    match default {
        Value::String(text) => text.clone(),
        Value::Object(fields) => {
            let fields: Vec<String> = fields
                .iter()
                .map(|(k, v)| format!("{k}: {}", default_text(v)))
                .collect();
            if fields.is_empty() {
                "{}".to_owned()
            } else {
                format!("{{ {} }}", fields.join(", "))
            }
        }
        Value::Array(items) => format!(
            "[{}]",
            items
                .iter()
                .map(default_text)
                .collect::<Vec<_>>()
                .join(", ")
        ),
        other => other.to_string(),
    }
}

/// The fields of which `name` is one and the map holds exactly one.
fn alternatives<'s>(owner: &'s Value, name: &str) -> Option<Vec<&'s str>> {
    let nested = owner["allOf"]
        .as_array()
        .into_iter()
        .flatten()
        .map(|part| &part["oneOf"]);
    let groups = std::iter::once(&owner["oneOf"])
        .chain(nested)
        .filter_map(Value::as_array);
    groups
        .map(|group| {
            group
                .iter()
                .flat_map(|one| strings(&one["required"]))
                .collect::<Vec<&str>>()
        })
        .find(|names| names.contains(&name))
}

fn description(schema: &Value) -> String {
    schema["description"]
        .as_str()
        .unwrap_or_default()
        .to_owned()
}

/// What a value is, in words; nothing for null and for expressions, which need no mention.
fn type_text(schema: &Value) -> Option<String> {
    if let Some(reference) = schema["$ref"].as_str() {
        let name = reference.rsplit('/').next().unwrap_or_default();
        return match name {
            "Expression" => None,
            _ => Some(match name.strip_prefix("NameOf") {
                Some(_) => format!(
                    "[name of {}](#{})",
                    with_article(&spaced(&name[6..])),
                    name.to_lowercase()
                ),
                None => format!("[{name}](#{})", name.to_lowercase()),
            }),
        };
    }
    if let Some(forms) = schema["anyOf"].as_array() {
        let mut texts: Vec<String> = forms.iter().filter_map(type_text).collect();
        texts.dedup();
        return Some(texts.join(" or ")).filter(|text| !text.is_empty());
    }
    if let Some(words) = schema["enum"].as_array() {
        let words: Vec<&str> = words.iter().filter_map(Value::as_str).collect();
        return Some(listed(&words, "or"));
    }
    if !schema["const"].is_null() {
        return Some(format!("`{}`", schema["const"]));
    }
    if schema["properties"].is_object() {
        return Some(format!("{{ {} }}", strings(&schema[ORDER]).join(", ")));
    }
    let mut names = strings(&schema["type"]);
    names.extend(schema["type"].as_str());
    match *names.first().unwrap_or(&"any") {
        "null" => None,
        "array" => Some(format!(
            "list of {}",
            type_text(&schema["items"]).unwrap_or_else(|| "values".into())
        )),
        "object" => {
            let values =
                type_text(&schema["additionalProperties"]).unwrap_or_else(|| "values".into());
            Some(format!("map of names to {values}"))
        }
        "boolean" => Some("`true` or `false`".to_owned()),
        "integer" => Some("whole number".to_owned()),
        "number" if names.contains(&"array") => Some("any value".to_owned()),
        "number" => Some("number".to_owned()),
        "string" => Some("text".to_owned()),
        _ => Some("any value".to_owned()),
    }
}

/// `VectorExemplar` as `vector exemplar`.
fn spaced(name: &str) -> String {
    let split = name.chars().map(|c| {
        if c.is_uppercase() {
            format!(" {}", c.to_lowercase())
        } else {
            c.to_string()
        }
    });
    split.collect::<String>().trim_start().to_owned()
}

fn types_text(definitions: &Value) -> String {
    let mut out = String::from("\n## Types\n");
    for (name, schema) in definitions.as_object().into_iter().flatten() {
        out += &format!("\n### {name}\n\n{}\n", description(schema));
        let words = std::iter::once(schema).chain(schema["anyOf"].as_array().into_iter().flatten());
        for form in words.filter(|form| form["enum"].is_array()) {
            let meanings = strings(&form["enumDescriptions"]);
            out += "\n";
            for (word, meaning) in strings(&form["enum"]).iter().zip(meanings) {
                out += &format!("- `{word}`: {meaning}\n");
            }
        }
        if schema["properties"].is_object() {
            out += &format!("\n{}", object_table(schema));
        }
        out += &form_tables(schema);
    }
    out
}
