//! The analysis of a body of voxels under a force profile.

use super::force_profile::Profile;
use fretwork_action::Action;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::shell::{Statistics, Strength};
use fretwork_geometry::voxel::{Voxel, Voxels};
use fretwork_geometry::{Mesh, Point3};
use fretwork_shell::analyse::{self, Body, Case, Load, MemoryLimit, Model, Stress, Summary};

/// How a body takes its profile.
pub struct Analysed {
    /// The stress of each voxel.
    pub stresses: Vec<Stress>,
    sums: Vec<f64>,
    /// The figures.
    pub strength: Strength,
    /// Whether it sags too far for linear analysis.
    pub is_sag_large: bool,
}

/// Analyses the body `voxels` under a profile, and, where asked, under gravity from all sides.
///
/// # Errors
/// When it cannot be analysed: nothing is held, a part hangs loose, a load misses, there is too much.
pub fn analysed(
    action: &Action,
    voxels: &Voxels,
    profile: &Profile,
    is_swept: bool,
) -> Result<Analysed, Vec<Diagnostic>> {
    let failed = |e: analyse::AnalysisError| {
        vec![Diagnostic::error(e.to_string()).at(action.span(), "analysed here")]
    };
    let body = Body {
        voxels,
        metres_per_unit: action.definition.units.millimetres() * 1e-3,
    };
    let bounds = body.bounds();
    let held = |p: Point3| {
        profile
            .supports
            .iter()
            .any(|zone| zone.contains(p, &bounds))
    };
    let places: Vec<_> = profile
        .loads
        .iter()
        .map(|(zone, force)| (move |p: Point3| zone.contains(p, &bounds), *force))
        .collect();
    let loads: Vec<Load<'_>> = places
        .iter()
        .map(|(at, force)| Load { at, force: *force })
        .collect();
    let model =
        Model::new(&body, &profile.material, &held, MemoryLimit::default()).map_err(failed)?;
    let case = Case {
        gravity: profile.gravity,
        loads: loads.clone(),
    };
    let found = model.analyse(&case).map_err(failed)?;
    let mut strength = strength(&found.summary, voxels.len(), body.metres_per_unit);
    if is_swept {
        let size = Point3::from(profile.gravity).length();
        let sweep = model.sweep(size, &loads).map_err(failed)?;
        let (direction, summary) = &sweep.directions[sweep.worst];
        let p99 = significant(summary.stress_sums.p99);
        strength.worst_gravity = Some((direction.map(significant), p99));
    }
    Ok(Analysed {
        stresses: found.stresses,
        sums: found.stress_sums,
        strength,
        is_sag_large: found.summary.is_sag_large,
    })
}

fn strength(summary: &Summary, elements: usize, metres: f64) -> Strength {
    let distribution = |of: &analyse::Statistics| Statistics {
        mean: significant(of.mean),
        median: significant(of.median),
        p99: significant(of.p99),
        max: significant(of.max),
    };
    let point = |p: Point3| Point3::new(significant(p.x), significant(p.y), significant(p.z));
    let safety = summary.safety;
    Strength {
        elements,
        stress: distribution(&summary.stress_sums),
        von_mises: distribution(&summary.von_mises),
        max_displacement: significant(summary.largest_displacement / metres),
        displacement_at: point(summary.largest_displacement_at),
        mass: significant(summary.mass),
        safety_factor: safety.map_or([f64::MAX; 2], |s| [s.at_p99, s.least].map(significant)),
        weakest_at: safety.map_or(Point3::ORIGIN, |s| point(s.at)),
        residual: significant(summary.residual),
        iterations: summary.iterations,
        worst_gravity: None,
    }
}

/// A number with five significant digits: what is more differs from one processor to another.
fn significant(value: f64) -> f64 {
    format!("{value:.4e}")
        .parse()
        .map_or(value, |v: f64| v + 0.0)
}

impl Analysed {
    /// For each corner of the body's mesh the mean stress of the voxels about it, in Pa.
    pub fn at_corners(&self, mesh: &Mesh, voxels: &Voxels) -> Vec<f32> {
        let of = |p: &Point3| {
            let place = voxels.lattice.place(*p).map(|c| (c - 0.5).floor());
            let around = (0..8u8).filter_map(|corner| {
                let at = |axis: usize| place[axis] + f64::from(corner >> axis & 1);
                let cell: Voxel = [at(0) as u16, at(1) as u16, at(2) as u16];
                voxels.find(cell)
            });
            let (sum, count) = around.fold((0.0, 0u32), |(sum, n), v| (sum + self.sums[v], n + 1));
            (sum / f64::from(count.max(1))) as f32
        };
        mesh.positions.iter().map(of).collect()
    }
}
