//! Puts the natives of the sandbox into a script's text: around receivers of copying methods, sliced
//! values, `*args`, and the right side of augmented assignments. Binary operators are replaced in
//! the syntax tree by [`OPERATORS`]. Only insertions are made, so that a place in the new text is
//! a place in the old one.

use starlark::codemap::Span;
use starlark::syntax::ast::{ArgumentP, AssignOp, AssignTargetP, AstExpr, AstStmt, Expr, Stmt};

use crate::sandbox::layout::Layout;

/// The binary operators that go through a native, with its name.
pub(crate) const OPERATORS: [(&str, &str); 13] = [
    ("+", "_bounded_add"),
    ("*", "_bounded_multiply"),
    ("%", "_bounded_percent"),
    ("<<", "_bounded_shift"),
    ("|", "_bounded_or"),
    ("==", "_bounded_equal"),
    ("!=", "_bounded_unequal"),
    ("<", "_bounded_less"),
    ("<=", "_bounded_at_most"),
    (">", "_bounded_greater"),
    (">=", "_bounded_at_least"),
    ("in", "_bounded_in"),
    ("not in", "_bounded_not_in"),
];

/// Methods whose result can be much larger than what they are called on, or whose message about an
/// argument that they refuse, which shows it.
const GROWING: [&str; 24] = [
    "count",
    "endswith",
    "extend",
    "find",
    "format",
    "index",
    "insert",
    "join",
    "lstrip",
    "partition",
    "pop",
    "removeprefix",
    "removesuffix",
    "replace",
    "rfind",
    "rindex",
    "rpartition",
    "rsplit",
    "rstrip",
    "split",
    "splitlines",
    "startswith",
    "strip",
    "update",
];

/// Other methods that walk or copy what they are called on.
const WALKING: [&str; 12] = [
    "capitalize",
    "codepoints",
    "elems",
    "isalnum",
    "isalpha",
    "items",
    "keys",
    "lower",
    "remove",
    "title",
    "upper",
    "values",
];

/// The new text, and how to get from it to the old one.
#[derive(Debug)]
pub(crate) struct Rewritten {
    pub text: String,
    /// Places in the old text, and what was put there.
    insertions: Vec<(usize, String)>,
}

impl Rewritten {
    /// The place in the old text of a place in the new one; inside an insertion, where it was made.
    pub fn original(&self, at: usize) -> usize {
        let mut shift = 0;
        for (place, inserted) in &self.insertions {
            if at < place + shift {
                break;
            }
            if at < place + shift + inserted.len() {
                return *place;
            }
            shift += inserted.len();
        }
        at - shift
    }
}

/// The rewritten form of `text`, of which `statement` is the tree.
pub(crate) fn rewrite(text: &str, layout: &Layout, statement: &AstStmt) -> Rewritten {
    let mut rewriter = Rewriter {
        text,
        layout,
        insertions: Vec::new(),
    };
    rewriter.statement(statement);
    statement.visit_expr(|expression| rewriter.expression(expression));
    let mut insertions = rewriter.insertions;
    // What ends at a place goes before what begins there; of several ends the inner one comes first.
    insertions.sort_by_key(|(place, rank, _)| (*place, *rank));
    let mut out = String::with_capacity(text.len() + insertions.len() * 16);
    let mut at = 0;
    for (place, _, inserted) in &insertions {
        out += &text[at..*place];
        out += inserted;
        at = *place;
    }
    out += &text[at..];
    Rewritten {
        text: out,
        insertions: insertions
            .into_iter()
            .map(|(place, _, text)| (place, text))
            .collect(),
    }
}

struct Rewriter<'a> {
    text: &'a str,
    layout: &'a Layout,
    /// Place, order at that place, text.
    insertions: Vec<(usize, i64, String)>,
}

fn bytes(span: Span) -> (usize, usize) {
    (span.begin().get() as usize, span.end().get() as usize)
}

/// The native that the right side of an augmented assignment passes through, if it can grow.
fn native_of(op: AssignOp) -> Option<&'static str> {
    match op {
        AssignOp::Add => Some("_bounded_adding"),
        AssignOp::Multiply => Some("_bounded_multiplying"),
        AssignOp::Percent => Some("_bounded_filling"),
        AssignOp::LeftShift => Some("_bounded_shifting"),
        AssignOp::BitOr => Some("_bounded_joining"),
        _ => None,
    }
}

