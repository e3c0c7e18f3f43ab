//! Finite elements of linear elasticity: wedges of six nodes and bricks of eight, with full integration
//! (Cook 2007, chapters 6 and 7). Where they stand and what they stand for is not known here.

use nalgebra::{DMatrix, Matrix3, SMatrix, Vector3};

use crate::analyse::Material;

/// An element of less than this part of itself elsewhere, or of what it would be if it were straight, is nearly inside out.
const SQUEEZED: f64 = 1e-3;

/// A point, or a vector, in metres.
pub(super) type Vector = Vector3<f64>;

/// What an element does: rows and columns are x, y, z of its first node, then of the next.
#[derive(Clone, Debug)]
pub(super) struct Element {
    /// Forces for displacements, N/m.
    pub stiffness: DMatrix<f64>,
    /// The six stresses xx, yy, zz, xy, xz, yz at the centre for displacements, Pa/m.
    pub stress: DMatrix<f64>,
    /// The part of the volume that hangs at each node, m³.
    pub volumes: Vec<f64>,
}

/// Stresses of strains: Hooke's law, the strains in the order of [`Element::stress`].
fn elasticity(material: &Material) -> DMatrix<f64> {
    let (e, nu) = (material.youngs_modulus, material.poisson_ratio);
    let lambda = e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
    let mu = 0.5 * e / (1.0 + nu);
    DMatrix::from_fn(6, 6, |i, j| match (i, j) {
        (0..3, 0..3) if i == j => lambda + 2.0 * mu,
        (0..3, 0..3) => lambda,
        _ if i == j => mu,
        _ => 0.0,
    })
}

/// The element on `nodes`: a wedge on six (three below, then the three above them), a brick on eight (node
/// c at the corner whose coordinates are the bits of c, the first one lowest). None where it is inside
/// out, or flat, at one of its points of integration.
pub(super) fn element(nodes: &[Vector], material: &Material) -> Option<Element> {
    let is_brick = nodes.len() == 8;
    let gradients = if is_brick {
        brick_gradients
    } else {
        wedge_gradients
    };
    let values = if is_brick { brick_values } else { wedge_values };
    let hooke = elasticity(material);
    let n = 3 * nodes.len();
    let mut stiffness = DMatrix::zeros(n, n);
    let mut volumes = vec![0.0; nodes.len()];
    // A brick may be squeezed at one end, but what is a thousandth of itself elsewhere is nearly inside out. One that is so
    // flat in its middle would have any stress.
    let middle = strain(nodes, &gradients(center(is_brick)))?.1;
    if is_brick && middle < SQUEEZED * straight(nodes) {
        return None;
    }
    let least = SQUEEZED * middle;
    for (point, weight) in points(is_brick) {
        let (b, determinant) = strain(nodes, &gradients(point))?;
        if determinant < least {
            return None;
        }
        stiffness += b.transpose() * &hooke * &b * (weight * determinant);
        for (volume, value) in volumes.iter_mut().zip(values(point)) {
            *volume += value * weight * determinant;
        }
    }
    let (b, _) = strain(nodes, &gradients(center(is_brick)))?;
    Some(Element {
        stiffness,
        stress: hooke * b,
        volumes,
    })
}

/// The volume, as [`strain`] has it, of a straight brick whose sides are as long as those of a brick are in the mean.
fn straight(nodes: &[Vector]) -> f64 {
    let side = |axis: usize| {
        let first = (0..8).filter(|c| c >> axis & 1 == 0);
        let sides = first.map(|c| (nodes[c | 1 << axis] - nodes[c]).norm());
        sides.sum::<f64>() / 8.0
    };
    side(0) * side(1) * side(2)
}

/// The strains for displacements at a point, and the volume of the element there as a part of that of the
/// element of reference. None where that is not positive.
fn strain(nodes: &[Vector], gradients: &[Vector]) -> Option<(DMatrix<f64>, f64)> {
    let jacobian: Matrix3<f64> = nodes
        .iter()
        .zip(gradients)
        .map(|(x, g)| x * g.transpose())
        .sum();
    let determinant = jacobian.determinant();
    let inverse = jacobian.try_inverse().filter(|_| determinant > 0.0)?;
    let mut b = DMatrix::zeros(6, 3 * nodes.len());
    for (a, gradient) in gradients.iter().enumerate() {
        let d = inverse.transpose() * gradient;
        let entries = [
            (0, 0, d.x),
            (1, 1, d.y),
            (2, 2, d.z),
            (3, 0, d.y),
            (3, 1, d.x),
            (4, 0, d.z),
            (4, 2, d.x),
            (5, 1, d.z),
            (5, 2, d.y),
        ];
        for (row, axis, value) in entries {
            b[(row, 3 * a + axis)] = value;
        }
    }
    Some((b, determinant))
}

