//! `${…}`: an expression of Starlark, its value, and the names it reads. Arithmetic takes a short
//! cut through `formula`; the rest, and every error message, is Starlark's.

use std::any::Any;
use std::collections::BTreeMap;
use std::sync::Arc;

use starlark::environment::Module;
use starlark::eval::Evaluator;
use starlark::syntax::Dialect;
use starlark::syntax::ast::{AstExpr, Stmt};

use crate::convert::{from_script, to_script};
use crate::expression::error::ExpressionError;
use crate::expression::names;
use crate::fault::Fault;
use crate::formula::tree::Name;
use crate::formula::{exact, parser};
use crate::language::{self, EXPRESSION, Parsed, constant};
use crate::library::Library;
use crate::ruler::{Held, Ruler};
use crate::sandbox::budget::Limits;
use crate::scale::Scale;
use crate::scope::Scope;
use crate::session::prepare;
use crate::value::Value;
use crate::values::session::Session;
use fretwork_diagnostic::nearest;
use fretwork_geometry::Seed;

const DIALECT: Dialect = Dialect {
    enable_def: false,
    enable_load: false,
    ..Dialect::Standard
};

/// The value of the expression `text`, in which the names of `scope`, `pi`, `deg` (one degree in
/// radians) and the mathematical functions have meaning; a name of `scope` goes before the others.
///
/// # Errors
/// Anything that Starlark does not accept, an unknown name (with the nearest known one), a division
/// by zero, a result that is no plain value or no finite number, and an expression that takes more
/// steps or memory than [`Limits::EXPRESSION`].
pub fn evaluate(text: &str, scope: &BTreeMap<Arc<str>, Value>) -> Result<Value, ExpressionError> {
    evaluated(text, scope, None)
}

/// The same where `text_width` measures with `ruler`.
///
/// # Errors
/// As [`evaluate`], and what the ruler says.
pub fn evaluate_with(
    text: &str,
    scope: &BTreeMap<Arc<str>, Value>,
    ruler: &Arc<dyn Ruler>,
) -> Result<Value, ExpressionError> {
    evaluated(text, scope, Some(ruler))
}

fn evaluated(
    text: &str,
    scope: &BTreeMap<Arc<str>, Value>,
    ruler: Option<&Arc<dyn Ruler>>,
) -> Result<Value, ExpressionError> {
    if let Ok(formula) = parser::parse(text)
        && let Some(value) = exact::evaluate(&formula, scope, constant)
        && value.number().is_none_or(f64::is_finite)
    {
        return Ok(value);
    }
    starlark(text, scope, ruler)
}

/// The names that the expression reads, functions included, each once, in the order of their first
/// mention; names that it binds itself (of lambdas and comprehensions) are not among them.
///
/// # Errors
/// Anything that Starlark does not accept.
pub fn free_names(text: &str) -> Result<Vec<String>, ExpressionError> {
    if let Ok(formula) = parser::parse(text) {
        let mut names: Vec<&Name> = formula.names.iter().chain(&formula.functions).collect();
        names.sort_by_key(|name| name.start);
        let mut out: Vec<String> = Vec::new();
        for name in names {
            if !out.iter().any(|known| **known == *name.name) {
                out.push(name.name.to_string());
            }
        }
        return Ok(out);
    }
    let parsed = Read::new(text)?;
    let names = names::free_names(parsed.expression()?);
    Ok(names.into_iter().map(|(name, ..)| name).collect())
}

/// A parsed expression. Texts of several lines are put in brackets, which let them break anywhere.
struct Read {
    parsed: Parsed,
    /// How many bytes of the text were left out before, less those put before.
    shift: isize,
    length: usize,
}

impl Read {
    fn new(text: &str) -> Result<Read, ExpressionError> {
        let trimmed = text.trim_start();
        let skipped = (text.len() - trimmed.len()) as isize;
        let trimmed = trimmed.trim_end();
        if trimmed.is_empty() {
            return Err(ExpressionError::new(
                "the expression is empty",
                0,
                text.len(),
            ));
        }
        let lines = trimmed.contains('\n');
        let (source, shift) = if lines {
            (format!("({trimmed}\n)"), skipped - 1)
        } else {
            (trimmed.to_owned(), skipped)
        };
        let place = |at: usize| at.saturating_add_signed(shift).min(text.len());
        let parsed = language::read("expression", &source, &DIALECT)
            .map_err(|e| ExpressionError::new(e.message, place(e.start), place(e.end)))?;
        Ok(Read {
            parsed,
            shift,
            length: text.len(),
        })
    }

