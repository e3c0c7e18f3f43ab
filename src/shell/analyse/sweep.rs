//! One body under gravity from all sides.

use super::analysis::{Analysis, Summary};
use super::case::Load;
use super::conjugate_gradients::Solution;
use super::error::AnalysisError;
use super::model::{Forces, Model};
use super::vector::{add, norm};

/// What gravity from fourteen directions does to a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// Each direction, of length one, and how the body takes it.
    pub directions: Vec<([f64; 3], Summary)>,
    /// The number of the direction with the greatest 99th percentile of |σ1| + |σ2| + |σ3|: the first of
    /// them.
    pub worst: usize,
}

/// Directions towards the faces and the corners of a cube.
fn directions() -> impl Iterator<Item = [f64; 3]> {
    let faces = (0..3).flat_map(|axis| {
        [-1.0, 1.0].map(|sign| {
            let mut direction = [0.0; 3];
            direction[axis] = sign;
            direction
        })
    });
    let side = 1.0 / 3f64.sqrt();
    let corners =
        (0..8).map(move |corner| [4, 2, 1].map(|bit| if corner & bit == 0 { -side } else { side }));
    faces.chain(corners)
}

/// A solution, and the length of the forces that it is of.
type Response = (Solution, f64);

impl Model {
    /// Analyses the body under gravity of `acceleration` m/s² in fourteen directions, towards the faces and the
    /// corners of a cube, with `loads` in each of them.
    ///
    /// Displacements are linear in the forces: four solutions, for the axes and for the loads, are
    /// combined to those of all directions. The residual of each combination is worked out.
    ///
    /// # Errors
    /// As [`Model::analyse`].
    pub fn sweep(&self, acceleration: f64, loads: &[Load]) -> Result<Sweep, AnalysisError> {
        let along = |axis: usize| {
            let mut gravity = [0.0; 3];
            gravity[axis] = acceleration;
            gravity
        };
        let mesh = &self.inverse.mesh;
        self.limit
            .check_sweep(mesh.elements.len(), mesh.nodes.len())?;
        let mut responses = Vec::new();
        for axis in 0..3 {
            responses.push(self.solve(&|| self.weight(along(axis)))?);
        }
        let own = || {
            let mut own = self.weight([0.0; 3])?;
            self.add_loads(loads, &mut own)?;
            Ok(own)
        };
        responses.push(self.solve(&own)?);
        let own = own()?;
        let mut swept = Vec::new();
        for direction in directions() {
            let mut forces = self.weight(direction.map(|x| x * acceleration))?;
            add(&mut forces, 1.0, &own);
            swept.push((direction, self.combined(forces, &responses, direction)));
        }
        let measure = |direction: usize| swept[direction].1.stress_sums.p99;
        let worst = (1..swept.len()).fold(0, |worst, direction| {
            match measure(direction) > measure(worst) {
                true => direction,
                false => worst,
            }
        });
        Ok(Sweep {
            directions: swept,
            worst,
        })
    }

    /// The analysis under `forces`, whose displacements are those of the axes, weighted by the
    /// direction, and those of the loads.
    fn combined(&self, mut forces: Forces, responses: &[Response], direction: [f64; 3]) -> Summary {
        let [x, y, z] = direction;
        let mut displacement = vec![[0.0; 4]; forces.len()];
        for ((solution, scale), weight) in responses.iter().zip([x, y, z, 1.0]) {
            add(&mut displacement, weight * scale, &solution.displacement);
        }
        let scale = norm(&forces);
        if scale > 0.0 {
            for x in [&mut forces, &mut displacement] {
                x.iter_mut().flatten().for_each(|x| *x /= scale);
            }
        }
        let iterations = responses.iter().map(|(solution, _)| solution.iterations);
        let iterations = iterations.max().unwrap_or(0);
        let solution = Solution::judged(&self.inverse, &forces, displacement, iterations);
        Analysis::new(&self.inverse.mesh, &self.units, &solution, scale).summary
    }
}
