//! Meshes to try.

use fretwork_geometry::mesh::Affine3;
use fretwork_geometry::{Mesh, Point3};

/// A cube about the origin.
pub(crate) fn cube(side: f64) -> Mesh {
    let half = Point3::new(0.5, 0.5, 0.5) * side;
    Mesh::cuboid(half * -1.0, half)
}

/// A square of the plane z = 0 about the origin, seen from above.
pub(crate) fn square(side: f64) -> Mesh {
    let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
    Mesh {
        positions: corners
            .map(|[x, y]| Point3::new(x * side, y * side, 0.0))
            .to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }
}

/// A sphere about the origin, of `steps` meridians and half as many parallels.
pub(crate) fn sphere(radius: f64, steps: u32) -> Mesh {
    grid(steps, steps / 2, |u, v| {
        let (along, up) = (turn(u), turn(0.5 * v - 0.25));
        Point3::new(along[0] * up[0], along[1] * up[0], up[1]) * radius
    })
}

/// A torus about the z axis.
pub(crate) fn torus(radius: f64, tube: f64, steps: u32) -> Mesh {
    grid(steps, steps / 2, |u, v| {
        let (along, round) = (turn(u), turn(v));
        let out = radius + tube * round[0];
        Point3::new(along[0] * out, along[1] * out, tube * round[1])
    })
}

/// A mesh turned so that nothing of it lies along the axes.
pub(crate) fn turned(mesh: &Mesh) -> Mesh {
    let axis = Point3::new(0.48, 0.6, 0.64);
    mesh.transformed(&Affine3::rotation(axis, 0.7))
}

fn turn(part: f64) -> [f64; 2] {
    let angle = part * std::f64::consts::TAU;
    [libm::cos(angle), libm::sin(angle)]
}

/// The mesh of a map of the unit square.
fn grid(columns: u32, rows: u32, at: impl Fn(f64, f64) -> Point3) -> Mesh {
    let part = |n: u32, of: u32| f64::from(n) / f64::from(of);
    let number = |i: u32, j: u32| i * (rows + 1) + j;
    let mut mesh = Mesh::default();
    for i in 0..=columns {
        for j in 0..=rows {
            mesh.positions.push(at(part(i, columns), part(j, rows)));
            if i < columns && j < rows {
                let [a, b] = [number(i, j), number(i + 1, j)];
                mesh.triangles.push([a, b, b + 1]);
                mesh.triangles.push([a, b + 1, a + 1]);
            }
        }
    }
    mesh
}
