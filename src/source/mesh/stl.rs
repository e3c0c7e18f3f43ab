//! STL, binary and text. Normals and attributes are not read: the order of the corners says which way a
//! triangle faces.
//!
//! `stl_io` reads these files too and is the oracle of the tests. It is not used here because it reads text by
//! lines, so that files in one line, with CR alone or with `end solid` are errors to it, its errors say no
//! line, and it takes a text behind a byte order mark for binary.

use super::lines::{shown, unmarked};
use fretwork_geometry::{Mesh, Point3, counted};

const HEADER: usize = 84;
const RECORD: usize = 50;

/// The triangles of an STL file, and what was not read; nothing is joined. Memory is proportional to the file.
///
/// # Errors
/// A message when the file is cut off or broken, or a coordinate is not finite.
pub fn read(bytes: &[u8]) -> Result<(Mesh, Vec<String>), String> {
    let claimed = bytes
        .get(80..HEADER)
        .and_then(|b| b.try_into().ok())
        .map(u32::from_le_bytes);
    let needed = |n: u32| HEADER as u64 + RECORD as u64 * u64::from(n);
    let fits = claimed.is_some_and(|n| needed(n) == bytes.len() as u64);
    if !fits && let Some(text) = text(bytes)? {
        return Reader::new(text).read().map(|mesh| (mesh, Vec::new()));
    }
    let Some(claimed) = claimed else {
        return Err("it is too short for an STL file".into());
    };
    let there = (bytes.len() - HEADER) / RECORD;
    if there < claimed as usize {
        return Err(format!(
            "it is cut off: it claims {} and holds {there}",
            counted(claimed as usize, "triangle", "triangles")
        ));
    }
    let told = (there > claimed as usize).then(|| {
        format!(
            "it claims {} and has room for {there}: those after them are not read",
            counted(claimed as usize, "triangle", "triangles")
        )
    });
    Ok((binary(bytes, claimed as usize)?, told.into_iter().collect()))
}

fn binary(bytes: &[u8], count: usize) -> Result<Mesh, String> {
    let mut mesh = Mesh::default();
    let records = bytes[HEADER..].chunks_exact(RECORD).take(count);
    for (number, record) in records.enumerate() {
        let float = |at: usize| {
            f32::from_le_bytes([record[at], record[at + 1], record[at + 2], record[at + 3]])
        };
        let corner =
            |at: usize| Point3::new(float(at).into(), float(at + 4).into(), float(at + 8).into());
        push(&mut mesh, [corner(12), corner(24), corner(36)], number)?;
    }
    Ok(mesh)
}

fn push(mesh: &mut Mesh, corners: [Point3; 3], number: usize) -> Result<(), String> {
    if corners.iter().any(|p| !p.is_finite()) {
        return Err(format!(
            "triangle {} has a coordinate that is not a finite number",
            number + 1
        ));
    }
    let first = u32::try_from(mesh.positions.len())
        .ok()
        .filter(|n| *n < u32::MAX - 3);
    let first = first.ok_or("it has too many triangles")?;
    mesh.positions.extend(corners);
    mesh.triangles.push([first, first + 1, first + 2]);
    Ok(())
}

/// The text in the file, if it begins as one does.
fn text(bytes: &[u8]) -> Result<Option<&[u8]>, String> {
    let text = unmarked(bytes)?;
    let start = &text[..text.len().min(1024)];
    let start = start.trim_ascii_start();
    let is_text =
        start.len() >= 5 && start[..5].eq_ignore_ascii_case(b"solid") && !start.contains(&0);
    Ok(is_text.then_some(text))
}

/// Reads a text word by word, as its grammar allows: ends of lines count as blanks do, but for the
/// names of solids, which end with their line.
struct Reader<'a> {
    words: Words<'a>,
    mesh: Mesh,
}