impl Rewriter<'_> {
    fn statement(&mut self, statement: &AstStmt) {
        if let Stmt::AssignModify(target, op, right) = &statement.node {
            let (start, from) = bytes(target.span);
            let (right_start, _) = bytes(right.span);
            let (_, end) = bytes(statement.span);
            // The `=` of the operator; between it and the right side stand only blanks and brackets.
            if let Some(equals) = self.text[from..right_start].find('=')
                && let Some(native) = native_of(*op)
            {
                // Adding needs the old value only to see its size; a product and a format need it.
                let is_name = matches!(target.node, AssignTargetP::Identifier(_));
                let old = if is_name || *op != AssignOp::Add {
                    &self.text[start..from]
                } else {
                    "None"
                };
                let before = format!(" {native}({old}, (");
                self.wrap(from + equals + 1, end, before, "))");
            }
        }
        statement.visit_stmt(|inner| self.statement(inner));
    }

    fn wrap(&mut self, start: usize, end: usize, before: String, after: &str) {
        // At one place: first ends, the shortest span first; then beginnings, the longest first.
        let length = (end - start) as i64;
        self.insertions
            .push((end, length - i64::from(i32::MAX), after.to_owned()));
        self.insertions.push((start, -length, before));
    }

    fn expression(&mut self, expression: &AstExpr) {
        match &expression.node {
            Expr::Dot(receiver, name) if GROWING.contains(&name.node.as_str()) => {
                let (start, end) = self.extent(receiver, bytes(name.span).0);
                self.wrap(start, end, "_bounded_method(".into(), ")");
            }
            Expr::Dot(receiver, name) if WALKING.contains(&name.node.as_str()) => {
                let (start, end) = self.extent(receiver, bytes(name.span).0);
                self.wrap(start, end, "_bounded(".into(), ")");
            }
            Expr::Tuple(items) if !items.is_empty() => {
                let (start, end) = bytes(expression.span);
                self.wrap(start, end, "_bounded_tuple((".into(), "))");
            }
            Expr::Slice(value, ..) => {
                let open = self.trailer(value);
                let (start, end) = self.extent(value, open);
                self.wrap(start, end, "_bounded(".into(), ")");
            }
            Expr::Call(_, args) => {
                for argument in &args.args {
                    if let ArgumentP::Args(value) | ArgumentP::KwArgs(value) = &argument.node {
                        let stars = if matches!(argument.node, ArgumentP::Args(_)) {
                            1
                        } else {
                            2
                        };
                        let (start, end) = bytes(argument.span);
                        self.wrap(
                            start + stars,
                            end.max(bytes(value.span).1),
                            "_bounded(".into(),
                            ")",
                        );
                    }
                }
            }
            _ => {}
        }
        expression.visit_expr(|inner| self.expression(inner));
    }

    /// Where the bracket of the call, index or slice after `value` opens.
    fn trailer(&self, value: &AstExpr) -> usize {
        self.layout
            .first_opened(bytes(value.span).1)
            .unwrap_or(self.text.len())
    }

    /// The bytes of `value` with the brackets around it, which the tree does not keep; what is
    /// done with it stands at `trailer`.
    fn extent(&self, value: &AstExpr, trailer: usize) -> (usize, usize) {
        let (start, end) = bytes(value.span);
        if let Some((open, close)) = self.layout.last_closed(end, trailer) {
            return (open, close + 1);
        }
        let start = match &value.node {
            Expr::Dot(inner, name) => self.extent(inner, bytes(name.span).0).0,
            Expr::Call(inner, _) | Expr::Slice(inner, ..) => {
                self.extent(inner, self.trailer(inner)).0
            }
            Expr::Index(pair) => self.extent(&pair.0, self.trailer(&pair.0)).0,
            Expr::Index2(triple) => self.extent(&triple.0, self.trailer(&triple.0)).0,
            _ => start,
        };
        (start, end)
    }
}
