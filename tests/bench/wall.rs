//! Tiled planar maps: walls drawn whole, their windows and places. The thesis takes 1.9 s for the operators of a brick wall
//! and 17.3 s to convert 9,000 cells of it (table 4.1); its general engine gives up there.

use std::sync::Arc;

use fretwork::arrangement::{Arrangement, Engine, Script};
use fretwork::geometry::planar_map::resolution;
use fretwork::geometry::{Bounds, Curves, Point, Region, Seed};
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

/// Courses of height 5 and half bricks of length 10.
const WALL: &str = "
def wall():
  beds, joints = stripes_properties(0, 5), stripes_properties(pi / 2, 10)
  set_edge_labels(beds, 'bed')
  set_face_labels(beds, 'odd', 'even')
  set_edge_labels(joints, 'odd', 'even')
  def bond(e):
    if is_boundary(e) or has_label(e, 'bed'):
      return to_curve(e)
    course = 'odd' if has_label(left_face(e), 'odd') else 'even'
    return to_curve(e) if has_label(e, course) else nothing()
  return map_to_edges(bond, grid_partition(beds, joints, KEEP_INSIDE))
def bricks():
  return map_to_faces(lambda face: scale(contour(face), 0.9), wall())
";

fn arrangement(entry: &str) -> Arrangement {
    let script = Script::compile(&"bench.star".into(), WALL, Arc::new(NoFiles));
    let script = script.expect("it compiles");
    let made = script.arrangement(entry, &[], Seed::root(1));
    made.expect("it has an entry").into()
}

fn page(courses: f64, halves: f64) -> Region {
    let corner = Point::new((halves + 1.0) * 10.0, (courses + 1.0) * 5.0);
    Region::rectangle(Point::ORIGIN, corner)
}

/// Runs the benchmarks named `map/...`.
pub fn run(bench: &Bench) {
    let large = page(1000.0, 2001.0);
    let exact = resolution(large.bounds().longer_side());
    for entry in ["wall", "bricks"] {
        let made = || arrangement(entry);
        bench.run(&format!("wall/{entry}_operators"), made, |wall| match wall
            .engine(large.bounds(), exact)
        {
            Engine::Tiled { cells, .. } => format!("{cells} cells a tile"),
            Engine::General(why) => why.text.to_string(),
        });
        bench.run(&format!("wall/{entry}_million_tiled"), made, |wall| {
            let curves = wall.draw(&large, exact).expect("it is drawn");
            format!("{} curves", curves.len())
        });
        bench.run(&format!("wall/{entry}_million_general"), made, |wall| {
            let curves = wall.apply(&large, exact).expect("it is drawn");
            format!("{} curves", curves.len())
        });
    }
    let giant = page(400_000.0, 200_000.0);
    let exact = resolution(giant.bounds().longer_side());
    let at = Point::new(1_000_000.25, 1_000_000.25);
    let made = || arrangement("wall");
    bench.run("wall/window_of_giant", made, |wall| {
        let window = Bounds::of([at, at + Point::new(200.0, 150.0)]);
        let curves = wall.draw_in(&giant, exact, &window).expect("it is drawn");
        format!("{} curves", curves.len())
    });
    bench.run("wall/place_in_giant", made, |wall| {
        let found = wall.at(&giant, exact, at).expect("it is drawn");
        format!("{:?} away", found.distance)
    });
}
