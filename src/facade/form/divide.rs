//! Bodies divided where the facade bends, so that they follow the corners of its curve and not chords
//! across them.

use std::collections::BTreeMap;

use fretwork_geometry::mesh::{Body, Coloring, Mesh};

/// A body in the coordinates of a facade, with its triangles divided along the planes u = `cuts`, which
/// are ascending. Triangles that share a side share the new corners, so that a closed body stays closed.
/// Pictures and colours are divided with them. O(triangles that a cut or what is right of it touches).
pub fn divided(body: Body, cuts: &[f64]) -> Body {
    let mut divider = Divider {
        mesh: Mesh {
            positions: body.mesh.positions,
            triangles: Vec::new(),
        },
        coloring: body.coloring,
        known: BTreeMap::new(),
    };
    let mut pending: Vec<Face> = match &body.uv {
        Some(uv) => body.mesh.triangles.iter().zip(uv).map(textured).collect(),
        None => body.mesh.triangles.iter().map(untextured).collect(),
    };
    let mut done = Vec::new();
    for cut in cuts {
        divider.known.clear();
        for face in std::mem::take(&mut pending) {
            divider.divide(face, *cut, &mut done, &mut pending);
        }
    }
    done.append(&mut pending);
    let done: Vec<[Corner; 3]> = done.iter().flat_map(|face| fan(face)).collect();
    let uv = body
        .uv
        .is_some()
        .then(|| done.iter().map(|t| t.map(|corner| corner.uv)).collect());
    divider.mesh.triangles = done.iter().map(|t| t.map(|corner| corner.at)).collect();
    Body {
        mesh: divider.mesh,
        uv,
        coloring: divider.coloring,
    }
}

/// A corner of a triangle: its number, and its place on the picture.
#[derive(Clone, Copy)]
struct Corner {
    at: u32,
    uv: [f32; 2],
}

/// What is left of a triangle, which is convex. It is not divided into triangles before its last cut: they would
/// all reach to its far corner, and each cut would divide all of them again.
type Face = Vec<Corner>;

fn textured((numbers, uv): (&[u32; 3], &[[f32; 2]; 3])) -> Face {
    let corners = numbers.iter().zip(uv);
    corners
        .map(|(at, uv)| Corner { at: *at, uv: *uv })
        .collect()
}

fn untextured(numbers: &[u32; 3]) -> Face {
    let corners = numbers.iter();
    corners
        .map(|at| Corner {
            at: *at,
            uv: [0.0; 2],
        })
        .collect()
}

struct Divider {
    mesh: Mesh,
    coloring: Option<Coloring>,
    /// The new corners at the present cut, by the two corners that they lie between.
    known: BTreeMap<[u32; 2], u32>,
}

impl Divider {
    /// The part of a face left of the cut goes to `left`, that right of it to `right`.
    fn divide(&mut self, face: Face, cut: f64, left: &mut Vec<Face>, right: &mut Vec<Face>) {
        let u = |corner: &Corner| self.mesh.positions[corner.at as usize].x;
        if face.iter().all(|corner| u(corner) <= cut) {
            return left.push(face);
        }
        if face.iter().all(|corner| u(corner) >= cut) {
            return right.push(face);
        }
        let (mut low, mut high) = (Face::new(), Face::new());
        for (i, corner) in face.iter().enumerate() {
            let next = face[(i + 1) % face.len()];
            let [here, there] = [*corner, next].map(|c| self.mesh.positions[c.at as usize].x);
            if here <= cut {
                low.push(*corner);
            }
            if here >= cut {
                high.push(*corner);
            }
            if (here < cut && cut < there) || (there < cut && cut < here) {
                let middle = self.between(*corner, next, cut);
                low.push(middle);
                high.push(middle);
            }
        }
        left.push(low);
        right.push(high);
    }

    /// The corner at the cut on the side between two corners.
    fn between(&mut self, a: Corner, b: Corner, cut: f64) -> Corner {
        let t = |from: u32, to: u32| {
            let u = |at: u32| self.mesh.positions[at as usize].x;
            (cut - u(from)) / (u(to) - u(from))
        };
        let along = t(a.at, b.at) as f32;
        let uv = std::array::from_fn(|k| a.uv[k] + (b.uv[k] - a.uv[k]) * along);
        let key = [a.at.min(b.at), a.at.max(b.at)];
        let t = t(key[0], key[1]);
        let at = *self.known.entry(key).or_insert_with(|| {
            let ends = key.map(|at| self.mesh.positions[at as usize]);
            let mut point = ends[0].lerp(ends[1], t);
            point.x = cut;
            self.mesh.positions.push(point);
            if let Some(coloring) = &mut self.coloring {
                let colors = key.map(|at| coloring.corners[at as usize]);
                coloring.corners.push(blended(colors, t));
            }
            self.mesh.positions.len() as u32 - 1
        });
        Corner { at, uv }
    }
}

fn blended([a, b]: [[u8; 3]; 2], t: f64) -> [u8; 3] {
    std::array::from_fn(|k| {
        let (a, b) = (f64::from(a[k]), f64::from(b[k]));
        (a + (b - a) * t).round() as u8
    })
}

/// A convex polygon as triangles.
fn fan(corners: &[Corner]) -> impl Iterator<Item = [Corner; 3]> + '_ {
    corners
        .windows(2)
        .skip(1)
        .map(|pair| [corners[0], pair[0], pair[1]])
}

#[cfg(test)]
mod tests {
    use super::super::slab::slab;
    use super::*;
    use fretwork_geometry::Seed;

    #[test]
    fn a_divided_body_stays_closed_and_what_it_was() {
        for round in 0..50 {
            let seed = Seed::root(round).name("divide");
            let cuts = {
                let mut cuts: Vec<f64> = (0..round).map(|n| seed.unit(n) * 1.4 - 0.2).collect();
                cuts.sort_by(f64::total_cmp);
                cuts
            };
            let whole = slab(&[0.0, 1.0], [0.0, 1.0], [0.0, 1.0]).mesh;
            let uv = whole
                .triangles
                .iter()
                .map(|t| whole.corners(*t).map(|p| [p.x as f32, p.y as f32]))
                .collect();
            let body = divided(
                Body {
                    uv: Some(uv),
                    ..Body::plain(whole.clone())
                },
                &cuts,
            );
            assert!((body.mesh.volume() - whole.volume()).abs() < 1e-12);
            assert!((body.mesh.area() - whole.area()).abs() < 1e-12);
            assert_eq!(
                body.mesh.check_closed().map(|t| t.components),
                Ok(1),
                "round {round}"
            );
            for (t, uv) in body.mesh.triangles.iter().zip(body.uv.unwrap()) {
                for (p, uv) in body.mesh.corners(*t).iter().zip(uv) {
                    assert!((p.x as f32 - uv[0]).abs() < 1e-6);
                    assert!((p.y as f32 - uv[1]).abs() < 1e-6);
                }
                let u = body.mesh.corners(*t).map(|p| p.x);
                let crossed = |cut: &&f64| u.iter().any(|u| u < *cut) && u.iter().any(|u| u > *cut);
                assert_eq!(cuts.iter().find(crossed), None);
            }
        }
    }
}
