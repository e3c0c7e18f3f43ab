//! Whole drawings through the reader.

mod browser;

use super::*;
use fretwork_diagnostic::Span;
use fretwork_geometry::{FillRule, Point, Polygon};

const OPTIONS: SvgOptions = SvgOptions {
    tolerance: 0.01,
    unit_mm: 1.0,
};

fn read_ok(text: &str) -> (Drawing, Vec<Diagnostic>) {
    read(text, &"a.svg".into(), &OPTIONS).unwrap_or_else(|e| panic!("{e:#?}"))
}

/// The drawing inside an `svg` element; it must not warn.
fn body(content: &str) -> Drawing {
    let (drawing, warnings) = read_ok(&svg(content));
    assert_eq!(warnings, []);
    drawing
}

fn svg(content: &str) -> String {
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' \
         xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape'>{content}</svg>"
    )
}

fn paths(drawing: &Drawing) -> Vec<Vec<[f64; 2]>> {
    let all = drawing.shapes.iter().flat_map(|s| &s.paths);
    all.map(|path| path.iter().map(|&p| p.into()).collect())
        .collect()
}

fn labels(drawing: &Drawing) -> Vec<String> {
    drawing
        .shapes
        .iter()
        .map(|s| s.label.names().join(" "))
        .collect()
}

/// The messages of a drawing that cannot be read, each with the text it points at.
fn errors(content: &str) -> Vec<String> {
    let text = svg(content);
    let errors = read(&text, &"a.svg".into(), &OPTIONS).expect_err("the drawing is bad");
    let shown = |d: &Diagnostic| match &d.labels[0].span {
        Span::Bytes { start, end, .. } => format!("{} [{}]", d.message, &text[*start..*end]),
        _ => d.message.clone(),
    };
    errors.iter().filter(|d| d.is_error()).map(shown).collect()
}

#[test]
fn transforms_nest() {
    let drawing = body(
        "<g transform='translate(10 20)'><g transform='scale(2)'><path d='M1 1H2' transform='rotate(90)'/></g></g>",
    );
    assert_eq!(paths(&drawing), [[[8.0, 22.0], [8.0, 24.0]]]);
}

#[test]
fn basic_shapes_are_closed_or_open_as_drawn() {
    let drawing = body(
        "<rect x='1' y='2' width='3' height='4'/><line x2='5' y2='6' stroke='red'/>\
         <polyline points='0,0 1,0 1,1'/><polygon points='0,0 1,0 1,1'/>",
    );
    assert_eq!(
        paths(&drawing)[0],
        [[1.0, 2.0], [4.0, 2.0], [4.0, 6.0], [1.0, 6.0], [1.0, 2.0]]
    );
    assert_eq!(paths(&drawing)[1], [[0.0, 0.0], [5.0, 6.0]]);
    assert_eq!((paths(&drawing)[2].len(), paths(&drawing)[3].len()), (3, 4));
    assert!(drawing.shapes[3].is_closed(0) && !drawing.shapes[2].is_closed(0));
}

#[test]
fn round_shapes_have_their_area() {
    let area = |content: &str| {
        body(content)
            .areas(0.01)
            .unwrap()
            .iter()
            .map(Polygon::area)
            .sum::<f64>()
    };
    let pi = std::f64::consts::PI;
    assert!((area("<circle cx='5' cy='5' r='10'/>") - 100.0 * pi).abs() < 0.7);
    assert!((area("<ellipse cx='5' cy='5' rx='10' ry='5'/>") - 50.0 * pi).abs() < 0.5);
    assert!((area("<ellipse rx='10'/>") - 100.0 * pi).abs() < 0.7);
    assert!(
        (area("<rect width='40' height='30' rx='10'/>") - (1200.0 - (4.0 - pi) * 100.0)).abs()
            < 0.7
    );
    assert!(
        (area("<rect width='40' height='30' rx='90' ry='5'/>") - (1200.0 - (4.0 - pi) * 100.0))
            .abs()
            < 0.7
    );
    assert_eq!(
        body("<rect width='4' height='3' rx='0' ry='2'/>").shapes[0].paths[0].len(),
        5
    );
}

