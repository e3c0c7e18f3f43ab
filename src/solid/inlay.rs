//! Bodies of what is pressed into a surface: the pattern made thick, the surface without it, with it standing out. The
//! surface is divided already, so that nothing has to be cut: parts of it get two faces, and walls where they end.

use std::collections::BTreeMap;

use fretwork_geometry::halving::largest;
use fretwork_geometry::mesh::open_sides;
use fretwork_geometry::numeric::UnionFind;
use fretwork_geometry::progress::step;
use fretwork_geometry::{Cutout, Imprint, Mesh, Point3, SurfaceMesh};

use super::SolidError;
use super::carving::{Carving, Keep};
use super::frame::framed;
use super::shell::{between, capped, check_turned, inward};

/// The part of a surface that is kept, made thick; the rest is cut through.
///
/// # Errors
/// Another surface than that of the imprint, rims where the surface has none, bends sharper than the thickness, and
/// nothing that is left.
pub fn carve_imprint(
    surface: &SurfaceMesh,
    imprint: &Imprint,
    carving: &Carving,
) -> Result<Mesh, SolidError> {
    if surface.mesh != imprint.surface {
        return Err(SolidError::OtherSurface);
    }
    step(|| "making what is left thick".to_owned());
    let divided;
    let (imprint, triangles) = match carving.keep {
        Keep::Ground => (imprint, imprint.part(false)),
        Keep::Pattern { frame: 0.0 } => (imprint, imprint.part(true)),
        Keep::Pattern { frame } => {
            divided = framed(surface, imprint, frame)?;
            let triangles = divided.part(true);
            (&divided, triangles)
        }
    };
    let [low, high] = between(carving.thickness, carving.side);
    body(imprint, &triangles, low, high)
}

/// The pattern of a cutout that is pressed into a surface, between two distances from it.
///
/// # Errors
/// Bends sharper than that, and a body that has not the counts of the cutout.
pub fn thicken_imprint(
    cutout: &Cutout,
    imprint: &Imprint,
    low: f64,
    high: f64,
) -> Result<Mesh, SolidError> {
    let mesh = body(imprint, &imprint.part(true), low, high)?;
    let found = mesh.check_closed()?;
    let wanted = (cutout.components, cutout.holes + cutout.around);
    if (found.components, found.genus) == (wanted.0, Some(wanted.1)) {
        return Ok(mesh);
    }
    Err(SolidError::Handles {
        found: (found.components, found.genus.unwrap_or(0)),
        wanted,
    })
}

/// What a surface encloses, its flat openings closed, with the pattern standing out of it by `height`.
///
/// # Errors
/// Another surface than that of the imprint, a surface that encloses nothing, bends sharper than the height.
pub fn emboss_imprint(
    surface: &SurfaceMesh,
    imprint: &Imprint,
    height: f64,
) -> Result<Mesh, SolidError> {
    if surface.mesh != imprint.surface {
        return Err(SolidError::OtherSurface);
    }
    let positions = imprint.positions();
    let whole = capped(&Mesh {
        positions: positions.clone(),
        triangles: imprint.triangles.clone(),
    })?;
    let raised = imprint.part(true);
    let out = moved(imprint, height);
    check(&positions, &out, &raised).map_err(|error| {
        with_most(error, height, |part| {
            check(&positions, &moved(imprint, part * height), &raised).is_ok()
        })
    })?;
    let fans = Fans::new(&raised);
    let mut mesh = whole;
    let first = mesh.positions.len() as u32;
    mesh.positions
        .extend(fans.corners.iter().map(|corner| out[*corner as usize]));
    // Triangles of caps come after those of the surface.
    let caps = mesh.triangles.split_off(imprint.triangles.len());
    mesh.triangles = imprint.part(false);
    mesh.triangles.extend(caps);
    mesh.triangles.extend(
        fans.triangles
            .iter()
            .map(|t| t.map(|corner| first + corner)),
    );
    for [a, b] in open_sides(&fans.triangles) {
        let [low_a, low_b] = [a, b].map(|corner| fans.corners[corner as usize]);
        mesh.triangles.push([low_a, low_b, first + b]);
        mesh.triangles.push([low_a, first + b, first + a]);
    }
    let mesh = compact(mesh);
    mesh.check_closed()?;
    Ok(mesh)
}

