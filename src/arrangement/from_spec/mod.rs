//! Arrangements as a spec declares them: from a kind's fields and the values that they name to a
//! function of regions.

pub(crate) mod argument;
pub(crate) mod combine;
pub(crate) mod context;
pub(crate) mod lack;
pub(crate) mod named;
pub(crate) mod partition;
pub(crate) mod script;
pub(crate) mod seam;
pub(crate) mod tiling;
pub(crate) mod units;
pub(crate) mod unknown;

use fretwork_language::kinds::arrangements as kinds;

pub use context::{Context, Declared, Inputs};
pub use lack::{nothing_drawn, without_value};
pub use named::Named;
pub use partition::partition;
pub use script::check;
pub use seam::{is_torn, torn, torn_faces};
pub use unknown::{unknown_label, unknown_labels};

/// The arrangement that `kind` declares.
///
/// # Errors
/// When what it names does not fit.
pub fn arrangement(kind: &kinds::Arrangement, context: &Context<'_>) -> Declared {
    Ok(open(kind, context)?.changed(tiling::closed))
}

/// What `kind` declares, as it comes out of the cells that a region shows.
fn open(kind: &kinds::Arrangement, context: &Context<'_>) -> Declared {
    use kinds::Arrangement as Kind;
    match kind {
        Kind::Map(map) | Kind::Vary(map) => {
            units::in_own_units(context, |context| script::map(map, kind.kind(), context))
        }
        Kind::Script(kind) => units::in_own_units(context, |context| script::script(kind, context)),
        Kind::Place(place) => Ok(combine::place(place, context)),
        Kind::Transform(transform) => Ok(combine::transform(transform, context)),
        Kind::Fill(fill) => Ok(combine::fill(fill, context)),
        Kind::Union(of) => Ok(combine::union(of, context)),
        Kind::Relabel(relabel) => Ok(combine::relabel(relabel, context)),
        Kind::Repeat(repeated) => Ok(combine::repeat(repeated, context)),
        Kind::Inside(masked) => Ok(combine::masked(masked, true, context)),
        Kind::Outside(masked) => Ok(combine::masked(masked, false, context)),
        Kind::Connect(_)
        | Kind::Wrap(_)
        | Kind::Projection(_)
        | Kind::Registration(_)
        | Kind::Text(_) => {
            unreachable!("a cutout, or a drawing of a thing, is no function of regions")
        }
    }
}
