//! Layouts of facades: the paper's 26 layers and its loosely sized apartment house (1 s and 5 s on
//! its authors' machine), and how time grows with layers and with the length of words.

use std::collections::BTreeMap;
use std::sync::Arc;

use fretwork::facade::{Description, Layer, PatternText, Symbol, lay_out};

use crate::Bench;

/// Runs the benchmarks named `facade/...`.
pub fn run(bench: &Bench) {
    let time = |name: &str, facade: &dyn Fn() -> Description| {
        bench.run(&format!("facade/{name}"), facade, |facade| {
            match lay_out(facade) {
                Ok((layout, warnings)) => format!(
                    "{} x {}, alignment {:.3}, sizes {:.3}, {} warnings",
                    layout.columns(),
                    layout.rows(),
                    layout.alignment_error,
                    layout.size_error,
                    warnings.len()
                ),
                Err(problems) => format!("{problems:?}"),
            }
        });
    };
    time("layers_26", &|| precise(25, 20));
    time("apartment_house", &apartment_house);
    for layers in [2, 5, 10, 20, 30] {
        time(&format!("growth_layers_{layers}"), &|| {
            precise(layers - 1, 20)
        });
    }
    for letters in [10, 20, 50, 100, 200] {
        time(&format!("growth_letters_{letters}"), &|| {
            precise(4, letters / 2)
        });
    }
}

/// A wall of windows of exact sizes under layers that pick out one pair of walls each.
fn precise(over: usize, windows: usize) -> Description {
    let mut facade = Description {
        canvas: [(2 + 5 * windows) as f64, 21.0],
        symbols: BTreeMap::new(),
        counters: BTreeMap::new(),
        layers: Vec::new(),
    };
    for (name, size) in [('W', 2.0), ('V', 3.0), ('G', 4.0), ('F', 3.0), ('R', 2.0)] {
        let (unoccludable, attached) = (name == 'V', name == 'V');
        let symbol = Symbol {
            size: Some(size),
            opaque: true,
            unoccludable,
            attached,
            ..Symbol::default()
        };
        facade.symbols.insert(name, symbol);
    }
    add(&mut facade, &format!("W(VW)^{windows}"), "GF^5R");
    for i in 0..over {
        // Letters that no pattern has otherwise.
        let name = [
            'α', 'β', 'γ', 'δ', 'ε', 'ζ', 'η', 'θ', 'ι', 'κ', 'λ', 'μ', 'ν',
        ][i % 13];
        facade.symbols.insert(
            name,
            Symbol {
                size: Some(2.0),
                ..Symbol::default()
            },
        );
        let (side, middle) = (
            i % (windows / 2).max(1),
            windows - 1 - 2 * (i % (windows / 2).max(1)),
        );
        let x = format!("(WV)^{side}z(VW)^{middle}Vz(VW)^{side}; z = {name}");
        let y = ["GF^5R", "gh; g = G", "umv; m = F^5", "tr; r = R"][i % 4];
        add(&mut facade, &x, y);
    }
    facade
}

/// Eight layers whose sizes do not go together, with free counters and wildcards.
fn apartment_house() -> Description {
    let mut facade = Description {
        canvas: [31.7, 19.3],
        symbols: BTreeMap::new(),
        counters: BTreeMap::new(),
        layers: Vec::new(),
    };
    for (name, size, opaque) in [
        ('A', 1.3, true),
        ('B', 1.7, true),
        ('C', 0.9, false),
        ('D', 2.1, true),
        ('E', 1.1, false),
        ('H', 1.9, false),
        ('G', 3.7, true),
        ('F', 2.9, true),
        ('R', 2.3, true),
        ('L', 0.4, false),
    ] {
        facade.symbols.insert(
            name,
            Symbol {
                size: Some(size),
                opaque,
                ..Symbol::default()
            },
        );
    }
    for (x, y) in [
        ("A(BA)^k", "GF^nR"),
        ("cec; c = C", "GF^nR"),
        ("vcwcv; c = H", "gh; h = F^nR"),
        ("fdf; d = D", "gh; g = G"),
        ("(pq)^mp; q = E", "imj; m = F^n"),
        ("oho; h = C", "zr; r = R"),
        ("s(ct)^2; c = H", "imj; m = F^n"),
        ("xcy; c = H", "GF^nR"),
    ] {
        add(&mut facade, x, y);
    }
    facade
}

/// Puts a layer on top: patterns are `control; letter = pattern; …`.
fn add(facade: &mut Description, x: &str, y: &str) {
    let main: Arc<str> = "main".into();
    facade.layers.push(Layer {
        name: format!("layer{}", facade.layers.len()).into(),
        patterns: [pattern(x), pattern(y)],
        groups: [main.clone(), main],
        visible: [None, None],
    });
}

fn pattern(text: &str) -> PatternText {
    let mut parts = text.split(';').map(str::trim);
    let control = parts.next().unwrap_or_default().into();
    let content: BTreeMap<char, Arc<str>> = parts
        .filter_map(|part| part.split_once('='))
        .filter_map(|(letter, inner)| Some((letter.trim().chars().next()?, inner.trim().into())))
        .collect();
    PatternText {
        name: text.into(),
        control,
        content: (!content.is_empty()).then_some(content),
    }
}
