//! Boxes and faces in the coordinates of a facade (u to the right, v up, w out of its plane), divided
//! where the facade bends.

use fretwork_geometry::Point3;
use fretwork_geometry::mesh::{Body, Mesh};

/// A box from the first to the last of `us`, which are ascending and at least two, divided at those
/// between. Its picture is seen from the front; the sides take the colours of its border.
pub fn slab(us: &[f64], v: [f64; 2], w: [f64; 2]) -> Body {
    let columns = us.len() as u32;
    let mut body = corners(us, v, w);
    // Corners of a column: low and back, low and front, high and back, high and front.
    let at = |column: u32, high: u32, front: u32| 4 * column + 2 * high + front;
    for i in 0..columns - 1 {
        let j = i + 1;
        quad(
            &mut body,
            [at(i, 0, 1), at(j, 0, 1), at(j, 1, 1), at(i, 1, 1)],
        );
        quad(
            &mut body,
            [at(j, 0, 0), at(i, 0, 0), at(i, 1, 0), at(j, 1, 0)],
        );
        quad(
            &mut body,
            [at(i, 1, 1), at(j, 1, 1), at(j, 1, 0), at(i, 1, 0)],
        );
        quad(
            &mut body,
            [at(i, 0, 0), at(j, 0, 0), at(j, 0, 1), at(i, 0, 1)],
        );
    }
    let last = columns - 1;
    quad(
        &mut body,
        [at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0)],
    );
    quad(
        &mut body,
        [
            at(last, 0, 1),
            at(last, 0, 0),
            at(last, 1, 0),
            at(last, 1, 1),
        ],
    );
    pictured(body, us, v)
}

/// A flat face at the depth `w`, divided like a box.
pub fn face(us: &[f64], v: [f64; 2], w: f64) -> Body {
    let mut mesh = Mesh::default();
    for u in us {
        mesh.positions.extend(v.map(|v| Point3::new(*u, v, w)));
    }
    for i in 0..us.len() as u32 - 1 {
        quad(&mut mesh, [2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1]);
    }
    pictured(mesh, us, v)
}

fn corners(us: &[f64], v: [f64; 2], w: [f64; 2]) -> Mesh {
    let mut mesh = Mesh::default();
    for u in us {
        for v in v {
            mesh.positions.extend(w.map(|w| Point3::new(*u, v, w)));
        }
    }
    mesh
}

fn quad(mesh: &mut Mesh, [a, b, c, d]: [u32; 4]) {
    mesh.triangles.extend([[a, b, c], [a, c, d]]);
}

/// The mesh with a picture laid over its extent along u and v.
pub fn pictured(mesh: Mesh, us: &[f64], v: [f64; 2]) -> Body {
    let (left, right) = (us[0], us[us.len() - 1]);
    let place =
        |p: Point3| [(p.x - left) / (right - left), (v[1] - p.y) / (v[1] - v[0])].map(|t| t as f32);
    let uv = mesh
        .triangles
        .iter()
        .map(|t| mesh.corners(*t).map(place))
        .collect();
    Body {
        uv: Some(uv),
        ..Body::plain(mesh)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slabs_are_closed_boxes() {
        for us in [&[1.0, 4.0][..], &[1.0, 1.5, 3.0, 4.0]] {
            let body = slab(us, [2.0, 4.0], [-1.0, 0.5]);
            assert_eq!(
                body.mesh.check_closed().map(|t| (t.components, t.genus)),
                Ok((1, Some(0)))
            );
            assert!((body.mesh.volume() - 9.0).abs() < 1e-12);
            let uv = body.uv.unwrap();
            assert!(
                uv.iter()
                    .flatten()
                    .flatten()
                    .all(|t| (0.0..=1.0).contains(t))
            );
        }
        let face = face(&[0.0, 1.0, 2.0], [0.0, 1.0], 3.0);
        assert_eq!((face.mesh.area(), face.mesh.bounds().min.z), (2.0, 3.0));
        let up = face.mesh.corners(face.mesh.triangles[0]);
        assert!((up[1] - up[0]).cross(up[2] - up[0]).z > 0.0);
    }
}
