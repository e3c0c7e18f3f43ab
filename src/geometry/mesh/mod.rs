//! Triangle meshes in space, and what they measure. Where they come from (files, extrusions, bands) and
//! how they are written is not known here.

mod check;
mod contact;
mod crossing;
pub mod delaunay;
mod error;
mod line_drawing;
mod model;
pub mod nearest;
mod normals;
mod overlap;
pub mod paths;
mod refine;
mod revolve;
mod section;
mod triangulate;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::Point3;

pub use crate::space::{Affine3, Bounds3};
pub use check::MeshTopology;
pub use contact::{Surface, charge_for_meetings};
pub use crossing::{Along, self_crossing};
pub use error::{MeshError, TriangulationError};
pub use line_drawing::{Line, LineKind, Wanted, line_drawing};
pub use model::{Body, Coloring, Cut, Image, ImageFormat, Material, Model, Part};
pub use normals::corner_normals;
pub use refine::refined;
pub use revolve::{RevolveError, check_size, revolve, revolved_profile};
pub use section::{SectionError, sections};
pub use triangulate::{open_sides, triangulate};

/// Triangles over shared corners, counter-clockwise seen from outside. A corner is one by its number: two
/// corners may stand in one place, as where two bodies touch.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Mesh {
    /// The corners.
    pub positions: Vec<Point3>,
    /// Numbers of corners.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// The closed box between `from` and `to`, whose coordinates are the greater ones. Its triangles turn counter-clockwise, seen from outside.
    pub fn cuboid(from: Point3, to: Point3) -> Mesh {
        let corner = |i: u32| {
            let pick = |bit: u32, low: f64, high: f64| if i >> bit & 1 == 1 { high } else { low };
            Point3::new(
                pick(0, from.x, to.x),
                pick(1, from.y, to.y),
                pick(2, from.z, to.z),
            )
        };
        let sides = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
        Mesh {
            positions: (0..8).map(corner).collect(),
            triangles: sides.into_iter().flat_map(halves).collect(),
        }
    }

    /// The corners of a triangle.
    #[inline]
    pub fn corners(&self, triangle: [u32; 3]) -> [Point3; 3] {
        triangle.map(|corner| self.positions[corner as usize])
    }

    /// The box of all corners.
    #[inline]
    pub fn bounds(&self) -> Bounds3 {
        Bounds3::of(self.positions.iter().copied())
    }

    /// The area of all triangles.
    #[inline]
    pub fn area(&self) -> f64 {
        let twice = |t: &[u32; 3]| doubled_normal(self.corners(*t)).length();
        self.triangles.iter().map(twice).sum::<f64>() / 2.0
    }

    /// The enclosed volume of a closed mesh, negative where its triangles face inward. Measured from the middle
    /// of its box, which keeps the digits of a small mesh far from the origin.
    #[inline]
    pub fn volume(&self) -> f64 {
        let origin = self.bounds().center();
        let six = |t: &[u32; 3]| {
            let [a, b, c] = self.corners(*t).map(|p| p - origin);
            a.dot(b.cross(c))
        };
        self.triangles.iter().map(six).sum::<f64>() / 6.0
    }

    /// The image under `map`; where it mirrors, the triangles are turned over so that they still face outward.
    #[inline]
    pub fn transformed(&self, map: &Affine3) -> Mesh {
        let positions = self.positions.iter().map(|p| map.apply(*p)).collect();
        let mirrored = map.determinant() < 0.0;
        let turned = |&[a, b, c]: &[u32; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
        Mesh {
            positions,
            triangles: self.triangles.iter().map(turned).collect(),
        }
    }

    /// The same mesh seen from the other side.
    #[inline]
    pub fn reversed(&self) -> Mesh {
        Mesh {
            positions: self.positions.clone(),
            triangles: self.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(),
        }
    }

    /// Adds `other` as it is; nothing is joined.
    #[inline]
    pub fn append(&mut self, other: &Mesh) {
        let first = u32::try_from(self.positions.len()).expect("corners are numbered with 32 bits");
        self.positions.extend_from_slice(&other.positions);
        self.triangles.extend(
            other
                .triangles
                .iter()
                .map(|t| t.map(|corner| corner + first)),
        );
    }

    /// The mesh whose corners in exactly the same place are one, without triangles that have lost a corner by
    /// that and without corners that no triangle has. Corners keep the order of their first use. O(n log n).
    pub fn welded(&self) -> Mesh {
        let mut known: BTreeMap<[u64; 3], u32> = BTreeMap::new();
        let mut mesh = Mesh::default();
        for triangle in &self.triangles {
            let keys = self.corners(*triangle).map(key);
            if keys[0] == keys[1] || keys[1] == keys[2] || keys[2] == keys[0] {
                continue;
            }
            mesh.triangles.push(std::array::from_fn(|i| {
                *known.entry(keys[i]).or_insert_with(|| {
                    mesh.positions
                        .push(self.positions[triangle[i] as usize] + Point3::ORIGIN);
                    (mesh.positions.len() - 1) as u32
                })
            }));
        }
        mesh
    }

    /// Whether every number of a corner exists and every coordinate is finite.
    ///
    /// # Errors
    /// The first triangle or corner that is wrong, or that there is no triangle.
    pub fn validate(&self) -> Result<(), MeshError> {
        if self.triangles.is_empty() {
            return Err(MeshError::Empty);
        }
        let count = self.positions.len();
        if let Some(at) = self.positions.iter().position(|p| !p.is_finite()) {
            return Err(MeshError::NotFinite { corner: at });
        }
        match self
            .triangles
            .iter()
            .position(|t| t.iter().any(|&corner| corner as usize >= count))
        {
            Some(triangle) => Err(MeshError::NoSuchCorner {
                triangle,
                corners: count,
            }),
            None => Ok(()),
        }
    }
}

