//! PNG: a preview of what the SVG shows, on white.

use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{Options, Tree};

use super::chunk::with_chunk;
use crate::format::svg;
use crate::sheet::Sheet;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Bounds, budget};

/// The most pixels along a side.
const LONGEST: u32 = 16_384;
/// The most pixels.
const MOST: u64 = 1 << 26;

/// The width of the thinnest lines in pixels. What is no wider than one is drawn by a method that lets upright lines lean.
const THINNEST: f64 = 1.02;

/// Bytes for a pixel, with those that are encoded, and steps for a point of an item.
const PIXEL: usize = 12;
const POINT_STEPS: u64 = 30;

/// Width and height in pixels of an image of `page` that is `width` pixels wide. Errors: an image
/// without pixels or with too many (16384 along a side, 2^26 in all).
pub fn size(page: Bounds, width: u32) -> Result<(u32, u32), Diagnostic> {
    let height = (f64::from(width) * page.height() / page.width())
        .round()
        .max(1.0);
    if width == 0
        || width > LONGEST
        || height > f64::from(LONGEST)
        || f64::from(width) * height > MOST as f64
    {
        let message = format!("an image of {width} × {height} pixels cannot be made");
        return Err(Diagnostic::error(message).help("choose another `width`"));
    }
    Ok((width, height as u32))
}

/// The page as an image `width` pixels wide. Lines are drawn at least one pixel wide, so that thin
/// ones are seen. Errors: as of [`size`].
pub fn write(sheet: &Sheet, width: u32) -> Result<Vec<u8>, Diagnostic> {
    let page = sheet.page_mm();
    let (width, height) = size(page, width)?;
    charge(sheet, width, height);
    let text = svg::preview(sheet, THINNEST * page.width() / f64::from(width));
    let broken = |e: String| Diagnostic::error(format!("the preview cannot be drawn: {e}"));
    let tree = Tree::from_data(&text, &Options::default()).map_err(|e| broken(e.to_string()))?;
    let mut image = Pixmap::new(width, height).ok_or_else(|| broken("no memory".into()))?;
    image.fill(Color::WHITE);
    let scale = Transform::from_scale(
        width as f32 / tree.size().width(),
        height as f32 / tree.size().height(),
    );
    resvg::render(&tree, scale, &mut image.as_mut());
    image.encode_png().map_err(|e| broken(e.to_string()))
}

/// Millimetres in an inch.
const INCH: f64 = 25.4;

/// The page with so many pixels an inch, which the file says too, so that it is printed in its size. Errors: as of [`size`].
pub fn write_at(sheet: &Sheet, dpi: f64) -> Result<Vec<u8>, Diagnostic> {
    let width = (sheet.page_mm().width() / INCH * dpi).round();
    if !(1.0..=f64::from(LONGEST)).contains(&width) {
        let message = format!("an image {width} pixels wide cannot be made");
        return Err(Diagnostic::error(message).help("choose another `dpi`"));
    }
    Ok(with_resolution(&write(sheet, width as u32)?, dpi))
}

/// A PNG file with a chunk that says how many pixels a metre has (PNG specification, 11.3.4.3).
fn with_resolution(png: &[u8], dpi: f64) -> Vec<u8> {
    let a_metre = (dpi * 1000.0 / INCH).round() as u32;
    let a_metre = a_metre.to_be_bytes();
    with_chunk(png, *b"pHYs", &[&a_metre[..], &a_metre, &[1]].concat())
}

