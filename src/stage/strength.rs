//! The analysis of a body of voxels under a force profile.

use super::force_profile::{Profile, zone_help};
use fretwork_action::Action;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::shell::{Statistics, Strength, WorstGravity};
use fretwork_geometry::voxel::{Voxel, Voxels};
use fretwork_geometry::{Bounds3, Mesh, Point3};
use fretwork_shell::analyse::{
    self, AnalysisError, Body, Case, Load, MemoryLimit, Model, Stress, Summary, Sweep,
};

/// How a body takes its profile.
pub struct Analysed {
    /// The stress of each voxel.
    pub stresses: Vec<Stress>,
    sums: Vec<f64>,
    /// The figures.
    pub strength: Strength,
    /// Whether it sags too far for linear analysis.
    pub is_sag_large: bool,
    /// The numbers of the loads that do nothing.
    pub idle_loads: Vec<usize>,
}

/// Analyses the body of `voxels`, each of which stands for so much of itself, under a profile, and, where asked, under gravity from all sides.
///
/// # Errors
/// When it cannot be analysed: nothing is held, a part hangs loose, a load misses, there is too much.
pub fn analysed(
    action: &Action,
    (voxels, weights): (&Voxels, &[f32]),
    profile: &Profile,
    is_swept: bool,
) -> Result<Analysed, Vec<Diagnostic>> {
    let body = Body {
        voxels,
        metres_per_unit: action.definition.units.millimetres() * 1e-3,
    };
    let bounds = body.bounds();
    let failed = |error: AnalysisError| vec![told(action, profile, &bounds, &error)];
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
    let model = Model::weighted(
        (&body, weights),
        &profile.material,
        &held,
        MemoryLimit::default(),
    )
    .map_err(failed)?;
    let case = Case {
        gravity: profile.gravity,
        loads,
    };
    let idle_loads = model.idle_loads(&case.loads);
    let (found, sweep) = match is_swept {
        false => (model.analyse(&case).map_err(failed)?, None),
        true => {
            let (found, sweep) = model.sweep(&case).map_err(failed)?;
            (found, Some(sweep))
        }
    };
    let mut strength = strength(&found.summary, voxels.len(), body.metres_per_unit);
    strength.worst_gravity = sweep.as_ref().map(|sweep| {
        worst(
            sweep,
            (profile.gravity, &found.summary),
            body.metres_per_unit,
        )
    });
    let sagging = |summary: &Summary| summary.is_sag_large;
    let is_sag_large = match &sweep {
        None => sagging(&found.summary),
        Some(sweep) => sweep.directions.iter().any(|(_, summary)| sagging(summary)),
    };
    Ok(Analysed {
        stresses: found.stresses,
        sums: found.stress_sums,
        strength,
        is_sag_large,
        idle_loads,
    })
}

/// Why a body with these bounds cannot be analysed, at the support or the load that it is about.
fn told(action: &Action, profile: &Profile, bounds: &Bounds3, error: &AnalysisError) -> Diagnostic {
    let told = Diagnostic::error(error.to_string());
    let told = match error {
        AnalysisError::NothingSupported => profile.at_supports(told).help(zone_help(bounds)),
        AnalysisError::LoadMisses { load } => profile.at_load(*load, told).help(zone_help(bounds)),
        _ => told,
    };
    told.at(action.span(), "analysed here")
}

fn strength(summary: &Summary, elements: usize, metres: f64) -> Strength {
    let distribution = |of: &analyse::Statistics| Statistics {
        mean: significant(of.mean),
        median: significant(of.median),
        p99: significant(of.p99),
        max: significant(of.max),
    };
    let safety = summary.safety;
    Strength {
        elements,
        stress: distribution(&summary.stress_sums),
        von_mises: distribution(&summary.von_mises),
        max_displacement: significant(summary.largest_displacement / metres),
        displacement_at: rounded(summary.largest_displacement_at),
        mass: significant(summary.mass),
        safety_factor: safety.map(|s| [s.at_p99, s.least].map(significant)),
        weakest_at: safety.map(|s| rounded(s.at)),
        residual: significant(summary.residual),
        iterations: summary.iterations,
        worst_gravity: None,
    }
}

/// What is worst of all directions, that of the profile among them.
fn worst(sweep: &Sweep, (gravity, of_case): ([f64; 3], &Summary), metres: f64) -> WorstGravity {
    let size = gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
    let own = gravity.map(|part| if size > 0.0 { part / size } else { 0.0 });
    let swept = sweep.directions.iter().map(|(d, summary)| (*d, summary));
    let mut worst = WorstGravity::default();
    let mut most = f64::NEG_INFINITY;
    for (direction, summary) in swept.chain([(own, of_case)]) {
        let p99 = summary.stress_sums.p99;
        if p99 > most {
            most = p99;
            worst.direction = direction.map(significant);
            worst.p99 = significant(p99);
        }
        let moved = significant(summary.largest_displacement / metres);
        worst.max_displacement = worst.max_displacement.max(moved);
        let Some(safety) = summary.safety else {
            continue;
        };
        let [at_p99, least] = [safety.at_p99, safety.least].map(significant);
        let [before_p99, before] = worst.safety_factor.unwrap_or([f64::INFINITY; 2]);
        if least < before {
            worst.weakest_at = Some(rounded(safety.at));
        }
        worst.safety_factor = Some([before_p99.min(at_p99), before.min(least)]);
    }
    worst
}

/// A number with five significant digits: what is more differs from one processor to another.
fn significant(value: f64) -> f64 {
    format!("{value:.4e}")
        .parse()
        .map_or(value, |v: f64| v + 0.0)
}

fn rounded(p: Point3) -> Point3 {
    Point3::new(significant(p.x), significant(p.y), significant(p.z))
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
