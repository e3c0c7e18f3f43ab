//! How the samples of a file are packed into blocks, and a block of one of its bands unpacked. What the samples mean,
//! colours among them, plays no part here: they are numbers.

use std::io::Read as _;

use tiff::tags::{ByteOrder, Tag};

use super::file::{GeoTiffError, Reader};

/// How samples are packed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Packing {
    compression: Compression,
    predictor: Predictor,
    is_big_endian: bool,
    kind: Kind,
    /// Bytes of a sample.
    width: usize,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Compression {
    None,
    Lzw,
    Deflate,
    PackBits,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Predictor {
    None,
    /// Samples are less the one before.
    Horizontal,
    /// The bytes of floats are sorted by weight, and less the byte before.
    Float,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Unsigned,
    Signed,
    Float,
}

/// The size of a block of samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    /// Samples side by side.
    pub width: usize,
    /// Rows that the image has of it.
    pub rows: usize,
    /// Rows that may be packed.
    pub most_rows: usize,
    /// The number of a band's samples in a pixel, and how many there are.
    pub channel: [usize; 2],
}

/// Why a block is none.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub(super) enum Damage {
    #[error("it holds fewer samples than it should")]
    Short,
    #[error("it unpacks to more than the samples that it should hold")]
    Long,
    #[error("it cannot hold as many samples as it should")]
    Unfillable,
    #[error("it unpacks to more than 256 MiB; write the file in tiles")]
    Large,
}

/// What may be unpacked from a byte, at most: the best of the compressions make about 1300 of one.
const MOST_UNPACKED: usize = 1500;
/// The largest block that is unpacked.
const LARGEST: usize = 1 << 28;

const FILL_ORDER: u16 = 266;

impl Packing {
    /// That of the image at which `reader` stands.
    pub fn read(reader: &mut Reader) -> Result<Packing, GeoTiffError> {
        let bits: Vec<u32> = reader
            .find_tag_unsigned_vec(Tag::BitsPerSample)?
            .unwrap_or_else(|| vec![1]);
        let formats: Vec<u32> = reader
            .find_tag_unsigned_vec(Tag::SampleFormat)?
            .unwrap_or_else(|| vec![1]);
        let (bits, format) = (bits.first().copied(), formats.first().copied());
        let bits = bits.unwrap_or(1);
        let kind = match (format.unwrap_or(1), bits) {
            (1 | 4, 8 | 16 | 32 | 64) => Kind::Unsigned,
            (2, 8 | 16 | 32 | 64) => Kind::Signed,
            (3, 16 | 32 | 64) => Kind::Float,
            (3, _) => return Err(GeoTiffError::Samples(format!("floats of {bits} bits"))),
            (5 | 6, _) => return Err(GeoTiffError::Samples("complex numbers".into())),
            _ => return Err(GeoTiffError::Samples(format!("integers of {bits} bits"))),
        };
        let is_reversed = reader.find_tag_unsigned::<u32>(Tag::Unknown(FILL_ORDER))? == Some(2);
        if is_reversed {
            let order = "bytes whose bits are in reversed order";
            return Err(GeoTiffError::Samples(order.into()));
        }
        let photometric: Option<u32> = reader.find_tag_unsigned(Tag::PhotometricInterpretation)?;
        if photometric == Some(6) {
            return Err(GeoTiffError::Samples("colours as YCbCr".into()));
        }
        Ok(Packing {
            compression: compression(reader)?,
            predictor: predictor(reader, kind)?,
            is_big_endian: reader.byte_order() == ByteOrder::BigEndian,
            kind,
            width: bits as usize / 8,
        })
    }

    /// The bytes of a sample.
    pub fn width(&self) -> usize {
        self.width
    }

    /// How many of the `bytes` bytes that a block has in the file are to be read.
    pub fn packed(&self, extent: &Extent, bytes: u64) -> Result<usize, Damage> {
        let most = match self.compression {
            // What follows the samples is not looked at.
            Compression::None => self.row(extent)?.checked_mul(extent.rows),
            _ => Some(2 * LARGEST),
        };
        let most = most.ok_or(Damage::Unfillable)?;
        match usize::try_from(bytes) {
            Ok(bytes) if bytes <= most => Ok(bytes),
            _ if !self.is_compressed() && most <= LARGEST => Ok(most),
            _ => Err(Damage::Large),
        }
    }

    /// Whether what lies in the file has to be unpacked before a part of it can be read.
    pub fn is_compressed(&self) -> bool {
        self.compression != Compression::None
    }

    /// The bytes of a row of all bands.
    pub fn row(&self, extent: &Extent) -> Result<usize, Damage> {
        let row = extent.width.checked_mul(extent.channel[1] * self.width);
        row.ok_or(Damage::Unfillable)
    }

