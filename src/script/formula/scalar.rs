//! A formula of the coordinates, run in floating point as often as a field asks.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::expression::error::ExpressionError;
use crate::formula::parser::parse;
use crate::formula::tree::{Binary, Formula, FormulaError, Name, Op};
use crate::language::constant;
use crate::mathematics::{FUNCTIONS, Function};
use crate::value::Value;
use fretwork_diagnostic::nearest;

/// How many values a formula may need at once.
const STACK: usize = 32;

/// A function of x, y and z, compiled: a field that an expression describes.
///
/// It knows numbers, `x`, `y`, `z`, the names given to it, `pi` and `deg`, the operators
/// `+ - * / // %`, comparisons, `and or not`, `a if c else b`, and the mathematical functions
/// (angles in radians). A comparison is worth 1 or 0.
#[derive(Clone, Debug, PartialEq)]
pub struct ScalarExpression {
    steps: Vec<Step>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Step {
    Number(f64),
    Coordinate(u8),
    Negate,
    Not,
    Binary(Binary),
    Call(Function, u32),
    Jump(u32),
    JumpUnless(u32),
    JumpIfFalse(u32),
    JumpIfTrue(u32),
}

impl ScalarExpression {
    /// Reads `text`. Names other than x, y and z mean `constants`, of which only numbers are usable.
    ///
    /// # Errors
    /// Anything that is no arithmetic, an unknown name or function, a name that is no number, a
    /// wrong number of arguments; with the place in `text`.
    pub fn compile(
        text: &str,
        constants: &BTreeMap<Arc<str>, Value>,
    ) -> Result<ScalarExpression, ExpressionError> {
        ScalarExpression::compile_over(text, &[], constants)
    }

    /// Reads `text`, in which `more` are names of variables after x, y and z; at most 200.
    ///
    /// # Errors
    /// As [`ScalarExpression::compile`].
    pub fn compile_over(
        text: &str,
        more: &[Arc<str>],
        constants: &BTreeMap<Arc<str>, Value>,
    ) -> Result<ScalarExpression, ExpressionError> {
        let formula = parse(text)?;
        if formula.depth > STACK {
            return Err(ExpressionError::new(
                "the expression is nested too deeply",
                0,
                text.len(),
            ));
        }
        let steps = formula
            .ops
            .iter()
            .map(|op| step(op, &formula, more, constants))
            .collect::<Result<_, _>>()?;
        Ok(ScalarExpression { steps })
    }

    /// The value at (x, y, z): NaN or infinite where the formula has none (a division by zero,
    /// the root of a negative number).
    pub fn value(&self, x: f64, y: f64, z: f64) -> f64 {
        self.value_over(&[x, y, z])
    }

    /// The value where x, y, z and the variables after them are these, which are as many as it was compiled with.
    pub fn value_over(&self, variables: &[f64]) -> f64 {
        let mut stack = [0.0; STACK];
        let mut top = 0; // one past the last value
        let mut at = 0;
        while let Some(step) = self.steps.get(at) {
            at += 1;
            match *step {
                Step::Number(value) => {
                    stack[top] = value;
                    top += 1;
                }
                Step::Coordinate(which) => {
                    stack[top] = variables[which as usize];
                    top += 1;
                }
                Step::Negate => stack[top - 1] = -stack[top - 1],
                Step::Not => stack[top - 1] = f64::from(u8::from(stack[top - 1] == 0.0)),
                Step::Binary(operator) => {
                    top -= 1;
                    stack[top - 1] = arithmetic(operator, stack[top - 1], stack[top]);
                }
                Step::Call(function, count) => {
                    let first = top - count as usize;
                    stack[first] = function.value(&stack[first..top]);
                    top = first + 1;
                }
                Step::Jump(by) => at += by as usize,
                Step::JumpUnless(by) => {
                    top -= 1;
                    at += if stack[top] == 0.0 { by as usize } else { 0 };
                }
                Step::JumpIfFalse(by) | Step::JumpIfTrue(by) => {
                    if (stack[top - 1] != 0.0) == matches!(step, Step::JumpIfTrue(_)) {
                        at += by as usize;
                    } else {
                        top -= 1;
                    }
                }
            }
        }
        stack[0]
    }

