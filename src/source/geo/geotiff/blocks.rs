//! Strips and tiles as samples, each decoded once, by whoever first asks for one of its samples.

use std::collections::BTreeMap;
use std::sync::{Mutex, OnceLock, PoisonError};

use tiff::decoder::DecodingResult;
use tiff::tags::Tag;

use super::file::{GeoTiffError, MOST_UNPACKED, Reader};
use fretwork_geometry::Samples;

/// How the samples of a band lie in the blocks of a file.
pub(super) struct Layout {
    size: [usize; 2],
    /// The size of a block.
    block: [usize; 2],
    /// Blocks side by side.
    across: usize,
    /// The first block of the band.
    first: usize,
    /// The number of the band's samples in a pixel of a block, and how many there are.
    channel: [usize; 2],
    /// Of each block of the band, the bytes that it has in the file; 0 for one that was left out.
    bytes: Vec<u64>,
    pub nodata: Option<f64>,
    pub scale: f64,
    pub offset: f64,
}

impl Layout {
    /// The layout of `band`, counted from 1, of the image that `reader` stands at, in a file of `size` bytes.
    pub fn read(reader: &mut Reader, band: u64, size: usize) -> Result<Layout, GeoTiffError> {
        let (width, height) = reader.dimensions()?;
        let (width, height) = (width as usize, height as usize);
        let (w, h) = reader.chunk_dimensions();
        if width == 0 || height == 0 || w == 0 || h == 0 {
            return Err(GeoTiffError::Blocks("they have no size"));
        }
        let block = [(w as usize).min(width.max(w as usize)), h as usize];
        let across = width.div_ceil(block[0]);
        let count = across
            .checked_mul(height.div_ceil(block[1]))
            .ok_or(GeoTiffError::Blocks("there are too many"))?;
        let bands: usize = reader.find_tag_unsigned(Tag::SamplesPerPixel)?.unwrap_or(1);
        let channel = usize::try_from(band.saturating_sub(1)).unwrap_or(usize::MAX);
        if band == 0 || channel >= bands {
            return Err(GeoTiffError::Band { band, count: bands });
        }
        let planar: Option<u32> = reader.find_tag_unsigned(Tag::PlanarConfiguration)?;
        let is_planar = planar == Some(2) && bands > 1;
        let first = if is_planar {
            channel.checked_mul(count)
        } else {
            Some(0)
        };
        let first = first.ok_or(GeoTiffError::Blocks("there are too many"))?;
        Ok(Layout {
            size: [width, height],
            block,
            across,
            first,
            channel: if is_planar { [0, 1] } else { [channel, bands] },
            bytes: byte_counts(reader, first, count, size)?,
            nodata: None,
            scale: 1.0,
            offset: 0.0,
        })
    }
}

/// The bytes of `count` blocks from number `first`, which all lie in the file of `size` bytes.
fn byte_counts(
    reader: &mut Reader,
    first: usize,
    count: usize,
    size: usize,
) -> Result<Vec<u64>, GeoTiffError> {
    let mut list = |tile, strip| -> Result<Vec<u64>, GeoTiffError> {
        let found = match reader.find_tag_unsigned_vec::<u64>(tile)? {
            Some(found) => Some(found),
            None => reader.find_tag_unsigned_vec::<u64>(strip)?,
        };
        Ok(found.unwrap_or_default())
    };
    let offsets = list(Tag::TileOffsets, Tag::StripOffsets)?;
    let bytes = list(Tag::TileByteCounts, Tag::StripByteCounts)?;
    let end = first.checked_add(count);
    let end = end.filter(|end| *end <= offsets.len().min(bytes.len()));
    let end = end.ok_or(GeoTiffError::Blocks(
        "the file lists fewer than the image has",
    ))?;
    let mut whole = 0u64;
    for block in first..end {
        let last = offsets[block].saturating_add(bytes[block]);
        if last > size as u64 {
            return Err(GeoTiffError::Truncated { block });
        }
        whole = whole.saturating_add(bytes[block]);
    }
    // Blocks that share their bytes would unpack to more than the file can fill.
    if whole > 2 * size as u64 {
        return Err(GeoTiffError::Blocks("they lie over one another"));
    }
    Ok(bytes[first..end].to_vec())
}

