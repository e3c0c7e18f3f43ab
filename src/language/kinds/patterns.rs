//! `patterns`: words of symbols along one axis of a facade.

use std::collections::BTreeMap;

use crate::macros::record;
use crate::scalar::{Letter, Text};
use crate::value::Named;
use crate::{Decode, Decoder, Tree};

/// Words of symbols: letters in a row, `A|B` for either, `(…)` to group, `^3` or `^k` to repeat (k is a counter of the facade; a negative one mirrors), `.` between
/// letters where it helps to read. `|` binds more tightly than the row: `A|B.C` is AC or BC, and the choice of A or BC is written `A|(BC)`.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Pattern {
    /// A pattern.
    Plain(Text),
    /// A pattern whose letters are replaced by patterns.
    Substituted(SubstitutedPattern),
}

record! {
    /// A pattern whose letters are replaced by patterns. Letters that are not replaced are transparent.
    pub struct Substitution {
        /// The pattern.
        control: Text,
        /// Letters of `control` and the patterns that replace them.
        content: Named<Text>,
    }
}

/// A pattern whose letters are replaced by patterns.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SubstitutedPattern {
    /// The pattern.
    pub control: Text,
    /// What replaces its letters.
    pub content: BTreeMap<Letter, Text>,
}

impl Decode for Pattern {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Pattern> {
        if !matches!(tree, Tree::Map(_)) {
            return match tree.to_text() {
                Some(text) => Some(Pattern::Plain(Text(text))),
                None => cx.mismatch("a pattern, or { control, content }", tree),
            };
        }
        let Substitution { control, content } = Substitution::decode(tree, cx)?;
        let letters: Vec<Option<(Letter, Text)>> = content
            .0
            .into_iter()
            .map(|(name, pattern)| match Letter::of(&name) {
                Some(letter) => Some((letter, pattern)),
                None => {
                    let place = cx.at("content", |cx| cx.key_span_of(&name));
                    let error = fretwork_diagnostic::Diagnostic::error(format!(
                        "`{name}` is not a single letter"
                    ));
                    cx.push(error.at(place, "must be a letter of `control`"));
                    None
                }
            })
            .collect();
        let content = letters.into_iter().collect::<Option<_>>()?;
        Some(Pattern::Substituted(SubstitutedPattern {
            control,
            content,
        }))
    }
}

impl schemars::JsonSchema for Pattern {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Pattern".into()
    }

    fn json_schema(g: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let doc = "Words of symbols: letters in a row, `A|B` for either, `(…)` to group, `^3` or `^k` to repeat (`k` is a counter of the facade; a negative one \
            mirrors), `.` between letters where it helps to read. `|` binds more tightly than the row: `A|B.C` is AC or BC, other than in regular expressions; \
            A or BC is `A|(BC)`.";
        schemars::json_schema!({ "description": doc, "anyOf": [g.subschema_for::<Text>(), Substitution::json_schema(g)] })
    }
}
