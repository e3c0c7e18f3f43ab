//! Params: values of a file that a caller may override.

use std::sync::Arc;

use super::expression::has_expression;
use super::macros::{choice, record};
use super::scalar::{Angle, Fraction, Length, Text, Unit};
use super::value::{List, NonEmpty};
use super::{Decode, DecodeContext, Decoder, Tree};
use fretwork_diagnostic::Diagnostic;

choice! {
    /// The type of a param.
    pub enum ParamType {
        /// A number.
        number: Number,
        /// A whole number.
        integer: Integer,
        /// A length: text with a unit, or a number in the file's `units`. Expressions see a number in the file's `units`.
        length: Length,
        /// An angle: text with a unit, or a number of degrees. Expressions see a number of degrees.
        angle: Angle,
        /// A fraction from 0 to 1, or text with a percent sign. Expressions see a number from 0 to 1.
        fraction: Fraction,
        /// Text.
        text: Text,
        /// `true` or `false`.
        boolean: Boolean,
        /// A list.
        list: List,
    }
}

/// A value of a file that a caller may override.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Param {
    /// Its name, as expressions use it.
    pub name: Arc<str>,
    /// Its type; where the file does not say, that of its default.
    pub ty: ParamType,
    /// What it is unless a caller says otherwise, as [`Param::accept`] gives it.
    pub default: Tree,
    /// The least value, if there is one.
    pub min: Option<Tree>,
    /// The greatest value, if there is one.
    pub max: Option<Tree>,
    /// The values to choose from; empty where any will do.
    pub choices: Vec<Tree>,
    /// What it is for.
    pub doc: Option<Arc<str>>,
}

record! {
    /// A value that a caller may override with `--set NAME=VALUE`.
    pub struct ParamForm {
        /// What it is unless a caller says otherwise; no expression: what follows from other values stands under `let`.
        default: Tree,
        /// Its type. Without it, that of its default.
        r#type: Option<ParamType>,
        /// The least value.
        min: Option<Tree>,
        /// The greatest value.
        max: Option<Tree>,
        /// The values to choose from.
        choices: Option<NonEmpty<Tree>>,
        /// What it is for.
        doc: Option<Text>,
    }
}

impl ParamForm {
    /// The long form of a param of which only the default is written.
    fn of_default(default: &Tree) -> ParamForm {
        ParamForm {
            default: default.clone(),
            r#type: None,
            min: None,
            max: None,
            choices: None,
            doc: None,
        }
    }
}

