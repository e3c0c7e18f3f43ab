//! Runs a formula on exact values, whole numbers apart from others, as Starlark does. Whatever is
//! unusual (an error, a list, a whole number beyond 64 bits) gives no value, and the caller asks
//! Starlark, which alone words the errors.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::formula::scalar;
use crate::formula::tree::{Binary, Formula, Op};
use crate::mathematics::Number;
use crate::value::Value;

/// Texts longer than this are left to Starlark and its budget.
const TEXT: usize = 1 << 16;

/// The value of `formula` where its names mean `scope` and `constants`, or nothing.
pub(crate) fn evaluate(
    formula: &Formula,
    scope: &BTreeMap<Arc<str>, Value>,
    constant: impl Fn(&str) -> Option<f64>,
) -> Option<Value> {
    if formula
        .functions
        .iter()
        .any(|f| scope.contains_key(&f.name))
    {
        return None;
    }
    let mut machine = Machine {
        formula,
        stack: Vec::with_capacity(formula.depth),
        at: 0,
    };
    let meaning = |name: &Arc<str>| {
        let known = scope.get(name).cloned();
        known.or_else(|| constant(name).map(Value::Float))
    };
    while let Some(op) = formula.ops.get(machine.at) {
        machine.at += 1;
        machine.step(op, meaning)?;
    }
    machine.stack.pop()
}

/// A stack machine in the middle of a formula.
struct Machine<'f> {
    formula: &'f Formula,
    stack: Vec<Value>,
    /// The number of the next step.
    at: usize,
}

impl Machine<'_> {
    /// Takes one step; `meaning` gives the values of names.
    fn step(&mut self, op: &Op, meaning: impl Fn(&Arc<str>) -> Option<Value>) -> Option<()> {
        let value = match op {
            Op::Int(i) => Value::Int(*i),
            Op::Float(f) => Value::Float(*f),
            Op::Text(text) => Value::Text(text.clone()),
            Op::Bool(b) => Value::Bool(*b),
            Op::None => Value::None,
            Op::Name(n) => meaning(&self.formula.names[*n as usize].name)?,
            Op::Negate | Op::Plus => signed(self.stack.pop()?, *op == Op::Negate)?,
            Op::Not => Value::Bool(!truth(&self.stack.pop()?)),
            Op::Binary(operator) => {
                let (right, left) = (self.stack.pop()?, self.stack.pop()?);
                binary(*operator, &left, &right)?
            }
            Op::Call(function, count) => {
                let first = self.stack.len().checked_sub(*count as usize)?;
                let args = self.stack.split_off(first);
                let args: Vec<Number> = args.iter().map(number).collect::<Option<_>>()?;
                function.call(&args).ok()?.into()
            }
            Op::Jump(_) | Op::JumpUnless(_) | Op::JumpIfFalse(_) | Op::JumpIfTrue(_) => {
                return self.jump(op);
            }
        };
        self.stack.push(value);
        Some(())
    }

    /// Goes on elsewhere, if the condition of the jump holds.
    fn jump(&mut self, op: &Op) -> Option<()> {
        match op {
            Op::Jump(by) => self.at += *by as usize,
            Op::JumpUnless(by) => {
                let holds = truth(&self.stack.pop()?);
                self.at += if holds { 0 } else { *by as usize };
            }
            Op::JumpIfFalse(by) | Op::JumpIfTrue(by) => {
                if truth(self.stack.last()?) == matches!(op, Op::JumpIfTrue(_)) {
                    self.at += *by as usize;
                } else {
                    self.stack.pop();
                }
            }
            _ => {}
        }
        Some(())
    }
}

impl From<Number> for Value {
    fn from(number: Number) -> Value {
        match number {
            Number::Int(i) => Value::Int(i),
            Number::Float(f) => Value::Float(f),
        }
    }
}

fn number(value: &Value) -> Option<Number> {
    match value {
        Value::Int(i) => Some(Number::Int(*i)),
        Value::Float(f) => Some(Number::Float(*f)),
        _ => None,
    }
}

fn truth(value: &Value) -> bool {
    match value {
        Value::None => false,
        Value::Bool(b) => *b,
        Value::Int(i) => *i != 0,
        Value::Float(f) => *f != 0.0,
        Value::Text(text) => !text.is_empty(),
        Value::List(items) => !items.is_empty(),
        Value::Dict(items) => !items.is_empty(),
    }
}

fn signed(operand: Value, negate: bool) -> Option<Value> {
    match number(&operand)? {
        Number::Int(i) if negate => Some(Value::Int(i.checked_neg()?)),
        Number::Float(f) if negate => Some(Value::Float(-f)),
        _ => Some(operand),
    }
}

