//! Strips and tiles as samples, each decoded once, by whoever first asks for one of its samples.

use std::collections::BTreeMap;
use std::io::{Read as _, Seek as _, SeekFrom};
use std::sync::{Mutex, OnceLock, PoisonError};

use tiff::decoder::ChunkType;
use tiff::tags::Tag;

use super::file::{GeoTiffError, Reader};
use super::packing::{Extent, Packing};
use fretwork_geometry::Samples;

/// How the samples of a band lie in the blocks of a file.
pub(super) struct Layout {
    size: [usize; 2],
    /// The size of a block.
    block: [usize; 2],
    /// Blocks side by side.
    across: usize,
    /// The number of the band's samples in a pixel of a block, and how many there are.
    channel: [usize; 2],
    /// Where each block of the band begins in the file, and how many bytes it has there; none for one that was left out.
    places: Vec<[u64; 2]>,
    /// Whether blocks are strips, of which the last may be shorter.
    is_strips: bool,
    packing: Packing,
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
        let is_strips = reader.get_chunk_type() == ChunkType::Strip;
        let block = match is_strips {
            true => [w as usize, (h as usize).min(height)],
            false => [w as usize, h as usize],
        };
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
            channel: if is_planar { [0, 1] } else { [channel, bands] },
            places: places(reader, first, count, size)?,
            is_strips,
            packing: Packing::read(reader)?,
            nodata: None,
            scale: 1.0,
            offset: 0.0,
        })
    }
}

/// The places of `count` blocks from number `first`, which all lie in the file of `size` bytes.
fn places(
    reader: &mut Reader,
    first: usize,
    count: usize,
    size: usize,
) -> Result<Vec<[u64; 2]>, GeoTiffError> {
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
    let places = offsets[first..end].iter().zip(&bytes[first..end]);
    Ok(places.map(|(offset, bytes)| [*offset, *bytes]).collect())
}

/// The samples of one band.
pub struct Blocks {
    layout: Layout,
    reader: Mutex<Reader>,
    /// The band's samples in each block, as they are unpacked.
    decoded: Vec<OnceLock<Option<Vec<u8>>>>,
    faults: Mutex<BTreeMap<usize, String>>,
}

impl Blocks {
    pub(super) fn new(reader: Reader, layout: Layout) -> Blocks {
        Blocks {
            decoded: layout.places.iter().map(|_| OnceLock::new()).collect(),
            layout,
            reader: Mutex::new(reader),
            faults: Mutex::default(),
        }
    }

    /// A block's samples; nothing for one that was left out or is damaged, which is noted.
    fn block(&self, number: usize) -> Option<&Vec<u8>> {
        let decode = || match self.layout.places[number] {
            [_, 0] => None,
            place => match self.decode(number, place) {
                Ok(samples) => Some(samples),
                Err(message) => {
                    let mut faults = self.faults.lock().unwrap_or_else(PoisonError::into_inner);
                    faults.insert(number, message);
                    None
                }
            },
        };
        self.decoded.get(number)?.get_or_init(decode).as_ref()
    }

    fn decode(&self, number: usize, [offset, bytes]: [u64; 2]) -> Result<Vec<u8>, String> {
        let mut packed = Vec::new();
        {
            let mut reader = self.reader.lock().unwrap_or_else(PoisonError::into_inner);
            let source = reader.inner();
            let found = source.seek(SeekFrom::Start(offset));
            found
                .and_then(|_| source.by_ref().take(bytes).read_to_end(&mut packed))
                .map_err(|e| e.to_string())?;
        }
        let layout = &self.layout;
        let above = number / layout.across * layout.block[1];
        let rows = match layout.is_strips {
            true => layout.block[1].min(layout.size[1].saturating_sub(above)),
            false => layout.block[1],
        };
        let extent = Extent {
            width: layout.block[0],
            rows,
            most_rows: layout.block[1],
            channel: layout.channel,
        };
        let samples = layout.packing.unpack(&packed, &extent);
        samples.map_err(|damage| damage.to_string())
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
        let index = (row % h) * w + column % w;
        let value = layout.packing.value(block, index, layout.nodata);
        value.map_or(f64::NAN, |value| value * layout.scale + layout.offset)
    }

    fn fault(&self) -> Option<String> {
        let faults = self.faults.lock().unwrap_or_else(PoisonError::into_inner);
        let (block, message) = faults.first_key_value()?;
        Some(format!("block {block} is damaged: {message}"))
    }
}