impl<'a> Reader<'a> {
    fn new(text: &'a [u8]) -> Reader<'a> {
        let mesh = Mesh::default();
        let words = Words {
            rest: text,
            line: 1,
        };
        Reader { words, mesh }
    }

    fn read(mut self) -> Result<Mesh, String> {
        let mut is_open = false;
        while let Some(word) = self.words.next() {
            match Keyword::of(word) {
                Some(Keyword::Solid) => {
                    is_open = true;
                    self.skip_name();
                }
                Some(Keyword::Facet) => {
                    is_open = true;
                    self.facet()?;
                }
                Some(Keyword::EndSolid) => {
                    is_open = false;
                    self.skip_name();
                }
                Some(Keyword::End) if self.words.is_next(Keyword::Solid) => {
                    is_open = false;
                    self.skip_name();
                }
                Some(Keyword::Vertex) => return Err(self.at("a vertex stands outside of a facet")),
                _ => {}
            }
        }
        if is_open {
            return Err(format!(
                "it is cut off after {}: there is no `endsolid`",
                counted(self.mesh.triangles.len(), "triangle", "triangles")
            ));
        }
        Ok(self.mesh)
    }

    /// Reads a facet after its first word.
    fn facet(&mut self) -> Result<(), String> {
        let mut corners: Vec<Point3> = Vec::with_capacity(3);
        loop {
            let Some(word) = self.words.next() else {
                let count = self.mesh.triangles.len();
                return Err(format!(
                    "it is cut off after {}, inside of a facet",
                    counted(count, "triangle", "triangles")
                ));
            };
            match Keyword::of(word) {
                Some(Keyword::Vertex) if corners.len() == 3 => {
                    return Err(self.at("a facet has more than three vertices"));
                }
                Some(Keyword::Vertex) => corners.push(self.vertex()?),
                Some(Keyword::EndFacet) => break,
                Some(Keyword::End) if self.words.is_next(Keyword::Facet) => {
                    self.words.next();
                    break;
                }
                Some(Keyword::Facet | Keyword::Solid | Keyword::EndSolid) => {
                    return Err(self.at("a facet has no `endfacet`"));
                }
                _ => {}
            }
        }
        let corners = <[Point3; 3]>::try_from(corners)
            .map_err(|_| self.at("a facet has fewer than three vertices"))?;
        let number = self.mesh.triangles.len();
        push(&mut self.mesh, corners, number).map_err(|e| self.at(&e))
    }

    fn vertex(&mut self) -> Result<Point3, String> {
        let mut corner = [0.0; 3];
        for value in &mut corner {
            let before = self.words.line;
            let word = self.words.next().unwrap_or(b"");
            let number = std::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
            *value = number.ok_or_else(|| match word {
                b"" => format!("line {before}: a vertex needs three numbers"),
                word => self.at(&format!(
                    "a vertex needs three numbers, and `{}` is none",
                    shown(word)
                )),
            })?;
        }
        Ok(corner.into())
    }

    fn at(&self, message: &str) -> String {
        format!("line {}: {message}", self.words.line)
    }

    /// Skips the name after the begin or the end of a solid: the rest of the line, but in a file of
    /// one line up to the next facet or end.
    fn skip_name(&mut self) {
        let line = self.words.line;
        loop {
            let mut ahead = self.words;
            let Some(word) = ahead.next().filter(|_| ahead.line == line) else {
                return;
            };
            let is_over = match Keyword::of(word) {
                Some(Keyword::Facet) => ahead.is_next(Keyword::Normal),
                Some(Keyword::EndSolid) => true,
                Some(Keyword::End) => ahead.is_next(Keyword::Solid),
                _ => false,
            };
            if is_over {
                return;
            }
            self.words = ahead;
        }
    }
}

/// The words of a text that are still to come, and the line of the last one.
#[derive(Clone, Copy)]
struct Words<'a> {
    rest: &'a [u8],
    line: usize,
}

