//! PNG.

use png::{ColorType, Decoder, Limits, Transformations};

use super::{Components, ImageError, MOST_PIXELS, Picture, Pixel};

/// What `value` gives for the pixels of a PNG.
pub fn read<T>(bytes: &[u8], value: fn(Pixel) -> T) -> Result<Picture<T>, ImageError> {
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
    let color = frame.color_type;
    let pixel = |p: &[f64]| match color {
        ColorType::Grayscale | ColorType::Indexed => Pixel::opaque(Components::Gray(p[0])),
        ColorType::GrayscaleAlpha => Pixel {
            color: Components::Gray(p[0]),
            alpha: p[1],
        },
        ColorType::Rgb => Pixel::opaque(Components::Rgb([p[0], p[1], p[2]])),
        ColorType::Rgba => Pixel {
            color: Components::Rgb([p[0], p[1], p[2]]),
            alpha: p[3],
        },
    };
    let pixels = samples.chunks_exact(color.samples());
    Ok(Picture {
        width: frame.width as usize,
        values: pixels.map(|p| value(pixel(p))).collect(),
    })
}