fn center(is_brick: bool) -> Vector {
    if is_brick {
        Vector::zeros()
    } else {
        Vector::new(1.0 / 3.0, 1.0 / 3.0, 0.0)
    }
}

/// Points of integration with their weights: Gauss's two along each axis, three in a triangle.
fn points(is_brick: bool) -> Vec<(Vector, f64)> {
    let g = (1.0f64 / 3.0).sqrt();
    if is_brick {
        let point = |c: usize| Vector::from_fn(|k, _| if c >> k & 1 == 1 { g } else { -g });
        return (0..8).map(|c| (point(c), 1.0)).collect();
    }
    let triangle = [
        (1.0 / 6.0, 1.0 / 6.0),
        (2.0 / 3.0, 1.0 / 6.0),
        (1.0 / 6.0, 2.0 / 3.0),
    ];
    let column = |(r, s): (f64, f64)| [-g, g].map(|t| (Vector::new(r, s, t), 1.0 / 6.0));
    triangle.into_iter().flat_map(column).collect()
}

/// The factors 1 ± x, 1 ± y, 1 ± z of a brick's corner, and their signs.
fn brick_factors(corner: usize, p: Vector) -> [(f64, f64); 3] {
    [0, 1, 2].map(|k| {
        let sign = if corner >> k & 1 == 1 { 1.0 } else { -1.0 };
        (sign, 1.0 + sign * p[k])
    })
}

fn brick_values(p: Vector) -> Vec<f64> {
    let value = |c| brick_factors(c, p).iter().map(|(_, f)| f).product::<f64>() / 8.0;
    (0..8).map(value).collect()
}

fn brick_gradients(p: Vector) -> Vec<Vector> {
    let gradient = |c| {
        let [(sx, fx), (sy, fy), (sz, fz)] = brick_factors(c, p);
        Vector::new(sx * fy * fz, sy * fx * fz, sz * fx * fy) / 8.0
    };
    (0..8).map(gradient).collect()
}

fn wedge_values(p: Vector) -> Vec<f64> {
    let area = [1.0 - p.x - p.y, p.x, p.y];
    let level = [1.0 - p.z, 1.0 + p.z];
    (0..6).map(|a| area[a % 3] * level[a / 3] / 2.0).collect()
}

fn wedge_gradients(p: Vector) -> Vec<Vector> {
    let area = [1.0 - p.x - p.y, p.x, p.y];
    let slope = [(-1.0, -1.0), (1.0, 0.0), (0.0, 1.0)];
    let gradient = |a: usize| {
        let (sign, (r, s)) = (if a < 3 { -1.0 } else { 1.0 }, slope[a % 3]);
        let level = 1.0 + sign * p.z;
        Vector::new(r * level, s * level, area[a % 3] * sign) / 2.0
    };
    (0..6).map(gradient).collect()
}

/// What stands for a brick that would be inside out, where the surface bends sharply between two pads: bars
/// from each node of its first end (x = -1) to each of its other end, which bend no more than the brick and,
/// like it, do not resist when they are moved as a whole. `area` is the section of all, m². Nodes in one
/// place have no bar.
pub(super) fn bars(nodes: &[Vector], area: f64, material: &Material) -> Element {
    let mut stiffness = DMatrix::zeros(24, 24);
    let mut stress = DMatrix::zeros(6, 24);
    let mut volumes = vec![0.0; 8];
    for (a, b) in [0, 2, 4, 6]
        .into_iter()
        .flat_map(|a| [1, 3, 5, 7].map(|b| (a, b)))
    {
        let along = nodes[b] - nodes[a];
        let length = along.norm();
        if length <= 1e-12 {
            continue;
        }
        let along = along / length;
        let block = along * along.transpose() * (material.youngs_modulus * area / 16.0 / length);
        for (i, j, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
            let mut view = stiffness.view_mut((3 * i, 3 * j), (3, 3));
            view += block * sign;
        }
        for k in 0..3 {
            let pull = along[k] * material.youngs_modulus / 16.0 / length;
            stress[(0, 3 * b + k)] += pull;
            stress[(0, 3 * a + k)] -= pull;
        }
        volumes[a] += area * length / 32.0;
        volumes[b] += area * length / 32.0;
    }
    Element {
        stiffness,
        stress,
        volumes,
    }
}

/// The sum of the sizes of the three principal stresses (Dumas 2015, 5.2.1), Pa.
pub(super) fn principal_sum(stress: &SMatrix<f64, 6, 1>) -> f64 {
    let [xx, yy, zz, xy, xz, yz] = [0, 1, 2, 3, 4, 5].map(|k| stress[k]);
    Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
        .symmetric_eigenvalues()
        .abs()
        .sum()
}
