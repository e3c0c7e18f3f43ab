//! Seamless tiles from specs: what a periodic region shows at one side goes on at the other.

use std::fs;

use super::project::{Project, ZIG};

/// A tile and what is drawn in it; the spec goes on with what is shown.
const TILE: &str = r#"fretwork: 1
seed: 4
regions:
  tile: { rectangle: { width: 60, height: 45, at: [7, -4], periodic: true } }
exemplars:
  zig: { vector: { file: assets/zig.svg } }
fields:
  wave: { expression: { value: "sin(2 * pi * (x - 7) / 60) + cos(2 * pi * (y + 4) / 45)" } }
  slope: { expression: { value: "0.01 + 0.0004 * x" } }
  aim: { expression: { value: "x / 50 + y / 70", unit: rad } }
partitions:
  cells: { uniform: { density: 0.02, border: keep_outside } }
  dense: { random: { density: slope, border: keep_outside } }
  checks: { grid: { across: { angle: 0, spacing: [15] }, along: { angle: 90, spacing: [12, 8] }, border: keep_outside } }
  fine: { uniform: { density: 0.3 } }
  hatch: { stripes: { angle: aim, spacing: 1.7 } }
  lines: { isolines: { field: wave, every: 0.37 } }
  dust: { packed: { elements: zig, scale: [0.1, 0.3], rotate: [0, 360] } }
arrangements:
  big: { place: { faces: checks, element: zig, scale: [3, 5], rotate: [0, 360] } }
  zigs: { place: { edges: cells, element: zig, flip: 0.5 } }
  small: { transform: { faces: cells, scale: 0.8, rotate: 20 } }
  filled: { fill: { faces: small, with: fine } }
  hatched: { fill: { faces: cells, with: hatch } }
  dusted: { fill: { faces: checks, with: dust } }
  mapped: { map: { faces: cells, with: "def m(f):\n  return random_partition(irregular_properties(0.2), CROP_ADD_BOUNDARY)(f)\n" } }
  masked: { inside: { input: fine, mask: small, border: crop_add_boundary } }
  both: { union: [small, lines] }
  sheet: { connect: { input: cells, region: tile, width: 0.8 } }
artifacts:
"#;

const SHOWN: [&str; 13] = [
    "cells", "dense", "checks", "lines", "big", "zigs", "small", "filled", "hatched", "dusted",
    "mapped", "masked", "both",
];

/// The points of all paths of an SVG file that is written with absolute commands.
fn points(svg: &str) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    for path in svg
        .split(" d=\"")
        .skip(1)
        .filter_map(|rest| rest.split('"').next())
    {
        let spaced: String = path
            .chars()
            .flat_map(|c| {
                if c.is_alphabetic() {
                    vec![' ', c, ' ']
                } else {
                    vec![c]
                }
            })
            .collect();
        let (mut at, mut command, mut is_y) = ([0.0; 2], 'M', false);
        // Two radii, a turn and two flags stand before the end of an arc.
        let mut skipped = 0;
        for word in spaced.split_whitespace() {
            match word.parse::<f64>() {
                Ok(_) if skipped > 0 => skipped -= 1,
                Ok(value) => {
                    let axis = if command == 'V' || (command != 'H' && is_y) {
                        1
                    } else {
                        0
                    };
                    at[axis] = value;
                    is_y = !is_y && command != 'H' && command != 'V';
                    if !is_y {
                        points.push(at);
                        skipped = if command == 'A' { 5 } else { 0 };
                    }
                }
                Err(_) => {
                    command = word.chars().next().unwrap_or('M');
                    skipped = if command == 'A' { 5 } else { 0 };
                }
            }
        }
    }
    points
}

/// Where points lie on the side at `at` along `axis`, corners apart.
fn touching(points: &[[f64; 2]], axis: usize, at: f64, ends: [f64; 2]) -> Vec<f64> {
    let along = |p: &[f64; 2]| p[1 - axis];
    let is_corner = |v: f64| ends.iter().any(|end| (v - end).abs() < 2e-3);
    points
        .iter()
        .filter(|p| (p[axis] - at).abs() < 2e-4)
        .map(along)
        .filter(|v| !is_corner(*v))
        .collect()
}

#[test]
fn what_ends_at_one_side_goes_on_at_the_other() {
    let artifacts: String = SHOWN
        .iter()
        .chain(&["sheet"])
        .map(|name| format!("  {name}.svg: {{ from: {name}, region: tile, clip: true }}\n"))
        .collect();
    let project = Project::of(&format!("{TILE}{artifacts}"));
    project.write("specs/assets/zig.svg", ZIG);
    project.succeed(&["build"]);
    for name in SHOWN.iter().chain(&["sheet"]) {
        let points =
            points(&fs::read_to_string(project.path(&format!("out/spec/{name}.svg"))).unwrap());
        let mut touches = 0;
        for (axis, low, high, ends) in [(0, 7.0, 67.0, [-4.0, 41.0]), (1, -4.0, 41.0, [7.0, 67.0])]
        {
            let [here, there] = [low, high].map(|at| touching(&points, axis, at, ends));
            touches += here.len();
            for (one, other) in [(&here, &there), (&there, &here)] {
                for at in one {
                    let is_met = other.iter().any(|v| (v - at).abs() < 2e-3);
                    assert!(
                        is_met,
                        "{name}: what touches a side at {at} (axis {axis}) does not go on"
                    );
                }
            }
        }
        assert!(touches > 3, "{name} hardly touches the sides: {touches}");
    }
}