impl Param {
    /// Reads the param `name`: its default alone, or the long form.
    pub(super) fn read(name: &Arc<str>, tree: &Tree, cx: &mut Decoder) -> Option<Param> {
        let (form, default_step) = match tree {
            Tree::Map(_) => (ParamForm::decode(tree, cx)?, Some("default")),
            _ => (ParamForm::of_default(tree), None),
        };
        let Some(ty) = form.r#type.or_else(|| ParamType::of(&form.default)) else {
            return cx.error(format!("a param cannot be {}", form.default.describe()));
        };
        let mut param = Param {
            name: name.clone(),
            ty,
            default: Tree::Null,
            min: None,
            max: None,
            choices: Vec::new(),
            doc: form.doc.map(|doc| doc.0),
        };
        let units = cx.file_units();
        let before = cx.diagnostics.len();
        if holds_expression(tree) {
            return cx.error_with(
                "a param cannot be an expression",
                "derive it from other params under `let`",
            );
        }
        param.min = form
            .min
            .and_then(|min| noted(cx, "min", ty.convert(&min, units)));
        param.max = form
            .max
            .and_then(|max| noted(cx, "max", ty.convert(&max, units)));
        for (n, choice) in form
            .choices
            .iter()
            .flat_map(|choices| choices.iter())
            .enumerate()
        {
            let step = n.to_string();
            param
                .choices
                .extend(cx.at("choices", |cx| noted(cx, &step, ty.convert(choice, units))));
        }
        if cx.diagnostics.len() > before {
            return None;
        }
        param.default = match default_step {
            Some(step) => noted(cx, step, param.accept(&form.default, units))?,
            None => param
                .accept(&form.default, units)
                .map_err(|message| cx.error::<()>(message))
                .ok()?,
        };
        Some(param)
    }

    /// The value as expressions see it: lengths are numbers in `units` (those of the file), angles
    /// numbers of degrees, fractions numbers from 0 to 1.
    ///
    /// # Errors
    /// What is wrong with it, in a sentence: its type, its limits, not one of the choices.
    pub fn accept(&self, value: &Tree, units: Unit) -> Result<Tree, String> {
        let value = self.ty.convert(value, units)?;
        let beyond = |limit: &Option<Tree>, test: fn(f64, f64) -> bool| {
            let limit =
                limit
                    .as_ref()
                    .filter(|limit| match (value.as_number(), limit.as_number()) {
                        (Some(value), Some(limit)) => test(value, limit),
                        _ => false,
                    });
            limit.map(Tree::describe)
        };
        if let Some(min) = beyond(&self.min, |value, min| value < min) {
            return Err(format!(
                "{} is below the least value, {min}",
                value.describe()
            ));
        }
        if let Some(max) = beyond(&self.max, |value, max| value > max) {
            return Err(format!(
                "{} is above the greatest value, {max}",
                value.describe()
            ));
        }
        let same = |choice: &Tree| {
            *choice == value
                || choice
                    .as_number()
                    .is_some_and(|c| value.as_number() == Some(c))
        };
        if self.choices.is_empty() || self.choices.iter().any(same) {
            return Ok(value);
        }
        let choices: Vec<String> = self.choices.iter().map(Tree::describe).collect();
        Err(format!(
            "{} is not one of the choices: {}",
            value.describe(),
            choices.join(", ")
        ))
    }

    /// The value as [`Param::accept`] gives it in `units`, where it is written in a file whose plain lengths are in `written`.
    ///
    /// # Errors
    /// As [`Param::accept`].
    pub fn accept_from(&self, value: &Tree, written: Unit, units: Unit) -> Result<Tree, String> {
        match value.as_number() {
            Some(length) if self.ty == ParamType::Length && written != units => {
                self.accept(&Tree::from(written.convert(length, units)), units)
            }
            _ => self.accept(value, units),
        }
    }

    /// The value that `text` stands for on a command line, as [`Param::accept`] gives it.
    ///
    /// # Errors
    /// As [`Param::accept`].
    pub fn parse(&self, text: &str, units: Unit) -> Result<Tree, String> {
        if self.ty == ParamType::Text {
            return self.accept(&Tree::from(text), units);
        }
        let file = Arc::from(&*self.name);
        let value = super::read::read(&file, text).map_err(|error| error.message)?;
        self.accept(&value.into_tree(), units)
    }
}

fn holds_expression(tree: &Tree) -> bool {
    match tree {
        Tree::Text(text) => has_expression(text),
        Tree::List(items) => items.iter().any(holds_expression),
        Tree::Map(entries) => entries.iter().any(|(_, value)| holds_expression(value)),
        Tree::Null | Tree::Bool(_) | Tree::Int(_) | Tree::Float(_) | Tree::Written(_) => false,
    }
}

fn noted(cx: &mut Decoder, step: &str, value: Result<Tree, String>) -> Option<Tree> {
    value
        .map_err(|message| cx.at(step, |cx| cx.error::<()>(message)))
        .ok()
}

impl ParamType {
    /// The unit of values as [`Param::accept`] gives them, where lengths are in `units`; none for what has no unit.
    pub fn unit(self, units: Unit) -> Option<&'static str> {
        match self {
            ParamType::Length => Some(units.word()),
            ParamType::Angle => Some("deg"),
            _ => None,
        }
    }

    fn of(value: &Tree) -> Option<ParamType> {
        match value.plain() {
            Tree::Bool(_) => Some(ParamType::Boolean),
            Tree::Int(_) | Tree::Float(_) => Some(ParamType::Number),
            Tree::Text(_) => Some(ParamType::Text),
            Tree::List(_) => Some(ParamType::List),
            Tree::Null | Tree::Map(_) | Tree::Written(_) => None,
        }
    }

    fn convert(self, value: &Tree, units: Unit) -> Result<Tree, String> {
        let context = DecodeContext {
            file: "".into(),
            path: Vec::new(),
            file_units: units,
            spec_units: units,
            is_scaled: false,
            modules: Default::default(),
        };
        let mut cx = Decoder::new(&context);
        let plain = value.as_number().is_some();
        let converted = match self {
            ParamType::Number => {
                super::scalar::Number::decode(value, &mut cx).map(|_| value.clone())
            }
            ParamType::Integer => {
                super::scalar::Integer::decode(value, &mut cx).map(|n| Tree::Int(n.0))
            }
            ParamType::Length => Length::decode(value, &mut cx).map(|length| Tree::from(length.0)),
            ParamType::Angle => {
                Angle::decode(value, &mut cx).map(|angle| Tree::from(angle.0.to_degrees()))
            }
            ParamType::Fraction => {
                Fraction::decode(value, &mut cx).map(|fraction| Tree::from(fraction.0))
            }
            ParamType::Text => Text::decode(value, &mut cx).map(|text| Tree::Text(text.0)),
            ParamType::Boolean => bool::decode(value, &mut cx).map(Tree::Bool),
            ParamType::List => List::<Tree>::decode(value, &mut cx).map(|_| value.clone()),
        };
        match converted {
            // What was a plain number stays as it was written.
            Some(_) if plain && self != ParamType::Text && self != ParamType::Integer => {
                Ok(value.clone())
            }
            Some(converted) => Ok(converted),
            None => Err(cx.diagnostics.first().map_or_else(String::new, sentence)),
        }
    }
}

