//! The pattern language: operators, order, mirrors, substitution, and errors with their places.

use std::collections::BTreeMap;

use crate::pattern::syntax::{Pattern, PatternErrorKind, parse};
use crate::pattern::word::{Environment, Letter, Words};

use super::pattern;

/// The words of up to 60 letters; a mirrored letter has a `'`, a transparent one brackets.
fn words(text: &str, counters: &[(char, i64)]) -> Vec<String> {
    let text = pattern(text);
    let control = parse(&text.control).expect("a pattern");
    let content = text.content.map(|c| {
        c.iter()
            .map(|(letter, t)| (*letter, parse(t).expect("a pattern")))
            .collect::<BTreeMap<_, _>>()
    });
    let pattern = Pattern { control, content };
    let env: Environment = counters.iter().copied().collect();
    let found = Words::new(&pattern, &env, &|_| 1, 60).flatten().take(2000);
    found.map(|word| word.iter().map(show).collect()).collect()
}

fn show(letter: &Letter) -> String {
    let name = format!(
        "{}{}",
        letter.symbol,
        if letter.mirrored { "'" } else { "" }
    );
    if letter.transparent {
        format!("<{name}>")
    } else {
        name
    }
}

#[test]
fn operators() {
    assert_eq!(words("A|B", &[]), ["A", "B"]);
    assert_eq!(words("A.B.C", &[]), ["ABC"]);
    assert_eq!(words("A|B.C", &[]), ["AC", "BC"]);
    assert_eq!(words("A|(B.C)", &[]), ["A", "BC"]);
    assert_eq!(words("A B^2 | C ^ 0 D", &[]), ["ABBD", "AD"]);
    assert_eq!(words("(AB)^-2", &[]), ["B'A'B'A'"]);
    assert_eq!(words("((AB)^-1C)^-1", &[]), ["C'AB"]);
    assert_eq!(words("A^2^3", &[]), ["AAAAAA"]);
    assert_eq!(words("(A|B)^2", &[]), ["AA", "AB", "BA", "BB"]);
    assert_eq!(words("(A|B)^-2", &[]), ["A'A'", "A'B'", "B'A'", "B'B'"]);
    assert_eq!(words("A|(BC)D", &[]), ["AD", "BCD"]);
    assert_eq!(words("ÄЖ", &[]), ["ÄЖ"]);
}

#[test]
fn counters() {
    assert_eq!(words("A(BA)^k", &[('k', 2)]), ["ABABA"]);
    assert_eq!(words("A(BA)^-k", &[('k', 2)]), ["AA'B'A'B'"]);
    assert_eq!(words("A(BA)^-k", &[('k', -1)]), ["ABA"]);
    assert_eq!(words("eb^se; b = B", &[('s', 3)]), ["<e>BBB<e>"]);
    assert_eq!(words("(A^kB)^k", &[('k', 2)]), ["AABAAB"]);
}

#[test]
fn substitution_of_equations_1_to_6() {
    let of = |k| words("xm; m = A(BA)^k", &[('k', k)]);
    assert_eq!(
        [of(0), of(1), of(2)].concat(),
        ["<x>A", "<x>ABA", "<x>ABABA"]
    );
    let of = |k| words("yBmAm^-1By; m = (AB)^k", &[('k', k)]).concat();
    assert_eq!(of(1), "<y><B>AB<A>B'A'<B><y>");
    assert_eq!(of(2), "<y><B>ABAB<A>B'A'B'A'<B><y>");
}

#[test]
fn one_content_word_replaces_all_instances() {
    assert_eq!(words("cec; c = A|B", &[]), ["A<e>A", "B<e>B"]);
    assert_eq!(
        words("(c|d)d; c = A; d = B|C", &[]),
        ["AB", "AC", "BB", "CC"]
    );
}

#[test]
fn long_words_are_given_up_early() {
    let node = parse("(A|B)^k").expect("a pattern");
    let pattern = Pattern {
        control: node,
        content: None,
    };
    let env = Environment::from([('k', 100_000)]);
    let size = |c: char| if c == 'A' { 1 } else { 7 };
    let words = Words::new(&pattern, &env, &size, 10);
    assert!(words.take(100).all(|word| word.is_none()));
    let mut endless = Words::new(&pattern, &env, &|_| 0, 10);
    assert!(endless.next().is_some_and(|word| word.is_some()));
    let mut crowded = Environment::from([('k', 100_001)]);
    crowded.insert('n', 1);
    let mut words = Words::new(&pattern, &crowded, &|_| 0, 10);
    assert_eq!((words.next(), words.too_many_letters), (Some(None), true));
}

#[test]
fn errors_carry_their_place() {
    use PatternErrorKind::*;
    let of = |text: &str| {
        parse(text)
            .map_err(|e| (e.kind, e.offset, e.length))
            .expect_err("an error")
    };
    assert_eq!(of(""), (Empty, 0, 0));
    assert_eq!(of("  "), (Empty, 0, 2));
    assert_eq!(of("A(BA"), (Unclosed, 1, 1));
    assert_eq!(of("A)B"), (Unopened, 1, 1));
    assert_eq!(of("A()B"), (EmptyGroup, 1, 2));
    assert_eq!(of("A||B"), (MissingBefore('|'), 2, 1));
    assert_eq!(of("A..B"), (MissingBefore('.'), 2, 1));
    assert_eq!(of("A."), (MissingAtEnd, 2, 0));
    assert_eq!(of("(A|)"), (MissingBefore(')'), 3, 1));
    assert_eq!(of("A 3"), (NotASymbol('3'), 2, 1));
    assert_eq!(of("A^"), (MissingExponent, 2, 0));
    assert_eq!(of("A^-B^ -)"), (MissingExponent, 7, 1));
    assert_eq!(of("^2"), (MissingBefore('^'), 0, 1));
    assert_eq!(of("A ^ 99999999999999999999"), (HugeExponent, 4, 20));
    assert_eq!(of("B(A^1000)^1000"), (TooLong, 0, 14));
}

#[test]
fn depth_is_limited() {
    let nested = |n: usize| format!("{}A{}", "(".repeat(n), ")".repeat(n));
    assert!(parse(&nested(200)).is_ok());
    let error = parse(&nested(201)).expect_err("too deep");
    assert_eq!((error.kind, error.offset), (PatternErrorKind::TooDeep, 200));
    assert_eq!(
        parse(&nested(10_000)).expect_err("too deep").kind,
        PatternErrorKind::TooDeep
    );
    assert_eq!(
        parse(&"(".repeat(10_000)).expect_err("too deep").kind,
        PatternErrorKind::TooDeep
    );
    assert_eq!(
        parse(&format!("A{}", "^1".repeat(10_000)))
            .expect_err("too deep")
            .kind,
        PatternErrorKind::TooDeep
    );
    assert_eq!(
        parse(&format!("A{}", "^k".repeat(150))).map(|n| n.counters()),
        Ok(vec!['k'])
    );
}
