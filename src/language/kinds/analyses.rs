//! `analyses`: whether bodies that are no shells bear what they must.

use crate::Ref;
use crate::macros::record;
use crate::scalar::PositiveLength;
use crate::types::wants;

record! {
    /// The stresses in a body under a force profile, by finite elements: one for each voxel of the body.
    pub struct Analysis {
        /// The body.
        of: Ref<wants::Solid>,
        /// What it is made of and what it must bear.
        force_profile: Ref<wants::ForceProfile>,
        /// The side of a voxel. The thinnest wall should be several of them thick.
        voxel: PositiveLength,
    }
}
