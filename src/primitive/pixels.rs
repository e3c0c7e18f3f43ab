//! Raster exemplars: pictures from files, and drawings of the spec as pictures.

use std::sync::Arc;

use fretwork_action::{Action, Data, StageResult, Value};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::drawing::{Drawing, FillRule, Shape, Stroke};
use fretwork_geometry::{Bounds, Curves, Pixels, Point, Polygon};
use fretwork_language::kinds::exemplars::{Grain, ImageExemplar, Rasterize, SolidPixels};
use fretwork_language::scalar::FilePath;
use fretwork_source::image::{self, Picture};

/// How far the period of a picture may be from that of its region, as a part of it.
const OFF_PERIOD: f64 = 0.001;
/// More pixels than this are refused.
const MOST_PIXELS: f64 = 16e6;
/// How far a round corner may be from what it stands for, in pixels.
const TOLERANCE: f64 = 0.05;

/// The error of an exemplar.
fn failed(action: &Action, message: String) -> Vec<Diagnostic> {
    vec![Diagnostic::error(message).at(action.span(), "in this exemplar")]
}

/// Reads the picture and tells its solid pixels from the empty ones.
///
/// # Errors
/// When a file is no picture, or the mask has another size.
pub fn picture(action: &Action, kind: &ImageExemplar) -> StageResult {
    let read = colors(action, &kind.file)?;
    // Rec. 601, of the values as stored.
    let luma = |[r, g, b]: [u8; 3]| {
        (0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b)) / 255.0
    };
    let solid: Vec<bool> = match &kind.solid {
        SolidPixels::DarkerThan(limit) => read.values.iter().map(|c| luma(*c) < limit.0).collect(),
        SolidPixels::LighterThan(limit) => read.values.iter().map(|c| luma(*c) > limit.0).collect(),
        SolidPixels::Mask(file) => {
            let mask = colors(action, file)?;
            if (mask.width, mask.values.len()) != (read.width, read.values.len()) {
                let message = format!(
                    "the mask has {} pixels, the picture has {}",
                    size(&mask),
                    size(&read)
                );
                let at = action.definition.field(&["solid"]);
                let error = Diagnostic::error(message).at(at, "this mask");
                return Err(vec![
                    error.help("a mask has a pixel for each of its picture"),
                ]);
            }
            mask.values.iter().map(|c| luma(*c) > 0.5).collect()
        }
    };
    check_mixed(action, &solid, "solid")?;
    let pixels = exemplar(read, solid, kind.pixel_size.0, &kind.grain);
    Ok((Data::Pixels(Arc::new(pixels)), Vec::new()))
}

/// An error at the field `by` that decides on them, where all pixels are solid or none is.
fn check_mixed(action: &Action, solid: &[bool], by: &str) -> Result<(), Vec<Diagnostic>> {
    let what = match (solid.contains(&true), solid.contains(&false)) {
        (true, true) => return Ok(()),
        (true, false) => "all pixels of the exemplar are solid: there is no pattern to make",
        _ => "all pixels of the exemplar are empty: nothing would remain of a surface",
    };
    let help = match by {
        "solid" => {
            "another threshold, `lighter_than` for `darker_than`, or a `mask` tells solid pixels from empty ones"
        }
        _ => {
            "what is filled is solid, of lines their `stroke`: does the `region` hold what is drawn, and what is not?"
        }
    };
    let at = action.definition.field(&[by]);
    Err(vec![
        Diagnostic::error(what)
            .at(at, "in this exemplar")
            .help(help),
    ])
}

fn size<T>(picture: &Picture<T>) -> String {
    format!(
        "{} × {}",
        picture.width,
        picture.values.len() / picture.width
    )
}

fn colors(action: &Action, file: &FilePath) -> Result<Picture<[u8; 3]>, Vec<Diagnostic>> {
    let (path, bytes) = action.file(&file.0)?;
    image::colors(&bytes).map_err(|e| failed(action, format!("cannot read `{path}`: {e}")))
}

fn exemplar(picture: Picture<[u8; 3]>, solid: Vec<bool>, pixel_size: f64, grain: &Grain) -> Pixels {
    Pixels {
        width: picture.width,
        rgb: picture.values,
        solid,
        pixel_size,
        feature_radius: grain.feature_radius.map(|radius| radius.0),
        tileable: grain.tileable,
    }
}

