//! Windows between shapes that lie apart near them, and touch one another in a ring far away: what lies within the ring is a
//! face, as it is in the whole.

use super::super::project::Project;

/// Shapes of cells, apart but for those between two squares about the middle of the sheet. What lies between them is filled.
fn spec(far: f64) -> String {
    format!(
        "fretwork: 1
map: {{}}
regions:
  sheet: {{ rectangle: {{ width: 4000, height: 3000 }} }}
partitions:
  cells: {{ uniform: {{ cell_size: 40, border: crop_add_boundary }} }}
  rows: {{ stripes: {{ angle: 30, spacing: 9, anchor: origin }} }}
arrangements:
  shapes:
    map:
      faces: cells
      reach: 1
      with: |
        def shape(face):
            far = centroid(face) - point(2000, 1500)
            far = max(abs(far.x), abs(far.y))
            return scale(contour(face), 1.0 if far > {far} and far < {far} + 150 else 0.7)
  hatched: {{ fill: {{ faces: shapes, with: rows }} }}
  masked: {{ inside: {{ input: rows, mask: shapes }} }}
artifacts:
  hatched.geojson: {{ from: hatched, region: sheet, crs: map }}
  masked.geojson: {{ from: masked, region: sheet, crs: map }}
"
    )
}

/// Bug: shapes that lie apart around a window were taken to lie in the open, also where a ring of others, farther than what is
/// drawn for the window, encloses them.
#[test]
fn a_window_within_a_far_ring_of_shapes_is_that_of_the_whole() {
    let windows = ["1900,1400,2060,1540", "100,1400,260,1500"];
    let page = "0,0,4000,3000";
    let mut lines = Vec::new();
    for far in [1100.0, 9000.0] {
        let project = Project::of(&spec(far));
        let build = |windows: &[&str]| {
            let windows = windows.iter().flat_map(|window| ["--window", window]);
            let all: Vec<&str> = ["build", "--no-cache"].into_iter().chain(windows).collect();
            project.succeed(&all);
            project.files("out")
        };
        let whole = build(&[windows[0], windows[1], page]);
        for window in windows {
            let name = window.replace(',', "_");
            let own = build(&[window]);
            let own = own.iter().filter(|(path, _)| path.contains(&name));
            assert_eq!(own.clone().count(), 2);
            for (path, bytes) in own {
                assert!(whole[path] == *bytes, "{far}: {path} is another one");
            }
        }
        let path = format!("spec/hatched/{}.geojson", windows[0].replace(',', "_"));
        let text = String::from_utf8_lossy(&whole[&path]).into_owned();
        lines.push(text.matches("LineString").count());
    }
    // Between the shapes there are rows within the ring only.
    assert!(lines[1] > 100 && lines[0] > lines[1] + 30, "{lines:?}");
}
