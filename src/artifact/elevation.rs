//! Facades on sheets: a layer for each layer of the facade, with what is seen of its cells, and one for
//! the lines in them: fills, and what is seen of meshes.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::mesh_lines::MeshLines;
use super::style::Styles;
use fretwork_fabricate::{Color, Item, Layer, Role as Made, Sheet};
use fretwork_geometry::facade::Facade;
use fretwork_geometry::polygon::AreaError;
use fretwork_geometry::{Affine, CurveLabels, Curves, Polygon};
use fretwork_language::kinds::artifacts::Role;

/// The layers of a facade's elevation, moved by `map`: outlines, or the colours of its materials, then a layer for each
/// colour.
///
/// # Errors
/// When areas cannot be computed.
pub fn elevation(
    facade: &Facade,
    role: Role,
    is_filled: bool,
    map: &Affine,
    styles: &Styles<'_>,
) -> Result<Vec<Layer>, AreaError> {
    let areas = facade.visible_areas()?;
    let meshes = MeshLines::new(facade);
    let mut layers = Vec::new();
    for (number, name) in facade.layout.layers.iter().enumerate() {
        let own = || {
            areas
                .iter()
                .enumerate()
                .filter(|(cell, _)| facade.layout.cells[*cell].layer as usize == number)
        };
        let moved = |area: &[Polygon]| {
            area.iter()
                .map(|polygon| transformed(polygon, map))
                .collect::<Vec<_>>()
        };
        let mut by_color: BTreeMap<Option<[u8; 3]>, Vec<Polygon>> = BTreeMap::new();
        for (cell, area) in own() {
            let color = facade
                .shape(cell)
                .map(|shape| shape.color())
                .filter(|_| is_filled);
            by_color.entry(color).or_default().extend(moved(area));
        }
        by_color.retain(|_, areas| !areas.is_empty());
        let several = by_color.len() > 1;
        for (color, areas) in by_color {
            let color = color.map(Color);
            let called: Arc<str> = color
                .filter(|_| several)
                .map_or_else(|| name.clone(), |color| format!("{name} {color}").into());
            layers.push(styles.painted(&called, name, role, &areas, color));
        }
        let mut lines = styles.engraved(&format!("{name} lines").into(), name);
        for (cell, area) in own() {
            if let Some(curves) = facade.fills.get(&(cell as u32)) {
                lines.items.extend(clipped(curves, area, map)?);
            }
            if let Some(curves) = meshes.in_cell(cell).filter(|_| !area.is_empty()) {
                lines.items.extend(clipped(&curves, area, map)?);
            }
        }
        layers.extend(Some(lines).filter(|lines| !lines.items.is_empty()));
    }
    Ok(layers)
}

/// The parts of lines inside of `area`.
fn clipped(curves: &Curves, area: &[Polygon], map: &Affine) -> Result<Vec<Item>, AreaError> {
    let layer = Layer::of_curves(
        "",
        Made::Engrave,
        fretwork_fabricate::Style::outline(1.0),
        curves,
    );
    let sheet = fretwork_fabricate::clip(
        &Sheet {
            page: None,
            unit_mm: 1.0,
            layers: vec![layer],
        },
        area,
    )?;
    let items = sheet.layers.into_iter().flat_map(|layer| layer.items);
    Ok(items.map(|item| transformed_item(item, map)).collect())
}

fn transformed_item(item: Item, map: &Affine) -> Item {
    match item {
        Item::Line(points) => {
            let mut curves = Curves::new();
            curves.push(points, CurveLabels::default());
            Item::Line(curves.transformed(map).points().to_vec())
        }
        Item::Area(polygon) => Item::Area(transformed(&polygon, map)),
    }
}

fn transformed(polygon: &Polygon, map: &Affine) -> Polygon {
    let ring = |ring: &Vec<fretwork_geometry::Point>| ring.iter().map(|p| map.apply(*p)).collect();
    Polygon {
        outer: ring(&polygon.outer),
        holes: polygon.holes.iter().map(ring).collect(),
    }
}
