//! What drawings show: sizes with a beam's width, order, looks, arcs.

use std::fs;

use super::project::Project;

/// Builds a spec with these artifacts over a plate of 120 by 80 with a window and a hole, a mark, and an
/// exemplar of a leaf with a stalk.
fn built(artifacts: &str) -> (Project, Vec<String>) {
    let spec = format!(
        r##"fretwork: 1
exemplars: {{ sprig: {{ vector: {{ file: sprig.svg }} }} }}
regions:
  sheet: {{ rectangle: {{ width: 120, height: 80 }} }}
  window: {{ rectangle: {{ width: 40, height: 40, at: [20, 20] }} }}
  hole: {{ circle: {{ radius: 1.6, at: [7, 7] }} }}
  mark: {{ rectangle: {{ width: 10, height: 10, at: [70, 20] }} }}
  plate: {{ difference: [sheet, window] }}
artifacts:
{artifacts}"##
    );
    let project = Project::of(&spec);
    project.write(
        "specs/sprig.svg",
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 20 40">
  <path data-label="stalk" fill="none" stroke="black" d="M10 40V20L5 12"/>
  <path data-label="leaf" d="M10 10H18V18H12Z"/>
</svg>"#,
    );
    let report = project.build(&[]);
    let warnings = report.0["warnings"].as_array().unwrap().iter();
    let messages = warnings.map(|w| w["message"].as_str().unwrap().to_owned());
    let messages = messages.collect();
    (project, messages)
}

fn text(project: &Project, name: &str) -> String {
    let bytes = fs::read(project.path("out/spec").join(name)).unwrap();
    String::from_utf8(bytes).unwrap()
}

/// The shapes of an SVG in their order, each with the group that it is in.
fn shapes(svg: &str) -> Vec<(String, String)> {
    let mut group = String::new();
    let mut shapes = Vec::new();
    for line in svg.lines() {
        if line.starts_with("<g ") {
            group = line.to_owned();
        } else if line.starts_with("<path") || line.starts_with("<circle") {
            shapes.push((group.clone(), line.to_owned()));
        }
    }
    shapes
}

