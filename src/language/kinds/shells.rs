//! `shells`: pixel patterns on surfaces, that hold together and bear loads.

use super::force_profiles::Zone;
use super::side::Side;
use crate::macros::{kinds, record};
use crate::scalar::{Count, Fraction, NonNegativeLength, PositiveLength, PositiveNumber};
use crate::types::wants;
use crate::value::{Direction, List};
use crate::{Decode, Decoder, Ref, Tree};

record! {
    /// A surface made of voxels that a picture's texture makes solid or empty, in one piece, and strong enough.
    pub struct WholeShell {
        /// The surface; or a cutout or a region, whose filled shape is one: what is wrapped on a surface is that part of it.
        surface: Ref<wants::Sheet>,
        /// The texture.
        exemplar: Ref<wants::RasterExemplar>,
        /// The thickness of the shell.
        thickness: PositiveLength,
        /// Where the shell lies.
        side: Side = "center",
        /// Parts that stay solid: rims and feet.
        keep_solid: List<Zone> = Tree::list([]),
        /// Where the texture's up points on the surface. Without it, as `{ up: [0, 0, 1] }`.
        orientation: Option<Orientation>,
        /// The part of the voxels that start from a label drawn at random, on each level of resolution.
        jitter: Fraction = 0.1,
        /// What it must bear. Without it, it must only hold together.
        force_profile: Option<Ref<wants::ForceProfile>>,
        /// How long a way between two points of the shell may be, as a multiple of the object's extent; larger, fewer bridges.
        geodesic_limit: Option<PositiveNumber>,
        /// The least width of what is solid.
        min_feature: NonNegativeLength = 0,
        /// How many rounds of analysis and repair there may be.
        max_iterations: Count = 30,
        /// The finished body is analysed under the force profile. `false` leaves it out, for a quick look.
        analysis: bool = true,
    }
    /// How fine it is.
    + voxels: VoxelSize
}

/// A shell, or a step on the way to it. The steps of a shell are nodes of their own, so that an edit of
/// what a later step reads leaves the results of earlier ones valid.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Shell {
    /// The whole.
    Whole(WholeShell),
    /// The voxels of its surface.
    Voxels(VoxelsStep),
    /// The first pattern on them.
    Pattern(PatternStep),
    /// The pattern in one piece.
    Structure(StructureStep),
}

/// What the voxels of a shell depend on.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct VoxelsStep {
    /// The surface.
    pub surface: Ref<wants::Sheet>,
    /// How fine they are.
    pub voxels: VoxelSize,
}

/// What the first pattern of a shell depends on.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct PatternStep {
    /// The surface, from whose height zones are measured.
    pub surface: Ref<wants::Sheet>,
    /// The voxels.
    pub voxels: Ref<wants::ShellStep>,
    /// The texture.
    pub exemplar: Ref<wants::RasterExemplar>,
    /// Parts that stay solid.
    pub keep_solid: List<Zone>,
    /// Where the texture's up points.
    pub orientation: Option<Orientation>,
    /// The part of the voxels that start at random.
    pub jitter: Fraction,
    /// The thickness and on which side it lies, where the orientation follows the stress in the wall.
    pub wall: Option<(PositiveLength, Side)>,
}

/// What the structure of a shell depends on.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct StructureStep {
    /// The first pattern, and all that it depends on.
    pub pattern: PatternStep,
    /// Its result.
    pub from: Ref<wants::ShellStep>,
    /// The thickness.
    pub thickness: PositiveLength,
    /// What it must bear.
    pub force_profile: Option<Ref<wants::ForceProfile>>,
    /// How long a way round may be.
    pub geodesic_limit: Option<PositiveNumber>,
    /// How many rounds there may be.
    pub max_iterations: Count,
}

impl Shell {
    /// The names of the steps.
    pub const STEPS: [&str; 3] = ["voxels", "pattern", "structure"];
}

impl WholeShell {
    /// The step `step` of the shell `name`, if there is such a step.
    pub fn step(&self, name: &str, step: &str) -> Option<Shell> {
        match step {
            "voxels" => Some(Shell::Voxels(VoxelsStep {
                surface: self.surface.clone(),
                voxels: self.voxels.clone(),
            })),
            "pattern" => Some(Shell::Pattern(self.pattern_step(name))),
            "structure" => Some(Shell::Structure(StructureStep {
                pattern: self.pattern_step(name),
                from: step_of(name, "pattern"),
                thickness: self.thickness,
                force_profile: self.force_profile.clone(),
                geodesic_limit: self.geodesic_limit,
                max_iterations: self.max_iterations,
            })),
            _ => None,
        }
    }

    fn pattern_step(&self, name: &str) -> PatternStep {
        let is_by_stress = matches!(self.orientation, Some(Orientation::Stress(_)));
        PatternStep {
            surface: self.surface.clone(),
            voxels: step_of(name, "voxels"),
            exemplar: self.exemplar.clone(),
            keep_solid: self.keep_solid.clone(),
            orientation: self.orientation.clone(),
            jitter: self.jitter,
            wall: is_by_stress.then_some((self.thickness, self.side)),
        }
    }
}

/// The reference to a step of the shell `name`. No entry can have such a name.
pub fn step_of(name: &str, step: &str) -> Ref<wants::ShellStep> {
    Ref::new(format!("{name}.{step}"))
}

impl Decode for Shell {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Shell> {
        WholeShell::decode(tree, cx).map(Shell::Whole)
    }
}

impl schemars::JsonSchema for Shell {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        WholeShell::schema_name()
    }

    fn schema_id() -> std::borrow::Cow<'static, str> {
        WholeShell::schema_id()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        WholeShell::json_schema(generator)
    }
}

kinds! {
    /// How fine the voxels are.
    pub enum VoxelSize {
        /// How many voxels there are along the longest side of the surface's bounding box.
        resolution: Resolution(Count),
        /// The side of a voxel.
        voxel: Voxel(PositiveLength),
    }
}

/// Where a texture's up points on a surface.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Orientation {
    /// As near to this direction as the surface allows.
    Up(Direction),
    /// Along the principal stress under this profile.
    Stress(Ref<wants::ForceProfile>),
    /// Along a vector field.
    Field(Ref<wants::Field>),
}

kinds! {
    /// Where a texture's up points.
    pub enum OrientationForm {
        /// As near to this direction as the surface allows.
        up: Up(Direction),
        /// Along the principal stress under this force profile.
        stress: Stress(Ref<wants::ForceProfile>),
    }
}

/// The forms that an orientation has.
const ORIENTATION: &str =
    "`{ up: [0, 0, 1] }`, `{ stress: PROFILE }` or the name of a vector field";

impl Decode for Orientation {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Orientation> {
        if let Tree::Text(_) = tree {
            return Ref::decode(tree, cx).map(Orientation::Field);
        }
        if tree.get("up").is_none() && tree.get("stress").is_none() {
            return cx.mismatch(ORIENTATION, tree);
        }
        match OrientationForm::decode(tree, cx)? {
            OrientationForm::Up(direction) => Some(Orientation::Up(direction)),
            OrientationForm::Stress(profile) => Some(Orientation::Stress(profile)),
        }
    }
}

impl schemars::JsonSchema for Orientation {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Orientation".into()
    }

    fn json_schema(g: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let doc = "Where a texture's up points on a surface: `{ up: [0, 0, 1] }`, `{ stress: PROFILE }`, or a vector field.";
        let forms = [
            g.subschema_for::<OrientationForm>(),
            g.subschema_for::<Ref<wants::Field>>(),
        ];
        schemars::json_schema!({ "description": doc, "anyOf": forms })
    }
}