/// Charges for the pixels, and for drawing items one over another: each is drawn within its box.
fn charge(sheet: &Sheet, width: u32, height: u32) {
    let pixels = width as usize * height as usize;
    budget::make("pixels", pixels, PIXEL);
    let page = sheet.page_mm();
    let scale = f64::from(width) / page.width() * sheet.unit_mm;
    for item in sheet.layers.iter().flat_map(|layer| &layer.items) {
        let bounds = Bounds::of(item.points());
        let box_pixels = (bounds.width() * scale + 2.0) * (bounds.height() * scale + 2.0);
        let drawn = box_pixels.clamp(0.0, pixels as f64) as u64;
        budget::spend(
            "pixels of items",
            drawn / 4 + POINT_STEPS * item.points().count() as u64,
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Color, Item, Layer, Role, Style};
    use fretwork_geometry::{Point, Polygon};

    fn image(items: Vec<Item>, style: Style, width: u32) -> Pixmap {
        let page = Bounds {
            min: Point::new(-100.0, 0.0),
            max: Point::new(100.0, 100.0),
        };
        let layers = vec![Layer {
            name: "a".into(),
            role: Role::Draw,
            style,
            items,
        }];
        let sheet = Sheet {
            page: Some(page),
            unit_mm: 10.0,
            layers,
        };
        let bytes = write(&sheet, width).unwrap();
        assert_eq!(bytes, write(&sheet, width).unwrap());
        Pixmap::decode_png(&bytes).unwrap()
    }

    fn pixel(image: &Pixmap, x: u32, y: u32) -> [u8; 3] {
        let c = image.pixel(x, y).unwrap();
        [c.red(), c.green(), c.blue()]
    }

    #[test]
    fn areas_and_hairlines_are_seen() {
        let outer = [[-50.0, 25.0], [50.0, 25.0], [50.0, 75.0], [-50.0, 75.0]]
            .map(Point::from)
            .to_vec();
        let area = Item::Area(Polygon {
            outer,
            holes: vec![],
        });
        let filled = image(vec![area], Style::filled(Color([255, 0, 0])), 200);
        assert_eq!((filled.width(), filled.height()), (200, 100));
        assert_eq!(
            (pixel(&filled, 100, 50), pixel(&filled, 10, 50)),
            ([255, 0, 0], [255; 3])
        );
        let line = Item::Line(vec![Point::new(-100.0, 50.5), Point::new(100.0, 50.5)]);
        let hair = image(vec![line], Style::outline(0.01), 200);
        assert!(pixel(&hair, 100, 50)[0] < 10 && pixel(&hair, 100, 40) == [255; 3]);
    }

    #[test]
    fn thin_upright_lines_do_not_lean() {
        let sides = [
            [-99.37, 1.0],
            [77.61, 1.0],
            [77.61, 99.0],
            [-99.37, 99.0],
            [-99.37, 1.0],
        ];
        let line = Item::Line(sides.map(Point::from).to_vec());
        let image = image(vec![line], Style::outline(0.01), 500);
        for x in 0..image.width() {
            assert_eq!(pixel(&image, x, 20), pixel(&image, x, 230), "{x}");
        }
    }

    #[test]
    fn a_resolution_decides_on_the_pixels_and_stands_in_the_file() {
        let page = Bounds {
            min: Point::ORIGIN,
            max: Point::new(50.8, 25.4),
        };
        let line = Item::Line(vec![Point::ORIGIN, Point::new(50.8, 25.4)]);
        let layers = vec![Layer {
            name: "a".into(),
            role: Role::Draw,
            style: Style::outline(0.2),
            items: vec![line],
        }];
        let sheet = Sheet {
            page: Some(page),
            unit_mm: 1.0,
            layers,
        };
        let bytes = write_at(&sheet, 300.0).unwrap();
        let image = Pixmap::decode_png(&bytes).unwrap();
        assert_eq!((image.width(), image.height()), (600, 300));
        assert_eq!(&bytes[37..41], b"pHYs");
        assert_eq!(bytes[41..45], 11811u32.to_be_bytes());
        assert!(write_at(&sheet, 1e6).is_err() && write_at(&sheet, 1e-3).is_err());
    }

    #[test]
    fn many_lines_are_drawn_and_sizes_are_checked() {
        let dash = |i: usize| {
            let (x, y) = ((i % 200) as f64 - 100.0, (i / 200) as f64);
            Item::Line(vec![Point::new(x, y + 0.5), Point::new(x + 1.0, y + 0.5)])
        };
        let dense = image((0..20_000).map(dash).collect(), Style::outline(0.1), 200);
        assert!((0..200).all(|x| pixel(&dense, x, 99) != [255; 3]));
        let sheet = Sheet {
            page: None,
            unit_mm: 1.0,
            layers: vec![],
        };
        assert!(
            write(&sheet, 0).is_err()
                && write(&sheet, 20_000).is_err()
                && write(&sheet, 16_000).is_err()
        );
        assert!(write(&sheet, 8).is_ok());
    }
}
