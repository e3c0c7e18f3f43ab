//! glTF 2.0 and GLB: the triangles of the default scene with their colours and pictures, from y up to z up. Skins,
//! animations, cameras, lights, normals and all extensions are not read.

mod accessor;
mod document;
mod material;
mod scene;

use serde_json::Value as Json;

use self::document::Document;
use super::mesh::Sibling;
use fretwork_geometry::Model;

/// The parts of a file, in metres, z up: one for each primitive of each node. `sibling` reads files that it names. Memory is
/// proportional to the files.
///
/// # Errors
/// A message when a file is broken, cut off, or needs an extension.
pub fn read(bytes: &[u8], sibling: Sibling<'_>) -> Result<Model, String> {
    let document = Document::read(bytes, sibling)?;
    if let Some(extension) = document.root["extensionsRequired"]
        .as_array()
        .and_then(|list| list.first())
    {
        return Err(format!(
            "it needs the extension {extension}, which is not supported"
        ));
    }
    scene::Reader::new(&document).model(sibling)
}

/// The item `number` of the list `name`.
fn item<'a>(document: &'a Document, name: &str, number: &Json) -> Result<&'a Json, String> {
    let index = number.as_u64().and_then(|n| usize::try_from(n).ok());
    let found = index.and_then(|index| document.root[name].as_array()?.get(index));
    found.ok_or_else(|| format!("`{name}` has no item {number}"))
}

#[cfg(test)]
mod tests;
