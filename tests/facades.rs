//! The facades in `specs/facades/`, as a user builds them: what is in their files, and that they follow their
//! canvases.

use std::path::Path;

use fretwork::source::mesh;
use serde_json::Value;

use super::project::{Project, copy};

fn project() -> Project {
    let project = Project::empty();
    copy(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("specs/facades"),
        &project.path("specs/facades"),
    );
    project
}

fn inspect(project: &Project, spec: &str, node: &str, sets: &[String]) -> Value {
    let path = format!("specs/facades/{spec}.yaml");
    let mut arguments = vec!["inspect", &path, node, "--format", "json"];
    sets.iter().for_each(|set| arguments.extend(["--set", set]));
    serde_json::from_str(&project.succeed(&arguments)).unwrap()
}

fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap()
}

/// How many shapes of a layer there are with this symbol along x, in the lowest row that has some.
fn count(layout: &Value, layer: &str, symbol: &str) -> usize {
    let shapes = layout["shapes"].as_array().unwrap();
    let mine: Vec<&Value> = shapes
        .iter()
        .filter(|s| s["layer"] == layer && s["symbol_x"] == symbol)
        .collect();
    let lowest = mine
        .iter()
        .map(|s| number(s, "y"))
        .fold(f64::INFINITY, f64::min);
    mine.iter().filter(|s| number(s, "y") == lowest).count()
}

/// What holds for every layout: shapes stand inside, a symbol has one size, layers do not overlap themselves.
#[track_caller]
fn check(layout: &Value) {
    let sides = [("x", "width", "symbol_x"), ("y", "height", "symbol_y")];
    let shapes = layout["shapes"].as_array().unwrap();
    assert!(!shapes.is_empty());
    for (at, size, symbol) in sides {
        let whole = number(layout, size);
        let slack = 1e-6 * whole;
        for shape in shapes {
            let (low, extent) = (number(shape, at), number(shape, size));
            assert!(
                low >= -slack && extent > 0.0 && low + extent <= whole + slack,
                "{shape}"
            );
            let same = shapes.iter().find(|s| s[symbol] == shape[symbol]).unwrap();
            assert!((number(same, size) - extent).abs() < slack, "{shape}");
        }
        let borders: Vec<f64> = layout[at]
            .as_array()
            .unwrap()
            .iter()
            .map(|v| v.as_f64().unwrap())
            .collect();
        assert!(borders.is_sorted() && borders[0] == 0.0 && borders.last() == Some(&whole));
    }
}

#[test]
fn facades_build_without_a_warning() {
    let project = project();
    project.succeed(&["build", "--deny", "warnings"]);
    let files = project.files("out");
    for (name, bytes) in &files {
        assert!(bytes.len() > 200, "{name}");
    }
    let svg = |name: &str| String::from_utf8(files[name].clone()).unwrap();
    let groups = |text: &str| -> Vec<String> {
        let labels = text.split("inkscape:label=\"").skip(1);
        labels
            .filter_map(|rest| rest.split_once('"'))
            .map(|(name, _)| name.to_owned())
            .collect()
    };
    assert_eq!(
        groups(&svg("facades/residential-house/house.svg")),
        ["walls", "door", "columns"]
    );
    assert_eq!(
        groups(&svg("facades/hotel/hotel.svg")),
        ["front lines", "front", "base"]
    );
    assert_eq!(
        groups(&svg("facades/terraced-house/house.svg")),
        ["front", "balconies"]
    );
    assert_eq!(
        groups(&svg("facades/tower/tower.svg")),
        ["wall lines", "wall"]
    );
}

#[test]
fn solids_are_closed_and_scenes_share_their_meshes() {
    let project = project();
    project.succeed(&["build"]);
    let files = project.files("out");
    for (name, genus) in [
        ("facades/residential-house/house.stl", 0),
        ("facades/tower/tower.stl", 1),
    ] {
        let (model, _) =
            mesh::read(&files[name], &name.into(), 1.0, &mut |_| Err(String::new())).unwrap();
        let topology = model.bodies[0]
            .mesh
            .check_closed()
            .unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(
            (topology.components, topology.genus),
            (1, Some(genus)),
            "{name}"
        );
    }
    let glb = &files["facades/residential-house/house.glb"];
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    let scene: Value = serde_json::from_slice(&glb[20..20 + length]).unwrap();
    let list = |key: &str| scene[key].as_array().unwrap();
    let groups: Vec<&str> = list("nodes")
        .iter()
        .filter(|n| n["children"].is_array())
        .map(|n| n["name"].as_str().unwrap())
        .collect();
    assert_eq!(groups, ["walls", "door", "columns"]);
    assert!(list("nodes").iter().any(|n| n["name"] == "KP"));
    assert!(
        list("meshes").len() <= 8 && list("nodes").len() > 50,
        "one mesh a shape"
    );
}

