//! Letters: set, aligned, along curves, as stencils, in single lines.

use serde_json::Value;

use super::project::Project;

const SPEC: &str = "fretwork: 1
curves:
  rim: { circle: { radius: 20 } }
  bar: { polyline: { points: [[0, 0], [40, 0]] } }
  pole: { polyline: { points: [[0, 0, 0], [0, 0, 40], [9, 0, 40]] } }
regions:
  plain: { text: { content: FRET, size: 10 } }
  fitted: { text: { content: \"FRET\\nA\", fit: 50 } }
  middle: { text: { content: \"FRET\\nA\", size: 10, align: middle, anchor: middle } }
  end: { text: { content: FRET, size: 10, align: end, anchor: top } }
  wide: { text: { content: FRET, size: 10, letter_spacing: 2 } }
  outside: { text: { content: FRETWORK, size: 6, on: rim, side: right, start: 25%, align: middle } }
  inside: { text: { content: FRETWORK, size: 6, on: rim, start: 25%, align: middle } }
  along: { text: { content: FRET, size: 6, on: bar, start: \"5mm\" } }
  loose: { text: { content: \"ABD80\", size: 20 } }
  stencil: { text: { content: \"ABD80\", size: 20, stencil: { width: 1 } } }
  font: { text: { content: OB, font: fret.ttf, size: 20, stencil: { width: 1 } } }
arrangements:
  note: { text: { content: \"front side\\nno 7\", size: 4, at: [3, 9] } }
artifacts:
  plain.svg: { from: plain }
  note.dxf: { from: note }
  both.svg: { parts: [{ from: stencil, role: cut }, { from: note, role: engrave }] }
";

fn project() -> Project {
    let project = Project::of(SPEC);
    project.write("specs/fret.ttf", include_bytes!("drawings/fret.ttf"));
    project
}

fn measures(project: &Project, node: &str) -> Value {
    let json = project.succeed(&["inspect", "specs/spec.yaml", node, "--format", "json"]);
    serde_json::from_str(&json).unwrap()
}

/// Left, top, right and bottom of a node.
fn bounds(project: &Project, node: &str) -> [f64; 4] {
    let measures = measures(project, node);
    let at = |corner: usize, axis: usize| measures["bounds"][corner][axis].as_f64().unwrap();
    [at(0, 0), at(0, 1), at(1, 0), at(1, 1)]
}

#[test]
fn letters_are_set_where_they_are_asked_for() {
    let project = project();
    let [left, top, right, bottom] = bounds(&project, "plain");
    let width = right - left;
    // Strokes are 0.9 wide, about lines that stand on the baseline; the text begins with them.
    assert!(
        (bottom - 0.45).abs() < 1e-6 && (top + 7.45).abs() < 1e-6,
        "{top} {bottom}"
    );
    assert!(left.abs() < 1e-6);
    let [left, _, right, _] = bounds(&project, "fitted");
    assert!(left.abs() < 1e-6 && (right - 50.0).abs() < 1e-6);
    let [left, top, right, bottom] = bounds(&project, "middle");
    assert!((left + right).abs() < 1e-6 && (top + bottom).abs() < 1e-6);
    let [left, top, right, _] = bounds(&project, "end");
    assert!(right.abs() < 1e-6 && (right - left - width).abs() < 1e-6);
    assert!((top).abs() < 0.46);
    let [left, _, right, _] = bounds(&project, "wide");
    assert!((right - left - width - 6.0).abs() < 1e-6);
    project.succeed(&["build"]);
}

#[test]
fn text_runs_along_curves() {
    let project = project();
    // Above the upper end of the circle, letters stand outside of it and upright.
    let [left, top, right, bottom] = bounds(&project, "outside");
    assert!(top < -24.0 && bottom < -12.0, "{top} {bottom}");
    assert!((left + right).abs() < 2.0, "{left} {right}");
    let [_, top, _, bottom] = bounds(&project, "inside");
    assert!(top > -20.5 && bottom < -9.0, "{top} {bottom}");
    let [left, _, _, bottom] = bounds(&project, "along");
    assert!((left - 5.0).abs() < 1e-6 && (bottom - 0.27).abs() < 1e-6);
}

#[test]
fn text_begins_with_what_is_drawn_of_it_where_an_open_curve_begins() {
    let project = project();
    for (text, from) in [
        ("content: FRET, size: 6, on: bar", 0.0),
        ("content: \"bend — ł\", size: 6, on: bar", 0.0),
        ("content: FRET, size: 6", 0.0),
    ] {
        let spec = SPEC.replace("content: FRET, size: 10", text);
        project.write("specs/spec.yaml", &spec);
        let [left, ..] = bounds(&project, "plain");
        assert!((left - from).abs() < 1e-6, "{text}: {left}");
    }
}

#[test]
fn stencils_leave_no_islands() {
    let project = project();
    let holes = |node: &str| measures(&project, node)["holes"].as_f64().unwrap();
    assert_eq!(holes("loose"), 7.0);
    assert_eq!((holes("stencil"), holes("font")), (0.0, 0.0));
    let area = |node: &str| measures(&project, node)["area"].as_f64().unwrap();
    assert!(area("stencil") > 0.7 * area("loose"));
    // What is cut out of a plate leaves one piece of it.
    project.edit("specs/spec.yaml", "  plain: { text", "  sheet: { rectangle: { width: 90, height: 40, at: [-9, -30] } }\n  plate: { difference: [sheet, stencil] }\n  plain: { text");
    assert_eq!(measures(&project, "plate")["components"], 1);
}

#[test]
fn what_cannot_be_written_is_told() {
    let told = |edit: [&str; 2], said: &[&str]| {
        let project = project();
        project.edit("specs/spec.yaml", edit[0], edit[1]);
        let run = project.run(&["build", "--only", "plain.svg"]);
        assert_eq!(run.code, Some(1), "{}", run.stderr);
        for said in said {
            assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
        }
        assert!(project.files("out").is_empty());
    };
    let plain = "plain: { text: { content: FRET, size: 10 } }";
    let of = |text: &str| format!("plain: {{ text: {{ {text} }} }}");
    told(
        [plain, &of("content: ФЖ, size: 10")],
        &[
            "plain letters have no `Ф`",
            "specs/spec.yaml:7:29",
            "name a font",
        ],
    );
    told(
        [plain, &of("content: FRETWORKFRET, size: 10, on: bar")],
        &["the text is", "its curve `bar`", "40"],
    );
    told(
        [plain, &of("content: FRET, size: 5, on: bar, start: 90%")],
        &["goes beyond its curve `bar` by"],
    );
    told(
        [plain, &of("content: FRET, size: 5, on: pole")],
        &["`pole` does not lie in a level plane"],
    );
    told(
        [plain, &of("content: OB, size: 5, stencil: { width: 4 }")],
        &[
            "`O`: bridges 4 wide are wider than the island",
            "specs/spec.yaml:7:",
        ],
    );
    let project = project();
    project.write("specs/fret.ttf", b"wOF2 and more");
    project.edit(
        "specs/spec.yaml",
        "plain.svg: { from: plain",
        "plain.svg: { from: font",
    );
    let run = project.run(&["build", "--only", "plain.svg"]);
    assert!(
        run.stderr.contains("the WOFF font is damaged"),
        "{}",
        run.stderr
    );
    for packed in [
        &include_bytes!("drawings/fret.woff")[..],
        include_bytes!("drawings/fret.woff2"),
    ] {
        project.write("specs/fret.ttf", packed);
        assert_eq!(measures(&project, "font")["holes"], 0);
    }
}

/// A spec with a rectangle that is as wide as this expression says.
fn measured(expression: &str) -> Project {
    let project = project();
    let frame = format!(
        "regions:\n  frame: {{ rectangle: {{ width: \"${{{expression}}}\", height: 1 }} }}\n"
    );
    project.edit("specs/spec.yaml", "regions:\n", &frame);
    project
}

fn width_of(expression: &str) -> f64 {
    let [left, _, right, _] = bounds(&measured(expression), "frame");
    right - left
}

#[test]
fn expressions_measure_text() {
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-6, "{a} {b}");
    let project = project();
    let [left, _, right, _] = bounds(&project, "plain");
    near(width_of("text_width('FRET')"), right - left);
    let [left, _, right, _] = bounds(&project, "wide");
    near(
        width_of("text_width('FRET', letter_spacing = 2)"),
        right - left,
    );
    near(
        width_of("text_width('FRET', 5)"),
        width_of("text_width('FRET') / 2"),
    );
    near(
        width_of("text_width('FRET\\\\nA', 5)"),
        width_of("text_width('FRET', size = 5)"),
    );
    // With a font: the advance of its letters, which is 0.2 more than what is seen of `I` on both sides together.
    let font = "text_width('II', 20, 'fret.ttf')";
    let one = width_of("text_width('I', 20, 'fret.ttf')");
    near(width_of(font), 2.0 * one);
    near(
        width_of("max([text_width(t, 20, font = 'fret.ttf') for t in ['I', 'II']])"),
        2.0 * one,
    );
    assert!(
        width_of("text_width('AV', 20, 'fret.ttf')") < width_of("text_width('VV', 20, 'fret.ttf')")
    );
}

#[test]
fn an_entry_measures_with_its_own_letters() {
    let project = project();
    project.edit(
        "specs/spec.yaml",
        "  plain: { text",
        "  own: { text: { content: OB, font: fret.ttf, size: \"20mm\", letter_spacing: 1, at: [\"${-text_width('OB')}\", 0] } }\n  told: { text: { content: OB, font: fret.ttf, size: 20, letter_spacing: 1, at: [\"${-text_width('OB', 20, 'fret.ttf', 1)}\", 0] } }\n  plain: { text",
    );
    assert_eq!(bounds(&project, "own"), bounds(&project, "told"));
    let [left, _, right, _] = bounds(&project, "own");
    assert!(left < -20.0 && right < 0.0, "{left} {right}");
}

#[test]
fn a_font_that_only_an_expression_names_is_an_input() {
    let project = measured("text_width('I', 20, 'fret.ttf')");
    project.edit(
        "specs/spec.yaml",
        "artifacts:\n",
        "artifacts:\n  frame.svg: { from: frame }\n",
    );
    project.build(&["--only", "frame.svg"]);
    let again = project.build(&["--only", "frame.svg"]);
    assert_eq!(again.artifacts("unchanged"), ["spec/frame.svg"]);
    project.write("specs/fret.ttf", b"no font any more");
    let run = project.run(&["build", "--only", "frame.svg"]);
    assert_eq!(run.code, Some(1));
    for said in [
        "no TrueType, OpenType or WOFF font",
        "specs/spec.yaml:7:",
        "in this expression",
    ] {
        assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
    }
}

#[test]
fn what_cannot_be_measured_is_told() {
    for (expression, said) in [
        ("text_width('Ж')", "plain letters have no `Ж`"),
        ("text_width('I', 20, 'fert.ttf')", "cannot read `fert.ttf`"),
        (
            "text_width('I', font = '../../../fret.ttf')",
            "outside of the project",
        ),
        (
            "text_width('I', sise = 4)",
            "no argument `sise`; did you mean `size`?",
        ),
        ("text_width('I', 4, size = 4)", "is given `size` twice"),
        ("text_width('I', 0)", "`size` of `text_width` is above 0"),
        ("text_width('I', font = 4)", "is the path of a font"),
        (
            "text_width('I', 1, None, 2, 3)",
            "at most `size`, `font` and `letter_spacing`",
        ),
        ("text_width(4)", "text"),
        ("text_with('I')", "did you mean `text_width`?"),
        (
            "sum([text_width('I', 1 + i % 3) for i in range(900)])",
            "steps",
        ),
        (
            "sum([text_width('I', 1, str(i) + '.ttf') for i in range(40)])",
            "cannot read `0.ttf`",
        ),
    ] {
        let run = measured(expression).run(&["check"]);
        assert_eq!(run.code, Some(1), "{expression}: {}", run.stderr);
        assert!(run.stderr.contains(said), "{expression}: {}", run.stderr);
        assert!(
            run.stderr.contains("specs/spec.yaml:7:"),
            "{expression}: {}",
            run.stderr
        );
    }
}

#[test]
fn fields_of_a_text_without_effect_are_told() {
    let cases = [
        (
            "content: FRET, size: 10 }",
            "content: FRET, side: right }",
            "`side` has no effect",
        ),
        (
            "content: FRET, size: 10 }",
            "content: FRET, start: 10% }",
            "`start` has no effect",
        ),
        (
            "content: FRET, size: 10 }",
            "content: FRET, size: 4, fit: 9 }",
            "`size` has no effect",
        ),
    ];
    for (from, to, said) in cases {
        let project = project();
        project.edit(
            "specs/spec.yaml",
            &format!("plain: {{ text: {{ {from}"),
            &format!("plain: {{ text: {{ {to}"),
        );
        let run = project.run(&["build"]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
    }
    let project = project();
    project.edit("specs/spec.yaml", "start: \"5mm\"", "start: \"41mm\"");
    let run = project.run(&["inspect", "specs/spec.yaml", "along"]);
    assert!(
        run.stderr
            .contains("starts at 41, and its curve `bar` is 40 long"),
        "{}",
        run.stderr
    );
}

#[test]
fn letters_that_run_into_one_another_on_a_bend_are_told() {
    let spec = |radius: u32, side: &str| {
        Project::of(&format!(
            "fretwork: 1
curves: {{ round: {{ circle: {{ radius: {radius} }} }} }}
regions: {{ name: {{ text: {{ content: MMMMMM, size: 12, on: round, side: {side}, align: middle, start: 25% }} }} }}
artifacts: {{ name.svg: {{ from: name }} }}
"
        ))
    };
    for side in ["left", "right"] {
        let told = |radius: u32| {
            let run = spec(radius, side).run(&["build"]);
            assert_eq!(run.code, Some(0), "{}", run.stderr);
            run.stderr
        };
        // On one side of a tight circle they do, and on a wide one on neither.
        let is_inner =
            told(13).contains("letters run into one another where `round` bends in 5 places");
        let other = if side == "left" { "right" } else { "left" };
        let run = spec(13, other).run(&["build"]);
        let said = "letters run into one another";
        assert_ne!(is_inner, run.stderr.contains(said), "{}", run.stderr);
        assert!(!told(60).contains(said));
    }
}
