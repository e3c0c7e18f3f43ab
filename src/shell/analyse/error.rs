//! Why a body has no analysis.

use std::fmt;

use fretwork_geometry::Point3;

/// Why a body cannot be analysed. Places are in units of the lattice.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AnalysisError {
    /// A body without voxels.
    #[error("there is nothing to analyse: the body has no voxels")]
    Empty,
    /// Supports that hold no node.
    #[error("the supports hold no part of the body")]
    NothingSupported,
    /// A load, by its place in the list, that catches no node.
    #[error("load {} catches no part of the body", .load + 1)]
    LoadMisses {
        /// Its number, from 0.
        load: usize,
    },
    /// A constant that no material has, or a size or force that is not finite.
    #[error("{what} cannot be {value}")]
    Value {
        /// What it is.
        what: &'static str,
        /// What was given.
        value: f64,
    },
    /// Parts that can move without strain, at least one; in the order of their first voxels.
    #[error("{}", told(.0))]
    Loose(Vec<LoosePart>),
    /// Refused before the memory was taken.
    #[error(
        "the analysis of {voxels} voxels needs about {} MB, more than {} MB: use larger voxels, or allow for more by \
         `--budget`",
        .bytes.div_ceil(1_000_000),
        .limit / 1_000_000
    )]
    TooLarge {
        /// Voxels of the body.
        voxels: usize,
        /// The estimate.
        bytes: u64,
        /// What is allowed.
        limit: u64,
    },
    /// The system has refused to give the memory.
    #[error("there is not enough memory for the analysis: use larger voxels")]
    OutOfMemory,
    /// A factorization that fails, although nothing moves freely: the constants of the material are
    /// at the edge of what numbers can tell.
    #[error("the stiffness of the body cannot be told from zero")]
    NotDefinite,
    /// The residual stays larger than allowed.
    #[error(
        "the equations are not solved after {iterations} iterations: residual {residual:.1e}, \
         error of the energy {energy_error:.1e}"
    )]
    NotConverged {
        /// How many were made.
        iterations: usize,
        /// The residual force, as a part of the load.
        residual: f64,
        /// The estimated error of the displacement in the energy norm, as a part of its norm.
        energy_error: f64,
    },
}

/// A part of a body that can move without strain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoosePart {
    /// Where it hangs, or the middle of one of its voxels.
    pub at: Point3,
    /// How it hangs.
    pub hold: Hold,
    /// How many voxels it has.
    pub voxels: usize,
}

/// What joins a loose part to the rest of the body and to the supports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hold {
    /// Nothing, or only other parts that nothing holds.
    Nothing,
    /// A corner, about which it can turn.
    Corner,
    /// Edges or corners on one line, about which it can swing.
    Edge,
    /// Several lines or corners, as a link of a chain.
    Chain,
}

impl fmt::Display for LoosePart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let how = match self.hold {
            Hold::Nothing => "is not joined to anything that is held",
            Hold::Corner => "hangs by one corner, about which it can turn",
            Hold::Edge => "hangs by one edge, about which it can swing",
            Hold::Chain => "hangs by edges or corners like a link of a chain",
        };
        let LoosePart { at, voxels, .. } = self;
        let count = match voxels {
            1 => "1 voxel".to_owned(),
            more => format!("{more} voxels"),
        };
        write!(
            f,
            "a part of {count} at ({:.3}, {:.3}, {:.3}) {how}",
            at.x, at.y, at.z
        )
    }
}

fn told(parts: &[LoosePart]) -> String {
    let first = parts.first().map(LoosePart::to_string).unwrap_or_default();
    match parts.len() {
        0 | 1 => first,
        more => format!("{first}, and {} more such parts", more - 1),
    }
}
