//! `analyses`: whether bodies bear what they must.

use super::side::Side;
use crate::Ref;
use crate::macros::record;
use crate::scalar::PositiveLength;
use crate::types::wants;

record! {
    /// The stresses in a body under a force profile, by finite elements: one for each voxel of the body.
    pub struct Analysis {
        /// The body, or what becomes one by a thickness.
        of: Ref<wants::Body>,
        /// How thick a cutout or a region becomes, which need one, or a surface: without one it is the body that it encloses.
        thickness: Option<PositiveLength>,
        /// On which side of what the cutout lies on, or of the surface, the thickness goes. Without it, the cutout's own `side`, and inside of a surface.
        side: Option<Side>,
        /// What it is made of and what it must bear.
        force_profile: Ref<wants::ForceProfile>,
        /// The side of a voxel. The thinnest wall should be several of them thick.
        voxel: PositiveLength,
    }
}
