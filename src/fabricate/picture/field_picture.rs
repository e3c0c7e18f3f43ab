//! PNG of a field: its values on a page in shades of grey.

use rayon::prelude::*;
use resvg::tiny_skia::{IntSize, Pixmap};

use super::sheet_picture::size;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Bounds, Field, Point, budget};

/// Bytes for a pixel, with its value, and steps for a sample of a field, which may be a formula.
const PIXEL: usize = 16;
const SAMPLE: u64 = 12;

/// The values of `field` at the centres of the pixels of an image that shows `page` and is `width`
/// pixels wide: the least value black, the greatest white, both the same white, and clear where the
/// field has no value. Errors: as of [`super::sheet_picture::write`], and a field without any value
/// there. The upper row shows the least y or, if `is_north_up`, the greatest.
pub fn write(
    field: &Field,
    page: Bounds,
    width: u32,
    is_north_up: bool,
) -> Result<Vec<u8>, Diagnostic> {
    let (width, height) = size(page, width)?;
    let step = Point::new(
        page.width() / f64::from(width),
        page.height() / f64::from(height),
    );
    let pixels = width as usize * height as usize;
    budget::make("pixels", pixels, PIXEL);
    budget::spend("pixels", SAMPLE * pixels as u64);
    let row = |y: u32| -> Vec<f64> {
        let y = if is_north_up { height - 1 - y } else { y };
        let center = |x: u32| {
            page.min + Point::new((f64::from(x) + 0.5) * step.x, (f64::from(y) + 0.5) * step.y)
        };
        (0..width).map(|x| field.value(center(x))).collect()
    };
    let values: Vec<f64> = (0..height).into_par_iter().flat_map_iter(row).collect();
    let known = values.iter().copied().filter(|v| v.is_finite());
    let (low, high) = known.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
        (low.min(v), high.max(v))
    });
    if low > high {
        return Err(Diagnostic::error("the field has no value on the region"));
    }
    let shade = |v: f64| {
        if high > low {
            ((v - low) / (high - low) * 255.0).round() as u8
        } else {
            255
        }
    };
    let pixel = |v: &f64| {
        if v.is_finite() {
            [shade(*v), shade(*v), shade(*v), 255]
        } else {
            [0; 4]
        }
    };
    let image = IntSize::from_wh(width, height)
        .and_then(|size| Pixmap::from_vec(values.iter().flat_map(pixel).collect(), size))
        .ok_or_else(|| Diagnostic::error("the picture has no pixels"))?;
    image
        .encode_png()
        .map_err(|e| Diagnostic::error(format!("the picture cannot be written: {e}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_value_is_black_and_the_greatest_white() {
        let page = Bounds {
            min: Point::ORIGIN,
            max: Point::new(40.0, 10.0),
        };
        let slope = Field::new([1; 32], |p| if p.y < 5.0 { p.x } else { f64::NAN });
        let image = Pixmap::decode_png(&write(&slope, page, 8, false).unwrap()).unwrap();
        let shades: Vec<[u8; 2]> = image
            .pixels()
            .iter()
            .map(|p| [p.red(), p.alpha()])
            .collect();
        assert_eq!(
            (
                image.width(),
                image.height(),
                shades[0],
                shades[7],
                shades[8]
            ),
            (8, 2, [0, 255], [255, 255], [0, 0])
        );
        let flat =
            Pixmap::decode_png(&write(&Field::constant(3.0), page, 4, false).unwrap()).unwrap();
        assert_eq!(flat.pixels()[0].red(), 255);
        assert!(
            write(&Field::constant(f64::NAN), page, 4, false).is_err()
                && write(&slope, page, 0, false).is_err()
        );
    }
}