/// Twice the area of a triangle along its normal.
pub fn doubled_normal([a, b, c]: [Point3; 3]) -> Point3 {
    (b - a).cross(c - a)
}

/// Equal for equal coordinates; 0 and -0 are equal.
fn key(p: Point3) -> [u64; 3] {
    [p.x, p.y, p.z].map(|v| (v + 0.0).to_bits())
}

#[cfg(test)]
mod tests {
    use super::*;

    pub fn tetrahedron() -> Mesh {
        let positions = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]]
            .map(Point3::from)
            .to_vec();
        Mesh {
            positions,
            triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
        }
    }

    #[test]
    fn a_tetrahedron_is_measured() {
        let mesh = tetrahedron();
        assert!((mesh.volume() - 1.0 / 6.0).abs() < 1e-15);
        assert!((mesh.area() - (1.5 + 3f64.sqrt() / 2.0)).abs() < 1e-15);
        assert!((mesh.reversed().volume() + 1.0 / 6.0).abs() < 1e-15);
        let mirrored = mesh.transformed(&Affine3::scale(Point3::new(-2.0, 1.0, 1.0)));
        assert!((mirrored.volume() - 1.0 / 3.0).abs() < 1e-15);
        assert_eq!(mirrored.bounds().min, Point3::new(-2.0, 0.0, 0.0));
    }

    #[test]
    fn welding_joins_what_stands_in_one_place() {
        let mesh = tetrahedron();
        let mut soup = Mesh::default();
        for triangle in &mesh.triangles {
            soup.append(&Mesh {
                positions: mesh.corners(*triangle).to_vec(),
                triangles: vec![[0, 1, 2]],
            });
        }
        soup.positions[0].x = -0.0;
        soup.append(&Mesh {
            positions: vec![Point3::ORIGIN; 3],
            triangles: vec![[0, 1, 2]],
        });
        let welded = soup.welded();
        assert_eq!((welded.positions.len(), welded.triangles.len()), (4, 4));
        assert!(welded.positions.iter().all(|p| p.x.is_sign_positive()));
        assert!(welded.check_closed().is_ok());
    }

    #[test]
    fn wrong_meshes_are_refused() {
        let mut mesh = tetrahedron();
        mesh.positions[1].y = f64::NAN;
        assert_eq!(mesh.validate(), Err(MeshError::NotFinite { corner: 1 }));
        let mut mesh = tetrahedron();
        mesh.triangles[2][1] = 4;
        assert_eq!(
            mesh.validate(),
            Err(MeshError::NoSuchCorner {
                triangle: 2,
                corners: 4
            })
        );
        assert_eq!(Mesh::default().validate(), Err(MeshError::Empty));
    }
}
