//! `${…}`: an expression of Starlark, its value, and the names it reads. Arithmetic takes a short
//! cut through `formula`; the rest, and every error message, is Starlark's.

use std::collections::BTreeMap;
use std::sync::Arc;

use starlark::environment::Module;
use starlark::eval::Evaluator;
use starlark::syntax::Dialect;
use starlark::syntax::ast::{AstExpr, Stmt};

use super::convert::{from_script, to_script};
use super::fault::Fault;
use super::formula;
use super::guard::Limits;
use super::language::{self, EXPRESSION, Guarded};
use super::library::Library;
use super::names;
use super::scope::Scope;
use super::session::{Scale, Session};
use super::value::Value;
use fretwork_diagnostic::nearest;
use fretwork_geometry::Seed;

pub(super) use super::language::constant;

/// What is wrong with an expression, and where: bytes of its text.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct ExpressionError {
    /// One sentence without a full stop.
    pub message: String,
    /// The first byte it is about.
    pub start: usize,
    /// One past the last.
    pub end: usize,
    /// What to do about it.
    pub help: Option<String>,
}

impl ExpressionError {
    pub(super) fn new(message: impl Into<String>, start: usize, end: usize) -> ExpressionError {
        ExpressionError {
            message: message.into(),
            start,
            end,
            help: None,
        }
    }
}

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
    if let Ok(formula) = formula::parse(text)
        && let Some(value) = formula::evaluate(&formula, scope, constant)
        && value.number().is_none_or(f64::is_finite)
    {
        return Ok(value);
    }
    starlark(text, scope)
}

/// The names that the expression reads, functions included, each once, in the order of their first
/// mention; names that it binds itself (of lambdas and comprehensions) are not among them.
///
/// # Errors
/// Anything that Starlark does not accept.
pub fn free_names(text: &str) -> Result<Vec<String>, ExpressionError> {
    if let Ok(formula) = formula::parse(text) {
        let mut names: Vec<&formula::Name> =
            formula.names.iter().chain(&formula.functions).collect();
        names.sort_by_key(|name| name.start);
        let mut out: Vec<String> = Vec::new();
        for name in names {
            if !out.iter().any(|known| **known == *name.name) {
                out.push(name.name.to_string());
            }
        }
        return Ok(out);
    }
    let guarded = Read::new(text)?;
    let names = names::free_names(guarded.expression()?);
    Ok(names.into_iter().map(|(name, ..)| name).collect())
}

