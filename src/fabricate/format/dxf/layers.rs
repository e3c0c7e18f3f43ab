//! The layers of a DXF file: which they are, and names that DXF allows.

use std::collections::{BTreeMap, BTreeSet};

use crate::format::dxf_color;
use crate::sheet::{Role, Sheet};

/// A layer of the file.
pub struct FileLayer {
    /// Distinct from all others, whatever their case.
    pub name: String,
    /// The colour of the file's palette.
    pub color: u8,
}

/// The layers of the file, and which of them each layer of the sheet is: the same for layers of one
/// name, role and colour, which stand more than once where they take turns. Names are such as DXF
/// allows, and distinct whatever their case.
pub fn file_layers(sheet: &Sheet) -> (Vec<FileLayer>, Vec<usize>) {
    let mut taken = BTreeSet::from(["0".to_string()]);
    let mut known: BTreeMap<(&str, Role, u8), usize> = BTreeMap::new();
    let mut layers = Vec::new();
    let mut numbers = Vec::new();
    for layer in &sheet.layers {
        let color = dxf_color::of(layer).0;
        let next = layers.len();
        let number = *known
            .entry((&layer.name, layer.role, color))
            .or_insert(next);
        numbers.push(number);
        if number == next {
            let name = unique_name(&layer.name, layer.role, &mut taken);
            layers.push(FileLayer { name, color });
        }
    }
    (layers, numbers)
}

fn unique_name(name: &str, role: Role, taken: &mut BTreeSet<String>) -> String {
    let forbidden = |c: char| c.is_control() || c > '\u{ff}' || "<>/\\\":;?*|=`,".contains(c);
    let plain = name.trim().chars();
    let plain = plain.map(|c| if forbidden(c) { '_' } else { c }).take(200);
    let mut plain: String = plain.collect();
    if plain.is_empty() {
        plain = "layer".to_string();
    }
    // One name for two things that are done: the second is told apart by what is done.
    let word = match role {
        Role::Cut => "cut",
        Role::Engrave => "engrave",
        Role::Draw => "draw",
    };
    let told_apart = [plain.clone(), format!("{plain} {word}")];
    let numbered = (2..).map(|count| format!("{plain}-{count}"));
    told_apart
        .into_iter()
        .chain(numbered)
        .find(|name| taken.insert(name.to_lowercase()))
        .unwrap_or(plain)
}
