//! The JSON Schema of a spec file, for editors and for the tests.
//!
//! Draft 7, which editors read best. Where a description stands beside a `$ref`, validators ignore
//! it and editors show it.

use schemars::JsonSchema;
use schemars::generate::{SchemaGenerator, SchemaSettings};
use serde_json::{Map as Fields, Value, json};

use super::param::ParamForm;
use super::record::{Group, ORDER};
use super::scalar::{Expression, Unit};
use super::{Map, Section, VERSION};

/// The JSON Schema of a spec file.
pub fn schema() -> Value {
    let mut schema = ordered_schema();
    forget_order(&mut schema);
    schema
}

fn forget_order(schema: &mut Value) {
    match schema {
        Value::Object(fields) => {
            fields.remove(ORDER);
            fields.values_mut().for_each(forget_order);
        }
        Value::Array(items) => items.iter_mut().for_each(forget_order),
        _ => {}
    }
}

/// The same with the order of fields, under [`ORDER`].
pub(super) fn ordered_schema() -> Value {
    let settings = SchemaSettings::draft07().with(|settings| settings.transforms.clear());
    let mut generator = settings.into_generator();
    let mut properties = head(&mut generator);
    for section in Section::ALL {
        properties.insert(
            section.name().into(),
            section_schema(*section, &mut generator),
        );
    }
    let definitions = generator.take_definitions(true);
    json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "fretwork spec",
        "description": "A file of the fretwork spec language.",
        "type": "object",
        "properties": properties,
        "required": ["fretwork"],
        "additionalProperties": false,
        "definitions": definitions,
    })
}

fn head(generator: &mut SchemaGenerator) -> Fields<String, Value> {
    let mut units = generator.subschema_for::<Unit>().to_value();
    units["default"] = "mm".into();
    units["description"] = "The unit of every plain length in the file.".into();
    let seed = seed(
        "The root of all randomness in the file. A file that is included or used as a module and says none has that of the file that names it.",
        generator,
    );
    let param = param(generator);
    let map = Map::json_schema(generator).to_value();
    let description = map["description"].clone();
    let map = json!({ "description": description, "anyOf": [map, { "type": "null" }] });
    let variable = json!({ "pattern": "^[A-Za-z_][A-Za-z0-9_]*$" });
    let with = json!({
        "description": "Values for the params of the modules, with expressions of this file.",
        "type": "object", "propertyNames": variable, "additionalProperties": {},
    });
    let module = json!({
        "type": "object", "properties": { "with": with },
        "propertyNames": { "pattern": r"^[^\s./${}]+$" }, "additionalProperties": { "type": "string" },
    });
    let head = json!({
        "fretwork": { "description": "The version of the language.", "const": VERSION },
        "units": units,
        "map": map,
        "seed": seed,
        "params": {
            "description": "Values that a caller may override with `--set NAME=VALUE`: a default alone, or a map of fields.",
            "type": ["object", "null"], "propertyNames": variable, "additionalProperties": param,
        },
        "let": {
            "description": "Values derived from others by expressions, by name.",
            "type": ["object", "null"], "propertyNames": variable, "additionalProperties": {},
        },
        "include": {
            "description": "Files whose entries belong to this one, relative to it.",
            "anyOf": [{ "type": ["string", "null"] }, { "type": "array", "items": { "type": "string" } }],
        },
        "use": {
            "description": "Files that are modules of this one, by name, as in `use: { box: parts/box.yaml, with: { width: 40 } }`: the entry `panel` of the file is `box.panel` here, and its artifacts are not built. `with` gives its params values, which may be expressions of this file; a number for a param of the type `length` is in this file's units. A list of such maps gives modules different values.",
            "anyOf": [module, { "type": "null" }, { "type": "array", "items": module }],
        },
    });
    match head {
        Value::Object(head) => head,
        _ => Fields::new(),
    }
}

fn seed(doc: &str, generator: &mut SchemaGenerator) -> Value {
    let expression = generator.subschema_for::<Expression>().to_value();
    let number = json!({ "type": "integer", "minimum": 0 });
    json!({ "description": doc, "default": 0, "anyOf": [number, expression] })
}

fn param(generator: &mut SchemaGenerator) -> Value {
    let mut shape = super::record::Shape::default();
    ParamForm::describe(&mut shape, generator);
    let form = shape
        .schema("A value that a caller may override.")
        .to_value();
    json!({ "anyOf": [{ "type": ["number", "string", "boolean", "array"] }, form] })
}

/// The schema of a section: a map of names to entries.
fn section_schema(section: Section, generator: &mut SchemaGenerator) -> Value {
    let mut entry = section.entry_schema(generator).to_value();
    let description = entry["description"].clone();
    let mut seed = seed(
        "The root of this entry's randomness, instead of its name.",
        generator,
    );
    if let Some(seed) = seed.as_object_mut() {
        seed.remove("default");
    }
    share(&mut entry, &seed);
    let names = match section {
        Section::Artifacts => json!({ "minLength": 1 }),
        Section::Symbols => json!({ "pattern": "^.$" }),
        _ => json!({ "pattern": r"^[^\s./${}]+$" }),
    };
    json!({ "description": description, "type": ["object", "null"], "propertyNames": names, "additionalProperties": entry })
}

/// Adds what every entry may carry.
fn share(entry: &mut Value, seed: &Value) {
    if let Some(properties) = entry.get_mut("properties").and_then(Value::as_object_mut) {
        properties.insert("seed".into(), seed.clone());
        properties.insert(
            "doc".into(),
            json!({ "description": "What the entry is for.", "type": "string" }),
        );
    }
    for form in entry
        .get_mut("anyOf")
        .and_then(Value::as_array_mut)
        .into_iter()
        .flatten()
    {
        share(form, seed);
    }
}