fn binary(operator: Binary, left: &Value, right: &Value) -> Option<Value> {
    match operator {
        Binary::Equal => Some(Value::Bool(equal(left, right)?)),
        Binary::NotEqual => Some(Value::Bool(!equal(left, right)?)),
        Binary::Less | Binary::LessOrEqual | Binary::Greater | Binary::GreaterOrEqual => {
            let order = order(left, right)?;
            Some(Value::Bool(match operator {
                Binary::Less => order.is_lt(),
                Binary::LessOrEqual => order.is_le(),
                Binary::Greater => order.is_gt(),
                _ => order.is_ge(),
            }))
        }
        _ => match (left, right) {
            (Value::Text(a), Value::Text(b))
                if operator == Binary::Add && a.len() + b.len() <= TEXT =>
            {
                Some(Value::Text(format!("{a}{b}").into()))
            }
            _ => arithmetic(operator, number(left)?, number(right)?).map(Value::from),
        },
    }
}

fn equal(left: &Value, right: &Value) -> Option<bool> {
    match (left, right) {
        (Value::List(_) | Value::Dict(_), _) | (_, Value::List(_) | Value::Dict(_)) => None,
        (Value::Int(_) | Value::Float(_), Value::Int(_) | Value::Float(_)) => {
            Some(order(left, right)?.is_eq())
        }
        _ => Some(left == right),
    }
}

fn order(left: &Value, right: &Value) -> Option<std::cmp::Ordering> {
    match (left, right) {
        (Value::Text(a), Value::Text(b)) => Some(a.cmp(b)),
        _ => number(left)?.order(number(right)?),
    }
}

fn arithmetic(operator: Binary, left: Number, right: Number) -> Option<Number> {
    if let (Number::Int(a), Number::Int(b)) = (left, right) {
        let whole = match operator {
            Binary::Add => a.checked_add(b),
            Binary::Subtract => a.checked_sub(b),
            Binary::Multiply => a.checked_mul(b),
            Binary::FloorDivide => {
                let towards_zero = a.checked_div(b)?;
                Some(towards_zero - i64::from(a % b != 0 && (a < 0) != (b < 0)))
            }
            Binary::Remainder => {
                let rest = a.checked_rem(b)?;
                Some(if rest != 0 && (rest < 0) != (b < 0) {
                    rest + b
                } else {
                    rest
                })
            }
            _ => {
                return if b == 0 {
                    None
                } else {
                    Some(Number::Float(a as f64 / b as f64))
                };
            }
        };
        return whole.map(Number::Int);
    }
    let (a, b) = (left.float(), right.float());
    let divides = matches!(
        operator,
        Binary::Divide | Binary::FloorDivide | Binary::Remainder
    );
    if divides && b == 0.0 {
        None
    } else {
        Some(Number::Float(scalar::arithmetic(operator, a, b)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formula::parser::parse;

    fn value(text: &str) -> Option<Value> {
        let scope = BTreeMap::from([
            (Arc::from("n"), Value::Int(5)),
            (Arc::from("w"), Value::Text("abc".into())),
        ]);
        evaluate(&parse(text).ok()?, &scope, |name| {
            (name == "pi").then_some(std::f64::consts::PI)
        })
    }

    #[test]
    fn whole_numbers_and_others_are_kept_apart() {
        assert_eq!(value("7 // 2 + n"), Some(Value::Int(8)));
        assert_eq!(value("-7 // 2"), Some(Value::Int(-4)));
        assert_eq!(value("-7 % 3"), Some(Value::Int(2)));
        assert_eq!(value("7 / 2"), Some(Value::Float(3.5)));
        assert_eq!(value("floor(7 / 2) * 2.0"), Some(Value::Float(6.0)));
        assert_eq!(value("9223372036854775807 + 1"), None);
    }

    #[test]
    fn conditions_take_one_arm() {
        assert_eq!(value("1 if n > 3 else 1 // 0"), Some(Value::Int(1)));
        assert_eq!(
            value("1 // 0 if n < 3 else w + 'd'"),
            Some(Value::Text("abcd".into()))
        );
        assert_eq!(
            value("n == 5 and w == 'abc' and not n < 0"),
            Some(Value::Bool(true))
        );
        assert_eq!(value("0 or n"), Some(Value::Int(5)));
        assert_eq!(
            value("(1 if False else 2 if False else 3) + 1"),
            Some(Value::Int(4))
        );
    }

    #[test]
    fn the_unusual_is_left_to_starlark() {
        for text in ["1 / 0", "w * 2", "w < 1", "missing", "sqrt(-1)", "sin(w)"] {
            assert_eq!(value(text), None, "{text}");
        }
    }
}
