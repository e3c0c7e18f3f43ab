//! The origin of an artifact as its file says it: in elements and members where a format has such, else in a line of
//! text. How it is read again is in `read`; where in a file it stands, each format knows.

mod read;

use serde_json::{Value as Json, json};

pub use read::read;

/// The XML namespace of origins.
pub const NAMESPACE: &str = "urn:fretwork:origin:1";
/// What every line begins with.
const WORD: &str = "fretwork";
/// The bytes of the head of an STL file.
pub(crate) const STL_HEAD: usize = 80;

/// Where a file comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    /// The output folder of its spec. Read from an STL file it may have lost its beginning.
    pub spec: String,
    /// Its path below that folder.
    pub artifact: String,
    /// 32 hexadecimal digits that stand for what it was made of.
    pub recipe: String,
}

impl Origin {
    /// `fretwork SPEC ARTIFACT RECIPE` in printable characters of Latin-1. Others, and spaces in names, are written
    /// as `\U+XXXX`, as DXF has it, in units of UTF-16.
    pub fn line(&self) -> String {
        let [spec, artifact] = [&self.spec, &self.artifact].map(|name| plain(name));
        format!("{WORD} {spec} {artifact} {}", self.recipe)
    }

    /// The origin that a line says, if it says one.
    pub fn of_line(line: &str) -> Option<Origin> {
        let parts: Vec<&str> = line.trim_end().split(' ').collect();
        let [WORD, spec, artifact, recipe] = parts[..] else {
            return None;
        };
        Origin {
            spec: named(spec)?,
            artifact: named(artifact)?,
            recipe: recipe.to_string(),
        }
        .checked()
    }

    /// The line as the head of an STL file. Where it is too long, the spec loses its beginning, and after it the
    /// artifact.
    pub fn head(&self) -> [u8; STL_HEAD] {
        let room = STL_HEAD.saturating_sub(WORD.len() + self.recipe.len() + 3);
        let artifact = plain_end(&self.artifact, room);
        let spec = plain_end(&self.spec, room - artifact.chars().count());
        let line = latin(&format!("{WORD} {spec} {artifact} {}", self.recipe));
        std::array::from_fn(|i| line.get(i).copied().unwrap_or(b' '))
    }

    /// Whether it is that of an artifact with these names, of which an STL file may have lost some.
    pub fn names(&self, spec: &str, artifact: &str) -> bool {
        let whole = Origin {
            spec: spec.to_string(),
            artifact: artifact.to_string(),
            recipe: self.recipe.clone(),
        };
        *self == whole || self.head() == whole.head()
    }

    /// The object that JSON files hold.
    pub fn json(&self) -> Json {
        json!({ "spec": self.spec, "artifact": self.artifact, "recipe": self.recipe })
    }

    fn of_json(json: &Json) -> Option<Origin> {
        let text = |name: &str| Some(json.get(name)?.as_str()?.to_string());
        Origin {
            spec: text("spec")?,
            artifact: text("artifact")?,
            recipe: text("recipe")?,
        }
        .checked()
    }

    /// The origin if it can be one.
    fn checked(self) -> Option<Origin> {
        let is_digit = |b: u8| matches!(b, b'0'..=b'9' | b'a'..=b'f');
        (self.recipe.len() == 32 && self.recipe.bytes().all(is_digit)).then_some(self)
    }
}

/// A name in printable characters of Latin-1 without spaces and backslashes.
fn plain(name: &str) -> String {
    let mut out = String::new();
    for c in name.chars() {
        if matches!(c, '!'..='[' | ']'..='~' | '\u{a1}'..='\u{ff}') {
            out.push(c);
        } else {
            let mut units = [0; 2];
            let units = c.encode_utf16(&mut units).iter();
            out.extend(units.map(|unit| format!("\\U+{unit:04X}")));
        }
    }
    out
}

/// The longest end of a name that has at most `room` characters when it is [`plain`].
fn plain_end(name: &str, room: usize) -> String {
    let starts = name.char_indices().map(|(at, _)| at).chain([name.len()]);
    let mut ends = starts.map(|at| plain(&name[at..]));
    ends.find(|end| end.chars().count() <= room)
        .unwrap_or_default()
}

/// The name that [`plain`] has written so.
fn named(plain: &str) -> Option<String> {
    let mut pieces = plain.split("\\U+");
    let mut units: Vec<u16> = pieces.next()?.encode_utf16().collect();
    for piece in pieces {
        units.push(u16::from_str_radix(piece.get(..4)?, 16).ok()?);
        units.extend(piece.get(4..)?.encode_utf16());
    }
    String::from_utf16(&units).ok()
}