    /// The samples of one band in a block, row by row, for [`Packing::value`].
    pub fn unpack(&self, packed: &[u8], extent: &Extent) -> Result<Vec<u8>, Damage> {
        let [channel, channels] = extent.channel;
        let row = self.row(extent)?;
        let size = |rows: usize| row.checked_mul(rows).ok_or(Damage::Unfillable);
        let (needed, most) = (size(extent.rows)?, size(extent.most_rows)?);
        let mut samples = self.decompress(packed, needed, most)?;
        samples.truncate(needed);
        let mut band = Vec::with_capacity(needed / channels);
        for row in samples.chunks_exact_mut(row) {
            self.undo(row, channels);
            let own = row.chunks_exact(self.width).skip(channel);
            own.step_by(channels)
                .for_each(|sample| band.extend_from_slice(sample));
        }
        Ok(band)
    }

    /// At least `needed` and at most `most` bytes.
    fn decompress(&self, packed: &[u8], needed: usize, most: usize) -> Result<Vec<u8>, Damage> {
        if self.compression == Compression::None {
            return match packed.get(..needed) {
                Some(samples) => Ok(samples.to_vec()),
                None => Err(Damage::Short),
            };
        }
        let fillable = packed.len().saturating_mul(MOST_UNPACKED);
        if needed > fillable.saturating_add(1 << 16) {
            return Err(Damage::Unfillable);
        }
        if needed > LARGEST {
            return Err(Damage::Large);
        }
        // One byte more than may be tells that there are too many.
        let limit = most.min(fillable.saturating_add(1 << 16)).min(LARGEST) + 1;
        let unpacked = match self.compression {
            Compression::Lzw => lzw(packed, limit),
            Compression::PackBits => pack_bits(packed, limit),
            Compression::Deflate | Compression::None => deflate(packed, limit),
        };
        if unpacked.len() > most {
            Err(Damage::Long)
        } else if unpacked.len() < needed {
            Err(Damage::Short)
        } else {
            Ok(unpacked)
        }
    }

    /// A row without its predictor, the least byte of every sample first.
    fn undo(&self, row: &mut [u8], channels: usize) {
        let width = self.width;
        if self.predictor == Predictor::Float {
            for i in channels..row.len() {
                row[i] = row[i].wrapping_add(row[i - channels]);
            }
            let count = row.len() / width;
            let sorted = row.to_vec();
            for (i, sample) in row.chunks_exact_mut(width).enumerate() {
                for (weight, byte) in sample.iter_mut().rev().enumerate() {
                    *byte = sorted[weight * count + i];
                }
            }
            return;
        }
        if self.is_big_endian {
            row.chunks_exact_mut(width).for_each(<[u8]>::reverse);
        }
        if self.predictor == Predictor::Horizontal {
            let step = channels * width;
            for at in (step..row.len()).step_by(width) {
                let (before, from) = row.split_at_mut(at);
                add(&mut from[..width], &before[at - step..][..width]);
            }
        }
    }

    /// The sample of a number in what was unpacked, if it is there and stands for something; `nodata` stands for nothing.
    pub fn value(&self, samples: &[u8], index: usize, nodata: Option<f64>) -> Option<f64> {
        let at = index.checked_mul(self.width)?;
        let bytes = samples.get(at..at + self.width)?;
        let mut wide = [0; 8];
        wide[..self.width].copy_from_slice(bytes);
        let bits = u64::from_le_bytes(wide);
        let unused = 64 - 8 * self.width as u32;
        let value = match (self.kind, self.width) {
            (Kind::Unsigned, _) => bits as f64,
            (Kind::Signed, _) => ((bits << unused) as i64 >> unused) as f64,
            (Kind::Float, 2) => half(bits as u16),
            (Kind::Float, 4) => {
                let value = f32::from_bits(bits as u32);
                // What stands for nothing is written with more digits than a sample of 32 bits has.
                if nodata.map(|n| n as f32) == Some(value) {
                    return None;
                }
                f64::from(value)
            }
            (Kind::Float, _) => f64::from_bits(bits),
        };
        (nodata != Some(value) && value.is_finite()).then_some(value)
    }
}

fn compression(reader: &mut Reader) -> Result<Compression, GeoTiffError> {
    let number: u32 = reader.find_tag_unsigned(Tag::Compression)?.unwrap_or(1);
    let name = match number {
        1 => return Ok(Compression::None),
        5 => return Ok(Compression::Lzw),
        8 | 32946 => return Ok(Compression::Deflate),
        32773 => return Ok(Compression::PackBits),
        2..=4 => "CCITT fax",
        6 | 7 => "JPEG",
        34712 => "JPEG 2000",
        34887 => "LERC",
        34925 => "LZMA",
        50000 => "ZSTD",
        50001 => "WebP",
        50002 => "JPEG XL",
        _ => return Err(GeoTiffError::Compression(format!("number {number}"))),
    };
    Err(GeoTiffError::Compression(name.into()))
}

