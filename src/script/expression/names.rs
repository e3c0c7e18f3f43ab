//! The names that an expression reads and does not bind itself.

use starlark::syntax::ast::{ArgumentP, AstExpr, AstNoPayload, Clause, Expr, ForClause, Parameter};

/// The free names of `expression` in the order of their first mention, with the bytes of it.
pub(crate) fn free_names(expression: &AstExpr) -> Vec<(String, usize, usize)> {
    let mut walk = FreeNames {
        bound: Vec::new(),
        free: Vec::new(),
    };
    walk.expression(expression);
    walk.free
}

struct FreeNames {
    bound: Vec<String>,
    free: Vec<(String, usize, usize)>,
}

impl FreeNames {
    fn expression(&mut self, expression: &AstExpr) {
        match &expression.node {
            Expr::Identifier(name) => {
                let known = self.bound.contains(&name.node.ident)
                    || self.free.iter().any(|f| f.0 == name.node.ident);
                if !known {
                    let (start, end) = (
                        name.span.begin().get() as usize,
                        name.span.end().get() as usize,
                    );
                    self.free.push((name.node.ident.clone(), start, end));
                }
            }
            Expr::Lambda(lambda) => {
                for parameter in &lambda.params {
                    parameter
                        .node
                        .visit_expr(|default| self.expression(default));
                }
                let names = lambda
                    .params
                    .iter()
                    .filter_map(|p: &starlark::codemap::Spanned<Parameter>| p.node.ident());
                let names: Vec<String> = names.map(|n| n.node.ident.clone()).collect();
                self.within(names, |walk| walk.expression(&lambda.body));
            }
            Expr::ListComprehension(element, first, clauses) => {
                self.comprehension(first, clauses, &[element]);
            }
            Expr::DictComprehension(entry, first, clauses) => {
                self.comprehension(first, clauses, &[&entry.0, &entry.1]);
            }
            Expr::Call(function, args) => {
                self.expression(function);
                for argument in &args.args {
                    let (ArgumentP::Positional(value)
                    | ArgumentP::Named(_, value)
                    | ArgumentP::Args(value)
                    | ArgumentP::KwArgs(value)) = &argument.node;
                    self.expression(value);
                }
            }
            other => other.visit_expr(|inner| self.expression(inner)),
        }
    }

    fn within(&mut self, names: Vec<String>, walk: impl FnOnce(&mut FreeNames)) {
        let outer = self.bound.len();
        self.bound.extend(names);
        walk(self);
        self.bound.truncate(outer);
    }

    fn comprehension(&mut self, first: &ForClause, clauses: &[Clause], elements: &[&AstExpr]) {
        let outer = self.bound.len();
        self.loop_over(first);
        for clause in clauses {
            match clause {
                Clause::For(inner) => self.loop_over(inner),
                Clause::If(condition) => self.expression(condition),
            }
        }
        elements.iter().for_each(|element| self.expression(element));
        self.bound.truncate(outer);
    }

    fn loop_over(&mut self, clause: &ForClause) {
        self.expression(&clause.over);
        clause.var.visit_lvalue(
            |name: &starlark::codemap::Spanned<
                starlark::syntax::ast::AssignIdentP<AstNoPayload>,
            >| {
                self.bound.push(name.node.ident.clone());
            },
        );
    }
}