#[test]
fn meshes_in_cells_are_one_body_with_the_solid() {
    let project = project();
    let path = "specs/facades/hotel.yaml";
    project.edit(
        path,
        "  hotel.glb: { from: hotel }",
        "  hotel.stl: { from: hotel, scale: \"1:100\" }",
    );
    project.succeed(&["build", path]);
    let files = project.files("out");
    let (name, bytes) = files
        .iter()
        .find(|(name, _)| name.ends_with("hotel.stl"))
        .unwrap();
    let (model, _) = mesh::read(bytes, &name.as_str().into(), 1.0, &mut |_| {
        Err(String::new())
    })
    .unwrap();
    let topology = model.bodies[0]
        .mesh
        .check_closed()
        .unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(topology.components, 1);
}

#[test]
fn layouts_of_the_specs_are_as_they_were() {
    let project = project();
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(concat!(env!("CARGO_MANIFEST_DIR"), "/snapshots"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    for (spec, node) in [
        ("residential-house", "house"),
        ("hotel", "hotel"),
        ("terraced-house", "house"),
        ("tower", "tower"),
    ] {
        let layout = inspect(&project, spec, node, &[]);
        check(&layout);
        settings.bind(|| insta::assert_snapshot!(format!("facade_{spec}"), shown(&layout)));
    }
}

/// A line for each row of a layer: the symbols with their places, rounded to millimetres.
fn shown(layout: &Value) -> String {
    let errors = format!(
        "alignment {:.4}, sizes {:.4}",
        number(layout, "alignment_error"),
        number(layout, "size_error")
    );
    let mut text = format!(
        "{} columns, {} rows, {errors}\n",
        layout["columns"], layout["rows"]
    );
    let mut row = String::new();
    for shape in layout["shapes"].as_array().unwrap() {
        let letter = |key: &str| shape[key].as_str().unwrap();
        let next = format!(
            "{} {} at {:.3}, {:.3} high:",
            letter("layer"),
            letter("symbol_y"),
            number(shape, "y"),
            number(shape, "height")
        );
        if next != row {
            text += &format!("\n{next}");
            row = next;
        }
        let hidden = if shape["visible"] == false {
            " hidden"
        } else {
            ""
        };
        text += &format!(
            " {}@{:.3}+{:.3}{hidden}",
            letter("symbol_x"),
            number(shape, "x"),
            number(shape, "width")
        );
    }
    text + "\n"
}

#[test]
fn a_house_follows_its_width() {
    let project = project();
    let mut windows = Vec::new();
    for width in [4.9, 5.5, 6.1, 7.7, 9.3, 11.3, 15.0, 22.6, 37.0, 60.0, 113.0] {
        let layout = inspect(
            &project,
            "residential-house",
            "house",
            &[format!("width={width}m")],
        );
        check(&layout);
        let (found, ideal) = (count(&layout, "walls", "B"), (width - 0.9) / 2.0);
        assert!(
            (found as f64 - ideal).abs() <= 1.0,
            "{width}: {found} windows"
        );
        assert_eq!(
            (count(&layout, "columns", "K"), count(&layout, "door", "D")),
            (2, 1),
            "{width}"
        );
        let of = |layer: &str| -> Vec<f64> {
            let shapes = layout["shapes"]
                .as_array()
                .unwrap()
                .iter()
                .filter(|s| s["layer"] == layer);
            shapes
                .map(|s| number(s, "x") + number(s, "width") / 2.0)
                .collect()
        };
        assert!(
            (of("door")[0] - width / 2.0).abs() < 1e-6,
            "{width}: the door is in the middle"
        );
        windows.push(found);
    }
    assert!(
        windows.is_sorted() && windows[0] == 2 && windows[10] == 56,
        "{windows:?}"
    );
}

#[test]
fn fronts_follow_their_heights() {
    let project = project();
    for height in [10, 13, 16, 22, 31, 40, 60] {
        let layout = inspect(
            &project,
            "terraced-house",
            "house",
            &[format!("height={height}m")],
        );
        check(&layout);
        let floors = layout["shapes"]
            .as_array()
            .unwrap()
            .iter()
            .filter(|s| s["symbol_x"] == "W" && s["symbol_y"] == "S");
        let first = |v: &&Value| number(v, "x") < 1e-6;
        let floors = floors.filter(first).count();
        let balconies = layout["shapes"]
            .as_array()
            .unwrap()
            .iter()
            .filter(|s| s["layer"] == "balconies")
            .count();
        assert_eq!(balconies, floors.div_ceil(2), "{height}: {floors} floors");
    }
    for radius in [1.5, 4.0, 15.0, 30.0] {
        let layout = inspect(&project, "tower", "tower", &[format!("radius={radius}m")]);
        check(&layout);
        assert_eq!(count(&layout, "wall", "M"), count(&layout, "wall", "V"));
    }
}
