//! `fields`: functions of the plane and of surfaces.

use crate::Ref;
use crate::macros::{choice, kinds, record};
use crate::scalar::{Count, FilePath, Number, Text};
use crate::types::wants;
use crate::value::{Named, OneOrMany};

kinds! {
    /// Numbers and vectors that differ from place to place: heights, directions, densities.
    pub enum Field {
        /// The values of a raster file: GeoTIFF, or a picture (PNG or JPEG; its luma, 0 to 1).
        raster: Raster(Raster),
        /// A measure of another field.
        derive: Derive(Derive),
        /// A formula in `x`, `y` (and `z` on a surface), in the spec's unit; the language is that of `${…}`. Where it
        /// is no finite number, as where it divides by zero, it has no value.
        expression: Expression(Formula),
        /// An attribute of a region's faces, constant in each.
        attribute: Attribute(Attribute),
        /// A statistic of another field in each of a region's faces, constant in each.
        zonal: Zonal(Zonal),
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
        /// The region that the raster covers. Without it, what the file says, or for a picture one unit a pixel.
        region: Option<Ref<wants::Region>>,
        /// The unit of the values. Where the field is used as an angle, it is the degree unless another is said.
        unit: Option<FieldUnit>,
        /// The value where the raster has none.
        otherwise: Option<Number>,
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
        /// The value where there is none.
        otherwise: Option<Number>,
    }
}

choice! {
    /// A measure of a field of heights.
    pub enum Operator {
        /// The steepness, as an angle in degrees from 0 (level) to 90.
        slope: Slope,
        /// The direction downhill, as an angle in degrees, counter-clockwise from +x.
        aspect: Aspect,
        /// The greatest less the least height of a sample and the eight around it.
        roughness: Roughness,
    }
}

record! {
    /// A formula in `x`, `y` (and `z` on a surface), in the spec's unit; the language is that of `${…}`.
    pub struct Formula {
        /// The formula; a list of them gives a vector.
        value: OneOrMany<Text>,
        /// Other fields whose values the formula reads, by the names that it has for them. Where one has no value, the formula has none.
        fields: Option<Named<Ref<wants::Field>>>,
        /// The unit of the value. It is needed where the field is used as an angle.
        unit: Option<FieldUnit>,
        /// The value where there is none.
        otherwise: Option<Number>,
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
        /// The unit of the values. Where the field is used as an angle, it is the degree unless another is said.
        unit: Option<FieldUnit>,
        /// The value where there is none.
        otherwise: Option<Number>,
    }
}

record! {
    /// A statistic of another field in each of a region's faces: over the samples whose middle lies in it, or at its inner
    /// point if none does.
    pub struct Zonal {
        /// The region with the faces.
        faces: Ref<wants::Region>,
        /// The field.
        from: Ref<wants::Field>,
        /// What of its values.
        statistic: Statistic,
        /// The unit of the values. Where the field is used as an angle, it is the degree unless another is said.
        unit: Option<FieldUnit>,
        /// The value where there is none.
        otherwise: Option<Number>,
    }
}

choice! {
    /// What is taken of the values in a face.
    pub enum Statistic {
        /// Their mean.
        mean: Mean,
        /// The least of them.
        min: Min,
        /// The greatest of them.
        max: Max,
        /// The direction downhill of their mean gradient, in degrees counter-clockwise from +x.
        direction: Direction,
    }
}
