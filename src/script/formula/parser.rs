//! Text to steps. Precedences are Starlark's; a comparison cannot be chained.

use std::sync::Arc;

use crate::formula::lexer::{Token, tokens};
use crate::formula::tree::{Binary, Formula, FormulaError, Name, Op};
use crate::mathematics::{FUNCTIONS, Function, MathError};
use fretwork_diagnostic::nearest;

/// How deeply brackets and signs may be nested.
const DEPTH: usize = 100;

/// Reads the whole of `text`.
pub(crate) fn parse(text: &str) -> Result<Formula, FormulaError> {
    let tokens = tokens(text)?;
    let mut parser = Parser {
        text,
        tokens,
        at: 0,
        depth: 0,
        names: Vec::new(),
        functions: Vec::new(),
    };
    let ops = parser.condition()?;
    if parser.peek() != Token::End {
        return Err(parser.unexpected());
    }
    let depth = stack_depth(&ops);
    Ok(Formula {
        ops,
        names: parser.names,
        functions: parser.functions,
        depth,
    })
}

struct Parser<'a> {
    text: &'a str,
    tokens: Vec<(Token<'a>, usize, usize)>,
    at: usize,
    depth: usize,
    names: Vec<Name>,
    functions: Vec<Name>,
}

type Steps = Result<Vec<Op>, FormulaError>;

