//! The description of a scene, and the bytes that it names.
//!
//! The crate `gltf` reads these too and is the oracle of the tests. It is not used here because it
//! refuses files that are in use (positions without `min` and `max`, chunks of GLB after one
//! that is not padded), hides the extensions of nodes behind features, and can be told to skip its checks only
//! at the price of panics on numbers that are out of range.

use std::sync::Arc;

use serde_json::Value as Json;

use super::super::limit::Sibling;
use fretwork_geometry::budget;

const MAGIC: u32 = 0x4654_6C67;
const JSON: u32 = 0x4E4F_534A;
const BINARY: u32 = 0x004E_4942;

/// A file and its buffers.
pub struct Document {
    /// The description.
    pub root: Json,
    buffers: Vec<Arc<[u8]>>,
}

/// Bytes for an item of a list or an object of JSON.
const ITEM: usize = 100;

impl Document {
    /// Reads a GLB, or the text of a glTF.
    pub fn read(bytes: &[u8], sibling: Sibling<'_>) -> Result<Document, String> {
        let is_binary = bytes.len() >= 4 && bytes[..4] == MAGIC.to_le_bytes();
        let (text, binary) = if is_binary {
            chunks(bytes)?
        } else {
            (bytes, None)
        };
        let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
        let padding = text.iter().rev().take_while(|b| **b == 0).count();
        let text = &text[..text.len() - padding];
        let is_item = |byte: &&u8| matches!(**byte, b',' | b'[' | b'{');
        let items = text.iter().filter(is_item).count();
        budget::make("items of JSON", items, ITEM);
        let root: Json =
            serde_json::from_slice(text).map_err(|e| format!("its JSON is broken: {e}"))?;
        match root["asset"]["version"].as_str() {
            Some(version) if version.starts_with("2.") => {}
            Some(version) => {
                return Err(format!("it is glTF {version}, and only 2.0 is supported"));
            }
            None => return Err("it is no glTF file: it has no `asset.version`".into()),
        }
        let mut document = Document {
            root,
            buffers: Vec::new(),
        };
        let buffers = document.root["buffers"]
            .as_array()
            .cloned()
            .unwrap_or_default();
        for (number, buffer) in buffers.iter().enumerate() {
            let bytes: Arc<[u8]> = match (buffer["uri"].as_str(), binary) {
                (Some(uri), _) => content(uri, sibling)?,
                (None, Some(binary)) if number == 0 => binary.into(),
                (None, _) => return Err(format!("buffer {number} has no bytes")),
            };
            let length = buffer["byteLength"].as_u64().unwrap_or(0);
            if length > bytes.len() as u64 {
                return Err(format!(
                    "it is cut off: buffer {number} claims {length} bytes and has {}",
                    bytes.len()
                ));
            }
            document.buffers.push(bytes);
        }
        Ok(document)
    }

    /// The item `number` of the list `name`.
    pub fn item(&self, name: &str, number: &Json) -> Result<&Json, String> {
        let index = number.as_u64().and_then(|n| usize::try_from(n).ok());
        let found = index.and_then(|index| self.root[name].as_array()?.get(index));
        found.ok_or_else(|| format!("`{name}` has no item {number}"))
    }

    /// How many bytes all buffers have.
    pub fn size(&self) -> usize {
        self.buffers.iter().map(|buffer| buffer.len()).sum()
    }

    /// The bytes of a buffer view, and the step between its items where it says one.
    pub fn view(&self, number: &Json) -> Result<(&[u8], Option<usize>), String> {
        let view = self.item("bufferViews", number)?;
        let size = |name: &str| view[name].as_u64().and_then(|v| usize::try_from(v).ok());
        let buffer = size("buffer").and_then(|number| self.buffers.get(number));
        let (start, length) = (size("byteOffset").unwrap_or(0), size("byteLength"));
        let end = length.and_then(|length| start.checked_add(length));
        let bytes = buffer
            .zip(end)
            .and_then(|(buffer, end)| buffer.get(start..end));
        Ok((
            bytes.ok_or_else(|| format!("buffer view {number} lies outside its buffer"))?,
            size("byteStride"),
        ))
    }
}

