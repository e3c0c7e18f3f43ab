//! Numbers with units. Lengths are held in the spec's unit, angles in radians, physical values in
//! SI units.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Serialize;
use serde_json::json;

use super::super::record::listed;
use super::super::tree::shortened;
use super::super::{Decode, Decoder, Tree};
use super::number::finite;
use super::number_schema;
use super::unit::{
    ACCELERATIONS, ANGLES, FORCES, FRACTIONS, LENGTHS, MASS_DENSITIES, PRESSURES, UnitTable, split_number,
};
use crate::diagnostic::{Diagnostic, nearest};

/// A quantity as it was written: a plain number, or one in the table's basic unit.
enum Written {
    Plain(f64),
    InUnit(f64),
}

/// Reads a number, or a number with a unit of `table` (where one is needed, `unit_needed`).
fn quantity(tree: &Tree, what: &str, table: &UnitTable, cx: &mut Decoder) -> Option<Written> {
    let Tree::Text(text) = tree else {
        return finite(tree, what, cx).map(Written::Plain);
    };
    let names: Vec<&str> = table.iter().map(|unit| unit.0).collect();
    let Some((number, unit)) = split_number(text) else {
        let message = format!("expected {what}, found {}", tree.describe());
        return cx.error_with(message, format!("write a number, or text with a unit ({})", listed(&names, "or")));
    };
    if unit.is_empty() {
        return cx.error_with(
            format!("\"{}\" is text without a unit", shortened(text)),
            format!("leave out the quotes, or write a unit ({})", listed(&names, "or")),
        );
    }
    let Some((_, factor)) = table.iter().find(|(name, _)| *name == unit) else {
        let message = format!("`{}` is not a unit of {}", shortened(unit), noun(what));
        let unknown = Diagnostic::error(message).at(cx.span(), "");
        cx.push(match nearest(unit, names.iter().copied()).filter(|_| unit.len() > 1) {
            Some(name) => unknown.help(format!("did you mean `{name}`? The units are {}", listed(&names, "and"))),
            None => unknown.help(format!("the units are {}", listed(&names, "and"))),
        });
        return None;
    };
    let value = number * factor + 0.0;
    if value.is_finite() { Some(Written::InUnit(value)) } else { cx.error("the number is too large") }
}

/// The noun of `a length above 0`.
fn noun(what: &str) -> &str {
    let bare = what.split_once(' ').map_or(what, |words| words.1);
    [" above", " that", " from"].iter().fold(bare, |bare, limit| bare.split(limit).next().unwrap_or(bare))
}

fn pattern(units: &str) -> String {
    format!(r"^\s*[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?\s*({units})\s*$")
}

/// Defines a quantity: how it is converted, and its limits.
macro_rules! quantity {
    (
        $(#[doc = $doc:literal])*
        $name:ident, $what:literal, $table:expr, $units:literal, $convert:expr $(, $test:expr, $limits:expr)?
    ) => {
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize)]
        #[serde(transparent)]
        pub struct $name(pub f64);

        impl Decode for $name {
            fn decode(tree: &Tree, cx: &mut Decoder) -> Option<$name> {
                let written = quantity(tree, $what, $table, cx)?;
                let convert: fn(Written, &Decoder) -> f64 = $convert;
                let value = convert(written, cx) + 0.0;
                if !value.is_finite() {
                    return cx.error("the number is too large");
                }
                $(
                    let fits: fn(f64) -> bool = $test;
                    if !fits(value) {
                        return cx.mismatch($what, tree);
                    }
                )?
                Some($name(value))
            }
        }

        impl JsonSchema for $name {
            fn schema_name() -> Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(_: &mut SchemaGenerator) -> Schema {
                let limits: &[(&str, serde_json::Value)] = &[$($limits)?];
                number_schema("number", concat!($($doc, "\n"),*), Some(&pattern($units)), limits)
            }
        }
    };
}

