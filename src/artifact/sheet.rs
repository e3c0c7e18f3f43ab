//! Values in the drawing plane as a sheet: parts with their styles, clipped, with the beam's width
//! made up for, in an order that a machine likes.

use std::cmp::Ordering;
use std::sync::Arc;

use super::elevation::elevation;
use super::fault::Fault;
use super::page::Page;
use super::paper::{beyond, on_page};
use super::ready::Ready;
use super::style::Styles;
use super::united::united;
use fretwork_action::{Data, Value};
use fretwork_diagnostic::Diagnostic;
use fretwork_fabricate::format::dxf_color;
use fretwork_fabricate::{Item, Layer, Sheet, inside_first};
use fretwork_geometry::{
    Affine, CurveLabels, Curves, Pixels, Point, Polygon, Region, SpaceCurve, cutout,
};
use fretwork_language::kinds::artifacts::{Draw, Format, Role};

/// The width of a line in millimetres, where the artifact does not say.
const STROKE: f64 = 0.25;

/// A value, what is done with it, and where its copies stand.
pub struct Part<'a> {
    /// The name of its node.
    pub name: Arc<str>,
    /// The value.
    pub value: &'a Value,
    /// Its number among the parts that the artifact names.
    pub number: usize,
    /// What a machine does with it.
    pub role: Role,
    /// The layer of all its lines, where that is said.
    pub layer: Option<Arc<str>>,
    /// The number of the pen that draws it, where that is said.
    pub pen: Option<u32>,
    /// The place of each copy.
    pub maps: Vec<Affine>,
}

/// The sheet that shows `parts`, made ready for a machine, before a window is cut of it.
///
/// # Errors
/// When a part cannot be drawn, or its areas cannot be computed.
pub fn ready_sheet(parts: &[Part<'_>], page: &Page<'_>) -> Result<ReadySheet, Fault> {
    let styles = styles(page);
    let sheet = composed(parts, page, &styles)?;
    let region = region(page).filter(|_| page.artifact.clip);
    let area = region.as_ref().map(|region| &region.area[..]);
    let ready = Ready::new(sheet, page, area, page.format == Format::Dxf)?;
    // A label that is not in a window may be elsewhere.
    let unused = match page.window {
        Some(_) => Vec::new(),
        None => styles.unused(),
    };
    Ok(ReadySheet { ready, unused })
}

/// A sheet that was made ready, of which windows are cut.
pub struct ReadySheet {
    ready: Ready,
    /// Warnings about looks of what is not there.
    unused: Vec<Diagnostic>,
}

impl ReadySheet {
    /// What of it comes near the window of `page`.
    pub fn near(&self, page: &Page<'_>) -> ReadySheet {
        ReadySheet {
            ready: self.ready.near(page),
            unused: self.unused.clone(),
        }
    }

    /// What of it lies in the window of `page`, on its paper if it has one; and warnings.
    ///
    /// # Errors
    /// When what a closed line fills cannot be computed.
    pub fn sheet(self, page: &Page<'_>) -> Result<(Sheet, Vec<Diagnostic>), Fault> {
        let is_dxf = page.format == Format::Dxf;
        let (mut sheet, mut warnings) = self.ready.cut(page)?;
        if page.window.is_some() && !page.artifact.optimize {
            put_in_order(&mut sheet);
            sheet = inside_first(&sheet);
        }
        if !is_dxf {
            sheet = on_page(sheet, page)?;
            warnings.extend(beyond(&sheet, page));
        }
        warnings.extend(self.unused);
        if is_dxf {
            warnings.extend(dxf_color::warnings(&sheet.layers));
        }
        Ok((sheet, warnings))
    }
}

/// Puts lines that may be drawn in any order in one that depends on them alone, and layers that look the same in that of their
/// names: what is near a window was drawn in another order than the whole. Layers of which nothing is seen are left out.
fn put_in_order(sheet: &mut Sheet) {
    let is_free =
        |layer: &Layer| layer.style.fill.is_none() && layer.role != fretwork_fabricate::Role::Cut;
    sheet.layers.retain(|layer| !layer.items.is_empty());
    let layers = sheet.layers.iter_mut().filter(|layer| is_free(layer));
    layers.for_each(|layer| layer.items.sort_by(by_place));
    // Of what is cut, outlines that the window divides enclose others that it does not.
    let is_open = |item: &Item| item.points().next() != item.points().last();
    let is_cut = |layer: &&mut Layer| {
        layer.style.fill.is_none() && layer.role == fretwork_fabricate::Role::Cut
    };
    for layer in sheet.layers.iter_mut().filter(is_cut) {
        let order = |a: &Item, b: &Item| is_open(a).cmp(&is_open(b)).then(by_place(a, b));
        layer.items.sort_by(order);
    }
    let are_alike = |a: &Layer, b: &Layer| is_free(a) && (a.role, a.style) == (b.role, b.style);
    for alike in sheet.layers.chunk_by_mut(are_alike) {
        alike.sort_by(|a, b| a.name.cmp(&b.name));
    }
}

/// By the coordinates of the first points that differ.
fn by_place(a: &Item, b: &Item) -> Ordering {
    let compared = |(p, q): (Point, Point)| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y));
    let mut both = a.points().zip(b.points()).map(compared);
    let first = both.find(|order| order.is_ne());
    first.unwrap_or_else(|| a.points().count().cmp(&b.points().count()))
}