#[test]
fn a_physical_size_with_a_view_box_scales() {
    let scaled = |attributes: &str, unit_mm: f64| {
        let text = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' {attributes}><path d='M-10 0 100 50'/></svg>"
        );
        let options = SvgOptions {
            tolerance: 0.01,
            unit_mm,
        };
        paths(&read(&text, &"a.svg".into(), &options).unwrap().0)[0][1]
    };
    assert_eq!(scaled("", 1.0), [100.0, 50.0]);
    assert_eq!(
        scaled("width='200' height='100' viewBox='5 5 400 200'", 1.0),
        [100.0, 50.0]
    );
    assert_eq!(
        scaled("width='200px' height='100px' viewBox='0 0 400 200'", 10.0),
        [100.0, 50.0]
    );
    assert_eq!(
        scaled("width='200mm' height='100mm' viewBox='0 0 400 200'", 1.0),
        [50.0, 25.0]
    );
    assert_eq!(
        scaled("width='200mm' height='100mm' viewBox='-9 7 400 200'", 10.0),
        [5.0, 2.5]
    );
    assert_eq!(
        scaled("width='20cm' viewBox='0 0 400 200'", 1.0),
        [50.0, 25.0]
    );
    assert_eq!(
        scaled("height='100mm' width='100%' viewBox='0 0 400 200'", 1.0),
        [50.0, 25.0]
    );
    assert_eq!(
        scaled("width='10in' height='10in' viewBox='0 0 254 508'", 1.0),
        [50.0, 25.0]
    );
    assert_eq!(
        scaled(
            "width='200mm' height='200mm' viewBox='0 0 400 200' preserveAspectRatio='none'",
            1.0
        ),
        [50.0, 50.0]
    );
    assert_eq!(
        scaled(
            "width='200mm' height='200mm' viewBox='0 0 400 200' preserveAspectRatio='xMidYMid slice'",
            1.0
        ),
        [100.0, 50.0]
    );
}

#[test]
fn labels_are_the_elements_own() {
    let drawing = body(
        "<g id='layer' inkscape:label='Layer 1' data-label='no'>\
         <path id='p' inkscape:label='l' data-label='d' d='M0 0 1 1'/><path id='p2' inkscape:label='l2' d='M0 0 1 1'/>\
         <path id='p3' d='M0 0 1 1'/><path d='M0 0 1 1'/></g>",
    );
    assert_eq!(labels(&drawing), ["d", "l2", "p3", ""]);
}

#[test]
fn construction_points_are_not_drawn() {
    let drawing = body(
        "<g transform='translate(100 0)'><circle data-label='point:c' cx='1' cy='2' r='1'/>\
         <ellipse id='point:e' cx='3' cy='4' rx='1' ry='2'/><path inkscape:label='point:p' d='M5 6h1'/>\
         <rect data-label='point:r' width='2' height='4'/><path data-label='point:bare' d='M7 8'/>\
         <line data-label='point:l' x1='9' y1='9'/><circle data-label='point:dot' cx='2'/></g><path d='M0 0h1' stroke='red'/>",
    );
    let found: Vec<_> = drawing
        .points
        .iter()
        .map(|(n, p)| (&**n, p.x - 100.0, p.y))
        .collect();
    let expected = [
        ("c", 1.0, 2.0),
        ("e", 3.0, 4.0),
        ("p", 5.0, 6.0),
        ("r", 1.0, 2.0),
        ("bare", 7.0, 8.0),
        ("l", 9.0, 9.0),
        ("dot", 2.0, 0.0),
    ];
    assert_eq!(found, expected);
    assert_eq!(drawing.shapes.len(), 1);
}

