//! What an analysis will take, before it takes it.

use super::error::AnalysisError;

/// The bytes of an analysis that grow with its nodes: eleven vectors of double and four of single
/// precision, as a sweep has them at once, and what the mesh keeps. One load case takes two vectors less.
const BYTES_A_NODE: u64 = 11 * 32 + 4 * 16 + 64;

/// The bytes that grow with its voxels: the mesh, the stresses and displacements of one load case.
const BYTES_A_VOXEL: u64 = 16 + 12 * 8;

/// At most this much memory is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MemoryLimit(pub u64);

impl Default for MemoryLimit {
    /// Four gibibytes, about five million voxels of a thin shell.
    fn default() -> MemoryLimit {
        MemoryLimit(4 << 30)
    }
}

impl MemoryLimit {
    /// Refuses a body whose voxels alone, with hardly more nodes than voxels, would not fit.
    pub(super) fn check_voxels(self, voxels: usize) -> Result<(), AnalysisError> {
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

    fn check(self, voxels: usize, bytes: u64) -> Result<(), AnalysisError> {
        // Nodes and elements have numbers of 32 bits, and a voxel has at most eight nodes.
        if bytes > self.0 || voxels >= (u32::MAX / 8) as usize {
            return Err(AnalysisError::TooLarge {
                voxels,
                bytes,
                limit: self.0,
            });
        }
        Ok(())
    }
}

fn vectors(voxels: usize, nodes: usize) -> u64 {
    voxels as u64 * BYTES_A_VOXEL + nodes as u64 * BYTES_A_NODE
}
