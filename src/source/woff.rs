//! WOFF fonts of version 1 and 2, as web pages have them, unpacked to the TrueType or OpenType font inside (W3C,
//! WOFF File Format 1.0, sections 3 to 5, and 2.0). What the font holds is read in `font`.

use flate2::{Decompress, FlushDecompress, Status};

/// The largest font that is unpacked, by what its head says: five times the largest in common use.
const LARGEST: usize = 100 << 20;

/// Why a font cannot be unpacked.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WoffError {
    /// The file ends before what its head says.
    #[error("the WOFF font is cut off")]
    CutOff,
    /// Something contradicts the format.
    #[error("the WOFF font is damaged: {0}")]
    Damaged(String),
    /// The font inside would be larger than fonts are.
    #[error("the WOFF font would be {0} bytes large, more than {LARGEST}")]
    TooLarge(usize),
}

/// Whether these are the bytes of a WOFF font.
pub fn is_woff(bytes: &[u8]) -> bool {
    bytes.starts_with(b"wOFF") || bytes.starts_with(b"wOF2")
}

/// The TrueType or OpenType font in a WOFF font. Metadata and private data are left out, checksums are not
/// looked at.
///
/// # Errors
/// [`WoffError`]; sizes are compared with the limit before anything is unpacked.
pub fn unpacked(bytes: &[u8]) -> Result<Vec<u8>, WoffError> {
    if bytes.starts_with(b"wOF2") {
        let font = wuff::decompress_woff2(bytes);
        return font.map_err(|error| WoffError::Damaged(error.to_string()));
    }
    let flavour = slice(bytes, 4, 4)?;
    let count = usize::from(u16_at(bytes, 12)?);
    let mut tables = (0..count)
        .map(|k| Table::read(bytes, HEAD + k * ENTRY))
        .collect::<Result<Vec<Table>, WoffError>>()?;
    if tables.is_empty() {
        return Err(damaged("it has no tables"));
    }
    let directory = 12 + 16 * count;
    let size: usize = tables.iter().map(|table| table.length + 3).sum();
    if directory + size > LARGEST {
        return Err(WoffError::TooLarge(directory + size));
    }
    tables.sort_by_key(|table| table.tag);
    let mut font = Vec::with_capacity(directory + size);
    font.extend_from_slice(flavour);
    let power = count.ilog2();
    let range = 16_usize << power;
    for field in [count, range, power as usize, 16 * count - range] {
        // Fields beyond 16 bits are those of more tables than a font can have, which no reader looks up.
        font.extend_from_slice(&(field as u16).to_be_bytes());
    }
    font.resize(directory, 0);
    for (k, table) in tables.iter().enumerate() {
        let at = font.len();
        let record = [
            table.tag,
            table.checksum,
            (at as u32).to_be_bytes(),
            (table.length as u32).to_be_bytes(),
        ];
        font[12 + 16 * k..28 + 16 * k].copy_from_slice(&record.concat());
        table.unpack(bytes, &mut font)?;
        font.resize(font.len().next_multiple_of(4), 0);
    }
    Ok(font)
}

/// Bytes before the directory of tables, and of an entry of it.
const HEAD: usize = 44;
const ENTRY: usize = 20;

/// An entry of the directory of tables.
struct Table {
    tag: [u8; 4],
    checksum: [u8; 4],
    at: usize,
    /// As packed.
    packed: usize,
    /// In the font.
    length: usize,
}

impl Table {
    fn read(bytes: &[u8], at: usize) -> Result<Table, WoffError> {
        let table = Table {
            tag: four(bytes, at)?,
            at: u32_at(bytes, at + 4)?,
            packed: u32_at(bytes, at + 8)?,
            length: u32_at(bytes, at + 12)?,
            checksum: four(bytes, at + 16)?,
        };
        if table.packed > table.length {
            return Err(damaged("a table is larger packed than unpacked"));
        }
        Ok(table)
    }

    /// Adds the table to the font.
    fn unpack(&self, bytes: &[u8], font: &mut Vec<u8>) -> Result<(), WoffError> {
        let packed = slice(bytes, self.at, self.packed)?;
        if self.packed == self.length {
            font.extend_from_slice(packed);
            return Ok(());
        }
        let mut table = Vec::with_capacity(self.length);
        let status = Decompress::new(true)
            .decompress_vec(packed, &mut table, FlushDecompress::Finish)
            .map_err(|error| damaged(&error.to_string()))?;
        if status != Status::StreamEnd || table.len() != self.length {
            return Err(damaged("a table has another size than it says"));
        }
        font.append(&mut table);
        Ok(())
    }
}

fn damaged(what: &str) -> WoffError {
    WoffError::Damaged(what.to_owned())
}

