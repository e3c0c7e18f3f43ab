//! Strips and tiles as samples, each read and decoded by whoever first asks for one of its samples. What was decoded lately is
//! held on a shelf, so that of a raster of any size no more than that is in memory.

use std::collections::BTreeMap;
use std::io::{Read as _, Seek as _, SeekFrom};
use std::sync::{Mutex, PoisonError};

use tiff::decoder::ChunkType;
use tiff::tags::Tag;

use super::file::{GeoTiffError, Reader};
use super::packing::{Damage, Extent, Packing};
use super::shelf::{Decoded, Shelf};
use fretwork_geometry::Samples;

/// So many bytes of decoded blocks are held, or those around a corner of four blocks if they are more.
const HELD: usize = 1 << 28;

/// Strips that are not compressed are read in parts of about so many bytes.
const STRIP: usize = 1 << 16;

/// How the samples of a band lie in the blocks of a file.
pub(super) struct Layout {
    size: [usize; 2],
    /// The size of a block.
    block: [usize; 2],
    /// Blocks side by side.
    across: usize,
    /// The number of the band's samples in a pixel of a block, and how many there are.
    channel: [usize; 2],
    /// Where each strip or tile of the band begins in the file, and how many bytes it has there; none for one that was left out.
    places: Vec<[u64; 2]>,
    /// Of how many blocks, one after the other, a strip or a tile consists, and the bytes of such a block.
    parts: (usize, u64),
    /// Whether blocks are strips, of which the last may be shorter.
    is_strips: bool,
    packing: Packing,
    pub nodata: Option<f64>,
    pub scale: f64,
    pub offset: f64,
}

impl Layout {
    /// The layout of `band`, counted from 1, of the image that `reader` stands at, in a file of `size` bytes.
    pub fn read(reader: &mut Reader, band: u64, size: u64) -> Result<Layout, GeoTiffError> {
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
        let layout = Layout {
            size: [width, height],
            block,
            across,
            channel: if is_planar { [0, 1] } else { [channel, bands] },
            places: places(reader, first, count, size)?,
            parts: (1, u64::MAX),
            is_strips,
            packing: Packing::read(reader)?,
            nodata: None,
            scale: 1.0,
            offset: 0.0,
        };
        Ok(layout.split())
    }

    /// The same with strips of few rows: those that are not compressed can be read in part.
    fn split(mut self) -> Layout {
        let row = match self.packing.row(&self.extent(0)) {
            Ok(row) if self.is_strips && !self.packing.is_compressed() => row,
            _ => return self,
        };
        let own = self.block[1];
        let wanted = (STRIP / row.max(1)).max(1);
        let rows = match self.places.len() {
            _ if wanted >= own => return self,
            1 => wanted,
            // The rows of a strip are counted from its first.
            _ => (1..=wanted)
                .rev()
                .find(|rows| own.is_multiple_of(*rows))
                .unwrap_or(1),
        };
        let bytes = (rows as u64).saturating_mul(row as u64);
        self.parts = (own.div_ceil(rows), bytes);
        self.block[1] = rows;
        self
    }
}

impl Layout {
    /// Where a block begins in the file, and how many bytes it has there.
    fn place(&self, number: usize) -> [u64; 2] {
        let (parts, part) = self.parts;
        let [offset, bytes] = self.places[number / parts];
        let start = ((number % parts) as u64).saturating_mul(part);
        [
            offset.saturating_add(start),
            bytes.saturating_sub(start).min(part),
        ]
    }

    /// Whether the file has nothing for the strip or the tile of a block.
    fn is_left_out(&self, number: usize) -> bool {
        self.places[number / self.parts.0][1] == 0
    }

    /// How many blocks there are.
    fn count(&self) -> usize {
        self.across
            .saturating_mul(self.size[1].div_ceil(self.block[1]))
    }