    /// Where a byte of the parsed text is in the given one.
    fn place(&self, at: usize) -> usize {
        at.saturating_add_signed(self.shift).min(self.length)
    }

    fn expression(&self) -> Result<&AstExpr, ExpressionError> {
        let mut statement = self.parsed.plain.statement();
        while let Stmt::Statements(inner) = &statement.node
            && let [only] = inner.as_slice()
        {
            statement = only;
        }
        match &statement.node {
            Stmt::Expression(expression) => Ok(expression),
            _ => Err(ExpressionError::new(
                "this is a statement, not an expression",
                0,
                self.length,
            )),
        }
    }
}

fn starlark(
    text: &str,
    scope: &BTreeMap<Arc<str>, Value>,
    ruler: Option<&Arc<dyn Ruler>>,
) -> Result<Value, ExpressionError> {
    let read = Read::new(text)?;
    let names = names::free_names(read.expression()?);
    for (name, start, end) in &names {
        if !scope.contains_key(name.as_str()) && !EXPRESSION.iter().any(|(known, _)| known == name)
        {
            return Err(unknown(name, read.place(*start), read.place(*end), scope));
        }
    }
    let Parsed { ast, rewritten, .. } = read.parsed;
    let scope_of_nothing = Scope::entry(Seed::root(0));
    let session = Session::new(
        Limits::EXPRESSION,
        Library::empty(),
        scope_of_nothing,
        Scale::unit(),
        ruler.map(|ruler| Arc::new(Held(ruler.clone())) as Arc<dyn Any + Send + Sync>),
    );
    let result = Module::with_temp_heap(|module| {
        for (name, ..) in &names {
            if let Some((name, value)) = scope.get_key_value(name.as_str()) {
                module.set(name, to_script(value, module.heap()));
            }
        }
        let mut eval = Evaluator::new(&module);
        prepare(&mut eval, &session);
        let value = eval
            .eval_module(ast, &EXPRESSION)
            .map_err(|e| Fault::of(&e))?;
        from_script(value).map_err(|e| Fault::new(e.to_string()))
    });
    result.map_err(|fault| {
        let place = |at: usize| {
            rewritten
                .original(at)
                .saturating_add_signed(read.shift)
                .min(read.length)
        };
        let (start, end) = fault
            .place
            .map_or((0, read.length), |p| (place(p.start), place(p.end)));
        ExpressionError::new(fault.message, start, end)
    })
}

/// Where the functions of the language are listed.
const FUNCTIONS: &str = "`fretwork schema --functions` lists the functions that there are";

fn unknown(
    name: &str,
    start: usize,
    end: usize,
    scope: &BTreeMap<Arc<str>, Value>,
) -> ExpressionError {
    let globals: Vec<&str> = EXPRESSION
        .iter()
        .map(|g| g.0)
        .filter(|g| !g.starts_with('_'))
        .collect();
    // What the spec defines is meant rather than a function of the language.
    let near = nearest(name, scope.keys().map(|k| &**k)).or_else(|| nearest(name, globals));
    // The one name that the head of a map defines.
    let of_map = "the scale of a map defines it: `map: { scale: \"1:25000\" }`";
    let help = Some(match near {
        _ if name == "paper_mm" => of_map.to_owned(),
        Some(near) => format!("did you mean `{near}`?"),
        None if scope.is_empty() => FUNCTIONS.to_owned(),
        None => {
            let known: Vec<&str> = scope.keys().map(|name| &**name).take(8).collect();
            format!("the spec defines {}; {FUNCTIONS}", known.join(", "))
        }
    });
    ExpressionError {
        help,
        ..ExpressionError::new(format!("unknown name `{name}`"), start, end)
    }
}

#[cfg(test)]
mod tests;