#[test]
fn hidden_things_are_not_read() {
    let line = "d='M0 0h1' stroke='red'";
    let hidden = [
        format!("<g display='none'><path {line}/></g>"),
        format!("<g style='display:none'><path {line} style='display:inline'/></g>"),
        format!("<g opacity='0'><path {line}/></g>"),
        format!("<g visibility='hidden'><path {line}/></g>"),
        format!("<path {line} class='off'/>"),
        format!(
            "<defs><path {line}/></defs><clipPath><path {line}/></clipPath><symbol><path {line}/></symbol>"
        ),
        format!("<metadata><path {line}/></metadata><x:g xmlns:x='other'><path {line}/></x:g>"),
        format!(
            "<g requiredExtensions='http://x'><path {line}/></g><g transform='scale(0)'><path {line}/></g>"
        ),
        "<path stroke='red'/><path d='' /><path d='M1 1'/><rect width='5' stroke='red'/><circle/>"
            .into(),
    ];
    for content in hidden {
        let drawing = body(&format!(
            "<style>.off{{display:none}}</style><path id='seen' {line}/>{content}"
        ));
        assert_eq!(labels(&drawing), ["seen"], "{content}");
    }
    let shown = body(&format!(
        "<g visibility='hidden'><path {line} visibility='visible'/></g>"
    ));
    assert_eq!(shown.shapes.len(), 1);
}

#[test]
fn fill_and_stroke_are_inherited() {
    let drawing = body(
        "<g fill='none' stroke='red' stroke-width='3' transform='scale(2 8)' fill-rule='evenodd'><path d='M0 0h1'/>\
         <path d='M0 0h1' fill='red' stroke='none'/><path d='M0 0h1' vector-effect='non-scaling-stroke'/></g>",
    );
    let styles: Vec<_> = drawing
        .shapes
        .iter()
        .map(|s| (s.filled, s.rule, s.stroke.map(|s| s.width)))
        .collect();
    assert_eq!(
        styles,
        [
            (false, FillRule::EvenOdd, Some(12.0)),
            (true, FillRule::EvenOdd, None),
            (false, FillRule::EvenOdd, Some(3.0))
        ]
    );
}

#[test]
fn use_shows_what_it_refers_to() {
    let drawing = body(
        "<defs><path id='p' d='M0 0h1'/><g id='g' transform='scale(2)'><use href='#p' x='1'/><path data-label='q' d='M0 0h1'/></g></defs>\
         <use xlink:href='#g' x='10' y='5'/><use href='#p' transform='scale(3)' x='1' data-label='mine'/><use href='#p' id='clone'/>",
    );
    assert_eq!(
        paths(&drawing),
        [
            [[12.0, 5.0], [14.0, 5.0]],
            [[10.0, 5.0], [12.0, 5.0]],
            [[3.0, 0.0], [6.0, 0.0]],
            [[0.0, 0.0], [1.0, 0.0]]
        ]
    );
    assert_eq!(labels(&drawing), ["p", "q", "mine", "p"]);
}

#[test]
fn symbols_and_nested_drawings_have_viewports() {
    let drawing = body(
        "<symbol id='s' viewBox='0 0 10 10'><path d='M0 0 10 10'/></symbol>\
         <use href='#s' x='5' y='6' width='40' height='20'/>\
         <svg x='1' y='2' width='20' height='20' viewBox='10 10 40 20' preserveAspectRatio='xMaxYMax' overflow='visible'><path d='M10 10 50 30'/>\
         <rect width='50%' height='50%'/></svg>",
    );
    let all = paths(&drawing);
    assert_eq!(all[0], [[15.0, 6.0], [35.0, 26.0]]);
    assert_eq!(all[1], [[1.0, 12.0], [21.0, 22.0]]);
    assert_eq!(all[2][2], [1.0 + 5.0, 12.0]);
}

