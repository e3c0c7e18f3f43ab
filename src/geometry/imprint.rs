//! A pattern pressed into a triangle mesh: the mesh divided so that the pattern's outline runs along edges. How it is
//! divided is known to the room `wrap`, and what becomes of the two sides to the room `solid`.

use serde::{Deserialize, Serialize};

use crate::{Mesh, Point3};

/// A place on a mesh, by the corners of a triangle that it lies on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OnMesh {
    /// The numbers of the corners.
    pub of: [u32; 3],
    /// How much of each, from 0 to 1, together 1.
    pub weights: [f64; 3],
}

impl OnMesh {
    /// A corner of the mesh.
    pub fn corner(corner: u32) -> OnMesh {
        OnMesh {
            of: [corner; 3],
            weights: [1.0, 0.0, 0.0],
        }
    }

    /// What stands at the corners, blended at this place.
    pub fn blend(&self, values: &[Point3]) -> Point3 {
        let at = |i: usize| values[self.of[i] as usize];
        if self.weights[0] == 1.0 {
            return at(0);
        }
        at(0) * self.weights[0] + at(1) * self.weights[1] + at(2) * self.weights[2]
    }

    /// As [`OnMesh::blend`], for numbers.
    pub fn blend_numbers(&self, values: &[f64]) -> f64 {
        let parts = self.of.iter().zip(&self.weights);
        parts
            .filter(|(_, weight)| **weight > 0.0)
            .map(|(corner, weight)| values[*corner as usize] * weight)
            .sum()
    }

    /// The place a part `t` of the way from here to `other`; both lie on one triangle.
    pub fn toward(&self, other: &OnMesh, t: f64) -> OnMesh {
        let mut of = Vec::with_capacity(6);
        for (place, part) in [(self, 1.0 - t), (other, t)] {
            for (corner, weight) in place.of.iter().zip(&place.weights) {
                if *weight > 0.0 {
                    of.push((*corner, weight * part));
                }
            }
        }
        of.sort_by_key(|entry| entry.0);
        of.dedup_by(|later, first| {
            let is_same = later.0 == first.0;
            first.1 += if is_same { later.1 } else { 0.0 };
            is_same
        });
        // Rounding can leave a trace of a fourth corner; the least of them goes.
        of.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        let at = |i: usize| of.get(i).copied().unwrap_or((of[0].0, 0.0));
        OnMesh {
            of: [0, 1, 2].map(|i| at(i).0),
            weights: [0, 1, 2].map(|i| at(i).1),
        }
    }
}

/// A mesh divided along the outline of a pattern.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Imprint {
    /// The mesh before it was divided.
    pub surface: Mesh,
    /// Where the corners of the triangles lie on it.
    pub places: Vec<OnMesh>,
    /// The triangles: all of the surface, facing as it does.
    pub triangles: Vec<[u32; 3]>,
    /// Which of them the pattern fills.
    pub inside: Vec<bool>,
}

impl Imprint {
    /// The triangles that are filled, or those that are not.
    pub fn part(&self, inside: bool) -> Vec<[u32; 3]> {
        let all = self.triangles.iter().zip(&self.inside);
        all.filter(|(_, of)| **of == inside)
            .map(|(triangle, _)| *triangle)
            .collect()
    }

    /// Where the corners are in space.
    pub fn positions(&self) -> Vec<Point3> {
        let place = |place: &OnMesh| place.blend(&self.surface.positions);
        self.places.iter().map(place).collect()
    }

    /// The area of the pattern on the surface.
    pub fn area(&self) -> f64 {
        let mesh = Mesh {
            positions: self.positions(),
            triangles: self.part(true),
        };
        mesh.area()
    }
}
