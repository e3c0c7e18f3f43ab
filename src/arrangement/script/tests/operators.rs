//! Every operator of tables 3.2 to 3.6 on a case small enough to count by hand. The lines of a grid
//! of width 20 on the square of side 100 are at 10, 30, 50, 70, 90: 4 by 4 whole cells inside.

use super::*;
use crate::script::mapping::Items;
use crate::script::program::Task;
use fretwork_geometry::{Field, VectorField};
use fretwork_script::Value;

const GRID: &str = "grid_partition(stripes_properties(0, 20), stripes_properties(pi / 2, 20), ";

fn entry(expression: &str) -> String {
    format!("def entry():\n  return {expression}\n")
}

/// `entry` maps `kind` of the grid of whole cells with a lambda.
fn mapped(kind: &str, lambda: &str) -> String {
    grid_then(&entry(&format!("map_to_{kind}({lambda}, g)")))
}

#[test]
fn stripes_are_cropped_and_bounded() {
    assert_eq!(
        counts(&entry("stripes_partition(stripes_properties(0, 20))")),
        [14, 19, 6, 1]
    );
    assert_eq!(
        counts(&entry("stripes_partition(stripes_properties(0, 30, 10))")),
        [14, 19, 6, 1]
    );
}

#[test]
fn borders_of_grids() {
    assert_eq!(
        counts(&entry(&format!("{GRID}KEEP_INSIDE)"))),
        [25, 40, 16, 1]
    );
    assert_eq!(
        counts(&entry(&format!("{GRID}KEEP_OUTSIDE)"))),
        [49, 84, 36, 1]
    );
    assert_eq!(
        counts(&entry(&format!("{GRID}CROP_ADD_BOUNDARY)"))),
        [49, 84, 36, 1]
    );
    assert_eq!(
        counts(&entry(&format!("{GRID}CROP)"))),
        counts(&entry(&format!("{})", &GRID[..GRID.len() - 2])))
    );
    assert_eq!(map(&entry(&format!("{GRID}CROP)"))).face_count(), 16);
}

#[test]
fn irregular_partitions_have_their_density() {
    for operator in ["uniform_partition", "random_partition"] {
        let faces = counts(&entry(&format!(
            "{operator}(irregular_properties(0.01), KEEP_OUTSIDE)"
        )))[2];
        assert!((100..200).contains(&faces), "{operator} {faces}");
    }
}

#[test]
fn labels_of_stripes_and_cells() {
    let text = "
def entry():
  a, b = stripes_properties(0, 20), stripes_properties(pi / 2, 20)
  set_face_labels(set_edge_labels(a, 'h1', 'h2'), 'f1', 'f2')
  set_edge_labels(b, ['v1', 'v2'])
  g = grid_partition(a, b, KEEP_INSIDE)
  edges = map_to_edges(lambda e: to_curve(e) if has_label(e, 'h1') else nothing(), g)
  faces = map_to_faces(lambda f: contour(f) if has_label(f, 'f1') and not has_label(f, 'v1') else nothing(), g)
  return [edges, faces][CHOICE]
";
    // Lines 1 to 5 of each family: 1, 3 and 5 are the second of the cycle, 2 and 4 the first.
    assert_eq!(counts(&text.replace("CHOICE", "0"))[1], 2 * 4);
    assert_eq!(counts(&text.replace("CHOICE", "1"))[2], 2 * 4);
}

#[test]
fn curves_are_given_other_labels() {
    let text = "
def entry():
  a = stripes_properties(0, 20)
  set_edge_labels(a, 'h1', 'h2')
  g = grid_partition(a, stripes_properties(pi / 2, 20), KEEP_INSIDE)
  def named(e):
    own = to_curve(e)
    labels = {'h1': ['major', 'thick'], '*': 'minor'} if USES_DICT else ['major'] if has_label(e, 'h1') else 'none'
    return set_labels(own, labels)
  t = map_to_edges(named, g)
  return map_to_edges(lambda e: to_curve(e) if has_label(e, 'LABEL') else nothing(), t)
";
    let count = |label: &str, uses_dict: &str| {
        let text = text.replace("USES_DICT", uses_dict);
        counts(&text.replace("LABEL", label))[1]
    };
    // Lines 2 and 4 of five across, as in the test above.
    assert_eq!(count("major", "True"), 2 * 4);
    assert_eq!(count("thick", "True"), 2 * 4);
    assert_eq!(count("minor", "True"), 3 * 4);
    assert_eq!((count("h1", "True"), count("h1", "False")), (0, 0));
    assert_eq!(count("major", "False"), 2 * 4);
}

