//! What a node is given to be made from: its inputs, its seed, its place; and what is common to
//! everything that a spec declares.

use std::sync::Arc;

use crate::border::Border;
use crate::error::ArrangementError;
use crate::from_spec::named::Named;
use crate::function::Arrangement;
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::{Curves, Field, LabelSet, Region, Seed};
use fretwork_language::kinds::partitions as spec;
use fretwork_language::scalar::{FilePath, Label};
use fretwork_language::{Ref, TypeSet, wants};
use fretwork_script::Host;

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
    /// A field of numbers for each square of the spec's unit.
    fn densities(&self, name: &Ref<wants::Field>) -> Field;
}

/// What a node is besides its fields.
pub struct Context<'a> {
    /// What it names.
    pub inputs: &'a dyn Inputs,
    /// The key of its random values.
    pub seed: Seed,
    /// The place of its name.
    pub span: Span,
    /// What positions are rounded to where they are hashed, if it does not depend on the region: in maps.
    pub step: Option<f64>,
    /// How long the unit is that scripts are written in: that of the node's file.
    pub unit: f64,
}

/// An arrangement, or what is wrong with it.
pub type Declared = Result<Arrangement, Vec<Diagnostic>>;

/// The border as the operators take it.
pub(crate) fn border(border: spec::Border) -> Border {
    match border {
        spec::Border::Crop => Border::Crop,
        spec::Border::CropAddBoundary => Border::CropAddBoundary,
        spec::Border::KeepInside => Border::KeepInside,
        spec::Border::KeepOutside => Border::KeepOutside,
    }
}

pub(crate) fn label_set(labels: &[Label]) -> LabelSet {
    LabelSet::of(labels.iter().map(|label| &*label.0))
}

/// An error of an operator at the entry that declares it.
pub(crate) fn failed(error: &ArrangementError, span: &Span) -> Vec<Diagnostic> {
    vec![Diagnostic::error(error.to_string()).at(span.clone(), "in this arrangement")]
}