/// Draws what is filled in black on white. A periodic region makes a tileable picture.
///
/// # Errors
/// When there would be too many pixels, or the drawing has no area.
pub fn rasterize(action: &Action, kind: &Rasterize) -> StageResult {
    let region = action.input(&kind.region);
    let bounds = region.bounds();
    let sides = [bounds.width(), bounds.height()];
    let (columns, rows, size) = match region.tile() {
        Some(_) => fitted(sides, kind.pixel_size.0),
        None => grid(sides, kind.pixel_size.0),
    };
    if columns * rows > MOST_PIXELS {
        let message = format!("the picture would have {columns} × {rows} pixels");
        let error = Diagnostic::error(message).at(action.span(), "in this exemplar");
        return Err(vec![error.help("choose a larger `pixel_size`")]);
    }
    let mut area = area(action, kind)?;
    if let Some(tile) = region.tile() {
        area = repeated(&area, tile.period);
    }
    let solid = painted(&area, bounds, columns as usize, rows as usize);
    check_mixed(action, &solid, "from")?;
    let ink = |solid: &bool| if *solid { [0; 3] } else { [255; 3] };
    let picture = Picture {
        width: columns as usize,
        values: solid.iter().map(ink).collect(),
    };
    let mut pixels = exemplar(picture, solid, size, &kind.grain);
    pixels.tileable |= region.tile().is_some();
    Ok((Data::Pixels(Arc::new(pixels)), Vec::new()))
}

/// Columns and rows of pixels of a size, as many as come nearest to the sides.
fn grid([width, height]: [f64; 2], size: f64) -> (f64, f64, f64) {
    let count = |side: f64| (side / size).round().max(1.0);
    (count(width), count(height), size)
}

/// Columns and rows that a period has, and the size of its pixels, at most that asked for: what repeats on the object must repeat
/// after the period. Of the sizes that go into the width, a little smaller each, the first that also goes into the height.
fn fitted([width, height]: [f64; 2], most: f64) -> (f64, f64, f64) {
    let least = (width / most - 1e-9).ceil().max(1.0);
    let off = |columns: &f64| {
        let rows = height * columns / width;
        (rows - rows.round().max(1.0)).abs() / rows
    };
    let tried = || (0..=(least / 4.0).max(8.0) as u64).map(|more| least + more as f64);
    let exact = tried().find(|columns| off(columns) < OFF_PERIOD);
    let columns = exact.or_else(|| tried().min_by(|a, b| off(a).total_cmp(&off(b))));
    let size = width / columns.unwrap_or(least);
    grid([width, height], size)
}

/// The area that is solid: that of shapes; of lines what closed ones enclose (by the even-odd rule),
/// and their strokes where they have a width.
fn area(action: &Action, kind: &Rasterize) -> Result<Vec<Polygon>, Vec<Diagnostic>> {
    let tolerance = TOLERANCE * kind.pixel_size.0;
    let of = |drawing: &Drawing| {
        drawing
            .areas(tolerance)
            .map_err(|e| failed(action, e.to_string()))
    };
    match action.value(&kind.from) {
        Value::Data(Data::Region(region)) => Ok(region.area.clone()),
        Value::Data(Data::Cutout(cutout)) => Ok(cutout.flat()),
        Value::Data(Data::Drawing(drawing)) => of(drawing),
        Value::Data(Data::Curves(curves)) => of(&drawing(curves, kind.stroke.map(|width| width.0))),
        _ => Err(vec![action.unsupported("this as a picture")]),
    }
}

/// Lines as a drawing.
fn drawing(curves: &Curves, width: Option<f64>) -> Drawing {
    let is_closed = |path: &Vec<Point>| path.len() > 2 && path.first() == path.last();
    let paths = curves.iter().map(|curve| curve.points.to_vec());
    let (closed, open) = paths.partition(is_closed);
    let shape = |paths, filled| Shape {
        label: fretwork_geometry::LabelSet::default(),
        paths,
        filled,
        rule: FillRule::EvenOdd,
        stroke: width.map(Stroke::round),
    };
    Drawing {
        shapes: vec![shape(closed, true), shape(open, false)],
        ..Drawing::default()
    }
}

/// An area with its copies one period away on all sides.
fn repeated(area: &[Polygon], period: Point) -> Vec<Polygon> {
    let mut all = Vec::with_capacity(9 * area.len());
    for (i, j) in (-1..=1).flat_map(|i| (-1..=1).map(move |j| (i, j))) {
        let offset = Point::new(f64::from(i) * period.x, f64::from(j) * period.y);
        let moved = |ring: &Vec<Point>| ring.iter().map(|p| *p + offset).collect();
        all.extend(area.iter().map(|polygon| Polygon {
            outer: moved(&polygon.outer),
            holes: polygon.holes.iter().map(moved).collect(),
        }));
    }
    all
}

