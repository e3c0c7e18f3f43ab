//! The columns of a table, read from the statement that made it. Expressions are not computed.

use super::sqlite::Value;

/// A column of a table.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Column {
    /// Its name.
    pub name: String,
    /// Whether it is the number of its line, which is not in the record.
    pub is_key: bool,
    /// Whether records have a value for it: not where it is computed when it is asked for.
    pub is_stored: bool,
    /// What kind of values its type says that it has.
    pub kind: Kind,
    /// Its value in records that were written before it was added.
    pub default: Value,
}

/// What the type of a column says of its values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// Yes or no, which are written as 1 and 0.
    Truth,
    /// Floats, of which those without decimals are written as whole numbers.
    Float,
    /// As they are written.
    Any,
}

impl Kind {
    /// That of a column whose type begins with `word`.
    fn of(word: Option<&Token>) -> Kind {
        let Some(Token::Word(word)) = word else {
            return Kind::Any;
        };
        let word = word.to_ascii_uppercase();
        match &*word {
            "BOOLEAN" | "BOOL" => Kind::Truth,
            // The rule of SQLite for types that store floats.
            _ if ["REAL", "FLOA", "DOUB"]
                .iter()
                .any(|part| word.contains(part)) =>
            {
                Kind::Float
            }
            _ => Kind::Any,
        }
    }
}

/// A piece of a statement.
#[derive(Clone, Debug, PartialEq)]
enum Token {
    /// A word or a number.
    Word(String),
    /// A text in quotes, without them.
    Quoted(String),
    /// What stands in brackets.
    Group(Vec<Token>),
    /// Any other sign.
    Sign(char),
}

impl Token {
    fn is(&self, word: &str) -> bool {
        matches!(self, Token::Word(own) if own.eq_ignore_ascii_case(word))
    }
}

/// The columns that a `CREATE TABLE` names.
pub(super) fn columns(sql: &str) -> Vec<Column> {
    let mut chars = sql.chars().peekable();
    let tokens = tokens(&mut chars, 0);
    let inside = tokens.iter().find_map(|token| match token {
        Token::Group(inside) => Some(inside),
        _ => None,
    });
    let parts = inside.map_or(&[][..], |inside| inside);
    let parts = parts.split(|token| *token == Token::Sign(','));
    let (mut columns, mut keys) = (Vec::new(), Vec::new());
    for part in parts {
        match part.first() {
            Some(first) if CONSTRAINTS.iter().any(|word| first.is(word)) => keys.extend(key(part)),
            Some(_) => columns.extend(column(part)),
            None => {}
        }
    }
    for (column, is_integer) in &mut columns {
        let is_named = keys
            .iter()
            .any(|key| key.eq_ignore_ascii_case(&column.name));
        column.is_key |= is_named && *is_integer;
    }
    columns.into_iter().map(|(column, _)| column).collect()
}

/// Words with which parts begin that are no columns.
const CONSTRAINTS: [&str; 5] = ["CONSTRAINT", "PRIMARY", "UNIQUE", "CHECK", "FOREIGN"];
/// Brackets inside of one another, at most; deeper ones are left out.
const DEEPEST: usize = 32;

/// The one column of a primary key.
fn key(part: &[Token]) -> Option<String> {
    let at = part.iter().position(|token| token.is("PRIMARY"))?;
    match part.get(at + 2)? {
        Token::Group(inside) if !inside.contains(&Token::Sign(',')) => name(inside.first()?),
        _ => None,
    }
}

fn name(token: &Token) -> Option<String> {
    match token {
        Token::Quoted(text) | Token::Word(text) => Some(text.clone()),
        _ => None,
    }
}

/// A column, and whether it holds whole numbers.
fn column(part: &[Token]) -> Option<(Column, bool)> {
    let name = name(part.first()?)?;
    let rest = &part[1..];
    let is_integer = rest.first().is_some_and(|token| token.is("INTEGER"));
    let is_primary = rest
        .windows(2)
        .any(|two| two[0].is("PRIMARY") && two[1].is("KEY"));
    let is_computed = rest
        .windows(2)
        .any(|two| two[0].is("AS") && matches!(two[1], Token::Group(_)));
    let default = rest.iter().position(|token| token.is("DEFAULT"));
    let column = Column {
        name,
        is_key: is_integer && is_primary,
        is_stored: !is_computed || rest.iter().any(|token| token.is("STORED")),
        kind: Kind::of(rest.first()),
        default: default.map_or(Value::Null, |at| literal(&rest[at + 1..])),
    };
    Some((column, is_integer))
}