/// A text of [`plain`] characters, a byte each.
pub(crate) fn latin(text: &str) -> Vec<u8> {
    text.chars()
        .map(|c| u8::try_from(u32::from(c)).unwrap_or(b'_'))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    pub fn origin(spec: &str, artifact: &str) -> Origin {
        Origin {
            spec: spec.into(),
            artifact: artifact.into(),
            recipe: "0123456789abcdef".repeat(2),
        }
    }

    #[test]
    fn a_line_is_plain_and_comes_back() {
        for (spec, artifact) in [
            ("solids/hare", "hare.stl"),
            ("my spec", "a b\n.svg"),
            ("höhe", "\u{4e00}\u{1f600}.dxf"),
            ("", "a.svg"),
            ("a\\U+0041", "b\\.svg"),
        ] {
            let origin = origin(spec, artifact);
            let line = origin.line();
            assert!(
                line.chars()
                    .all(|c| matches!(c, ' '..='~' | '\u{a1}'..='\u{ff}')),
                "{line}"
            );
            assert_eq!(Origin::of_line(&line), Some(origin));
        }
        let line = origin("solids/hare", "hare.stl").line();
        assert_eq!(
            line,
            "fretwork solids/hare hare.stl 0123456789abcdef0123456789abcdef"
        );
        for wrong in ["", "fretwork a b 12", "solid a b c", "fretwork a b \\U+"] {
            assert_eq!(Origin::of_line(wrong), None, "{wrong}");
        }
    }

    /// What a program that knows nothing of origins makes of a file still says them.
    #[test]
    fn packages_and_drawings_that_were_written_anew_say_their_origin() {
        let known = origin("a <b>", "c & d.3mf");
        let model = |attribute: &str, name: &str| {
            let line = crate::format::escaped(&known.line());
            format!(
                "<model xmlns=\"core\" {attribute}><metadata name=\"Title\">t</metadata>\n<metadata name=\"{name}\" \
                 type=\"xs:string\">\n {line} </metadata><resources><object/></resources></model>"
            )
        };
        let package = |text: &str| {
            let files = [
                ("3D/other.model", &b"<model/>"[..]),
                ("3D/a.model", text.as_bytes()),
            ];
            crate::format::zip::archive(&files).unwrap()
        };
        let space = format!("xmlns:x=\"{NAMESPACE}\"");
        assert_eq!(
            read(&package(&model(&space, "x:origin"))),
            Some(known.clone())
        );
        assert_eq!(
            read(&package(&model("xmlns:x=\"other\"", "x:origin"))),
            None
        );
        assert_eq!(read(&package(&model(&space, "origin"))), None);
        let drawing = format!(
            "\u{feff}<?xml version=\"1.0\"?><!DOCTYPE svg [<!ENTITY o \"{NAMESPACE}\">]>\n<svg xmlns=\"http://www.w3.org/2000/svg\" \
             xmlns:f=\"&o;\"><metadata><other/><f:origin recipe='{}' spec='a &lt;b>' artifact='c &amp; d.3mf'/></metadata></svg>",
            known.recipe
        );
        assert_eq!(read(drawing.as_bytes()), Some(known.clone()));
        assert_eq!(read(drawing.replace(&known.recipe, "12").as_bytes()), None);
        let comments = format!(
            "  0\r\nSECTION\r\n999\r\nother\r\n999\r\n{}\r\n",
            known.line()
        );
        assert_eq!(read(comments.as_bytes()), Some(known));
    }

    #[test]
    fn bytes_of_any_sort_say_nothing() {
        for bytes in [
            &b""[..],
            b"glTF",
            b"glTF\x02\0\0\0\xff\xff\xff\xff\xff\xff\xff\xffJSON{}",
            b"\x89PNG\r\n\x1a\n\xff\xff\xff\xfftEXtOrigin\0",
            b"PK\x03\x04",
            b"<svg",
            b"{\"origin\": 3}",
            b"{",
            b"fretwork a b c",
            b"999\n\xff",
            b"solid a",
        ] {
            assert_eq!(read(bytes), None, "{bytes:?}");
        }
    }

    #[test]
    fn a_head_is_cut_from_the_left_of_the_spec() {
        let long = origin(&"folder/".repeat(9), "a.stl");
        let head = long.head();
        assert!(head.starts_with(b"fretwork ") && !head.starts_with(b"solid"));
        let text: String = head.map(char::from).iter().collect();
        let read = Origin::of_line(&text).unwrap();
        assert_eq!((&*read.artifact, &read.recipe), ("a.stl", &long.recipe));
        assert!(
            long.spec.ends_with(&read.spec) && read.spec.len() == 32,
            "{}",
            read.spec
        );
        let short = origin("a", "b.stl");
        let text: String = short.head().map(char::from).iter().collect();
        assert_eq!(Origin::of_line(&text), Some(short));
        let name = origin("a", &"b".repeat(100)).head();
        assert!(name.ends_with(b"bbb 0123456789abcdef0123456789abcdef"));
    }
}
