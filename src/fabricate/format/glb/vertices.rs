//! Vertices as glTF has them: a corner of a mesh is one for each normal and each place on a picture
//! that it has.

use fretwork_geometry::mesh::corner_normals;
use fretwork_geometry::{Mesh, Point3};

/// The cosine of the angle from which on two faces meet in a crease (30 degrees).
const CREASE: f64 = 0.866;

/// Vertices in metres, y up, and triangles of them.
pub struct Vertices {
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    pub uv: Option<Vec<[f32; 2]>>,
    /// The corner of the mesh that each vertex is.
    pub corners: Vec<u32>,
    pub indices: Vec<u32>,
}

/// The end of a chain.
const NONE: u32 = u32::MAX;

impl Vertices {
    /// The vertices of `mesh`, `unit` metres to a unit, with places on a picture for the corners of
    /// each triangle.
    pub fn of(mesh: &Mesh, uv: Option<&[[[f32; 2]; 3]]>, unit: f64) -> Vertices {
        let mut vertices = Vertices {
            positions: Vec::with_capacity(mesh.positions.len()),
            normals: Vec::with_capacity(mesh.positions.len()),
            uv: uv.map(|_| Vec::new()),
            corners: Vec::with_capacity(mesh.positions.len()),
            indices: Vec::with_capacity(3 * mesh.triangles.len()),
        };
        // The vertices of a corner are a chain: its first one, and for each the next.
        let mut first = vec![NONE; mesh.positions.len()];
        let mut next: Vec<u32> = Vec::new();
        for (number, (triangle, normals)) in mesh
            .triangles
            .iter()
            .zip(corner_normals(mesh, CREASE))
            .enumerate()
        {
            for side in 0..3 {
                let corner = triangle[side] as usize;
                let normal = float(up(normals[side]));
                let place = uv.map(|uv| uv[number][side]);
                let mut found = first[corner];
                while found != NONE && !vertices.is(found as usize, normal, place) {
                    found = next[found as usize];
                }
                if found == NONE {
                    found = vertices.positions.len() as u32;
                    next.push(first[corner]);
                    first[corner] = found;
                    vertices.corners.push(corner as u32);
                    vertices.push(float(up(mesh.positions[corner]) * unit), normal, place);
                }
                vertices.indices.push(found);
            }
        }
        vertices
    }

    fn is(&self, vertex: usize, normal: [f32; 3], place: Option<[f32; 2]>) -> bool {
        self.normals[vertex] == normal && self.uv.as_ref().map(|uv| uv[vertex]) == place
    }

    fn push(&mut self, position: [f32; 3], normal: [f32; 3], place: Option<[f32; 2]>) {
        self.positions.push(position);
        self.normals.push(normal);
        if let Some((uv, place)) = self.uv.as_mut().zip(place) {
            uv.push(place);
        }
    }
}

/// Negative zero becomes zero.
fn float(p: Point3) -> [f32; 3] {
    [p.x, p.y, p.z].map(|v| v as f32 + 0.0)
}

/// From z up to y up.
pub fn up(p: Point3) -> Point3 {
    Point3::new(p.x, p.z, -p.y)
}