/// The sheet as what is made of it in the end: nothing is moved for a beam, left out because it is there twice, or put in
/// order, and areas are areas also where a machine is led along their outlines.
///
/// # Errors
/// As of [`ready_sheet`].
pub fn finished(parts: &[Part<'_>], page: &Page<'_>) -> Result<Sheet, Fault> {
    let sheet = composed(parts, page, &styles(page))?;
    match region(page).filter(|_| page.artifact.clip) {
        Some(region) => fretwork_fabricate::clip(&sheet, &region.area)
            .map_err(|e| Diagnostic::error(e.to_string()).into()),
        None => Ok(sheet),
    }
}

fn styles<'a>(page: &Page<'a>) -> Styles<'a> {
    Styles::new(page.artifact, STROKE, page.format != Format::Png).in_units(page.width_mm)
}

/// The region of the page as it lies on the sheet.
fn region(page: &Page<'_>) -> Option<Region> {
    let turn = page.turn();
    let region = page.region.as_ref();
    region.map(|region| region.transformed(&turn))
}

/// All layers as they are drawn.
fn composed(parts: &[Part<'_>], page: &Page<'_>, styles: &Styles<'_>) -> Result<Sheet, Fault> {
    let mut layers = Vec::new();
    for part in parts {
        let styles = styles.of_part(part.number, part.layer.clone(), part.pen);
        layers.extend(part_layers(part, page, &styles)?);
    }
    styles.check_layers(&layers)?;
    let sheet = Sheet {
        page: region(page).as_ref().map(Region::bounds),
        unit_mm: page.unit_mm,
        layers,
    };
    // What is near a window was drawn, perhaps nothing.
    match page.window {
        Some(_) => sheet.check_numbers()?,
        None => sheet.check()?,
    }
    Ok(sheet)
}

/// The layers of a part: one for each set of labels, in the order in which they first occur.
fn part_layers(
    part: &Part<'_>,
    page: &Page<'_>,
    styles: &Styles<'_>,
) -> Result<Vec<Layer>, Diagnostic> {
    let mut layers = Vec::new();
    for map in &part.maps {
        merge(&mut layers, copy_layers(part, map, page, styles)?);
    }
    Ok(layers)
}

/// The layers of one copy of a part, moved by `map`.
fn copy_layers(
    part: &Part<'_>,
    map: &Affine,
    page: &Page<'_>,
    styles: &Styles<'_>,
) -> Result<Vec<Layer>, Diagnostic> {
    let draw = page.artifact.draw;
    let is_filled = draw == Some(Draw::Filled);
    let (name, role) = (&part.name, part.role);
    // What is upright on a screen stays upright.
    let upright = map;
    let map = &map.then(page.turn());
    let Value::Data(data) = part.value else {
        return Err(undrawable(name));
    };
    let lines = |curves: &Curves| -> Result<Vec<Layer>, Diagnostic> {
        Ok(styles.lines(name, role, &*united(curves, page)?))
    };
    Ok(match data {
        Data::Curves(curves) if is_filled => {
            let curves = curves.transformed(map);
            let faces = page.planar_map(&curves)?;
            styles.filled(name, role, &curves, &faces)
        }
        Data::Curves(curves) => lines(&curves.transformed(map))?,
        // Borders within a map and lines of it have labels of their own.
        Data::Region(region) if !is_filled && region.has_lines() => {
            lines(&region.transformed(map).contour)?
        }
        Data::Region(region) => styles.region(name, role, &region.transformed(map), is_filled),
        Data::Cutout(cutout) => {
            let moved = cutout::mapped(&cutout.flat(), |p| map.apply(p));
            let area = fretwork_fabricate::rounded(&moved, page.unit_mm)?;
            // Cutouts are shapes: they are filled unless their outlines are asked for.
            styles.areas(name, role, &area, draw != Some(Draw::Outline))
        }
        Data::Facade(facade) => {
            let is_painted = draw.map_or(page.format == Format::Png, |draw| draw == Draw::Filled);
            elevation(facade, role, is_painted, upright, styles)
                .map_err(|e| Diagnostic::error(e.to_string()))?
        }
        Data::Drawing(drawing) if is_filled => styles
            .drawing(name, role, &drawing.transformed(map))
            .map_err(|e| Diagnostic::error(e.to_string()))?,
        Data::Drawing(drawing) => lines(&drawing.transformed(map).curves())?,
        Data::Curve(curve) => styles.lines(name, role, &from_above(curve).transformed(upright)),
        Data::Pixels(pixels) => {
            let area = fretwork_geometry::polygon::unite(&runs(pixels))
                .map_err(|e| Diagnostic::error(e.to_string()))?;
            let region = Region::of_area(area).transformed(upright);
            styles.areas(name, role, &region.area, draw != Some(Draw::Outline))
        }
        Data::Surface(_)
        | Data::Solid(_)
        | Data::Shell(_)
        | Data::ShellStep(_)
        | Data::Analysis(_)
        | Data::File(_) => return Err(undrawable(name)),
    })
}

/// The solid pixels of a picture, a rectangle for each run of them in a row.
fn runs(pixels: &Pixels) -> Vec<Polygon> {
    let mut all = Vec::new();
    for (row, line) in pixels.solid.chunks_exact(pixels.width).enumerate() {
        let mut column = 0;
        for run in line.chunk_by(|a, b| a == b) {
            if run[0] {
                let corner =
                    |x: usize, y: usize| Point::new(x as f64, y as f64) * pixels.pixel_size;
                let rectangle =
                    Region::rectangle(corner(column, row), corner(column + run.len(), row + 1));
                all.extend(rectangle.area);
            }
            column += run.len();
        }
    }
    all
}

fn undrawable(name: &str) -> Diagnostic {
    Diagnostic::error(format!("drawing `{name}` is not supported yet"))
}

/// A curve of the world as it is seen from above, in the drawing plane.
fn from_above(curve: &SpaceCurve) -> Curves {
    let mut curves = Curves::new();
    let closing = curve.points().first().filter(|_| curve.is_closed());
    let points = curve.points().iter().chain(closing);
    curves.push(
        points.map(|p| Point::new(p.x, -p.y)),
        CurveLabels::default(),
    );
    curves
}

/// Adds layers, each to the one of its name, role and look if there is one.
fn merge(layers: &mut Vec<Layer>, more: Vec<Layer>) {
    for layer in more {
        let is_same =
            |l: &&mut Layer| (&l.name, l.role, l.style) == (&layer.name, layer.role, layer.style);
        match layers.iter_mut().find(is_same) {
            Some(known) => known.items.extend(layer.items),
            None => layers.push(layer),
        }
    }
}
