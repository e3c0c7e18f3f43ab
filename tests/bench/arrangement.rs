//! Partitions and mappers. The thesis gives 6.5 s for a brick wall of 350 cells and gives up at 9,000 with its
//! general engine; its tiled one takes 19.2 s for 9,000.

use std::sync::Arc;

use fretwork::arrangement::Script;
use fretwork::geometry::planar_map::{PlanarMap, resolution};
use fretwork::geometry::{Curves, LabelSet, Point, Region, Seed};
use fretwork::language::scalar::Label;
use fretwork::script::Host;

use super::super::Bench;

struct NoFiles;

impl Host for NoFiles {
    fn curves(&self, path: &str, _: &str, _: Option<f64>) -> Result<Arc<Curves>, String> {
        Err(format!("there is no `{path}`"))
    }

    fn script(&self, path: &str, _: &str) -> Result<(Arc<str>, Arc<str>), String> {
        Err(format!("there is no `{path}`"))
    }
}

/// A board of 200 by 200 squares, dark and light.
fn board() -> PlanarMap {
    let mut curves = Curves::new();
    for (i, j) in (0..200).flat_map(|i| (0..200).map(move |j| (i, j))) {
        let corner = Point::new(f64::from(i), f64::from(j));
        let label = if (i + j) % 2 == 0 { "dark" } else { "light" };
        let square = Region::rectangle(corner, corner + Point::new(1.0, 1.0));
        curves.append(&square.labelled(LabelSet::one(label)).contour);
    }
    PlanarMap::build(&curves, resolution(200.0)).expect("a board")
}

/// The curves of `expression` on a square of this side.
fn evaluate(expression: &str, side: f64) -> Arc<Curves> {
    let text = format!("{BRICKS}\ndef entry():\n  return {expression}\n");
    let script =
        Script::compile(&"bench.star".into(), &text, Arc::new(NoFiles)).expect("it compiles");
    let arrangement = script
        .arrangement("entry", &[], Seed::root(1))
        .expect("it has an entry");
    let square = Region::rectangle(Point::ORIGIN, Point::new(side, side));
    arrangement
        .evaluate(&square, resolution(side))
        .expect("it can be evaluated")
}

/// Courses of height 1 and bricks of length 2, in two grid faces each.
const BRICKS: &str = "
def wall():
  courses, joints = stripes_properties(0, 1), stripes_properties(pi / 2, 1)
  set_edge_labels(courses, 'bed')
  set_face_labels(courses, 'odd', 'even')
  set_edge_labels(joints, 'first', 'second')
  def keep(e):
    if has_label(e, 'bed'):
      return to_curve(e)
    course = 'odd' if has_label(e, 'first') else 'even'
    return to_curve(e) if has_label(left_face(e), course) else nothing()
  return map_to_edges(keep, grid_partition(courses, joints, KEEP_INSIDE))
";

/// Builds the wall; says how much memory the process has held at once per cell (vertex, edge or face) of the
/// grid, all that it held before included.
fn wall(side: f64) -> String {
    let curves = evaluate("wall()", side).len();
    let cells = (side + 1.0) * (side + 1.0) + 2.0 * side * (side + 1.0) + side * side;
    let peak = peak_bytes().map_or(String::new(), |bytes| {
        format!(", at most {:.0} bytes a cell", bytes / cells)
    });
    format!("{curves} curves{peak}")
}

/// The greatest resident size of the process so far, where the system tells.
fn peak_bytes() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace()
        .nth(1)?
        .parse()
        .ok()
        .map(|kibibytes: f64| kibibytes * 1024.0)
}

/// Runs the benchmarks of this file.
pub fn run(bench: &Bench) {
    for by in [0.0, 0.1] {
        let name = format!("arrangement/region of 20,000 faces, inset {by}");
        bench.run(&name, board, |map| {
            let dark = [Label("dark".into())];
            let chosen = fretwork::arrangement::Chosen {
                labels: Some(&dark),
                of: None,
            };
            let made = fretwork::arrangement::faces(map, &chosen, by, resolution(200.0));
            format!("{:?} parts", made.map(|region| region.area.len()))
        });
    }
    for (name, expression) in [
        ("stripes", "stripes_partition(stripes_properties(0.3, 1))"),
        (
            "grid",
            "grid_partition(stripes_properties(0.3, 1), stripes_properties(pi / 2, 1))",
        ),
        ("uniform", "uniform_partition(irregular_properties(1))"),
        ("random", "random_partition(irregular_properties(1))"),
    ] {
        bench.run(
            &format!("partition {name}, side 200"),
            || (),
            |()| format!("{} curves", evaluate(expression, 200.0).len()),
        );
    }
    for side in [100.0, 316.0, 1000.0] {
        bench.run(
            &format!("brick wall, {} grid faces", side * side),
            || (),
            |()| wall(side),
        );
    }
    // Their difference, by the number of edges, is what a call of a mapper costs.
    let grid = "grid_partition(stripes_properties(0, 1), stripes_properties(pi / 2, 1))";
    bench.run(
        "mapper never called",
        || (),
        |()| format!("{} curves", evaluate(grid, 400.0).len()),
    );
    let mapped = format!("map_to_edges(lambda e: nothing(), {grid})");
    bench.run(
        "mapper called on every edge",
        || (),
        |()| {
            let edges = PlanarMap::build(&evaluate(grid, 400.0), resolution(400.0))
                .expect("it is finite")
                .edge_count();
            evaluate(&mapped, 400.0);
            format!("{edges} calls")
        },
    );
}
