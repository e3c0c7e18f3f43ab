//! Union, intersection and difference of solids, by the `manifold-rust` crate. Only this file names it.

use manifold_rust::manifold::Manifold;
use manifold_rust::types::{BooleanEngine, Error, MeshGL64, OpType};

use super::SolidError;
use super::films::{Meeting, moved_through};
use super::parts::{groups, parts};
use fretwork_geometry::budget;
use fretwork_geometry::mesh::{Surface, charge_for_meetings};
use fretwork_geometry::progress::step;
use fretwork_geometry::{Mesh, Point3};

/// How solids are combined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// What is in any of them.
    Union,
    /// What is in all of them.
    Intersection,
    /// What is in the first and in none of the others.
    Difference,
}

/// The combination of closed meshes, from the first to the last. A mesh may have several bodies; where they overlap, what is
/// inside any is inside. Equal input gives equal output, whatever the number of threads.
///
/// All that is united or taken away is put together first, and exact work is done only where parts meet (see
/// `parts`): bodies that are apart are one operand as they are.
///
/// # Errors
/// An operand that is not closed, or nothing that is left.
///
/// ```
/// use fretwork_geometry::{Affine3, Point3};
/// use fretwork_solid::{Operation, combine, cuboid};
/// let cube = cuboid(Point3::new(2.0, 2.0, 2.0)).unwrap();
/// let moved = cube.transformed(&Affine3::translation(Point3::new(1.0, 1.0, 1.0)));
/// let rest = combine(Operation::Difference, &[cube, moved]).unwrap();
/// assert!((rest.volume() - 7.0).abs() < 1e-12);
/// ```
pub fn combine(operation: Operation, meshes: &[Mesh]) -> Result<Mesh, SolidError> {
    meshes
        .iter()
        .try_for_each(|mesh| mesh.check_closed().map(|_| ()))?;
    let triangles = meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    budget::hold(WORK, triangles, TRIANGLE);
    budget::spend(WORK, CLEAN_STEPS * triangles as u64);
    let (first, rest) = meshes.split_first().ok_or(SolidError::Nothing)?;
    let result = match operation {
        Operation::Union => united(meshes)?,
        Operation::Difference if rest.is_empty() => united(std::slice::from_ref(first))?,
        Operation::Difference => {
            let whole = united(std::slice::from_ref(first))?;
            let taken = united(rest)?;
            step(|| {
                let [of, from] = [&taken, &whole].map(|operand| operand.body.num_tri());
                format!("taking a body of {of} triangles out of one of {from}")
            });
            whole.combined(OpType::Subtract, &taken)?
        }
        Operation::Intersection => {
            let whole = united(std::slice::from_ref(first))?;
            rest.iter().enumerate().try_fold(whole, |all, (i, next)| {
                step(|| format!("intersecting bodies, {} of {}", i + 2, meshes.len()));
                all.combined(OpType::Intersect, &united(std::slice::from_ref(next))?)
            })?
        }
    };
    if result.body.num_tri() == 0 {
        return Err(SolidError::Nothing);
    }
    let mesh = without_specks(mesh_of(&result.body));
    mesh.check_closed()?;
    Ok(mesh)
}

/// The union of closed meshes whose faces may lie nearly on one another. It is always computed in
/// rational numbers: the fast engine leaves corners there that are so near to one another that files of
/// 32-bit floats do not tell them apart.
///
/// # Errors
/// An operand that is not closed, or nothing that is left.
pub fn unite_touching(meshes: &[Mesh]) -> Result<Mesh, SolidError> {
    let operand = |mesh: &Mesh| -> Result<Operand, SolidError> {
        mesh.check_closed()?;
        let body = manifold(mesh)?;
        Ok(Operand {
            body,
            is_clean: false,
        })
    };
    let (first, rest) = meshes.split_first().ok_or(SolidError::Nothing)?;
    let whole = rest.iter().try_fold(operand(first)?, |all, next| {
        all.combined(OpType::Add, &operand(next)?)
    })?;
    let mesh = without_specks(mesh_of(&whole.body));
    mesh.check_closed()?;
    Ok(mesh)
}

