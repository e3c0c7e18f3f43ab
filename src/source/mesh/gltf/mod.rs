//! glTF 2.0 and GLB: the triangles of the default scene as they stand at rest, with their colours and pictures, from
//! y up to z up.
//!
//! ```text
//! document   bytes → JSON and buffers;  accessor: buffers → vectors
//! extension  what a file needs or uses beyond the core, and whether it is read
//! place      the place of every node
//! pose       morph targets and skins → positions
//! scene      nodes → bodies, parts;  material: colours and pictures
//! ```
//!
//! Animations, lines, points, cameras, lights and normals are not read; the first three are told.

mod accessor;
mod document;
mod extension;
mod material;
mod place;
mod pose;
mod scene;
#[cfg(test)]
mod tests;

use self::document::Document;
use super::limit::Sibling;
use fretwork_geometry::Model;

/// The parts of a file, in metres, z up: one for each primitive of each node, or of each instance of it; and what was not
/// read. `sibling` reads files that it names. Memory is proportional to the files, but for poses and instances, which
/// have limits.
///
/// # Errors
/// A message when a file is broken, cut off, or needs an extension that is not read.
pub fn read(bytes: &[u8], sibling: Sibling<'_>) -> Result<(Model, Vec<String>), String> {
    let document = Document::read(bytes, sibling)?;
    let mut told = extension::check(&document)?;
    let (model, unread) = scene::Reader::new(&document)?.model(sibling)?;
    told.extend(unread);
    if document.root["animations"]
        .as_array()
        .is_some_and(|a| !a.is_empty())
    {
        told.push("its animations are not read: it is posed as at rest".into());
    }
    Ok((model, told))
}
