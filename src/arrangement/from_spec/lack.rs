//! Faces that stay empty because a field has no value in them.

use crate::cells::face_region;
use crate::from_spec::combine::planar_map;
use crate::from_spec::context::Context;
use crate::function::Arrangement;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Point, Region};
use fretwork_language::kinds::arrangements::Arrangement as Kind;

/// A warning about the faces that an arrangement of this kind leaves empty in `region`: how many, and where the first lies.
pub fn without_value(
    kind: &Kind,
    context: &Context<'_>,
    region: &Region,
    resolution: f64,
) -> Option<Diagnostic> {
    let Kind::Fill(fill) = kind else {
        return None;
    };
    let with = context.inputs.arrangement(&fill.with);
    if !with.may_lack() {
        return None;
    }
    let faces = context.inputs.arrangement(&fill.faces);
    // What is wrong with them has been said where they were applied.
    let lines = faces.apply(region, resolution).ok()?;
    let map = planar_map(&lines, resolution, &context.span).ok()?;
    let covered = faces.covered(&map).into_iter();
    let lacks: Vec<Point> = covered
        .filter_map(|face| with.lack(&face_region(&map, face, region.tile())))
        .collect();
    warning(context, &fill.with.name, &lacks)
}

/// A warning about a partition that is drawn on a region as a whole, where one of its fields has no value.
pub fn nothing_drawn(
    made: &Arrangement,
    name: &str,
    context: &Context<'_>,
    region: &Region,
) -> Option<Diagnostic> {
    let lack = made.lack(region)?;
    warning(context, name, &[lack])
}

fn warning(context: &Context<'_>, name: &str, lacks: &[Point]) -> Option<Diagnostic> {
    let first = lacks.first()?;
    let place = format!("({:.3}, {:.3})", first.x, first.y);
    let message = match lacks.len() {
        1 => format!("a field of `{name}` has no value at {place}: the face there stays empty"),
        n => format!(
            "a field of `{name}` has no value in {n} faces, which stay empty; the first is around {place}"
        ),
    };
    let warning = Diagnostic::warning(message).at(context.span.clone(), "here");
    Some(warning.help(
        "`otherwise:` gives a field a value where it has none, as an `expression` has where it divides by zero or takes the root of what is negative",
    ))
}