#[test]
fn what_cannot_be_periodic_is_an_error() {
    let project = Project::of(&format!("{TILE}  a.svg: {{ from: fine, region: tile }}\n"));
    project.write("specs/assets/zig.svg", ZIG);
    for (wave, message) in [
        ("x", "the field is not the same on opposite sides"),
        ("y * y", "is not the same"),
    ] {
        let text = TILE.replace(
            "sin(2 * pi * (x - 7) / 60) + cos(2 * pi * (y + 4) / 45)",
            wave,
        );
        project.write(
            "specs/spec.yaml",
            format!("{text}  a.svg: {{ from: lines, region: tile }}\n"),
        );
        let run = project.run(&["build"]);
        assert_eq!(run.code, Some(1));
        let flat = run
            .stderr
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
            .replace("│ ", "");
        assert!(flat.contains(message), "{}", run.stderr);
    }
}

#[test]
fn a_label_that_nothing_has_is_a_warning_with_the_nearest() {
    let spec = "fretwork: 1
regions:
  page: { rectangle: { width: 50, height: 50 } }
exemplars:
  zig: { vector: { file: assets/zig.svg } }
partitions:
  cells: { uniform: { density: 0.05, face_labels: { large: 0.5, small: 0.5 } } }
arrangements:
  some: { place: { faces: cells, where: [larg, small], element: zig } }
artifacts:
  some.svg: { from: some, region: page }
";
    let project = Project::of(spec);
    project.write("specs/assets/zig.svg", ZIG);
    let report = project.build(&[]);
    let warnings = report.0["warnings"].as_array().unwrap();
    assert_eq!(warnings.len(), 1, "{}", report.0);
    assert_eq!(
        warnings[0]["message"],
        "nothing in `cells` is labelled `larg` here"
    );
    assert_eq!(warnings[0]["line"], 9);
    assert!(
        project
            .run(&["build"])
            .stderr
            .contains("did you mean `large`?")
    );
}

/// Copies of a flag by name, on a tile and on a page of several of them.
const REPEATS: &str = "fretwork: 1
regions:
  flag: { svg: { file: flag.svg } }
  cell: { rectangle: { width: 8, height: 6 } }
  tile: { rectangle: { width: 16, height: 12, periodic: true } }
  wide: { rectangle: { width: 32, height: 24, periodic: true } }
arrangements:
  cloth: { repeat: { from: flag, tile: cell, layout: straight } }
artifacts:
  tile.svg: { from: cloth, region: tile, clip: true }
  wide.svg: { from: cloth, region: wide, clip: true }
  wide.png: { from: cloth, region: wide, clip: true, width: 320 }
  preview.svg: { from: cloth, region: tile, clip: true, repeat: [2, 2] }
  preview.png: { from: cloth, region: tile, clip: true, repeat: [2, 2], width: 320 }
";

/// A flag that reaches out of its tile on three sides.
const FLAG: &str = "<svg xmlns='http://www.w3.org/2000/svg' width='8mm' height='6mm' viewBox='0 0 8 6'><path d='M1,-1 L9.5,2 L3,4 L2,7 Z'/></svg>";

fn repeats(layout: &str) -> Project {
    let project = Project::of(&REPEATS.replace("straight", layout));
    project.write("specs/flag.svg", FLAG);
    project
}

#[test]
fn repeats_by_name_are_seamless_and_previews_show_it() {
    for layout in ["straight", "half_drop", "brick", "mirrored"] {
        let project = repeats(layout);
        project.build(&[]);
        let files = project.files("out/spec");
        let pixels = |name: &str| picture(&files[name]);
        // Four tiles side by side are what is drawn on a page as large, to the pixels that lines pass.
        let (one, other) = (pixels("preview.png"), pixels("wide.png"));
        assert_eq!(one.len(), other.len(), "{layout}");
        let off = one.iter().zip(&other).filter(|(a, b)| a.abs_diff(**b) > 16);
        assert!(off.count() < 20, "{layout}");
        // No picture is empty or full.
        let dark = one.iter().filter(|p| **p < 128).count();
        assert!(dark > one.len() / 20 && dark < one.len() / 2, "{layout}");
    }
}

/// The first sample of every pixel of a picture, row by row.
fn picture(bytes: &[u8]) -> Vec<u8> {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().unwrap();
    let mut samples = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut samples).unwrap();
    let size = info.color_type.samples();
    samples.chunks(size).map(|pixel| pixel[0]).collect()
}

