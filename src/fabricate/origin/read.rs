//! The origin of a file read again, also after another program has written it anew. The format is told by the bytes.

use std::io::Read as _;

use flate2::read::DeflateDecoder;
use rawzip::{CompressionMethod, ZipArchive};
use roxmltree::{Document, ParsingOptions};
use serde_json::Value as Json;

use super::{NAMESPACE, Origin, STL_HEAD};
use crate::picture::chunk;

/// No model of a package is read beyond this: a small file may unpack to any size.
const LARGEST: u64 = 1 << 30;

/// The origin that the file with these bytes says; none where it says none, or is of no known format.
pub fn read(bytes: &[u8]) -> Option<Origin> {
    let begins = |with: &[u8]| bytes.starts_with(with);
    let first = bytes.iter().find(|b| !b.is_ascii_whitespace());
    if begins(b"\x89PNG") {
        of_png(bytes)
    } else if begins(b"glTF") {
        of_glb(bytes)
    } else if begins(b"PK") {
        of_package(bytes)
    } else if begins(b"fretwork ") {
        let head = bytes.get(..STL_HEAD)?;
        Origin::of_line(&text_of(head))
    } else if begins(b"\xef\xbb\xbf") || first == Some(&b'<') {
        of_svg(std::str::from_utf8(bytes).ok()?)
    } else if first == Some(&b'{') {
        let json: Json = serde_json::from_slice(bytes).ok()?;
        Origin::of_json(json.get("origin")?)
    } else {
        of_dxf(bytes)
    }
}

fn text_of(latin: &[u8]) -> String {
    latin.iter().copied().map(char::from).collect()
}

fn of_png(bytes: &[u8]) -> Option<Origin> {
    chunk::all(bytes).find_map(|(kind, data)| {
        let text = data.strip_prefix(chunk::ORIGIN.as_bytes())?;
        let text = text.strip_prefix(b"\0")?;
        (kind == b"tEXt").then(|| Origin::of_line(&text_of(text)))?
    })
}

fn of_glb(bytes: &[u8]) -> Option<Origin> {
    let length = u32::from_le_bytes(bytes.get(12..16)?.try_into().ok()?) as usize;
    let json: Json = serde_json::from_slice(bytes.get(20..20usize.checked_add(length)?)?).ok()?;
    Origin::of_json(json.pointer("/asset/extras/origin")?)
}

fn of_svg(text: &str) -> Option<Origin> {
    // Editors declare their names as entities.
    let options = ParsingOptions {
        allow_dtd: true,
        ..ParsingOptions::default()
    };
    let tree = Document::parse_with_options(text.trim_start_matches('\u{feff}'), options).ok()?;
    let origin = tree
        .descendants()
        .find(|node| node.has_tag_name((NAMESPACE, "origin")))?;
    let attribute = |name: &str| Some(origin.attribute(name)?.to_string());
    Origin {
        spec: attribute("spec")?,
        artifact: attribute("artifact")?,
        recipe: attribute("recipe")?,
    }
    .checked()
}

/// The origin of a 3MF package: metadata of the first model that has some.
fn of_package(bytes: &[u8]) -> Option<Origin> {
    let archive = ZipArchive::from_slice(bytes).ok()?;
    let mut entries = archive.entries();
    while let Some(entry) = entries.next_entry().ok()? {
        if !entry.file_path().as_ref().ends_with(b".model") {
            continue;
        }
        let method = entry.compression_method();
        let data = archive.get_entry(entry.wayfinder()).ok()?;
        let mut model = Vec::new();
        let read = match method {
            CompressionMethod::STORE => data.data().take(LARGEST).read_to_end(&mut model),
            CompressionMethod::DEFLATE => DeflateDecoder::new(data.data())
                .take(LARGEST)
                .read_to_end(&mut model),
            _ => continue,
        };
        let found = read.ok().and_then(|_| of_model(&model));
        if found.is_some() {
            return found;
        }
    }
    None
}

/// The origin among the metadata, which stand before all else in a model.
fn of_model(model: &[u8]) -> Option<Origin> {
    let end = find(model, b"<resources")?;
    let text = format!("{}</model>", std::str::from_utf8(&model[..end]).ok()?);
    let tree = Document::parse(&text).ok()?;
    let is_origin = |name: &str| {
        name.split_once(':').is_some_and(|(prefix, name)| {
            let space = tree.root_element().lookup_namespace_uri(Some(prefix));
            name == "origin" && space == Some(NAMESPACE)
        })
    };
    let metadata = tree
        .descendants()
        .find(|node| node.attribute("name").is_some_and(is_origin))?;
    Origin::of_line(metadata.text()?.trim())
}

fn find(text: &[u8], part: &[u8]) -> Option<usize> {
    text.windows(part.len()).position(|window| window == part)
}

/// The first comment of a DXF file that says an origin.
fn of_dxf(bytes: &[u8]) -> Option<Origin> {
    let mut lines = bytes.split(|b| *b == b'\n');
    while let (Some(code), Some(value)) = (lines.next(), lines.next()) {
        if code.trim_ascii() == b"999"
            && let Some(origin) = Origin::of_line(&text_of(value.trim_ascii()))
        {
            return Some(origin);
        }
    }
    None
}
