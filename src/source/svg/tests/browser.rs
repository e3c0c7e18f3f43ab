//! What browsers show and a drawing program may write in many ways: read as they do, or told.

use super::*;

/// The area of a drawing that is read without a warning.
fn area(content: &str) -> f64 {
    painted(&read_ok(&svg(content)).0)
}

fn painted(drawing: &Drawing) -> f64 {
    let areas = drawing.areas(0.01).unwrap();
    areas.iter().map(Polygon::area).sum()
}

fn warnings(content: &str) -> Vec<String> {
    let (_, warnings) = read_ok(&svg(content));
    warnings.iter().map(|w| w.message.clone()).collect()
}

const NONE: [&str; 0] = [];

#[test]
fn markers_stand_at_the_vertices_of_lines() {
    let marker = |more: &str| {
        format!(
            "<marker id='m' markerWidth='8' markerHeight='8' {more}><rect width='8' height='8'/></marker>"
        )
    };
    let triangle = "<path d='M10 10H50V50Z' marker-end='url(#m)'/>";
    let found = area(&format!("{}{triangle}", marker("refY='4'")));
    assert!((found - 840.0).abs() < 1e-6, "{found}");
    // One marker each at the start, the two middles and the end.
    let line = "<path d='M0 0H20V20H40' fill='none' stroke='red' style='marker:url(#m)' stroke-width='.5'/>";
    let corners = |more: &str| -> Vec<[f64; 2]> {
        let drawing = body(&format!("{}{line}", marker(more)));
        paths(&drawing)[1..].iter().map(|path| path[0]).collect()
    };
    let mut plain = corners("refX='4' refY='center'");
    plain.sort_by(|a, b| a.partial_cmp(b).unwrap());
    assert_eq!(plain, [[-2., -2.], [18., -2.], [18., 18.], [38., 18.]]);
    let big = corners("markerUnits='userSpaceOnUse'");
    assert!(big.contains(&[40.0, 20.0]) && big.len() == 4);
}

#[test]
fn markers_turn_along_their_lines() {
    let ends = |orient: &str, line: &str| -> Vec<[f64; 2]> {
        let marker = format!(
            "<marker id='m' orient='{orient}' overflow='visible'><path d='M0 0h1' stroke='red'/></marker>"
        );
        let drawing = body(&format!("{marker}<g fill='none' stroke='red'>{line}</g>"));
        paths(&drawing)[1..].iter().map(|path| path[1]).collect()
    };
    let near = |found: &[[f64; 2]], expected: &[[f64; 2]]| {
        assert_eq!(found.len(), expected.len());
        for (p, q) in found.iter().zip(expected) {
            let distance = libm::hypot(p[0] - q[0], p[1] - q[1]);
            assert!(distance < 1e-9, "{found:?} {expected:?}");
        }
    };
    let end = "<path d='M0 0V10' marker-end='url(#m)'/>";
    near(&ends("auto", end), &[[0.0, 11.0]]);
    near(&ends("180", end), &[[-1.0, 10.0]]);
    near(&ends(".25turn", end), &[[0.0, 11.0]]);
    let start = "<polyline points='0,0 0,10' marker-start='url(#m)'/>";
    near(&ends("auto-start-reverse", start), &[[0.0, -1.0]]);
    // Halfway between both directions in a corner, and where a ring closes.
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let middle = "<path d='M0 0H10V10' marker-mid='url(#m)'/>";
    near(&ends("auto", middle), &[[10.0 + half, half]]);
    let ring = "<polygon points='0,0 10,0 10,10 0,10' marker-start='url(#m)'/>";
    near(&ends("auto", ring), &[[half, -half]]);
    let arc = "<path d='M0 0A5 5 0 0 1 10 0' marker-end='url(#m)'/>";
    near(&ends("auto", arc), &[[10.0, 1.0]]);
    let curve = "<path d='M0 0C0 0 10 0 10 10' marker-start='url(#m)'/>";
    near(&ends("auto", curve), &[[1.0, 0.0]]);
}

