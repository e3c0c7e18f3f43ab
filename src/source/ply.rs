//! PLY, text and binary of either byte order: positions and faces. Other elements and properties are skipped.

use super::mesh::MOST_TRIANGLES;
use fretwork_geometry::Mesh;

/// The faces of a PLY file; those of more than three corners are divided into fans. Memory is proportional to the
/// file.
///
/// # Errors
/// A message when the file is broken or cut off, or a coordinate is not finite.
pub fn read(bytes: &[u8]) -> Result<Mesh, String> {
    let (header, body) = header(bytes)?;
    let mut reader = Reader {
        rest: body,
        form: header.form,
    };
    let mut mesh = Mesh::default();
    for element in &header.elements {
        let least = element
            .properties
            .iter()
            .map(|p| p.least(header.form))
            .sum::<u64>();
        if element.count.saturating_mul(least) > reader.rest.len() as u64 + 1 {
            let (count, name) = (element.count, &element.name);
            return Err(format!(
                "it is cut off: it claims {count} records of `{name}`, more than the file has bytes for"
            ));
        }
        match &*element.name {
            "vertex" => read_vertices(&mut reader, element, &mut mesh)?,
            "face" => read_faces(&mut reader, element, &mut mesh)?,
            _ => skip(&mut reader, element)?,
        }
    }
    let count = mesh.positions.len();
    match mesh
        .triangles
        .iter()
        .flatten()
        .find(|corner| **corner as usize >= count)
    {
        Some(corner) => Err(format!(
            "a face names vertex {corner}, and there are {count}, counted from 0"
        )),
        None => Ok(mesh),
    }
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
    let mut rest = bytes;
    let mut line = || {
        let end = rest.iter().take(4096).position(|b| *b == b'\n')?;
        let text = std::str::from_utf8(&rest[..end])
            .ok()?
            .trim_end_matches('\r')
            .to_string();
        rest = &rest[end + 1..];
        Some(text)
    };
    if line().as_deref().map(str::trim) != Some("ply") {
        return Err("it does not begin with `ply`".into());
    }
    let mut header = Header {
        form: Form::Text,
        elements: Vec::new(),
    };
    let mut has_form = false;
    loop {
        let text = line().ok_or("its header is cut off or broken")?;
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        match words[..] {
            ["end_header"] if has_form => return Ok((header, rest)),
            ["format", form, _] => {
                has_form = true;
                header.form = match form {
                    "ascii" => Form::Text,
                    "binary_little_endian" => Form::LittleEndian,
                    "binary_big_endian" => Form::BigEndian,
                    _ => return Err(format!("`{form}` is no format that is known")),
                };
            }
            ["element", name, count] => {
                let count = count
                    .parse()
                    .map_err(|_| format!("`{count}` is no number of records"))?;
                header.elements.push(Element {
                    name: name.into(),
                    count,
                    properties: Vec::new(),
                });
            }
            ["property", "list", length, item, name] => {
                let property = Property {
                    name: name.into(),
                    length: Some(Scalar::of(length)?),
                    item: Scalar::of(item)?,
                };
                header
                    .elements
                    .last_mut()
                    .ok_or("a property belongs to no element")?
                    .properties
                    .push(property);
            }
            ["property", item, name] => {
                let property = Property {
                    name: name.into(),
                    length: None,
                    item: Scalar::of(item)?,
                };
                header
                    .elements
                    .last_mut()
                    .ok_or("a property belongs to no element")?
                    .properties
                    .push(property);
            }
            [] | ["comment" | "obj_info", ..] => {}
            _ => return Err(format!("its header has a line that is not known: `{text}`")),
        }
    }
}

struct Reader<'a> {
    rest: &'a [u8],
    form: Form,
}