#[test]
fn what_viewports_and_unknown_selectors_hide_is_told() {
    let messages = |content: &str| -> Vec<String> {
        read_ok(&svg(content))
            .1
            .iter()
            .map(|d| d.message.clone())
            .collect()
    };
    let edge = "the edge of a nested drawing or symbol is not read";
    let nested = |more: &str, side: u32| {
        format!(
            "<svg x='10' y='10' width='20' height='20' {more}><rect width='{side}' height='{side}'/></svg>"
        )
    };
    assert_eq!(messages(&nested("", 50)), [edge]);
    assert_eq!(messages(&nested("", 20)), [""; 0]);
    assert_eq!(messages(&nested("overflow='visible'", 50)), [""; 0]);
    let symbol = "<symbol id='s' viewBox='0 0 10 10'><rect x='5' width='10' height='10'/></symbol>";
    let mirrored = "<g transform='scale(-1 1)'><use href='#s' width='40' height='40'/></g>";
    assert_eq!(messages(&format!("{symbol}{mirrored}")), [edge]);
    assert_eq!(
        messages(
            "<style>:not(g){display:none} rect:hover{fill:none}</style><rect width='1' height='1'/>"
        ),
        ["the selector `:not(g)` is not understood"]
    );
}

#[test]
fn switch_takes_the_first_that_fits() {
    let drawing = body(
        "<switch><foreignObject requiredExtensions='ai'/><g systemLanguage='de'><path id='no' d='M0 0h1'/></g>\
         <g><path id='yes' d='M0 0h1'/></g><path id='late' d='M0 0h1'/></switch>",
    );
    assert_eq!(labels(&drawing), ["yes"]);
}

#[test]
fn what_is_visible_but_not_read_is_said_once() {
    let (_, warnings) = read_ok(&svg(
        "<path d='M0 0h1'/><text>a</text><g display='none'><text>hidden</text></g><text>b</text><image/>\
         <clipPath id='c'><path d='M0 0h1v1z'/></clipPath>\
         <path d='M0 0h1' fill='none'/><path d='M0 0h1' clip-path='url(#c)' stroke='red' stroke-dasharray='1 2'/>",
    ));
    let messages: Vec<_> = warnings.iter().map(|w| w.message.as_str()).collect();
    let expected = [
        "a clip or mask is not read",
        "a shape without fill and stroke is not read",
        "an image is not read",
        "text is not read (2 times)",
        "the dashing of a stroke is not read",
    ];
    assert_eq!(messages, expected);
    assert!(warnings.iter().all(|w| !w.is_error() && w.help.is_some()));
}

#[test]
fn bad_values_are_errors_at_their_place() {
    assert_eq!(
        errors("<path d='M0 0 L5 x'/>"),
        ["bad path data: expected a finite number here, not `x` [x]"]
    );
    assert_eq!(
        errors("<path d='10 10'/>"),
        ["bad path data: expected `M` here, not `1` [1]"]
    );
    assert_eq!(errors("<circle r='-1'/>"), ["`r` is negative [-1]"]);
    assert_eq!(
        errors("<rect width='1 0' height='3'/>"),
        ["`1 0` is not a length [1 0]"]
    );
    assert_eq!(errors("<polygon points='1 2 3'/>").len(), 1);
    assert!(errors("<g transform='rotate(x)'/>")[0].ends_with("[rotate(x)]"));
    assert!(errors("<rect width='10%' height='5'/>")[0].contains("viewport"));
    assert!(errors("<path d='M0 0 1e13 0'/>")[0].contains("too far out"));
    assert!(errors("<path d='M0 0 1e300 0' transform='scale(1e300)'/>")[0].contains("too far out"));
    assert!(errors("<path d='M0 0A1e300 1e300 0 0 1 5 5'/>")[0].contains("too far out"));
    assert!(errors("<svg viewBox='0 0 0 5'><path d='M0 0h1'/></svg>")[0].contains("[0 0 0 5]"));
    assert!(
        errors("<circle data-label='point:' r='1'/><path d='M0 0h1'/>")[0].contains("needs a name")
    );
    assert!(
        errors("<use href='#lin'/><path id='line' d='M0 0h1'/>")[0].contains("`lin`, which is not")
    );
    assert!(errors("")[0].contains("nothing visible"));
    assert_eq!(errors("<circle r='-1'/><circle r='-2'/>").len(), 2);
    assert_eq!(errors(&"<circle r='-1'/>".repeat(50)).len(), 21);
}