/// Parts below this share of the whole volume are what rounding leaves where faces lie on one another.
const SPECK: f64 = 1e-9;

/// The mesh without bodies and cavities that have no volume to speak of.
fn without_specks(mesh: Mesh) -> Mesh {
    let parts = mesh.components();
    let least = SPECK * parts.iter().map(|part| part.volume().abs()).sum::<f64>();
    if parts.iter().all(|part| part.volume().abs() > least) {
        return mesh;
    }
    let mut rest = Mesh::default();
    parts
        .iter()
        .filter(|part| part.volume().abs() > least)
        .for_each(|part| rest.append(part));
    rest
}

/// How deep a surface may pass through itself, as a part of its size, and still count as clean. What was cut before has corners
/// that were rounded, by about 1e-15 of the size and more where faces meet at small angles; with less depth such a body
/// takes the exact engine's hundredfold time, with more a real overlap might be taken for rounding.
const CLEAN: f64 = 1e-9;

/// What is charged for, and the bytes that a triangle takes while solids are combined.
const WORK: &str = "triangles to be combined";
const TRIANGLE: usize = 500;

/// Steps for a triangle that is combined by the fast engine and by the exact one.
const CLEAN_STEPS: u64 = 300;
const EXACT_STEPS: u64 = 30_000;

/// Steps for a pair of triangles whose boxes meet.
const PAIR_STEPS: u64 = 50;

/// A body as the library has it.
struct Operand {
    body: Manifold,
    /// Whether its surface does not overlap itself, so that the fast engine gets it right.
    is_clean: bool,
}

impl Operand {
    fn new(mesh: &Mesh) -> Result<Operand, SolidError> {
        step(|| {
            let count = mesh.triangles.len();
            format!("looking whether {count} triangles pass through one another")
        });
        let depth = CLEAN * mesh.bounds().longest_side();
        Ok(Operand {
            is_clean: !Surface::new(mesh).overlaps_itself(depth),
            body: manifold(mesh)?,
        })
    }

    /// The combination of two bodies. The library's engine of floating-point numbers decides degenerate cases by symbolic
    /// perturbation, and what it makes of clean bodies is clean; its engine of rational numbers takes bodies that
    /// overlap themselves.
    fn combined(&self, kind: OpType, other: &Operand) -> Result<Operand, SolidError> {
        let is_clean = self.is_clean && other.is_clean;
        let triangles = (self.body.num_tri() + other.body.num_tri()) as u64;
        let steps = if is_clean { CLEAN_STEPS } else { EXACT_STEPS };
        budget::spend(WORK, steps * triangles);
        let [one, another] = [self, other].map(|operand| mesh_of(&operand.body));
        charge_for_meetings(&one, &another, PAIR_STEPS);
        let meeting = match kind {
            OpType::Subtract => Some(Meeting::Taken),
            OpType::Add => Some(Meeting::Added),
            OpType::Intersect => None,
        };
        let moved = meeting.and_then(|meeting| moved_through(&one, &another, meeting));
        let moved = moved.map(|mesh| manifold(&mesh)).transpose()?;
        let other = moved.as_ref().unwrap_or(&other.body);
        let engine = if is_clean {
            BooleanEngine::Exact
        } else {
            BooleanEngine::Robust
        };
        let body = checked(self.body.boolean_with_engine(other, kind, engine))?;
        Ok(Operand {
            body,
            is_clean: true,
        })
    }
}

/// All bodies of some meshes as one operand: those that meet are united in pairs, and the pairs again; the others are
/// put side by side.
fn united(meshes: &[Mesh]) -> Result<Operand, SolidError> {
    let parts = parts(meshes);
    if let [mesh] = &parts[..] {
        return Operand::new(mesh);
    }
    let mut whole = Mesh::default();
    for group in groups(&parts) {
        match group[..] {
            [one] => whole.append(&parts[one]),
            _ => whole.append(&mesh_of(&tree(&parts, &group)?.body)),
        }
    }
    Operand::new(&whole)
}

