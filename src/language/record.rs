//! Maps with known fields: their description, reading them, and the errors about fields that are missing
//! or unknown.
//!
//! The types are written with two macros of [`macros`](super::macros). `record!` makes a struct of fields.
//! `kinds!` makes an enum; a map holds exactly one of its kinds, as in `{ circle: { … } }`. Either can be
//! a *group* in another record: its fields then stand in the map of that record.

use std::sync::Arc;

use schemars::SchemaGenerator;
use serde_json::{Map, Value, json};

use super::hint::of_decimal_comma;
use super::{Decode, Decoder, Tree};
use fretwork_diagnostic::{Code, Diagnostic, nearest};

/// Fields that a map may hold.
pub trait Group: Sized {
    /// Adds the fields to `shape`.
    fn describe(shape: &mut Shape, generator: &mut SchemaGenerator);

    /// Takes the fields out of `fields`.
    fn read(fields: &mut Fields, cx: &mut Decoder) -> Option<Self>;
}

/// The keyword under which a schema keeps the order of its fields until the reference is written.
pub(super) const ORDER: &str = "x-order";

/// The description of a map: the parts of its JSON Schema.
#[derive(Default)]
pub struct Shape {
    properties: Map<String, Value>,
    order: Vec<&'static str>,
    required: Vec<&'static str>,
    one_of: Vec<Vec<&'static str>>,
}

impl Shape {
    /// Adds a field of type `T`.
    pub fn field<T: Decode>(
        &mut self,
        name: &'static str,
        doc: &str,
        default: Option<Tree>,
        g: &mut SchemaGenerator,
    ) {
        let mut schema = T::field_schema(g).to_value();
        if let Value::Object(schema) = &mut schema {
            schema.insert("description".into(), prose(doc).into());
            if let Some(default) = &default {
                schema.insert("default".into(), default.to_json());
            }
        }
        if default.is_none() && T::absent().is_none() {
            self.required.push(name);
        }
        self.properties.insert(name.into(), schema);
        self.order.push(name);
    }

    /// Adds a kind: a field of which the map holds this one or one of its siblings.
    pub fn kind<T: Decode>(&mut self, name: &'static str, doc: &str, g: &mut SchemaGenerator) {
        // Records are described in place, for they belong to their kind.
        let own = T::json_schema(g).to_value();
        let mut schema = if own["properties"].is_object() {
            own
        } else {
            T::field_schema(g).to_value()
        };
        if let Value::Object(schema) = &mut schema {
            schema.insert("description".into(), prose(doc).into());
        }
        self.properties.insert(name.into(), schema);
        self.order.push(name);
    }

    /// Asks for exactly one of `names`.
    pub fn exactly_one(&mut self, names: Vec<&'static str>) {
        self.one_of.push(names);
    }

    /// The JSON Schema of the map.
    pub fn schema(self, doc: &str) -> schemars::Schema {
        let mut schema =
            json!({ "type": "object", "description": prose(doc), "properties": self.properties });
        schema["additionalProperties"] = false.into();
        schema[ORDER] = json!(self.order);
        if !self.required.is_empty() {
            schema["required"] = json!(self.required);
        }
        let mut choices = self.one_of.iter().map(|names| {
            let alternatives: Vec<Value> = names
                .iter()
                .map(|name| json!({ "required": [name] }))
                .collect();
            json!({ "oneOf": alternatives })
        });
        match (choices.next(), choices.next()) {
            (Some(only), None) => schema["oneOf"] = only["oneOf"].clone(),
            (Some(first), Some(second)) => {
                schema["allOf"] = [first, second].into_iter().chain(choices).collect()
            }
            (None, _) => {}
        }
        schema.try_into().expect("an object is a schema")
    }
}

