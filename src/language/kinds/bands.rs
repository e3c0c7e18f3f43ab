//! `bands`: patterns along curves, with a given number of pieces and holes.

use super::side::Side;
use crate::macros::{choice, kinds, record};
use crate::scalar::{Count, Fraction, NonNegativeLength, NonNegativeNumber, PositiveLength};
use crate::types::wants;
use crate::value::{Direction, Target};
use crate::{Decode, Decoder, Ref, Tree};

record! {
    /// A pattern along a curve, made of pieces of an exemplar, with a given number of connected components and holes: a cutout.
    pub struct Band {
        /// The ornament. It is used at its own size; its own up is across the curve.
        exemplar: Ref<wants::VectorExemplar>,
        /// The curve: open or closed, planar, spatial or on a surface.
        curve: Ref<wants::Curve>,
        /// The room for the pattern across the curve.
        height: PositiveLength,
        /// The exemplar is scaled so that the pattern is as high as `height`: to that height itself, or to less where pieces stand above and below one another.
        fit: bool = false,
        /// Where the exemplar's up points. Without it: `plane` for planar curves (to the left of an open curve, outward on a closed one), `surface` for curves on a surface,
        /// else `normal`.
        across: Option<Across>,
        /// The other side is up.
        flip: bool = false,
        /// On which side of the curve the thickness goes when the band becomes a solid. A band with `outside` that stands round something has the curve's own size inside. The outer side of a flat band is above it; on a surface it is out of the surface; else it is away from the middle of the curve.
        side: Side = "center",
        /// The pattern itself closes around a closed curve; otherwise it may have a seam.
        closed_pattern: bool = true,
        /// What closes an open band at its two ends: a straight bar across its height, a drawn cap, or nothing but the exemplar's own ends.
        ends: Ends = "free",
        /// `strip` draws the developed strip also where the band could be drawn in place.
        layout: Layout = "in_place",
    }
    /// What is shared with panels.
    + synthesis: Synthesis
}

record! {
    /// How pieces of the exemplar are put together.
    pub struct Synthesis {
        /// How many connected components the pattern has.
        components: Target = 1,
        /// How many holes the pattern has. The hole around the centre of a closed curve does not count.
        holes: Target = "any",
        /// How the exemplar is cut into pieces.
        slicing: Slicing = "topology",
        /// Topology slicing: places where the exemplar's topology changes that are closer than this part of its width count as one.
        event_tolerance: Fraction = "2%",
        /// Cuts through necks thinner than this are not used.
        min_portal: NonNegativeLength = 0,
        /// The weight of the penalty on repetition; 0 allows any repetition.
        variety: NonNegativeNumber = 0,
        /// The weight of directions against positions where the cost of a seam is measured.
        tangent_weight: Fraction = 0.2,
        /// How far the pieces' total may be from the curve's length, as a part of it; they are then stretched to it exactly.
        length_tolerance: Fraction = "5%",
    }
}

/// Where the exemplar's up points.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Across {
    /// In the plane of the curve.
    Plane,
    /// Out of the plane of the curve, so that the band stands up; on a surface, out of the surface.
    Normal,
    /// In the surface that the curve lies on.
    Surface,
    /// In this direction.
    Direction(Direction),
}

impl Decode for Across {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Across> {
        if let Tree::List(_) = tree {
            return Direction::decode(tree, cx).map(Across::Direction);
        }
        match AcrossWord::decode(tree, cx)? {
            AcrossWord::Plane => Some(Across::Plane),
            AcrossWord::Normal => Some(Across::Normal),
            AcrossWord::Surface => Some(Across::Surface),
        }
    }
}

impl schemars::JsonSchema for Across {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Across".into()
    }

    fn json_schema(g: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let doc = "Where the exemplar's up points: a word, or a direction `[x, y, z]`.";
        let words = [
            g.subschema_for::<AcrossWord>(),
            g.subschema_for::<Direction>(),
        ];
        schemars::json_schema!({ "description": doc, "anyOf": words })
    }
}