#[test]
fn markers_have_their_own_style_and_know_that_of_their_line() {
    // The rectangle without any paint is told.
    let (drawing, _) = read_ok(&svg(
        "<g fill='none' stroke='blue'><marker id='m' viewBox='0 0 2 2'><rect width='2' height='2' fill='context-stroke' stroke='none'/>\
         <rect width='2' height='2' fill='context-fill' stroke='none'/></marker></g>\
         <path d='M0 0H9' stroke='red' fill='none' marker-end='url(#m)'/>",
    ));
    assert_eq!(drawing.shapes.len(), 2);
    assert_eq!(paths(&drawing)[1][0], [9.0, 0.0]);
    assert_eq!(paths(&drawing)[1][2], [12.0, 3.0]);
    assert_eq!(
        warnings("<path d='M0 0h1v1' marker-end='url(#gone)'/>"),
        ["the marker `gone` is not in the drawing"]
    );
    // A marker that shows itself ends; circles have none.
    let own = "<marker id='m'><path d='M0 0h1v1' marker-end='url(#m)'/></marker>\
               <g marker-start='url(#m)'><path d='M0 0h1v1'/><circle r='1'/></g>";
    assert_eq!(body(own).shapes.len(), 3);
    let edge = "<marker id='m'><rect width='9' height='1'/></marker><path d='M0 0h1v1' marker-end='url(#m)'/>";
    assert_eq!(
        warnings(edge),
        ["the edge of a nested drawing or symbol is not read"]
    );
}

#[test]
fn paint_servers_are_there_or_not() {
    let other = "<rect x='50' width='10' height='10'/>";
    let square = |fill: &str| format!("<rect width='40' height='40' fill='{fill}'/>{other}");
    assert_eq!(area(&square("url(#gone) none")), 100.0);
    assert_eq!(area(&square("url(#gone) red")), 1700.0);
    assert_eq!(
        warnings(&square("url(#gone)")),
        ["the paint server `gone` is not in the drawing"]
    );
    let gradient = |stops: &str| {
        format!(
            "<linearGradient id='g' href='#h'/><linearGradient id='h'>{stops}</linearGradient>{}",
            square("url(#g)")
        )
    };
    assert_eq!(area(&gradient("<stop stop-color='red'/>")), 1700.0);
    assert_eq!(area(&gradient("")), 100.0);
    assert_eq!(
        area(&gradient(
            "<stop stop-opacity='0'/><stop style='stop-color:#0000'/>"
        )),
        100.0
    );
    let pattern = |content: &str| {
        format!(
            "<pattern id='p'>{content}</pattern>{}",
            square("url(\"#p\")")
        )
    };
    let pattern = |content: &str| pattern(content).replace("fill='url(\"#p\")'", "fill='url(#p)'");
    assert_eq!(
        warnings(&pattern("<path/>")),
        ["a pattern as paint is not read"]
    );
    assert_eq!(area(&pattern("")), 100.0);
}

#[test]
fn relative_lengths_are_taken_of_letters() {
    assert_eq!(
        area("<g font-size='10'><rect width='4em' height='2em'/></g>"),
        800.0
    );
    assert_eq!(
        area("<g style='font:10px x'><rect width='4ex' height='2rem'/></g>"),
        640.0
    );
    let text = "<svg xmlns='http://www.w3.org/2000/svg' font-size='10'><g font-size='5'>\
                <rect width='4rem' height='2em'/></g></svg>";
    assert_eq!(painted(&read_ok(text).0), 400.0);
}