fn in_spec_units(written: Written, cx: &Decoder) -> f64 {
    match written {
        Written::Plain(value) => cx.file_units().convert(value, cx.spec_units()),
        Written::InUnit(mm) => mm / cx.spec_units().millimetres(),
    }
}

fn as_it_is(written: Written, _: &Decoder) -> f64 {
    match written {
        Written::Plain(value) | Written::InUnit(value) => value,
    }
}

quantity!(
    /// A length: a number in the file's `units`, or text with its unit (`"2.5mm"`, `"1cm"`, `"0.2m"`, `"0.1in"`).
    Length, "a length", LENGTHS, "mm|cm|m|in", in_spec_units
);
quantity!(
    /// A length above 0.
    PositiveLength, "a length above 0", LENGTHS, "mm|cm|m|in", in_spec_units, |x| x > 0.0, ("exclusiveMinimum", json!(0))
);
quantity!(
    /// A length, 0 or above.
    NonNegativeLength, "a length that is not below 0", LENGTHS, "mm|cm|m|in", in_spec_units, |x| x >= 0.0, ("minimum", json!(0))
);
quantity!(
    /// A length, 0 or above, on the output: held in millimetres. A plain number is in the file's `units`,
    /// or in millimetres where the artifact has a `scale`.
    OutputLength, "a length that is not below 0", LENGTHS, "mm|cm|m|in", in_output, |x| x >= 0.0, ("minimum", json!(0))
);
quantity!(
    /// An angle: a number of degrees, or text with its unit (`"45deg"`, `"0.785rad"`, `"0.125turn"`).
    Angle, "an angle", ANGLES, "deg|rad|turn", in_radians
);
quantity!(
    /// A force: a number of newtons, or text with its unit (`"20N"`, `"1.5kN"`).
    Force, "a force", FORCES, "N|mN|kN", as_it_is
);
quantity!(
    /// A pressure or stress above 0: a number of pascals, or text with its unit (`"8MPa"`, `"2.3GPa"`).
    Pressure, "a pressure above 0", PRESSURES, "Pa|kPa|MPa|GPa", as_it_is, |x| x > 0.0, ("exclusiveMinimum", json!(0))
);
quantity!(
    /// A mass density above 0: a number of kg/m³, or text with its unit (`"1040kg/m3"`, `"1.04g/cm3"`).
    MassDensity, "a mass density above 0", MASS_DENSITIES, "kg/m3|g/cm3", as_it_is, |x| x > 0.0, ("exclusiveMinimum", json!(0))
);

fn in_radians(written: Written, _: &Decoder) -> f64 {
    match written {
        Written::Plain(degrees) => degrees.to_radians(),
        Written::InUnit(radians) => radians,
    }
}

fn in_output(written: Written, cx: &Decoder) -> f64 {
    match written {
        Written::Plain(value) if cx.scaled => value,
        Written::Plain(value) => value * cx.file_units().millimetres(),
        Written::InUnit(mm) => mm,
    }
}

/// A fraction from 0 to 1: `0.1` or `"10%"`.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize)]
#[serde(transparent)]
pub struct Fraction(pub f64);

impl Decode for Fraction {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Fraction> {
        let value = as_it_is(quantity(tree, FRACTION, FRACTIONS, cx)?, cx);
        if (0.0..=1.0).contains(&value) {
            return Some(Fraction(value));
        }
        let message = format!("expected {FRACTION}, found {}", tree.describe());
        match tree {
            Tree::Text(_) => cx.error(message),
            _ if value > 1.0 && value <= 100.0 => cx.error_with(message, format!("did you mean \"{value}%\"?")),
            _ => cx.error(message),
        }
    }
}

const FRACTION: &str = "a fraction from 0 to 1";

impl JsonSchema for Fraction {
    fn schema_name() -> Cow<'static, str> {
        "Fraction".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let doc = "A fraction from 0 to 1: `0.1` or `\"10%\"`.";
        number_schema("number", doc, Some(&pattern("%")), &[("minimum", json!(0)), ("maximum", json!(1))])
    }
}