#[test]
fn circles_of_use_and_explosions_are_errors() {
    assert!(errors("<g id='a'><use href='#a'/></g>")[0].contains("leads back to itself"));
    assert!(
        errors("<use id='a' href='#b'/><use id='b' href='#a'/>")[0]
            .contains("leads back to itself")
    );
    assert!(
        errors("<symbol id='s'><use href='#s'/></symbol><use href='#s'/>")[0]
            .contains("leads back to itself")
    );
    let mut bomb = String::from("<defs><g id='g0'><path d='M0 0h1'/></g>");
    for i in 1..40 {
        bomb += &format!(
            "<g id='g{i}'>{}</g>",
            format!("<use href='#g{}'/>", i - 1).repeat(10)
        );
    }
    assert!(errors(&(bomb + "</defs><use href='#g39'/>"))[0].contains("more than 1000000"));
}

#[test]
fn deep_groups_and_fine_tolerances_are_no_danger() {
    let deep = format!(
        "{}<path d='M0 0h1'/>{}",
        "<g transform='translate(1)'>".repeat(100_000),
        "</g>".repeat(100_000)
    );
    assert_eq!(paths(&body(&deep))[0][0], [100_000.0, 0.0]);
    let text = svg(&"<circle r='1000'/>".repeat(1000));
    let fine = SvgOptions {
        tolerance: 1e-15,
        unit_mm: 1.0,
    };
    let errors = read(&text, &"a.svg".into(), &fine).unwrap_err();
    assert!(
        errors[0].message.contains("more than 10000000 points"),
        "{errors:?}"
    );
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(
            read(
                &text,
                &"a.svg".into(),
                &SvgOptions {
                    tolerance,
                    unit_mm: 1.0
                }
            )
            .is_err()
        );
    }
}

#[test]
fn an_element_can_be_selected_by_id_or_label() {
    let text = svg(
        "<defs transform='translate(5)'><symbol id='sym'><path d='M0 0h1'/></symbol></defs><g transform='translate(1 2)' fill='none' stroke='red'>\
         <path id='a' d='M0 0h1'/><g inkscape:label='Layer A'><path data-label='b' d='M0 0h2'/><circle data-label='point:x' r='1'/></g></g>\
         <path id='bad' d='nonsense'/><g id='off' display='none'><path id='inner' d='M0 0h1'/></g>",
    );
    let selected = |id: &str| select(&text, &"a.svg".into(), &OPTIONS, Some(id));
    let first = |id: &str| paths(&selected(id).unwrap().0)[0][0];
    assert_eq!(first("a"), [1.0, 2.0]);
    assert_eq!(first("sym"), [5.0, 0.0]);
    let (layer, _) = selected("Layer A").unwrap();
    assert_eq!(
        (
            paths(&layer)[0][1],
            layer.points[0].1,
            layer.shapes[0].filled
        ),
        ([3.0, 2.0], Point::new(1.0, 2.0), false)
    );
    assert_eq!(labels(&selected("b").unwrap().0), ["b"]);
    assert!(
        selected("inner").unwrap_err()[0]
            .message
            .contains("nothing visible is in the selected element")
    );
    let unknown = &selected("Layer B").unwrap_err()[0];
    assert_eq!(unknown.help.as_deref(), Some("did you mean `Layer A`?"));
    assert!(selected("bad").is_err() && read(&text, &"a.svg".into(), &OPTIONS).is_err());
}