/// The pixels whose middles lie in one of the polygons, row by row.
fn painted(area: &[Polygon], bounds: Bounds, columns: usize, rows: usize) -> Vec<bool> {
    let step = Point::new(
        bounds.width() / columns as f64,
        bounds.height() / rows as f64,
    );
    let to_pixels =
        |p: &Point| Point::new((p.x - bounds.min.x) / step.x, (p.y - bounds.min.y) / step.y);
    let mut solid = vec![false; columns * rows];
    for polygon in area {
        let rings: Vec<Vec<Point>> = polygon
            .rings()
            .map(|ring| ring.iter().map(to_pixels).collect())
            .collect();
        let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); rows];
        for ring in &rings {
            let ends = ring.iter().cycle().skip(1);
            ring.iter()
                .zip(ends)
                .for_each(|(a, b)| cross(*a, *b, &mut crossings));
        }
        for (row, line) in crossings.iter_mut().enumerate() {
            line.sort_by(f64::total_cmp);
            for pair in line.chunks_exact(2) {
                let inside = |x: f64| (x - 0.5).ceil().clamp(0.0, columns as f64) as usize;
                solid[row * columns..][inside(pair[0])..inside(pair[1])].fill(true);
            }
        }
    }
    solid
}

/// Notes where a side crosses the middle lines of rows.
fn cross(a: Point, b: Point, crossings: &mut [Vec<f64>]) {
    let (low, high) = if a.y < b.y { (a, b) } else { (b, a) };
    let row = |y: f64| (y - 0.5).ceil().clamp(0.0, crossings.len() as f64) as usize;
    let (first, end) = (row(low.y), row(high.y));
    for (n, line) in (first..end).zip(crossings.iter_mut().skip(first)) {
        let t = (n as f64 + 0.5 - low.y) / (high.y - low.y);
        line.push(low.x + t * (high.x - low.x));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_are_those_whose_middles_are_inside() {
        let ring = |points: &[[f64; 2]]| points.iter().map(|p| Point::from(*p)).collect();
        let polygon = Polygon {
            outer: ring(&[[0.6, 0.2], [7.4, 0.0], [7.0, 5.7], [1.0, 6.0]]),
            holes: vec![ring(&[[3.0, 2.0], [3.0, 4.0], [5.0, 4.2]])],
        };
        let bounds = Bounds {
            min: Point::new(0.0, -1.0),
            max: Point::new(8.0, 7.0),
        };
        let solid = painted(std::slice::from_ref(&polygon), bounds, 16, 16);
        for (n, is_solid) in solid.iter().enumerate() {
            let middle = Point::new(
                ((n % 16) as f64 + 0.5) * 0.5,
                ((n / 16) as f64 + 0.5) * 0.5 - 1.0,
            );
            assert_eq!(*is_solid, polygon.contains(middle), "{middle:?}");
        }
        let share = solid.iter().filter(|s| **s).count() as f64 / 4.0;
        assert!((share - polygon.area()).abs() < 1.5, "{share}");
    }

    #[test]
    fn copies_of_a_tile_come_in_from_all_sides() {
        let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let polygon = Polygon {
            outer: square.map(Point::from).to_vec(),
            holes: vec![],
        };
        let area = repeated(&[polygon], Point::new(4.0, 4.0));
        let bounds = Bounds {
            min: Point::ORIGIN,
            max: Point::new(4.0, 4.0),
        };
        let solid = painted(&area, bounds, 4, 4);
        let expected = [true, false, false, true];
        let rows = (0..4).flat_map(|j| (0..4).map(move |i| expected[i] && expected[j]));
        assert_eq!(solid, rows.collect::<Vec<_>>());
    }

    #[test]
    fn a_drawing_turned_over_is_no_other() {
        let closed = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [0.0, 0.0]];
        let mut curves = Curves::new();
        curves.push(closed.map(Point::from), Default::default());
        curves.push(
            [[6.0, 0.0], [6.0, 4.0]].map(Point::from),
            Default::default(),
        );
        let area = |width| -> f64 {
            let areas = drawing(&curves, width).areas(0.01).unwrap();
            areas.iter().map(Polygon::area).sum()
        };
        assert_eq!(area(None), 16.0);
        assert!(area(Some(1.0)) > 16.0 + 4.0 + 8.0);
        let mirrored = curves.transformed(&fretwork_geometry::Affine::scale(-1.0, 1.0));
        assert_eq!(drawing(&mirrored, None).areas(0.01).unwrap().len(), 1);
    }
}