/// A part of an extent, or a length.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub enum Extent {
    /// This part of the whole, from 0 to 1.
    Fraction(f64),
    /// A length, not below 0, in the spec's unit.
    Length(f64),
}

impl Decode for Extent {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Extent> {
        const EXTENT: &str = "a fraction or a length with its unit";
        let in_percent = tree.as_text().is_some_and(|text| text.trim_end().ends_with('%'));
        if in_percent {
            return Fraction::decode(tree, cx).map(|fraction| Extent::Fraction(fraction.0));
        }
        if let Tree::Text(_) = tree {
            return NonNegativeLength::decode(tree, cx).map(|length| Extent::Length(length.0));
        }
        let value = finite(tree, EXTENT, cx)?;
        if (0.0..=1.0).contains(&value) {
            return Some(Extent::Fraction(value));
        }
        let help = format!("write \"{value}%\" or \"{value}{}\"", cx.file_units().word());
        cx.error_with(format!("{value} is neither a fraction nor a length with its unit"), help)
    }
}

impl JsonSchema for Extent {
    fn schema_name() -> Cow<'static, str> {
        "Extent".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let doc =
            "A part of the whole or a length: a fraction (`0.1`, `\"10%\"`) or text with a unit of length (`\"5mm\"`).";
        let limits = [("minimum", json!(0)), ("maximum", json!(1))];
        number_schema("number", doc, Some(&pattern("%|mm|cm|m|in")), &limits)
    }
}

/// A mean number of points per square of the spec's unit, above 0.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize)]
#[serde(transparent)]
pub struct Density(pub f64);

impl Decode for Density {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Density> {
        let value = finite(tree, "a density above 0", cx)?;
        // A length of 1 of the file is this long in the spec, so a square of it holds this much more.
        let side = cx.file_units().convert(1.0, cx.spec_units());
        let value = value / (side * side);
        let fits = value > 0.0 && value.is_finite();
        if fits { Some(Density(value)) } else { cx.mismatch("a density above 0", tree) }
    }
}

impl JsonSchema for Density {
    fn schema_name() -> Cow<'static, str> {
        "Density".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let doc = "A density: the mean number of points per square of the file's unit, above 0.";
        number_schema("number", doc, None, &[("exclusiveMinimum", json!(0))])
    }
}

/// A factor above 0 by which lengths are multiplied.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize)]
#[serde(transparent)]
pub struct Scale(pub f64);

impl Decode for Scale {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Scale> {
        const SCALE: &str = "a scale above 0 (`2`, \"50%\" or \"1:200\")";
        let value = match tree {
            Tree::Text(text) => match scale_of_text(text) {
                Some(value) => value,
                None => return cx.mismatch(SCALE, tree),
            },
            _ => finite(tree, SCALE, cx)?,
        };
        let fits = value > 0.0 && value.is_finite();
        if fits { Some(Scale(value)) } else { cx.mismatch(SCALE, tree) }
    }
}

fn scale_of_text(text: &str) -> Option<f64> {
    let (first, rest) = split_number(text)?;
    if rest == "%" {
        return Some(first / 100.0);
    }
    match split_number(rest.strip_prefix(':')?)? {
        (second, "") => Some(first / second),
        _ => None,
    }
}

impl JsonSchema for Scale {
    fn schema_name() -> Cow<'static, str> {
        "Scale".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let number = r"\s*[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?\s*";
        let doc = "A factor above 0: a number, a percentage (`\"50%\"`) or a ratio (`\"1:200\"`).";
        let pattern = format!("^{number}(%|:{number})$");
        number_schema("number", doc, Some(&pattern), &[("exclusiveMinimum", json!(0))])
    }
}

/// Poisson's ratio: above -1 and below 0.5.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize)]
#[serde(transparent)]
pub struct PoissonRatio(pub f64);

impl Decode for PoissonRatio {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<PoissonRatio> {
        const RATIO: &str = "a number above -1 and below 0.5";
        let value = finite(tree, RATIO, cx)?;
        if -1.0 < value && value < 0.5 { Some(PoissonRatio(value)) } else { cx.mismatch(RATIO, tree) }
    }
}