fn predictor(reader: &mut Reader, kind: Kind) -> Result<Predictor, GeoTiffError> {
    let number: Option<u32> = reader.find_tag_unsigned(Tag::Predictor)?;
    match number.unwrap_or(1) {
        1 => Ok(Predictor::None),
        2 => Ok(Predictor::Horizontal),
        3 if kind == Kind::Float => Ok(Predictor::Float),
        3 => Err(GeoTiffError::Blocks(
            "the predictor is one of floats, and the samples are integers",
        )),
        _ => Err(GeoTiffError::Blocks("the predictor is not known")),
    }
}

/// Adds integers, the least byte first.
fn add(to: &mut [u8], other: &[u8]) {
    let mut carry = 0;
    for (byte, other) in to.iter_mut().zip(other) {
        let sum = u16::from(*byte) + u16::from(*other) + carry;
        *byte = sum as u8;
        carry = sum >> 8;
    }
}

/// The value of a float of 16 bits (IEEE 754).
fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let (exponent, part) = (i32::from(bits >> 10 & 31), f64::from(bits & 1023) / 1024.0);
    match exponent {
        0 => sign * part * f64::from_bits((1023 - 14) << 52),
        31 if part == 0.0 => sign * f64::INFINITY,
        31 => f64::NAN,
        _ => sign * (1.0 + part) * f64::from_bits(((1023 - 15 + exponent) as u64) << 52),
    }
}

/// At most `limit` bytes; what was unpacked before the first damage.
fn deflate(packed: &[u8], limit: usize) -> Vec<u8> {
    let mut unpacked = Vec::new();
    let mut reader = flate2::read::ZlibDecoder::new(packed).take(limit as u64);
    // A damage after the last sample that is needed does no harm; one before it leaves too few bytes.
    let _ = reader.read_to_end(&mut unpacked);
    unpacked
}

/// As [`deflate`].
fn lzw(packed: &[u8], limit: usize) -> Vec<u8> {
    let mut decoder = weezl::decode::Decoder::with_tiff_size_switch(weezl::BitOrder::Msb, 8);
    let mut unpacked = vec![0; limit];
    let (mut read, mut written) = (0, 0);
    while written < limit {
        let done = decoder.decode_bytes(&packed[read..], &mut unpacked[written..]);
        read += done.consumed_in;
        written += done.consumed_out;
        let goes_on = matches!(done.status, Ok(weezl::LzwStatus::Ok));
        if !goes_on || done.consumed_in + done.consumed_out == 0 {
            break;
        }
    }
    unpacked.truncate(written);
    unpacked
}

/// As [`deflate`] (TIFF 6.0, section 9).
fn pack_bits(packed: &[u8], limit: usize) -> Vec<u8> {
    let mut unpacked = Vec::new();
    let mut rest = packed;
    while let ([head, tail @ ..], true) = (rest, unpacked.len() < limit) {
        rest = match (*head, tail) {
            (128, _) => tail,
            (0..128, _) => {
                let count = tail.len().min(usize::from(*head) + 1);
                unpacked.extend_from_slice(&tail[..count]);
                &tail[count..]
            }
            (_, [byte, tail @ ..]) => {
                unpacked.resize(unpacked.len() + 257 - usize::from(*head), *byte);
                tail
            }
            (_, []) => break,
        };
    }
    unpacked
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floats_of_16_bits_have_their_values() {
        let cases = [
            (0x3c00, 1.0),
            (0xc000, -2.0),
            (0x7bff, 65504.0),
            (0x0001, 5.960464477539063e-8),
            (0x3555, 0.333251953125),
        ];
        for (bits, value) in cases {
            assert_eq!(half(bits), value);
        }
        assert!(half(0x7c01).is_nan() && half(0x7c00).is_infinite());
    }

    #[test]
    fn runs_are_unpacked_as_the_standard_has_it() {
        let packed = [
            0xfe, 0xaa, 0x02, 0x80, 0x00, 0x2a, 0xfd, 0xaa, 0x03, 0x80, 0x00, 0x2a, 0x22, 0xf7,
            0xaa,
        ];
        let unpacked = [
            0xaa, 0xaa, 0xaa, 0x80, 0x00, 0x2a, 0xaa, 0xaa, 0xaa, 0xaa, 0x80, 0x00, 0x2a, 0x22,
        ];
        assert_eq!(
            pack_bits(&packed, 1000),
            [&unpacked[..], &[0xaa; 10]].concat()
        );
    }
}