#[test]
fn weighted_labels_are_drawn() {
    let text = "
def entry():
  p = irregular_properties(0.02)
  set_weighted_face_labels(p, 'a', 1, 'b', 3)
  set_weighted_edge_labels(p, 'c', 1)
  set_weighted_vertex_labels(p, 'd', 1)
  t = uniform_partition(p, KEEP_OUTSIDE)
  def keep(f):
    ok = has_label(f, 'a') and has_label(incident_edges(f), 'c') and has_label(incident_vertices(f), 'd')
    return scale(contour(f), 0.5) if ok else nothing()
  return union(map_to_faces(keep, t))
";
    let kept = map(text).face_count();
    assert!((25..100).contains(&kept), "{kept}");
}

#[test]
fn properties_are_taken_as_they_are_when_a_partition_is_constructed() {
    let text = "
def entry():
  p = stripes_properties(0, 20)
  t = stripes_partition(p)
  set_edge_labels(p, 'late')
  return map_to_edges(lambda e: to_curve(e) if has_label(e, 'late') else nothing(), t)
";
    assert!(curves(text).is_empty());
}

#[test]
fn mapping_operators_see_every_cell_once() {
    let dot =
        "match_point(scale(import_svg('square.svg'), 0.1), bbox_center(import_svg('square.svg')), ";
    assert_eq!(
        counts(&mapped("vertices", &format!("lambda v: {dot}location(v))")))[2],
        25
    );
    assert_eq!(
        counts(&mapped(
            "edges",
            &format!("lambda e: {dot}location_at(e, 0.5))")
        ))[2],
        40
    );
    assert_eq!(
        counts(&mapped("faces", &format!("lambda f: {dot}centroid(f))")))[2],
        16
    );
    assert_eq!(counts(&mapped("faces", "contour")), [25, 40, 16, 1]);
    for other in [
        "map_to_faces_tpm",
        "ghost_map_to_faces",
        "ghost_map_to_faces_tpm",
    ] {
        assert_eq!(
            counts(&grid_then(&entry(&format!("{other}(contour, g)")))),
            [25, 40, 16, 1]
        );
    }
}

#[test]
fn incidence() {
    let ring = "len(incident_edges(v)) == 4 and len(incident_faces(v)) == 4";
    let keep = "match_point(scale(import_svg('square.svg'), 0.1), bbox_center(import_svg('square.svg')), location(v))";
    assert_eq!(
        counts(&mapped(
            "vertices",
            &format!("lambda v: {keep} if {ring} else nothing()")
        ))[2],
        9
    );
    let corner = "lambda f: contour(f) if len(incident_edges(f)) == 4 and len(incident_vertices(f)) == 4 else nothing()";
    assert_eq!(counts(&mapped("faces", corner))[2], 16);
    // Every edge runs along its line: horizontal ones to the right with their left face above.
    let ends = "
def mapper(e):
  a, b = location(source_vertex(e)), location(target_vertex(e))
  if a.y != b.y or b.x < a.x:
    return nothing()
  l, r = left_face(e), right_face(e)
  if is_boundary(e):
    return nothing()
  up = (centroid(l) - centroid(r)).y
  return to_curve(e) if up > 0 and l != r and l == left_face(e) else nothing()
def entry():
  return map_to_edges(mapper, g)
";
    assert_eq!(counts(&grid_then(ends))[1], 12);
}

#[test]
fn boundaries() {
    assert_eq!(
        counts(&mapped(
            "edges",
            "lambda e: to_curve(e) if is_boundary(e) else nothing()"
        ))[1],
        16
    );
    assert_eq!(
        counts(&mapped(
            "faces",
            "lambda f: contour(f) if is_boundary(f) else nothing()"
        ))[2],
        12 + 1
    );
    assert_eq!(
        counts(&mapped(
            "faces",
            "lambda f: contour(f) if is_bounded_face(f) else nothing()"
        ))[2],
        4
    );
    let dot = "match_point(scale(import_svg('square.svg'), 0.1), bbox_center(import_svg('square.svg')), location(v))";
    assert_eq!(
        counts(&mapped(
            "vertices",
            &format!("lambda v: {dot} if is_outside(v) else nothing()")
        ))[2],
        16
    );
}

