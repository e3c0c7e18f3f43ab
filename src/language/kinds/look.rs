//! How a part looks: what parts of artifacts and of assemblies share.

use crate::macros::record;
use crate::scalar::{Color, Fraction};

record! {
    /// How a part looks in GLB and 3MF files and in pictures.
    pub struct Look {
        /// Its colour. Without it, that of its material, else its own.
        color: Option<Color>,
        /// What it is made of. Without it, its own materials.
        material: Option<LookMaterial>,
    }
}

record! {
    /// How a surface takes light.
    pub struct LookMaterial {
        /// The colour, with its opacity (`"#rrggbbaa"`).
        color: Color = "#cccccc",
        /// 1 for a metal, 0 for all else.
        metallic: Fraction = 0,
        /// 0 for a mirror, 1 for chalk.
        roughness: Fraction = 0.8,
    }
}
