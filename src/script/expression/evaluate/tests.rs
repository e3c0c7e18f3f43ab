//! Values, names and errors of expressions; attacks on them.

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
        let short = crate::formula::parser::parse(&text).ok().and_then(|f| crate::formula::exact::evaluate(&f, &scope, constant));
        if let Some(short) = short {
            match starlark(&text, &scope, None) {
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
