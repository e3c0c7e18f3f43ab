//! Measures compared: without what is another number only by rounding.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Map, Value};

/// Measures by name.
type Measures = Map<String, Value>;

/// The measures that differ, before and after; null for one that is not there.
pub fn changed(before: &Measures, after: &Measures) -> BTreeMap<String, [Value; 2]> {
    let names: BTreeSet<&String> = before.keys().chain(after.keys()).collect();
    let pair = |name: &&String| {
        [before, after].map(|measures| measures.get(*name).cloned().unwrap_or_default())
    };
    let pairs = names.into_iter().map(|name| (name.clone(), pair(&name)));
    let differing = pairs.filter(|(_, [a, b])| !is_same(a, b));
    differing
        .map(|(name, pair)| (name, pair.map(without_noise)))
        .collect()
}

/// Measures that differ by less are the same, as a part of their size; and numbers below it are zero.
const NOISE: f64 = 1e-9;

/// Whether two measures are the same but for rounding.
fn is_same(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Number(a), Value::Number(b)) => {
            let [a, b] = [a, b].map(|n| n.as_f64().unwrap_or_default());
            (a - b).abs() <= NOISE * a.abs().max(b.abs()).max(1.0)
        }
        (Value::Array(a), Value::Array(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| is_same(a, b))
        }
        (Value::Object(a), Value::Object(b)) => {
            a.len() == b.len()
                && a.iter()
                    .zip(b)
                    .all(|((x, a), (y, b))| x == y && is_same(a, b))
        }
        (a, b) => a == b,
    }
}

/// A measure with zeros for what is none only by rounding.
fn without_noise(value: Value) -> Value {
    match value {
        Value::Number(number) => match number.as_f64() {
            Some(v) if number.is_f64() && v.abs() < NOISE => 0.0.into(),
            _ => Value::Number(number),
        },
        Value::Array(items) => items.into_iter().map(without_noise).collect(),
        Value::Object(fields) => {
            let fields = fields.into_iter();
            fields.map(|(name, v)| (name, without_noise(v))).collect()
        }
        value => value,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn measures(value: Value) -> Measures {
        value.as_object().cloned().unwrap_or_default()
    }

    #[test]
    fn noise_is_no_change_and_no_number() {
        let before = measures(
            json!({ "area": 12.6, "bounds": [[-1.8e-16, 0.0], [4.0, 3.0]], "holes": 3, "old": true }),
        );
        let after = measures(
            json!({ "area": 12.600000000001, "bounds": [[1e-15, 0], [4.5, 3.0]], "holes": 3, "new": "a" }),
        );
        let found = changed(&before, &after);
        assert_eq!(
            found["bounds"],
            [
                json!([[0.0, 0.0], [4.0, 3.0]]),
                json!([[0.0, 0], [4.5, 3.0]])
            ]
        );
        assert_eq!(found["old"], [json!(true), Value::Null]);
        assert_eq!(found["new"], [Value::Null, json!("a")]);
        assert_eq!(found.len(), 3);
        assert!(changed(&after, &after).is_empty());
    }
}