impl<'a> Words<'a> {
    /// The next word; none at the end.
    fn next(&mut self) -> Option<&'a [u8]> {
        while let [first, tail @ ..] = self.rest {
            if !first.is_ascii_whitespace() {
                break;
            }
            // CR LF ends one line.
            let ends = *first == b'\n' || *first == b'\r' && tail.first() != Some(&b'\n');
            self.line += usize::from(ends);
            self.rest = tail;
        }
        let end = self.rest.iter().position(u8::is_ascii_whitespace);
        let (word, rest) = self.rest.split_at(end.unwrap_or(self.rest.len()));
        self.rest = rest;
        (!word.is_empty()).then_some(word)
    }

    /// Whether the next word is this one.
    fn is_next(mut self, keyword: Keyword) -> bool {
        self.next().and_then(Keyword::of) == Some(keyword)
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Keyword {
    Solid,
    EndSolid,
    Facet,
    EndFacet,
    Normal,
    Vertex,
    End,
}

impl Keyword {
    fn of(word: &[u8]) -> Option<Keyword> {
        let is = |keyword: &[u8]| word.eq_ignore_ascii_case(keyword);
        Some(match word.first()?.to_ascii_lowercase() {
            b's' if is(b"solid") => Keyword::Solid,
            b'f' if is(b"facet") => Keyword::Facet,
            b'n' if is(b"normal") => Keyword::Normal,
            b'v' if is(b"vertex") => Keyword::Vertex,
            b'e' if is(b"endsolid") => Keyword::EndSolid,
            b'e' if is(b"endfacet") => Keyword::EndFacet,
            b'e' if is(b"end") => Keyword::End,
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn binary(claimed: u32, triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut bytes = vec![b' '; 80];
        bytes.extend(claimed.to_le_bytes());
        for triangle in triangles {
            bytes.extend([0; 12]);
            triangle
                .iter()
                .flatten()
                .for_each(|v| bytes.extend(v.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    fn mesh(bytes: &[u8]) -> Mesh {
        let (mesh, told) = read(bytes).unwrap();
        assert_eq!(told, [""; 0]);
        mesh
    }

    const TRIANGLE: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.5]];
    const TEXT: &str = "solid a b\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   VERTEX 1 0 0\r\n   vertex 0 2e0 .5\n  endloop\n endfacet\nendsolid a b\n";

    #[test]
    fn both_forms_are_read() {
        let found = mesh(&binary(1, &[TRIANGLE]));
        assert_eq!(
            (found.positions[2], found.triangles.len()),
            (Point3::new(0.0, 2.0, 0.5), 1)
        );
        let mut named = binary(1, &[TRIANGLE]);
        named[..5].copy_from_slice(b"solid");
        assert_eq!(mesh(&named), found);
        assert_eq!(mesh(TEXT.as_bytes()), found);
    }

    #[test]
    fn all_dialects_of_text_are_read() {
        let found = mesh(TEXT.as_bytes());
        for other in [
            format!("\u{feff}{TEXT}"),
            TEXT.replace("\r\n", "\n").replace('\n', "\r"),
            TEXT.replace("\r\n", "\n").replace('\n', "\r\n"),
            TEXT.replace(['\n', '\r'], " "),
            TEXT.replace("endsolid", "end solid"),
            TEXT.replace("endsolid a b", "END SOLID"),
            TEXT.replace("endfacet", "end facet")
                .replace("endloop", "end loop"),
            TEXT.replace("solid a b", "solid"),
            TEXT.replace("endsolid a b", "endsolid a solid part"),
            TEXT.replace("solid a b", "solid vertex facet solid"),
            TEXT.replace("0 0 1\n", "nan nan nan\n"),
            TEXT.trim_end().to_string(),
        ] {
            assert_eq!(mesh(other.as_bytes()), found, "{other:?}");
        }
        let two = format!("{TEXT}{TEXT}");
        assert_eq!(mesh(two.as_bytes()).triangles.len(), 2);
        let line = two.replace(['\n', '\r'], " ");
        assert_eq!(mesh(line.as_bytes()).triangles.len(), 2);
        let latin = [
            b"solid \xe4 \xff\n",
            TEXT.split_once('\n').unwrap().1.as_bytes(),
        ]
        .concat();
        assert_eq!(mesh(&latin), found);
    }

    #[test]
    fn what_follows_the_triangles_is_told() {
        let (found, told) = read(&binary(1, &[TRIANGLE, TRIANGLE])).unwrap();
        assert_eq!((found.triangles.len(), told.len()), (1, 1));
        assert!(told[0].contains("claims 1 triangle and has room for 2"));
    }

    #[test]
    fn broken_files_are_told() {
        let error = |bytes: &[u8]| read(bytes).unwrap_err();
        assert_eq!(error(b""), "it is too short for an STL file");
        assert_eq!(
            error(&binary(u32::MAX, &[TRIANGLE])),
            "it is cut off: it claims 4294967295 triangles and holds 1"
        );
        assert_eq!(
            error(&binary(2, &[TRIANGLE, TRIANGLE])[..150]),
            "it is cut off: it claims 2 triangles and holds 1"
        );
        let nan = [[0.0, f32::NAN, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.5]];
        assert_eq!(
            error(&binary(2, &[TRIANGLE, nan])),
            "triangle 2 has a coordinate that is not a finite number"
        );
        assert_eq!(
            error(b"solid a\nfacet\nvertex 0 0"),
            "line 3: a vertex needs three numbers"
        );
        assert_eq!(
            error(b"solid a\rfacet\rvertex 0 0 1,5"),
            "line 3: a vertex needs three numbers, and `1,5` is none"
        );
        assert_eq!(
            error(b"solid a\nfacet\nvertex 0 0 0\nendfacet"),
            "line 4: a facet has fewer than three vertices"
        );
        assert_eq!(
            error(b"solid a\nfacet\nvertex 0 0 0\nfacet"),
            "line 4: a facet has no `endfacet`"
        );
        assert_eq!(
            error(b"solid a\nvertex 0 0 0\n"),
            "line 2: a vertex stands outside of a facet"
        );
        assert_eq!(
            error(b"solid a\n"),
            "it is cut off after 0 triangles: there is no `endsolid`"
        );
        assert_eq!(
            error(b"solid a\nfacet\n"),
            "it is cut off after 0 triangles, inside of a facet"
        );
        let nan = b"solid\nfacet\nvertex 0 nan 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\nendsolid";
        assert_eq!(
            error(nan),
            "line 6: triangle 1 has a coordinate that is not a finite number"
        );
    }
}