/// A diagnostic's message with its advice.
fn sentence(diagnostic: &Diagnostic) -> String {
    match &diagnostic.help {
        Some(help) => format!("{}: {help}", diagnostic.message),
        None => diagnostic.message.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn param(form: Tree) -> Result<Param, Vec<String>> {
        let context = DecodeContext {
            file: "f.yaml".into(),
            path: vec!["params".into(), "p".into()],
            file_units: Unit::Millimetre,
            spec_units: Unit::Millimetre,
            is_scaled: false,
            modules: Default::default(),
        };
        let mut cx = Decoder::new(&context);
        let param = Param::read(&"p".into(), &form, &mut cx);
        let messages: Vec<String> = cx.diagnostics.iter().map(|d| d.message.clone()).collect();
        if messages.is_empty() {
            Ok(param.expect("it has no errors"))
        } else {
            Err(messages)
        }
    }

    #[test]
    fn a_length_is_a_number_in_the_files_unit() {
        let choices = Tree::from([150, 165, 180]);
        let wrist = Tree::map([
            ("default", Tree::Int(165)),
            ("type", Tree::from("length")),
            ("choices", choices),
        ]);
        let wrist = param(wrist).unwrap();
        assert_eq!(wrist.default, Tree::Int(165));
        assert_eq!(wrist.parse("18cm", Unit::Millimetre), Ok(Tree::from(180.0)));
        assert_eq!(wrist.parse("150", Unit::Millimetre), Ok(Tree::Int(150)));
        let wrong = wrist.parse("6.5in", Unit::Millimetre).unwrap_err();
        assert_eq!(
            wrong,
            "the number 165.1 is not one of the choices: the number 150, the number 165, the number 180"
        );
        assert!(
            wrist
                .parse("6.5inch", Unit::Millimetre)
                .unwrap_err()
                .contains("not a unit of length")
        );
    }

    #[test]
    fn limits_and_types_are_kept() {
        let courses = param(Tree::map([
            ("default", Tree::Int(12)),
            ("min", Tree::Int(1)),
            ("max", Tree::Int(100)),
        ]))
        .unwrap();
        assert_eq!(courses.ty, ParamType::Number);
        assert!(courses.parse("0", Unit::Millimetre).is_err());
        assert!(courses.parse("nan", Unit::Millimetre).is_err());
        assert!(courses.parse("[1]", Unit::Millimetre).is_err());
        assert_eq!(
            param(Tree::from("a")).unwrap().parse("12", Unit::Inch),
            Ok(Tree::from("12"))
        );
        assert_eq!(
            param(Tree::map([
                ("default", Tree::Int(0)),
                ("min", Tree::Int(1))
            ])),
            Err(vec![
                "the number 0 is below the least value, the number 1".to_owned()
            ])
        );
        assert_eq!(
            param(Tree::Null),
            Err(vec!["a param cannot be nothing".to_owned()])
        );
        for form in [
            Tree::from("${a}"),
            Tree::map([("default", Tree::from("${a}")), ("doc", Tree::from("x"))]),
        ] {
            assert_eq!(
                param(form),
                Err(vec!["a param cannot be an expression".to_owned()])
            );
        }
    }
}
