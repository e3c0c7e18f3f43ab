//! Triangles that share their corners, and upright walls between levels.

use std::collections::HashMap;

use fretwork_geometry::mesh::Mesh;
use fretwork_geometry::{Point, Point3};

/// Triangles with one corner for each place and height.
#[derive(Default)]
pub struct Corners {
    /// The triangles so far.
    pub mesh: Mesh,
    numbers: HashMap<[u64; 3], u32>,
    /// The heights that meet at each place, ascending.
    levels: HashMap<[u64; 2], Vec<f64>>,
}

impl Corners {
    /// Notes a height at a place. Walls beside the place get a corner there, so that no edge ends in
    /// the middle of another.
    pub fn note(&mut self, p: Point, height: f64) {
        let levels = self.levels.entry(place(p)).or_default();
        if let Err(at) = levels.binary_search_by(|other| other.total_cmp(&height)) {
            levels.insert(at, height);
        }
    }

    /// Adds a triangle.
    pub fn push(&mut self, corners: [(Point, f64); 3]) {
        let numbers = corners.map(|(p, height)| self.number(p, height));
        self.mesh.triangles.push(numbers);
    }

    fn number(&mut self, p: Point, height: f64) -> u32 {
        let [x, y] = place(p);
        *self
            .numbers
            .entry([x, y, (height + 0.0).to_bits()])
            .or_insert_with(|| {
                self.mesh.positions.push(Point3::new(p.x, p.y, height));
                (self.mesh.positions.len() - 1) as u32
            })
    }

    /// Adds a wall from `a` to `b` that faces to the right of that direction.
    pub fn wall(&mut self, a: Point, b: Point, low: f64, high: f64) {
        let chain = |solid: &Corners, p: Point| -> Vec<f64> {
            let levels = solid.levels.get(&place(p)).map_or(&[][..], |levels| levels);
            let between = levels.iter().copied().filter(|v| *v > low && *v < high);
            std::iter::once(low)
                .chain(between)
                .chain(std::iter::once(high))
                .collect()
        };
        let (left, right) = (chain(self, a), chain(self, b));
        let (mut i, mut j) = (0, 0);
        while i + 1 < left.len() || j + 1 < right.len() {
            let is_left = j + 1 == right.len() || i + 1 < left.len() && left[i + 1] < right[j + 1];
            if is_left {
                self.push([(a, left[i]), (b, right[j]), (a, left[i + 1])]);
                i += 1;
            } else {
                self.push([(a, left[i]), (b, right[j]), (b, right[j + 1])]);
                j += 1;
            }
        }
    }
}

/// A key that is equal for equal coordinates; 0 and -0 are equal.
fn place(p: Point) -> [u64; 2] {
    [p.x + 0.0, p.y + 0.0].map(f64::to_bits)
}
