//! What letters are set by, wherever there are letters.

use fretwork_diagnostic::Diagnostic;

use crate::macros::{choice, record};
use crate::placement::PlanePlacement;
use crate::record::{Fields, Group, Shape};
use crate::scalar::{Extent, FilePath, Length, PositiveLength, Scale, Text};
use crate::types::wants;
use crate::{Decoder, Ref};

record! {
    /// Letters as areas.
    pub struct Letters {
        /// The font: TrueType, OpenType or WOFF. Without it plain letters of even strokes, which fretwork has itself.
        font: Option<FilePath>,
        /// Bridges that hold the islands of letters, for what is cut out.
        stencil: Option<Stencil>,
    }
    /// How they are set.
    + setting: Setting
}

record! {
    /// Bridges straight above and below the islands of letters.
    pub struct Stencil {
        /// How wide they are.
        width: PositiveLength,
    }
}

record! {
    /// How letters are set; the point of the anchor comes to `at`.
    pub struct Setting {
        /// What is written; it may have several lines.
        content: Text,
        /// The font's size: the height of its em square.
        size: PositiveLength = 10,
        /// The width of what is drawn of the widest line: all is scaled so that it has it, and `size` has no effect.
        fit: Option<PositiveLength>,
        /// What is put between any two letters; below 0 they move together.
        letter_spacing: Length = 0,
        /// A factor for the distance of lines.
        leading: Scale = 1,
        /// Which place of what is drawn of each line is at the anchor; without `fit` a line that starts there keeps the blank
        /// before its first letter.
        align: Align = "start",
        /// Which height of the whole is at the anchor.
        anchor: Anchor = "baseline",
        /// A level curve that is the baseline instead of a straight one.
        on: Option<Ref<wants::Curve>>,
        /// On a curve: the side of it that the letters stand on.
        side: LetterSide = "left",
        /// On a curve: the length from its beginning, or the part of it, where the text is aligned. Without it the beginning, the middle
        /// or the end of the way that it is read, by `align`.
        start: Option<Extent>,
    }
    /// Where it stands.
    + placement: PlanePlacement
    /// Nothing; fields that have no effect are told.
    + effects: Effects
}

/// Tells which fields of a text have no effect beside the others.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Effects {}

impl Group for Effects {
    fn describe(_: &mut Shape, _: &mut schemars::SchemaGenerator) {}

    fn read(fields: &mut Fields, cx: &mut Decoder) -> Option<Effects> {
        let mut tell = |name: &str, why: &str| {
            let place = cx.key_span_of(name);
            let warning = Diagnostic::warning(format!("`{name}` has no effect: {why}"));
            cx.push(warning.at(place, ""));
        };
        if !fields.is_given("on") {
            let without = ["side", "start"].into_iter();
            let without = without.filter(|name| fields.is_given(name));
            without.for_each(|name| tell(name, "the text runs along no curve, which `on` names"));
        }
        if fields.is_given("fit") && fields.is_given("size") {
            tell("size", "`fit` says how large the text is");
        }
        Some(Effects {})
    }
}

choice! {
    /// A place of a line.
    pub enum Align {
        /// Its beginning.
        start: Start,
        /// Its middle.
        middle: Middle,
        /// Its end.
        end: End,
    }
}

choice! {
    /// A height of a text.
    pub enum Anchor {
        /// The first line's baseline.
        baseline: Baseline,
        /// The top of the letters.
        top: Top,
        /// Half way between their top and their bottom.
        middle: Middle,
        /// The bottom of the letters.
        bottom: Bottom,
    }
}

choice! {
    /// A side of a curve, seen in its direction from above.
    pub enum LetterSide {
        /// Letters stand to its left and are read in its direction.
        left: Left,
        /// Letters stand to its right and are read against its direction: outside of a circle, clockwise.
        right: Right,
    }
}