impl Reader<'_> {
    fn number(&mut self, scalar: Scalar) -> Result<f64, String> {
        if self.form == Form::Text {
            return self.word();
        }
        let size = scalar.size();
        let mut bytes = [0u8; 8];
        bytes[..size].copy_from_slice(self.rest.get(..size).ok_or("it is cut off")?);
        self.rest = &self.rest[size..];
        if self.form == Form::BigEndian {
            bytes[..size].reverse();
        }
        let [a, b, c, d, ..] = bytes;
        Ok(match scalar {
            Scalar::I8 => f64::from(a as i8),
            Scalar::U8 => f64::from(a),
            Scalar::I16 => f64::from(i16::from_le_bytes([a, b])),
            Scalar::U16 => f64::from(u16::from_le_bytes([a, b])),
            Scalar::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Scalar::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Scalar::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Scalar::F64 => f64::from_le_bytes(bytes),
        })
    }

    fn word(&mut self) -> Result<f64, String> {
        self.rest = self.rest.trim_ascii_start();
        let end = self
            .rest
            .iter()
            .position(u8::is_ascii_whitespace)
            .unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        let word = std::str::from_utf8(word).unwrap_or("");
        if word.is_empty() {
            return Err("it is cut off".into());
        }
        word.parse().map_err(|_| {
            format!(
                "`{}` is no number",
                word.chars().take(20).collect::<String>()
            )
        })
    }

    /// The length of a list whose items are still to come.
    fn length(&mut self, length: Scalar, item: Scalar) -> Result<usize, String> {
        let count = self.number(length)?;
        let least = if self.form == Form::Text {
            1
        } else {
            item.size()
        };
        if count < 0.0 || count.fract() != 0.0 || count * least as f64 > self.rest.len() as f64 {
            return Err(format!(
                "a list claims {count} items, and the file ends before"
            ));
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

fn skip(reader: &mut Reader<'_>, element: &Element) -> Result<(), String> {
    if element.properties.is_empty() {
        return Ok(());
    }
    (0..element.count).try_for_each(|_| element.properties.iter().try_for_each(|p| reader.pass(p)))
}

fn read_vertices(
    reader: &mut Reader<'_>,
    element: &Element,
    mesh: &mut Mesh,
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
    for number in 0..element.count {
        let mut point = [0.0; 3];
        for (i, property) in element.properties.iter().enumerate() {
            match [x, y, z].iter().position(|axis| *axis == i) {
                Some(axis) => point[axis] = reader.number(property.item)?,
                None => reader.pass(property)?,
            }
        }
        // In binary files of single floats NaN stands for points that were not measured.
        if point.iter().any(|v| !v.is_finite()) {
            return Err(format!(
                "vertex {number} has a coordinate that is not a finite number"
            ));
        }
        if mesh.positions.len() >= u32::MAX as usize {
            return Err("it has too many vertices".into());
        }
        mesh.positions.push(point.into());
    }
    Ok(())
}

fn read_faces(reader: &mut Reader<'_>, element: &Element, mesh: &mut Mesh) -> Result<(), String> {
    let is_corners =
        |p: &Property| matches!(&*p.name, "vertex_indices" | "vertex_index") && p.length.is_some();
    if !element.properties.iter().any(is_corners) && element.count > 0 {
        return Err("its faces have no `vertex_indices`".into());
    }
    let mut corners = Vec::new();
    for _ in 0..element.count {
        for property in &element.properties {
            let Some(length) = property.length.filter(|_| is_corners(property)) else {
                reader.pass(property)?;
                continue;
            };
            corners.clear();
            for _ in 0..reader.length(length, property.item)? {
                let corner = reader.number(property.item)?;
                if !(0.0..f64::from(u32::MAX)).contains(&corner) || corner.fract() != 0.0 {
                    return Err(format!("a face names vertex {corner}"));
                }
                corners.push(corner as u32);
            }
            if mesh.triangles.len() + corners.len() > MOST_TRIANGLES {
                return Err("it has too many triangles".into());
            }
            if let [first, rest @ ..] = &corners[..] {
                mesh.triangles
                    .extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Point3;

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

    #[test]
    fn all_forms_give_the_same_mesh() {
        let text = format!(
            "ply\nformat ascii 1.0\n{HEADER}0 0 0 7\n1 0 0 7\n1 1 .5 7\n0 1 0 7\n4 0 1 2 3\n"
        );
        let mesh = read(text.as_bytes()).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(mesh.positions[2], Point3::new(1.0, 1.0, 0.5));
        assert_eq!(read(&binary("binary_little_endian", false)).unwrap(), mesh);
        assert_eq!(read(&binary("binary_big_endian", true)).unwrap(), mesh);
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
            "`many` is no number of records"
        );
        let cut = binary("binary_little_endian", false);
        assert!(error(&cut[..cut.len() - 1]).starts_with("a list claims 4 items"));
        let huge = String::from_utf8_lossy(&cut).replace("vertex 4", "vertex 4294967296");
        assert!(
            error(huge.as_bytes())
                .starts_with("it is cut off: it claims 4294967296 records of `vertex`")
        );
        let far = b"ply\nformat ascii 1.0\nelement face 1\nproperty list int int vertex_indices\nend_header\n3 0 1 9\n";
        assert_eq!(
            error(far),
            "a face names vertex 0, and there are 0, counted from 0"
        );
        let nan = b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 nan 0\n";
        assert_eq!(
            error(nan),
            "vertex 0 has a coordinate that is not a finite number"
        );
        let empty = b"ply\nformat ascii 1.0\nelement nothing 18446744073709551615\nend_header\n";
        assert_eq!(read(empty), Ok(Mesh::default()));
    }
}
