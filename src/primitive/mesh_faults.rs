//! What is told of a mesh that can be used all the same: triangles without area, and places where it passes through
//! itself. What makes it useless is told where it is read.

use fretwork_action::Action;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::mesh::{self, doubled_normal};
use fretwork_geometry::{Affine3, Mesh, Point3};

/// A triangle lower than this part of its longest side has no area: rounding leaves as much.
const FLAT: f64 = 1e-12;
/// Contacts less deep than this part of the mesh's longest side are none: coordinates of files have seven digits.
const DEPTH: f64 = 1e-6;

/// A warning where triangles of a mesh that is used as `placed` have no area, with the first of them in place.
///
/// # Errors
/// When none has an area.
pub fn without_area(
    action: &Action,
    mesh: &Mesh,
    placed: &Affine3,
) -> Result<Option<Diagnostic>, Vec<Diagnostic>> {
    let all = mesh.triangles.iter().map(|t| mesh.corners(*t));
    let flat: Vec<[Point3; 3]> = all.filter(is_flat).collect();
    let Some([a, b, c]) = flat.first() else {
        return Ok(None);
    };
    let near = shown(placed.apply((*a + *b + *c) * (1.0 / 3.0)));
    let count = flat.len();
    let told = |diagnostic: Diagnostic| diagnostic.at(action.span(), "in this surface");
    if count == mesh.triangles.len() {
        let message = format!("no triangle of the mesh has an area; one is near {near}");
        return Err(vec![told(Diagnostic::error(message))]);
    }
    let message = match count {
        1 => format!("a triangle of the mesh has no area, near {near}"),
        _ => format!("{count} triangles of the mesh have no area, one near {near}"),
    };
    let help = "what has no area is passed over; merging corners by distance in a mesh editor takes it out";
    Ok(Some(told(Diagnostic::warning(message)).help(help)))
}

fn is_flat(corners: &[Point3; 3]) -> bool {
    let [a, b, c] = *corners;
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    doubled_normal(*corners).length() <= FLAT * longest * longest
}

/// A warning where a mesh passes through itself, with a place; `here` says what it is.
pub fn crossing(action: &Action, mesh: &Mesh, here: &str) -> Option<Diagnostic> {
    let depth = DEPTH * mesh.bounds().longest_side();
    let surface = mesh::Surface::new(mesh);
    let pairs = surface.overlaps(depth);
    let near = surface.place_of_overlap(*pairs.first()?, depth)?;
    let message = format!(
        "the mesh passes through itself: {} {} of triangles cross or lie on one another, one near {}",
        pairs.len(),
        if pairs.len() == 1 { "pair" } else { "pairs" },
        shown(near)
    );
    let warning = Diagnostic::warning(message).at(action.span(), here);
    let help = "what lies in another part of it is filled once in an analysis, and carries a pattern on a shell: unite its parts in \
                a mesh editor, or make `solids` of them and their `union`";
    Some(warning.help(help))
}

fn shown(p: Point3) -> String {
    let [x, y, z] = [p.x, p.y, p.z].map(|v| format!("{v:.3}"));
    format!("({x}, {y}, {z})")
}