    /// The most bytes that all blocks can be decoded to, as far as the file tells.
    fn most_bytes(&self) -> usize {
        match self.packing.is_compressed() {
            true => usize::MAX,
            false => {
                let bytes = self.places.iter().map(|[_, bytes]| *bytes);
                usize::try_from(bytes.fold(0, u64::saturating_add)).unwrap_or(usize::MAX)
            }
        }
    }

    /// The size of a block as it is packed.
    fn extent(&self, number: usize) -> Extent {
        let above = number / self.across * self.block[1];
        let rows = match self.is_strips {
            true => self.block[1].min(self.size[1].saturating_sub(above)),
            false => self.block[1],
        };
        Extent {
            width: self.block[0],
            rows,
            most_rows: self.block[1],
            channel: self.channel,
        }
    }
}

/// The places of `count` blocks from number `first`, which all lie in the file of `size` bytes.
fn places(
    reader: &mut Reader,
    first: usize,
    count: usize,
    size: u64,
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
        if last > size {
            return Err(GeoTiffError::Truncated { block });
        }
        whole = whole.saturating_add(bytes[block]);
    }
    // Blocks that share their bytes would unpack to more than the file can fill.
    if whole > size.saturating_mul(2) {
        return Err(GeoTiffError::Blocks("they lie over one another"));
    }
    let places = offsets[first..end].iter().zip(&bytes[first..end]);
    Ok(places.map(|(offset, bytes)| [*offset, *bytes]).collect())
}

/// The samples of one band.
pub struct Blocks {
    layout: Layout,
    reader: Mutex<Reader>,
    shelf: Shelf,
    faults: Mutex<BTreeMap<usize, String>>,
}

impl Blocks {
    pub(super) fn new(reader: Reader, layout: Layout) -> Blocks {
        let factor = fretwork_geometry::budget::factor().min(1.0);
        let [width, height] = layout.block;
        let block = width.saturating_mul(height);
        let block = block.saturating_mul(layout.packing.width());
        Blocks {
            shelf: Shelf::new(block, (HELD as f64 * factor) as usize),
            layout,
            reader: Mutex::new(reader),
            faults: Mutex::default(),
        }
    }

    /// A block's samples; nothing for one that was left out or is damaged, which is noted.
    fn decoded(&self, number: usize) -> Decoded {
        if self.layout.is_left_out(number) {
            return None;
        }
        let place = self.layout.place(number);
        let note = |message| {
            let mut faults = self.faults.lock().unwrap_or_else(PoisonError::into_inner);
            faults.insert(number, message);
        };
        self.decode(number, place).map_err(note).ok()
    }

    fn decode(&self, number: usize, [offset, bytes]: [u64; 2]) -> Result<Vec<u8>, String> {
        let damaged = |damage: Damage| format!("block {number} is damaged: {damage}");
        let extent = self.layout.extent(number);
        let bytes = self
            .layout
            .packing
            .packed(&extent, bytes)
            .map_err(damaged)?;
        let mut packed = vec![0; bytes];
        {
            let mut reader = self.reader.lock().unwrap_or_else(PoisonError::into_inner);
            let source = reader.inner();
            let found = source.seek(SeekFrom::Start(offset));
            found
                .and_then(|_| source.read_exact(&mut packed))
                .map_err(|error| error.to_string())?;
        }
        let samples = self.layout.packing.unpack(&packed, &extent);
        samples.map_err(damaged)
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
        let number = j * layout.across + i;
        let index = (row % h) * w + column % w;
        let read = |block: Option<&[u8]>| layout.packing.value(block?, index, layout.nodata);
        let decode = || self.decoded(number);
        let value = self.shelf.with(number, (i & 1) + 2 * (j & 1), decode, read);
        value.map_or(f64::NAN, |value| value * layout.scale + layout.offset)
    }

    fn held_bytes(&self) -> usize {
        let most = self.shelf.most(self.layout.count());
        most.min(self.layout.most_bytes())
    }

    fn fault(&self) -> Option<String> {
        let faults = self.faults.lock().unwrap_or_else(PoisonError::into_inner);
        faults.first_key_value().map(|(_, message)| message.clone())
    }
}
