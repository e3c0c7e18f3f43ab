//! Cutouts that lie on a surface as bodies that cut it, or stand out of it.

use rayon::prelude::*;

use super::carving::{AtCutout, Carving, THROUGH, reaching};
use super::inlay::{emboss_imprint, thicken_imprint};
use super::shell::between;
use super::{Operation, Overlap, SolidError, capped, combine, thicken_between};
use fretwork_geometry::mesh::nearest::{Foot, Nearest};
use fretwork_geometry::mesh::{Cut, doubled_normal};
use fretwork_geometry::{Carrier, Cutout, Mesh, Point, SurfaceMesh};

/// How many points of a cutout are asked how far they are from the surface.
const PROBES: usize = 600;
/// What lies farther than this part of the surface's longest side from it does not lie on it.
const FAR: f64 = 0.25;
/// What goes through something goes farther by this part.
const BEYOND: f64 = 0.1;

/// A body, and where a cutout overlaps itself, if one does.
pub type Relief = (Mesh, Option<Overlap>);

/// The body that takes a cutout out of a surface: through it, or from its outer face to a depth.
///
/// # Errors
/// A cutout that lies off the surface or was pressed into another one, and a depth that reaches through it where it lies.
pub(crate) fn cutter(
    surface: &SurfaceMesh,
    cutout: &Cutout,
    carving: &Carving,
) -> Result<Relief, SolidError> {
    let [low, high] = between(carving.thickness, carving.side);
    if let Carrier::Surface(imprint) = &cutout.carrier {
        if surface.mesh != imprint.surface {
            return Err(SolidError::OtherSurface);
        }
        // Farther than what is taken of the ground, whose faces it must not lie on.
        let beyond = 2.0 * THROUGH * carving.thickness;
        let low = carving.depth.map_or(low - beyond, |depth| high - depth);
        return Ok((thicken_imprint(cutout, imprint, low, high + beyond)?, None));
    }
    let lie = Lie::of(surface, cutout)?;
    let away = lie.away;
    let low = match carving.depth {
        None => low - away - (carving.thickness + away) * BEYOND,
        Some(depth) => {
            reaching(depth, carving.thickness, away)?;
            high - depth
        }
    };
    let [low, high] = lie.outward(low, high + away + carving.thickness * BEYOND);
    thicken_between(cutout, low, high)
}

/// What is in all of some cuts of one whole: all that they take away is taken from it at once, which
/// is exact work only where the cuts are, not wherever the faces of the whole lie on themselves. None when the wholes
/// differ.
///
/// # Errors
/// Nothing that is left.
pub fn intersect_cuts(cuts: &[&Cut]) -> Option<Result<(Mesh, Cut), SolidError>> {
    let (first, rest) = cuts.split_first()?;
    if rest.iter().any(|cut| cut.whole != first.whole) {
        return None;
    }
    let taken: Vec<Mesh> = cuts
        .iter()
        .flat_map(|cut| cut.taken.iter().cloned())
        .collect();
    let operands: Vec<Mesh> = std::iter::once(&first.whole)
        .chain(&taken)
        .cloned()
        .collect();
    let whole = first.whole.clone();
    let made = combine(Operation::Difference, &operands);
    Some(made.map(|mesh| (mesh, Cut { whole, taken })))
}

/// What the surface encloses, its flat openings closed, with the cutouts standing out of it by `height`.
///
/// # Errors
/// A surface that encloses nothing, a cutout that lies off it or was pressed into another one.
pub fn emboss(surface: &SurfaceMesh, cutouts: &[&Cutout], height: f64) -> Result<Relief, AtCutout> {
    if let [
        Cutout {
            carrier: Carrier::Surface(imprint),
            ..
        },
    ] = cutouts
    {
        return Ok((emboss_imprint(surface, imprint, height)?, None));
    }
    let mut bodies = vec![capped(surface)?];
    let mut overlap = None;
    for (number, cutout) in cutouts.iter().enumerate() {
        let at = |error| AtCutout {
            cutout: Some(number),
            error,
        };
        let (body, found) = standing(surface, cutout, height).map_err(at)?;
        bodies.push(body);
        overlap = overlap.or(found);
    }
    Ok((combine(Operation::Union, &bodies)?, overlap))
}

/// A cutout as a body that stands out of a surface, and is rooted in it.
fn standing(surface: &SurfaceMesh, cutout: &Cutout, height: f64) -> Result<Relief, SolidError> {
    if let Carrier::Surface(imprint) = &cutout.carrier {
        if surface.mesh != imprint.surface {
            return Err(SolidError::OtherSurface);
        }
        let mesh = thicken_imprint(cutout, imprint, -height * BEYOND, height)?;
        return Ok((mesh, None));
    }
    let lie = Lie::of(surface, cutout)?;
    // It is rooted in the body, also where the body turns away from it.
    let root = lie.away * (1.0 + BEYOND) + height * BEYOND;
    let [low, high] = lie.outward(-root, height);
    thicken_between(cutout, low, high)
}

/// How a cutout lies on a surface, measured at some of its corners.
struct Lie {
    /// How far it is from the surface at most.
    away: f64,
    /// Whether its outer side is the inner one of the surface.
    is_turned: bool,
}

impl Lie {
    fn of(surface: &Mesh, cutout: &Cutout) -> Result<Lie, SolidError> {
        let rings = cutout.polygons.iter().flat_map(|p| p.rings().flatten());
        let corners: Vec<Point> = rings.copied().collect();
        let tree = Nearest::new(surface);
        let step = corners.len().div_ceil(PROBES).max(1);
        let probes: Vec<Point> = corners.into_iter().step_by(step).collect();
        let at = |p: &Point| cutout.place(*p, 0.0);
        let feet: Vec<Option<Foot>> = probes.par_iter().map(|p| tree.foot(at(p))).collect();
        let distance =
            |foot: &Option<Foot>| foot.as_ref().map_or(f64::INFINITY, |foot| foot.distance);
        let farthest = |most: (usize, f64), (i, foot): (usize, &Option<Foot>)| {
            if distance(foot) > most.1 {
                (i, distance(foot))
            } else {
                most
            }
        };
        let (number, away) = feet.iter().enumerate().fold((0, 0.0), farthest);
        if away > FAR * surface.bounds().longest_side() {
            let at = at(&probes[number]);
            return Err(SolidError::OffSurface { at, away });
        }
        let facing = |(p, foot): (&Point, &Option<Foot>)| {
            let triangle = surface.triangles[foot.as_ref()?.triangle as usize];
            let normal = doubled_normal(surface.corners(triangle)).unit()?;
            Some((cutout.place(*p, 1.0) - at(p)).dot(normal))
        };
        let facing: f64 = probes.iter().zip(&feet).filter_map(facing).sum();
        Ok(Lie {
            away,
            is_turned: facing < 0.0,
        })
    }

    /// Distances out of the surface as distances out of the cutout, in order.
    fn outward(&self, low: f64, high: f64) -> [f64; 2] {
        if self.is_turned {
            [-high, -low]
        } else {
            [low, high]
        }
    }
}

#[cfg(test)]
mod tests;
