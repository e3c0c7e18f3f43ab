//! Bytes as chains of operators in a script: evaluating one must end with curves or an error, and the
//! planar map of the curves must be consistent.
//!
//! `RUSTC_BOOTSTRAP=1 cargo fuzz run -s none --fuzz-dir tests/fuzz operators`
#![no_main]

use std::sync::Arc;

use fretwork::arrangement::Script;
use fretwork::geometry::planar_map::{PlanarMap, resolution};
use fretwork::geometry::{CurveLabels, Curves, Point, Region, Seed};
use fretwork::script::Host;
use libfuzzer_sys::fuzz_target;

/// Draws one element, whatever it is asked for.
struct OneElement;

impl Host for OneElement {
    fn curves(&self, _: &str, _: &str, _: Option<f64>) -> Result<Arc<Curves>, String> {
        let mut curves = Curves::new();
        let points = [[0.0, 0.0], [3.0, -2.0], [7.0, 2.0], [10.0, 0.0]].map(Point::from);
        curves.push(points, CurveLabels::default());
        Ok(Arc::new(curves))
    }

    fn script(&self, path: &str, _: &str) -> Result<(Arc<str>, Arc<str>), String> {
        Err(format!("there is no `{path}`"))
    }
}

/// Reads bytes as choices; without any left, the first choice is taken.
struct Choices<'a>(std::slice::Iter<'a, u8>);

impl Choices<'_> {
    fn below(&mut self, n: u8) -> u8 {
        self.0.next().map_or(0, |byte| byte % n)
    }

    fn of<'t>(&mut self, texts: &[&'t str]) -> &'t str {
        texts[self.below(texts.len() as u8) as usize]
    }

    fn arrangement(&mut self, depth: u8) -> String {
        let border = self.of(&["CROP", "CROP_ADD_BOUNDARY", "KEEP_INSIDE", "KEEP_OUTSIDE"]);
        let turn = self.below(24);
        match self.below(if depth == 0 { 4 } else { 10 }) {
            0 => format!("stripes_partition(stripes_properties({turn} * pi / 12, 7, 3))"),
            1 => format!("grid_partition(stripes_properties({turn} * pi / 12, 8), stripes_properties(pi / 2, 9), {border})"),
            2 => format!("uniform_partition(irregular_properties(0.02), {border})"),
            3 => format!("random_partition(irregular_properties(0.02), {border})"),
            4 => format!("union({}, {})", self.arrangement(depth - 1), self.arrangement(depth - 1)),
            5 => format!("inside({}, {}, {border})", self.arrangement(depth - 1), self.arrangement(depth - 1)),
            6 => format!("outside({}, {}, {border})", self.arrangement(depth - 1), self.arrangement(depth - 1)),
            7 => format!("map_to_faces(lambda c: {}, {})", self.face(depth), self.arrangement(depth - 1)),
            8 => format!("map_to_edges(lambda c: {}, {})", self.edge(), self.arrangement(depth - 1)),
            _ => format!("map_to_vertices(lambda c: {}, {})", self.vertex(), self.arrangement(depth - 1)),
        }
    }

    fn face(&mut self, depth: u8) -> String {
        let (a, b) = (self.below(20), self.below(20));
        match self.below(6) {
            0 => format!("scale(contour(c), {a} / 10)"),
            1 => format!("rotate(contour(c), {a} * pi / 10)"),
            2 => format!("append(contour(c), translate(contour(c), point({a} - 10, {b} - 10)))"),
            3 => format!("match_face(import_svg('e.svg'), c) if random(c, 0, 1, {b}) < 0.5 else nothing()"),
            4 => format!("match_point(rotate(import_svg('e.svg'), random(c, 0, {a}, 1)), bbox_center(contour(c)), centroid(c))"),
            _ => format!("({})(c)", self.arrangement(depth.min(2) - 1)),
        }
    }

    fn edge(&mut self) -> &'static str {
        self.of(&[
            "to_curve(c)",
            "scale(to_curve(c), 0.5)",
            "to_curve(c) if is_boundary(c) else nothing()",
            "match_points(import_svg('e.svg'), point(0, 0), point(10, 0), location(source_vertex(c)), location(target_vertex(c)))",
            "contour(left_face(c)) if is_bounded_face(left_face(c)) else nothing()",
        ])
    }

    fn vertex(&mut self) -> &'static str {
        self.of(&[
            "match_point(import_svg('e.svg'), point(0, 0), location(c))",
            "append(nothing(), translate(import_svg('e.svg'), location(c)))",
            "to_curve(incident_edges(c)[0])",
        ])
    }
}

fuzz_target!(|bytes: &[u8]| {
    let text = format!("def entry():\n  return {}\n", Choices(bytes.iter()).arrangement(3));
    let Ok(script) = Script::compile(&"any.star".into(), &text, Arc::new(OneElement)) else { return };
    let Ok(arrangement) = script.arrangement("entry", &[], Seed::root(1)) else { return };
    let region = Region::rectangle(Point::ORIGIN, Point::new(50.0, 40.0));
    let resolution = resolution(50.0);
    if let Ok(curves) = arrangement.evaluate(&region, resolution) {
        PlanarMap::build(&curves, resolution).expect("the curves are finite").check().expect(&text);
    }
});
