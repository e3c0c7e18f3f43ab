//! The image of a file that is meant, and what its tags say of it.

use std::io::{BufReader, Read, Seek, SeekFrom};
use std::sync::Arc;

use tiff::TiffError;
use tiff::decoder::{Decoder, Limits};
use tiff::tags::Tag;

use super::blocks::{Blocks, Layout};
use super::keys::{self, Keys};
use super::words::told;
use crate::geo::crs::{Crs, CrsError};
use fretwork_geometry::{Affine, Point, counted};

/// Why a raster cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum GeoTiffError {
    /// The file is damaged, or of a kind that is not read.
    #[error("{}", told(.0))]
    Tiff(#[from] TiffError),
    /// There is no image of full size in it.
    #[error("it holds no image of full size")]
    NoImage,
    /// The way in which it is compressed is not supported.
    #[error("its compression, {0}, is not supported; write it with Deflate, LZW or none")]
    Compression(String),
    /// Its samples are of a kind that is not supported.
    #[error(
        "its samples are {0}, which is not supported; write it with integers or floats of 8, 16, 32 or 64 bits"
    )]
    Samples(String),
    /// It ends before the last block, or a block lies elsewhere.
    #[error("block {block} lies beyond the end of the file, which is truncated")]
    Truncated {
        /// The number of the block.
        block: usize,
    },
    /// What is said of the blocks cannot be.
    #[error("its blocks are damaged: {0}")]
    Blocks(&'static str),
    /// It has fewer bands.
    #[error("it has {}, and no band {band}", counted(*.count, "band", "bands"))]
    Band {
        /// The band that is asked for.
        band: u64,
        /// How many there are.
        count: usize,
    },
    /// Placed by more than one point without a map.
    #[error("it is placed by control points, which is not supported; warp it first")]
    ControlPoints,
    /// Its coordinate system cannot be used.
    #[error(transparent)]
    Crs(#[from] CrsError),
}

/// One band of a raster.
pub struct GeoTiff {
    /// The samples.
    pub blocks: Arc<Blocks>,
    /// From columns and rows, counted from the outer corner of the first pixel, to its own plane; none where it does not say.
    pub frame: Option<Affine>,
    /// The system of its plane; none where it does not say.
    pub crs: Option<Crs>,
}

/// What a file is read from, whatever its size.
pub trait Source: Read + Seek + Send {}

impl<T: Read + Seek + Send> Source for T {}

pub(super) type Reader = Decoder<BufReader<Box<dyn Source>>>;

/// The most bytes that the values of a tag may take: those of the places of ten million blocks.
const LARGEST_TAG: u64 = 1 << 28;

/// Images after one another, at most.
const MOST_IMAGES: usize = 1000;

const SCALE: u16 = 33550;
const TIE_POINTS: u16 = 33922;
const TRANSFORMATION: u16 = 34264;
const METADATA: u16 = 42112;
const NODATA: u16 = 42113;

/// Opens a band, counted from 1, of the file that is read from `source`. Of its samples nothing is read yet.
///
/// # Errors
/// [`GeoTiffError`]
pub fn open(mut source: impl Source + 'static, band: u64) -> Result<GeoTiff, GeoTiffError> {
    let size = source.seek(SeekFrom::End(0)).map_err(TiffError::from)?;
    source.rewind().map_err(TiffError::from)?;
    let mut limits = Limits::default();
    limits.ifd_value_size = usize::try_from(size.min(LARGEST_TAG)).unwrap_or(usize::MAX);
    let source: Box<dyn Source> = Box::new(source);
    let mut reader = Decoder::new(BufReader::new(source))?.with_limits(limits);
    seek_full_size(&mut reader)?;
    let keys = Keys::read(&mut reader)?;
    let frame = frame(&mut reader, keys.is_point)?;
    let crs = keys.crs()?;
    let mut layout = Layout::read(&mut reader, band, size)?;
    let nodata = reader.find_tag(Tag::Unknown(NODATA)).ok().flatten();
    layout.nodata = nodata
        .and_then(|text| text.into_string().ok())
        .and_then(|text| text.trim().trim_end_matches('\0').trim().parse().ok());
    let metadata = reader.find_tag(Tag::Unknown(METADATA)).ok().flatten();
    if let Some(text) = metadata.and_then(|text| text.into_string().ok()) {
        (layout.scale, layout.offset) = scale_and_offset(&text, band);
    }
    Ok(GeoTiff {
        blocks: Arc::new(Blocks::new(reader, layout)),
        frame,
        crs,
    })
}

/// Goes on to the first image that is neither an overview nor a mask.
fn seek_full_size(reader: &mut Reader) -> Result<(), GeoTiffError> {
    for _ in 0..MOST_IMAGES {
        let kind: Option<u32> = reader.find_tag_unsigned(Tag::NewSubfileType)?;
        if kind.unwrap_or(0) & 0b101 == 0 {
            return Ok(());
        }
        if !reader.more_images() {
            break;
        }
        reader.next_image()?;
    }
    Err(GeoTiffError::NoImage)
}

/// From columns and rows to the raster's plane, as tags 33550, 33922 and 34264 have it (GeoTIFF 1.1, chapter 6).
fn frame(reader: &mut Reader, is_point: bool) -> Result<Option<Affine>, GeoTiffError> {
    let scale = keys::numbers(reader, SCALE)?;
    let ties = keys::numbers(reader, TIE_POINTS)?;
    let matrix = keys::numbers(reader, TRANSFORMATION)?;
    let map = if let [a, b, _, e, c, d, _, f, ..] = matrix[..] {
        Affine([a, c, b, d, e, f])
    } else if let ([x, y, ..], [i, j, _, e, f, ..]) = (&scale[..], &ties[..]) {
        Affine([*x, 0.0, 0.0, -y, e - i * x, f + j * y])
    } else if ties.len() > 6 {
        return Err(GeoTiffError::ControlPoints);
    } else {
        return Ok(None);
    };
    Ok(Some(if is_point {
        Affine::translation(Point::new(-0.5, -0.5)).then(map)
    } else {
        map
    }))
}

/// The factor and the summand of a band that GDAL's metadata name.
fn scale_and_offset(text: &str, band: u64) -> (f64, f64) {
    let (mut scale, mut offset) = (1.0, 0.0);
    let Ok(document) = roxmltree::Document::parse(text.trim_end_matches('\0')) else {
        return (scale, offset);
    };
    for item in document.descendants().filter(|n| n.has_tag_name("Item")) {
        let sample = item.attribute("sample").and_then(|s| s.parse::<u64>().ok());
        let value = item.text().and_then(|t| t.trim().parse::<f64>().ok());
        let (Some(value), true) = (value, sample == Some(band - 1)) else {
            continue;
        };
        match item.attribute("role") {
            Some("scale") => scale = value,
            Some("offset") => offset = value,
            _ => {}
        }
    }
    (scale, offset)
}

/// The map of a world file, from columns and rows counted from the outer corner of the first pixel.
pub fn world_file(text: &str) -> Option<Affine> {
    let numbers = text.split_whitespace().map(|n| n.parse::<f64>().ok());
    let numbers: Vec<f64> = numbers.collect::<Option<_>>()?;
    let map = Affine(<[f64; 6]>::try_from(numbers).ok()?);
    let is_sound = map.0.iter().all(|v| v.is_finite()) && map.determinant() != 0.0;
    is_sound.then(|| Affine::translation(Point::new(-0.5, -0.5)).then(map))
}
