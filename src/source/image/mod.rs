//! Pictures as samples: PNG of any colour type and depth and JPEG, to the luma or the colours of their pixels.
//! Colour profiles and gamma are left alone; where a pixel is transparent, white paper shows through.

mod exif;
mod jpeg;
mod png;

/// More pixels than this are refused.
const MOST_PIXELS: u64 = 1 << 26;

/// A value for every pixel, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture<T> {
    /// Columns, at least 1.
    pub width: usize,
    /// As many as columns times rows.
    pub values: Vec<T>,
}

/// A pixel as it is stored: its components from 0 to 1, and how much it covers.
#[derive(Clone, Copy, Debug)]
struct Pixel {
    color: Components,
    alpha: f64,
}

#[derive(Clone, Copy, Debug)]
enum Components {
    Gray(f64),
    Rgb([f64; 3]),
}

impl Pixel {
    const fn opaque(color: Components) -> Pixel {
        Pixel { color, alpha: 1.0 }
    }

    /// 0 for black to 1 for white.
    fn luma(self) -> f64 {
        let luma = match self.color {
            Components::Gray(gray) => gray,
            Components::Rgb(rgb) => gray(rgb),
        };
        on_white(luma, self.alpha)
    }

    fn rgb(self) -> [u8; 3] {
        let rgb = match self.color {
            Components::Gray(gray) => [gray; 3],
            Components::Rgb(rgb) => rgb,
        };
        rgb.map(|part| (on_white(part, self.alpha) * f64::from(u8::MAX)).round() as u8)
    }
}

fn on_white(part: f64, alpha: f64) -> f64 {
    part * alpha + (1.0 - alpha)
}

/// The formats of pictures, known by their first bytes: their names are often wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// PNG.
    Png,
    /// JPEG.
    Jpeg,
}

impl PictureFormat {
    /// The format of a file that begins with these bytes.
    pub fn of_bytes(bytes: &[u8]) -> Option<PictureFormat> {
        match bytes {
            [0x89, b'P', b'N', b'G', ..] => Some(PictureFormat::Png),
            [0xff, 0xd8, 0xff, ..] => Some(PictureFormat::Jpeg),
            _ => None,
        }
    }
}

/// Why a picture was not read.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// The bytes begin as no picture that is read does.
    #[error("this is no PNG or JPEG")]
    Unknown,
    /// The PNG is damaged.
    #[error("this is a damaged PNG: {0}")]
    Png(#[from] ::png::DecodingError),
    /// The JPEG is damaged, or of a kind that is not read.
    #[error("this is a damaged JPEG, or one that is not read: {0}")]
    Jpeg(String),
    /// The picture is one for printing.
    #[error("the JPEG is in CMYK, for printing: save it in RGB or grey")]
    Cmyk,
    /// The picture is larger than any that is meant.
    #[error("the picture has {0} × {1} pixels, more than {limit} in all", limit = MOST_PIXELS)]
    TooLarge(usize, usize),
    /// The picture claims more than its bytes can say.
    #[error("the picture claims {0} × {1} pixels, more than its bytes can hold")]
    Hollow(usize, usize),
}

/// The luma of an RGB pixel (the weights of Rec. 709 for the stored components).
fn gray([red, green, blue]: [f64; 3]) -> f64 {
    0.2126 * red + 0.7152 * green + 0.0722 * blue
}

/// Reads the luma of a PNG or JPEG, 0 for black to 1 for white (the weights of Rec. 709); one that a camera took
/// turned is turned upright.
///
/// # Errors
/// [`ImageError`]; memory is bounded by the size that the file claims, which is checked first.
pub fn luma(bytes: &[u8]) -> Result<Picture<f64>, ImageError> {
    read(bytes, Pixel::luma)
}

/// Reads the colours of a PNG or JPEG: red, green and blue as stored, upright.
///
/// # Errors
/// As of [`luma`].
pub fn colors(bytes: &[u8]) -> Result<Picture<[u8; 3]>, ImageError> {
    read(bytes, Pixel::rgb)
}

fn read<T: Copy>(bytes: &[u8], value: fn(Pixel) -> T) -> Result<Picture<T>, ImageError> {
    match PictureFormat::of_bytes(bytes).ok_or(ImageError::Unknown)? {
        PictureFormat::Png => png::read(bytes, value),
        PictureFormat::Jpeg => jpeg::read(bytes, value),
    }
}

/// Whether the picture can be shown: that all of it is there, and is not larger than any that is meant.
///
/// # Errors
/// [`ImageError`]. A picture for printing is none: what shows it may know its colours.
pub fn check(bytes: &[u8]) -> Result<(), ImageError> {
    match luma(bytes) {
        Ok(_) | Err(ImageError::Cmyk) => Ok(()),
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests;
