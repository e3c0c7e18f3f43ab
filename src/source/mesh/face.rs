//! Faces of more than three corners to triangles.

use fretwork_geometry::mesh::triangulate;
use fretwork_geometry::{Point, Point3, Polygon};

/// The faces of a file until all of its vertices are known.
pub struct Faces {
    /// How the file counts its first vertex.
    first: u32,
    corners: Vec<u32>,
    /// Where the corners of each face end, and its row or line.
    ends: Vec<(usize, usize)>,
}

impl Faces {
    /// No faces yet, of a file that counts its vertices from `first`.
    pub fn counted_from(first: u32) -> Faces {
        Faces {
            first,
            corners: Vec::new(),
            ends: Vec::new(),
        }
    }

    /// Adds a face, which stands in the row `place`.
    pub fn push(&mut self, corners: &[u32], place: usize) {
        self.corners.extend_from_slice(corners);
        self.ends.push((self.corners.len(), place));
    }

    /// How many triangles the faces give at most.
    pub fn most_triangles(&self) -> usize {
        self.corners.len()
    }

    /// How many faces there are.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// The triangles of all faces.
    ///
    /// # Errors
    /// The row of the first face that cannot be divided, and why.
    pub fn triangles(&self, positions: &[Point3]) -> Result<Vec<[u32; 3]>, (usize, String)> {
        self.divided(positions).map(|(triangles, _)| triangles)
    }

    /// The triangles of all faces, and how many there are up to the end of each face.
    ///
    /// # Errors
    /// As [`Faces::triangles`].
    pub fn divided(
        &self,
        positions: &[Point3],
    ) -> Result<(Vec<[u32; 3]>, Vec<usize>), (usize, String)> {
        let mut triangles = Vec::new();
        let mut ends = Vec::with_capacity(self.ends.len());
        let mut start = 0;
        for &(end, place) in &self.ends {
            let corners = &self.corners[start..end];
            divide(corners, positions, &mut triangles).map_err(|e| (place, self.message(e)))?;
            start = end;
            ends.push(triangles.len());
        }
        Ok((triangles, ends))
    }

    fn message(&self, error: FaceError) -> String {
        match error {
            FaceError::NoVertex(vertex) => {
                let (number, first) = (u64::from(vertex) + u64::from(self.first), self.first);
                format!("a face names vertex {number}, counted from {first}, which is not there")
            }
            error => error.to_string(),
        }
    }
}

/// Why a face has no triangles.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FaceError {
    /// It names a vertex, by its number from 0, that there is not.
    #[error("vertex {0} of a face is not there")]
    NoVertex(u32),
    /// Its sides cross or touch one another.
    #[error("the sides of a face of {0} corners cross or touch one another")]
    Crossing(usize),
}

/// Adds the triangles of the face whose corners are numbers of `positions`, turned as the face is.
///
/// A face that is convex, seen against its normal, is a fan about its first corner. Any other is
/// triangulated in the plane of that normal (Newell's: the sum of the cross products of successive
/// corners, which no corner alone decides), so a face that is bent a little keeps its corners. A
/// corner that is named twice in a row counts once; a face without an area is a fan.
///
/// # Errors
/// [`FaceError`].
pub fn divide(
    corners: &[u32],
    positions: &[Point3],
    triangles: &mut Vec<[u32; 3]>,
) -> Result<(), FaceError> {
    if let Some(&vertex) = corners.iter().find(|c| **c as usize >= positions.len()) {
        return Err(FaceError::NoVertex(vertex));
    }
    let mut corners = corners;
    let mut distinct = Vec::new();
    if corners.len() > 3 {
        distinct.extend_from_slice(corners);
        distinct.dedup();
        while distinct.len() > 1 && distinct.first() == distinct.last() {
            distinct.pop();
        }
        corners = &distinct;
    }
    let [first, rest @ ..] = corners else {
        return Ok(());
    };
    let ring = if corners.len() > 3 {
        flattened(corners, positions)
    } else {
        Vec::new()
    };
    if is_convex(&ring) {
        triangles.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
        return Ok(());
    }
    let polygon = Polygon {
        outer: ring,
        holes: Vec::new(),
    };
    let found = triangulate(&polygon).map_err(|_| FaceError::Crossing(corners.len()))?;
    triangles.extend(found.iter().map(|t| t.map(|i| corners[i as usize])));
    Ok(())
}

/// The corners in the plane of the face's normal, counter-clockwise; none when it has no area.
fn flattened(corners: &[u32], positions: &[Point3]) -> Vec<Point> {
    let at = |i: usize| positions[corners[i % corners.len()] as usize];
    let origin = at(0);
    let normal = (0..corners.len())
        .map(|i| (at(i) - origin).cross(at(i + 1) - origin))
        .fold(Point3::ORIGIN, |sum, part| sum + part);
    let Some(normal) = normal.unit() else {
        return Vec::new();
    };
    // The axis that is farthest from the normal gives the best-conditioned frame.
    let (x, y, z) = (normal.x.abs(), normal.y.abs(), normal.z.abs());
    let axis = if x <= y && x <= z {
        Point3::new(1.0, 0.0, 0.0)
    } else if y <= z {
        Point3::new(0.0, 1.0, 0.0)
    } else {
        Point3::new(0.0, 0.0, 1.0)
    };
    let Some(u) = axis.cross(normal).unit() else {
        return Vec::new();
    };
    let v = normal.cross(u);
    let flat = |i: usize| {
        let p = at(i) - origin;
        Point::new(p.dot(u), p.dot(v))
    };
    (0..corners.len()).map(flat).collect()
}

