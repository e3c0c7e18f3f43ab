//! Where pictures come from: from the server by their digests, or out of the page itself, which must not become too large.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::super::exhibit::{Figure, Sort};

/// The most bytes of one picture in a page, of solids, and of all: as text they take a third more.
const PICTURE: usize = 3 << 20;
const SOLIDS: usize = 2 << 20;
const ALL: usize = 17 << 20;

/// How much a page may still hold in itself.
pub struct Room {
    is_live: bool,
    left: usize,
}

impl Room {
    /// The room of a page; nothing is held in one that is served.
    pub fn new(is_live: bool) -> Room {
        Room { is_live, left: ALL }
    }

    /// Notes that so many bytes are in the page already.
    pub fn take(&mut self, bytes: usize) {
        self.left = self.left.saturating_sub(bytes);
    }

    /// Whether the page asks a server.
    pub fn is_live(&self) -> bool {
        self.is_live
    }

    /// Where a figure's bytes are; none where they find no room.
    pub fn figure(&mut self, figure: &Figure) -> Option<String> {
        if !self.is_live {
            return self.data(media(figure), &figure.bytes, PICTURE);
        }
        let view = figure.is_view.then(|| figure.sort.name());
        Some(address(&figure.path, &figure.blake3, view))
    }

    /// A picture of solids in the page itself.
    pub fn still(&mut self, png: &[u8]) -> Option<String> {
        self.data("image/png", png, PICTURE)
    }

    /// The bytes of solids as text in the page itself.
    pub fn solids(&mut self, glb: &[u8]) -> Option<String> {
        self.text(glb, SOLIDS)
    }

    fn data(&mut self, media: &str, bytes: &[u8], most: usize) -> Option<String> {
        let text = self.text(bytes, most)?;
        Some(format!("data:{media};base64,{text}"))
    }

    fn text(&mut self, bytes: &[u8], most: usize) -> Option<String> {
        if bytes.len() > most.min(self.left) {
            return None;
        }
        self.left -= bytes.len();
        Some(STANDARD.encode(bytes))
    }
}

/// Where the server has an artifact, or a form of it in another format.
pub fn address(path: &str, blake3: &str, view: Option<&str>) -> String {
    let parts: Vec<String> = path.split('/').map(escaped).collect();
    let view = view.map_or(String::new(), |view| format!("&as={view}"));
    format!("/files/{}?v={blake3}{view}", parts.join("/"))
}

fn media(figure: &Figure) -> &'static str {
    match figure.sort {
        Sort::Svg => "image/svg+xml",
        Sort::Png => "image/png",
        Sort::Glb => "model/gltf-binary",
    }
}

/// A part of a path as it stands in an address.
fn escaped(part: &str) -> String {
    let mut text = String::new();
    for byte in part.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' => {
                text.push(char::from(byte));
            }
            _ => text += &format!("%{byte:02X}"),
        }
    }
    text
}
