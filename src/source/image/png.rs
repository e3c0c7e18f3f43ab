//! PNG.

use png::{ColorType, Decoder, Limits, Transformations};

use super::{Components, ImageError, MOST_PIXELS, Picture, Pixel};
use fretwork_geometry::budget;

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
    budget::make("pixels", size, 1);
    budget::make("pixels", width as usize * height as usize, size_of::<T>());
    let mut data = vec![0; size];
    let frame = reader.next_frame(&mut data)?;
    let color = frame.color_type;
    let bytes = match frame.bit_depth {
        png::BitDepth::Sixteen => 2,
        _ => 1,
    };
    let sample = |pixel: &[u8], number: usize| match pixel[number * bytes..][..bytes] {
        [high, low] => f64::from(u16::from_be_bytes([high, low])) / f64::from(u16::MAX),
        _ => f64::from(pixel[number]) / f64::from(u8::MAX),
    };
    let rgb = |p: &[u8]| Components::Rgb([0, 1, 2].map(|number| sample(p, number)));
    let pixel = |p: &[u8]| match color {
        ColorType::Grayscale | ColorType::Indexed => Pixel::opaque(Components::Gray(sample(p, 0))),
        ColorType::GrayscaleAlpha => Pixel {
            color: Components::Gray(sample(p, 0)),
            alpha: sample(p, 1),
        },
        ColorType::Rgb => Pixel::opaque(rgb(p)),
        ColorType::Rgba => Pixel {
            color: rgb(p),
            alpha: sample(p, 3),
        },
    };
    let pixels = data[..frame.buffer_size()].chunks_exact(color.samples() * bytes);
    Ok(Picture {
        width: frame.width as usize,
        values: pixels.map(|p| value(pixel(p))).collect(),
    })
}
