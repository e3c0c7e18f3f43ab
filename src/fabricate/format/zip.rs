//! ZIP archives with the same bytes every time: deflated, all of one day, in the order given.

use std::io::Write;

use flate2::Compression;
use flate2::write::DeflateEncoder;
use rawzip::time::UtcDateTime;
use rawzip::{CompressionMethod, Error, ZipArchiveWriter};

/// 1 January 1980, the earliest day that the format knows.
const DAY: Option<UtcDateTime> = UtcDateTime::from_components(1980, 1, 1, 0, 0, 0, 0);
/// How hard the encoder looks for repetitions: coordinates have few, and higher levels take three
/// times as long for a few percent.
const LEVEL: u32 = 3;

/// The archive of `files`, names and contents.
///
/// # Errors
/// When a name cannot stand in an archive.
pub fn archive(files: &[(&str, &[u8])]) -> Result<Vec<u8>, Error> {
    let mut archive = ZipArchiveWriter::new(Vec::new());
    for (name, content) in files {
        let mut file = archive
            .new_file(*name)
            .compression_method(CompressionMethod::DEFLATE);
        if let Some(day) = DAY {
            file = file.last_modified(day);
        }
        let (mut entry, config) = file.start()?;
        let encoder = DeflateEncoder::new(&mut entry, Compression::new(LEVEL));
        let mut writer = config.wrap(encoder);
        writer.write_all(content)?;
        let (encoder, descriptor) = writer.finish()?;
        encoder.finish()?;
        entry.finish(descriptor)?;
    }
    archive.finish()
}

#[cfg(test)]
mod tests {
    use std::io::Read;

    use super::*;

    #[test]
    fn contents_come_back() {
        let files = [
            ("a/b.txt", b"one one one one one one".as_slice()),
            ("c", b""),
        ];
        let bytes = archive(&files).unwrap();
        assert_eq!(bytes, archive(&files).unwrap());
        let read = rawzip::ZipArchive::from_slice(&bytes).unwrap();
        let mut entries = read.entries();
        for (name, content) in files {
            let entry = entries.next_entry().unwrap().unwrap();
            assert_eq!(entry.file_path().as_ref(), name.as_bytes());
            let data = read.get_entry(entry.wayfinder()).unwrap();
            let decoder = flate2::read::DeflateDecoder::new(data.data());
            let mut back = Vec::new();
            data.verifying_reader(decoder)
                .read_to_end(&mut back)
                .unwrap();
            assert_eq!(back, content);
        }
    }
}