#[test]
fn places_and_sizes_may_stand_in_the_style() {
    assert_eq!(
        area(
            "<style>rect{width:40px;height:2em}</style><rect style='X:10px' width='1' height='1'/>"
        ),
        1280.0
    );
    let circle = body("<circle style='r:5px;cx:10px'/>");
    assert!((circle.bounds().max.x - 15.0).abs() < 1e-9);
    let path = body("<path style='d:path(\"M0 0H4V4Z\")'/>");
    assert_eq!(paths(&path)[0].len(), 4);
    assert_eq!(
        warnings("<rect style='width:40' width='2' height='2'/>"),
        ["`width: 40` is not understood"]
    );
}

#[test]
fn transforms_refer_to_the_box_they_name() {
    let bounds = |style: &str| {
        let rect = format!("<rect x='60' y='60' width='20' height='10' style='{style}'/>");
        let b = body(&rect).bounds();
        [b.min.x, b.min.y, b.max.x, b.max.y].map(|v| (v * 1e6).round() / 1e6)
    };
    let turn = "transform:rotate(90deg);transform-box:fill-box";
    assert_eq!(
        bounds(&format!("{turn};transform-origin:center")),
        [65.0, 55.0, 75.0, 75.0]
    );
    assert_eq!(bounds(turn), [50.0, 60.0, 60.0, 80.0]);
    assert_eq!(
        bounds("transform:scaleX(2);transform-origin:right;transform-box:content-box"),
        [40.0, 60.0, 80.0, 70.0]
    );
    let group =
        "<g style='transform:rotate(90deg);transform-box:fill-box'><path d='M0 0h1v1'/></g>";
    assert_eq!(
        warnings(group),
        ["the `transform-box` of a group is not read"]
    );
    assert_eq!(
        warnings("<path d='M0 0h1v1' style='rotate:45deg'/>"),
        ["rotate is not read"]
    );
}

#[test]
fn rules_nest_and_are_for_screens() {
    let squares =
        "<g><rect class='a' width='40' height='40'/></g><rect x='50' width='10' height='10'/>";
    for css in [
        "@media screen { .a { fill: none } }",
        "g { .a { fill: none } }",
        "g { &amp; .a { FILL: None } }",
        "/* .a { */ .a { fill: /* red */ none }",
        "<![CDATA[ <!-- .a { fill: none } --> ]]>",
        "[class~=a] { fill: none }",
    ] {
        assert_eq!(
            area(&format!("<style>{css}</style>{squares}")),
            100.0,
            "{css}"
        );
    }
    assert_eq!(
        area(&format!(
            "<style>@media print{{.a{{fill:none}}}}</style>{squares}"
        )),
        1700.0
    );
    assert_eq!(
        warnings(&format!(
            "<style>@media (min-width:1px){{.a{{fill:none}}}}</style>{squares}"
        )),
        ["`@media (min-width:1px)` is not read"]
    );
    let text = format!("<?xml-stylesheet href='look.css'?>{}", svg(squares));
    let (_, told) = read_ok(&text);
    assert_eq!(told[0].message, "the style sheet `look.css` is not read");
}

