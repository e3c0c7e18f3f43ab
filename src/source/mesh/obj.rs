//! Wavefront OBJ: positions, faces and the names of their materials. Groups, normals, places on pictures and lines are not read.
//!
//! `tobj` reads these files too. It is not used here because its errors say neither the line nor the
//! word, a line that goes on after a backslash is an error to it, and every face becomes a fan.

use std::collections::BTreeMap;

use super::face::Faces;
use super::limit::MOST_TRIANGLES;
use super::lines::{Lines, shown, unmarked};
use fretwork_geometry::{Mesh, Point3, counted};

/// Statements that say nothing about faces.
const WITHOUT_FACES: [&str; 31] = [
    "vt",
    "vn",
    "vp",
    "p",
    "l",
    "g",
    "o",
    "s",
    "mg",
    "usemap",
    "maplib",
    "lod",
    "bevel",
    "c_interp",
    "d_interp",
    "shadow_obj",
    "trace_obj",
    "ctech",
    "stech",
    "cstype",
    "deg",
    "bmat",
    "step",
    "parm",
    "trim",
    "hole",
    "scrv",
    "sp",
    "end",
    "con",
    "call",
];

/// What an OBJ file holds.
pub struct Parts {
    /// All of it.
    pub whole: Mesh,
    /// The faces of each material by its name, which is empty before one is named.
    pub parts: Vec<(String, Mesh)>,
    /// The files of materials that it names.
    pub libraries: Vec<String>,
    /// What was not read.
    pub told: Vec<String>,
}

/// The faces of an OBJ file as triangles, and what was not read. Memory is proportional to the file.
///
/// # Errors
/// A message with the line when a vertex or a face is broken.
pub fn read(bytes: &[u8]) -> Result<(Mesh, Vec<String>), String> {
    read_parts(bytes).map(|read| (read.whole, read.told))
}

/// As [`read`], with the faces of each material apart.
///
/// # Errors
/// As there.
pub fn read_parts(bytes: &[u8]) -> Result<Parts, String> {
    let mut positions = Vec::new();
    let mut faces = Faces::counted_from(1);
    let mut materials = Materials::default();
    let mut unread = Unread::default();
    let mut lines = Lines::new(unmarked(bytes)?, 0);
    while let Some((number, line)) = lines.next() {
        let at = |message: String| format!("line {number}: {message}");
        let text = joined(line, &mut lines);
        let content = text.split('#').next().unwrap_or("");
        let mut words = content.split_ascii_whitespace();
        match words.next() {
            Some("v") => positions.push(vertex(words).map_err(at)?),
            // `fo` is what the first version of the format called a face.
            Some("f" | "fo") => {
                let corners = words
                    .map(|word| corner(word, positions.len()))
                    .collect::<Result<Vec<u32>, _>>()
                    .map_err(at)?;
                if corners.len() < 3 {
                    let count = counted(corners.len(), "vertex", "vertices");
                    return Err(at(format!("a face has {count}")));
                }
                faces.push(&corners, number);
            }
            Some("usemtl") => materials.begin(content, faces.len()),
            Some("mtllib") => materials.libraries.extend(words.map(str::to_owned)),
            Some(word) => unread.note(word, number),
            None => {}
        }
        if faces.most_triangles() > MOST_TRIANGLES {
            return Err(at("it has too many triangles".into()));
        }
    }
    let (triangles, ends) = faces
        .divided(&positions)
        .map_err(|(line, error)| format!("line {line}: {error}"))?;
    let whole = Mesh {
        positions,
        triangles,
    };
    Ok(Parts {
        parts: materials.parts(&whole, &ends),
        whole,
        libraries: materials.libraries,
        told: unread.told(),
    })
}

/// The materials that a file names, in its order.
#[derive(Default)]
struct Materials {
    libraries: Vec<String>,
    /// Each name with the number of the first face that has it.
    begin: Vec<(String, usize)>,
}

