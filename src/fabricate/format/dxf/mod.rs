//! DXF, release 2000: circles, and closed and open polylines with arcs in them, on named layers, in
//! millimetres, y up.
//!
//! Written here rather than through a library: such a file needs few kinds of records, while the
//! library brings an image codec and stamps dates and random identifiers into every file.

mod entities;
mod layers;
mod records;
#[cfg(test)]
mod tests;

use super::FileUnit;
use crate::origin::Origin;
use crate::sheet::Sheet;
use crate::sheet::lines::outlines;
use layers::file_layers;
use records::{FIRST_LAYER, Records};

/// The file. The plane is mirrored in the x axis, so that the picture looks as it does in SVG.
/// Areas are written as their outlines. Layers keep the names of the sheet's layers as far as DXF
/// allows, and have the colour of the file's palette that is nearest to that of their lines. Holds
/// no dates and no random identifiers.
pub fn write(sheet: &Sheet, unit: FileUnit, origin: Option<&Origin>) -> Vec<u8> {
    let (layers, numbers) = file_layers(sheet);
    let mut entities = Records {
        text: String::new(),
        next_handle: FIRST_LAYER + layers.len() as u64,
    };
    for (layer, number) in sheet.layers.iter().zip(numbers) {
        for line in layer.items.iter().flat_map(outlines) {
            entities.line(&line, &layers[number].name, sheet.unit_mm);
        }
    }
    let mut file = Records {
        text: String::new(),
        next_handle: FIRST_LAYER,
    };
    if let Some(origin) = origin {
        file.put(&[(999, &origin.line())]);
    }
    file.header(sheet, unit, entities.next_handle);
    file.tables(&layers);
    file.blocks();
    file.section("ENTITIES", |file| file.text += &entities.text);
    file.section("OBJECTS", |file| {
        file.put(&[
            (0, "DICTIONARY"),
            (5, "C"),
            (330, "0"),
            (100, "AcDbDictionary"),
            (281, "1"),
        ]);
        file.put(&[(3, "ACAD_GROUP"), (350, "D")]);
        file.put(&[
            (0, "DICTIONARY"),
            (5, "D"),
            (330, "C"),
            (100, "AcDbDictionary"),
            (281, "1"),
        ]);
    });
    file.put(&[(0, "EOF")]);
    latin(&file.text)
}

/// The text in the code page that the header names, in which the characters up to U+00FF that
/// names can hold are single bytes.
fn latin(text: &str) -> Vec<u8> {
    text.chars()
        .map(|c| u8::try_from(u32::from(c)).unwrap_or(b'_'))
        .collect()
}