/// The two chunks of a GLB.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), String> {
    let word = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
    let length = word(8).ok_or("it is cut off")? as usize;
    if length > bytes.len() {
        return Err(format!(
            "it is cut off: it claims {length} bytes and has {}",
            bytes.len()
        ));
    }
    let (mut at, mut text, mut binary) = (12, None, None);
    while let (Some(size), Some(kind)) = (word(at), word(at + 4)) {
        let end = (at + 8).checked_add(size as usize);
        let chunk = end
            .and_then(|end| bytes.get(at + 8..end))
            .ok_or("it is cut off inside a chunk")?;
        match kind {
            JSON if text.is_none() => text = Some(chunk),
            BINARY if binary.is_none() => binary = Some(chunk),
            _ => {}
        }
        let end = at + 8 + chunk.len();
        // Chunks are padded to whole words; some programs forget that, or leave it out of the length.
        at = match word(end + 4) {
            Some(JSON | BINARY) => end,
            _ => end.next_multiple_of(4),
        };
    }
    Ok((text.ok_or("it has no JSON chunk")?, binary))
}

/// The bytes that a URI stands for: those in it, or those of a file.
pub fn content(uri: &str, sibling: Sibling<'_>) -> Result<Arc<[u8]>, String> {
    let Some(data) = uri.strip_prefix("data:") else {
        return sibling(&unescaped(uri)?);
    };
    let (head, text) = data.split_once(',').ok_or("a data URI has no comma")?;
    if !head.ends_with(";base64") {
        return Err("a data URI is not in base 64".into());
    }
    decoded(text.as_bytes())
        .map(Arc::from)
        .ok_or_else(|| "a data URI is broken".into())
}

/// A path without `%20` and the like.
fn unescaped(uri: &str) -> Result<String, String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [first, tail @ ..] = rest {
        rest = tail;
        if *first != b'%' {
            bytes.push(*first);
            continue;
        }
        let code = tail.get(..2).and_then(|hex| std::str::from_utf8(hex).ok());
        let byte = code.and_then(|hex| u8::from_str_radix(hex, 16).ok());
        bytes.push(byte.ok_or_else(|| format!("`{uri}` is no path"))?);
        rest = &tail[2..];
    }
    String::from_utf8(bytes).map_err(|_| format!("`{uri}` is no path"))
}

/// Base 64 (RFC 4648, section 4).
fn decoded(text: &[u8]) -> Option<Vec<u8>> {
    let value = |c: u8| match c {
        b'A'..=b'Z' => Some(c - b'A'),
        b'a'..=b'z' => Some(c - b'a' + 26),
        b'0'..=b'9' => Some(c - b'0' + 52),
        b'+' => Some(62),
        b'/' => Some(63),
        _ => None,
    };
    let text = text
        .strip_suffix(b"==")
        .or(text.strip_suffix(b"="))
        .unwrap_or(text);
    let mut out = Vec::with_capacity(text.len() / 4 * 3);
    for group in text.chunks(4) {
        let mut bits = 0u32;
        for c in group {
            bits = bits << 6 | u32::from(value(*c)?);
        }
        bits <<= 6 * (4 - group.len());
        let bytes = bits.to_be_bytes();
        match group.len() {
            4 => out.extend(&bytes[1..4]),
            3 => out.extend(&bytes[1..3]),
            2 => out.extend(&bytes[1..2]),
            _ => return None,
        }
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uris_are_decoded() {
        assert_eq!(decoded(b"aGVsbG8=").as_deref(), Some(&b"hello"[..]));
        assert_eq!(decoded(b"aGVsbG8h").as_deref(), Some(&b"hello!"[..]));
        assert_eq!(decoded(b"aGVsbA==").as_deref(), Some(&b"hell"[..]));
        assert_eq!((decoded(b"a"), decoded(b"a*bc")), (None, None));
        assert_eq!(unescaped("a%20b/%C3%A9.bin").as_deref(), Ok("a b/é.bin"));
        assert!(unescaped("100%").is_err());
    }
}
