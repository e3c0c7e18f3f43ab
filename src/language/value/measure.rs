//! The measures that values have: their names, what they are counted in, and how people see them. How they are taken is
//! not known here.

use serde_json::Value as Json;

use super::super::scalar::Unit;

/// What a measure is counted in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// It is a whole number of things.
    Count,
    /// It is a number without a unit.
    Number,
    /// It is a length in the spec's unit.
    Length,
    /// It is an area in squares of the spec's unit.
    Area,
    /// It is a volume in cubes of the spec's unit.
    Volume,
    /// It is a pressure or a stress in pascals.
    Pressure,
    /// It is a mass in kilograms.
    Mass,
    /// It holds or it does not.
    Flag,
    /// It is the least and the greatest corner of a box with sides along the axes.
    Corners,
    /// It is a list or a table, which is only shown.
    Table,
}

use Dimension::{Area, Corners, Count, Flag, Length, Mass, Number, Pressure, Table, Volume};

/// All measures, by name; those of a table by its name and theirs, with a point between.
pub const MEASURES: &[(&str, Dimension)] = &[
    ("components", Count),
    ("holes", Count),
    ("min_width", Length),
    ("bounds", Corners),
    ("area", Area),
    ("volume", Volume),
    ("length", Length),
    ("width", Length),
    ("height", Length),
    ("parts", Count),
    ("triangles", Count),
    ("genus", Count),
    ("cavities", Count),
    ("watertight", Flag),
    ("vertices", Count),
    ("edges", Count),
    ("faces", Count),
    ("closed", Flag),
    ("planar", Flag),
    ("pieces_in", Count),
    ("pieces_out", Count),
    ("pieces", Table),
    ("seam_cost", Number),
    ("copies", Count),
    ("around", Count),
    ("surface_area", Area),
    ("stretch", Table),
    ("flat", Table),
    ("columns", Count),
    ("rows", Count),
    ("x", Table),
    ("y", Table),
    ("layers", Table),
    ("shapes", Table),
    ("alignment_error", Number),
    ("size_error", Number),
    ("min", Number),
    ("mean", Number),
    ("max", Number),
    ("defined", Number),
    ("pixel_size", Length),
    ("tileable", Flag),
    ("solid_fraction", Number),
    ("voxels", Count),
    ("solid_voxels", Count),
    ("voxel", Length),
    ("iterations", Count),
    ("done", Flag),
    ("min_feature", Length),
    ("elements", Count),
    ("max_displacement", Length),
    ("mass", Mass),
    ("residual", Number),
    ("solver_iterations", Count),
    ("stress.mean", Pressure),
    ("stress.median", Pressure),
    ("stress.p99", Pressure),
    ("stress.max", Pressure),
    ("von_mises.mean", Pressure),
    ("von_mises.median", Pressure),
    ("von_mises.p99", Pressure),
    ("von_mises.max", Pressure),
    ("safety_factor.p99", Number),
    ("safety_factor.max", Number),
    ("worst_gravity.p99", Pressure),
    ("worst_gravity.max_displacement", Length),
    ("worst_gravity.safety_factor.p99", Number),
    ("worst_gravity.safety_factor.max", Number),
    ("solid_fraction.before", Number),
    ("solid_fraction.after", Number),
    ("bridges.connection", Count),
    ("bridges.stress", Count),
    ("bridges.geodesic", Count),
    ("bytes", Count),
];

impl Dimension {
    /// That of the measure called `name`.
    pub fn of(name: &str) -> Option<Dimension> {
        let found = MEASURES.iter().find(|(known, _)| *known == name);
        found.map(|(_, dimension)| *dimension)
    }

    /// How its unit is written where lengths are in `unit`: `mm²`. Nothing for what has none.
    pub fn unit(self, unit: Unit) -> String {
        let power = match self {
            Length | Corners => "",
            Area => "²",
            Volume => "³",
            Pressure => return "Pa".to_owned(),
            Mass => return "kg".to_owned(),
            Count | Number | Flag | Table => return String::new(),
        };
        format!("{}{power}", unit.word())
    }
}

/// A number for people: with four decimals at most, or four digits where it is small.
pub fn shown_number(x: f64) -> String {
    let decimals = if x.abs() >= 1.0 || x == 0.0 {
        4
    } else {
        let leading = -libm::floor(libm::log10(x.abs())) as usize;
        (leading + 3).min(12)
    };
    let text = format!("{x:.decimals$}");
    let text = if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        &text
    };
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}

/// A measure for people, with its unit; of a table each of its measures.
pub fn shown_measure(name: &str, value: &Json, unit: Unit) -> String {
    if let Json::Object(entries) = value {
        let shown = entries.iter().map(|(key, value)| {
            let full = format!("{name}.{key}");
            format!("{key} {}", shown_measure(&full, value, unit))
        });
        return format!("{{ {} }}", shown.collect::<Vec<_>>().join(", "));
    }
    let unit = Dimension::of(name).map_or_else(String::new, |dimension| dimension.unit(unit));
    let text = shown_value(value);
    // A picture is so many pixels wide.
    if unit.is_empty() || value.is_null() || value.is_u64() {
        text
    } else {
        format!("{text} {unit}")
    }
}

fn shown_value(value: &Json) -> String {
    match value {
        Json::Number(number) if number.is_f64() => {
            number.as_f64().map_or_else(String::new, shown_number)
        }
        Json::Array(items) => {
            let items: Vec<String> = items.iter().map(shown_value).collect();
            format!("[{}]", items.join(", "))
        }
        Json::Null => "none".to_owned(),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn units_follow_from_what_is_measured() {
        let unit = |name| Dimension::of(name).map(|d| d.unit(Unit::Inch));
        assert_eq!(unit("volume").as_deref(), Some("in³"));
        assert_eq!(unit("bounds").as_deref(), Some("in"));
        assert_eq!(unit("holes").as_deref(), Some(""));
        assert_eq!(unit("weight"), None);
    }

    #[test]
    fn people_see_four_digits_and_the_unit() {
        let shown = |name, value| shown_measure(name, &value, Unit::Millimetre);
        assert_eq!(shown("area", json!(3600.0)), "3600 mm²");
        assert_eq!(shown("volume", json!(12.345678)), "12.3457 mm³");
        assert_eq!(shown("min_width", json!(0.000123456)), "0.0001235 mm");
        assert_eq!(shown("min_width", json!(null)), "none");
        assert_eq!(
            shown("bounds", json!([[0.0, 1.5], [2.0, 3.0]])),
            "[[0, 1.5], [2, 3]] mm"
        );
        assert_eq!(shown("holes", json!(100)), "100");
        assert_eq!(
            shown(
                "worst_gravity",
                json!({ "p99": 2.5e6, "safety_factor": { "max": 2.25 } })
            ),
            "{ p99 2500000 Pa, safety_factor { max 2.25 } }"
        );
    }
}
