//! Normals for shading: smooth over bent surfaces, sharp at creases.

use super::{Mesh, Point3, doubled_normal};

/// A unit normal for each corner of each triangle: the mean of the normals of the triangles at that corner, by
/// their angles there, that lean no more than the crease from the triangle's own. `crease` is the cosine of the angle.
/// A triangle without area takes the mean of all at its corners, or +z.
pub fn corner_normals(mesh: &Mesh, crease: f64) -> Vec<[Point3; 3]> {
    let units: Vec<Option<Point3>> = mesh
        .triangles
        .iter()
        .map(|t| doubled_normal(mesh.corners(*t)).unit())
        .collect();
    let angles: Vec<[f64; 3]> = mesh
        .triangles
        .iter()
        .map(|t| angles(mesh.corners(*t)))
        .collect();
    let (starts, around) = triangles_around(mesh);
    let normal = |triangle: usize, corner: u32| {
        let own = units[triangle];
        let mut sum = Point3::ORIGIN;
        for &other in
            &around[starts[corner as usize] as usize..starts[corner as usize + 1] as usize]
        {
            let other = other as usize;
            let Some(theirs) = units[other] else { continue };
            if other == triangle || own.is_none_or(|own| own.dot(theirs) >= crease) {
                let side = mesh.triangles[other]
                    .iter()
                    .position(|c| *c == corner)
                    .unwrap_or(0);
                sum = sum + theirs * angles[other][side];
            }
        }
        sum.unit().or(own).unwrap_or(Point3::new(0.0, 0.0, 1.0))
    };
    mesh.triangles
        .iter()
        .enumerate()
        .map(|(number, t)| t.map(|corner| normal(number, corner)))
        .collect()
}

/// The angles of a triangle.
fn angles(corners: [Point3; 3]) -> [f64; 3] {
    std::array::from_fn(|i| {
        let (next, back) = (
            corners[(i + 1) % 3] - corners[i],
            corners[(i + 2) % 3] - corners[i],
        );
        libm::atan2(next.cross(back).length(), next.dot(back))
    })
}

/// The triangles at each corner: those of corner `c` stand from `starts[c]` to `starts[c + 1]`.
pub(super) fn triangles_around(mesh: &Mesh) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0u32; mesh.positions.len() + 1];
    for &corner in mesh.triangles.iter().flatten() {
        starts[corner as usize + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut next = starts.clone();
    let mut around = vec![0u32; 3 * mesh.triangles.len()];
    for (number, triangle) in mesh.triangles.iter().enumerate() {
        for &corner in triangle {
            around[next[corner as usize] as usize] = number as u32;
            next[corner as usize] += 1;
        }
    }
    (starts, around)
}

#[cfg(test)]
mod tests {
    use super::super::tests::tetrahedron;
    use super::*;

    #[test]
    fn creases_are_sharp_and_bends_are_smooth() {
        let mesh = tetrahedron();
        let sharp = corner_normals(&mesh, 0.9);
        assert!(sharp[0].iter().all(|n| *n == Point3::new(0.0, 0.0, -1.0)));
        let smooth = corner_normals(&mesh, -1.0);
        assert_eq!(smooth[0][0], smooth[1][0]);
        assert!(
            smooth
                .iter()
                .flatten()
                .all(|n| (n.length() - 1.0).abs() < 1e-12)
        );
    }

    #[test]
    fn triangles_without_area_have_normals_too() {
        let flat = Mesh {
            positions: vec![Point3::ORIGIN; 3],
            triangles: vec![[0, 1, 2]],
        };
        assert_eq!(
            corner_normals(&flat, 0.5),
            [[Point3::new(0.0, 0.0, 1.0); 3]]
        );
    }
}
