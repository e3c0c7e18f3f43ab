//! PLY, text and binary of either byte order: positions and faces. Other elements and properties are skipped.
//!
//! `ply-rs-bw` reads these files too. It is not used here because its rows are records of named values, each
//! with allocations of its own, which a large scan multiplies, and because it brings a parser
//! generator that is compiled for the header alone.

use super::face::Faces;
use super::limit::MOST_TRIANGLES;
use super::lines::{Lines, shown, unmarked};
use fretwork_geometry::{Mesh, Point3};

/// The faces of a PLY file as triangles, and what was not read. Memory is proportional to the file.
///
/// # Errors
/// A message when the file is broken or cut off, a row does not fit the header, or a coordinate is
/// not finite.
pub fn read(bytes: &[u8]) -> Result<(Mesh, Vec<String>), String> {
    let (header, body) = header(unmarked(bytes)?)?;
    let mut rows = Rows::new(&header, body);
    let (mut positions, mut faces) = (Vec::new(), Faces::counted_from(0));
    let mut told = Vec::new();
    for element in &header.elements {
        let properties = element.properties.iter();
        let least = properties.map(|p| p.least(header.form)).sum::<u64>();
        if element.count.saturating_mul(least) > rows.rest().len() as u64 + 1 {
            let (count, name) = (element.count, &element.name);
            return Err(format!(
                "it is cut off: it claims {count} rows of `{name}`, more than the file has bytes for"
            ));
        }
        match &*element.name {
            "vertex" => read_vertices(&mut rows, element, &mut positions)?,
            "face" => read_faces(&mut rows, element, &mut faces)?,
            name => {
                if name == "tristrips" {
                    told.push("its strips of triangles are not read; save it with faces".into());
                }
                skip(&mut rows, element)?;
            }
        }
    }
    told.extend(rows.finish()?);
    let triangles = faces
        .triangles(&positions)
        .map_err(|(row, error)| format!("row {row} of `face`: {error}"))?;
    Ok((
        Mesh {
            positions,
            triangles,
        },
        told,
    ))
}

#[derive(Clone, Copy, PartialEq)]
enum Form {
    Text,
    LittleEndian,
    BigEndian,
}

#[derive(Clone, Copy, PartialEq)]
enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

struct Property {
    name: String,
    /// The type of a list's length, where it is a list.
    length: Option<Scalar>,
    item: Scalar,
}

struct Element {
    name: String,
    count: u64,
    properties: Vec<Property>,
}

struct Header {
    form: Form,
    elements: Vec<Element>,
    /// How many lines it has.
    lines: usize,
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

    fn size(self) -> usize {
        match self {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::F64 => 8,
        }
    }

