//! Pictures as samples: PNG of any colour type and depth and JPEG, to the luma of their pixels. Colour profiles
//! and gamma are left alone; where a pixel is transparent, white paper shows through.

mod exif;
mod jpeg;
mod png;

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

/// Reads the luma of a PNG or JPEG; one that a camera took turned is turned upright.
///
/// # Errors
/// [`ImageError`]; memory is bounded by the size that the file claims, which is checked first.
pub fn luma(bytes: &[u8]) -> Result<Luma, ImageError> {
    match PictureFormat::of_bytes(bytes).ok_or(ImageError::Unknown)? {
        PictureFormat::Png => png::luma(bytes),
        PictureFormat::Jpeg => jpeg::luma(bytes),
    }
}

#[cfg(test)]
mod tests;
