//! `layers`: what facades are stacked from.

use crate::macros::record;
use crate::scalar::{Letter, Text};
use crate::types::wants;
use crate::value::List;
use crate::{Decode, Decoder, Ref, Tree};

record! {
    /// A grid of shapes: each letter of a word along x with each letter of a word along y.
    pub struct Layer {
        /// The pattern along x.
        x: Ref<wants::Pattern>,
        /// The pattern along y; its first letter is the ground floor.
        y: Ref<wants::Pattern>,
        /// The symbols whose shapes are there; those of an axis that is not named all are.
        visible: Option<Visible>,
        /// The layers that it is aligned with: those of the same group.
        group: Group = "main",
    }
}

record! {
    /// The symbols whose shapes are there.
    pub struct Visible {
        /// Symbols along x. Without it, all.
        x: Option<List<Letter>>,
        /// Symbols along y. Without it, all.
        y: Option<List<Letter>>,
    }
}

/// The alignment groups of a layer along the axes.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Group {
    /// Along x.
    pub x: Text,
    /// Along y.
    pub y: Text,
}

record! {
    /// A group for each axis.
    pub struct GroupForm {
        /// The group along x.
        x: Text = "main",
        /// The group along y.
        y: Text = "main",
    }
}

impl Decode for Group {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Group> {
        if let Tree::Map(_) = tree {
            return GroupForm::decode(tree, cx).map(|form| Group {
                x: form.x,
                y: form.y,
            });
        }
        Text::decode(tree, cx).map(|name| Group {
            x: name.clone(),
            y: name,
        })
    }
}

impl schemars::JsonSchema for Group {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "AlignmentGroup".into()
    }

    fn json_schema(g: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let forms = [g.subschema_for::<Text>(), GroupForm::json_schema(g)];
        schemars::json_schema!({ "description": "A name, or one for each axis: `{ x: a, y: b }`.", "anyOf": forms })
    }
}
