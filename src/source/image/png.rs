//! PNG.

use png::{ColorType, Decoder, Limits, Transformations};

use super::{ImageError, Luma, MOST_PIXELS, gray};

/// The luma of a PNG.
pub fn luma(bytes: &[u8]) -> Result<Luma, ImageError> {
    let limits = Limits {
        bytes: 16 * MOST_PIXELS as usize,
    };
    let mut decoder = Decoder::new_with_limits(std::io::Cursor::new(bytes), limits);
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info()?;
    let (width, height) = reader.info().size();
    let too_large = ImageError::TooLarge(width as usize, height as usize);
    if u64::from(width) * u64::from(height) > MOST_PIXELS {
        return Err(too_large);
    }
    let size = reader.output_buffer_size().ok_or(too_large)?;
    let mut data = vec![0; size];
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
    let values = match frame.color_type {
        ColorType::Grayscale | ColorType::Indexed => samples,
        ColorType::GrayscaleAlpha => samples
            .chunks_exact(2)
            .map(|p| on_white(p[0], p[1]))
            .collect(),
        ColorType::Rgb => samples
            .chunks_exact(3)
            .map(|p| gray([p[0], p[1], p[2]]))
            .collect(),
        ColorType::Rgba => samples
            .chunks_exact(4)
            .map(|p| on_white(gray([p[0], p[1], p[2]]), p[3]))
            .collect(),
    };
    Ok(Luma {
        width: frame.width as usize,
        values,
    })
}
