//! PLY files as programs write them, and broken ones.

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
        error(huge.as_bytes()).starts_with("it is cut off: it claims 4294967296 rows of `vertex`")
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
