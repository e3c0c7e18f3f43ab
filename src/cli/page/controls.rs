//! The parameters of a spec: controls where somebody listens, a table where nobody does.

use maud::{Markup, html};
use serde_json::Value;

use super::super::exhibit::Spec;
use fretwork_engine::ParamReport;
use fretwork_language::value::shown_number;

/// The parameters of a spec; `line` is the command line that builds with the values that are tried out.
pub fn shown(spec: &Spec, is_live: bool, line: Option<&str>) -> Markup {
    html! {
        form.params data-params=(spec.path) autocomplete="off" {
            h3 { "Parameters" }
            @for param in &spec.params {
                div.param data-param-row=(param.name) title=[param.doc.as_deref()] {
                    label { (param.name) @if let Some(unit) = param.unit { " " span.quiet { (unit) } } }
                    @if is_live { (control(&spec.path, param)) }
                    @else { output { (text(&param.value)) } }
                    @if let Some(doc) = &param.doc { p.doc { (doc) } }
                }
            }
            @if is_live {
                div.trial data-part={ "trial " (spec.path) } {
                    @if let Some(line) = line {
                        p { "Tried out here, and written nowhere. The same from a shell:" }
                        code data-command { @for word in line.split_inclusive(' ') { span { (word) } } }
                        p.buttons {
                            button type="button" data-copy=(line) { "copy" }
                            button type="button" data-reset-all=(spec.path) { "reset" }
                        }
                    }
                }
                p.refused data-refused=(spec.path) role="alert" hidden {}
            }
        }
    }
}

/// The control of a parameter: a slider where both limits are known, a list where the values are, a box for yes and no.
fn control(spec: &str, param: &ParamReport) -> Markup {
    let (name, value, default) = (&param.name, text(&param.value), text(&param.default));
    let id = format!("{spec} {name}");
    if !param.choices.is_empty() {
        return html! {
            select #(id) data-param=(name) data-spec=(spec) data-default=(default) aria-label=(name) {
                @for choice in param.choices.iter().map(text) {
                    option value=(choice) selected[choice == value] { (choice) }
                }
            }
        };
    }
    if param.value.is_boolean() {
        return html! {
            input #(id) type="checkbox" checked[value == "true"] data-param=(name) data-spec=(spec) data-default=(default) aria-label=(name);
        };
    }
    let limits = (number(&param.min), number(&param.max), param.value.as_f64());
    if let (Some(min), Some(max), Some(_)) = limits
        && min < max
    {
        return html! {
            input #(id) type="range" min=(min) max=(max) step=(step(param)) value=(value) data-param=(name) data-spec=(spec) data-default=(default)
                data-step=(nice(min, max)) aria-label=(name);
            input.exact type="text" inputmode="decimal" value=(value) data-exact=(name) aria-label={ (name) " as a number" };
        };
    }
    let mode = if param.value.is_number() {
        "decimal"
    } else {
        "text"
    };
    html! {
        input #(id) type="text" inputmode=(mode) value=(value) data-param=(name) data-spec=(spec) data-default=(default) aria-label=(name);
    }
}

fn number(value: &Option<Value>) -> Option<f64> {
    value.as_ref().and_then(Value::as_f64)
}

/// Whole numbers step by one; others are wherever they are, and the script rounds what a hand has set.
fn step(param: &ParamReport) -> &'static str {
    let is_whole = |value: &Value| value.is_i64() || value.is_u64();
    let limits = [&param.min, &param.max].into_iter().flatten();
    let is_count = ["integer", "int", "count"].contains(&&*param.param_type);
    if is_count && limits.chain([&param.default]).all(is_whole) {
        "1"
    } else {
        "any"
    }
}

/// A round number of which there are some hundred between two limits.
fn nice(min: f64, max: f64) -> String {
    let mut step = 1.0;
    while step * 100.0 > max - min && step > 1e-9 {
        step /= 10.0;
    }
    while step * 1000.0 < max - min {
        step *= 10.0;
    }
    shown_number(step)
}

/// A value as it would be typed.
fn text(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Number(number) => match number.as_f64() {
            Some(float) if number.is_f64() => shown_number(float),
            _ => number.to_string(),
        },
        other => other.to_string(),
    }
}
