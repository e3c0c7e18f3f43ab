//! Chunks of PNG files (PNG specification, section 5.3): what a picture says of itself beside its pixels.

use crate::origin::{Origin, latin};

/// The bytes of the signature, and of the signature with the head, after which other chunks may begin.
const SIGNATURE: usize = 8;
const HEAD: usize = SIGNATURE + 25;
/// The keyword of the text that names an origin.
pub const ORIGIN: &str = "Origin";

/// The picture with one more chunk after its head.
pub fn with_chunk(png: &[u8], kind: [u8; 4], data: &[u8]) -> Vec<u8> {
    let mut sum = flate2::Crc::new();
    sum.update(&kind);
    sum.update(data);
    let (head, rest) = png.split_at(HEAD.min(png.len()));
    let length = (data.len() as u32).to_be_bytes();
    let sum = sum.sum().to_be_bytes();
    [head, &length, &kind, data, &sum, rest].concat()
}

/// The picture that names its origin, in a text in Latin-1 (section 11.3.3.2).
pub fn with_origin(png: &[u8], origin: &Origin) -> Vec<u8> {
    let text = latin(&origin.line());
    with_chunk(png, *b"tEXt", &[ORIGIN.as_bytes(), b"\0", &text].concat())
}

/// The kinds and the data of all chunks that are whole.
pub fn all(png: &[u8]) -> impl Iterator<Item = (&[u8], &[u8])> {
    let mut rest = png.get(SIGNATURE..).unwrap_or_default();
    std::iter::from_fn(move || {
        let length = u32::from_be_bytes(rest.get(..4)?.try_into().ok()?) as usize;
        let end = length.checked_add(8)?;
        let (kind, data) = (rest.get(4..8)?, rest.get(8..end)?);
        rest = rest.get(end.checked_add(4)?..)?;
        Some((kind, data))
    })
}