#[test]
fn a_drawing_as_inkscape_saves_it() {
    let (drawing, warnings) = read_ok(include_str!("../../../../tests/drawings/inkscape.svg"));
    assert_eq!(
        warnings
            .iter()
            .map(|w| w.message.as_str())
            .collect::<Vec<_>>(),
        ["text is not read"]
    );
    assert_eq!(labels(&drawing), ["leaf", "leaf", "path2", "path3"]);
    assert_eq!(drawing.points, [("tip".into(), Point::new(80.0, 50.0))]);
    let all = paths(&drawing);
    assert_eq!((all[0][0], all[1][0]), ([10.0, 20.0], [10.0, 20.0]));
    // The clone is turned by a quarter: its tip is to the lower right.
    assert!(all[0].contains(&[20.0, 10.0]) && all[1].contains(&[20.0, 30.0]));
    assert_eq!(all[3], [[10.0, 40.0], [60.0, 40.0], [80.0, 50.0]]);
    let painted: Vec<_> = drawing
        .shapes
        .iter()
        .map(|s| (s.filled, s.stroke.is_some()))
        .collect();
    assert_eq!(
        painted,
        [(true, false), (true, false), (true, false), (false, true)]
    );
    let file = "inkscape.svg".into();
    let (stem, _) = select(
        include_str!("../../../../tests/drawings/inkscape.svg"),
        &file,
        &OPTIONS,
        Some("Stem"),
    )
    .unwrap();
    assert_eq!((stem.shapes.len(), stem.points.len()), (1, 1));
}

#[test]
fn drawings_as_illustrator_saves_them() {
    let (drawing, warnings) = read_ok(include_str!("../../../../tests/drawings/illustrator.svg"));
    // The unpainted frame is the only thing that is drawn and not read.
    assert_eq!(
        warnings
            .iter()
            .map(|w| w.message.as_str())
            .collect::<Vec<_>>(),
        ["a shape without fill and stroke is not read"]
    );
    let painted: Vec<_> = drawing
        .shapes
        .iter()
        .map(|s| (s.filled, s.stroke.map(|s| s.width)))
        .collect();
    assert_eq!(
        painted,
        [
            (true, None),
            (true, None),
            (false, Some(2.0)),
            (false, Some(2.0))
        ]
    );
    let disc = Drawing {
        shapes: drawing.shapes[..1].to_vec(),
        points: vec![],
    };
    let area = disc.areas(0.01).unwrap()[0].area();
    assert!(
        (area - std::f64::consts::PI * 28.35 * 28.35).abs() < 5.0,
        "{area}"
    );

    let (drawing, warnings) = read_ok(include_str!(
        "../../../../tests/drawings/illustrator_entities.svg"
    ));
    assert_eq!((drawing.shapes.len(), warnings), (2, vec![]));
    assert_eq!(drawing.shapes[0].paths.len(), 2);
    let hole = Drawing {
        shapes: drawing.shapes[..1].to_vec(),
        points: vec![],
    }
    .areas(0.01)
    .unwrap();
    // The inner square runs the other way round; the stroke widens the frame on both sides.
    assert!((hole[0].area() - (30.5f64.powi(2) - 9.5f64.powi(2))).abs() < 1e-6);
}

mod oracle {
    //! Path data against the reader and the flattening of `kurbo`.

    use super::*;
    use proptest::prelude::*;

    type Segments = Vec<(Point, Point)>;

    fn ours(d: &str, tolerance: f64) -> Segments {
        let text = svg(&format!("<path d='{d}' stroke='red'/><path d='M0 0h1'/>"));
        let (mut drawing, _) = read(
            &text,
            &"a.svg".into(),
            &SvgOptions {
                tolerance,
                unit_mm: 1.0,
            },
        )
        .unwrap();
        drawing.shapes.pop();
        let paths = drawing.shapes.first().map_or(&[][..], |shape| &shape.paths);
        let segments = |p: &Vec<Point>| {
            (0..p.len())
                .map(|i| (p[i.saturating_sub(1)], p[i]))
                .collect::<Vec<_>>()
        };
        paths.iter().flat_map(segments).collect()
    }

    fn theirs(d: &str) -> Segments {
        let (mut segments, mut at, mut start) = (Vec::new(), Point::ORIGIN, Point::ORIGIN);
        kurbo::flatten(
            kurbo::BezPath::from_svg(d).unwrap(),
            1e-4,
            |element| match element {
                kurbo::PathEl::MoveTo(p) => {
                    (at, start) = (Point::new(p.x, p.y), Point::new(p.x, p.y))
                }
                kurbo::PathEl::LineTo(p) => {
                    segments.push((at, Point::new(p.x, p.y)));
                    at = Point::new(p.x, p.y);
                }
                _ => {
                    segments.push((at, start));
                    at = start;
                }
            },
        );
        segments
    }

