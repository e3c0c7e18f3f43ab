//! The whole of a shell: its pattern wide enough, as a closed body of one piece, with its measures and its strength.

use std::sync::Arc;

use super::force_profile::profile;
use super::sheet::surface_of;
use super::shell_remarks::{crowded, filled, narrow, sparse, untested};
use super::shell_step::{NAMED, failed, surface_in};
use super::strength::analysed;
use super::verdict::verdict;
use fretwork_action::{Action, Data, StageResult};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::shell::{ShellMeasures, Structure, solid_fraction};
use fretwork_geometry::{Mesh, Shell};
use fretwork_language::kinds::shells::{Shell as Kind, WholeShell, step_of};
use fretwork_primitive::placement::thickness_side;
use fretwork_shell::connect::{Pieces, SurfaceGraph, Touch};
use fretwork_shell::finish::{
    Finished, Thickness, finish, least_width, reasons, rejoined, rim, wide_enough,
};

/// Features are measured up to so many pitches more than the least that was asked for.
const MOST_FEATURE: f64 = 12.0;
/// How wide the bridges are on each side, in pitches, that join a body which fell apart as it was finished: one round
/// after the other.
const REJOINED: [f64; 6] = [1.0, 1.0, 1.5, 1.5, 2.0, 3.0];

/// The voxels of a shell with what is asked of them.
struct Ground<'a> {
    mesh: &'a Mesh,
    graph: &'a SurfaceGraph<'a>,
    /// Where the surface ends.
    rim: Vec<bool>,
    kind: &'a WholeShell,
}

/// The body of a shell.
pub fn whole(action: &Action, kind: &WholeShell) -> StageResult {
    let name = &action.definition.id.name;
    let [voxels, first, held] = Kind::STEPS.map(|step| action.input(&step_of(name, step)));
    let surface = surface_in(&voxels);
    let (first, _) = first.pattern().expect(NAMED);
    let structure = held.structure().expect(NAMED);
    let mesh = surface_of(action, &kind.surface)?;
    let graph = SurfaceGraph::new(surface);
    let ground = Ground {
        rim: rim(&mesh, surface),
        mesh: &mesh,
        graph: &graph,
        kind,
    };
    let (solid, finished) = ground.finished(action, structure)?;
    one_piece(action, &graph, &finished)?;
    let measures = ground.measures(structure, &solid);
    // The analysis needs all the memory that there is.
    drop(ground);
    drop(graph);
    let mut made = Shell {
        measures: ShellMeasures {
            components: finished.pieces,
            exemplar_fraction: action.input(&kind.exemplar).solid_fraction(),
            ..measures
        },
        stress: Vec::new(),
        reasons: reasons(
            surface,
            &finished.mesh,
            [&first.solid, &structure.solid, &solid],
        ),
        mesh: finished.mesh,
    };
    let mut warnings = filled(action, kind, &made.measures);
    warnings.extend(narrow(action, kind, &made.measures));
    warnings.extend(sparse(action, &made.measures));
    warnings.extend(crowded(action, kind, surface));
    warnings.extend(untested(action, kind));
    if let Some(reference) = kind.force_profile.as_ref().filter(|_| kind.analysis) {
        let said = action.input(reference);
        let profile = profile(&said, &made.mesh.bounds());
        let said = said.kind;
        let analysis = analysed(
            action,
            (&finished.voxels, &finished.weights),
            &profile,
            said.sweep.is_some(),
        )?;
        warnings.extend(verdict(action, &said, &profile, &analysis)?);
        made.stress = analysis.at_corners(&made.mesh, &finished.voxels);
        made.measures.strength = Some(analysis.strength);
    }
    Ok((Data::Shell(Arc::new(made)), warnings))
}

impl Ground<'_> {
    /// The body of the pattern, and the solid voxels with the bridges that it has needed to become one piece.
    fn finished(
        &self,
        action: &Action,
        structure: &Structure,
    ) -> Result<(Vec<bool>, Finished), Vec<Diagnostic>> {
        let surface = self.graph.surface;
        let wall = Thickness {
            thickness: self.kind.thickness.0,
            side: thickness_side(self.kind.side),
        };
        let make = |solid: &[bool]| {
            finish(self.mesh, surface, solid, wall).map_err(|e| failed(action, &e))
        };
        let mut solid = self.wide_enough(&structure.solid);
        let mut finished = make(&solid)?;
        for radius in REJOINED {
            let parts = (&finished, wall);
            let Some(joined) = rejoined(self.graph, surface, &solid, parts, radius) else {
                break;
            };
            solid = self.wide_enough(&joined);
            drop(finished);
            finished = make(&solid)?;
        }
        Ok((solid, finished))
    }

    /// The solid voxels with those that narrow features lack.
    fn wide_enough(&self, solid: &[bool]) -> Vec<bool> {
        let of = (self.mesh, self.graph);
        wide_enough(of, (solid, &self.rim), self.kind.min_feature.0)
    }

    /// What can be said of a pattern before it is a body. The least feature is told in hundredths of a voxel.
    fn measures(&self, structure: &Structure, solid: &[bool]) -> ShellMeasures {
        let (asked, pitch) = (self.kind.min_feature.0, self.graph.pitch());
        let range = (asked, asked + MOST_FEATURE * pitch);
        let (width, place) = least_width((self.mesh, self.graph), (solid, &self.rim), range);
        ShellMeasures {
            voxels: solid.len(),
            solid_voxels: solid.iter().filter(|solid| **solid).count(),
            voxel: pitch,
            iterations: structure.iterations,
            is_done: structure.is_done,
            bridges: structure.bridges,
            fraction: [structure.fraction_before, solid_fraction(solid)],
            min_feature: (100.0 * width / pitch).round() / 100.0 * pitch,
            min_feature_at: place,
            ..ShellMeasures::default()
        }
    }
}

/// An error where the body falls apart although the surface does not.
fn one_piece(
    action: &Action,
    graph: &SurfaceGraph,
    finished: &Finished,
) -> Result<(), Vec<Diagnostic>> {
    let parts = Pieces::of(graph, Touch::Corner, |_| true).len();
    if finished.pieces <= parts {
        return Ok(());
    }
    let at = finished.loose[0];
    let message = format!(
        "the shell falls into {} pieces, one near ({:.3}, {:.3}, {:.3})",
        finished.pieces, at.x, at.y, at.z
    );
    let error = Diagnostic::error(message).at(action.span(), "in this shell");
    Err(vec![error.help(
        "choose a higher `resolution`, or a larger `min_feature`",
    )])
}
