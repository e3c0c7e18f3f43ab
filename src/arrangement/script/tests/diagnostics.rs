//! What a script does wrong is said with the mapper, the cell and the place.

use super::*;

fn message(rest: &str) -> String {
    error(&grid_then(rest)).message
}

#[test]
fn an_error_in_a_mapper_names_mapper_cell_and_place() {
    let text = grid_then(
        "def bad(face):\n  x = 1 + 'a'\n  return x\ndef entry():\n  return map_to_faces(bad, g)",
    );
    let e = error(&text);
    assert!(
        e.message.starts_with("`bad` on the face at (20, 20): "),
        "{e:#?}"
    );
    assert_eq!(underlined(&text, &e, 0), "1 + 'a'");
    assert_eq!(underlined(&text, &e, 1), "map_to_faces(bad, g)");
}

#[test]
fn the_first_cell_is_named_for_any_number_of_threads() {
    let text = "
def bad(e):
  return None if location(source_vertex(e)).x > 40 else to_curve(e)
def entry():
  return map_to_edges(bad, grid_partition(stripes_properties(0, 2), stripes_properties(pi / 2, 2), KEEP_INSIDE))
";
    let on = |n: usize| {
        rayon::ThreadPoolBuilder::new()
            .num_threads(n)
            .build()
            .unwrap()
            .install(|| error(text))
    };
    assert!(
        on(1).message.contains("the mapper gives None"),
        "{:?}",
        on(1)
    );
    assert_eq!(on(1), on(2));
    assert_eq!(on(1), on(3));
}

#[test]
fn nested_mappers_are_traced() {
    let text = grid_then(
        "def inner(e):
  return point_labeled(import_svg('parts.svg'), 'tpi')
def outer(face):
  t = map_to_edges(inner, stripes_partition(stripes_properties(0, 5)))
  return t(face)
def entry():
  return map_to_faces(outer, g)",
    );
    let e = error(&text);
    assert!(e.message.starts_with("`inner` on the edge at ("), "{e:#?}");
    assert!(
        e.message.ends_with("no point `tpi`; did you mean `tip`?"),
        "{e:#?}"
    );
    assert_eq!(
        underlined(&text, &e, 0),
        "point_labeled(import_svg('parts.svg'), 'tpi')"
    );
    let said: Vec<&str> = e.labels.iter().map(|l| l.text.as_str()).collect();
    assert!(
        said.iter()
            .any(|t| t.starts_with("`outer` on the face at (20, 20)")),
        "{said:?}"
    );
    assert!(
        (0..e.labels.len()).any(|i| underlined(&text, &e, i) == "t(face)"),
        "{e:#?}"
    );
}

#[test]
fn wrong_arguments_are_explained() {
    let mapper = |body: &str| {
        message(&format!(
            "def entry():\n  return map_to_faces(lambda f: {body}, g)"
        ))
    };
    assert!(mapper("location(f)").ends_with("`location` takes a vertex, not a face"));
    assert!(
        mapper("centroid(incident_edges(f)[0])").ends_with("`centroid` takes a face, not an edge")
    );
    assert!(mapper("scale('x', 2)").ends_with("`scale` takes curves, not a string"));
    assert!(mapper("scale(contour(f), f)").ends_with("`scale` takes a number, not a face"));
    assert!(
        mapper("scale(contour(f), 1e308 * 10)").ends_with("`scale` takes a finite number, not inf")
    );
    assert!(
        mapper("match_point(contour(f), 1, 2)")
            .ends_with("`match_point` takes a point, not a number")
    );
    assert!(mapper("None").contains("the mapper gives None"));
    assert!(mapper("g").contains("an arrangement (apply it to the cell: `texture(face)`)"));
    assert!(
        mapper("g(incident_edges(f)[0])")
            .ends_with("an arrangement is applied to a face, not to an edge")
    );
    assert!(mapper("g(3)").ends_with("an arrangement is applied to a face, not to a number"));
    assert!(mapper("random(f, 1)").contains("`random` takes (lo, hi) or (cell, lo, hi, n)"));
    assert!(mapper("bbox_center(nothing())").contains("no centre"));
    assert!(mapper("import_svg('no.svg')").ends_with("no drawing `no.svg` in ``"));
    assert!(
        mapper("contour(f, f)").contains("expected 1, got 2"),
        "{}",
        mapper("contour(f, f)")
    );
}

