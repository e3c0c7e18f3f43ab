//! Small bodies put together as whole matrices and solved directly.

use fretwork_geometry::voxel::Voxels;
use fretwork_geometry::{Point3, Seed};
use nalgebra::{DMatrix, DVector, SMatrix};
use nalgebra_sparse::factorization::CscCholesky;
use nalgebra_sparse::{CooMatrix, CscMatrix};

use super::super::element::{Corners, Quad, Stiffness, lame};
use super::super::mesh::corners;
use super::super::model::Forces;
use super::super::{Case, Load, MemoryLimit, Model};
use super::{ABS, is_near, millimetres, on_floor, random_body, set};

/// The stiffness of an element by 2 × 2 × 2 points of integration.
fn element_matrix(poisson_ratio: f64) -> DMatrix<f64> {
    let (lambda, mu) = lame(poisson_ratio);
    let elasticity = SMatrix::<f64, 6, 6>::from_fn(|i, k| match (i, k) {
        _ if i == k && i < 3 => lambda + 2.0 * mu,
        _ if i < 3 && k < 3 => lambda,
        _ if i == k => mu,
        _ => 0.0,
    });
    let mut matrix = DMatrix::zeros(24, 24);
    for point in 0..8 {
        let at = [4, 2, 1].map(|bit| match point & bit == 0 {
            true => 0.5 - 0.5 / 3f64.sqrt(),
            false => 0.5 + 0.5 / 3f64.sqrt(),
        });
        let mut strain = DMatrix::zeros(6, 24);
        for corner in 0..8 {
            let is_high = [4, 2, 1].map(|bit| corner & bit != 0);
            let value = |k: usize| if is_high[k] { at[k] } else { 1.0 - at[k] };
            let slope = |k: usize| if is_high[k] { 1.0 } else { -1.0 };
            let g: [f64; 3] =
                std::array::from_fn(|k| slope(k) * value((k + 1) % 3) * value((k + 2) % 3));
            for k in 0..3 {
                strain[(k, 3 * corner + k)] = g[k];
            }
            for (row, (i, k)) in [(3, (0, 1)), (4, (0, 2)), (5, (1, 2))] {
                strain[(row, 3 * corner + i)] = g[k];
                strain[(row, 3 * corner + k)] = g[i];
            }
        }
        matrix += strain.transpose() * elasticity * strain / 8.0;
    }
    matrix
}

/// The matrix of a model, clamped unknowns held by ones.
fn whole_matrix(model: &Model) -> CscMatrix<f64> {
    let mesh = &model.inverse.mesh;
    let own = element_matrix(ABS.poisson_ratio);
    let size = 3 * mesh.nodes.len();
    let mut whole = CooMatrix::new(size, size);
    for element in &mesh.elements {
        let nodes = corners(element);
        for (i, k) in (0..24).flat_map(|i| (0..24).map(move |k| (i, k))) {
            let (a, b) = (nodes[i / 3], nodes[k / 3]);
            if !mesh.is_clamped[a] && !mesh.is_clamped[b] {
                whole.push(3 * a + i % 3, 3 * b + k % 3, own[(i, k)]);
            }
        }
    }
    for node in &mesh.clamped {
        let first = 3 * *node as usize;
        (first..first + 3).for_each(|i| whole.push(i, i, 1.0));
    }
    CscMatrix::from(&whole)
}

fn to_dense(x: &[Quad<f64>]) -> DVector<f64> {
    DVector::from_iterator(3 * x.len(), x.iter().flat_map(|u| [u[0], u[1], u[2]]))
}

/// The error of a model's displacements by the direct solution, in the energy norm and in the largest
/// displacement, and the error that it estimates.
fn errors(model: &Model, forces: Forces) -> [f64; 3] {
    let matrix = whole_matrix(model);
    let right = to_dense(&forces);
    let exact = CscCholesky::factor(&matrix).unwrap().solve(&right);
    let exact = exact.column(0).into_owned();
    let found = model.solve(&|| Ok(forces.clone())).unwrap();
    let error = to_dense(&found.displacement) * found.scale - &exact;
    let energy = |u: &DVector<f64>| u.dot(&(&matrix * u)).abs().sqrt();
    [
        energy(&error) / energy(&exact),
        error.amax() / exact.amax(),
        found.quality.energy_error,
    ]
}

fn model(voxels: &Voxels, supports: fn(Point3) -> bool) -> Model {
    Model::new(
        &millimetres(voxels),
        &ABS,
        &supports,
        MemoryLimit::default(),
    )
    .unwrap()
}

#[test]
fn the_element_agrees_with_its_integral() {
    for nu in [-0.4, 0.0, 0.2, 0.35, 0.49] {
        let matrix = element_matrix(nu);
        let stiffness = Stiffness::<f64>::new(nu);
        for column in 0..24 {
            let mut u: Corners<f64> = [[0.0; 4]; 8];
            u[column / 3][column % 3] = 1.0;
            let forces = stiffness.forces(u);
            for row in 0..24 {
                let found = forces[row / 3][row % 3];
                let expected = matrix[(row, column)];
                assert!(
                    (found - expected).abs() < 1e-13 * matrix.amax(),
                    "{nu}: {row}, {column}"
                );
            }
        }
    }
}

#[test]
fn random_bodies_agree_with_a_direct_solution() {
    for case in 0..12 {
        let seed = Seed::root(case);
        let voxels = random_body(seed);
        let model = model(&voxels, on_floor);
        let highest = model.units.lattice.point([0.0, 0.0, 3.0]).z;
        let is_high = move |p: Point3| p.z >= highest;
        let some = |n: u64| 2.0 * seed.unit(900 + n) - 1.0;
        let force = [some(0), some(1), some(2)];
        let mut forces = model.weight([some(3), some(4), some(5)]).unwrap();
        let loads = [Load {
            at: &is_high,
            force,
        }];
        if voxels.cells.iter().any(|cell| cell[2] >= 2) {
            model.add_loads(&loads, &mut forces).unwrap();
        }
        let [energy, largest, estimate] = errors(&model, forces);
        assert!(
            energy < 2e-6 && largest < 1e-5,
            "{case}: {energy} {largest}"
        );
        // The two norms are equivalent: the quotient lies where the eigenvalues of the
        // preconditioned matrix do, in a small interval around one.
        assert!(
            (0.3..3.0).contains(&(estimate / energy)),
            "{case}: {estimate} for {energy}"
        );
    }
}

/// Three hinges not in one plane hold two links, though each of them would swing alone.
#[test]
fn hinges_that_hold_one_another_are_solved() {
    let voxels = set(super::mechanisms::links());
    let model = model(&voxels, super::mechanisms::is_at_the_ends);
    let forces = model.weight([1.0, 2.0, -9.81]).unwrap();
    let [energy, largest, _] = errors(&model, forces);
    assert!(energy < 1e-5 && largest < 1e-4, "{energy} {largest}");
}

/// A load that is weak beyond single precision has the same displacements, but for their size.
#[test]
fn displacements_are_linear_in_the_load() {
    let voxels = random_body(Seed::root(77));
    let model = model(&voxels, on_floor);
    let of = |gravity: f64| {
        let case = Case {
            gravity: [0.0, gravity, 0.0],
            loads: Vec::new(),
        };
        model.analyse(&case).unwrap().summary.largest_displacement
    };
    assert!(is_near(of(1e-25), 1e-25 * of(1.0), 1e-9));
    assert_eq!(of(0.0), 0.0);
}
