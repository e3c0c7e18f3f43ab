//! Bodies compared by booleans.

use std::collections::BTreeMap;

use super::{Amounts, Difference, Overlay};
use crate::picture::{ADDED, COMMON, REMOVED};
use fretwork_geometry::mesh::Material;
use fretwork_geometry::{Bounds3, Mesh, Model};
use fretwork_solid::{Operation, SolidError, combine};

/// Bodies of more triangles are not compared: it would take minutes.
const MOST: usize = 3_000_000;

/// Two models compared, in cubes of their unit, which is the millimetre. Of parts that both have in the same place nothing is
/// computed. Without amounts where a part is not closed or the booleans fail.
pub fn compare(before: &Model, after: &Model) -> Difference {
    let found = pieces(before, after);
    let amounts = found.as_ref().map(|found| found.amounts);
    Difference {
        amounts: amounts.map(Amounts::rounded),
        is_same: amounts.map_or(before == after, |amounts| amounts.is_same()),
        overlay: found.map(|found| Overlay::Body(overlay(&found))),
    }
}

/// What becomes of the bodies.
struct Found {
    common: Vec<Mesh>,
    removed: Mesh,
    added: Mesh,
    amounts: Amounts,
}

fn pieces(before: &Model, after: &Model) -> Option<Found> {
    if before.triangle_count() + after.triangle_count() > MOST {
        return None;
    }
    let [before, after] = [before, after].map(|model| -> Vec<Mesh> {
        let parts = model.parts.iter();
        parts.map(|part| model.mesh(part)).collect()
    });
    let is_closed = |mesh: &Mesh| mesh.check_closed().is_ok();
    if !before.iter().chain(&after).all(is_closed) {
        return None;
    }
    let (kept, old, new) = apart(&before, &after);
    let ((removed, added), (shared, whole)) = rayon::join(
        || rayon::join(|| less(&old, &after), || less(&new, &before)),
        || rayon::join(|| both(&old, &after), || volume(&before)),
    );
    let (removed, added, whole) = (removed?, added?, whole?);
    let mut common = kept;
    common.extend(shared.filter(|mesh| !mesh.triangles.is_empty()));
    let amounts = Amounts {
        added: added.volume(),
        removed: removed.volume(),
        common: (whole - removed.volume()).max(0.0),
        unit: "mm3",
    };
    Some(Found {
        common,
        removed,
        added,
        amounts,
    })
}

/// The parts that both have, those that were only before, and those that are only after.
fn apart(before: &[Mesh], after: &[Mesh]) -> (Vec<Mesh>, Vec<Mesh>, Vec<Mesh>) {
    let mut count: BTreeMap<Vec<u64>, usize> = BTreeMap::new();
    for mesh in after {
        *count.entry(key(mesh)).or_default() += 1;
    }
    let (mut kept, mut old) = (Vec::new(), Vec::new());
    for mesh in before {
        match count.get_mut(&key(mesh)) {
            Some(left) if *left > 0 => {
                *left -= 1;
                kept.push(mesh.clone());
            }
            _ => old.push(mesh.clone()),
        }
    }
    let mut new = Vec::new();
    for mesh in after {
        if let Some(left) = count.get_mut(&key(mesh))
            && *left > 0
        {
            *left -= 1;
            new.push(mesh.clone());
        }
    }
    (kept, old, new)
}

/// The corners and triangles in bits, by which equal meshes are found.
fn key(mesh: &Mesh) -> Vec<u64> {
    let corners = mesh.positions.iter().flat_map(|p| [p.x, p.y, p.z]);
    let triangles = mesh.triangles.iter().flatten().map(|i| u64::from(*i));
    corners.map(f64::to_bits).chain(triangles).collect()
}

fn whole(meshes: &[&Mesh]) -> Mesh {
    let mut all = Mesh::default();
    meshes.iter().for_each(|mesh| all.append(mesh));
    all
}

/// The meshes of `others` whose boxes meet that of one of `meshes`.
fn near<'a>(meshes: &[Mesh], others: &'a [Mesh]) -> Vec<&'a Mesh> {
    let boxes: Vec<Bounds3> = meshes.iter().map(Mesh::bounds).collect();
    let meets = |mesh: &&Mesh| {
        let bounds = mesh.bounds();
        boxes.iter().any(|known| meeting(known, &bounds))
    };
    others.iter().filter(meets).collect()
}

fn meeting(a: &Bounds3, b: &Bounds3) -> bool {
    let along = |low: f64, high: f64, other: (f64, f64)| low <= other.1 && other.0 <= high;
    along(a.min.x, a.max.x, (b.min.x, b.max.x))
        && along(a.min.y, a.max.y, (b.min.y, b.max.y))
        && along(a.min.z, a.max.z, (b.min.z, b.max.z))
}

/// What is in `meshes` and in none of `others`.
fn less(meshes: &[Mesh], others: &[Mesh]) -> Option<Mesh> {
    if meshes.is_empty() {
        return Some(Mesh::default());
    }
    let mut operands = vec![whole(&meshes.iter().collect::<Vec<_>>())];
    operands.extend(near(meshes, others).into_iter().cloned());
    made(combine(Operation::Difference, &operands))
}

/// What is in one of `meshes` and in one of `others`.
fn both(meshes: &[Mesh], others: &[Mesh]) -> Option<Mesh> {
    let near = near(meshes, others);
    if meshes.is_empty() || near.is_empty() {
        return Some(Mesh::default());
    }
    let operands = [whole(&meshes.iter().collect::<Vec<_>>()), whole(&near)];
    made(combine(Operation::Intersection, &operands))
}

/// A combination, which may be of nothing.
fn made(combination: Result<Mesh, SolidError>) -> Option<Mesh> {
    match combination {
        Ok(mesh) => Some(mesh),
        Err(SolidError::Nothing) => Some(Mesh::default()),
        Err(_) => None,
    }
}

/// The volume of all meshes together. Those whose boxes are apart are not united for it.
fn volume(meshes: &[Mesh]) -> Option<f64> {
    let boxes: Vec<Bounds3> = meshes.iter().map(Mesh::bounds).collect();
    let is_apart = boxes
        .iter()
        .enumerate()
        .all(|(i, a)| boxes[..i].iter().all(|b| !meeting(a, b)));
    if is_apart {
        return Some(meshes.iter().map(Mesh::volume).sum());
    }
    Some(made(combine(Operation::Union, meshes))?.volume())
}

/// Pieces that are thinner than this in the mean, in millimetres, are counted and not shown: they are what another division of
/// a curved face leaves, and their faces lie on those of what is common.
const THIN: f64 = 0.01;

/// The pieces of what differs that are to be seen; a piece with cavities is one of them.
fn seen(mesh: &Mesh) -> Mesh {
    let pieces = mesh.components();
    let is_seen = |piece: &&Mesh| 2.0 * piece.volume().abs() >= THIN * piece.area();
    whole(&pieces.iter().filter(is_seen).collect::<Vec<_>>())
}

fn overlay(found: &Found) -> Model {
    let mut model = Model::default();
    let (removed, added) = (seen(&found.removed), seen(&found.added));
    let common = whole(&found.common.iter().collect::<Vec<_>>());
    for (name, color, mesh) in [
        ("common", COMMON, &common),
        ("removed", REMOVED, &removed),
        ("added", ADDED, &added),
    ] {
        if !mesh.triangles.is_empty() {
            let material = model.add_material(Material::of(name, color));
            model.push(name, mesh.clone()).material = Some(material);
        }
    }
    model
}
