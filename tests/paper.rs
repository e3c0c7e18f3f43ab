//! Layers, pens and paper: what a plotter or a printer needs to know of a drawing.

use super::project::Project;

const SPEC: &str = "fretwork: 1
regions:
  page: { rectangle: { width: 100, height: 60 } }
  hole: { circle: { radius: 5, at: [20, 20] } }
partitions:
  rows: { stripes: { spacing: 10, edge_labels: [\"1400\", \"1410\"] } }
arrangements:
  heights: { relabel: { from: rows, labels: { \"1400\": [major, line], \"*\": minor } } }
artifacts:
  plain.svg: { from: heights, region: page }
  pens.svg: &pens
    region: page
    parts: [{ from: heights, role: draw }, { from: page, role: draw, layer: frame, pen: 2 }, { from: hole, role: draw, layer: frame, pen: 2 }]
    style: { major: { stroke: red, layer: thick, pen: 2 }, minor: { pen: 1 } }
  pens.dxf: *pens
  sheet.svg: { from: page, page: A5 landscape, margin: 12 }
  sheet.png: { from: page, page: A5 landscape, margin: 12, dpi: 100 }
  margin.svg: { from: page, margin: 5 }
";

fn text(project: &Project, path: &str) -> String {
    String::from_utf8(project.files("out")[path].clone()).unwrap()
}

#[test]
fn labels_layers_and_pens_name_the_layers_of_files() {
    let project = Project::of(SPEC);
    let run = project.run(&["build", "--deny", "warnings"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let plain = text(&project, "spec/plain.svg");
    for layer in ["\"line major\"", "\"minor\""] {
        assert!(
            plain.contains(&format!("inkscape:label={layer}")),
            "{layer}"
        );
    }
    let pens = text(&project, "spec/pens.svg");
    // What has no label is in a layer of the name of its node.
    assert_eq!(pens.matches("inkscape:label=").count(), 4, "{pens}");
    for layer in ["\"heights\"", "\"2 thick\"", "\"1 minor\"", "\"2 frame\""] {
        assert!(pens.contains(&format!("inkscape:label={layer}")), "{layer}");
    }
    let dxf = text(&project, "spec/pens.dxf");
    for layer in ["2 thick", "1 minor", "2 frame"] {
        assert!(dxf.contains(layer), "{layer}");
    }
}

#[test]
fn paper_has_its_size_and_pictures_their_resolution() {
    let project = Project::of(SPEC);
    project.succeed(&["build"]);
    let sheet = text(&project, "spec/sheet.svg");
    assert!(
        sheet.contains("width=\"210mm\" height=\"148mm\" viewBox=\"-55 -44 210 148\""),
        "{sheet}"
    );
    assert!(text(&project, "spec/margin.svg").contains("width=\"110"));
    let png = project.files("out")["spec/sheet.png"].clone();
    let decoder = png::Decoder::new(std::io::Cursor::new(&png));
    let reader = decoder.read_info().unwrap();
    let info = reader.info();
    assert_eq!((info.width, info.height), (827, 583));
    assert_eq!(info.pixel_dims.map(|dims| dims.xppu), Some(3937));
}

#[test]
fn what_does_not_fit_or_is_unclear_is_told() {
    let told = |edit: [&str; 2], only: &str, said: &[&str]| {
        let project = Project::of(SPEC);
        project.edit("specs/spec.yaml", edit[0], edit[1]);
        let run = project.run(&["build", "--only", only, "--deny", "warnings"]);
        assert_eq!(run.code, Some(1), "{only}: {}", run.stderr);
        for said in said {
            assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
        }
        assert!(project.files("out").is_empty());
    };
    let sheet = "sheet.svg: { from: page, page: A5 landscape, margin: 12 }";
    let of = |page: &str| format!("sheet.svg: {{ from: page, page: {page}, margin: 12 }}");
    told(
        [sheet, &of("A6")],
        "sheet.svg",
        &["room for 81 × 124 mm", "it fits when the page is turned"],
    );
    told(
        [sheet, &of("[50, 40]")],
        "sheet.svg",
        &["it fits with `scale: 0.256"],
    );
    told(
        [sheet, &of("A33")],
        "sheet.svg",
        &["no size of paper is called `A33`", "did you mean `A3`?"],
    );
    told(
        [sheet, &of("A3 sideways")],
        "sheet.svg",
        &["`landscape` or `portrait`"],
    );
    told(
        [
            "{ from: hole, role: draw, layer: frame, pen: 2 }",
            "{ from: hole, role: engrave, layer: frame, pen: 2 }",
        ],
        "pens.svg",
        &[
            "the layer `frame` has lines of different looks",
            "specs/spec.yaml:13:",
            "this layer",
        ],
    );
    told(
        [
            "{ from: hole, role: draw, layer: frame, pen: 2 }",
            "{ from: hole, role: draw, layer: frame }",
        ],
        "pens.svg",
        &[
            "the layer `frame` is drawn by different pens",
            "specs/spec.yaml:13:",
        ],
    );
    told(
        ["minor: { pen: 1 }", "minor: { layer: thick, pen: 1 }"],
        "pens.svg",
        &[
            "the layer `thick` is drawn by different pens",
            "specs/spec.yaml:14:",
        ],
    );
    told(
        ["dpi: 100 }", "dpi: 100, width: 300 }"],
        "sheet.png",
        &["a `width` or a `dpi`, not both"],
    );
    let project = Project::of(SPEC);
    project.edit("specs/spec.yaml", "\"1400\": [major", "\"1401\": [major");
    let run = project.run(&["check"]);
    for said in [
        "nothing in `rows` is labelled `1401`",
        "did you mean `1400`?",
        "specs/spec.yaml:8:",
    ] {
        assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
    }
}

#[test]
fn what_lies_beyond_the_page_is_told() {
    let spec = "fretwork: 1
regions:
  map: { rectangle: { width: 180, height: 130 } }
  title: { text: { content: MASSIF, size: 12, at: [0, -20] } }
artifacts:
  both.svg: { region: map, parts: [{ from: map }, { from: title }], page: A5 landscape }
";
    let project = Project::of(spec);
    let told = |said: &[&str]| {
        let run = project.run(&["build"]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        for said in said {
            assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
        }
        run.stderr.contains("warning") || run.stderr.contains('⚠')
    };
    // The page ends 9 mm above the map.
    assert!(told(&["what is drawn goes 19.9", "mm beyond the page"]));
    project.edit("specs/spec.yaml", ", page: A5 landscape", "");
    assert!(told(&["nothing of `title` lies in the region"]));
    project.edit("specs/spec.yaml", "region: map, ", "");
    assert!(!told(&[]));
    project.edit("specs/spec.yaml", "at: [0, -20]", "at: [0, 20]");
    project.edit("specs/spec.yaml", "{ parts", "{ region: map, parts");
    assert!(!told(&[]));
}
