//! Pictures as samples: PNG of any colour type and depth to the luma of its pixels. Colour profiles
//! and gamma are left alone; where a pixel is transparent, white paper shows through.

use png::{ColorType, Decoder, Limits, Transformations};

/// More pixels than this are refused.
const MOST_PIXELS: u64 = 1 << 26;

/// The luma of every pixel, row by row from the top, 0 for black to 1 for white.
#[derive(Clone, Debug, PartialEq)]
pub struct Luma {
    /// Columns, at least 1.
    pub width: usize,
    /// As many as columns times rows.
    pub values: Vec<f64>,
}

/// Why a picture was not read.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// The bytes are no PNG, or a damaged one.
    #[error("this is no PNG, or a damaged one: {0}")]
    Damaged(#[from] png::DecodingError),
    /// The picture is larger than any that is meant.
    #[error("the picture has {0} × {1} pixels, more than {limit} in all", limit = MOST_PIXELS)]
    TooLarge(u32, u32),
}

/// Reads the luma (Rec. 709 weights of the stored components) of a PNG.
///
/// # Errors
/// [`ImageError`]; memory is bounded by the size that the file claims, which is checked first.
pub fn luma(bytes: &[u8]) -> Result<Luma, ImageError> {
    let limits = Limits {
        bytes: 16 * MOST_PIXELS as usize,
    };
    let mut decoder = Decoder::new_with_limits(std::io::Cursor::new(bytes), limits);
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info()?;
    let (width, height) = reader.info().size();
    if u64::from(width) * u64::from(height) > MOST_PIXELS {
        return Err(ImageError::TooLarge(width, height));
    }
    let mut data = vec![
        0;
        reader
            .output_buffer_size()
            .ok_or(ImageError::TooLarge(width, height))?
    ];
    let frame = reader.next_frame(&mut data)?;
    let samples: Vec<f64> = match frame.bit_depth {
        png::BitDepth::Sixteen => data[..frame.buffer_size()]
            .chunks_exact(2)
            .map(|b| f64::from(u16::from_be_bytes([b[0], b[1]])) / f64::from(u16::MAX))
            .collect(),
        _ => data[..frame.buffer_size()]
            .iter()
            .map(|&b| f64::from(b) / f64::from(u8::MAX))
            .collect(),
    };
    let on_white = |gray: f64, alpha: f64| gray * alpha + (1.0 - alpha);
    let gray = |rgb: &[f64]| 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    let values = match frame.color_type {
        ColorType::Grayscale | ColorType::Indexed => samples,
        ColorType::GrayscaleAlpha => samples
            .chunks_exact(2)
            .map(|p| on_white(p[0], p[1]))
            .collect(),
        ColorType::Rgb => samples.chunks_exact(3).map(gray).collect(),
        ColorType::Rgba => samples
            .chunks_exact(4)
            .map(|p| on_white(gray(p), p[3]))
            .collect(),
    };
    Ok(Luma {
        width: frame.width as usize,
        values,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn encoded(
        color: ColorType,
        depth: png::BitDepth,
        width: u32,
        height: u32,
        data: &[u8],
    ) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width, height);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if color == ColorType::Indexed {
            encoder.set_palette(vec![0, 0, 0, 255, 255, 255]);
        }
        encoder
            .write_header()
            .unwrap()
            .write_image_data(data)
            .unwrap();
        bytes
    }

    #[test]
    fn every_colour_type_is_read() {
        use png::BitDepth::{Eight, One, Sixteen};
        let values =
            |color, depth, data: &[u8]| luma(&encoded(color, depth, 2, 1, data)).unwrap().values;
        assert_eq!(values(ColorType::Grayscale, Eight, &[0, 255]), [0.0, 1.0]);
        assert_eq!(
            values(ColorType::Grayscale, One, &[0b0100_0000]),
            [0.0, 1.0]
        );
        assert_eq!(
            values(ColorType::Grayscale, Sixteen, &[0, 0, 0xff, 0xff]),
            [0.0, 1.0]
        );
        assert_eq!(
            values(ColorType::GrayscaleAlpha, Eight, &[0, 0, 0, 255]),
            [1.0, 0.0]
        );
        assert_eq!(values(ColorType::Indexed, One, &[0b0100_0000]), [0.0, 1.0]);
        assert_eq!(
            values(ColorType::Rgba, Eight, &[0, 0, 0, 0, 0, 0, 0, 255]),
            [1.0, 0.0]
        );
        let rgb = values(ColorType::Rgb, Eight, &[255, 255, 255, 0, 255, 0]);
        assert!((rgb[0] - 1.0).abs() < 1e-12 && (rgb[1] - 0.7152).abs() < 1e-12);
    }

    #[test]
    fn rows_run_from_the_top() {
        let read = luma(&encoded(
            ColorType::Grayscale,
            png::BitDepth::Eight,
            1,
            2,
            &[0, 255],
        ))
        .unwrap();
        assert_eq!((read.width, read.values), (1, vec![0.0, 1.0]));
    }

    #[test]
    fn what_is_damaged_or_too_large_is_refused() {
        let whole = encoded(
            ColorType::Grayscale,
            png::BitDepth::Eight,
            40,
            40,
            &[7; 1600],
        );
        for end in 0..whole.len() - 12 {
            assert!(luma(&whole[..end]).is_err(), "cut at {end}");
        }
        let mut huge = whole.clone();
        huge[16..24].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff]);
        assert!(luma(&huge).is_err());
    }
}
