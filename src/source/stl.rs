//! STL, binary and text. Normals and attributes are not read: the order of the corners says which way a
//! triangle faces.

use fretwork_geometry::{Mesh, Point3};

const HEADER: usize = 84;
const RECORD: usize = 50;

/// The triangles of an STL file; nothing is joined. Memory is proportional to the file.
///
/// # Errors
/// A message when the file is cut off or broken, or a coordinate is not finite.
pub fn read(bytes: &[u8]) -> Result<Mesh, String> {
    let claimed = bytes
        .get(80..HEADER)
        .and_then(|b| b.try_into().ok())
        .map(u32::from_le_bytes);
    let fits =
        claimed.is_some_and(|n| HEADER as u64 + RECORD as u64 * u64::from(n) == bytes.len() as u64);
    if !fits && is_text(bytes) {
        return text(bytes);
    }
    let Some(claimed) = claimed else {
        return Err("it is too short for an STL file".into());
    };
    let there = (bytes.len() - HEADER) / RECORD;
    if there < claimed as usize {
        return Err(format!(
            "it is cut off: it claims {claimed} triangles and holds {there}"
        ));
    }
    let mut mesh = Mesh::default();
    for (number, record) in bytes[HEADER..]
        .chunks_exact(RECORD)
        .take(claimed as usize)
        .enumerate()
    {
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

/// Whether the file begins as a text does.
fn is_text(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(1024)];
    let start = start.trim_ascii_start();
    start.len() >= 5 && start[..5].eq_ignore_ascii_case(b"solid") && !start.contains(&0)
}

fn text(bytes: &[u8]) -> Result<Mesh, String> {
    let mut mesh = Mesh::default();
    let mut corners: Vec<Point3> = Vec::with_capacity(3);
    let mut is_open = true;
    for (line, content) in bytes.split(|b| *b == b'\n').enumerate() {
        let at = |message: &str| format!("line {}: {message}", line + 1);
        let content = std::str::from_utf8(content).unwrap_or("");
        let mut words = content.split_ascii_whitespace();
        match words.next().map(str::to_ascii_lowercase).as_deref() {
            Some("solid") => is_open = true,
            Some("endsolid") => is_open = false,
            Some("facet") => corners.clear(),
            Some("vertex") => {
                let mut next = || words.next().and_then(|word| word.parse::<f64>().ok());
                let (Some(x), Some(y), Some(z)) = (next(), next(), next()) else {
                    return Err(at("a vertex needs three numbers"));
                };
                if corners.len() == 3 {
                    return Err(at("a facet has more than three vertices"));
                }
                corners.push(Point3::new(x, y, z));
            }
            Some("endfacet") => {
                let triangle: [Point3; 3] = corners[..]
                    .try_into()
                    .map_err(|_| at("a facet has fewer than three vertices"))?;
                let number = mesh.triangles.len();
                push(&mut mesh, triangle, number).map_err(|e| at(&e))?;
                corners.clear();
            }
            _ => {}
        }
    }
    if is_open || !corners.is_empty() {
        return Err(format!(
            "it is cut off after {} triangles: there is no `endsolid`",
            mesh.triangles.len()
        ));
    }
    Ok(mesh)
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

    const TRIANGLE: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.5]];

    #[test]
    fn both_forms_are_read() {
        let mesh = read(&binary(1, &[TRIANGLE])).unwrap();
        assert_eq!(
            (mesh.positions[2], mesh.triangles.len()),
            (Point3::new(0.0, 2.0, 0.5), 1)
        );
        let mut named = binary(1, &[TRIANGLE]);
        named[..5].copy_from_slice(b"solid");
        assert_eq!(read(&named).unwrap(), mesh);
        let text = "solid a b\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   VERTEX 1 0 0\r\n   vertex 0 2e0 .5\n  endloop\n endfacet\nendsolid a b\n";
        assert_eq!(read(text.as_bytes()).unwrap(), mesh);
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
            error(b"solid a\nfacet\nvertex 0 0 0\nendfacet"),
            "line 4: a facet has fewer than three vertices"
        );
        assert_eq!(
            error(b"solid a\nfacet\n"),
            "it is cut off after 0 triangles: there is no `endsolid`"
        );
        let nan = b"solid\nfacet\nvertex 0 nan 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\nendsolid";
        assert_eq!(
            error(nan),
            "line 6: triangle 1 has a coordinate that is not a finite number"
        );
    }
}