impl Materials {
    /// From this face on they have the material of a `usemtl` statement.
    fn begin(&mut self, statement: &str, face: usize) {
        let name = statement.trim().strip_prefix("usemtl").unwrap_or("").trim();
        self.begin.push((name.to_owned(), face));
    }

    /// The triangles of each material that has some, in the order in which they are named. `ends` counts triangles up to the end
    /// of each face.
    fn parts(&self, whole: &Mesh, ends: &[usize]) -> Vec<(String, Mesh)> {
        let before = |face: usize| face.checked_sub(1).map_or(0, |last| ends[last]);
        let mut parts: Vec<(String, Vec<[u32; 3]>)> = vec![(String::new(), Vec::new())];
        let first = (String::new(), 0);
        let begins: Vec<&(String, usize)> = std::iter::once(&first).chain(&self.begin).collect();
        for (i, (name, face)) in begins.iter().enumerate() {
            let end = begins.get(i + 1).map_or(ends.len(), |next| next.1);
            let own = &whole.triangles[before(*face)..before(end)];
            match parts.iter_mut().find(|(known, _)| known == name) {
                Some((_, triangles)) => triangles.extend(own),
                None => parts.push((name.clone(), own.to_vec())),
            }
        }
        parts.retain(|(_, triangles)| !triangles.is_empty());
        let of = |(name, triangles)| (name, part(&whole.positions, triangles));
        parts.into_iter().map(of).collect()
    }
}

/// Some triangles with the corners that they have.
fn part(positions: &[Point3], triangles: Vec<[u32; 3]>) -> Mesh {
    let mut numbers: BTreeMap<u32, u32> = BTreeMap::new();
    let mut own = Vec::new();
    let mut number = |corner: u32| {
        *numbers.entry(corner).or_insert_with(|| {
            own.push(positions[corner as usize]);
            (own.len() - 1) as u32
        })
    };
    let triangles = triangles.into_iter().map(|t| t.map(&mut number)).collect();
    Mesh {
        positions: own,
        triangles,
    }
}

/// A line, and those that it goes on in after a backslash.
fn joined(line: &[u8], lines: &mut Lines<'_>) -> String {
    let mut text = String::from_utf8_lossy(line).into_owned();
    while text.trim_end().ends_with('\\') {
        text.truncate(text.trim_end().len() - 1);
        match lines.next() {
            Some((_, more)) => {
                text.push(' ');
                text.push_str(&String::from_utf8_lossy(more));
            }
            None => break,
        }
    }
    text
}

fn vertex<'a>(mut words: impl Iterator<Item = &'a str>) -> Result<Point3, String> {
    let mut next = || words.next().and_then(|word| word.parse::<f64>().ok());
    match (next(), next(), next()) {
        (Some(x), Some(y), Some(z)) if Point3::new(x, y, z).is_finite() => Ok(Point3::new(x, y, z)),
        _ => Err("a vertex needs three finite numbers".into()),
    }
}

/// The number of a corner from 0; the file counts from 1, or back from the last one.
fn corner(word: &str, count: usize) -> Result<u32, String> {
    let number = word.split('/').next().and_then(|n| n.parse::<i64>().ok());
    let index = match number {
        Some(n) if n > 0 => Some(n - 1),
        Some(n) if n < 0 => Some(count as i64 + n),
        _ => None,
    };
    let index = index.and_then(|i| u32::try_from(i).ok());
    index.ok_or_else(|| format!("`{}` is no vertex of a face", shown(word.as_bytes())))
}

/// What is in a file and not read.
#[derive(Default)]
struct Unread {
    surfaces: usize,
    unknown: usize,
    /// The first statement that is not known.
    first: Option<(String, usize)>,
}

impl Unread {
    fn note(&mut self, word: &str, line: usize) {
        if matches!(word, "surf" | "curv" | "curv2" | "csh") {
            self.surfaces += 1;
        } else if !WITHOUT_FACES.contains(&word) {
            self.unknown += 1;
            self.first
                .get_or_insert_with(|| (shown(word.as_bytes()), line));
        }
    }

