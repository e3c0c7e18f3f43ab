//! Cutouts that lie on a surface, cut through it or standing out of it.

use rayon::prelude::*;

use super::shell::between;
use super::{Operation, Overlap, SolidError, capped, combine, shell, thicken_between};
use fretwork_geometry::mesh::Cut;
use fretwork_geometry::mesh::nearest::Nearest;
use fretwork_geometry::progress::step;
use fretwork_geometry::{Cutout, Mesh, Point3, Side};

/// How many points of a cutout are asked how far they are from the surface.
const PROBES: usize = 600;
/// What lies farther than this part of the surface's longest side from it does not lie on it.
const FAR: f64 = 0.25;
/// What goes through something goes farther by this part.
const BEYOND: f64 = 0.1;

/// A body, and where the cutout overlaps itself, if it does.
pub type Relief = (Mesh, Option<Overlap>);

/// A body that was carved.
pub struct Carved {
    /// What is left.
    pub mesh: Mesh,
    /// Where the cutout overlaps itself, if it does.
    pub overlap: Option<Overlap>,
    /// What it was carved out of, and what was taken away.
    pub cut: Cut,
}

/// The surface made `thickness` thick, to this side of it, without what the cutout fills.
///
/// # Errors
/// A surface that cannot be made thick, a cutout that lies off it, nothing that is left.
pub fn carve(
    surface: &Mesh,
    cutout: &Cutout,
    thickness: f64,
    side: Side,
) -> Result<Carved, SolidError> {
    step(|| "making the surface thick".to_owned());
    let body = shell(surface, thickness, side)?;
    let [low, high] = between(thickness, side);
    let away = distance(surface, cutout)?;
    step(|| "making the cutout thick".to_owned());
    let (cutter, overlap) = thicken_between(
        cutout,
        low - away - (thickness + away) * BEYOND,
        high + away + thickness * BEYOND,
    )?;
    let pair = [body, cutter];
    let mesh = combine(Operation::Difference, &pair)?;
    let [whole, cutter] = pair;
    let cut = Cut {
        whole,
        taken: vec![cutter],
    };
    Ok(Carved { mesh, overlap, cut })
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

/// What the surface encloses, its flat openings closed, with the cutout standing out of it by `height`.
///
/// # Errors
/// A surface that encloses nothing, a cutout that lies off it.
pub fn emboss(surface: &Mesh, cutout: &Cutout, height: f64) -> Result<Relief, SolidError> {
    let body = capped(surface)?;
    let away = distance(surface, cutout)?;
    // It is rooted in the body, also where the body turns away from it.
    let (relief, fold) =
        thicken_between(cutout, -(away * (1.0 + BEYOND) + height * BEYOND), height)?;
    Ok((combine(Operation::Union, &[body, relief])?, fold))
}

/// How far the cutout is from the surface at most, measured at some of its corners.
fn distance(surface: &Mesh, cutout: &Cutout) -> Result<f64, SolidError> {
    let corners: Vec<Point3> = cutout
        .polygons
        .iter()
        .flat_map(|p| p.rings().flatten())
        .map(|p| cutout.place(*p, 0.0))
        .collect();
    let tree = Nearest::new(surface);
    let nearest = |p: Point3| tree.foot(p).map_or(f64::INFINITY, |foot| foot.distance);
    let step = corners.len().div_ceil(PROBES).max(1);
    let probes: Vec<Point3> = corners.into_iter().step_by(step).collect();
    let distances: Vec<f64> = probes.par_iter().map(|p| nearest(*p)).collect();
    let (at, away) =
        distances.iter().enumerate().fold(
            (0, 0.0),
            |most, (i, d)| if *d > most.1 { (i, *d) } else { most },
        );
    if away > FAR * surface.bounds().longest_side() {
        return Err(SolidError::OffSurface {
            at: probes[at],
            away,
        });
    }
    Ok(away)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use fretwork_geometry::mesh::{Surface, revolve};
    use fretwork_geometry::{Across, Carrier, Point, Polygon, Ribbon, SpaceCurve};

    /// A tube about the z axis, open at both ends.
    fn tube(radius: f64) -> Mesh {
        revolve(
            &[Point::new(radius, 0.0), Point::new(radius, 30.0)],
            false,
            240,
        )
        .unwrap()
    }

    /// Two windows on the way round a tube, on a strip that stands upright on it, at this height.
    fn windows(radius: f64, height: f64) -> Cutout {
        let circle = SpaceCurve::circle(radius)
            .unwrap()
            .mapped(|p| p + Point3::new(0.0, 0.0, height))
            .unwrap();
        let ribbon = Ribbon::new(circle, Across::Normal, false).unwrap();
        let joints = ribbon.joints().to_vec();
        let window = |from: usize, to: usize| {
            let side = |v: f64| {
                joints[from..=to]
                    .iter()
                    .map(|&u| Point::new(u, v))
                    .collect::<Vec<_>>()
            };
            Polygon {
                outer: side(-5.0)
                    .into_iter()
                    .chain(side(5.0).into_iter().rev())
                    .collect(),
                holes: vec![],
            }
        };
        let polygons = vec![window(10, 100), window(300, 380)];
        Cutout {
            carrier: Carrier::Strip(Arc::new(ribbon)),
            ..Cutout::planar(polygons).unwrap()
        }
    }

    #[test]
    fn windows_are_cut_through_a_tube() {
        let carved = carve(&tube(20.0), &windows(20.0, 15.0), 2.0, Side::Inside).unwrap();
        let (mesh, fold) = (carved.mesh, carved.overlap);
        let topology = mesh.check_closed().unwrap();
        assert_eq!(
            (topology.components, topology.genus, fold),
            (1, Some(3), None)
        );
        let whole = shell(&tube(20.0), 2.0, Side::Inside).unwrap().volume();
        let turns = 170.0 / 720.0 * std::f64::consts::TAU;
        let taken = turns * 10.0 * (20.0 * 20.0 - 18.0 * 18.0) / 2.0;
        assert!((whole - mesh.volume()) / taken > 0.98 && (whole - mesh.volume()) / taken < 1.02);
    }

    #[test]
    fn what_is_carved_goes_through_on_whichever_side_the_thickness_is() {
        for side in [Side::Inside, Side::Center, Side::Outside] {
            let carved = carve(&tube(20.0), &windows(20.0, 15.0), 2.0, side).unwrap();
            let mesh = carved.mesh;
            let topology = mesh.check_closed().unwrap();
            assert_eq!((topology.components, topology.genus), (1, Some(3)));
            let wide = mesh.bounds().size().x;
            let [_, out] = between(2.0, side);
            assert!((wide - 2.0 * (20.0 + out)).abs() < 0.01, "{side:?} {wide}");
        }
    }

    #[test]
    fn what_was_carved_twice_meets_in_one_body_without_exact_arithmetic() {
        // The faces of the two lie on one another all over the tube, but for the rounding of the cuts.
        let carved = |height: f64| {
            carve(&tube(20.0), &windows(20.0, height), 2.0, Side::Inside)
                .unwrap()
                .mesh
        };
        let (low, high) = (carved(7.5), carved(22.5));
        for mesh in [&low, &high] {
            let depth = 1e-9 * mesh.bounds().longest_side();
            assert!(!Surface::new(mesh).overlaps_itself(depth));
        }
        let both = combine(Operation::Intersection, &[low.clone(), high.clone()]).unwrap();
        let topology = both.check_closed().unwrap();
        assert_eq!((topology.components, topology.genus), (1, Some(5)));
        let whole = shell(&tube(20.0), 2.0, Side::Inside).unwrap().volume();
        let expected = low.volume() + high.volume() - whole;
        assert!((both.volume() / expected - 1.0).abs() < 1e-9);
    }

    #[test]
    fn cuts_of_one_whole_are_made_at_once_and_as_they_are_one_by_one() {
        let carved =
            |height: f64| carve(&tube(20.0), &windows(20.0, height), 2.0, Side::Inside).unwrap();
        let [low, high] = [7.5, 22.5].map(carved);
        let (mesh, cut) = intersect_cuts(&[&low.cut, &high.cut]).unwrap().unwrap();
        let slow = combine(Operation::Intersection, &[low.mesh, high.mesh.clone()]).unwrap();
        assert_eq!(mesh.topology().genus, slow.topology().genus);
        assert!((mesh.volume() / slow.volume() - 1.0).abs() < 1e-9);
        // A cut of cuts is one again, and that of another whole is not.
        assert_eq!(cut.taken.len(), 2);
        let again = intersect_cuts(&[&cut, &high.cut]).unwrap().unwrap().0;
        assert!((again.volume() / mesh.volume() - 1.0).abs() < 1e-9);
        let other = carve(&tube(21.0), &windows(21.0, 15.0), 2.0, Side::Inside).unwrap();
        assert!(intersect_cuts(&[&low.cut, &other.cut]).is_none());
    }

    #[test]
    fn windows_stand_out_of_a_filled_tube() {
        let (mesh, _) = emboss(&tube(20.0), &windows(20.0, 15.0), 1.5).unwrap();
        let topology = mesh.check_closed().unwrap();
        assert_eq!((topology.components, topology.genus), (1, Some(0)));
        let radius = mesh
            .positions
            .iter()
            .map(|p| (p.x * p.x + p.y * p.y).sqrt())
            .fold(0.0, f64::max);
        assert!((21.4..21.6).contains(&radius), "{radius}");
    }

    #[test]
    fn what_lies_off_the_surface_is_refused() {
        assert!(matches!(
            carve(&tube(20.0), &windows(60.0, 15.0), 2.0, Side::Inside),
            Err(SolidError::OffSurface { .. })
        ));
    }
}