/// Whether a counter-clockwise ring turns left at every corner and once round in all. A ring of
/// fewer than four corners does.
fn is_convex(ring: &[Point]) -> bool {
    if ring.len() < 4 {
        return true;
    }
    let at = |i: usize| ring[i % ring.len()];
    let turns_left =
        (0..ring.len()).all(|i| (at(i + 1) - at(i)).cross(at(i + 2) - at(i + 1)) > 0.0);
    // A star turns left everywhere too, but its sides change between left and right more often.
    let is_leftward = |i: usize| at(i + 1).x < at(i).x;
    let changes = (0..ring.len()).filter(|&i| is_leftward(i) != is_leftward(i + 1));
    turns_left && changes.count() == 2
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangles(places: &[[f64; 3]]) -> Result<Vec<[u32; 3]>, FaceError> {
        let positions: Vec<Point3> = places.iter().map(|p| Point3::from(*p)).collect();
        let corners: Vec<u32> = (0..places.len() as u32).collect();
        let mut found = Vec::new();
        divide(&corners, &positions, &mut found).map(|()| found)
    }

    /// The area of the triangles, and that of their normals' sum: they differ where a triangle is turned over.
    fn areas(places: &[[f64; 3]], triangles: &[[u32; 3]]) -> (f64, f64) {
        let normals = triangles.iter().map(|t| {
            let [a, b, c] = t.map(|i| Point3::from(places[i as usize]));
            (b - a).cross(c - a) * 0.5
        });
        let sum = normals.clone().fold(Point3::ORIGIN, |sum, n| sum + n);
        (normals.map(|n| n.length()).sum(), sum.length())
    }

    const ARROW: [[f64; 3]; 4] = [[0., 0., 0.], [4., 0., 0.], [1., 1., 0.], [0., 4., 0.]];

    #[test]
    fn concave_faces_keep_their_area_from_any_first_corner() {
        for first in 0..4 {
            let mut places = ARROW;
            places.rotate_left(first);
            let (area, turned) = areas(&places, &triangles(&places).unwrap());
            assert!((area - 4.0).abs() < 1e-12 && (turned - 4.0).abs() < 1e-12);
            places.reverse();
            let back = triangles(&places).unwrap();
            assert!((areas(&places, &back).0 - 4.0).abs() < 1e-12);
        }
    }

    #[test]
    fn concave_faces_may_stand_anywhere_and_bend_a_little() {
        // A comb on a slope, whose teeth leave its plane by a hundredth.
        let comb = [
            [0., 0.],
            [7., 0.],
            [7., 3.],
            [6., 3.],
            [6., 1.],
            [4., 1.],
            [4., 3.],
            [3., 3.],
            [3., 1.],
            [1., 1.],
            [1., 3.],
            [0., 3.],
        ];
        let lift = |i: usize| if i % 5 == 3 { 0.01 } else { 0.0 };
        let places: Vec<[f64; 3]> = comb
            .iter()
            .enumerate()
            .map(|(i, p)| [p[0], 0.8 * p[1] - 0.6 * lift(i), 0.6 * p[1] + 0.8 * lift(i)])
            .collect();
        let found = triangles(&places).unwrap();
        let (area, turned) = areas(&places, &found);
        assert_eq!(found.len(), 10);
        assert!(
            (area - 13.0).abs() < 0.05 && (area - turned).abs() < 0.05,
            "{area} {turned}"
        );
    }

    #[test]
    fn convex_faces_are_fans() {
        let square = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
        assert_eq!(triangles(&square), Ok(vec![[0, 1, 2], [0, 2, 3]]));
        let line = [[0., 0., 0.], [1., 0., 0.], [2., 0., 0.], [3., 0., 0.]];
        assert_eq!(triangles(&line).unwrap().len(), 2);
    }

    #[test]
    fn repeated_corners_count_once_and_crossing_sides_are_told() {
        let positions: Vec<Point3> = ARROW.iter().map(|p| Point3::from(*p)).collect();
        let mut found = Vec::new();
        divide(&[0, 0, 1, 2, 2, 3, 0], &positions, &mut found).unwrap();
        assert_eq!(found.len(), 2);
        let star = [0.0f64, 144., 288., 72., 216.].map(|a| {
            let a = a.to_radians();
            [libm::cos(a), libm::sin(a), 0.0]
        });
        assert_eq!(triangles(&star), Err(FaceError::Crossing(5)));
        assert_eq!(
            divide(&[0, 1, 9], &positions, &mut found),
            Err(FaceError::NoVertex(9))
        );
    }
}
