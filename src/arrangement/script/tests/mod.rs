//! Scripts in memory, and what the tests beside this file ask of them.

mod attacks;
mod diagnostics;
mod operators;
mod purity;
mod reference;
mod tiles;

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::script::argument::Argument;
use crate::script::program::Script;
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::planar_map::{PlanarMap, resolution};
use fretwork_geometry::{CurveLabels, Curves, LabelSet, Point, Region, Seed};
use fretwork_script::Host;

/// Elements `segment`, `square` and `parts`, and the scripts that a test adds.
#[derive(Default)]
pub(crate) struct Memory {
    scripts: BTreeMap<String, String>,
}

impl Host for Memory {
    fn curves(&self, path: &str, from: &str, _: Option<f64>) -> Result<Arc<Curves>, String> {
        let folder = from.rsplit_once('/').map_or("", |(folder, _)| folder);
        match path {
            "segment.svg" => Ok(Arc::new(segment())),
            "square.svg" => Ok(Arc::new(square())),
            "parts.svg" => Ok(Arc::new(parts())),
            "here.svg" if folder == "lib" => Ok(Arc::new(square())),
            _ => Err(format!("no drawing `{path}` in `{folder}`")),
        }
    }

    fn script(&self, path: &str, _: &str) -> Result<(Arc<str>, Arc<str>), String> {
        let text = self
            .scripts
            .get(path)
            .ok_or_else(|| format!("no script `{path}`"))?;
        Ok((path.into(), text.as_str().into()))
    }
}

fn segment() -> Curves {
    let mut curves = Curves::new();
    curves.push(
        [Point::ORIGIN, Point::new(100.0, 0.0)],
        CurveLabels::default(),
    );
    curves.name_point("start", Point::ORIGIN);
    curves.name_point("end", Point::new(100.0, 0.0));
    curves
}

fn square() -> Curves {
    let mut curves = Curves::new();
    let corners = [
        [0.0, 0.0],
        [10.0, 0.0],
        [10.0, 10.0],
        [0.0, 10.0],
        [0.0, 0.0],
    ]
    .map(Point::from);
    curves.push(
        corners,
        CurveLabels {
            left: LabelSet::one("tile"),
            ..CurveLabels::default()
        },
    );
    curves
}

fn parts() -> Curves {
    let mut curves = Curves::new();
    curves.push(
        [Point::ORIGIN, Point::new(3.0, 0.0)],
        CurveLabels::edge(LabelSet::one("stem")),
    );
    curves.push(
        [Point::new(3.0, 0.0), Point::new(4.0, 2.0)],
        CurveLabels::edge(LabelSet::one("leaf")),
    );
    curves.name_point("tip", Point::new(4.0, 2.0));
    curves
}

pub(crate) fn compile(text: &str) -> Result<Script, Vec<Diagnostic>> {
    compile_with(text, &[])
}

pub(crate) fn compile_with(
    text: &str,
    scripts: &[(&str, &str)],
) -> Result<Script, Vec<Diagnostic>> {
    let scripts = scripts
        .iter()
        .map(|(name, text)| (name.to_string(), text.to_string()))
        .collect();
    Script::compile(&Arc::from("test.star"), text, Arc::new(Memory { scripts }))
}

/// A square with its lower-left corner at the origin.
pub(crate) fn page(side: f64) -> Region {
    Region::rectangle(Point::ORIGIN, Point::new(side, side))
}

/// What `entry()` of a script gives on a square of side 100.
pub(crate) fn run(text: &str) -> Result<Arc<Curves>, Vec<Diagnostic>> {
    run_on(text, &page(100.0), &[], 1)
}

pub(crate) fn run_on(
    text: &str,
    region: &Region,
    args: &[(Arc<str>, Argument)],
    seed: u64,
) -> Result<Arc<Curves>, Vec<Diagnostic>> {
    let made = compile(text)?.arrangement("entry", args, Seed::root(seed))?;
    made.evaluate(region, resolution(region.bounds().longer_side()))
}

/// The curves of a script that must succeed.
pub(crate) fn curves(text: &str) -> Arc<Curves> {
    run(text).unwrap_or_else(|e| panic!("{text}\n{e:#?}"))
}

/// The planar map of the curves of a script that must succeed.
pub(crate) fn map(text: &str) -> PlanarMap {
    PlanarMap::build(&curves(text), resolution(100.0)).unwrap()
}

/// Vertices, edges, bounded faces, components.
pub(crate) fn counts(text: &str) -> [usize; 4] {
    let map = map(text);
    [
        map.vertex_count(),
        map.edge_count(),
        map.face_count(),
        map.component_count(),
    ]
}

/// The only diagnostic of a script that must fail.
pub(crate) fn error(text: &str) -> Diagnostic {
    only(
        run(text)
            .err()
            .unwrap_or_else(|| panic!("this must fail:\n{text}")),
    )
}

pub(crate) fn only(mut errors: Vec<Diagnostic>) -> Diagnostic {
    assert_eq!(errors.len(), 1, "{errors:?}");
    errors.remove(0)
}

/// The text that a label of a diagnostic underlines.
pub(crate) fn underlined<'a>(text: &'a str, error: &Diagnostic, label: usize) -> &'a str {
    match &error.labels[label].span {
        Span::Bytes { start, end, .. } => &text[*start..*end],
        other => panic!("{other:?} is no place in a script"),
    }
}

/// A grid of 5 by 5 whole cells of side 20 around the square of side 100, and a text after it.
pub(crate) fn grid_then(rest: &str) -> String {
    let grid = "g = grid_partition(stripes_properties(0, 20), stripes_properties(pi / 2, 20), KEEP_INSIDE)";
    format!("{grid}\n{rest}\n")
}
