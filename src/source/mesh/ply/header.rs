//! The header of a PLY file: which tables of rows it has, and how they are written.

use crate::mesh::lines::shown;

/// How the rows are written.
#[derive(Clone, Copy, PartialEq)]
pub enum Form {
    Text,
    LittleEndian,
    BigEndian,
}

/// The type of a number.
#[derive(Clone, Copy, PartialEq)]
pub enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

/// What a row has once, or as a list.
pub struct Property {
    pub name: String,
    /// The type of a list's length, where it is a list.
    pub length: Option<Scalar>,
    pub item: Scalar,
}

/// A table of rows.
pub struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

/// What a file says of itself.
pub struct Header {
    pub form: Form,
    pub elements: Vec<Element>,
    /// How many lines it has.
    pub lines: usize,
}

impl Scalar {
    fn of(word: &str) -> Result<Scalar, String> {
        Ok(match word {
            "char" | "int8" => Scalar::I8,
            "uchar" | "uint8" => Scalar::U8,
            "short" | "int16" => Scalar::I16,
            "ushort" | "uint16" => Scalar::U16,
            "int" | "int32" => Scalar::I32,
            "uint" | "uint32" => Scalar::U32,
            "float" | "float32" => Scalar::F32,
            "double" | "float64" => Scalar::F64,
            _ => return Err(format!("`{word}` is no type of a property")),
        })
    }

    pub fn size(self) -> usize {
        match self {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::F64 => 8,
        }
    }

    /// The number in the first bytes, the lowest first.
    pub fn value(self, bytes: [u8; 8]) -> f64 {
        let [a, b, c, d, ..] = bytes;
        match self {
            Scalar::I8 => f64::from(a as i8),
            Scalar::U8 => f64::from(a),
            Scalar::I16 => f64::from(i16::from_le_bytes([a, b])),
            Scalar::U16 => f64::from(u16::from_le_bytes([a, b])),
            Scalar::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Scalar::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Scalar::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Scalar::F64 => f64::from_le_bytes(bytes),
        }
    }
}

impl Property {
    /// The fewest bytes that it takes: in text a digit and what parts it from the next.
    pub fn least(&self, form: Form) -> u64 {
        if form == Form::Text {
            2
        } else {
            self.length.unwrap_or(self.item).size() as u64
        }
    }
}

/// The header, and what stands after it.
pub fn header(bytes: &[u8]) -> Result<(Header, &[u8]), String> {
    let end = bytes.iter().position(|b| matches!(b, b'\n' | b'\r'));
    let first = &bytes[..end.unwrap_or(bytes.len())];
    if first.trim_ascii() != b"ply" {
        return Err("it does not begin with `ply`".into());
    }
    // After a header whose lines end in CR alone, binary rows may begin with the byte of LF.
    let after = &bytes[first.len()..];
    let is_carriage = after.starts_with(b"\r") && !after.starts_with(b"\r\n");
    let ending = if is_carriage { b'\r' } else { b'\n' };
    let mut rest = bytes;
    let mut number = 0;
    let mut line = || {
        let end = rest.iter().take(4096).position(|b| *b == ending)?;
        let text = std::str::from_utf8(&rest[..end])
            .ok()?
            .trim_end_matches('\r');
        rest = &rest[end + 1..];
        number += 1;
        Some(text)
    };
    line();
    let mut form = None;
    let mut elements: Vec<Element> = Vec::new();
    loop {
        let text = line().ok_or("its header is cut off or broken")?;
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        match (&words[..], form) {
            (["end_header"], Some(form)) => {
                let header = Header {
                    form,
                    elements,
                    lines: number,
                };
                return Ok((header, rest));
            }
            (["format", name, _], _) => form = Some(Form::of(name)?),
            (["element", name, count], _) => elements.push(Element::of(name, count)?),
            (["property", words @ ..], _) => elements
                .last_mut()
                .ok_or("a property belongs to no element")?
                .properties
                .push(Property::of(words, text)?),
            ([] | ["comment" | "obj_info", ..], _) => {}
            _ => return Err(unknown(text)),
        }
    }
}

fn unknown(line: &str) -> String {
    let line = shown(line.as_bytes());
    format!("its header has a line that is not known: `{line}`")
}

impl Form {
    fn of(word: &str) -> Result<Form, String> {
        match word {
            "ascii" => Ok(Form::Text),
            "binary_little_endian" => Ok(Form::LittleEndian),
            "binary_big_endian" => Ok(Form::BigEndian),
            _ => Err(format!("`{}` is no format of PLY", shown(word.as_bytes()))),
        }
    }
}

impl Element {
    fn of(name: &str, count: &str) -> Result<Element, String> {
        let count = count
            .parse()
            .map_err(|_| format!("`{}` is no number of rows", shown(count.as_bytes())))?;
        Ok(Element {
            name: name.into(),
            count,
            properties: Vec::new(),
        })
    }
}

impl Property {
    /// The property that the words after `property` in this line declare.
    fn of(words: &[&str], line: &str) -> Result<Property, String> {
        let (length, item, name) = match words {
            ["list", length, item, name] => (Some(Scalar::of(length)?), item, name),
            [item, name] => (None, item, name),
            _ => return Err(unknown(line)),
        };
        Ok(Property {
            name: (*name).into(),
            length,
            item: Scalar::of(item)?,
        })
    }
}
