//! The letters of an entry with a `text`, by which its expressions measure others. How text is measured is
//! known to `ruler`.

use super::database::Db;
use super::ruler::OwnLetters;
use super::scope::{Scope, evaluate_tree};
use fretwork_language::scalar::{FilePath, Length, PositiveLength};
use fretwork_language::{Decode, DecodeContext, Decoder, Tree};

/// Those of the `text` of an entry, as far as they can be read; what is wrong is told when the entry is.
pub fn own_letters(db: &dyn Db, body: &Tree, context: &DecodeContext, scope: &Scope) -> OwnLetters {
    let mut own = OwnLetters::default();
    let Some(text) = body.get("text") else {
        return own;
    };
    let in_file_units = DecodeContext {
        spec_units: context.file_units,
        ..context.clone()
    };
    let mut decoder = Decoder::new(&in_file_units);
    let value =
        |name: &str| evaluate_tree(db, text.get(name)?, (&context.file, &context.path), scope).ok();
    if let Some(size) = value("size").and_then(|t| PositiveLength::decode(&t, &mut decoder)) {
        own.size = size.0;
    }
    own.font = value("font")
        .and_then(|t| FilePath::decode(&t, &mut decoder))
        .map(|path| path.0);
    if let Some(by) = value("letter_spacing").and_then(|t| Length::decode(&t, &mut decoder)) {
        own.letter_spacing = by.0;
    }
    own
}
