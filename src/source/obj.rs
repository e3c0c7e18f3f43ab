//! Wavefront OBJ: positions and faces. Groups, materials, normals, places on pictures and curves are not read.

use super::mesh::MOST_TRIANGLES;
use fretwork_geometry::{Mesh, Point3};

/// The faces of an OBJ file; those of more than three corners are divided into fans. Memory is proportional to the file.
///
/// # Errors
/// A message with the line when a vertex or a face is broken.
pub fn read(bytes: &[u8]) -> Result<Mesh, String> {
    let mut mesh = Mesh::default();
    let mut lines = bytes.split(|b| *b == b'\n').enumerate();
    while let Some((number, line)) = lines.next() {
        let at = |message: String| format!("line {}: {message}", number + 1);
        let mut text = String::from_utf8_lossy(line).into_owned();
        // A backslash joins a line to the next.
        while text.trim_end().ends_with('\\') {
            text.truncate(text.trim_end().len() - 1);
            match lines.next() {
                Some((_, more)) => text.push_str(&String::from_utf8_lossy(more)),
                None => break,
            }
        }
        let content = text.split('#').next().unwrap_or("");
        let mut words = content.split_ascii_whitespace();
        match words.next() {
            Some("v") => mesh.positions.push(vertex(words).map_err(at)?),
            Some("f") => {
                let corners = words
                    .map(|word| corner(word, mesh.positions.len()))
                    .collect::<Result<Vec<u32>, _>>();
                push_face(&mut mesh, &corners.map_err(at)?).map_err(at)?;
            }
            _ => {}
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
            "a face names vertex {}, and there are {count}",
            corner + 1
        )),
        None => Ok(mesh),
    }
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
    index.ok_or_else(|| format!("`{word}` is no vertex of a face"))
}

fn push_face(mesh: &mut Mesh, corners: &[u32]) -> Result<(), String> {
    let [first, rest @ ..] = corners else {
        return Err("a face has no vertices".into());
    };
    if rest.len() < 2 {
        return Err(format!("a face has {} vertices", corners.len()));
    }
    if mesh.triangles.len() + rest.len() > MOST_TRIANGLES {
        return Err("it has too many triangles".into());
    }
    mesh.triangles
        .extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_are_read() {
        let text = b"# a\no thing\nv 0 0 0 1\nv 1 0 0\nv 1 1 \\\n 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1/1 3//1 -1 # quad\ns off\nf 5 1 2\nv 0 0 1\n";
        let mesh = read(text).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [4, 0, 1]]);
        assert_eq!(mesh.positions[2], Point3::new(1.0, 1.0, 0.0));
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
            "a face names vertex 2, and there are 1"
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
        assert_eq!(error(b"f\\\n\\"), "line 1: a face has no vertices");
    }
}