/// The body between two copies of some triangles, moved out of the surface by `low` and by `high`, with walls at their border.
pub(crate) fn body(
    imprint: &Imprint,
    triangles: &[[u32; 3]],
    low: f64,
    high: f64,
) -> Result<Mesh, SolidError> {
    if !(low < high && low.is_finite() && high.is_finite()) {
        return Err(SolidError::Size(high - low));
    }
    if triangles.is_empty() {
        return Err(SolidError::Nothing);
    }
    let before = imprint.positions();
    let copies = |part: f64| [part * low, part * high].map(|out| moved(imprint, out));
    let made = copies(1.0);
    let checked = |copies: &[Vec<Point3>; 2]| {
        let mut copies = copies.iter();
        copies.try_for_each(|copy| check(&before, copy, triangles))
    };
    checked(&made)
        .map_err(|error| with_most(error, high - low, |part| checked(&copies(part)).is_ok()))?;
    let [inner, outer] = made;
    let fans = Fans::new(triangles);
    let count = fans.corners.len() as u32;
    let at = |places: &[Point3]| -> Vec<Point3> {
        fans.corners
            .iter()
            .map(|corner| places[*corner as usize])
            .collect()
    };
    let mut mesh = Mesh {
        positions: at(&outer),
        triangles: fans.triangles.clone(),
    };
    mesh.positions.extend(at(&inner));
    for [a, b] in open_sides(&fans.triangles) {
        mesh.triangles.push([b, a, a + count]);
        mesh.triangles.push([b, a + count, b + count]);
    }
    let turned = fans
        .triangles
        .iter()
        .map(|t| t.map(|corner| corner + count));
    mesh.triangles.extend(turned.map(|[a, b, c]| [a, c, b]));
    mesh.check_closed()?;
    Ok(mesh)
}

/// An error about a bend, with the part of a thickness that `holds`.
pub(crate) fn with_most(
    error: SolidError,
    thickness: f64,
    holds: impl Fn(f64) -> bool,
) -> SolidError {
    match error {
        SolidError::Bend { at, .. } => SolidError::Bend {
            at,
            most: largest(1.0, holds).map(|part| part * thickness),
        },
        other => other,
    }
}

/// The corners of an imprint, moved out of its surface. As the surface's own corners move, so do the places between them.
pub(crate) fn moved(imprint: &Imprint, out: f64) -> Vec<Point3> {
    let surface = &imprint.surface;
    let corners: Vec<Point3> = if out == 0.0 {
        surface.positions.clone()
    } else {
        let steps = inward(surface);
        let pairs = surface.positions.iter().zip(&steps);
        pairs.map(|(p, step)| *p + *step * -out).collect()
    };
    imprint
        .places
        .iter()
        .map(|place| place.blend(&corners))
        .collect()
}

/// An error where one of the triangles is turned over once its corners have moved.
pub(crate) fn check(
    before: &[Point3],
    after: &[Point3],
    triangles: &[[u32; 3]],
) -> Result<(), SolidError> {
    triangles.iter().try_for_each(|triangle| {
        let corners = triangle.map(|corner| before[corner as usize]);
        check_turned(corners, after, *triangle)
    })
}

/// Triangles whose corners are one only where the triangles hang together by sides: where two parts meet in a point, each has a
/// corner of its own there, so that walls on them do not meet.
pub(crate) struct Fans {
    /// The old number of each corner.
    pub corners: Vec<u32>,
    /// The triangles with new numbers.
    pub triangles: Vec<[u32; 3]>,
}

impl Fans {
    pub fn new(triangles: &[[u32; 3]]) -> Fans {
        let mut sides: Vec<([u32; 2], [u32; 2])> = Vec::with_capacity(3 * triangles.len());
        for (t, triangle) in (0..).zip(triangles) {
            for i in 0..3u32 {
                let j = (i + 1) % 3;
                let (a, b) = (triangle[i as usize], triangle[j as usize]);
                // The ends by number, and with them the corners of the triangle that they are.
                let (here, there) = (3 * t + i, 3 * t + j);
                sides.push(if a < b {
                    ([a, b], [here, there])
                } else {
                    ([b, a], [there, here])
                });
            }
        }
        sides.sort_unstable();
        let mut sets = UnionFind::new(3 * triangles.len());
        for pair in sides.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            sets.unite(pair[0].1[0], pair[1].1[0]);
            sets.unite(pair[0].1[1], pair[1].1[1]);
        }
        let mut numbers: BTreeMap<u32, u32> = BTreeMap::new();
        let mut corners = Vec::new();
        let mut fresh = |old: u32, place: u32| {
            *numbers.entry(sets.find(place)).or_insert_with(|| {
                corners.push(old);
                (corners.len() - 1) as u32
            })
        };
        let triangles = (0..)
            .zip(triangles)
            .map(|(t, triangle)| [0, 1, 2].map(|i: u32| fresh(triangle[i as usize], 3 * t + i)))
            .collect();
        Fans { corners, triangles }
    }
}

/// The mesh without corners that no triangle has.
pub(crate) fn compact(mesh: Mesh) -> Mesh {
    let mut numbers: Vec<Option<u32>> = vec![None; mesh.positions.len()];
    let mut positions = Vec::new();
    let mut number = |corner: u32| {
        *numbers[corner as usize].get_or_insert_with(|| {
            positions.push(mesh.positions[corner as usize]);
            (positions.len() - 1) as u32
        })
    };
    let triangles = mesh.triangles.iter().map(|t| t.map(&mut number)).collect();
    Mesh {
        positions,
        triangles,
    }
}