/// A parsed expression. Texts of several lines are put in brackets, which let them break anywhere.
struct Read {
    guarded: Guarded,
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
        let guarded = language::read("expression", &source, &DIALECT)
            .map_err(|e| ExpressionError::new(e.message, place(e.start), place(e.end)))?;
        Ok(Read {
            guarded,
            shift,
            length: text.len(),
        })
    }

    /// Where a byte of the parsed text is in the given one.
    fn place(&self, at: usize) -> usize {
        at.saturating_add_signed(self.shift).min(self.length)
    }

    fn expression(&self) -> Result<&AstExpr, ExpressionError> {
        let mut statement = self.guarded.plain.statement();
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

fn starlark(text: &str, scope: &BTreeMap<Arc<str>, Value>) -> Result<Value, ExpressionError> {
    let read = Read::new(text)?;
    let names = names::free_names(read.expression()?);
    for (name, start, end) in &names {
        if !scope.contains_key(name.as_str()) && !EXPRESSION.iter().any(|(known, _)| known == name)
        {
            return Err(unknown(name, read.place(*start), read.place(*end), scope));
        }
    }
    let Guarded { ast, rewritten, .. } = read.guarded;
    let scope_of_nothing = Scope::entry(Seed::root(0));
    let session = Session::new(
        Limits::EXPRESSION,
        Library::empty(),
        scope_of_nothing,
        Scale::unit(),
        None,
    );
    let result = Module::with_temp_heap(|module| {
        for (name, ..) in &names {
            if let Some((name, value)) = scope.get_key_value(name.as_str()) {
                module.set(name, to_script(value, module.heap()));
            }
        }
        let mut eval = Evaluator::new(&module);
        super::session::prepare(&mut eval, &session);
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
    let help = near.map(|near| format!("did you mean `{near}`?"));
    ExpressionError {
        help,
        ..ExpressionError::new(format!("unknown name `{name}`"), start, end)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn scope() -> BTreeMap<Arc<str>, Value> {
        BTreeMap::from([
            (Arc::from("n"), Value::Int(7)),
            (Arc::from("width"), Value::Float(12.5)),
            (Arc::from("name"), Value::Text("oak".into())),
            (
                Arc::from("sizes"),
                Value::List(vec![Value::Int(1), Value::Int(2)]),
            ),
        ])
    }

    fn value(text: &str) -> Value {
        evaluate(text, &scope()).unwrap_or_else(|e| panic!("{text}: {e:?}"))
    }

    fn error(text: &str) -> ExpressionError {
        evaluate(text, &scope()).expect_err(text)
    }

    #[test]
    fn expressions_have_their_values() {
        assert_eq!(value("n"), Value::Int(7));
        assert_eq!(
            value(" width / (2 * pi) "),
            Value::Float(12.5 / (2.0 * std::f64::consts::PI))
        );
        assert_eq!(value("180 * deg"), Value::Float(std::f64::consts::PI));
        assert_eq!(
            value("[x * n for x in range(3)]"),
            Value::List(vec![Value::Int(0), Value::Int(7), Value::Int(14)])
        );
        assert_eq!(value("name + '-%d' % n"), Value::Text("oak-7".into()));
        assert_eq!(value("{'a': sizes}['a'][-1]"), Value::Int(2));
        assert_eq!(value("max(sizes) + sum(sizes) + len(name)"), Value::Int(8));
        assert_eq!(value("None"), Value::None);
        assert_eq!(value("(\n  1 +\n  2\n)"), Value::Int(3));
        assert_eq!(value("1 +\n2"), Value::Int(3));
        assert_eq!(
            value("', '.join([str(s) for s in sizes])"),
            Value::Text("1, 2".into())
        );
        assert_eq!(
            value("(name).upper()[0:2].lower()"),
            Value::Text("oa".into())
        );
        assert_eq!(value("(lambda a, b = n: a * b)(3)"), Value::Int(21));
        assert_eq!(value("max(*sizes) * round(2.5)"), Value::Int(6));
        assert_eq!(
            value("2 in sizes and 3 not in sizes and sizes == [1, 2]"),
            Value::Bool(true)
        );
        assert_eq!(
            value("'{} x {}'.format(width, n)"),
            Value::Text("12.5 x 7".into())
        );
        assert_eq!(value("((1, 2), (3,))"), value("[[1, 2], [3]]"));
    }

    #[test]
    fn names_of_the_scope_go_before_others() {
        let scope = BTreeMap::from([
            (Arc::from("pi"), Value::Int(3)),
            (Arc::from("floor"), Value::Int(4)),
        ]);
        assert_eq!(evaluate("pi + floor", &scope), Ok(Value::Int(7)));
        assert_eq!(
            evaluate("[pi]", &scope),
            Ok(Value::List(vec![Value::Int(3)]))
        );
    }

    #[test]
    fn errors_name_their_place_and_the_nearest_name() {
        let e = error("1 + widht");
        assert_eq!(
            (e.message.as_str(), e.start, e.end),
            ("unknown name `widht`", 4, 9)
        );
        assert_eq!(e.help.as_deref(), Some("did you mean `width`?"));
        let e = error("  flor(width)");
        assert_eq!(
            (e.start, e.end, e.help.as_deref()),
            (2, 6, Some("did you mean `floor`?"))
        );
        let e = error("[1, n / 0]");
        assert_eq!((e.start, e.end), (4, 9), "{e:?}");
        assert!(e.message.contains("zero"), "{e:?}");
        let e = error("(name * 2)[0] + (name.join)(1)");
        assert!(e.start >= 16 && e.end <= 30, "{e:?}");
        assert_eq!(
            error("sqrt(0 - 1)").message,
            "sqrt(-1) is NaN, which is not a usable number"
        );
        assert!(error("1e308 * 10").message.contains("not a usable number"));
        assert!(
            error("name + 1").message.contains("+"),
            "{:?}",
            error("name + 1")
        );
        assert!(error("lambda: 1").message.contains("function"));
        for text in [
            "",
            "  ",
            "x = 1",
            "1; 2",
            "1 2",
            "def f(): pass",
            "load('a', 'b')",
            "1) + (2",
            "import os",
            "%",
            "'a",
        ] {
            error(text);
        }
    }

    #[test]
    fn free_names_leave_out_what_is_bound() {
        assert_eq!(free_names("a + floor(b) * a").unwrap(), ["a", "floor", "b"]);
        assert_eq!(
            free_names("[x + y for x in rows if x > z]").unwrap(),
            ["rows", "z", "y"]
        );
        assert_eq!(
            free_names("(lambda p, q = r: p + q + s)(t)").unwrap(),
            ["r", "s", "t"]
        );
        assert_eq!(
            free_names("{k: v for k, v in pairs}[w].m(u = 1)").unwrap(),
            ["pairs", "w"]
        );
        assert!(free_names("1 +").is_err());
    }

    /// Each of these would take hours or gigabytes unbounded.
    #[test]
    fn attacks_end_quickly_with_an_error() {
        let doubled = |inner: &str| {
            (0..40).fold(inner.to_owned(), |text, _| {
                format!("(lambda a: a + a)({text})")
            })
        };
        let tower = (0..40).fold("[1]".to_owned(), |text, _| {
            format!("(lambda a: [a, a])({text})")
        });
        let tuples = (0..40).fold("(1,)".to_owned(), |text, _| {
            format!("(lambda a: (a, a))({text})")
        });
        let attacks = [
            "[i for i in range(1000000) for j in range(1000000)]".to_owned(),
            "max(range(2000000000))".into(),
            "range(2000000000)".into(),
            "range(20000000000)".into(),
            "range(-9223372036854775807, 9223372036854775807)".into(),
            "range(20000000000, 20000000001)".into(),
            "'x' * 300000000".into(),
            "[0] * 300000000".into(),
            "300000000 * (1, 2)".into(),
            doubled("[1]"),
            doubled("'ab'"),
            (0..30).fold("3".to_owned(), |text, _| {
                format!("(lambda a: a * a)({text})")
            }),
            "1 << 2000000000".into(),
            "(lambda f: f(f))(lambda f: f(f))".into(),
            format!("str({tower})"),
            format!("'%s' % {tower}"),
            format!("'{{}}'.format({tower})"),
            format!("{tower} == {tower}"),
            format!("{{{tuples}: 1}}"),
            "('x' * 100000).replace('x', 'x' * 100000)".into(),
            "('x' * 100000).join(['y'] * 100000)".into(),
            "[[0] * 1000000 for i in range(1000)]".into(),
            "[([0] * 100000)[:] for i in range(100000)]".into(),
            "[list(range(1000000)) for i in range(900)]".into(),
            "[l.extend(l) for l in [[1]] for i in range(60)]".into(),
            "[sorted(l) for l in [[0] * 100000] for i in range(100000)]".into(),
            "[x in l for l in [[0] * 1000000] for x in range(1000000)]".into(),
            "int('9' * 1000000)".into(),
            "sum([[1] * 100000] * 1000, [])".into(),
            "(".repeat(100_000),
            "-".repeat(100_000) + "1",
            "[".repeat(300) + &"]".repeat(300),
            vec!["1"; 100_000].join("+") + " + x.y",
            vec!["a"; 20_000].join(" if a else "),
            "x".repeat(2 << 20),
        ];
        for attack in attacks {
            let start = std::time::Instant::now();
            let e = evaluate(&attack, &scope());
            let shown: String = attack.chars().take(60).collect();
            assert!(e.is_err(), "{shown}");
            assert!(
                start.elapsed().as_millis() < 2000,
                "{shown}: {:?}",
                start.elapsed()
            );
        }
    }

    #[test]
    fn deep_but_allowed_nesting_fits_a_small_stack() {
        let run = || {
            for text in [
                format!("{}1{}", "(".repeat(180), ")".repeat(180)),
                format!("{}1{}", "[".repeat(180), "]".repeat(180)),
                "-".repeat(190) + "n + [0][0]",
                vec!["n"; 190].join("+") + "+[1][0]",
                format!("{}1{}", "(lambda: ".repeat(90), ")".repeat(90)) + "if 0 else 1",
            ] {
                let _ = evaluate(&text, &scope())
                    .map_err(|e| assert!(!e.message.contains("deeply"), "{e:?} {text}"));
            }
        };
        std::thread::Builder::new()
            .stack_size(1 << 20)
            .spawn(run)
            .unwrap()
            .join()
            .unwrap();
    }

    fn formulas() -> impl Strategy<Value = String> {
        let leaf = prop_oneof![
            (0_i64..5).prop_map(|i| i.to_string()),
            Just("2.5".to_owned()),
            Just("n".to_owned()),
            Just("width".to_owned()),
            Just("name".to_owned()),
            Just("True".to_owned()),
            Just("None".to_owned()),
            Just("9223372036854775807".to_owned()),
        ];
        leaf.prop_recursive(4, 24, 3, |inner| {
            let operators = [
                "+", "-", "*", "/", "//", "%", "==", "!=", "<", ">=", "and", "or",
            ];
            let functions = ["floor", "round", "abs", "sqrt", "ceil", "sin", "sign"];
            prop_oneof![
                (inner.clone(), 0..operators.len(), inner.clone())
                    .prop_map(move |(a, op, b)| format!("({a} {} {b})", operators[op])),
                (inner.clone(), inner.clone(), inner.clone())
                    .prop_map(|(a, c, b)| format!("({a} if {c} else {b})")),
                (0..functions.len(), inner.clone())
                    .prop_map(move |(f, a)| format!("{}({a})", functions[f])),
                (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("max({a}, {b})")),
                inner.clone().prop_map(|a| format!("-{a}")),
                inner.prop_map(|a| format!("(not {a})")),
            ]
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn the_short_cut_agrees_with_starlark(text in formulas()) {
            let scope = scope();
            let short = formula::parse(&text).ok().and_then(|f| formula::evaluate(&f, &scope, constant));
            if let Some(short) = short {
                match starlark(&text, &scope) {
                    Ok(long) => prop_assert_eq!(format!("{short:?}"), format!("{long:?}")),
                    Err(e) => prop_assert!(short.number().is_some_and(|n| !n.is_finite()), "{:?} {:?}", short, e),
                }
            }
        }

        #[test]
        fn no_text_ends_the_process(text in "[-+*/%<>=!()\\[\\]{}a-c0-9. ,:'\"\\\\n\n]{0,40}") {
            let _ = evaluate(&text, &scope());
            let _ = free_names(&text);
        }
    }
}