#[test]
fn placing() {
    let ends = "location(source_vertex(e)), location(target_vertex(e))";
    let zig = format!(
        "lambda e: match_points(import_svg('segment.svg'), point(0, 0), point(100, 0), {ends})"
    );
    assert_eq!(counts(&mapped("edges", &zig)), [25, 40, 16, 1]);
    let fitted = map(&mapped(
        "faces",
        "lambda f: match_face(import_svg('square.svg'), f)",
    ));
    // The square's circle, of radius 5√2, becomes that of radius 10: a side of 10√2.
    assert!(
        (fitted.area() - 16.0 * 200.0).abs() < 1e-6,
        "{}",
        fitted.area()
    );
    let shrunk = map(&mapped(
        "faces",
        "lambda f: translate(rotate(scale(contour(f), 0.5), pi / 2), point(1, 2))",
    ));
    assert!((shrunk.area() - 16.0 * 100.0).abs() < 1e-6);
    assert_eq!(
        shrunk
            .location(fretwork_geometry::VertexId(0))
            .x
            .rem_euclid(10.0),
        6.0
    );
}

#[test]
fn named_points_and_labelled_curves() {
    let text = "
def entry():
  c = rotate(scale(import_svg('parts.svg'), 2), pi)
  tip = point_labeled(c, 'tip')
  leaf = match_point(curve_labeled(c, 'leaf'), tip, point(50, 50))
  both = append(curve_labeled(c, 'stem'), leaf)
  return lambda region: both
";
    let both = curves(text);
    assert_eq!(both.len(), 2);
    // The tip of the moved leaf, and the name that the first of the two keeps.
    assert!(
        both.get(1)
            .points
            .iter()
            .any(|p| p.distance(Point::new(50.0, 50.0)) < 1e-9),
        "{both:?}"
    );
    assert!(
        both.point_named("tip")
            .is_some_and(|p| p.distance(Point::new(50.0, 50.0)) > 1.0)
    );
}

#[test]
fn boxes_of_cells_and_curves() {
    let text = "
def mapper(f):
  ok = bbox_width(f) == 20 and bbox_height(contour(f)) == 20 and (bbox_center(f) - centroid(f)).length() < 1e-9
  return contour(f) if ok else nothing()
def entry():
  return map_to_faces(mapper, g)
";
    assert_eq!(counts(&grid_then(text))[2], 16);
}

#[test]
fn masks() {
    let text = "
hole = map_to_faces(lambda f: scale(contour(f), 0.5), g)
lines = stripes_partition(stripes_properties(0, 20))
def entry():
  return KIND(lines, hole, BORDER)
";
    let count = |kind: &str, border: &str| {
        counts(&grid_then(
            &text.replace("KIND", kind).replace("BORDER", border),
        ))
    };
    // No line meets the small squares, which lie between them.
    assert_eq!(count("inside", "CROP"), [0, 0, 0, 0]);
    assert_eq!(count("inside", "CROP_ADD_BOUNDARY")[2], 16);
    assert_eq!(count("outside", "KEEP_INSIDE")[1], 19);
    assert_eq!(count("outside_tpm", "CROP_ADD_BOUNDARY")[2], 6 + 16);
}

#[test]
fn unions_of_two_and_of_many() {
    let two = grid_then(&entry(
        "union(g, map_to_faces(lambda f: scale(contour(f), 0.5), g))",
    ));
    assert_eq!(counts(&two)[2], 32);
    assert_eq!(
        counts(&grid_then(&entry("merge([g, g], g)"))),
        [25, 40, 16, 1]
    );
    let long = "
def entry():
  t = g
  for i in range(3000):
    t = union(t, lambda region: nothing())
  return t
";
    assert_eq!(counts(&grid_then(long))[2], 16);
}

#[test]
fn any_function_of_one_argument_is_an_arrangement() {
    assert_eq!(
        counts(&entry("lambda region: contour(region)")),
        [4, 4, 1, 1]
    );
    assert_eq!(
        counts(&entry(
            "map_to_faces(lambda f: scale(contour(f), 0.5), contour)"
        )),
        [4, 4, 1, 1]
    );
    assert_eq!(
        counts(&entry("export_svg(lambda region: nothing(), 100)")),
        [0, 0, 0, 0]
    );
    // And an arrangement is a mapper of faces.
    assert_eq!(
        counts(&grid_then(&entry(
            "map_to_faces(stripes_partition(stripes_properties(0, 10)), g)"
        )))[2],
        48
    );
}

