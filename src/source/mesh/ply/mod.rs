//! PLY, text and binary of either byte order: positions and faces. Other elements and properties are skipped.
//!
//! `ply-rs-bw` reads these files too. It is not used here because its rows are records of named values, each
//! with allocations of its own, which a large scan multiplies, and because it brings a parser
//! generator that is compiled for the header alone.

mod header;
mod rows;
#[cfg(test)]
mod tests;

use self::header::{Element, Property, header};
use self::rows::Rows;
use super::face::Faces;
use super::limit::MOST_TRIANGLES;
use super::lines::unmarked;
use fretwork_geometry::{Mesh, Point3};

/// The faces of a PLY file as triangles, and what was not read. Memory is proportional to the file.
///
/// # Errors
/// A message when the file is broken or cut off, a row does not fit the header, or a coordinate is
/// not finite.
pub fn read(bytes: &[u8]) -> Result<(Mesh, Vec<String>), String> {
    let (header, body) = header(unmarked(bytes)?)?;
    let mut rows = Rows::new(&header, body);
    let (mut positions, mut faces) = (Vec::new(), Faces::counted_from(0));
    let mut told = Vec::new();
    for element in &header.elements {
        let properties = element.properties.iter();
        let least = properties.map(|p| p.least(header.form)).sum::<u64>();
        if element.count.saturating_mul(least) > rows.rest().len() as u64 + 1 {
            let (count, name) = (element.count, &element.name);
            return Err(format!(
                "it is cut off: it claims {count} rows of `{name}`, more than the file has bytes for"
            ));
        }
        match &*element.name {
            "vertex" => read_vertices(&mut rows, element, &mut positions)?,
            "face" => read_faces(&mut rows, element, &mut faces)?,
            name => {
                if name == "tristrips" {
                    told.push("its strips of triangles are not read; save it with faces".into());
                }
                skip(&mut rows, element)?;
            }
        }
    }
    told.extend(rows.finish()?);
    let triangles = faces
        .triangles(&positions)
        .map_err(|(row, error)| format!("row {row} of `face`: {error}"))?;
    Ok((
        Mesh {
            positions,
            triangles,
        },
        told,
    ))
}

fn skip(rows: &mut Rows<'_>, element: &Element) -> Result<(), String> {
    rows.each(element, |rows, _| {
        element.properties.iter().try_for_each(|p| rows.pass(p))
    })
}

fn read_vertices(
    rows: &mut Rows<'_>,
    element: &Element,
    positions: &mut Vec<Point3>,
) -> Result<(), String> {
    let at = |name: &str| {
        element
            .properties
            .iter()
            .position(|p| p.name == name && p.length.is_none())
    };
    let (Some(x), Some(y), Some(z)) = (at("x"), at("y"), at("z")) else {
        return Err("its vertices have no x, y and z".into());
    };
    rows.each(element, |rows, _| {
        let mut point = [0.0; 3];
        for (i, property) in element.properties.iter().enumerate() {
            match [x, y, z].iter().position(|axis| *axis == i) {
                Some(axis) => point[axis] = rows.number(property.item)?,
                None => rows.pass(property)?,
            }
        }
        // In binary files of single floats NaN stands for points that were not measured.
        if point.iter().any(|v| !v.is_finite()) {
            return Err("it has a coordinate that is not a finite number".into());
        }
        if positions.len() >= u32::MAX as usize {
            return Err("it has too many vertices".into());
        }
        positions.push(point.into());
        Ok(())
    })
}

fn read_faces(rows: &mut Rows<'_>, element: &Element, faces: &mut Faces) -> Result<(), String> {
    let is_corners =
        |p: &Property| matches!(&*p.name, "vertex_indices" | "vertex_index") && p.length.is_some();
    if !element.properties.iter().any(is_corners) && element.count > 0 {
        return Err("its faces have no `vertex_indices`".into());
    }
    let mut corners = Vec::new();
    rows.each(element, |rows, number| {
        for property in &element.properties {
            let Some(length) = property.length.filter(|_| is_corners(property)) else {
                rows.pass(property)?;
                continue;
            };
            corners.clear();
            for _ in 0..rows.length(length, property.item)? {
                let corner = rows.number(property.item)?;
                if !(0.0..f64::from(u32::MAX)).contains(&corner) || corner.fract() != 0.0 {
                    return Err(format!("a face names vertex {corner}"));
                }
                corners.push(corner as u32);
            }
            faces.push(&corners, number as usize);
        }
        if faces.most_triangles() > MOST_TRIANGLES {
            return Err("it has too many triangles".into());
        }
        Ok(())
    })
}