    /// The number in the first bytes, the lowest first.
    fn value(self, bytes: [u8; 8]) -> f64 {
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
    fn least(&self, form: Form) -> u64 {
        if form == Form::Text {
            2
        } else {
            self.length.unwrap_or(self.item).size() as u64
        }
    }
}

/// The header, and what stands after it.
fn header(bytes: &[u8]) -> Result<(Header, &[u8]), String> {
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

/// The rows that are still to be read.
enum Rows<'a> {
    /// Numbers as their bytes.
    Binary { rest: &'a [u8], is_big_endian: bool },
    /// One row a line.
    Text {
        lines: Lines<'a>,
        row: &'a [u8],
        line: usize,
    },
}

impl<'a> Rows<'a> {
    fn new(header: &Header, body: &'a [u8]) -> Rows<'a> {
        match header.form {
            Form::Text => Rows::Text {
                lines: Lines::new(body, header.lines),
                row: b"",
                line: header.lines,
            },
            form => Rows::Binary {
                rest: body,
                is_big_endian: form == Form::BigEndian,
            },
        }
    }

    /// The bytes that are still to be read, of the row or of the file.
    fn rest(&self) -> &'a [u8] {
        match self {
            Rows::Binary { rest, .. } => rest,
            Rows::Text { lines, row: [], .. } => lines.rest(),
            Rows::Text { row, .. } => row,
        }
    }

    /// Where the row is that is being read, the one numbered `number` (from 1) of `element`.
    fn place(&self, element: &Element, number: u64) -> String {
        let name = &element.name;
        match self {
            Rows::Binary { .. } => format!("row {number} of `{name}`"),
            Rows::Text { line, .. } => format!("line {line}, row {number} of `{name}`"),
        }
    }

    /// Calls `read` for each row of the element; a row must have just what it reads.
    fn each(
        &mut self,
        element: &Element,
        mut read: impl FnMut(&mut Rows<'a>, u64) -> Result<(), String>,
    ) -> Result<(), String> {
        if element.properties.is_empty() {
            return Ok(());
        }
        for number in 1..=element.count {
            let made = self.next_row().and_then(|()| read(self, number));
            made.and_then(|()| self.end_row())
                .map_err(|what| format!("{}: {what}", self.place(element, number)))?;
        }
        Ok(())
    }

    fn next_row(&mut self) -> Result<(), String> {
        if let Rows::Text { lines, row, line } = self {
            let mut filled = lines.filter(|(_, text)| !text.trim_ascii().is_empty());
            (*line, *row) = filled.next().ok_or("it is cut off")?;
        }
        Ok(())
    }

    fn end_row(&mut self) -> Result<(), String> {
        match self {
            Rows::Text { row, .. } if !row.trim_ascii().is_empty() => Err(format!(
                "it has more values than the header says, first `{}`",
                shown(row.trim_ascii())
            )),
            Rows::Text { row, .. } => {
                *row = b"";
                Ok(())
            }
            Rows::Binary { .. } => Ok(()),
        }
    }

    /// What is left over after the last row.
    fn finish(self) -> Result<Option<String>, String> {
        match self {
            Rows::Text { mut lines, .. } => {
                match lines.find(|(_, text)| !text.trim_ascii().is_empty()) {
                    Some((line, _)) => Err(format!(
                        "line {line}: there are more rows than the header says"
                    )),
                    None => Ok(None),
                }
            }
            // Some programs end binary files with a line break.
            Rows::Binary { rest, .. } if rest.trim_ascii().is_empty() => Ok(None),
            Rows::Binary { rest, .. } => Ok(Some(format!(
                "{} bytes after the last row are not read: does the header fit the rows?",
                rest.len()
            ))),
        }
    }

    fn number(&mut self, scalar: Scalar) -> Result<f64, String> {
        match self {
            Rows::Text { row, .. } => word(row),
            Rows::Binary {
                rest,
                is_big_endian,
            } => {
                let size = scalar.size();
                let mut bytes = [0u8; 8];
                bytes[..size].copy_from_slice(rest.get(..size).ok_or("it is cut off")?);
                *rest = &rest[size..];
                if *is_big_endian {
                    bytes[..size].reverse();
                }
                Ok(scalar.value(bytes))
            }
        }
    }

    /// The length of a list whose items are still to come.
    fn length(&mut self, length: Scalar, item: Scalar) -> Result<usize, String> {
        let count = self.number(length)?;
        let room = match self {
            // A digit and what parts it from the next, but for the last one.
            Rows::Text { .. } => (self.rest().len() as f64 + 1.0) / 2.0,
            Rows::Binary { .. } => self.rest().len() as f64 / item.size() as f64,
        };
        if count < 0.0 || count.fract() != 0.0 || count > room {
            return Err(format!("a list claims {count} items, and fewer are there"));
        }
        Ok(count as usize)
    }

    fn pass(&mut self, property: &Property) -> Result<(), String> {
        let count = property
            .length
            .map_or(Ok(1), |length| self.length(length, property.item))?;
        (0..count).try_for_each(|_| self.number(property.item).map(|_| ()))
    }
}

/// Takes the next word off a row; it must be a number.
fn word(row: &mut &[u8]) -> Result<f64, String> {
    let text = row.trim_ascii_start();
    let end = text.iter().position(u8::is_ascii_whitespace);
    let (word, rest) = text.split_at(end.unwrap_or(text.len()));
    *row = rest;
    if word.is_empty() {
        return Err("it has fewer values than the header says".into());
    }
    let number = std::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
    number.ok_or_else(|| format!("`{}` is no number", shown(word)))
}

fn skip(rows: &mut Rows<'_>, element: &Element) -> Result<(), String> {
    rows.each(element, |rows, _| {
        element.properties.iter().try_for_each(|p| rows.pass(p))
    })
}

fn read_vertices(
    rows: &mut Rows<'_>,
    element: &Element,
    positions: &mut Vec<Point3>,
) -> Result<(), String> {
    let at = |name: &str| {
        element
            .properties
            .iter()
            .position(|p| p.name == name && p.length.is_none())
    };
    let (Some(x), Some(y), Some(z)) = (at("x"), at("y"), at("z")) else {
        return Err("its vertices have no x, y and z".into());
    };
    rows.each(element, |rows, _| {
        let mut point = [0.0; 3];
        for (i, property) in element.properties.iter().enumerate() {
            match [x, y, z].iter().position(|axis| *axis == i) {
                Some(axis) => point[axis] = rows.number(property.item)?,
                None => rows.pass(property)?,
            }
        }
        // In binary files of single floats NaN stands for points that were not measured.
        if point.iter().any(|v| !v.is_finite()) {
            return Err("it has a coordinate that is not a finite number".into());
        }
        if positions.len() >= u32::MAX as usize {
            return Err("it has too many vertices".into());
        }
        positions.push(point.into());
        Ok(())
    })
}

fn read_faces(rows: &mut Rows<'_>, element: &Element, faces: &mut Faces) -> Result<(), String> {
    let is_corners =
        |p: &Property| matches!(&*p.name, "vertex_indices" | "vertex_index") && p.length.is_some();
    if !element.properties.iter().any(is_corners) && element.count > 0 {
        return Err("its faces have no `vertex_indices`".into());
    }
    let mut corners = Vec::new();
    rows.each(element, |rows, number| {
        for property in &element.properties {
            let Some(length) = property.length.filter(|_| is_corners(property)) else {
                rows.pass(property)?;
                continue;
            };
            corners.clear();
            for _ in 0..rows.length(length, property.item)? {
                let corner = rows.number(property.item)?;
                if !(0.0..f64::from(u32::MAX)).contains(&corner) || corner.fract() != 0.0 {
                    return Err(format!("a face names vertex {corner}"));
                }
                corners.push(corner as u32);
            }
            faces.push(&corners, number as usize);
        }
        if faces.most_triangles() > MOST_TRIANGLES {
            return Err("it has too many triangles".into());
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n";

    fn binary(form: &str, big: bool) -> Vec<u8> {
        let mut bytes = format!("ply\r\nformat {form} 1.0\ncomment by hand\n{HEADER}").into_bytes();
        for p in [
            [0.0f32, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.5],
            [0.0, 1.0, 0.0],
        ] {
            p.iter().for_each(|v| {
                bytes.extend(if big {
                    v.to_be_bytes()
                } else {
                    v.to_le_bytes()
                })
            });
            bytes.push(7);
        }
        bytes.push(4);
        (0..4i32).for_each(|i| {
            bytes.extend(if big {
                i.to_be_bytes()
            } else {
                i.to_le_bytes()
            })
        });
        bytes
    }

    fn mesh(bytes: &[u8]) -> Mesh {
        let (mesh, told) = read(bytes).unwrap();
        assert_eq!(told, [""; 0]);
        mesh
    }

    fn text() -> String {
        format!("ply\nformat ascii 1.0\n{HEADER}0 0 0 7\n1 0 0 7\n1 1 .5 7\n0 1 0 7\n4 0 1 2 3\n")
    }

    #[test]
    fn all_forms_give_the_same_mesh() {
        let found = mesh(text().as_bytes());
        assert_eq!(found.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(found.positions[2], Point3::new(1.0, 1.0, 0.5));
        assert_eq!(mesh(&binary("binary_little_endian", false)), found);
        assert_eq!(mesh(&binary("binary_big_endian", true)), found);
        for other in [
            text().replace('\n', "\r"),
            text().replace('\n', "\r\n"),
            text().replace("7\n", "7 \n\n"),
            format!("\u{feff}{}", text().trim_end()),
        ] {
            assert_eq!(mesh(other.as_bytes()), found, "{other:?}");
        }
        let carriage = binary("binary_little_endian", false);
        let end = carriage
            .windows(11)
            .position(|w| w == b"end_header\n")
            .unwrap()
            + 11;
        let head = String::from_utf8_lossy(&carriage[..end])
            .replace("\r\n", "\n")
            .replace('\n', "\r");
        assert_eq!(
            mesh(&[head.as_bytes(), &carriage[end..], b"\n"].concat()),
            found
        );
    }

    #[test]
    fn concave_faces_are_triangulated() {
        let bent = text()
            .replace("1 1 .5 7", "0.2 0.2 0 7")
            .replace("4 0 1 2 3", "4 1 2 3 0");
        let found = mesh(bent.as_bytes());
        assert!((found.area() - 0.2).abs() < 1e-12, "{}", found.area());
        let bow = text().replace("4 0 1 2 3", "4 0 2 1 3");
        assert!(
            read(bow.as_bytes())
                .unwrap_err()
                .starts_with("row 1 of `face`: the sides of a face of 4")
        );
    }

    #[test]
    fn rows_that_do_not_fit_the_header_are_told() {
        let error = |from: &str, to: &str| read(text().replace(from, to).as_bytes()).unwrap_err();
        assert_eq!(
            error("1 0 0 7\n", "1 0 0\n"),
            "line 12, row 2 of `vertex`: it has fewer values than the header says"
        );
        assert_eq!(
            error("1 0 0 7\n", "1 0 0 7 8 9\n"),
            "line 12, row 2 of `vertex`: it has more values than the header says, first `8 9`"
        );
        assert_eq!(
            error("4 0 1 2 3\n", "4 0 1 2\n"),
            "line 15, row 1 of `face`: a list claims 4 items, and fewer are there"
        );
        assert_eq!(
            error("3\n", "3\n3 0 1 2\n"),
            "line 16: there are more rows than the header says"
        );
        assert_eq!(
            error("4 0 1 2 3\n", ""),
            "it is cut off: it claims 1 rows of `face`, more than the file has bytes for"
        );
        assert_eq!(
            error("1 1 .5 7", "1 1,5 0 7"),
            "line 13, row 3 of `vertex`: `1,5` is no number"
        );
        let mut long = binary("binary_little_endian", false);
        long.extend(b"more");
        assert!(read(&long).unwrap().1[0].starts_with("4 bytes after the last row"));
    }

    #[test]
    fn broken_files_are_told() {
        let error = |bytes: &[u8]| read(bytes).unwrap_err();
        assert_eq!(error(b""), "it does not begin with `ply`");
        assert_eq!(
            error(b"ply\nformat ascii 1.0\n"),
            "its header is cut off or broken"
        );
        assert_eq!(
            error(b"ply\nelement vertex many\n"),
            "`many` is no number of rows"
        );
        let cut = binary("binary_little_endian", false);
        assert!(error(&cut[..cut.len() - 1]).starts_with("row 1 of `face`: a list claims 4 items"));
        let huge = String::from_utf8_lossy(&cut).replace("vertex 4", "vertex 4294967296");
        assert!(
            error(huge.as_bytes())
                .starts_with("it is cut off: it claims 4294967296 rows of `vertex`")
        );
        let far = b"ply\nformat ascii 1.0\nelement face 1\nproperty list int int vertex_indices\nend_header\n3 0 1 9\n";
        assert_eq!(
            error(far),
            "row 1 of `face`: a face names vertex 0, counted from 0, which is not there"
        );
        let nan = b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 nan 0\n";
        assert_eq!(
            error(nan),
            "line 8, row 1 of `vertex`: it has a coordinate that is not a finite number"
        );
        let empty = b"ply\nformat ascii 1.0\nelement nothing 18446744073709551615\nend_header\n";
        assert_eq!(mesh(empty), Mesh::default());
    }
}