#[test]
fn regions_of_holes_and_of_pieces() {
    let outer = |x: f64| {
        vec![[x, 0.0], [x + 10.0, 0.0], [x + 10.0, 10.0], [x, 10.0]]
            .into_iter()
            .map(Point::from)
    };
    let hole = [[2.0, 2.0], [2.0, 4.0], [4.0, 4.0], [4.0, 2.0]]
        .map(Point::from)
        .to_vec();
    let ring = fretwork_geometry::Polygon {
        outer: outer(0.0).collect(),
        holes: vec![hole],
    };
    let far = fretwork_geometry::Polygon {
        outer: outer(20.0).collect(),
        holes: Vec::new(),
    };
    let text = "
def entry():
  def made(region):
    ok = (bbox_width(region) == WIDTH and random(region, 2, 3) >= 2 and is_boundary(region)
          and centroid(region).x > 5 and not has_label(region, 'x'))
    return union(stripes_partition(stripes_properties(0, 4)), contour)(region) if ok else None
  return made
";
    let one = run_on(
        &text.replace("WIDTH", "10"),
        &Region::of_area(vec![ring.clone()]),
        &[],
        1,
    )
    .unwrap();
    let two = run_on(
        &text.replace("WIDTH", "30"),
        &Region::of_area(vec![ring, far]),
        &[],
        1,
    )
    .unwrap();
    let faces = |curves: &Curves| {
        PlanarMap::build(curves, resolution(30.0))
            .unwrap()
            .face_count()
    };
    assert!(
        faces(&one) >= 4 && faces(&two) > faces(&one),
        "{} {}",
        faces(&one),
        faces(&two)
    );
}

#[test]
fn points_calculate() {
    let text = "
def entry():
  p, q = point(3, 4), point(1, -1)
  ok = (p.length() == 5 and p.dot(q) == -1 and (p + q).x == 4 and (p - q).y == 5 and -q == point(-1, 1)
        and p * 2 == 2 * p and p / 2 == p * 0.5 and p == +p and p != q and {p: 1}[point(3, 4)] == 1
        and floor(-1.5) == -2 and type(floor(2.5)) == 'int' and 7 / 2 == 3.5)
  return (lambda region: contour(region)) if ok else None
";
    assert_eq!(curves(text).len(), 4);
}

#[test]
fn arguments_of_every_kind() {
    let text = "
def entry(size, names, motif, height, flow, texture, many):
  def mapper(f):
    if height(f) != height(centroid(f)) or flow(f).y != 0 or names != ['a', 'b']:
      return nothing()
    return append(texture(f), match_face(many[0], f))
  return map_to_faces(mapper, grid_partition(stripes_properties(0, size), stripes_properties(pi / 2, size), KEEP_INSIDE))
";
    let contour = crate::Arrangement::new(|region, _| Ok(Arc::new(region.contour.clone())));
    let x = Field::new([1; 32], |p| p.x);
    let names = ["a", "b"].map(|n| Value::Text(n.into())).to_vec();
    let args: Vec<(Arc<str>, Argument)> = vec![
        ("size".into(), Argument::Value(Value::Float(20.0))),
        ("names".into(), Argument::Value(Value::List(names))),
        ("motif".into(), Argument::Curves(Arc::new(segment()))),
        ("height".into(), Argument::Field(x.clone())),
        (
            "flow".into(),
            Argument::VectorField(VectorField {
                x,
                y: Field::constant(0.0),
            }),
        ),
        ("texture".into(), Argument::Arrangement(contour)),
        (
            "many".into(),
            Argument::List(vec![Argument::Curves(Arc::new(square()))]),
        ),
    ];
    let made = run_on(text, &page(100.0), &args, 1).unwrap();
    assert_eq!(
        PlanarMap::build(&made, resolution(100.0))
            .unwrap()
            .face_count(),
        32
    );
}

#[test]
fn densities_may_be_fields() {
    let text = "def entry(d):\n  return uniform_partition(irregular_properties(d), KEEP_OUTSIDE)\n";
    let args = [("d".into(), Argument::Field(Field::constant(0.01)))];
    let made = run_on(text, &page(100.0), &args, 1).unwrap();
    assert!(
        PlanarMap::build(&made, resolution(100.0))
            .unwrap()
            .face_count()
            > 90
    );
}

#[test]
fn mappers_written_in_a_spec_and_by_an_entry() {
    let cells = Arc::new(map(&grid_then(&entry("g"))));
    let inline = compile(
        "def helper(f):\n  return contour(f)\ndef keep(f):\n  return scale(helper(f), 0.5)\n",
    )
    .unwrap();
    let by_entry = compile("def made(k):\n  return lambda f: scale(contour(f), k)\n").unwrap();
    let args = [("k".into(), Argument::Value(Value::Float(0.5)))];
    for mapper in [
        inline.inline_mapper(Seed::root(1)).unwrap(),
        by_entry.mapper("made", &args, Seed::root(1)).unwrap(),
    ] {
        let kind = fretwork_script::CellKind::Face;
        let made = mapper
            .map_cells(
                Task {
                    kind,
                    map: cells.clone(),
                    items: Items::All,
                    watch: None,
                    known: None,
                },
                &page(100.0),
                resolution(100.0),
            )
            .unwrap();
        assert_eq!(
            PlanarMap::build(&made, resolution(100.0))
                .unwrap()
                .face_count(),
            16
        );
    }
}