/// A doc comment as prose: without the space after `///`, and lines joined into paragraphs.
pub(super) fn prose(doc: &str) -> String {
    let mut out = String::new();
    let mut fenced = false;
    for line in doc
        .lines()
        .map(|line| line.strip_prefix(' ').unwrap_or(line))
    {
        let fence = line.trim_start().starts_with("```");
        let joins =
            !fenced && !fence && !line.is_empty() && !out.is_empty() && !out.ends_with('\n');
        out += if joins { " " } else { "" };
        out += line;
        fenced ^= fence;
        out += if fenced || fence || line.is_empty() {
            "\n"
        } else {
            ""
        };
        if line.is_empty() && !fenced {
            out += "\n";
        }
    }
    out.trim().to_owned()
}

/// The map that a record is read from, with what of it was read so far.
pub struct Fields<'t> {
    entries: &'t [(Arc<str>, Tree)],
    /// Whether there is no map at all: its fields may stand in the wrong column.
    is_null: bool,
    known: Vec<&'static str>,
    missing: Vec<Vec<&'static str>>,
}

impl<'t> Fields<'t> {
    /// The fields of `tree`, which must be a map.
    pub fn open(tree: &'t Tree, cx: &mut Decoder) -> Option<Fields<'t>> {
        match tree {
            Tree::Map(entries) => Some(Fields {
                entries,
                is_null: false,
                known: Vec::new(),
                missing: Vec::new(),
            }),
            Tree::Null => Some(Fields {
                entries: &[],
                is_null: true,
                known: Vec::new(),
                missing: Vec::new(),
            }),
            other => cx.mismatch("a map of fields", other),
        }
    }

    fn knows(&mut self, name: &'static str) {
        if !self.known.contains(&name) {
            self.known.push(name);
        }
    }

    fn get(&self, name: &str) -> Option<&'t Tree> {
        self.entries
            .iter()
            .find(|(key, _)| &**key == name)
            .map(|(_, value)| value)
    }

    /// Whether the field `name` is written.
    pub fn is_given(&self, name: &str) -> bool {
        self.get(name).is_some()
    }

    /// The value of the field `name`.
    pub fn take<T: Decode>(
        &mut self,
        name: &'static str,
        default: Option<Tree>,
        cx: &mut Decoder,
    ) -> Option<T> {
        self.knows(name);
        match (self.get(name), default) {
            (Some(tree), _) => cx.at(name, |cx| T::decode(tree, cx)),
            (None, Some(default)) => cx.at(name, |cx| T::decode(&default, cx)),
            (None, None) => {
                let absent = T::absent();
                if absent.is_none() {
                    self.missing.push(vec![name]);
                }
                absent
            }
        }
    }

