//! What must hold of every value, whatever the spec. A value that breaks it is a mistake of the
//! compiler; looking for it is slow, so it is done when `FRETWORK_CHECK=1` asks for it.

use super::Data;
use fretwork_geometry::shell::Step;
use fretwork_geometry::{
    Carrier, Curves, Cutout, FacadeLayout, Imprint, Mesh, Model, Pixels, PlanarMap, Region, mesh,
    planar_map, topology,
};

/// How deep a triangle passes through another one that counts, as a part of the body's size.
const DEPTH: f64 = 2e-6;

/// Whether `value` is sound, or a sentence on what is wrong with it.
///
/// # Errors
/// With that sentence.
pub fn check(data: &Data) -> Result<(), String> {
    match data {
        Data::Region(region) => check_region(region),
        Data::Curves(curves) => check_curves(curves),
        Data::Drawing(drawing) => check_curves(&drawing.curves()),
        Data::Cutout(cutout) => check_cutout(cutout),
        Data::Facade(facade) => check_facade(&facade.layout),
        Data::Surface(mesh) => mesh.validate().map_err(|e| e.to_string()),
        Data::Solid(model) => check_model(model),
        Data::Shell(shell) => check_shell(&shell.mesh),
        Data::Pixels(pixels) => check_pixels(pixels),
        Data::ShellStep(step) => check_step(step),
        Data::Curve(_) | Data::Analysis(_) | Data::File(_) => Ok(()),
    }
}

fn check_shell(mesh: &Mesh) -> Result<(), String> {
    mesh.check_closed().map_err(|e| e.to_string())?;
    let depth = DEPTH * mesh.bounds().longest_side();
    let pairs = mesh::Surface::new(mesh).overlaps(depth);
    let Some([first, _]) = pairs.first() else {
        return Ok(());
    };
    let [at, ..] = mesh.corners(mesh.triangles[*first as usize]);
    Err(format!(
        "{} pairs of triangles of the shell pass through one another, one near ({:.3}, {:.3}, {:.3})",
        pairs.len(),
        at.x,
        at.y,
        at.z
    ))
}

fn check_pixels(pixels: &Pixels) -> Result<(), String> {
    let count = pixels.rgb.len();
    if count == pixels.solid.len() && count > 0 && count.is_multiple_of(pixels.width.max(1)) {
        Ok(())
    } else {
        Err(format!("{count} pixels in rows of {}", pixels.width))
    }
}

fn check_step(step: &Step) -> Result<(), String> {
    match step {
        Step::Voxels(surface) if surface.voxels.len() != surface.normals.len() => {
            Err("a voxel has no normal".into())
        }
        Step::Voxels(surface) if !surface.voxels.cells.is_sorted_by(|a, b| a < b) => {
            Err("voxels are not in order".into())
        }
        Step::Pattern { pattern, .. } => match pattern.labels.first() {
            Some(finest) if finest.len() == pattern.solid.len() => Ok(()),
            _ => Err("a voxel of the pattern has no label".into()),
        },
        Step::Voxels(_) | Step::Structure(_) => Ok(()),
    }
}

fn check_region(region: &Region) -> Result<(), String> {
    match region
        .area
        .iter()
        .flat_map(|polygon| polygon.rings())
        .find(|ring| ring.len() < 3)
    {
        Some(ring) => Err(format!("a ring of the region has {} points", ring.len())),
        None => check_curves(&region.contour),
    }
}

fn check_curves(curves: &Curves) -> Result<(), String> {
    let map = PlanarMap::build(
        curves,
        planar_map::resolution(curves.bounds().longer_side()),
    );
    map.map_err(|e| e.to_string())?.check()
}

fn check_cutout(cutout: &Cutout) -> Result<(), String> {
    if let Carrier::Surface(imprint) = &cutout.carrier {
        return check_imprint(imprint);
    }
    let counted = topology::count(&cutout.polygons).map_err(|e| e.to_string())?;
    if (counted.components, counted.holes) == (cutout.components, cutout.holes + cutout.around) {
        Ok(())
    } else {
        let (components, holes) = (counted.components, counted.holes);
        Err(format!(
            "{} components with {} holes are {components} with {holes}",
            cutout.components, cutout.holes
        ))
    }
}

fn check_imprint(imprint: &Imprint) -> Result<(), String> {
    let divided = Mesh {
        positions: imprint.positions(),
        triangles: imprint.triangles.clone(),
    };
    divided.validate().map_err(|e| e.to_string())?;
    let (before, after) = (imprint.surface.topology(), divided.topology());
    let is_kept = before.genus == after.genus
        && before.components == after.components
        && before.bad_edges == after.bad_edges;
    let off = (imprint.surface.area() / divided.area() - 1.0).abs();
    match is_kept && off < 1e-6 && imprint.inside.len() == imprint.triangles.len() {
        true => Ok(()),
        false => Err(format!(
            "a divided surface is another: {before:?}, {after:?}, {off}"
        )),
    }
}

fn check_model(model: &Model) -> Result<(), String> {
    let bodies = model
        .bodies
        .iter()
        .try_for_each(|body| body.mesh.check_closed().map(|_| ()));
    bodies.map_err(|e| e.to_string())?;
    match model
        .parts
        .iter()
        .find(|part| !part.place.is_finite() || part.body as usize >= model.bodies.len())
    {
        Some(part) => Err(format!("the part `{}` stands nowhere", part.name)),
        None => Ok(()),
    }
}

fn check_facade(layout: &FacadeLayout) -> Result<(), String> {
    let slack = 1e-6 * layout.width.max(layout.height);
    let is_inside = |low: f64, size: f64, whole: f64| {
        low >= -slack && size > 0.0 && low + size <= whole + slack
    };
    let is_sound = |cell: &fretwork_geometry::FacadeCell| {
        is_inside(cell.x, cell.width, layout.width) && is_inside(cell.y, cell.height, layout.height)
    };
    match layout.cells.iter().find(|cell| !is_sound(cell)) {
        Some(cell) => Err(format!(
            "a shape of {}{} leaves the canvas",
            cell.symbol_x, cell.symbol_y
        )),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::{Point, Polygon};

    #[test]
    fn a_wrong_count_is_found() {
        let square = [[0., 0.], [4., 0.], [4., 4.], [0., 4.]]
            .map(Point::from)
            .to_vec();
        let cutout = Cutout::planar(vec![Polygon {
            outer: square,
            holes: vec![],
        }])
        .unwrap();
        let value = |cutout: Cutout| Data::Cutout(cutout.into());
        assert_eq!(check(&value(cutout.clone())), Ok(()));
        assert!(
            check(&value(Cutout { holes: 1, ..cutout }))
                .unwrap_err()
                .contains("holes")
        );
    }
}
