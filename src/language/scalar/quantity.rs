//! Numbers with units. Lengths are held in the spec's unit, angles in radians, physical values in
//! SI units.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::super::hint::of_decimal_comma;
use super::super::record::listed;
use super::super::tree::shortened;
use super::super::{Decode, Decoder, Tree};
use super::number::finite;
use super::number_schema;
use super::unit::{
    ANGLES, AREAS, FORCES, LENGTHS, MASS_DENSITIES, PRESSURES, UnitTable, VOLUMES, split_number,
};
use fretwork_diagnostic::{Diagnostic, nearest};

/// The largest value of a quantity in its basic unit: what is computed from it stays far from the limits of numbers.
const LARGEST: f64 = 1e15;

/// A quantity as it was written: a plain number, or one in the table's basic unit.
pub(super) enum Written {
    Plain(f64),
    InUnit(f64),
}

/// Reads a number, or text of a number with a unit of `table`. `what` is what is expected ("a length").
pub(super) fn quantity(
    tree: &Tree,
    what: &str,
    table: &UnitTable,
    cx: &mut Decoder,
) -> Option<Written> {
    let Tree::Text(text) = tree else {
        return finite(tree, what, cx).map(Written::Plain);
    };
    if of_decimal_comma(text).is_some() {
        return cx.mismatch(what, tree);
    }
    let names: Vec<&str> = table.iter().map(|unit| unit.0).collect();
    let Some((number, unit)) = split_number(text) else {
        let message = format!("expected {what}, found {}", tree.describe());
        return cx.error_with(
            message,
            format!(
                "write a number, or text with a unit ({})",
                listed(&names, "or")
            ),
        );
    };
    if unit.is_empty() {
        return cx.error_with(
            format!("\"{}\" is text without a unit", shortened(text)),
            format!(
                "leave out the quotes, or write a unit ({})",
                listed(&names, "or")
            ),
        );
    }
    let Some((_, factor)) = table.iter().find(|(name, _)| *name == unit) else {
        let message = format!("`{}` is not a unit of {}", shortened(unit), noun(what));
        let unknown = Diagnostic::error(message).at(cx.span(), "");
        cx.push(
            match nearest(unit, names.iter().copied()).filter(|_| unit.len() > 1) {
                Some(name) => unknown.help(format!(
                    "did you mean `{name}`? The units are {}",
                    listed(&names, "and")
                )),
                None => unknown.help(format!("the units are {}", listed(&names, "and"))),
            },
        );
        return None;
    };
    let value = number * factor + 0.0;
    if value.is_finite() {
        Some(Written::InUnit(value))
    } else {
        cx.error("the number is too large")
    }
}

/// The noun of `a length above 0`.
fn noun(what: &str) -> &str {
    let bare = what.split_once(' ').map_or(what, |words| words.1);
    [" above", " that", " from"]
        .iter()
        .fold(bare, |bare, limit| bare.split(limit).next().unwrap_or(bare))
}

pub(super) fn pattern(units: &str) -> String {
    format!(r"^\s*[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?\s*({units})\s*$")
}

/// Defines a quantity: how it is converted, and its limits.
macro_rules! quantity {
    (
        $(#[doc = $doc:literal])*
        $name:ident, $what:literal, $table:expr, $units:literal, $convert:expr $(, $test:expr, $limits:expr)?
    ) => {
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
        #[serde(transparent)]
        pub struct $name(pub f64);

        impl Decode for $name {
            fn decode(tree: &Tree, cx: &mut Decoder) -> Option<$name> {
                let written = quantity(tree, $what, $table, cx)?;
                let convert: fn(Written, &Decoder) -> f64 = $convert;
                let value = convert(written, cx) + 0.0;
                if !value.is_finite() || value.abs() > LARGEST {
                    return cx.error_with("the number is too large", format!("it can be at most {LARGEST:e}"));
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

/// A power of a length, in that power of the spec's unit.
fn in_powers(written: Written, cx: &Decoder, power: i32) -> f64 {
    let (value, unit) = match written {
        Written::Plain(value) => (value, cx.file_units().millimetres()),
        Written::InUnit(value) => (value, 1.0),
    };
    let factor = unit / cx.spec_units().millimetres();
    (0..power).fold(value, |value, _| value * factor)
}

pub(super) fn as_it_is(written: Written, _: &Decoder) -> f64 {
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
    /// An area, 0 or above: a number in squares of the file's unit, or text with its unit (`"120mm2"`, `"4cm2"`).
    Area, "an area that is not below 0", AREAS, "mm2|cm2|m2|in2", |written, cx| in_powers(written, cx, 2), |x| x >= 0.0, ("minimum", json!(0))
);
quantity!(
    /// A volume, 0 or above: a number in cubes of the file's unit, or text with its unit (`"120mm3"`, `"4cm3"`).
    Volume, "a volume that is not below 0", VOLUMES, "mm3|cm3|m3|in3", |written, cx| in_powers(written, cx, 3), |x| x >= 0.0, ("minimum", json!(0))
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

#[cfg(test)]
mod tests {
    use super::super::super::DecodeContext;
    use super::super::{Density, Extent, ForceVector, Fraction, Gravity, Scale, Unit};
    use super::*;

    fn read<T: Decode>(tree: impl Into<Tree>, scaled: bool) -> Result<T, String> {
        let context = DecodeContext {
            file: "f.yaml".into(),
            path: vec!["a".into()],
            file_units: Unit::Inch,
            spec_units: Unit::Centimetre,
            is_scaled: false,
            modules: Default::default(),
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
        assert_eq!(
            read::<Length>("1e308m", false),
            Err("the number is too large".into())
        );
        assert_eq!(
            read::<Length>(1e20, false),
            Err("the number is too large".into())
        );
        assert_eq!(
            read::<PositiveLength>(0, false),
            Err("expected a length above 0, found the number 0".into())
        );
        assert_eq!(
            read::<Length>("5furlongs", false),
            Err("`furlongs` is not a unit of length".into())
        );
        assert_eq!(
            read::<Length>("NaN", false),
            Err("expected a length, found text \"NaN\"".into())
        );
    }

    #[test]
    fn areas_and_volumes_are_in_powers_of_the_specs_unit() {
        let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
        close(read::<Area>(1, false).unwrap().0, 2.54 * 2.54);
        close(read::<Area>("50mm2", false).unwrap().0, 0.5);
        close(read::<Volume>(1, false).unwrap().0, 2.54 * 2.54 * 2.54);
        close(read::<Volume>("2cm3", false).unwrap().0, 2.0);
        assert!(read::<Volume>(-1, false).is_err());
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
        assert_eq!(
            read::<Extent>(5, false),
            Err("5 is neither a fraction nor a length with its unit".into())
        );
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
        assert_eq!(
            read(list(["0N", "1kN", "-20N"]), false),
            Ok(ForceVector([0.0, 1000.0, -20.0]))
        );
        assert_eq!(read([0, 0, -1], false), Ok(Gravity([0.0, 0.0, -9.81])));
        assert_eq!(
            read(list(["0m/s2", "0m/s2", "-1.62m/s2"]), false),
            Ok(Gravity([0.0, 0.0, -1.62]))
        );
        assert!(read::<Gravity>([0, 0, 0], false).is_err());
    }
}