/// The union of parts as a balanced tree: each corner goes through log n unions instead of n.
fn tree(parts: &[Mesh], group: &[usize]) -> Result<Operand, SolidError> {
    match *group {
        [one] => Operand::new(&parts[one]),
        _ => {
            let (low, high) = group.split_at(group.len() / 2);
            let (low, high) = (tree(parts, low)?, tree(parts, high)?);
            step(|| format!("uniting {} of {} bodies", group.len(), parts.len()));
            low.combined(OpType::Add, &high)
        }
    }
}

fn manifold(mesh: &Mesh) -> Result<Manifold, SolidError> {
    let input = MeshGL64 {
        num_prop: 3,
        vert_properties: mesh
            .positions
            .iter()
            .flat_map(|p| [p.x, p.y, p.z])
            .collect(),
        tri_verts: mesh
            .triangles
            .iter()
            .flatten()
            .map(|corner| u64::from(*corner))
            .collect(),
        ..MeshGL64::default()
    };
    checked(Manifold::from_mesh_gl64_robust(&input))
}

fn checked(manifold: Manifold) -> Result<Manifold, SolidError> {
    match manifold.status() {
        Error::NoError => Ok(manifold),
        error => Err(SolidError::Combination(format!("{error:?}"))),
    }
}

fn mesh_of(manifold: &Manifold) -> Mesh {
    let output = manifold.get_mesh_gl64(-1);
    let width = output.num_prop as usize;
    let positions = output.vert_properties.chunks_exact(width.max(3));
    let corner = |v: u64| v as u32;
    Mesh {
        positions: positions
            .map(|p| Point3::new(p[0] + 0.0, p[1] + 0.0, p[2] + 0.0))
            .collect(),
        triangles: output
            .tri_verts
            .chunks_exact(3)
            .map(|t| [corner(t[0]), corner(t[1]), corner(t[2])])
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::{ball, cuboid, cylinder, extrude};
    use super::*;
    use fretwork_geometry::mesh::revolve;
    use fretwork_geometry::{Affine3, Point, Polygon};

    fn cube(side: f64, at: [f64; 3]) -> Mesh {
        cuboid(Point3::new(side, side, side))
            .unwrap()
            .transformed(&Affine3::translation(at.into()))
    }

    fn volume(operation: Operation, meshes: &[Mesh]) -> f64 {
        let mesh = combine(operation, meshes).unwrap();
        assert_eq!(mesh, combine(operation, meshes).unwrap());
        mesh.volume()
    }

    #[test]
    fn specks_are_no_bodies() {
        let mut mesh = cube(10.0, [0.0; 3]);
        mesh.append(&cube(1e-4, [20.0; 3]));
        assert_eq!(
            without_specks(mesh.clone()).bounds(),
            cube(10.0, [0.0; 3]).bounds()
        );
        mesh.append(&cube(0.1, [30.0; 3]));
        assert_eq!(without_specks(mesh).components().len(), 2);
    }

    #[test]
    fn cubes_are_combined_exactly() {
        let pair = [cube(2.0, [0.0; 3]), cube(2.0, [1.0; 3])];
        for (operation, expected) in [
            (Operation::Union, 15.0),
            (Operation::Intersection, 1.0),
            (Operation::Difference, 7.0),
        ] {
            assert!((volume(operation, &pair) - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn faces_that_lie_on_one_another_are_joined() {
        let stack = [
            cube(2.0, [0.0; 3]),
            cube(2.0, [2.0, 0.0, 0.0]),
            cube(1.0, [0.0, 0.0, 2.0]),
        ];
        let union = combine(Operation::Union, &stack).unwrap();
        assert_eq!(union.topology().components, 1);
        assert!((union.volume() - 17.0).abs() < 1e-12);
        let same = [cube(2.0, [0.0; 3]), cube(2.0, [0.0; 3])];
        assert!((volume(Operation::Union, &same) - 8.0).abs() < 1e-12);
        assert_eq!(
            combine(Operation::Difference, &same),
            Err(SolidError::Nothing)
        );
        assert_eq!(
            combine(
                Operation::Intersection,
                &[cube(1.0, [0.0; 3]), cube(1.0, [5.0; 3])]
            ),
            Err(SolidError::Nothing)
        );
    }

    #[test]
    fn a_drilled_ball_has_a_handle() {
        let drill = cylinder(1.0, 10.0, 48)
            .unwrap()
            .transformed(&Affine3::translation(Point3::new(0.0, 0.0, -5.0)));
        let bead = combine(Operation::Difference, &[ball(3.0, 96).unwrap(), drill]).unwrap();
        let topology = bead.check_closed().unwrap();
        assert_eq!((topology.components, topology.genus), (1, Some(1)));
        // The bead's volume depends on its height alone: pi·h³/6.
        let height = 2.0 * 8f64.sqrt();
        assert!((bead.volume() / (std::f64::consts::PI * height.powi(3) / 6.0) - 1.0).abs() < 5e-3);
    }

    #[test]
    fn bodies_of_one_operand_may_overlap() {
        let mut cross = cube(2.0, [0.0; 3]);
        cross.append(&cube(2.0, [1.0, 0.0, 0.0]));
        assert!((volume(Operation::Union, std::slice::from_ref(&cross)) - 12.0).abs() < 1e-12);
        assert!(
            (volume(Operation::Difference, &[cube(6.0, [-1.0; 3]), cross]) - 204.0).abs() < 1e-9
        );
    }

    #[test]
    fn a_hollow_body_keeps_its_cavity() {
        let mut hollow = cube(4.0, [0.0; 3]);
        hollow = combine(Operation::Difference, &[hollow, cube(2.0, [1.0; 3])]).unwrap();
        assert_eq!((hollow.topology().components, hollow.volume()), (2, 56.0));
        // And goes on being one operand.
        let again = combine(Operation::Intersection, &[hollow, cube(2.0, [0.0; 3])]).unwrap();
        assert!((again.volume() - 7.0).abs() < 1e-12);
    }

    #[test]
    fn many_cuts_agree_with_areas_in_the_plane() {
        // A plate with a grid of turned holes, cut in space and in the plane.
        let ring = |x: f64, y: f64, r: f64, n: u32, turn: f64| -> Vec<Point> {
            (0..n)
                .map(|i| {
                    Point::new(x, y)
                        + Point::unit(turn + std::f64::consts::TAU * f64::from(i) / f64::from(n))
                            * r
                })
                .collect()
        };
        let plate = vec![Polygon {
            outer: ring(0.0, 0.0, 10.0, 64, 0.1),
            holes: vec![],
        }];
        let holes: Vec<Polygon> = (0..25)
            .map(|i| Polygon {
                outer: ring(
                    f64::from(i % 5 * 4 - 8),
                    f64::from(i / 5 * 4 - 8),
                    1.7,
                    17,
                    f64::from(i),
                ),
                holes: vec![],
            })
            .collect();
        let flat = fretwork_geometry::polygon::subtract(&plate, &holes).unwrap();
        let area: f64 = flat.iter().map(Polygon::area).sum();
        let cut = [
            extrude(&plate, 0.0, 2.0).unwrap(),
            extrude(&holes, -1.0, 3.0).unwrap(),
        ];
        let solid = combine(Operation::Difference, &cut).unwrap();
        assert!(
            (solid.volume() - 2.0 * area).abs() < 1e-6,
            "{} {}",
            solid.volume(),
            2.0 * area
        );
        let (planar, spatial) = (
            extrude(&flat, 0.0, 2.0).unwrap().topology(),
            solid.topology(),
        );
        assert_eq!(
            (planar.components, planar.genus),
            (spatial.components, spatial.genus)
        );
    }

    #[test]
    fn open_operands_are_refused() {
        let open = revolve(&[Point::new(1.0, 0.0), Point::new(2.0, 1.0)], false, 9).unwrap();
        assert!(matches!(
            combine(Operation::Union, &[open]),
            Err(SolidError::Mesh(_))
        ));
        assert_eq!(combine(Operation::Union, &[]), Err(SolidError::Nothing));
    }
}