/// The samples of one band.
pub struct Blocks {
    layout: Layout,
    reader: Mutex<Reader>,
    decoded: Vec<OnceLock<Option<DecodingResult>>>,
    faults: Mutex<BTreeMap<usize, String>>,
}

impl Blocks {
    pub(super) fn new(reader: Reader, layout: Layout) -> Blocks {
        Blocks {
            decoded: layout.bytes.iter().map(|_| OnceLock::new()).collect(),
            layout,
            reader: Mutex::new(reader),
            faults: Mutex::default(),
        }
    }

    /// A block's samples; nothing for one that was left out or is damaged, which is noted.
    fn block(&self, number: usize) -> Option<&DecodingResult> {
        let decode = || {
            let bytes = self.layout.bytes[number];
            if bytes == 0 {
                return None;
            }
            match self.decode(number, bytes) {
                Ok(samples) => Some(samples),
                Err(message) => {
                    let mut faults = self.faults.lock().unwrap_or_else(PoisonError::into_inner);
                    faults.insert(number, message);
                    None
                }
            }
        };
        self.decoded.get(number)?.get_or_init(decode).as_ref()
    }

    fn decode(&self, number: usize, bytes: u64) -> Result<DecodingResult, String> {
        let index = u32::try_from(self.layout.first + number).map_err(|e| e.to_string())?;
        let mut reader = self.reader.lock().unwrap_or_else(PoisonError::into_inner);
        let size = reader.image_chunk_buffer_layout(index);
        let size = size.map_err(|e| e.to_string())?.len;
        if size as u64
            > bytes
                .saturating_mul(MOST_UNPACKED as u64)
                .saturating_add(1 << 16)
        {
            return Err("it cannot hold as many samples as it should".into());
        }
        reader.read_chunk(index).map_err(|e| e.to_string())
    }
}

impl Samples for Blocks {
    fn size(&self) -> [usize; 2] {
        self.layout.size
    }

    fn sample(&self, column: usize, row: usize) -> f64 {
        let layout = &self.layout;
        let [w, h] = layout.block;
        let (i, j) = (column / w, row / h);
        let Some(block) = self.block(j * layout.across + i) else {
            return f64::NAN;
        };
        let width = w.min(layout.size[0] - i * w);
        let [channel, channels] = layout.channel;
        let index = ((row % h) * width + column % w) * channels + channel;
        match value(block, index, layout.nodata) {
            Some(value) => value * layout.scale + layout.offset,
            None => f64::NAN,
        }
    }

    fn fault(&self) -> Option<String> {
        let faults = self.faults.lock().unwrap_or_else(PoisonError::into_inner);
        let (block, message) = faults.first_key_value()?;
        Some(format!("block {block} is damaged: {message}"))
    }
}

/// The sample, if it is there and stands for something.
fn value(block: &DecodingResult, index: usize, nodata: Option<f64>) -> Option<f64> {
    macro_rules! plain {
        ($samples:expr) => {{
            let value = *$samples.get(index)? as f64;
            (nodata != Some(value)).then_some(value)
        }};
    }
    match block {
        DecodingResult::U8(samples) => plain!(samples),
        DecodingResult::U16(samples) => plain!(samples),
        DecodingResult::U32(samples) => plain!(samples),
        DecodingResult::U64(samples) => plain!(samples),
        DecodingResult::I8(samples) => plain!(samples),
        DecodingResult::I16(samples) => plain!(samples),
        DecodingResult::I32(samples) => plain!(samples),
        DecodingResult::I64(samples) => plain!(samples),
        DecodingResult::F16(samples) => {
            let value = samples.get(index)?.to_f64();
            (nodata != Some(value) && value.is_finite()).then_some(value)
        }
        // What stands for nothing is written with more digits than a sample of 32 bits has.
        DecodingResult::F32(samples) => {
            let value = *samples.get(index)?;
            (nodata.map(|n| n as f32) != Some(value) && value.is_finite())
                .then_some(f64::from(value))
        }
        DecodingResult::F64(samples) => {
            let value = *samples.get(index)?;
            (nodata != Some(value) && value.is_finite()).then_some(value)
        }
    }
}
