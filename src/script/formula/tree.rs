//! A parsed formula: steps for a stack machine, and the names that it reads.

use std::sync::Arc;

use crate::mathematics::Function;

/// One step. Jumps are relative to the step after them, so that a piece of program can be moved.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Op {
    Int(i64),
    Float(f64),
    Text(Arc<str>),
    Bool(bool),
    None,
    /// The name of this number in [`Formula::names`].
    Name(u32),
    Negate,
    Plus,
    Not,
    Binary(Binary),
    /// Takes its arguments, of which there are as many as said.
    Call(Function, u32),
    Jump(u32),
    /// Takes the condition.
    JumpUnless(u32),
    /// Leaves the value where it jumps, else takes it: `and`.
    JumpIfFalse(u32),
    /// Likewise: `or`.
    JumpIfTrue(u32),
}

/// An operator with two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    FloorDivide,
    Remainder,
    Equal,
    NotEqual,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
}

/// A name that a formula reads, and where it first does.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Name {
    pub name: Arc<str>,
    pub start: usize,
    pub end: usize,
}

/// A parsed formula.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Formula {
    pub ops: Vec<Op>,
    pub names: Vec<Name>,
    /// The functions it calls, which are names too.
    pub functions: Vec<Name>,
    /// How many values it needs at once.
    pub depth: usize,
}

/// Why a text is no formula; it may still be Starlark.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FormulaError {
    pub message: String,
    pub start: usize,
    pub end: usize,
    pub help: Option<String>,
}