impl JsonSchema for PoissonRatio {
    fn schema_name() -> Cow<'static, str> {
        "PoissonRatio".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let limits = [("exclusiveMinimum", json!(-1)), ("exclusiveMaximum", json!(0.5))];
        number_schema("number", "Poisson's ratio: a number above -1 and below 0.5.", None, &limits)
    }
}

/// A force in space, in newtons.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub struct ForceVector(pub [f64; 3]);

impl Decode for ForceVector {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<ForceVector> {
        match tree.as_list() {
            Some(items) if items.len() == 3 => match *cx.items::<Force>(items)? {
                [x, y, z] => Some(ForceVector([x.0, y.0, z.0])),
                _ => None,
            },
            _ => cx.mismatch("a force `[x, y, z]`", tree),
        }
    }
}

impl JsonSchema for ForceVector {
    fn schema_name() -> Cow<'static, str> {
        "ForceVector".into()
    }

    fn json_schema(g: &mut SchemaGenerator) -> Schema {
        let force = g.subschema_for::<Force>();
        json_schema!({ "description": "A force `[x, y, z]`.", "type": "array", "items": force, "minItems": 3, "maxItems": 3 })
    }
}

/// The acceleration by gravity, in m/s².
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Gravity(pub [f64; 3]);

/// What gravity is on earth, in m/s².
const STANDARD_GRAVITY: f64 = 9.81;

impl Decode for Gravity {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Gravity> {
        const GRAVITY: &str = "a direction `[x, y, z]`, or a vector with the unit m/s2";
        let Some(items) = tree.as_list().filter(|items| items.len() == 3) else {
            return cx.mismatch(GRAVITY, tree);
        };
        let read = |cx: &mut Decoder, n: usize| {
            cx.at(&n.to_string(), |cx| quantity(&items[n], "an acceleration", ACCELERATIONS, cx))
        };
        let (x, y, z) = (read(cx, 0), read(cx, 1), read(cx, 2));
        match (x?, y?, z?) {
            (Written::InUnit(x), Written::InUnit(y), Written::InUnit(z)) => Some(Gravity([x, y, z])),
            (Written::Plain(x), Written::Plain(y), Written::Plain(z)) => {
                let largest = x.abs().max(y.abs()).max(z.abs());
                if largest == 0.0 {
                    return cx.error_with(
                        "a direction must not be zero",
                        "write [\"0m/s2\", \"0m/s2\", \"0m/s2\"] for no gravity",
                    );
                }
                let [x, y, z] = [x, y, z].map(|part| part / largest);
                let factor = STANDARD_GRAVITY / (x * x + y * y + z * z).sqrt();
                Some(Gravity([x, y, z].map(|part| part * factor + 0.0)))
            }
            _ => cx.error("either all parts of the vector have the unit m/s2, or none has"),
        }
    }
}

impl JsonSchema for Gravity {
    fn schema_name() -> Cow<'static, str> {
        "Gravity".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let part = number_schema("number", "", Some(&pattern("m/s2")), &[]);
        let doc = "The acceleration by gravity: a direction `[x, y, z]` (of 9.81 m/s²), or a vector in text with units (`[\"0m/s2\", \"0m/s2\", \"-1.62m/s2\"]`).";
        json_schema!({ "description": doc, "type": "array", "items": part, "minItems": 3, "maxItems": 3 })
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::DecodeContext;
    use super::super::Unit;
    use super::*;

    fn read<T: Decode>(tree: impl Into<Tree>, scaled: bool) -> Result<T, String> {
        let context = DecodeContext {
            file: "f.yaml".into(),
            path: vec!["a".into()],
            file_units: Unit::Inch,
            spec_units: Unit::Centimetre,
        };
        let mut cx = Decoder::new(&context);
        cx.scaled = scaled;
        T::decode(&tree.into(), &mut cx).ok_or_else(|| cx.diagnostics[0].message.clone())
    }

