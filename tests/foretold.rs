//! What `check` says before a build: labels that nothing has, elements that no drawing has; and what a build says meanwhile.

use super::project::Project;

const SPEC: &str = r#"fretwork: 1
regions:
  page: { rectangle: { width: 60, height: 40 } }
exemplars:
  dot: { vector: { file: dot.svg, id: dot } }
partitions:
  rows: { stripes: { spacing: 8, face_labels: [wide, narrow], edge_labels: line } }
  cells: { uniform: { cell_size: 9, face_labels: { big: 1, small: 2 } } }
arrangements:
  both: { union: [rows, cells] }
  dots: { place: { faces: both, element: dot, where: [wide, small] } }
artifacts:
  rows.svg: { from: rows, region: page, style: { line: { stroke: red }, rows: { stroke: blue }, "*": { width: 1 } } }
  dots.svg: { from: dots, region: page, style: { anything: { stroke: red } } }
"#;

const DOT: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="10mm" height="10mm" viewBox="0 0 10 10">
  <circle id="dot" r="1" cx="5" cy="5"/>
</svg>"#;

fn checked(text: &str) -> String {
    let project = Project::of(text);
    project.write("specs/dot.svg", DOT);
    project.run(&["check"]).stderr
}

#[test]
fn labels_that_nothing_can_have_are_told_by_check() {
    // What scripts and drawings may give is not guessed at.
    assert_eq!(checked(SPEC), "");
    for (from, to, said) in [
        (
            "where: [wide, small]",
            "where: [wide, smal]",
            "did you mean `small`?",
        ),
        ("{ line: {", "{ lien: {", "did you mean `line`?"),
        (
            "{ line: {",
            "{ 7: {",
            "nothing that is drawn has the label or the name `7`",
        ),
    ] {
        let told = checked(&SPEC.replace(from, to));
        assert!(told.contains(said), "{to}: {told}");
        let line = if to.starts_with("where") { 11 } else { 13 };
        assert!(told.contains(&format!("spec.yaml:{line}:")), "{told}");
    }
}

#[test]
fn elements_that_a_drawing_has_not_are_told_by_check() {
    let told = checked(&SPEC.replace("id: dot", "id: spot"));
    assert!(
        told.contains("no element `spot` is in the drawing"),
        "{told}"
    );
    let region = "  mark: { svg: { file: dot.svg, id: spot } }\nexemplars:";
    let told = checked(&SPEC.replace("exemplars:", region));
    assert!(
        told.contains("no element `spot` is in the drawing"),
        "{told}"
    );
}

#[test]
fn backslashes_and_columns_get_advice() {
    for (from, to, said) in [
        (
            "file: dot.svg",
            r#"file: "a\dot.svg""#,
            "write `/` between folders",
        ),
        (
            "file: dot.svg",
            r#"file: "a\b.svg""#,
            "write `/` between folders",
        ),
        (
            "file: dot.svg",
            r"file: a\dot.svg",
            "write `/` between folders",
        ),
        (
            "  page: {",
            "  page:\n  next: {",
            "indent what belongs to it further",
        ),
        ("  cells: {", "   cells: {", "in one column, here 2"),
    ] {
        let told = checked(&SPEC.replace(from, to));
        assert!(told.contains(said), "{to}: {told}");
    }
}

#[test]
fn a_small_circle_in_a_large_drawing_stays_round() {
    let project = Project::of(
        "fretwork: 1
exemplars:
  drawing: { vector: { file: large.svg } }
regions:
  hole: { svg: { file: large.svg, id: hole } }
  all: { svg: { file: large.svg } }
artifacts:
  drawing.json: { from: drawing, expect: { area: { min: 3.09 } } }
  hole.json: { from: hole, expect: { area: { min: 3.09, max: 3.15 } } }
  all.json: { from: all, expect: { area: { min: 103.09 } } }
",
    );
    project.write(
        "specs/large.svg",
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="3000mm" height="3000mm" viewBox="0 0 3000 3000">
  <circle id="hole" r="1" cx="5" cy="5"/><path d="M2900 2900h10v10h-10Z"/>
</svg>"#,
    );
    project.succeed(&["build"]);
}
