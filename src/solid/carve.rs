//! Cutouts taken out of a surface that is made thick, or kept while the rest is taken; and how it is done. One that is pressed
//! into the surface needs no cutting (see `inlay` and `engrave`); others, and several at once, are cut.

use fretwork_geometry::mesh::Cut;
use fretwork_geometry::progress::step;
use fretwork_geometry::{Carrier, Cutout, Imprint, Mesh, OnMesh, SurfaceMesh};

use super::carving::{AtCutout, Carving, Keep, THROUGH, reaching};
use super::engrave::engrave_imprint;
use super::frame::framed;
use super::inlay::{body, carve_imprint};
use super::plate::Plate;
use super::relief::cutter;
use super::shell::between;
use super::{Operation, Overlap, SolidError, combine, shell};

/// A body that was carved.
#[derive(Debug)]
pub struct Carved {
    /// What is left.
    pub mesh: Mesh,
    /// Where a cutout overlaps itself, if one does.
    pub overlap: Option<Overlap>,
    /// What it was carved out of, and what was taken away, where it was cut through.
    pub cut: Option<Cut>,
}

/// The surface made thick, without what the cutouts fill, or with nothing but it.
///
/// # Errors
/// A surface that cannot be made thick, a cutout that lies off it or on another one, a depth that reaches through it, rims
/// where it has none, and nothing that is left.
pub fn carve(
    surface: &SurfaceMesh,
    cutouts: &[&Cutout],
    carving: &Carving,
) -> Result<Carved, AtCutout> {
    if let Some(depth) = carving.depth {
        reaching(depth, carving.thickness, 0.0)?;
    }
    if let [
        Cutout {
            carrier: Carrier::Surface(imprint),
            ..
        },
    ] = cutouts
    {
        let mesh = match carving.depth {
            None => carve_imprint(surface, imprint, carving),
            Some(depth) => engrave_imprint(surface, imprint, carving, depth),
        };
        return Ok(Carved {
            mesh: mesh?,
            overlap: None,
            cut: None,
        });
    }
    step(|| "making the surface thick".to_owned());
    let whole = shell(surface, carving.thickness, carving.side)?;
    let (mut cutters, mut overlap) = (Vec::with_capacity(cutouts.len()), None);
    for (number, cutout) in cutouts.iter().enumerate() {
        step(|| "making the cutout thick".to_owned());
        let at = |error| AtCutout {
            cutout: Some(number),
            error,
        };
        let (cutter, found) = cutter(surface, cutout, carving).map_err(at)?;
        cutters.push(cutter);
        overlap = overlap.or(found);
    }
    let (mesh, cut) = match carving.keep {
        Keep::Ground => without(whole, cutters, carving)?,
        Keep::Pattern { frame } => (kept(surface, whole, cutters, (carving, frame))?, None),
    };
    Ok(Carved { mesh, overlap, cut })
}

fn without(
    whole: Mesh,
    taken: Vec<Mesh>,
    carving: &Carving,
) -> Result<(Mesh, Option<Cut>), SolidError> {
    let operands: Vec<Mesh> = std::iter::once(whole).chain(taken).collect();
    let mesh = combine(Operation::Difference, &operands)?;
    let mut operands = operands.into_iter();
    let whole = operands.next().ok_or(SolidError::Nothing)?;
    let cut = Cut {
        whole,
        taken: operands.collect(),
    };
    Ok((mesh, carving.depth.is_none().then_some(cut)))
}

/// What the cutters have in common with the surface, and its rims: the surface without the ground between them.
fn kept(
    surface: &SurfaceMesh,
    whole: Mesh,
    cutters: Vec<Mesh>,
    (carving, frame): (&Carving, f64),
) -> Result<Mesh, SolidError> {
    if frame == 0.0 && carving.depth.is_none() {
        let pattern = combine(Operation::Union, &cutters)?;
        return combine(Operation::Intersection, &[whole, pattern]);
    }
    let Some(ground) = ground(surface, carving, frame)? else {
        return Ok(whole);
    };
    let operands: Vec<Mesh> = std::iter::once(ground).chain(cutters).collect();
    match combine(Operation::Difference, &operands) {
        Ok(taken) => combine(Operation::Difference, &[whole, taken]),
        Err(SolidError::Nothing) => Ok(whole),
        Err(error) => Err(error),
    }
}

/// All of the surface but its rims, thicker than it becomes, or as deep as it is engraved. None where its rims are all of it.
fn ground(
    surface: &SurfaceMesh,
    carving: &Carving,
    frame: f64,
) -> Result<Option<Mesh>, SolidError> {
    let beyond = THROUGH * carving.thickness;
    let [low, high] = between(carving.thickness, carving.side);
    let low = carving.depth.map_or(low - beyond, |depth| high - depth);
    let high = high + beyond;
    if let Some(plate) = Plate::of(surface) {
        return plate.ground(frame, low, high);
    }
    let bare = Imprint {
        places: (0..surface.positions.len() as u32)
            .map(OnMesh::corner)
            .collect(),
        triangles: surface.triangles.clone(),
        inside: vec![false; surface.triangles.len()],
        surface: surface.mesh.clone(),
    };
    let bare = if frame == 0.0 {
        bare
    } else {
        framed(surface, &bare, frame)?
    };
    let triangles = bare.part(false);
    if triangles.is_empty() {
        return Ok(None);
    }
    body(&bare, &triangles, low, high).map(Some)
}