#[test]
fn wrong_constructions_are_explained() {
    let at = |expression: &str| message(&format!("def entry():\n  return {expression}"));
    assert!(
        at("map_to_faces(g, import_svg('square.svg'))").contains("`lambda region: curves` is one")
    );
    assert!(
        at("map_to_faces(1, g)")
            .contains("`map_to_faces` takes a mapper and an arrangement, not a number")
    );
    assert!(at("union(g, 3)").contains("`union` takes arrangements"));
    assert!(
        at("grid_partition(stripes_properties(0, 1), 2, CROP)")
            .contains("stripes_properties(…), not a number")
    );
    assert!(
        at("grid_partition(stripes_properties(0, 1), stripes_properties(1, 1), 'keep')")
            .contains("is no border")
    );
    assert!(at("stripes_properties(0)").contains("1 to 100000 widths, 0 given"));
    assert!(at("stripes_properties(0, 5, 0)").contains("positive widths, not 0"));
    assert!(
        at("set_edge_labels(irregular_properties(1), 'a')").contains("not irregular properties")
    );
    assert!(
        at("set_weighted_edge_labels(irregular_properties(1), 'a')")
            .contains("each followed by its weight")
    );
    assert!(at("irregular_properties(-1)").contains("positive density, not -1"));
    assert!(at("import_svg('square.svg')").contains("`entry` gives curves"));
    assert!(at("None").contains("not an arrangement"));
    let parallel = at("grid_partition(stripes_properties(1, 5), stripes_properties(1, 5), CROP)");
    assert!(
        parallel.starts_with("`grid_partition`: the lines of a grid must cross"),
        "{parallel}"
    );
}

#[test]
fn unknown_names_are_suggested() {
    let e = only(
        compile("def entry():\n  return strips_partition(1)\n")
            .err()
            .unwrap(),
    );
    assert_eq!(e.message, "unknown name `strips_partition`");
    assert_eq!(e.help.as_deref(), Some("did you mean `stripes_partition`?"));
    let text = "def wall():\n  return contour\n";
    let e = only(
        compile(text)
            .unwrap()
            .arrangement("wal", &[], Seed::root(1))
            .err()
            .unwrap(),
    );
    assert_eq!(e.message, "`test.star` defines no `wal`");
    assert_eq!(e.help.as_deref(), Some("did you mean `wall`?"));
    let e = only(
        compile("x = 1\n")
            .unwrap()
            .inline_mapper(Seed::root(1))
            .err()
            .unwrap(),
    );
    assert!(e.message.contains("defines no mapper"));
}

#[test]
fn syntax_errors_have_their_place() {
    let text = "def entry():\n  return (1 +\n";
    let e = only(compile(text).err().unwrap());
    assert!(
        matches!(&e.labels[0].span, Span::Bytes { start, .. } if *start > 12),
        "{e:?}"
    );
    let text = "x = 1\nx += [1][5]\ny = (x).upper().lower()\n";
    assert_eq!(
        underlined(text, &only(compile(text).err().unwrap()), 0),
        "[1][5]"
    );
    let text = "y = [1, 2]\ny += y\nz = (y[1:] + y).index(9)\n";
    let e = only(compile(text).err().unwrap());
    assert_eq!(underlined(text, &e, 0), "(y[1:] + y).index(9)", "{e:?}");
}

#[test]
fn scripts_load_one_another() {
    let lib = (
        "lib/util.star",
        "def tile(f):\n  return match_face(import_svg('here.svg'), f)\n",
    );
    let text =
        "load('lib/util.star', 'tile')\ndef entry():\n  return map_to_faces(tile, contour)\n";
    let made = compile_with(text, &[lib])
        .unwrap()
        .arrangement("entry", &[], Seed::root(1))
        .unwrap();
    assert_eq!(
        made.evaluate(&page(100.0), resolution(100.0))
            .unwrap()
            .len(),
        1
    );
    let circle = [
        ("a.star", "load('b.star', 'x')\n"),
        ("b.star", "load('a.star', 'y')\n"),
    ];
    let e = only(
        compile_with("load('a.star', 'x')\n", &circle)
            .err()
            .unwrap(),
    );
    assert!(e.message.contains("a.star → b.star → a.star"), "{e:?}");
    assert_eq!(e.labels[0].span.file().as_ref(), "b.star");
    let text = "load('no.star', 'x')\nload('nor.star', 'x')\n";
    let errors = compile_with(text, &[]).err().unwrap();
    assert_eq!(errors.len(), 2);
    assert_eq!(underlined(text, &errors[1], 0), "'nor.star'");
    let broken = [("bad.star", "x = 1 / 0\n")];
    let e = only(
        compile_with("load('bad.star', 'x')\n", &broken)
            .err()
            .unwrap(),
    );
    assert_eq!(e.labels[0].span.file().as_ref(), "bad.star");
}

#[test]
fn a_call_with_too_many_arguments_names_the_function() {
    let told = error("def entry():\n  p = point(1, 2, 3)\n  return lambda r: nothing()\n");
    assert_eq!(
        told.message,
        "`point`: wrong number of positional arguments, expected 2, got 3"
    );
    let own = error("def f(a):\n  return a\ndef entry():\n  return f(1, 2)\n");
    assert!(
        own.message.ends_with("in the call of `f`"),
        "{}",
        own.message
    );
}
