//! Measures as they are handed out: without the noise of rounding, with their unit.

use serde_json::Value as Json;

use fretwork_language::scalar::Unit;

/// Decimals that every number keeps.
const DECIMALS: i32 = 4;
/// Digits that small numbers keep, the leading one included.
const DIGITS: i32 = 9;

/// `measures` with numbers of at least four decimals and nine digits, and no more, and a field `units` that says what
/// lengths are in; areas and volumes are in its squares and cubes.
pub fn report(measures: Json, unit: Unit) -> Json {
    let mut measures = rounded(measures);
    if let Json::Object(fields) = &mut measures {
        fields.insert("units".to_owned(), unit.word().into());
    }
    measures
}

fn rounded(value: Json) -> Json {
    match value {
        Json::Number(number) if number.is_f64() => number
            .as_f64()
            .map_or(Json::Null, |x| round(x, decimals(x)).into()),
        Json::Array(items) => items.into_iter().map(rounded).collect(),
        Json::Object(fields) => fields.into_iter().map(|(k, v)| (k, rounded(v))).collect(),
        other => other,
    }
}

/// How many decimals a number keeps.
fn decimals(x: f64) -> usize {
    if x == 0.0 {
        return 0;
    }
    let leading = libm::floor(libm::log10(x.abs())) as i32;
    (DIGITS - 1 - leading).max(DECIMALS) as usize
}

/// The number that is written with so many decimals.
fn round(x: f64, decimals: usize) -> f64 {
    let written = format!("{x:.decimals$}");
    written.parse().unwrap_or(x) + 0.0
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn numbers_lose_their_noise_and_keep_what_they_say() {
        let measures = json!({ "area": 12.600000000000001, "min": 1.23456789012e-7, "holes": 3, "bounds": [[-0.0, 2.0]] });
        let report = report(measures, Unit::Metre);
        assert_eq!(report["area"], json!(12.6));
        assert_eq!(report["min"], json!(1.23456789e-7));
        assert_eq!(report["bounds"], json!([[0.0, 2.0]]));
        assert_eq!(
            (&report["holes"], &report["units"]),
            (&json!(3), &json!("m"))
        );
    }
}
