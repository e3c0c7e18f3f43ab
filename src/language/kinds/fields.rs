//! `fields`: functions of the plane and of surfaces.

use crate::Ref;
use crate::macros::{choice, kinds, record};
use crate::scalar::{Count, FilePath, Number, Text};
use crate::types::wants;
use crate::value::OneOrMany;

kinds! {
    /// Numbers and vectors that differ from place to place: heights, directions, densities.
    pub enum Field {
        /// The values of a raster file: GeoTIFF, or a picture (PNG or JPEG; its luma, 0 to 1).
        raster: Raster(Raster),
        /// A measure of another field.
        derive: Derive(Derive),
        /// A formula in `x`, `y` (and `z` on a surface), in the spec's unit; the language is that of `${…}`.
        expression: Expression(Formula),
        /// An attribute of a region's faces, constant in each.
        attribute: Attribute(Attribute),
    }
}

record! {
    /// The values of a raster file: GeoTIFF, or a picture (PNG or JPEG; its luma, 0 to 1).
    pub struct Raster {
        /// The file.
        file: FilePath,
        /// The values between the samples.
        interpolate: Interpolation = "bilinear",
        /// The band of a file that has several, from 1.
        band: Count = 1,
        /// Pictures: the value of black.
        black: Number = 0,
        /// Pictures: the value of white.
        white: Number = 1,
        /// The region that the raster covers. Without it, what the file says, or one unit a pixel.
        region: Option<Ref<wants::Region>>,
    }
}

choice! {
    /// The values between the samples of a raster.
    pub enum Interpolation {
        /// The mean of the four nearest samples, by distance.
        bilinear: Bilinear,
        /// The nearest sample.
        nearest: Nearest,
    }
}

record! {
    /// A measure of another field.
    pub struct Derive {
        /// The field.
        from: Ref<wants::Field>,
        /// The measure.
        operator: Operator,
    }
}

choice! {
    /// A measure of a field of heights.
    pub enum Operator {
        /// The steepness, as an angle in degrees from 0 (level) to 90.
        slope: Slope,
        /// The direction downhill, as an angle in degrees, counter-clockwise from +x.
        aspect: Aspect,
        /// The greatest difference of height to a neighbouring sample.
        roughness: Roughness,
    }
}

record! {
    /// A formula in `x`, `y` (and `z` on a surface), in the spec's unit; the language is that of `${…}`.
    pub struct Formula {
        /// The formula; a list of them gives a vector.
        value: OneOrMany<Text>,
        /// The unit of the value. It is needed where the field is used as an angle.
        unit: Option<FieldUnit>,
    }
}

choice! {
    /// The unit of a field's values.
    pub enum FieldUnit {
        /// Degrees.
        deg: Degree,
        /// Radians.
        rad: Radian,
        /// Turns of 360 degrees.
        turn: Turn,
        /// Millimetres.
        mm: Millimetre,
        /// Centimetres.
        cm: Centimetre,
        /// Metres.
        m: Metre,
        /// Inches of 25.4 mm.
        in: Inch,
    }
}

record! {
    /// An attribute of a region's faces.
    pub struct Attribute {
        /// The region.
        region: Ref<wants::Region>,
        /// The attribute.
        name: Text,
    }
}