#[test]
fn openings_that_are_parts_of_their_own_have_their_size_after_the_cut() {
    let (project, warnings) = built(
        "  plate.svg: { kerf: 0.2, parts: [{ from: sheet }, { from: window }, { from: hole }, { from: mark, role: engrave }] }\n",
    );
    assert!(warnings.is_empty(), "{warnings:?}");
    let svg = text(&project, "plate.svg");
    let lines: Vec<String> = shapes(&svg).into_iter().map(|(_, shape)| shape).collect();
    // What is engraved comes first and keeps its size, the outline of the sheet comes last.
    let of = |from: &str| lines.iter().position(|line| line.contains(from)).unwrap();
    assert_eq!((lines.len(), of("70 20"), of("80.1")), (4, 0, 3), "{svg}");
    assert!(
        lines.contains(&r#"<circle cx="7" cy="7" r="1.5"/>"#.to_owned()),
        "{svg}"
    );
    assert!(svg.contains("20.1") && svg.contains("59.9"), "{svg}");
}

#[test]
fn holes_come_before_outlines_whatever_form_the_artifact_has() {
    let (project, _) = built(
        "  from.svg: { from: plate, optimize: true }\n  parts.dxf: { parts: [{ from: sheet }, { from: window }], optimize: true }\n  kerf.dxf: { from: plate, kerf: 0.2 }\n",
    );
    let svg = text(&project, "from.svg");
    assert!(
        svg.find("20 20").unwrap() < svg.find("M0 0").unwrap(),
        "{svg}"
    );
    for (name, outer, inner) in [("parts.dxf", "120", "60"), ("kerf.dxf", "120.1", "59.9")] {
        let dxf = text(&project, name);
        let entities = dxf.split("2\nENTITIES\n").nth(1).unwrap();
        let at = |x: &str| entities.find(&format!("\n10\n{x}\n")).unwrap();
        assert!(at(inner) < at(outer), "{name}");
    }
}

#[test]
fn roles_have_colours_in_drawings_and_styles_are_honoured_or_told() {
    let parts = "parts: [{ from: sheet }, { from: mark, role: engrave }]";
    let (project, warnings) = built(&format!(
        "  roles.svg: {{ {parts} }}\n  own.dxf: {{ {parts}, style: {{ sheet: {{ stroke: lime }}, mark: {{ stroke: \"#e8d8ff\" }} }} }}\n  typo.svg: {{ {parts}, style: {{ shet: {{ stroke: lime }} }} }}\n"
    ));
    let groups: Vec<String> = shapes(&text(&project, "roles.svg"))
        .into_iter()
        .map(|(group, _)| group)
        .collect();
    assert!(groups[0].contains("engrave") && groups[0].contains("#0000ff"));
    assert!(groups[1].contains("cut") && groups[1].contains("#ff0000"));
    assert!(text(&project, "own.dxf").contains("2\nsheet\n70\n0\n62\n3\n"));
    let told = |what: &str| warnings.iter().any(|warning| warning.contains(what));
    assert!(
        told("DXF has no colour #e8d8ff") && told("`shet`"),
        "{warnings:?}"
    );
    assert_eq!(warnings.len(), 2, "{warnings:?}");
}

#[test]
fn fill_and_stroke_both_count_and_filled_keeps_open_lines() {
    let both = "fill: \"#ff0000\", stroke: \"#0000ff\"";
    let (project, warnings) = built(&format!(
        "  both.svg: {{ from: window, style: {{ window: {{ {both} }} }} }}\n  filled.svg: {{ from: window, draw: filled, style: {{ window: {{ {both} }} }} }}\n  plain.svg: {{ from: window, draw: filled }}\n  sprig.svg: {{ from: sprig, draw: filled }}\n"
    ));
    assert!(warnings.is_empty(), "{warnings:?}");
    for name in ["both.svg", "filled.svg"] {
        let (group, _) = shapes(&text(&project, name)).remove(0);
        assert!(group.contains("fill=\"#ff0000\"") && group.contains("stroke=\"#0000ff\""));
    }
    let (plain, _) = shapes(&text(&project, "plain.svg")).remove(0);
    assert!(
        plain.contains("fill=\"#000000\"") && !plain.contains("stroke="),
        "{plain}"
    );
    let sprig = shapes(&text(&project, "sprig.svg"));
    let look = |label: &str| {
        sprig
            .iter()
            .find(|(group, _)| group.contains(label))
            .unwrap()
    };
    assert!(look("\"leaf\"").0.contains("fill=\"#000000\""));
    let (group, stalk) = look("\"stalk\"");
    assert!(
        group.contains("fill=\"none\"") && group.contains("stroke="),
        "{group}"
    );
    assert!(!stalk.contains('Z'), "{stalk}");
}

#[test]
fn lines_of_two_labels_have_what_the_styles_of_both_say() {
    let project = Project::of(
        "fretwork: 1
regions:
  page: { rectangle: { width: 60, height: 40 } }
partitions:
  rows: { stripes: { spacing: 8, edge_labels: [row] } }
arrangements:
  both: { relabel: { from: rows, labels: { row: [major, thick] } } }
artifacts:
  both.svg: { from: both, region: page, style: { thick: { width: 2 }, major: { stroke: red } } }
",
    );
    project.succeed(&["build"]);
    let svg = text(&project, "both.svg");
    assert!(
        svg.contains("#ff0000") && svg.contains("stroke-width=\"2\""),
        "{svg}"
    );
    project.edit(
        "specs/spec.yaml",
        "stroke: red",
        "stroke: red, layer: \" \"",
    );
    let run = project.run(&["check"]);
    assert!(
        run.stderr.contains("the name of a layer is not blank"),
        "{}",
        run.stderr
    );
}