    /// Which one of `names` the map holds; none and several are errors.
    pub fn only(&mut self, names: &[&'static str], cx: &mut Decoder) -> Option<&'static str> {
        names.iter().for_each(|name| self.knows(name));
        let found: Vec<&'static str> = names
            .iter()
            .copied()
            .filter(|name| self.get(name).is_some())
            .collect();
        match *found {
            [one] => Some(one),
            [] => {
                self.missing.push(names.to_vec());
                None
            }
            [first, second, ..] => {
                let (first_span, second_span) = (cx.key_span_of(first), cx.key_span_of(second));
                let both =
                    Diagnostic::error(format!("`{first}` and `{second}` exclude each other"))
                        .about(Code::Field);
                cx.push(both.at(second_span, "").at(first_span, "the other one"));
                None
            }
        }
    }

    /// Reports unknown and missing fields. A missing field is not reported if an unknown one resembles
    /// it.
    pub fn close(self, cx: &mut Decoder) {
        let what = cx.subject();
        let mut forgiven = Vec::new();
        let entries = self.entries.iter().enumerate();
        for (n, (key, value)) in entries.filter(|(_, (key, _))| !self.known.contains(&&**key)) {
            let unknown = Diagnostic::error(format!("unknown field `{key}` in {what}"))
                .about(Code::Field)
                .at(cx.key_span_of(key), "");
            let before = &self.entries[..n];
            cx.push(match nearest(key, self.known.iter().copied()) {
                Some(name) => {
                    forgiven.push(name);
                    unknown.help(format!("did you mean `{name}`?"))
                }
                None => unknown.help(
                    comma_in_number(before, key, value)
                        .or_else(|| below_empty(before))
                        .unwrap_or_else(|| {
                            format!("its fields are {}", listed(&self.known, "and"))
                        }),
                ),
            });
        }
        for names in self
            .missing
            .iter()
            .filter(|names| !names.iter().any(|name| forgiven.contains(name)))
        {
            let one = if names.len() > 2 { "one of " } else { "" };
            let message = format!("{what} needs {one}{}", listed(names, "or"));
            let missing = Diagnostic::error(message)
                .about(Code::Field)
                .at(cx.key_span(), "missing here");
            cx.push(if self.is_null {
                missing.help(format!(
                    "{what} is empty: indent what belongs to it further"
                ))
            } else {
                missing
            });
        }
    }
}

/// Advice if a field is what YAML makes of a decimal comma within braces: `{ width: 20,5 }` has the
/// field `width` and, without a value, the field `5`.
fn comma_in_number(before: &[(Arc<str>, Tree)], key: &str, value: &Tree) -> Option<String> {
    let (_, whole) = before.last().filter(|_| *value == Tree::Null)?;
    let whole = matches!(whole.plain(), Tree::Int(_)).then(|| whole.to_text())??;
    of_decimal_comma(&format!("{whole},{key}"))
}

/// Advice for a key that stands beside one without a value: it may be meant to stand below that.
pub(super) fn below_empty(before: &[(Arc<str>, Tree)]) -> Option<String> {
    let (empty, _) = before.iter().rfind(|(_, value)| *value == Tree::Null)?;
    let advice = format!("`{empty}` before it is empty: if it belongs there, indent it further");
    Some(advice)
}

/// `a`, `b` and `c`.
pub(super) fn listed(names: &[&str], word: &str) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match &*quoted {
        [most @ .., second, last] => {
            let head: String = most.iter().map(|name| format!("{name}, ")).collect();
            format!("{head}{second} {word} {last}")
        }
        _ => quoted.concat(),
    }
}

/// Reads a whole map as `T`.
pub fn decode_group<T: Group>(tree: &Tree, cx: &mut Decoder) -> Option<T> {
    let mut fields = Fields::open(tree, cx)?;
    let value = T::read(&mut fields, cx);
    fields.close(cx);
    value
}

/// The name of a field without the prefix of a raw identifier.
pub const fn plain(name: &'static str) -> &'static str {
    match name.as_bytes() {
        [b'r', b'#', ..] => name.split_at(2).1,
        _ => name,
    }
}

/// The text of `tree`, which must be one of `words`.
pub fn decode_word<'t>(
    words: &[&'static str],
    tree: &'t Tree,
    cx: &mut Decoder,
) -> Option<&'t str> {
    let one = if words.len() > 1 { "one of " } else { "" };
    let expected = format!("{one}{}", listed(words, "or"));
    let Some(word) = tree.as_text() else {
        return cx.mismatch(&expected, tree);
    };
    if words.contains(&&**word) {
        return Some(word);
    }
    let unknown = Diagnostic::error(format!(
        "`{}` is not one of the choices here",
        super::tree::shortened(word)
    ));
    let unknown = unknown.at(cx.span(), "");
    cx.push(match nearest(word, words.iter().copied()) {
        Some(name) => unknown.help(format!("did you mean `{name}`?")),
        None => unknown.help(format!("write {expected}")),
    });
    None
}

/// The JSON Schema of a word out of `words` with their meanings.
pub fn choice_schema(
    doc: &str,
    words: &[(&str, &str)],
    generator: &mut SchemaGenerator,
) -> schemars::Schema {
    let names: Vec<&str> = words.iter().map(|w| w.0).collect();
    let meanings: Vec<String> = words.iter().map(|w| prose(w.1)).collect();
    let expression = generator
        .subschema_for::<super::scalar::Expression>()
        .to_value();
    let words = json!({ "type": "string", "enum": names, "enumDescriptions": meanings });
    let schema = json!({ "description": prose(doc), "anyOf": [words, expression] });
    schema.try_into().expect("an object is a schema")
}