fn slice(bytes: &[u8], at: usize, length: usize) -> Result<&[u8], WoffError> {
    let end = at.checked_add(length).ok_or(WoffError::CutOff)?;
    bytes.get(at..end).ok_or(WoffError::CutOff)
}

fn four(bytes: &[u8], at: usize) -> Result<[u8; 4], WoffError> {
    slice(bytes, at, 4)?
        .try_into()
        .map_err(|_| WoffError::CutOff)
}

fn u32_at(bytes: &[u8], at: usize) -> Result<usize, WoffError> {
    Ok(u32::from_be_bytes(four(bytes, at)?) as usize)
}

fn u16_at(bytes: &[u8], at: usize) -> Result<u16, WoffError> {
    let both = slice(bytes, at, 2)?;
    Ok(u16::from_be_bytes([both[0], both[1]]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::font::set;

    const FONT: &[u8] = include_bytes!("../../tests/drawings/fret.ttf");
    const WOFF: &[u8] = include_bytes!("../../tests/drawings/fret.woff");
    const WOFF2: &[u8] = include_bytes!("../../tests/drawings/fret.woff2");

    #[test]
    fn packed_fonts_have_the_same_letters() {
        let plain = set(FONT, "FRET OB", 10.0, 0.01).unwrap();
        for packed in [WOFF, WOFF2] {
            assert!(is_woff(packed));
            assert_eq!(set(packed, "FRET OB", 10.0, 0.01).as_ref(), Ok(&plain));
        }
        assert!(!is_woff(FONT));
    }

    #[test]
    fn tables_are_as_in_the_font() {
        let font = unpacked(WOFF).unwrap();
        let count = u16_at(FONT, 4).unwrap();
        assert_eq!(slice(&font, 0, 12), slice(FONT, 0, 12));
        let table = |font: &[u8], k: usize| {
            let entry = 12 + 16 * k;
            let (at, length) = (
                u32_at(font, entry + 8).unwrap(),
                u32_at(font, entry + 12).unwrap(),
            );
            (
                four(font, entry).unwrap(),
                slice(font, at, length).unwrap().to_vec(),
            )
        };
        for k in 0..usize::from(count) {
            let (tag, bytes) = table(&font, k);
            let (other, expected) = table(FONT, k);
            assert_eq!(tag, other);
            // The whole font's checksum is in `head`.
            assert!(bytes == expected || tag == *b"head", "{tag:?}");
        }
    }

    #[test]
    fn bombs_are_refused_from_their_heads() {
        let mut bomb = WOFF.to_vec();
        bomb[HEAD + 12..HEAD + 16].copy_from_slice(&u32::MAX.to_be_bytes());
        assert!(matches!(unpacked(&bomb), Err(WoffError::TooLarge(_))));
        let mut lie = WOFF.to_vec();
        let table = (0..).map(|k| HEAD + k * ENTRY);
        let mut packed = table.filter(|&at| u32_at(WOFF, at + 8) != u32_at(WOFF, at + 12));
        let at = packed.next().unwrap();
        let longer = u32_at(WOFF, at + 12).unwrap() as u32 + 1;
        lie[at + 12..at + 16].copy_from_slice(&longer.to_be_bytes());
        assert_eq!(
            unpacked(&lie),
            Err(damaged("a table has another size than it says"))
        );
    }

    #[test]
    fn what_is_cut_off_or_damaged_is_an_error() {
        for font in [WOFF, WOFF2] {
            for end in 0..font.len() - 4 {
                assert!(unpacked(&font[..end]).is_err() || end < 4, "{end}");
            }
            for at in 0..font.len() {
                let mut damaged = font.to_vec();
                damaged[at] ^= 0x55;
                if let Ok(font) = unpacked(&damaged) {
                    let _ = set(&font, "FRET", 10.0, 0.1);
                }
            }
        }
    }

    #[test]
    #[ignore = "takes minutes"]
    fn random_damage_is_an_error_or_a_font() {
        use fretwork_geometry::Seed;
        for round in 0..300_000 {
            let seed = Seed::root(round).name("woff");
            let pick = |k: u64, below: usize| (seed.unit(k) * below as f64) as usize;
            let mut font = [WOFF, WOFF2][pick(0, 2)].to_vec();
            for k in 0..1 + pick(1, 6) as u64 {
                let at = 4 + pick(10 + 3 * k, font.len().min(400) - 4);
                let values = [0, 1, 0x7f, 0x80, 0xff, pick(11 + 3 * k, 256)];
                font[at] = values[pick(12 + 3 * k, 6)] as u8;
            }
            if let Ok(font) = unpacked(&font) {
                let _ = set(&font, "FRET", 10.0, 0.1);
            }
        }
    }
}