#[test]
fn repeats_that_do_not_close_are_refused() {
    for (layout, width, height, fits) in [
        ("half_drop", 8, 6, Some("16 by 6")),
        ("half_drop", 16, 6, None),
        ("brick", 8, 6, Some("8 by 12")),
        ("brick", 8, 12, None),
        ("mirrored", 24, 12, Some("32 by 12")),
        ("straight", 8, 6, None),
    ] {
        let project = repeats(layout);
        project.edit(
            "specs/spec.yaml",
            "width: 16, height: 12",
            &format!("width: {width}, height: {height}"),
        );
        let run = project.run(&["build", "--only", "tile.svg"]);
        assert_eq!(
            run.code,
            Some(i32::from(fits.is_some())),
            "{layout}: {}",
            run.stderr
        );
        if let Some(fits) = fits {
            assert!(
                run.stderr.contains("does not close") && run.stderr.contains(fits),
                "{}",
                run.stderr
            );
        }
    }
}

#[test]
fn previews_of_what_is_no_tile_are_refused() {
    for (from, to, said) in [
        (
            ", periodic: true }",
            " }",
            "only what is drawn on a periodic region repeats",
        ),
        (
            "preview.svg: { from: cloth, region: tile, clip: true",
            "preview.json: { from: cell",
            "a preview of tiles is a drawing",
        ),
        (
            "repeat: [2, 2] }\n  preview.png",
            "repeat: [200, 20] }\n  preview.png",
            "4000 copies are more than 1000",
        ),
        (
            "repeat: [2, 2] }\n  preview.png",
            "repeat: 3 }\n  preview.png",
            "two numbers of copies",
        ),
    ] {
        let project = repeats("brick");
        project.edit("specs/spec.yaml", from, to);
        let run = project.run(&["build"]);
        assert_eq!(run.code, Some(1), "{said}: {}", run.stderr);
        assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
    }
}

#[test]
fn faces_that_a_tile_loses_at_its_sides_are_told() {
    let spec = "fretwork: 1
regions:
  tile: { rectangle: { width: 60, height: 60, periodic: true } }
  whole: { faces: { of: cells, region: tile, inset: 1 } }
partitions:
  cells: { uniform: { cell_size: 12 } }
arrangements:
  shrunk: { transform: { faces: cells, scale: 0.8 } }
artifacts:
  shrunk.svg: { from: shrunk, region: tile }
  whole.svg: { from: whole }
";
    let project = Project::of(spec);
    let run = project.run(&["build"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    for said in [
        "specs/spec.yaml:4:3",
        "specs/spec.yaml:8:3",
        "faces of `cells` that cross the sides of the periodic region",
        "`border: keep_outside`",
    ] {
        assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
    }
    project.edit(
        "specs/spec.yaml",
        "cell_size: 12",
        "cell_size: 12, border: keep_outside",
    );
    let run = project.run(&["build", "--deny", "warnings"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
}

#[test]
fn repeats_by_name_are_cut_by_windows_wrapped_and_made_of_pixels() {
    for layout in ["straight", "half_drop", "brick", "mirrored"] {
        let project = repeats(layout);
        project.edit(
            "specs/spec.yaml",
            "artifacts:",
            "  around: { wrap: { from: cloth, onto: tube, region: tile, width: 0.3 } }
surfaces: { tube: { revolve: { profile: [[5.093, 0], [5.093, 20]], segments: 240 } } }
exemplars: { dots: { rasterize: { from: cloth, region: tile, pixel_size: 0.1, stroke: 0.3 } } }
artifacts:
  around.stl: { from: around, thickness: 0.2 }
  dots.png: { from: dots }",
        );
        let measured = |node: &str, more: &[&str]| -> serde_json::Value {
            let own = ["inspect", "specs/spec.yaml", node, "--format", "json"];
            let json = project.succeed(&[&own[..], more].concat());
            serde_json::from_str(&json).unwrap()
        };
        let length = |more: &[&str]| {
            let of = [&["--region", "wide"], more].concat();
            measured("cloth", &of)["length"].as_f64().unwrap()
        };
        let (whole, [x, y]) = (length(&["--window", "0,0,32,24"]), [13.3, 9.7]);
        let windows = [
            [0.0, 0.0, x, y],
            [x, 0.0, 32.0, y],
            [0.0, y, x, 24.0],
            [x, y, 32.0, 24.0],
        ];
        let parts = windows.map(|window| {
            let window = window.map(|v| v.to_string()).join(",");
            length(&["--window", &window])
        });
        let sum: f64 = parts.iter().sum();
        assert!(
            whole > 100.0 && (whole - sum).abs() < 1e-3,
            "{layout}: {whole} {parts:?}"
        );
        // Two tiles go around, and close without a seam.
        let around = measured("around", &[]);
        assert_eq!(around["copies"], 2, "{layout}: {around}");
        let stretch = around["stretch"]["mean"].as_f64().unwrap();
        assert!((stretch - 1.0).abs() < 1e-3, "{layout}: {around}");
        let dots = measured("dots", &[]);
        assert_eq!(
            (&dots["width"], &dots["height"]),
            (&160.into(), &120.into())
        );
        let solid = dots["solid_fraction"].as_f64().unwrap();
        assert!((0.1..0.3).contains(&solid), "{layout}: {dots}");
    }
}
