//! Arithmetic as a small program for a stack machine: the common part of Starlark's expressions
//! (numbers, texts, names, operators, comparisons, conditions, mathematical functions), parsed by
//! hand. It is what a field evaluates a million times, and the short cut for most `${…}`. Lists,
//! methods, lambdas and comprehensions are on purpose not here: Starlark itself reads those.

pub(crate) mod exact;
pub(crate) mod lexer;
pub(crate) mod parser;
pub(crate) mod scalar;
pub(crate) mod tree;