    #[test]
    fn lengths_go_from_the_files_unit_to_the_specs() {
        assert_eq!(read(2, false), Ok(Length(5.08)));
        assert_eq!(read("25mm", false), Ok(Length(2.5)));
        assert_eq!(read("-0mm", false), Ok(Length(0.0)));
        assert!(read::<Length>("-0mm", false).unwrap().0.is_sign_positive());
        assert_eq!(read::<Length>("1e308m", false), Err("the number is too large".into()));
        assert_eq!(read::<PositiveLength>(0, false), Err("expected a length above 0, found the number 0".into()));
        assert_eq!(read::<Length>("5furlongs", false), Err("`furlongs` is not a unit of length".into()));
        assert_eq!(read::<Length>("NaN", false), Err("expected a length, found text \"NaN\"".into()));
    }

    #[test]
    fn output_lengths_are_millimetres() {
        assert_eq!(read(1, false), Ok(OutputLength(25.4)));
        assert_eq!(read(1, true), Ok(OutputLength(1.0)));
        assert_eq!(read("0.2mm", true), Ok(OutputLength(0.2)));
    }

    #[test]
    fn angles_are_radians() {
        use std::f64::consts::PI;
        assert_eq!(read(180, false), Ok(Angle(PI)));
        assert_eq!(read("0.5turn", false), Ok(Angle(PI)));
        assert_eq!(read("0.785rad", false), Ok(Angle(0.785)));
        assert_eq!(read("90deg", false), Ok(Angle(PI / 2.0)));
    }

    #[test]
    fn densities_count_points_in_the_specs_squares() {
        let density: Density = read(2.54 * 2.54, false).unwrap();
        assert!((density.0 - 1.0).abs() < 1e-12);
        assert!(read::<Density>(0, false).is_err());
    }

    #[test]
    fn fractions_and_extents_do_not_guess() {
        assert_eq!(read("10%", false), Ok(Fraction(0.1)));
        assert_eq!(read(1, false), Ok(Fraction(1.0)));
        assert!(read::<Fraction>(5, false).is_err());
        assert!(read::<Fraction>("101%", false).is_err());
        assert_eq!(read(0.25, false), Ok(Extent::Fraction(0.25)));
        assert_eq!(read("5mm", false), Ok(Extent::Length(0.5)));
        assert_eq!(read::<Extent>(5, false), Err("5 is neither a fraction nor a length with its unit".into()));
        assert!(read::<Extent>("-5mm", false).is_err());
    }

    #[test]
    fn scales_are_numbers_percentages_and_ratios() {
        assert_eq!(read("1:200", false), Ok(Scale(0.005)));
        assert_eq!(read("2 : 1", false), Ok(Scale(2.0)));
        assert_eq!(read("50%", false), Ok(Scale(0.5)));
        for wrong in ["1:0", "0:1", "1:2:3", "half", "1", ":2"] {
            assert!(read::<Scale>(wrong, false).is_err(), "{wrong}");
        }
    }

    #[test]
    fn physical_values_are_in_si_units() {
        assert_eq!(read("8MPa", false), Ok(Pressure(8e6)));
        assert_eq!(read(8e6, false), Ok(Pressure(8e6)));
        assert_eq!(read("1.04g/cm3", false), Ok(MassDensity(1040.0)));
        assert_eq!(read("20N", false), Ok(Force(20.0)));
        let list = |items: [&str; 3]| Tree::list(items.map(Tree::from));
        assert_eq!(read(list(["0N", "1kN", "-20N"]), false), Ok(ForceVector([0.0, 1000.0, -20.0])));
        assert_eq!(read([0, 0, -1], false), Ok(Gravity([0.0, 0.0, -9.81])));
        assert_eq!(read(list(["0m/s2", "0m/s2", "-1.62m/s2"]), false), Ok(Gravity([0.0, 0.0, -1.62])));
        assert!(read::<Gravity>([0, 0, 0], false).is_err());
    }
}
