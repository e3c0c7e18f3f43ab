//! The six rigid motions of a patch: three translations and three turns, linearized.

use super::element::Quad;
use super::mesh::Node;
use super::number::Columns;

/// A combination of six motions.
pub(super) type Motion<T = f64> = [T; 6];

/// The orthonormal motions of a patch, as combinations of the plain ones about its middle.
pub(super) struct RigidBasis {
    center: [f64; 3],
    /// Column j holds the j-th orthonormal motion, or zeros where the nodes allow fewer than six: one node
    /// cannot turn, and nodes on a line cannot turn about it.
    columns: [Motion; 6],
}

/// A motion whose length falls to this part of what it was, squared, depends on those before it.
const DEPENDENT: f64 = 1e-8;

impl RigidBasis {
    /// The motions of these nodes, at least one of them: Gram–Schmidt in the metric of the nodes, twice,
    /// which is as good as exact (Giraud, Langou, Rozložník 2005).
    pub(super) fn new(nodes: impl Iterator<Item = Node> + Clone) -> RigidBasis {
        let count = nodes.clone().count() as f64;
        let mean = |axis: usize| nodes.clone().map(|n| f64::from(n[axis])).sum::<f64>() / count;
        let center = [mean(0), mean(1), mean(2)];
        let mut metric = [[0.0; 6]; 6];
        for node in nodes {
            let motions = plain(node, &center);
            for i in 0..6 {
                for j in 0..6 {
                    metric[i][j] += (0..3).map(|k| motions[i][k] * motions[j][k]).sum::<f64>();
                }
            }
        }
        let product = |a: &Motion, b: &Motion| -> f64 {
            let row = |i: usize| (0..6).map(|j| metric[i][j] * b[j]).sum::<f64>();
            (0..6).map(|i| a[i] * row(i)).sum()
        };
        let mut columns = [[0.0; 6]; 6];
        for j in 0..6 {
            let mut motion = [0.0; 6];
            motion[j] = 1.0;
            for _ in 0..2 {
                for before in &columns[..j] {
                    let part = product(&motion, before);
                    (0..6).for_each(|i| motion[i] -= part * before[i]);
                }
            }
            let square = product(&motion, &motion);
            if metric[j][j] > 0.1 && square > DEPENDENT * metric[j][j] {
                columns[j] = motion.map(|x| x / square.sqrt());
            }
        }
        RigidBasis { center, columns }
    }

    /// Whether the j-th motion is left out.
    pub(super) fn is_void(&self, j: usize) -> bool {
        self.columns[j] == [0.0; 6]
    }

    /// The six orthonormal motions at a node.
    pub(super) fn at(&self, node: Node) -> [Quad<f64>; 6] {
        let motions = plain(node, &self.center);
        self.columns.map(|column| combined(&motions, &column))
    }

    /// The combination of plain motions that is this one of orthonormal motions.
    pub(super) fn to_plain<T: Columns>(&self, motion: &Motion<T>) -> Motion<T> {
        std::array::from_fn(|i| sum(|j| motion[j].scaled(self.columns[j][i])))
    }

    /// The products with orthonormal motions, of those with plain ones.
    pub(super) fn of_plain<T: Columns>(&self, products: &Motion<T>) -> Motion<T> {
        self.columns
            .map(|column| sum(|i| products[i].scaled(column[i])))
    }

    /// What a combination of plain motions moves a node by.
    #[inline]
    pub(super) fn moved<T: Columns, const D: usize>(
        &self,
        node: Node,
        motion: &Motion<T>,
    ) -> [T; D] {
        let plain = plain(node, &self.center);
        let mut moved = [T::default(); D];
        for (k, along) in moved.iter_mut().take(3).enumerate() {
            *along = sum(|j| motion[j].scaled(plain[j][k]));
        }
        moved
    }

    /// Adds the products of plain motions with a vector at a node.
    #[inline]
    pub(super) fn add_products<T: Columns, const D: usize>(
        &self,
        node: Node,
        v: [T; D],
        products: &mut Motion<T>,
    ) {
        let motions = plain(node, &self.center);
        for (sum, motion) in products.iter_mut().zip(&motions) {
            *sum += v[0].scaled(motion[0]) + v[1].scaled(motion[1]) + v[2].scaled(motion[2]);
        }
    }
}

/// The sum of six terms.
#[inline]
fn sum<T: Columns>(term: impl Fn(usize) -> T) -> T {
    (1..6).fold(term(0), |sum, j| sum + term(j))
}

/// Translations along x, y, z and turns about them at a node.
#[inline]
fn plain(node: Node, center: &[f64; 3]) -> [Quad<f64>; 6] {
    let [x, y, z] = [0, 1, 2].map(|k| f64::from(node[k]) - center[k]);
    [
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
        [0.0, -z, y, 0.0],
        [z, 0.0, -x, 0.0],
        [-y, x, 0.0, 0.0],
    ]
}

#[inline]
fn combined(motions: &[Quad<f64>; 6], weights: &Motion) -> Quad<f64> {
    std::array::from_fn(|k| (0..6).map(|j| motions[j][k] * weights[j]).sum())
}
