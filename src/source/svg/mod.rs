//! SVG drawings to [`Drawing`]s: every shape that is visible, flattened, in spec units.
//!
//! ```text
//! document   text → XML tree, refused early when it is broken or a bomb
//! sheet      <style> elements → rules;  style: what an element's attributes and rules say
//! length, transform, viewport: the values of attributes → numbers and maps
//! path, shape  one element → polylines through a pen
//! walk       the tree in paint order: groups, use, switch, nested svg, markers
//! ```
//!
//! Text, images, dashes, patterns, clips, masks, filters and animations are not read, and are told where
//! something visible is lost or shown by it. The plane is SVG's own, unflipped: the origin of user
//! space stays the origin, and a drawing with a physical size is scaled to it.

mod document;
mod guard;
mod length;
mod options;
mod path;
mod pen;
mod report;
mod select;
mod shape;
mod sheet;
mod style;
#[cfg(test)]
mod tests;
mod transform;
mod viewport;
mod walk;

use std::sync::Arc;

use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::Drawing;

pub use options::SvgOptions;

/// The whole drawing in `text`, and warnings about what was not read. `file` is its name in
/// diagnostics.
///
/// Errors, several at once: broken XML, a root that is not `svg`, bad path data, transforms or
/// numbers, coordinates beyond 10^12, circular or exploding `use`, nothing visible.
pub fn read(
    text: &str,
    file: &Arc<str>,
    options: &SvgOptions,
) -> Result<(Drawing, Vec<Diagnostic>), Vec<Diagnostic>> {
    select(text, file, options, None)
}

/// As [`read`], but of the element or group alone whose `id`, else `data-label`, else
/// `inkscape:label` is `id`, in the place where the whole drawing has it. It may stand in `defs`.
pub fn select(
    text: &str,
    file: &Arc<str>,
    options: &SvgOptions,
    id: Option<&str>,
) -> Result<(Drawing, Vec<Diagnostic>), Vec<Diagnostic>> {
    let document = document::parse(text, file).map_err(|d| vec![d])?;
    walk::drawing(&document, file, options, id)
}

/// The text in the `bytes` of a file: UTF-8, with or without a byte order mark. The error says how
/// to save the drawing instead.
pub fn decode<'a>(bytes: &'a [u8], file: &Arc<str>) -> Result<&'a str, Diagnostic> {
    document::decode(bytes, file)
}
