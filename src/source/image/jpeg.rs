//! JPEG: baseline and progressive, grey or colour. Arithmetic coding and samples of 12 bits are refused.
//!
//! The decoder has no code for particular processors here: the same file gives the same samples
//! everywhere.

use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::exif::{orientation, upright};
use super::{Components, ImageError, MOST_PIXELS, Picture, Pixel};
use fretwork_geometry::budget;

/// A block of 8 × 8 pixels takes two bits at the least, or one in a progressive file.
const MOST_PIXELS_A_BYTE: u64 = 512;
/// What is beside the blocks may be left out by this much.
const SLACK: u64 = 1 << 16;
/// Each scan goes over all pixels.
const MOST_SCANS: usize = 100;

/// What `value` gives for the pixels of a JPEG, upright.
pub fn read<T: Copy>(bytes: &[u8], value: fn(Pixel) -> T) -> Result<Picture<T>, ImageError> {
    let damaged = |e: &dyn std::fmt::Debug| ImageError::Jpeg(format!("{e:?}"));
    let options = DecoderOptions::default()
        .set_max_width(usize::from(u16::MAX))
        .set_max_height(usize::from(u16::MAX))
        .jpeg_set_max_scans(MOST_SCANS)
        .set_strict_mode(true);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(|e| damaged(&e))?;
    let (width, height) = decoder
        .dimensions()
        .filter(|(width, height)| width * height > 0)
        .ok_or_else(|| ImageError::Jpeg("it has no size".into()))?;
    let pixels = width as u64 * height as u64;
    if pixels > MOST_PIXELS {
        return Err(ImageError::TooLarge(width, height));
    }
    if pixels > bytes.len() as u64 * MOST_PIXELS_A_BYTE + SLACK {
        return Err(ImageError::Hollow(width, height));
    }
    budget::make("pixels", pixels as usize, 2 * size_of::<f64>());
    let is_gray = match decoder.input_colorspace() {
        Some(ColorSpace::CMYK | ColorSpace::YCCK) => return Err(ImageError::Cmyk),
        Some(ColorSpace::Luma) => true,
        _ => false,
    };
    let space = if is_gray {
        ColorSpace::Luma
    } else {
        ColorSpace::RGB
    };
    let options = decoder.options().jpeg_set_out_colorspace(space);
    decoder.set_options(options);
    let data = decoder.decode().map_err(|e| damaged(&e))?;
    let part = |byte: u8| f64::from(byte) / f64::from(u8::MAX);
    let value = |color| value(Pixel::opaque(color));
    let values: Vec<T> = match is_gray {
        true => data
            .iter()
            .map(|v| value(Components::Gray(part(*v))))
            .collect(),
        false => data
            .chunks_exact(3)
            .map(|p| value(Components::Rgb([p[0], p[1], p[2]].map(part))))
            .collect(),
    };
    if values.len() as u64 != pixels {
        return Err(ImageError::Jpeg("it ends early".into()));
    }
    let turned = decoder.exif().map_or(1, |exif| orientation(exif));
    Ok(upright(Picture { width, values }, turned))
}
