//! Arrangements as a spec declares them: from a kind's fields and the values that they name to a
//! function of regions.

mod combine;
mod partition;
mod script;
mod unknown;

use std::sync::Arc;

use super::{Arrangement, ArrangementError, Border, mask, tiling};
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::{Curves, Field, LabelSet, Region, Seed};
use fretwork_language::kinds::arrangements as kinds;
use fretwork_language::kinds::partitions as spec;
use fretwork_language::scalar::{FilePath, Label};
use fretwork_language::{Ref, TypeSet, wants};
use fretwork_script::Host;

pub use partition::partition;
pub use script::{Named, check};
pub use unknown::unknown_labels;

/// What a node gets from the nodes that it names.
pub trait Inputs {
    /// An arrangement, or a region in its place.
    fn arrangement(&self, name: &Ref<wants::Arrangement>) -> Arrangement;
    /// A drawn exemplar as an element.
    fn element(&self, name: &Ref<wants::VectorExemplar>) -> Arc<Curves>;
    /// A region.
    fn region(&self, name: &Ref<wants::Region>) -> Arc<Region>;
    /// What `text` names, if it names something that a script can be handed.
    fn argument(&self, text: &Arc<str>, wants: TypeSet) -> Option<Named>;
    /// The name and the text of a script.
    ///
    /// # Errors
    /// When it cannot be read.
    fn script(&self, file: &FilePath) -> Result<(Arc<str>, Arc<str>), Vec<Diagnostic>>;
    /// What scripts ask for the files that they name.
    fn host(&self) -> Arc<dyn Host>;
    /// A field of plain numbers.
    fn field(&self, name: &Ref<wants::Field>) -> Field;
    /// A field of angles, in radians.
    ///
    /// # Errors
    /// When the field does not say what its numbers mean.
    fn angles(&self, name: &Ref<wants::Field>) -> Result<Field, Diagnostic>;
    /// A field of lengths, in the spec's units.
    ///
    /// # Errors
    /// When the field's numbers are angles.
    fn lengths(&self, name: &Ref<wants::Field>) -> Result<Field, Diagnostic>;
}

/// What a node is besides its fields.
pub struct Context<'a> {
    /// What it names.
    pub inputs: &'a dyn Inputs,
    /// The key of its random values.
    pub seed: Seed,
    /// The place of its name.
    pub span: Span,
}

/// An arrangement, or what is wrong with it.
pub type Declared = Result<Arrangement, Vec<Diagnostic>>;

/// The arrangement that `kind` declares.
///
/// # Errors
/// When what it names does not fit.
pub fn arrangement(kind: &kinds::Arrangement, context: &Context<'_>) -> Declared {
    let made = open(kind, context)?;
    Ok(Arrangement::new(move |region, resolution| {
        Ok(tiling::closed(made.apply(region, resolution)?, region))
    }))
}

/// What `kind` declares, as it comes out of the cells that a region shows.
fn open(kind: &kinds::Arrangement, context: &Context<'_>) -> Declared {
    use kinds::Arrangement as Kind;
    match kind {
        Kind::Map(map) | Kind::Vary(map) => script::map(map, kind.kind(), context),
        Kind::Script(kind) => script::script(kind, context),
        Kind::Place(place) => Ok(combine::place(place, context)),
        Kind::Transform(transform) => Ok(combine::transform(transform, context)),
        Kind::Fill(fill) => Ok(combine::fill(fill, context)),
        Kind::Union(of) => Ok(combine::union(of, context)),
        Kind::Inside(masked) => Ok(combine::masked(masked, mask::inside, context)),
        Kind::Outside(masked) => Ok(combine::masked(masked, mask::outside, context)),
        Kind::Connect(_) => unreachable!("a cutout is no arrangement"),
    }
}

/// The border as the operators take it.
fn border(border: spec::Border) -> Border {
    match border {
        spec::Border::Crop => Border::Crop,
        spec::Border::CropAddBoundary => Border::CropAddBoundary,
        spec::Border::KeepInside => Border::KeepInside,
        spec::Border::KeepOutside => Border::KeepOutside,
    }
}

fn label_set(labels: &[Label]) -> LabelSet {
    LabelSet::of(labels.iter().map(|label| &*label.0))
}

/// An error of an operator at the entry that declares it.
fn failed(error: &ArrangementError, span: &Span) -> Vec<Diagnostic> {
    vec![Diagnostic::error(error.to_string()).at(span.clone(), "in this arrangement")]
}
