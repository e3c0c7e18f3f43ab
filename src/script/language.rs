//! The language of scripts: Starlark as its standard says, with the standard functions within
//! budgets and the mathematical ones added. Reads text to a syntax tree that is safe to run.

use std::sync::LazyLock;

use starlark::environment::{Globals, GlobalsBuilder};
use starlark::syntax::{AstModule, Dialect};

use crate::mathematics::FUNCTIONS;
use crate::ruler;
use crate::sandbox::layout::Layout;
use crate::sandbox::rewrite::{OPERATORS, Rewritten, rewrite};
use crate::sandbox::standard;
use crate::values::function::MathFunction;

/// The longest text that is read, in bytes.
const LONGEST: usize = 1 << 20;

/// What an expression can call.
pub(crate) static EXPRESSION: LazyLock<Globals> = LazyLock::new(|| {
    let builder = GlobalsBuilder::standard().with(register);
    builder.with(ruler::register).build()
});

/// Puts mathematics and the bounded standard functions among the globals.
pub fn register(builder: &mut GlobalsBuilder) {
    standard::register(builder);
    for (name, function, ..) in FUNCTIONS {
        // `min` and `max` take lists too, which the bounded standard functions do.
        if !matches!(name, "min" | "max") {
            builder.set(name, MathFunction { function });
        }
    }
    for name in ["pi", "deg"] {
        builder.set(name, constant(name).expect("both are constants"));
    }
}

/// The value of a constant of the language: `pi`, and `deg`, one degree in radians.
pub(crate) fn constant(name: &str) -> Option<f64> {
    match name {
        "pi" => Some(std::f64::consts::PI),
        "deg" => Some(std::f64::consts::PI / 180.0),
        _ => None,
    }
}

/// A text that parses, ready to be run.
pub(crate) struct Parsed {
    /// As written, for looking at.
    pub plain: AstModule,
    /// With the natives of the sandbox in it.
    pub ast: AstModule,
    /// From places in the rewritten text to places in the plain one.
    pub rewritten: Rewritten,
}

/// Why a text is no Starlark; the place is in bytes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SyntaxError {
    pub message: String,
    pub start: usize,
    pub end: usize,
}

/// Parses `text`, twice: the second time with the natives of the sandbox in it.
pub(crate) fn read(file: &str, text: &str, dialect: &Dialect) -> Result<Parsed, SyntaxError> {
    let at = |message: &str, start: usize, end: usize| SyntaxError {
        message: message.into(),
        start,
        end,
    };
    if text.len() > LONGEST {
        return Err(at("the text is longer than 1 MiB", 0, text.len()));
    }
    if let Some(start) = reserved(text) {
        return Err(at(
            "names that begin with `_bounded` are reserved",
            start,
            start + "_bounded".len(),
        ));
    }
    let layout =
        Layout::read(text).map_err(|deep| at("this is nested too deeply", deep.at, deep.at))?;
    let parse =
        |text: &str| AstModule::parse(file, text.to_owned(), dialect).map_err(|e| syntax_error(&e));
    let plain = parse(text)?;
    let rewritten = rewrite(text, &layout, plain.statement());
    let mut ast = parse(&rewritten.text).map_err(|e| SyntaxError {
        start: rewritten.original(e.start),
        end: rewritten.original(e.end),
        ..e
    })?;
    let operators = OPERATORS.map(|(operator, native)| (operator.to_owned(), native.to_owned()));
    ast.replace_binary_operators(&operators.into_iter().collect());
    Ok(Parsed {
        plain,
        ast,
        rewritten,
    })
}

/// Where a name begins that could stand for one of the natives of the sandbox.
fn reserved(text: &str) -> Option<usize> {
    let begins_name =
        |at: &usize| !text[..*at].ends_with(|c: char| c == '_' || c.is_alphanumeric());
    text.match_indices("_bounded")
        .map(|(at, _)| at)
        .find(begins_name)
}

fn syntax_error(e: &starlark::Error) -> SyntaxError {
    let message = e.without_diagnostic().to_string();
    let span = e.span().map_or((0, 0), |s| {
        (s.span.begin().get() as usize, s.span.end().get() as usize)
    });
    SyntaxError {
        message: message.trim_end_matches('.').to_owned(),
        start: span.0,
        end: span.1,
    }
}
