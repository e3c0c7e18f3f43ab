//! What keeps a script within its budget.
//!
//! The interpreter counts calls and rounds of loops, and looks at its heap once in a thousand of them.
//! Between two looks a single operation can do unbounded work: `x += x` thirty times doubles a list to a
//! thousand million elements, and a comparison of two towers of shared tuples takes longer than the
//! universe has had. So a text is made safe before it runs.
//!
//! 1. [`layout`] scans the text for brackets, without parsing it, and refuses one that is nested too deeply.
//!    The parser, the compiler and the garbage collector all recurse, and nothing catches an overflow of
//!    the stack.
//! 2. [`rewrite`] puts the names of natives into the text wherever an operation can grow or walk a large
//!    value: `xs.index(y)` becomes `_bounded_method(xs).index(y)`, `f(*xs)` becomes `f(*_bounded(xs))`, and
//!    `x += y` becomes `x += _bounded_adding(x, (y))`. It only inserts, so that a place in the new text
//!    has exactly one place in the old one, and errors point at what was written. Binary operators
//!    are replaced in the syntax tree, which keeps their precedence.
//! 3. [`natives`] charge the [`budget`] by the sizes of the operands ([`measure`], [`checks`]) and then do
//!    what Starlark does. For small values that is one comparison. [`standard`] does the same for the
//!    standard functions, [`range`] for `range`, and [`calls`] for methods whose cost depends on their arguments.
//!
//! Names that begin with `_bounded` are reserved, and `getattr` and `dir`, which could reach a method past
//! its native, do not exist. What one step may cost is charged before it is done, so a script that is stopped has
//! done no more than its budget allows and ends the same way on every machine.

pub(crate) mod budget;
pub(crate) mod calls;
pub(crate) mod checks;
pub(crate) mod layout;
pub(crate) mod measure;
pub(crate) mod natives;
pub(crate) mod range;
pub(crate) mod rewrite;
pub(crate) mod standard;