/// The value at the start of tokens; nothing where it is computed.
fn literal(tokens: &[Token]) -> Value {
    match tokens {
        [Token::Quoted(text), ..] => Value::Text(text.clone()),
        [Token::Group(inside), ..] => literal(inside),
        [Token::Sign('+'), rest @ ..] => literal(rest),
        [Token::Sign('-'), rest @ ..] => match literal(rest) {
            Value::Integer(number) => Value::Integer(-number),
            Value::Real(number) => Value::Real(-number),
            _ => Value::Null,
        },
        [word, ..] if word.is("TRUE") => Value::Integer(1),
        [word, ..] if word.is("FALSE") => Value::Integer(0),
        [Token::Word(word), ..] => match (word.parse::<i64>(), word.parse::<f64>()) {
            (Ok(whole), _) => Value::Integer(whole),
            (_, Ok(number)) if number.is_finite() => Value::Real(number),
            _ => Value::Null,
        },
        _ => Value::Null,
    }
}

/// The tokens up to the end, or to the bracket that closes. Comments are left out.
fn tokens(chars: &mut std::iter::Peekable<std::str::Chars<'_>>, depth: usize) -> Vec<Token> {
    let mut all = Vec::new();
    while let Some(c) = chars.next() {
        match c {
            ')' => break,
            '(' if depth == DEEPEST => break,
            '(' => all.push(Token::Group(tokens(chars, depth + 1))),
            '"' | '\'' | '`' => all.push(Token::Quoted(quoted(chars, c))),
            '[' => all.push(Token::Quoted(quoted(chars, ']'))),
            '-' if chars.peek() == Some(&'-') => {
                let _ = chars.find(|c| *c == '\n');
            }
            '/' if chars.peek() == Some(&'*') => {
                let mut last = ' ';
                chars.next();
                let _ = chars.find(|c| std::mem::replace(&mut last, *c) == '*' && *c == '/');
            }
            c if is_of_word(c) => {
                let mut word = String::from(c);
                // The sign of an exponent belongs to a number.
                let is_number = c.is_ascii_digit() || c == '.';
                while let Some(next) = chars.peek().copied() {
                    let is_sign = is_number && (next == '-' || next == '+');
                    if !(is_of_word(next) || is_sign && word.ends_with(['e', 'E'])) {
                        break;
                    }
                    word.push(next);
                    chars.next();
                }
                all.push(Token::Word(word));
            }
            c if c.is_whitespace() => {}
            c => all.push(Token::Sign(c)),
        }
    }
    all
}

fn is_of_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_' || c == '.' || c == '$'
}

/// The text up to a quote; two of them stand for one.
fn quoted(chars: &mut std::iter::Peekable<std::str::Chars<'_>>, end: char) -> String {
    let mut text = String::new();
    while let Some(c) = chars.next() {
        if c != end {
            text.push(c);
        } else if end != ']' && chars.peek() == Some(&end) {
            chars.next();
            text.push(c);
        } else {
            break;
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(sql: &str) -> Vec<String> {
        let shown = |c: &Column| {
            let mut text = c.name.clone();
            for (is, mark) in [(c.is_key, " key"), (!c.is_stored, " computed")] {
                text += if is { mark } else { "" };
            }
            match &c.default {
                Value::Null => text,
                default => format!("{text} {default:?}"),
            }
        };
        columns(sql).iter().map(shown).collect()
    }

    #[test]
    fn columns_are_told_from_comments_constraints_and_what_is_computed() {
        let sql = "CREATE TABLE \"a, (b\" ( -- the features, (all of them)
            \"fid\" INTEGER /* a key, of course */ PRIMARY KEY AUTOINCREMENT NOT NULL,
            geom POLYGON, [odd, name] MEDIUMINT CHECK ([odd, name] > 0),
            'it''s' TEXT(20) DEFAULT 'a, ''b''',
            twice REAL GENERATED ALWAYS AS (h * 2) VIRTUAL,
            kept REAL AS (h * 3) STORED,
            h REAL DEFAULT -1.5e-3, ok BOOLEAN NOT NULL DEFAULT (TRUE), at TEXT DEFAULT CURRENT_TIMESTAMP,
            unique_id INTEGER DEFAULT 7,
            CONSTRAINT one UNIQUE (h, ok))";
        let expected = [
            "fid key",
            "geom",
            "odd, name",
            "it's Text(\"a, 'b'\")",
            "twice computed",
            "kept",
            "h Real(-0.0015)",
            "ok Integer(1)",
            "at",
            "unique_id Integer(7)",
        ];
        assert_eq!(shown(sql), expected);
    }

    #[test]
    fn types_say_what_their_values_are() {
        let sql = "create table t (a boolean, b REAL, c double precision, d MEDIUMINT, e, f Float)";
        let kinds: Vec<Kind> = columns(sql).iter().map(|c| c.kind).collect();
        use Kind::{Any, Float, Truth};
        assert_eq!(kinds, [Truth, Float, Float, Any, Any, Float]);
    }

    #[test]
    fn a_key_may_be_named_after_the_columns() {
        let sql = |kind: &str| format!("create table t (id {kind}, g blob, primary key (\"ID\"))");
        assert_eq!(shown(&sql("integer")), ["id key", "g"]);
        assert_eq!(shown(&sql("text")), ["id", "g"]);
    }
}