    /// Whether z is among its variables: then it is a function of space, not of the plane.
    pub fn uses_z(&self) -> bool {
        self.steps.contains(&Step::Coordinate(2))
    }
}

fn step(
    op: &Op,
    formula: &Formula,
    more: &[Arc<str>],
    constants: &BTreeMap<Arc<str>, Value>,
) -> Result<Step, ExpressionError> {
    let only_numbers = |what: &str| {
        ExpressionError::new(format!("{what} cannot stand in a formula of x and y"), 0, 0)
    };
    Ok(match op {
        Op::Int(i) => Step::Number(*i as f64),
        Op::Float(f) => Step::Number(*f),
        Op::Bool(b) => Step::Number(f64::from(u8::from(*b))),
        Op::Text(_) => return Err(only_numbers("a text")),
        Op::None => return Err(only_numbers("None")),
        Op::Name(n) => return name(&formula.names[*n as usize], more, constants),
        Op::Negate => Step::Negate,
        Op::Plus => Step::Jump(0),
        Op::Not => Step::Not,
        Op::Binary(operator) => Step::Binary(*operator),
        Op::Call(function, count) => Step::Call(*function, *count),
        Op::Jump(by) => Step::Jump(*by),
        Op::JumpUnless(by) => Step::JumpUnless(*by),
        Op::JumpIfFalse(by) => Step::JumpIfFalse(*by),
        Op::JumpIfTrue(by) => Step::JumpIfTrue(*by),
    })
}

fn name(
    name: &Name,
    more: &[Arc<str>],
    constants: &BTreeMap<Arc<str>, Value>,
) -> Result<Step, ExpressionError> {
    let variables = ["x", "y", "z"].into_iter().chain(more.iter().map(|m| &**m));
    let mut numbered = (0..=u8::MAX).zip(variables.clone());
    if let Some((which, _)) = numbered.find(|(_, variable)| *variable == &*name.name) {
        return Ok(Step::Coordinate(which));
    }
    let error = |message: String| ExpressionError::new(message, name.start, name.end);
    if let Some(value) = constants.get(&name.name) {
        let number = value
            .number()
            .ok_or_else(|| error(format!("`{}` is {}, not a number", name.name, value.kind())));
        return number.map(Step::Number);
    }
    if let Some(value) = constant(&name.name) {
        return Ok(Step::Number(value));
    }
    let known = variables
        .chain(["pi", "deg"])
        .chain(constants.keys().map(|k| &**k));
    let known = known.chain(FUNCTIONS.iter().map(|f| f.0));
    let help = nearest(&name.name, known).map(|near| format!("did you mean `{near}`?"));
    Err(ExpressionError {
        help,
        ..error(format!("unknown name `{}`", name.name))
    })
}

impl From<FormulaError> for ExpressionError {
    fn from(e: FormulaError) -> ExpressionError {
        ExpressionError {
            message: e.message,
            start: e.start,
            end: e.end,
            help: e.help,
        }
    }
}

/// `left operator right` in floating point; comparisons are 1 or 0, `//` and `%` round down.
pub(crate) fn arithmetic(operator: Binary, left: f64, right: f64) -> f64 {
    let truth = |t: bool| f64::from(u8::from(t));
    match operator {
        Binary::Add => left + right,
        Binary::Subtract => left - right,
        Binary::Multiply => left * right,
        Binary::Divide => left / right,
        Binary::FloorDivide => libm::floor(left / right),
        Binary::Remainder => {
            let rest = left % right;
            if rest == 0.0 {
                0.0
            } else if rest.is_sign_negative() != right.is_sign_negative() {
                rest + right
            } else {
                rest
            }
        }
        Binary::Equal => truth(left == right),
        Binary::NotEqual => truth(left != right),
        Binary::Less => truth(left < right),
        Binary::LessOrEqual => truth(left <= right),
        Binary::Greater => truth(left > right),
        Binary::GreaterOrEqual => truth(left >= right),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn compiled(text: &str) -> Result<ScalarExpression, ExpressionError> {
        let constants = BTreeMap::from([
            (Arc::from("size"), Value::Int(2000)),
            (Arc::from("word"), Value::Text("no".into())),
        ]);
        ScalarExpression::compile(text, &constants)
    }

    #[test]
    fn formulas_have_their_values() {
        let at = |text: &str, x: f64, y: f64| compiled(text).unwrap().value(x, y, 7.0);
        assert_eq!(at("atan2(size / 2 - y, 1000 - x)", 0.0, 1000.0), 0.0);
        assert_eq!(at("0.5 + 0.4 * sin(x / 110.0)", 0.0, 0.0), 0.5);
        assert_eq!(at("x if x > y else y - z", 1.0, 9.0), 2.0);
        assert_eq!(at("(x > 1 and y > 1) + (x > 1 or y > 1)", 0.0, 5.0), 1.0);
        assert_eq!(at("-x % 3 + 7 // 2 + +1", 1.0, 0.0), 6.0);
        assert_eq!(
            at(
                "hypot(x, y) + max(1, 2, 3) - abs(-45 * deg / pi * 4)",
                3.0,
                4.0
            ),
            7.0
        );
        assert!(at("sqrt(-1 - x)", 0.0, 0.0).is_nan());
        assert!(compiled("x + z").unwrap().uses_z() && !compiled("x").unwrap().uses_z());
    }

    #[test]
    fn errors_show_the_place_and_the_nearest_name() {
        let error = compiled("sin(x) + cosine(y)").unwrap_err();
        assert_eq!((error.start, error.end), (9, 15));
        assert_eq!(error.message, "unknown function `cosine`");
        let error = compiled("1 + sise").unwrap_err();
        assert_eq!(error.help.as_deref(), Some("did you mean `size`?"));
        assert_eq!((error.start, error.end), (4, 8));
        assert_eq!(
            compiled("2 * word").unwrap_err().message,
            "`word` is a text, not a number"
        );
        assert_eq!(
            compiled("atan2(x)").unwrap_err().message,
            "`atan2` takes 2 arguments, 1 given"
        );
        for text in [
            "",
            "x +",
            "x y",
            "1 < x < 2",
            "[x]",
            "x = 2",
            "(x",
            "x)",
            "sin",
            "2mm",
            "x if y",
            "é",
        ] {
            assert!(compiled(text).is_err(), "{text}");
        }
        assert!(compiled(&"(".repeat(100_000)).is_err());
        assert!(compiled(&"-".repeat(100_000)).is_err());
        assert!(compiled(&("1+(".repeat(60) + "1" + &")".repeat(60))).is_err());
    }

    #[test]
    fn long_sums_need_no_stack() {
        let text = vec!["x"; 50_000].join("+");
        assert_eq!(compiled(&text).unwrap().value(1.0, 0.0, 0.0), 50_000.0);
    }
}
