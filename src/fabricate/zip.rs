//! ZIP archives with the same bytes every time: deflated, without times, in the order given.

use std::io::Write;

use flate2::Compression;
use flate2::write::DeflateEncoder;

/// 1 January 1980, the earliest day that the format knows.
const DATE: u16 = 1 << 5 | 1;
/// Version 2.0 of the format: deflated files.
const VERSION: u16 = 20;
/// Names are UTF-8.
const FLAGS: u16 = 1 << 11;
const DEFLATED: u16 = 8;
/// How hard the encoder looks for repetitions: coordinates have few, and higher levels take three times as long for a few percent.
const LEVEL: u32 = 3;

/// The archive of `files`, names and contents. None when one of them, or all together, has four gigabytes.
pub fn archive(files: &[(&str, &[u8])]) -> Option<Vec<u8>> {
    let (mut out, mut directory) = (Vec::new(), Vec::new());
    for (name, content) in files {
        let start = u32::try_from(out.len()).ok()?;
        let mut encoder = DeflateEncoder::new(Vec::new(), Compression::new(LEVEL));
        let deflated = encoder
            .write_all(content)
            .and_then(|()| encoder.finish())
            .ok()?;
        let header = header(name, content, &deflated)?;
        out.extend(0x0403_4b50_u32.to_le_bytes());
        out.extend(&header);
        out.extend(name.as_bytes());
        out.extend(&deflated);
        directory.extend(0x0201_4b50_u32.to_le_bytes());
        directory.extend(VERSION.to_le_bytes());
        directory.extend(&header);
        // No comment, first disk, no attributes.
        directory.extend([0; 10]);
        directory.extend(start.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let start = u32::try_from(out.len()).ok()?;
    let count = u16::try_from(files.len()).ok()?.to_le_bytes();
    let size = u32::try_from(directory.len()).ok()?;
    out.extend(directory);
    out.extend(0x0605_4b50_u32.to_le_bytes());
    out.extend([0; 4]);
    out.extend(count);
    out.extend(count);
    out.extend(size.to_le_bytes());
    out.extend(start.to_le_bytes());
    out.extend([0; 2]);
    Some(out)
}

/// The fields that a file's own header and its entry in the directory share.
fn header(name: &str, content: &[u8], deflated: &[u8]) -> Option<Vec<u8>> {
    let mut header = Vec::with_capacity(26);
    for field in [VERSION, FLAGS, DEFLATED, 0, DATE] {
        header.extend(field.to_le_bytes());
    }
    let sizes = [
        u32::try_from(deflated.len()).ok()?,
        u32::try_from(content.len()).ok()?,
    ];
    for field in [crc32fast::hash(content), sizes[0], sizes[1]] {
        header.extend(field.to_le_bytes());
    }
    header.extend(u16::try_from(name.len()).ok()?.to_le_bytes());
    // No extra fields.
    header.extend([0; 2]);
    Some(header)
}

#[cfg(test)]
mod tests {
    use std::io::Read;

    use super::*;

    #[test]
    fn contents_come_back() {
        let text = b"one one one one one one".as_slice();
        let archive = archive(&[("a/b.txt", text), ("c", b"")]).unwrap();
        let size = u32::from_le_bytes(archive[18..22].try_into().unwrap()) as usize;
        let mut back = Vec::new();
        flate2::read::DeflateDecoder::new(&archive[37..37 + size])
            .read_to_end(&mut back)
            .unwrap();
        assert_eq!(back, text);
        assert_eq!(&archive[30..37], b"a/b.txt");
        assert_eq!(&archive[archive.len() - 22..][..4], b"PK\x05\x06");
    }
}