    /// The largest distance of a point of `a` from `b`.
    fn excess(a: &Segments, b: &Segments) -> f64 {
        let to_segment = |p: Point, (from, to): &(Point, Point)| {
            let along = *to - *from;
            let t = if along.dot(along) > 0.0 {
                (p - *from).dot(along) / along.dot(along)
            } else {
                0.0
            };
            p.distance(from.lerp(*to, t.clamp(0.0, 1.0)))
        };
        let nearest = |p: Point| {
            b.iter()
                .map(|s| to_segment(p, s))
                .fold(f64::INFINITY, f64::min)
        };
        a.iter()
            .flat_map(|s| [s.0, s.0.lerp(s.1, 0.5), s.1])
            .map(nearest)
            .fold(0.0, f64::max)
    }

    fn command(arcs: bool) -> impl Strategy<Value = String> {
        let kinds = if arcs {
            "LHVCSQTAlhvcsqtaZz"
        } else {
            "LHVCSQTlhvcsqtZz"
        };
        let n = prop::collection::vec(-40.0..40.0f64, 7);
        (
            prop::sample::select(kinds.chars().collect::<Vec<_>>()),
            n,
            any::<[bool; 2]>(),
        )
            .prop_map(|(kind, n, flags)| {
                let count = match kind.to_ascii_uppercase() {
                    'Z' => 0,
                    'H' | 'V' => 1,
                    'L' | 'T' => 2,
                    'C' => 6,
                    'S' | 'Q' => 4,
                    _ => {
                        let [a, b] = flags.map(u8::from);
                        return format!(
                            "{kind}{:.2} {:.2} {:.1} {a}{b}{:.3},{:.3}",
                            n[0], n[1], n[2], n[3], n[4]
                        );
                    }
                };
                n[..count]
                    .iter()
                    .fold(kind.to_string(), |text, x| text + &format!(" {x:.3}"))
            })
    }

    /// Without smooth commands but after a curve of the same degree: after others kurbo mirrors
    /// some control point all the same, which SVG does not.
    fn conforming(mut commands: Vec<String>) -> String {
        let mut previous = None;
        commands.retain(|command| {
            let this = command.to_ascii_uppercase().chars().next();
            let keep = match this {
                Some('S') => matches!(previous, Some('C' | 'S')),
                Some('T') => matches!(previous, Some('Q' | 'T')),
                _ => true,
            };
            previous = if keep { this } else { previous };
            keep
        });
        commands.concat()
    }

    fn path(arcs: bool) -> impl Strategy<Value = String> {
        let moves = ("[Mm]", -40.0..40.0f64, -40.0..40.0f64)
            .prop_map(|(m, x, y)| format!("{m}{x:.3} {y:.3}"));
        let subpath = (moves, prop::collection::vec(command(arcs), 1..6))
            .prop_map(|(m, all)| m + &conforming(all));
        prop::collection::vec(subpath, 1..4).prop_map(|all| all.concat())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        #[test]
        fn curves_agree_within_the_tolerance(d in path(false), e in -3.0..0.0f64) {
            let tolerance = libm::exp10(e);
            let (ours, theirs) = (ours(&d, tolerance), theirs(&d));
            prop_assert!(excess(&theirs, &ours) <= tolerance + 2e-4, "{}", excess(&theirs, &ours));
            prop_assert!(excess(&ours, &theirs) <= tolerance + 2e-4, "{}", excess(&ours, &theirs));
        }

        #[test]
        fn arcs_agree_within_the_tolerance(d in path(true)) {
            // kurbo makes Béziers of arcs with a tolerance of its own, a tenth.
            let (ours, theirs) = (ours(&d, 0.01), theirs(&d));
            prop_assert!(excess(&theirs, &ours) <= 0.12, "{}", excess(&theirs, &ours));
            prop_assert!(excess(&ours, &theirs) <= 0.12, "{}", excess(&ours, &theirs));
        }
    }
}
