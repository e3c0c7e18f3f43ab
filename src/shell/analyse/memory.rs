//! What an analysis will take, before it takes it.

use fretwork_geometry::budget;

use super::error::AnalysisError;

/// The bytes of an analysis that grow with its nodes: eight vectors of double and two of single precision, and what
/// the mesh and the patches keep.
const BYTES_A_NODE: u64 = 8 * 32 + 2 * 16 + 28;

/// The vectors more that a sweep has at once: the solutions of the other axes, and the forces of the loads.
const SWEEP: u64 = 4 * 32;

/// The bytes of a node while four load cases are solved together: eight vectors of double and two of single
/// precision for each, the forces of one by themselves, and what the mesh and the patches keep.
const BYTES_A_NODE_TOGETHER: u64 = 8 * 96 + 2 * 48 + 32 + 28;

/// The bytes that grow with its voxels while equations are solved, and those of the result, when most vectors are
/// gone again.
const BYTES_A_VOXEL: [u64; 2] = [20, 20 + 12 * 8];
const BYTES_A_NODE_AFTERWARDS: u64 = 32 + 28;

/// At most this much memory is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MemoryLimit(pub u64);

impl Default for MemoryLimit {
    /// Two gibibytes, about three million voxels of a thin shell; as many times as much as the budget allows.
    fn default() -> MemoryLimit {
        MemoryLimit(((2u64 << 30) as f64 * budget::factor()) as u64)
    }
}

impl MemoryLimit {
    /// Refuses a body whose voxels alone, with hardly more nodes than voxels, would not fit.
    ///
    /// # Errors
    /// That it is too large, with an estimate.
    pub fn check_voxels(self, voxels: usize) -> Result<(), AnalysisError> {
        // While nodes are sought, all eight corners of each voxel are there.
        let corners = voxels as u64 * 8 * 12;
        self.check(voxels, corners.max(vectors(voxels, voxels)))
    }

    /// Refuses a factor of `values` numbers beside the vectors of a body.
    pub(super) fn check_factor(
        self,
        voxels: usize,
        nodes: usize,
        values: u64,
    ) -> Result<(), AnalysisError> {
        self.check(voxels, vectors(voxels, nodes) + values * 8)
    }

    /// Refuses the sweep of a body whose single load case fits, beside a factor of so many bytes.
    pub(super) fn check_sweep(
        self,
        voxels: usize,
        nodes: usize,
        factor: u64,
    ) -> Result<(), AnalysisError> {
        self.check(
            voxels,
            vectors(voxels, nodes) + nodes as u64 * SWEEP + factor,
        )
    }

    /// Whether four load cases of a body can be solved together, beside a factor of so many bytes.
    pub(super) fn fits_together(self, voxels: usize, nodes: usize, factor: u64) -> bool {
        let [meanwhile, _] = BYTES_A_VOXEL;
        let bytes = voxels as u64 * meanwhile + nodes as u64 * BYTES_A_NODE_TOGETHER + factor;
        self.check(voxels, bytes).is_ok()
    }

    fn check(self, voxels: usize, bytes: u64) -> Result<(), AnalysisError> {
        // Nodes and elements have numbers of 32 bits, and a voxel has at most eight nodes.
        if bytes > self.0 || voxels >= (u32::MAX / 8) as usize {
            return Err(AnalysisError::TooLarge {
                voxels,
                bytes,
                limit: self.0,
            });
        }
        budget::hold("the equations of an analysis", 1, bytes as usize);
        Ok(())
    }
}

fn vectors(voxels: usize, nodes: usize) -> u64 {
    let (voxels, nodes) = (voxels as u64, nodes as u64);
    let [meanwhile, afterwards] = BYTES_A_VOXEL;
    let solving = voxels * meanwhile + nodes * BYTES_A_NODE;
    solving.max(voxels * afterwards + nodes * BYTES_A_NODE_AFTERWARDS)
}