#[test]
fn a_clip_or_mask_that_cuts_nothing_is_no_warning() {
    let told = ["a clip or mask is not read"];
    let clip = |shape: &str, more: &str| {
        format!(
            "<clipPath id='c' {more}>{shape}</clipPath><g clip-path='url(#c)'><rect width='4' height='4'/></g>"
        )
    };
    let page = "<rect x='-1' y='-1' width='9' height='9'/>";
    assert_eq!(warnings(&clip(page, "")), NONE);
    assert_eq!(
        warnings(&clip(page, "").replace("'4'/></g>", "'9'/></g>")),
        told
    );
    assert_eq!(warnings(&clip("<circle r='6'/>", "")), NONE);
    assert_eq!(warnings(&clip("<circle r='5'/>", "")), told);
    assert_eq!(warnings(&clip("<path d='M0 0V9H9Z'/>", "")), told);
    assert_eq!(
        warnings(&clip(
            "<rect width='1' height='1'/>",
            "clipPathUnits='objectBoundingBox'"
        )),
        NONE
    );
    assert_eq!(warnings(&clip("", "")), told);
    assert_eq!(
        warnings("<rect width='4' height='4' clip-path='url(#gone)'/>"),
        NONE
    );
    assert_eq!(
        warnings("<rect width='4' height='4' style='clip-path:inset(1px)'/>"),
        told
    );
    // Half of a stroke on the edge is cut away.
    let stroked = clip("<rect width='4' height='4'/>", "");
    assert_eq!(warnings(&stroked), NONE);
    assert_eq!(warnings(&stroked.replace("<g ", "<g stroke='red' ")), told);
    let mask = |shape: &str| {
        format!("<mask id='m'>{shape}</mask><rect mask='url(#m)' width='4' height='4'/>")
    };
    assert_eq!(
        warnings(&mask("<rect fill='#fff' width='9' height='9'/>")),
        NONE
    );
    assert_eq!(
        warnings(&mask("<rect fill='#ddd' width='9' height='9'/>")),
        told
    );
    assert_eq!(
        warnings(&mask(
            "<rect fill='#fff' opacity='.5' width='9' height='9'/>"
        )),
        told
    );
}

#[test]
fn physical_sizes_without_a_view_box_are_those_of_browsers() {
    let read = |attributes: &str, shape: &str| {
        let text = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' {attributes}>{shape}</svg>"
        );
        let (drawing, warnings) = read_ok(&text);
        let told: Vec<String> = warnings.into_iter().map(|w| w.message).collect();
        (drawing.bounds().max.x, told)
    };
    let (side, told) = read(
        "width='100mm' height='100mm'",
        "<rect width='50mm' height='20mm'/>",
    );
    assert!(
        (side - 50.0).abs() < 1e-9 && told.is_empty(),
        "{side} {told:?}"
    );
    let (side, told) = read("width='4in'", "<rect width='96' height='20'/>");
    assert!(
        (side - 25.4).abs() < 1e-9 && told.is_empty(),
        "{side} {told:?}"
    );
    let (side, told) = read("width='100'", "<rect width='50mm' height='20mm'/>");
    assert!((side - 50.0 * 96.0 / 25.4).abs() < 1e-9);
    assert!(
        told[0].starts_with("a length has a unit such as mm"),
        "{told:?}"
    );
    let (_, told) = read(
        "width='4in' inkscape:version='0.48.4 r9939'",
        "<rect width='96' height='20'/>",
    );
    assert!(told[0].contains("read as 96 to the inch"));
}

#[test]
fn filters_and_animations_are_told() {
    assert_eq!(
        warnings("<rect width='4' height='4' filter='url(#f)'><animate/></rect>"),
        ["a filter is not read", "an animation is not read"]
    );
}

#[test]
fn hostile_style_sheets_and_markers_end() {
    let started = std::time::Instant::now();
    let deep = "<g class='x'>".repeat(2000);
    let css = format!(".y {} rect {{ fill: red }}", "g ".repeat(400));
    let text = svg(&format!(
        "<style>{css}</style>{deep}<rect width='1' height='1'/>{}",
        "</g>".repeat(2000)
    ));
    assert!(read(&text, &"a.svg".into(), &OPTIONS).is_ok());
    let marker = "<marker id='m' overflow='visible'><path id='p' d='M0 0h1v1h1v1h1' marker-mid='url(#n)'/></marker>\
                  <marker id='n' overflow='visible'><path d='M0 0h1v1h1v1h1'/></marker>";
    let line = "h1v1".repeat(200_000);
    let found = read(
        &svg(&format!(
            "{marker}<path d='M0 0{line}' marker-mid='url(#m)'/>"
        )),
        &"a.svg".into(),
        &OPTIONS,
    );
    assert!(
        found.unwrap_err()[0]
            .message
            .contains("more than 1000000 elements")
    );
    assert!(started.elapsed().as_secs() < 60);
}