choice! {
    /// Where the exemplar's up points.
    pub enum AcrossWord {
        /// In the plane of the curve.
        plane: Plane,
        /// Out of the plane of the curve, so that the band stands up; on a surface, out of the surface.
        normal: Normal,
        /// In the surface that the curve lies on.
        surface: Surface,
    }
}

/// What closes an open band at its ends.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Ends {
    /// The exemplar's own first and last pieces.
    Free,
    /// A straight bar over the whole height, of this thickness along the curve; a tenth of the height without one.
    Bar(Option<PositiveLength>),
    /// A drawing whose right side goes on as the pattern; mirrored at the last end.
    Cap(Ref<wants::VectorExemplar>),
}

impl Decode for Ends {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Ends> {
        if let Tree::Map(_) = tree {
            return EndPiece::decode(tree, cx).map(|piece| match piece {
                EndPiece::Bar(thickness) => Ends::Bar(Some(thickness)),
                EndPiece::Exemplar(cap) => Ends::Cap(cap),
            });
        }
        EndsWord::decode(tree, cx).map(|word| match word {
            EndsWord::Free => Ends::Free,
            EndsWord::Bar => Ends::Bar(None),
        })
    }
}

impl schemars::JsonSchema for Ends {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Ends".into()
    }

    fn json_schema(g: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let doc = "What closes an open band at its two ends: `free`, `bar`, `{ bar: 2 }`, or `{ exemplar: NAME }`.";
        let forms = [g.subschema_for::<EndsWord>(), g.subschema_for::<EndPiece>()];
        schemars::json_schema!({ "description": doc, "anyOf": forms })
    }
}

choice! {
    /// What closes an open band at its ends.
    pub enum EndsWord {
        /// The exemplar's own first and last pieces.
        free: Free,
        /// A straight bar over the whole height, a tenth of the height thick.
        bar: Bar,
    }
}

kinds! {
    /// An end piece with a measure or a drawing of its own.
    pub enum EndPiece {
        /// A straight bar over the whole height, of this thickness along the curve.
        bar: Bar(PositiveLength),
        /// A cap: a drawing at the exemplar's scale that stands at the band's beginning, mirrored at its end. Its right side is cut straight where the pattern goes on.
        exemplar: Exemplar(Ref<wants::VectorExemplar>),
    }
}

choice! {
    /// How a band is drawn.
    pub enum Layout {
        /// Bent along a planar curve, ready to cut; the developed strip for other curves.
        in_place: InPlace,
        /// The developed strip.
        strip: Strip,
    }
}

/// How an exemplar is cut into pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Slicing {
    /// Midway between the places where the topology changes.
    Topology,
    /// At this many places with equal distances.
    Uniform(Count),
}

impl Decode for Slicing {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Slicing> {
        if let Tree::Map(_) = tree {
            return UniformSlicing::decode(tree, cx)
                .map(|uniform| Slicing::Uniform(uniform.uniform));
        }
        if !matches!(tree, Tree::Text(_)) {
            return cx.mismatch("`topology` or `{ uniform: 12 }`", tree);
        }
        SlicingWord::decode(tree, cx).map(|SlicingWord::Topology| Slicing::Topology)
    }
}

impl schemars::JsonSchema for Slicing {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Slicing".into()
    }

    fn json_schema(g: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let doc = "How an exemplar is cut into pieces: `topology`, or `{ uniform: 12 }`.";
        let forms = [
            g.subschema_for::<SlicingWord>(),
            g.subschema_for::<UniformSlicing>(),
        ];
        schemars::json_schema!({ "description": doc, "anyOf": forms })
    }
}

choice! {
    /// How an exemplar is cut into pieces.
    pub enum SlicingWord {
        /// Midway between the places where the topology of its columns changes.
        topology: Topology,
    }
}

record! {
    /// Cuts with equal distances.
    pub struct UniformSlicing {
        /// How many cuts there are; one less than pieces.
        uniform: Count,
    }
}
