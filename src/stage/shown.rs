//! What an artifact shows: its values as one model, and its page. How a file is made of them is not known here.

use super::model::{Form, Thickness, give_look, model};
use fretwork_action::Action;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Bounds, Model};
use fretwork_language::kinds::artifacts::{Artifact, Content};
use fretwork_primitive::placement::space_maps;

/// The box of the region that an artifact shows, if it names one.
pub fn page_bounds(action: &Action, kind: &Artifact) -> Option<Bounds> {
    let region = kind.region.as_ref()?;
    Some(action.input(region).bounds())
}

/// All that an artifact shows in space, in its places, and warnings about it.
///
/// # Errors
/// When one of its values has no volume.
pub fn shown_model(
    action: &Action,
    kind: &Artifact,
    form: Form,
) -> Result<(Model, Vec<Diagnostic>), Vec<Diagnostic>> {
    let thickness = Thickness::new(kind.thickness, kind.side);
    let mut warnings = Vec::new();
    let parts = match &kind.content {
        Content::From(from) => {
            let whole = model(action, from, form, thickness, &mut warnings)?;
            return Ok((whole, warnings));
        }
        Content::Parts(parts) => parts,
    };
    let mut all = Model::default();
    for part in parts.iter() {
        let thickness = Thickness::new(part.thickness, part.side).or(thickness);
        let mut one = model(action, &part.from, form, thickness, &mut warnings)?;
        give_look(&mut one, &part.look);
        space_maps(&part.placement)
            .iter()
            .for_each(|map| all.append(&one, map));
    }
    Ok((all, warnings))
}
