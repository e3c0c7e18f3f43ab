//! What styles make of elements.

use super::*;
use crate::svg::length::Basis;
use crate::svg::sheet::Sheet;
use fretwork_geometry::Point;

/// What `look` sees in the style of an element, and what was not understood.
fn cascaded<T>(
    attributes: &str,
    css: &str,
    look: impl FnOnce(&Style, &Own) -> T,
) -> (T, Vec<String>) {
    let text = format!("<svg><path class='a' {attributes}/></svg>");
    let document = roxmltree::Document::parse(&text).unwrap();
    let sheet = Sheet::parse(css);
    let node = document.root_element().first_element_child().unwrap();
    let mut bad = Vec::new();
    let mut note = |name: &str, value: &str| bad.push(format!("{name}: {value}"));
    let basis = Basis::of(Point::new(100.0, 100.0));
    let (style, own) = cascade(&Style::default(), node, &sheet, &basis, &mut note);
    (look(&style, &own), bad)
}

fn painted(attributes: &str, css: &str) -> (bool, bool) {
    let seen = |style: &Style, _: &Own| {
        let stroke = style.pen(1.0).filter(|_| style.stroke() != Paint::None);
        (style.fill() != Paint::None, stroke.is_some())
    };
    cascaded(attributes, css, seen).0
}

fn hidden(attributes: &str, css: &str) -> bool {
    cascaded(attributes, css, |_, own| own.is_hidden()).0
}

#[test]
fn styles_win_over_rules_and_rules_over_attributes() {
    assert_eq!(painted("", ""), (true, false));
    assert_eq!(painted("fill='none'", ".a{fill:red}"), (true, false));
    assert_eq!(
        painted("fill='red' style='fill:none'", ".a{fill:red}"),
        (false, false)
    );
    assert_eq!(
        painted("style='fill:red'", ".a{fill:none!important}"),
        (false, false)
    );
    assert_eq!(painted("style='fill:none;stroke:#000'", ""), (false, true));
}

#[test]
fn paint_is_there_or_not() {
    for none in ["none", "transparent", "rgba(1,2,3,0)", "#12345600"] {
        assert_eq!(
            painted(&format!("fill='{none}'"), ""),
            (false, false),
            "{none}"
        );
    }
    for some in [
        "red",
        "#abc",
        "url(#g)",
        "url(#g) none",
        "rgb(1,2,3)",
        "currentColor",
        "hsl(120, 50%, 50%)",
    ] {
        assert_eq!(
            painted(&format!("fill='{some}'"), ""),
            (true, false),
            "{some}"
        );
    }
    assert_eq!(
        painted("fill='currentColor' color='transparent'", ""),
        (false, false)
    );
    assert_eq!(painted("stroke='red' stroke-width='0'", ""), (true, false));
    assert_eq!(
        painted("stroke='red' stroke-opacity='0' fill-opacity='0%'", ""),
        (false, false)
    );
    assert_eq!(
        painted("stroke='red' visibility='collapse'", ""),
        (false, false)
    );
    assert_eq!(
        cascaded(
            "stroke='red' stroke-width='2%' stroke-linecap='round'",
            "",
            |style, _| { style.pen(3.0) }
        )
        .0,
        Some(Stroke {
            width: 6.0,
            cap: Cap::Round,
            join: Join::Miter(4.0)
        })
    );
}

#[test]
fn hiding_is_by_display_or_opacity() {
    assert!(hidden("display='none'", ""));
    assert!(hidden("style='opacity: 0.0'", ""));
    assert!(hidden("", ".a{display:none}"));
    assert!(!hidden("style='display:inline;opacity:.5'", ""));
    // What is stronger shows again what is hidden by what is weaker.
    assert!(!hidden("", ".a{display:none} .a{display:inline}"));
    assert!(!hidden("style='display:inline'", ".a{display:none}"));
    assert!(!hidden("display='none'", ".a{display:inline}"));
    assert!(!hidden("style='opacity:1'", "path{opacity:0}"));
    assert!(hidden("style='opacity:1'", "path{display:none}"));
    assert_eq!(
        cascaded("fill='oops' stroke-width='-1' fill-rule='x'", "", |_, _| ()).1,
        ["fill: oops", "stroke-width: -1", "fill-rule: x"]
    );
}

#[test]
fn names_and_keywords_may_be_written_in_capitals() {
    assert_eq!(painted("style='FILL:None;Stroke:RED'", ""), (false, true));
    assert!(hidden("", ".a{DISPLAY:NONE}"));
}

#[test]
fn comments_stand_anywhere_in_a_style() {
    assert_eq!(
        painted("style='/*fill:red*/fill:/*a*/none/*b*/'", ""),
        (false, false)
    );
}

#[test]
fn letters_give_lengths_their_size() {
    let width =
        |attributes: &str| cascaded(attributes, "", |style, _| (style.font_size, style.width)).0;
    assert_eq!(width("stroke-width='2em' font-size='10'"), (10.0, 20.0));
    assert_eq!(
        width("style='stroke-width:1ex;font:bold 2em/1.5 Arial'"),
        (32.0, 16.0)
    );
    assert_eq!(width("font-size='150%' stroke-width='1rem'"), (24.0, 16.0));
    assert_eq!(width("font-size='large'").0, 18.0);
    assert_eq!(width("style='font:700 5px x'").0, 5.0);
}

#[test]
fn servers_and_white_are_told_apart() {
    let fill = |value: &str| {
        let (paint, bad) = cascaded(&format!("fill='{value}'"), "", |style, _| {
            format!("{:?}", style.fill())
        });
        assert_eq!(bad, [""; 0]);
        paint
    };
    assert_eq!(
        fill("url(#p) none"),
        "Server { id: \"p\", fallback: Some(false) }"
    );
    assert_eq!(fill("url(#p)"), "Server { id: \"p\", fallback: None }");
    assert_eq!(fill("#fff"), "Color { is_white: true }");
    assert_eq!(fill("context-fill"), "None");
    assert_eq!(reference("url( \"#a\" ) x"), Some("a"));
    assert_eq!(reference("url(b.svg#a)"), None);
}

#[test]
fn places_in_a_style_need_units() {
    let (said, bad) = cascaded("style='width:4px;x:0;r:5'", ".a{rx:1em}", |_, own| {
        ["width", "x", "r", "rx"].map(|name| own.geometry(name).unwrap_or("").to_string())
    });
    assert_eq!(said, ["4px", "0", "", "1em"]);
    assert_eq!(bad, ["r: 5"]);
}
