//! Whatever bytes come in, parsing gives a value; what is large and honest is read fast.

use std::sync::Arc;
use std::time::{Duration, Instant};

use fretwork::diagnostic::Diagnostic;
use fretwork::language::{MAX_DEPTH, Places, parse, parse_bytes};
use proptest::prelude::*;

use super::language::{decode_all, files};

/// Parses and decodes, and looks every place up.
fn exercise(bytes: &[u8]) {
    let file: Arc<str> = "any.yaml".into();
    let parsed = parse_bytes(&file, bytes);
    let decoded = decode_all(&file, &parsed.document);
    let text = String::from_utf8_lossy(bytes);
    let places = Places::new(text.as_ref().into());
    for diagnostic in parsed
        .diagnostics
        .iter()
        .chain(decoded.iter().flat_map(|d| &d.diagnostics))
    {
        assert!(!diagnostic.labels.is_empty(), "{diagnostic:?}");
        for label in &diagnostic.labels {
            if let fretwork::diagnostic::Span::Name { path, key, .. } = &label.span {
                let range = places
                    .locate(path, *key)
                    .expect("what was decoded can be found");
                assert!(text.get(range).is_some());
            }
        }
    }
}

/// Fragments of the language, to be cut up and put together wrongly.
fn pieces() -> &'static [String] {
    static PIECES: std::sync::LazyLock<Vec<String>> = std::sync::LazyLock::new(read_pieces);
    &PIECES
}

fn read_pieces() -> Vec<String> {
    let texts = files("language")
        .into_iter()
        .chain(files("bad"))
        .filter_map(|path| std::fs::read_to_string(path).ok());
    let lines: Vec<String> = texts
        .flat_map(|text| text.lines().map(str::to_owned).collect::<Vec<_>>())
        .collect();
    let signs = [
        "{", "}", "[", "]", ": ", ", ", "\"", "'", "\n  ", "\n", "- ", "&a ", "*a", "<<: *a", "${",
        "# ", "|\n", "!x ", "\t", "---\n", "? ",
    ];
    lines
        .into_iter()
        .filter(|line| line.len() < 300)
        .chain(signs.map(str::to_owned))
        .collect()
}

/// A slice of the cases; PROPTEST_CASES asks for more.
fn cases() -> u32 {
    std::env::var("PROPTEST_CASES")
        .ok()
        .and_then(|cases| cases.parse().ok())
        .unwrap_or(400)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        exercise(&bytes);
    }

    #[test]
    fn broken_specs_never_panic(choices in proptest::collection::vec((any::<prop::sample::Index>(), 0..3u8, any::<prop::sample::Index>()), 1..30)) {
        let pieces = pieces();
        let mut text = String::from("fretwork: 1\n");
        for (which, end, cut) in choices {
            let piece = which.get(pieces);
            match end {
                0 => text.push_str(piece),
                1 => text.push_str(&format!("{piece}\n")),
                _ => text.push_str(&piece[..piece.floor_char_boundary(cut.index(piece.len() + 1))]),
            }
        }
        exercise(text.as_bytes());
    }

    #[test]
    fn mutated_specs_never_panic(which in any::<prop::sample::Index>(), edits in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)) {
        let files = files("language");
        let mut bytes = std::fs::read(which.get(&files)).unwrap();
        for (at, byte) in edits {
            let at = at.index(bytes.len());
            // Half of the edits keep the text a text.
            bytes[at] = if byte < 128 { b" {}[]:,\"'#&*!|>-?%@`$\n\tax0."[usize::from(byte) % 27] } else { byte };
        }
        exercise(&bytes);
    }
}

#[test]
fn ten_thousand_entries_take_well_under_a_second() {
    let regions: String = (0..10_000)
        .map(|n| {
            format!(
                "  r{n}: {{ rectangle: {{ width: {n}.5, height: \"{}mm\", at: [1, 2] }} }}\n",
                n + 1
            )
        })
        .collect();
    let text = format!("fretwork: 1\nregions:\n{regions}");
    let file: Arc<str> = "large.yaml".into();
    let start = Instant::now();
    let parsed = parse(&file, &text);
    let parsing = start.elapsed();
    assert_eq!(parsed.diagnostics, []);
    assert_eq!(parsed.document.entries.len(), 10_000);
    let decoded = decode_all(&file, &parsed.document);
    assert!(decoded.iter().all(|d| d.node.is_some()));
    println!(
        "{} kB: parsed in {parsing:?}, decoded in {:?}",
        text.len() / 1000,
        start.elapsed() - parsing
    );
    assert!(
        start.elapsed() < Duration::from_secs(5),
        "{:?}",
        start.elapsed()
    );
}

#[test]
fn hostile_files_cost_little() {
    let nested = |open: &str, close: &str| {
        format!(
            "fretwork: 1\nlet:\n  a: {}{}\n",
            open.repeat(100_000),
            close.repeat(100_000)
        )
    };
    let hostile = [
        nested("[", "]"),
        nested("{a: ", "}"),
        nested("- ", ""),
        nested("[", ""),
        format!(
            "fretwork: 1\nlet:\n  a: &a x\n  b: [{}]\n",
            "*a, ".repeat(1_000_000)
        ),
        format!("fretwork: 1\nlet: {{ {} }}\n", "x, ".repeat(300_000)),
        format!("fretwork: 1\nlet: {{ {} }}\n", "x: 1, ".repeat(100_000)),
        format!(
            "fretwork: 1\nlet: {{ a: \"{}\" }}\n",
            "${".repeat(2_000_000)
        ),
        format!(
            "fretwork: 1\nlet: {{ a: \"{}\" }}\n",
            "${a}".repeat(1_000_000)
        ),
        format!("fretwork: 1\n{}", "&a ".repeat(100_000)),
        format!("fretwork: 1\n{}", "? ".repeat(100_000)),
        format!("fretwork: 1\n#{}", "#".repeat(10_000_000)),
        format!("fretwork: 1\nlet:\n  {}: 1\n", "k".repeat(3_000_000)),
        format!("fretwork: 1\nlet: [{}]\n", "1,".repeat(3_000_000)),
        "\"".repeat(1_000_000),
        "%".repeat(1_000_000),
        "\n".repeat(10_000_000),
    ];
    for (n, text) in hostile.iter().enumerate() {
        let start = Instant::now();
        let parsed = parse(&"hostile.yaml".into(), text);
        println!(
            "{n}: {:?}, {} errors",
            start.elapsed(),
            parsed.diagnostics.iter().filter(|d| d.is_error()).count()
        );
        assert!(
            start.elapsed() < Duration::from_secs(10),
            "case {n} took {:?}",
            start.elapsed()
        );
    }
}

#[test]
fn nesting_up_to_the_limit_fits_a_small_stack() {
    let deep = MAX_DEPTH - 3;
    let text = format!(
        "fretwork: 1\nlet:\n  a: {}{}\n",
        "[".repeat(deep),
        "]".repeat(deep)
    );
    let parse_it = move || parse(&"deep.yaml".into(), &text);
    let thread = std::thread::Builder::new()
        .stack_size(1 << 20)
        .spawn(parse_it)
        .unwrap();
    let errors: Vec<Diagnostic> = thread.join().unwrap().diagnostics;
    assert_eq!(errors, []);
}
