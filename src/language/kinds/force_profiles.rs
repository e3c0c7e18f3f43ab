//! `force_profiles`: what an object is made of and what it must bear.

use crate::macros::{choice, kinds, record};
use crate::scalar::{
    Extent, ForceVector, Gravity, MassDensity, PoissonRatio, PositiveFraction, PositiveLength,
    PositiveNumber, Pressure,
};
use crate::value::{Direction, List, NonEmpty, SpacePoint};
use crate::{Decode, Decoder, Tree};

record! {
    /// What an object is made of and what it must bear.
    pub struct ForceProfile {
        /// A material that is known, or its values.
        material: Material,
        /// The direction of gravity (9.81 m/s²), or a vector with the unit `"m/s2"`.
        gravity: Gravity = [0, 0, -1],
        /// The zones that are held fast.
        supports: NonEmpty<Zone>,
        /// Forces beside gravity.
        loads: List<Load> = Tree::list([]),
        /// The stress (the sum of the absolute principal stresses) that 99 % of the body must stay below. Without it, the
        /// material's yield strength.
        max_stress: Option<Pressure>,
        /// What else must hold in the final analysis.
        limits: Option<Limits>,
        /// Gravity is also tried from other sides, and the worst of them counts.
        sweep: Option<Sweep>,
        /// Exceeding a limit in the final analysis is an error, not a warning.
        require: bool = false,
    }
}

impl ForceProfile {
    /// The same without what must hold: what the stress in a body follows from.
    pub fn forces(&self) -> ForceProfile {
        ForceProfile {
            max_stress: None,
            limits: None,
            sweep: None,
            require: false,
            ..self.clone()
        }
    }
}

record! {
    /// What must hold beside the stress.
    pub struct Limits {
        /// How many times as strong as is needed the material must be at the weakest place: its yield strength over the
        /// stress of von Mises there.
        safety_factor: Option<PositiveNumber>,
        /// How far a point may move.
        max_displacement: Option<PositiveLength>,
    }
}

choice! {
    /// What is tried from other sides.
    pub enum Sweep {
        /// Gravity, toward the faces and the corners of a cube.
        gravity: Gravity,
    }
}

record! {
    /// A force on a part of the object, shared among the nodes caught.
    pub struct Load {
        /// The whole force: `[x, y, z]`.
        force: ForceVector,
    }
    /// The part.
    + zone: Zone
}

kinds! {
    /// A part of space.
    pub enum Zone {
        /// The lowest part along z: a part of the height, or a length.
        lowest: Lowest(Extent),
        /// The highest part along z: a part of the height, or a length.
        highest: Highest(Extent),
        /// A box: its lowest and its highest corner.
        r#box: Box(ZoneBox),
        /// A ball.
        sphere: Sphere(Ball),
    }
}

/// A box of space: `min <= max` along each axis.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ZoneBox {
    /// The corner of least coordinates.
    pub min: [f64; 3],
    /// The corner of greatest coordinates.
    pub max: [f64; 3],
}

impl Decode for ZoneBox {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<ZoneBox> {
        const BOX: &str = "two corners `[[x, y, z], [x, y, z]]`";
        let Some(items) = tree.as_list() else {
            return cx.mismatch(BOX, tree);
        };
        match *cx.items::<SpacePoint>(items)? {
            [SpacePoint(min), SpacePoint(max)] if (0..3).all(|axis| min[axis] <= max[axis]) => {
                Some(ZoneBox { min, max })
            }
            [_, _] => cx.error("the first corner must not be above the second"),
            _ => cx.mismatch(BOX, tree),
        }
    }
}

impl schemars::JsonSchema for ZoneBox {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Corners".into()
    }

    fn json_schema(g: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let point = g.subschema_for::<SpacePoint>();
        schemars::json_schema!({
            "description": "A box of space: its lowest and its highest corner.",
            "type": "array", "items": point, "minItems": 2, "maxItems": 2,
        })
    }
}

record! {
    /// A ball.
    pub struct Ball {
        /// Its centre.
        center: SpacePoint,
        /// Its radius.
        radius: PositiveLength,
    }
}

/// What an object is made of: values in SI units.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Material {
    /// A material that is known.
    Known(KnownMaterial),
    /// A material that is known, as it is printed.
    Printed(PrintedMaterial),
    /// Its values.
    Custom(MaterialValues),
}

impl Decode for Material {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Material> {
        if let Tree::Map(entries) = tree {
            return match entries.iter().any(|(key, _)| **key == *"of") {
                true => PrintedMaterial::decode(tree, cx).map(Material::Printed),
                false => MaterialValues::decode(tree, cx).map(Material::Custom),
            };
        }
        KnownMaterial::decode(tree, cx).map(Material::Known)
    }
}

impl schemars::JsonSchema for Material {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "SolidMaterial".into()
    }

    fn json_schema(g: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let forms = [
            g.subschema_for::<KnownMaterial>(),
            g.subschema_for::<PrintedMaterial>(),
            g.subschema_for::<MaterialValues>(),
        ];
        schemars::json_schema!({ "description": "A material that is known, by itself or as it is printed, or its values.", "anyOf": forms })
    }
}

choice! {
    /// A material that is known.
    pub enum KnownMaterial {
        /// Acrylonitrile butadiene styrene.
        abs: Abs,
        /// Polylactic acid.
        pla: Pla,
        /// Polyethylene terephthalate glycol.
        petg: Petg,
        /// Polyamide 12, sintered.
        pa12: Pa12,
    }
}

record! {
    /// A material that is known, as it is printed.
    pub struct PrintedMaterial {
        /// The material.
        of: KnownMaterial,
        /// The strength across layers as a part of that within one.
        across_layers: Option<PositiveFraction>,
        /// The direction in which the layers are stacked.
        build_direction: Direction = [0, 0, 1],
    }
}

record! {
    /// The values of a material.
    pub struct MaterialValues {
        /// Young's modulus.
        youngs_modulus: Pressure,
        /// Poisson's ratio.
        poisson_ratio: PoissonRatio,
        /// The mass density.
        density: MassDensity,
        /// The stress at which it yields.
        yield_strength: Pressure,
        /// The strength across layers as a part of that within one, where it is printed.
        across_layers: Option<PositiveFraction>,
        /// The direction in which the layers are stacked.
        build_direction: Direction = [0, 0, 1],
    }
}