    fn told(self) -> Vec<String> {
        let surfaces = (self.surfaces > 0)
            .then(|| "free-form curves and surfaces are not read; save it as faces".to_string());
        let unknown = self.first.map(|(word, line)| match self.unknown {
            1 => format!("line {line} is not read: `{word}` is no statement"),
            n => format!("{n} lines are not read, first line {line}: `{word}` is no statement"),
        });
        surfaces.into_iter().chain(unknown).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(text: &[u8]) -> Mesh {
        let (mesh, told) = read(text).unwrap();
        assert_eq!(told, [""; 0]);
        mesh
    }

    #[test]
    fn faces_are_read() {
        let text = b"# a\no thing\nv 0 0 0 1\nv 1 0 0\nv 1 1 \\\n 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1/1 3//1 -1 # quad\ns off\nf 5 1 2\nv 0 0 1\n";
        let found = mesh(text);
        assert_eq!(found.triangles, [[0, 1, 2], [0, 2, 3], [4, 0, 1]]);
        assert_eq!(found.positions[2], Point3::new(1.0, 1.0, 0.0));
    }

    #[test]
    fn marks_and_ends_of_lines_of_other_systems_are_read() {
        let lines = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        let plain = mesh(lines.as_bytes());
        assert_eq!(plain.triangles, [[0, 1, 2]]);
        for other in [
            lines.replace('\n', "\r"),
            lines.replace('\n', "\r\n"),
            format!("\u{feff}{lines}"),
        ] {
            assert_eq!(mesh(other.as_bytes()), plain, "{other:?}");
        }
        assert!(read(b"\xff\xfev\0").unwrap_err().contains("UTF-16"));
    }

    #[test]
    fn concave_faces_are_triangulated() {
        let found = mesh(b"v 0 4 0\nv 0 0 0\nv 4 0 0\nv 1 1 0\nf 1 2 3 4\n");
        assert_eq!((found.triangles.len(), found.area()), (2, 4.0));
        let bow = read(b"v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nv 3 .5 0\n\nf 1 2 3 4 5\n");
        assert!(
            bow.unwrap_err()
                .starts_with("line 7: the sides of a face of 5 corners cross")
        );
    }

    #[test]
    fn what_is_not_read_is_told() {
        let base = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        let told = |more: &str| read(format!("{base}{more}").as_bytes()).unwrap().1;
        assert_eq!(
            told("surf 0 1 0 1 1\n"),
            ["free-form curves and surfaces are not read; save it as faces"]
        );
        assert_eq!(told("vv 1\n"), ["line 5 is not read: `vv` is no statement"]);
        assert_eq!(
            told("\nF 1 2 3\nV 1\n"),
            ["2 lines are not read, first line 6: `F` is no statement"]
        );
    }

    #[test]
    fn broken_files_are_told() {
        let error = |text: &[u8]| read(text).unwrap_err();
        assert_eq!(
            error(b"v 0 0\n"),
            "line 1: a vertex needs three finite numbers"
        );
        assert_eq!(
            error(b"\nv 0 nan 0\n"),
            "line 2: a vertex needs three finite numbers"
        );
        assert_eq!(
            error(b"v 0 0 0\nf 1 1 2\n"),
            "line 2: a face names vertex 2, counted from 1, which is not there"
        );
        assert_eq!(
            error(b"v 0 0 0\nf 1 -2 1\n"),
            "line 2: `-2` is no vertex of a face"
        );
        assert_eq!(error(b"f 0 1 2\n"), "line 1: `0` is no vertex of a face");
        assert_eq!(error(b"v 0 0 0\nf 1 1\n"), "line 2: a face has 2 vertices");
        assert_eq!(
            error(b"f 99999999999 1 2"),
            "line 1: `99999999999` is no vertex of a face"
        );
        assert_eq!(error(b"f\\\n\\"), "line 1: a face has 0 vertices");
    }
}
