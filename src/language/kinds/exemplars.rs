//! `exemplars`: small pieces of ornament from which larger ones are made.

use crate::macros::{kinds, record};
use crate::placement::Turn;
use crate::scalar::{FilePath, Fraction, NonNegativeLength, PositiveLength, Text};
use crate::types::wants;
use crate::{Ref, ValueType};

kinds! {
    /// Small pieces of ornament from which larger ones are made: drawn (polygons with holes, open curves, labelled points) or
    /// made of pixels (colours, each solid or empty).
    pub enum Exemplar {
        /// A drawing in an SVG file.
        vector: Vector(VectorExemplar),
        /// A picture file (PNG or JPEG).
        image: Image(ImageExemplar),
        /// A drawing of this spec as a picture; what is filled is solid.
        rasterize: Rasterize(Rasterize),
    }
}

impl Exemplar {
    /// Whether it is drawn or made of pixels.
    pub fn provides(&self) -> ValueType {
        match self {
            Exemplar::Vector(_) => ValueType::VectorExemplar,
            Exemplar::Image(_) | Exemplar::Rasterize(_) => ValueType::RasterExemplar,
        }
    }
}

record! {
    /// A drawing in an SVG file.
    pub struct VectorExemplar {
        /// The drawing.
        file: FilePath,
        /// The element to take, by its label or id, with all that is inside it. Without it, the whole drawing.
        id: Option<Text>,
        /// How far a polyline may be from the curve that it stands for. Without it, a thousandth of the drawing's longer side, and 0.01 mm at most: of the object, in a map of its paper if it has a `scale`, and any length if not.
        tolerance: Option<PositiveLength>,
    }
    /// How it is turned first.
    + turn: Turn
}

record! {
    /// A picture file (PNG or JPEG).
    pub struct ImageExemplar {
        /// The picture.
        file: FilePath,
        /// The width of a pixel on the object.
        pixel_size: PositiveLength,
        /// Which pixels are solid.
        solid: SolidPixels = SolidPixels::by_luma(),
    }
    /// What else synthesis must know.
    + grain: Grain
}

record! {
    /// A drawing of this spec as a picture; what is filled is solid.
    pub struct Rasterize {
        /// What is drawn.
        from: Ref<wants::Drawing>,
        /// The part of the plane that the picture shows; a periodic one makes a tileable picture.
        region: Ref<wants::Region>,
        /// The width of a pixel.
        pixel_size: PositiveLength,
        /// The width of lines. Without it they have no area of their own: only what closed ones enclose is solid.
        stroke: Option<PositiveLength>,
    }
    /// What else synthesis must know.
    + grain: Grain
}

record! {
    /// What synthesis must know of a picture.
    pub struct Grain {
        /// The radius of the features that must stay whole. Without it, it is estimated.
        feature_radius: Option<NonNegativeLength>,
        /// Opposite sides join.
        tileable: bool = false,
    }
}

kinds! {
    /// Which pixels of a picture are solid.
    pub enum SolidPixels {
        /// Those whose luma (Rec. 601, of the encoded values) is below this.
        darker_than: DarkerThan(Fraction),
        /// Those whose luma (Rec. 601, of the encoded values) is above this.
        lighter_than: LighterThan(Fraction),
        /// Those that are white in this picture of the same size.
        mask: Mask(FilePath),
    }
}

impl SolidPixels {
    /// The default, as it is written.
    fn by_luma() -> crate::Tree {
        crate::Tree::map([("darker_than", 0.5.into())])
    }
}
