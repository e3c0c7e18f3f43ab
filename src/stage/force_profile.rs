//! Force profiles as the room of shells takes them: materials in SI units, zones that know what they
//! are measured from; and where the spec says all that.

use std::sync::Arc;

use fretwork_action::{Definition, Described};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Bounds3, Point3};
use fretwork_language::kinds::force_profiles::{
    ForceProfile, KnownMaterial, Material, Zone as Kind,
};
use fretwork_language::scalar::Extent;
use fretwork_shell::analyse::{self, AcrossLayers, Zone};

/// What an object is made of and what it must bear.
pub struct Profile {
    /// The material.
    pub material: analyse::Material,
    /// The acceleration of all of it, in m/s².
    pub gravity: [f64; 3],
    /// The zones that are held fast.
    pub supports: Vec<Zone>,
    /// Forces in newtons, and where they act.
    pub loads: Vec<(Zone, [f64; 3])>,
    /// The stress that must not be exceeded, in Pa.
    pub max_stress: f64,
    /// Where all that is said.
    definition: Arc<Definition>,
}

impl Profile {
    /// An error about what holds the object.
    pub fn at_supports(&self, error: Diagnostic) -> Diagnostic {
        error.at(self.definition.field(&["supports"]), "held here")
    }

    /// An error or a warning about the load of this number.
    pub fn at_load(&self, load: usize, told: Diagnostic) -> Diagnostic {
        let place = ["loads", &load.to_string()];
        told.at(self.definition.field(&place), "this load")
    }
}

/// What helps where a zone catches nothing of an object with these bounds.
pub fn zone_help(bounds: &Bounds3) -> String {
    let shown = |p: Point3| format!("({:.2}, {:.2}, {:.2})", p.x, p.y, p.z);
    format!(
        "the body lies between {} and {}: make the zone larger or, over a hole of a shell's \
         pattern, keep it solid with `keep_solid`",
        shown(bounds.min),
        shown(bounds.max)
    )
}

/// The profile of an object with these bounds.
pub fn profile(said: &Described<ForceProfile>, bounds: &Bounds3) -> Profile {
    let kind = &said.kind;
    let material = material(&kind.material);
    Profile {
        definition: said.action.definition.clone(),
        gravity: kind.gravity.0,
        supports: zones(kind.supports.iter(), bounds),
        loads: kind
            .loads
            .iter()
            .map(|load| (zone(&load.zone, bounds), load.force.0))
            .collect(),
        max_stress: match (&kind.max_stress, material.yield_strength) {
            (Some(stress), _) => stress.0,
            (None, Some(strength)) => strength,
            (None, None) => f64::INFINITY,
        },
        material,
    }
}

/// Zones of an object with these bounds.
pub fn zones<'a>(kinds: impl Iterator<Item = &'a Kind>, bounds: &Bounds3) -> Vec<Zone> {
    kinds.map(|kind| zone(kind, bounds)).collect()
}

fn zone(kind: &Kind, bounds: &Bounds3) -> Zone {
    let height = |extent: &Extent| match *extent {
        Extent::Fraction(part) => part * bounds.size().z,
        Extent::Length(length) => length,
    };
    match kind {
        Kind::Lowest(extent) => Zone::Lowest(height(extent)),
        Kind::Highest(extent) => Zone::Highest(height(extent)),
        Kind::Box(corners) => Zone::Box(Bounds3 {
            min: corners.min.into(),
            max: corners.max.into(),
        }),
        Kind::Sphere(ball) => Zone::Ball {
            center: Point3::from(ball.center.0),
            radius: ball.radius.0,
        },
    }
}

/// Young's modulus in Pa, Poisson's ratio, kg/m³ and the yield strength in Pa, of moulded or sintered
/// stock as makers of filament and powder give them. Printed parts are weaker across their layers.
fn constants(known: KnownMaterial) -> [f64; 4] {
    match known {
        KnownMaterial::Abs => [2.3e9, 0.35, 1040.0, 40e6],
        KnownMaterial::Pla => [3.5e9, 0.36, 1240.0, 55e6],
        KnownMaterial::Petg => [2.1e9, 0.38, 1270.0, 48e6],
        KnownMaterial::Pa12 => [1.7e9, 0.39, 1010.0, 46e6],
    }
}

fn material(kind: &Material) -> analyse::Material {
    let ([youngs_modulus, poisson_ratio, density, yield_strength], printed) = match kind {
        Material::Known(known) => (constants(*known), None),
        Material::Printed(printed) => (
            constants(printed.of),
            Some((printed.across_layers, printed.build_direction)),
        ),
        Material::Custom(values) => (
            [
                values.youngs_modulus.0,
                values.poisson_ratio.0,
                values.density.0,
                values.yield_strength.0,
            ],
            Some((values.across_layers, values.build_direction)),
        ),
    };
    let across_layers = printed.and_then(|(strength, direction)| {
        Some(AcrossLayers {
            strength: strength?.0,
            direction: direction.0,
        })
    });
    analyse::Material {
        youngs_modulus,
        poisson_ratio,
        density,
        yield_strength: Some(yield_strength),
        across_layers,
    }
}