impl<'a> Parser<'a> {
    fn peek(&self) -> Token<'a> {
        self.tokens[self.at].0
    }

    fn eat(&mut self, token: Token<'_>) -> bool {
        let found = self.peek() == token;
        self.at += usize::from(found);
        found
    }

    fn error(&self, at: usize, message: String) -> FormulaError {
        let (_, start, end) = self.tokens[at];
        FormulaError {
            message,
            start,
            end,
            help: None,
        }
    }

    fn unexpected(&self) -> FormulaError {
        let (token, start, end) = self.tokens[self.at];
        if token == Token::End {
            return self.error(self.at, "the expression ends too early".into());
        }
        self.error(
            self.at,
            format!("`{}` cannot stand here", &self.text[start..end]),
        )
    }

    fn expect(&mut self, sign: &'static str) -> Result<(), FormulaError> {
        if self.eat(Token::Sign(sign)) {
            Ok(())
        } else {
            Err(self.unexpected())
        }
    }

    fn nested(&mut self, parse: impl FnOnce(&mut Self) -> Steps) -> Steps {
        self.depth += 1;
        if self.depth > DEPTH {
            return Err(self.error(self.at, "the expression is nested too deeply".into()));
        }
        let steps = parse(self);
        self.depth -= 1;
        steps
    }

    /// `a if c else b`, `a or b`, and all below.
    fn condition(&mut self) -> Steps {
        let then = self.either()?;
        if !self.eat(Token::Word("if")) {
            return Ok(then);
        }
        let mut ops = self.either()?;
        if !self.eat(Token::Word("else")) {
            return Err(self.unexpected());
        }
        let otherwise = self.nested(Self::condition)?;
        ops.push(Op::JumpUnless(length(&then) + 1));
        ops.extend(then);
        ops.push(Op::Jump(length(&otherwise)));
        ops.extend(otherwise);
        Ok(ops)
    }

    fn either(&mut self) -> Steps {
        let mut ops = self.both()?;
        while self.eat(Token::Word("or")) {
            let right = self.both()?;
            ops.push(Op::JumpIfTrue(length(&right)));
            ops.extend(right);
        }
        Ok(ops)
    }

    fn both(&mut self) -> Steps {
        let mut ops = self.negation()?;
        while self.eat(Token::Word("and")) {
            let right = self.negation()?;
            ops.push(Op::JumpIfFalse(length(&right)));
            ops.extend(right);
        }
        Ok(ops)
    }

    fn negation(&mut self) -> Steps {
        if self.eat(Token::Word("not")) {
            let mut ops = self.nested(Self::negation)?;
            ops.push(Op::Not);
            return Ok(ops);
        }
        self.comparison()
    }

    fn comparison(&mut self) -> Steps {
        let mut ops = self.sum()?;
        if let Some(operator) = self.operator(&COMPARISONS) {
            ops.extend(self.sum()?);
            ops.push(Op::Binary(operator));
            if self.operator(&COMPARISONS).is_some() {
                self.at -= 1;
                return Err(self.error(
                    self.at,
                    "comparisons cannot be chained; join them with `and`".into(),
                ));
            }
        }
        Ok(ops)
    }

    fn sum(&mut self) -> Steps {
        let mut ops = self.product()?;
        while let Some(operator) = self.operator(&SUMS) {
            ops.extend(self.product()?);
            ops.push(Op::Binary(operator));
        }
        Ok(ops)
    }

    fn product(&mut self) -> Steps {
        let mut ops = self.sign()?;
        while let Some(operator) = self.operator(&PRODUCTS) {
            ops.extend(self.sign()?);
            ops.push(Op::Binary(operator));
        }
        Ok(ops)
    }

    fn operator(&mut self, of: &[(&'static str, Binary)]) -> Option<Binary> {
        let Token::Sign(sign) = self.peek() else {
            return None;
        };
        let operator = of.iter().find(|(name, _)| *name == sign)?.1;
        self.at += 1;
        Some(operator)
    }

    fn sign(&mut self) -> Steps {
        for (sign, op) in [("-", Op::Negate), ("+", Op::Plus)] {
            if self.eat(Token::Sign(sign)) {
                let mut ops = self.nested(Self::sign)?;
                ops.push(op);
                return Ok(ops);
            }
        }
        self.atom()
    }

    fn atom(&mut self) -> Steps {
        let (token, start, end) = self.tokens[self.at];
        let op = match token {
            Token::Int(i) => Op::Int(i),
            Token::Float(f) => Op::Float(f),
            Token::Text(text) => Op::Text(Arc::from(text)),
            Token::Word("True") => Op::Bool(true),
            Token::Word("False") => Op::Bool(false),
            Token::Word("None") => Op::None,
            Token::Word(word) if RESERVED.contains(&word) => return Err(self.unexpected()),
            Token::Word(word) => {
                self.at += 1;
                if self.eat(Token::Sign("(")) {
                    return self.nested(|parser| parser.call(word, start, end));
                }
                return Ok(vec![Op::Name(self.name(word, start, end))]);
            }
            Token::Sign("(") => {
                self.at += 1;
                let ops = self.nested(Self::condition)?;
                self.expect(")")?;
                return Ok(ops);
            }
            _ => return Err(self.unexpected()),
        };
        self.at += 1;
        Ok(vec![op])
    }

    fn name(&mut self, word: &str, start: usize, end: usize) -> u32 {
        let known = self.names.iter().position(|n| &*n.name == word);
        let number = known.unwrap_or_else(|| {
            self.names.push(Name {
                name: Arc::from(word),
                start,
                end,
            });
            self.names.len() - 1
        });
        number as u32
    }

    fn call(&mut self, word: &str, start: usize, end: usize) -> Steps {
        let Some(function) = Function::named(word) else {
            let help =
                nearest(word, FUNCTIONS.map(|f| f.0)).map(|name| format!("did you mean `{name}`?"));
            return Err(FormulaError {
                message: format!("unknown function `{word}`"),
                start,
                end,
                help,
            });
        };
        let mut ops = Vec::new();
        let mut count = 0;
        while self.peek() != Token::Sign(")") {
            ops.extend(self.condition()?);
            count += 1;
            if !self.eat(Token::Sign(",")) {
                break;
            }
        }
        self.expect(")")?;
        let (least, greatest) = function.arity();
        if count < least || count > greatest {
            let message = MathError::Arguments {
                function: function.name(),
                least,
                greatest,
                given: count,
            }
            .to_string();
            return Err(FormulaError {
                message,
                start,
                end,
                help: None,
            });
        }
        self.functions.push(Name {
            name: Arc::from(word),
            start,
            end,
        });
        ops.push(Op::Call(function, count as u32));
        Ok(ops)
    }
}

const COMPARISONS: [(&str, Binary); 6] = [
    ("==", Binary::Equal),
    ("!=", Binary::NotEqual),
    ("<", Binary::Less),
    ("<=", Binary::LessOrEqual),
    (">", Binary::Greater),
    (">=", Binary::GreaterOrEqual),
];
const SUMS: [(&str, Binary); 2] = [("+", Binary::Add), ("-", Binary::Subtract)];
const PRODUCTS: [(&str, Binary); 4] = [
    ("*", Binary::Multiply),
    ("/", Binary::Divide),
    ("//", Binary::FloorDivide),
    ("%", Binary::Remainder),
];

/// Words of Starlark that are no names.
const RESERVED: [&str; 15] = [
    "and", "break", "continue", "def", "elif", "else", "for", "if", "in", "lambda", "load", "not",
    "or", "pass", "return",
];

fn length(ops: &[Op]) -> u32 {
    u32::try_from(ops.len()).expect("a formula has fewer steps than its text has bytes")
}

/// The most values that are on the stack at once. Both arms of a condition leave one value, so
/// that counting every step as if no jump were taken errs only upward.
fn stack_depth(ops: &[Op]) -> usize {
    let (mut now, mut most) = (0_usize, 0);
    for op in ops {
        match op {
            Op::Int(_) | Op::Float(_) | Op::Text(_) | Op::Bool(_) | Op::None | Op::Name(_) => {
                now += 1
            }
            Op::Binary(_) => now -= 1,
            Op::JumpUnless(_) | Op::Jump(_) | Op::JumpIfFalse(_) | Op::JumpIfTrue(_) => {
                now = now.saturating_sub(1)
            }
            Op::Call(_, count) => now = now + 1 - *count as usize,
            Op::Negate | Op::Plus | Op::Not => {}
        }
        most = most.max(now);
    }
    most
}
