//! The same script on the same region gives the same bytes: for any number of threads, in any
//! order, however often, and whatever stands in comments.

use super::*;

/// Nested partitions, random values of cells and of the stream, functions used as arrangements.
const BUSY: &str = "
def entry():
  cells = uniform_partition(irregular_properties(0.01), KEEP_OUTSIDE)
  def fill(face):
    n = 4 + 4 * random(face, 0, 1, 3)
    lines = stripes_properties(random(face, 0, pi), n, n / 2 + random(1, 2))
    inner = map_to_edges(lambda e: rotate(to_curve(e), random(e, 0, 1, 1)), stripes_partition(lines))
    dots = random_partition(irregular_properties(3 / (bbox_width(face) * bbox_height(face))), CROP)
    return append(inner(face), dots(face))
  own = lambda region: uniform_partition(irregular_properties(0.005), CROP)(region)
  return union(map_to_faces(fill, cells), own)
";

fn on_threads(count: usize, text: &str) -> Arc<Curves> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(count)
        .build()
        .unwrap();
    pool.install(|| curves(text))
}

#[test]
fn threads_are_not_seen_in_the_result() {
    let one = on_threads(1, BUSY);
    assert!(one.len() > 500, "{}", one.len());
    assert_eq!(one, on_threads(2, BUSY));
    assert_eq!(one, on_threads(3, BUSY));
}

#[test]
fn an_arrangement_is_the_same_every_time() {
    let made = compile(BUSY)
        .unwrap()
        .arrangement("entry", &[], Seed::root(1))
        .unwrap();
    let first = made.evaluate(&page(100.0), resolution(100.0)).unwrap();
    assert_eq!(
        first,
        made.evaluate(&page(100.0), resolution(100.0)).unwrap()
    );
    assert_ne!(first, run_on(BUSY, &page(100.0), &[], 2).unwrap());
}

#[test]
fn comments_and_blank_lines_change_nothing() {
    let commented = BUSY
        .replace("  def fill", "\n\n  # a comment (\n  def fill")
        .replace("    return append", "    # [\n    return append");
    assert_eq!(curves(BUSY), curves(&commented));
}

#[test]
fn what_a_mapper_constructs_does_not_shift_what_is_constructed_after_it() {
    let text = "
def entry():
  cells = uniform_partition(irregular_properties(0.01), KEEP_OUTSIDE)
  def fill(face):
    BODY
    return nothing()
  first = map_to_faces(fill, cells)
  return union(first, uniform_partition(irregular_properties(0.02), CROP))
";
    let plain = curves(&text.replace("BODY", "pass"));
    let busy = curves(&text.replace(
        "BODY",
        "random_partition(irregular_properties(0.1), CROP)(face)",
    ));
    assert_eq!(plain, busy);
}

#[test]
fn constructions_are_independent_and_shared_ones_equal() {
    let two = "
def entry():
  p = irregular_properties(0.01)
  return union(uniform_partition(p, CROP), uniform_partition(p, CROP))
";
    let one = "
def entry():
  t = uniform_partition(irregular_properties(0.01), CROP)
  return union(t, t)
";
    let (two, one) = (curves(two), curves(one));
    let half = |c: &Curves| c.filtered(|i, _| i < c.len() / 2);
    let rest = |c: &Curves| c.filtered(|i, _| i >= c.len() / 2);
    assert_eq!(half(&one), rest(&one));
    assert_ne!(half(&two), rest(&two));
    let function = "
def entry():
  t = lambda region: uniform_partition(irregular_properties(0.01), CROP)(region)
  u = lambda region: uniform_partition(irregular_properties(0.01), CROP)(region)
  return union(WHICH)
";
    let same = curves(&function.replace("WHICH", "t, t"));
    assert_eq!(half(&same), rest(&same));
    let other = curves(&function.replace("WHICH", "t, u"));
    assert_ne!(half(&other), rest(&other));
}

#[test]
fn random_values_of_a_cell_depend_on_it_and_on_n_alone() {
    let text = "
def entry():
  def mapper(f):
    a = random(f, 0, 1)
    b = random(f, 0, 1, 5)
    random(0, 1)
    again = [random(incident_edges(f)[0], 0, 1, 2), random(f, 0, 1, 5), random(f, 0, 1, n = 0)]
    same = again[1] == b and again[2] == a and a != b and again[0] != b
    return contour(f) if same and random(f, 7, 9) >= 7 and random(0, 1) != random(0, 1) else nothing()
  return map_to_faces(mapper, g)
";
    assert_eq!(counts(&grid_then(text))[2], 16);
    // The same vertex seen from two edges has the same value.
    let shared = "
def entry():
  move = lambda v: location(v) + point(random(v, -3, 3, 0), random(v, -3, 3, 1))
  ends = lambda e: match_points(to_curve(e), location(source_vertex(e)), location(target_vertex(e)), move(source_vertex(e)), move(target_vertex(e)))
  return map_to_edges(ends, g)
";
    assert_eq!(counts(&grid_then(shared)), [25, 40, 16, 1]);
}

#[test]
fn random_values_are_uniform() {
    let text = "
def entry():
  def mapper(v):
    return translate(import_svg('segment.svg'), point(random(v, 0, 1000), random(0, 1000)))
  return map_to_vertices(mapper, grid_partition(stripes_properties(0, 2), stripes_properties(pi / 2, 2), CROP))
";
    let made = curves(text);
    let starts: Vec<Point> = made.iter().map(|c| c.points[0]).collect();
    assert!(starts.len() > 2000);
    let mean = starts.iter().fold(Point::ORIGIN, |sum, p| sum + *p) * (1.0 / starts.len() as f64);
    assert!(
        (mean.x - 500.0).abs() < 25.0 && (mean.y - 500.0).abs() < 25.0,
        "{mean:?}"
    );
}

#[test]
fn mappers_cannot_remember() {
    let text = "
seen = []
def mapper(f):
  seen.append(1)
  return contour(f)
def entry():
  return map_to_faces(mapper, contour)
";
    assert!(
        error(text).message.contains("mmutable"),
        "{:?}",
        error(text)
    );
    let captured = "
def entry():
  p = stripes_properties(0, 10)
  return map_to_faces(lambda f: stripes_partition(set_edge_labels(p, 'x'))(f), contour)
";
    assert!(error(captured).message.contains("cannot change properties"));
}

#[test]
fn seeds_reach_what_is_constructed_at_the_top_of_a_script() {
    let text =
        "t = uniform_partition(irregular_properties(0.01), CROP)\ndef entry():\n  return t\n";
    let with = |seed| run_on(text, &page(100.0), &[], seed).unwrap();
    assert_eq!(with(1), with(1));
    assert_ne!(with(1), with(2));
    let named = compile(text)
        .unwrap()
        .arrangement("t", &[], Seed::root(1))
        .unwrap();
    assert_eq!(
        with(1),
        named.evaluate(&page(100.0), resolution(100.0)).unwrap()
    );
}
