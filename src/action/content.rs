//! What is in a file: its bytes, or, of a raster that is too large to be held, a way to read parts of it. Where the parts
//! come from is for whoever opens the file.

use std::fmt;
use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::sync::Arc;

use super::files::{FILE_LIMIT, ReadError};

/// Rasters of more bytes than this are read by parts.
pub const HELD_LIMIT: u64 = 8 << 20;

/// Whether the file at `path` may be read by parts: whether its name is that of a TIFF.
pub fn is_read_by_parts(path: &str) -> bool {
    let ending = path.rsplit_once('.').map_or("", |(_, ending)| ending);
    let endings = ["tif", "tiff"];
    endings
        .iter()
        .any(|known| ending.eq_ignore_ascii_case(known))
}

/// A file that is held open, and of which parts are read.
pub trait Parts: Send + Sync {
    /// How many bytes it has.
    fn size(&self) -> u64;

    /// Reads bytes from `offset` on, and gives how many these are; none at the end.
    ///
    /// # Errors
    /// When it cannot be read, and when it is no longer what it was when it was opened.
    fn read_at(&self, offset: u64, into: &mut [u8]) -> io::Result<usize>;

    /// What tells this file, as it is, from any other, and from what it was before it was written to.
    fn state(&self) -> &[u8];

    /// Whether another process that finds the same state finds the same bytes. Not so just after the file was written:
    /// it may be written to again before the clock of the file system has moved on.
    fn is_settled(&self) -> bool;
}

/// What is in a file.
#[derive(Clone)]
pub enum Content {
    /// Its bytes.
    Bytes(Arc<[u8]>),
    /// A way to read it.
    Parts {
        /// The file.
        parts: Arc<dyn Parts>,
        /// The BLAKE3 digest of all of its bytes.
        digest: [u8; 32],
    },
}

impl fmt::Debug for Content {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Content::Bytes(bytes) => write!(f, "{} bytes", bytes.len()),
            Content::Parts { parts, .. } => write!(f, "{} bytes by parts", parts.size()),
        }
    }
}

/// What bytes are read from.
pub trait Source: Read + Seek + Send {}

impl<T: Read + Seek + Send> Source for T {}

impl Content {
    /// All of its bytes.
    ///
    /// # Errors
    /// When they cannot be read, or are more than [`FILE_LIMIT`].
    pub fn whole(&self) -> Result<Arc<[u8]>, ReadError> {
        match self {
            Content::Bytes(bytes) => Ok(bytes.clone()),
            Content::Parts { parts, .. } if parts.size() > FILE_LIMIT => Err(ReadError::TooLarge),
            Content::Parts { parts, .. } => {
                let mut bytes = Vec::with_capacity(parts.size() as usize);
                let read = PartsReader::new(parts.clone()).read_to_end(&mut bytes);
                read.map_err(|error| ReadError::Io(error.to_string()))?;
                Ok(bytes.into())
            }
        }
    }

    /// What reads its bytes one after the other, from any place.
    pub fn source(&self) -> Box<dyn Source> {
        match self {
            Content::Bytes(bytes) => Box::new(Cursor::new(bytes.clone())),
            Content::Parts { parts, .. } => Box::new(PartsReader::new(parts.clone())),
        }
    }
}

/// Reads parts one after the other.
pub struct PartsReader {
    parts: Arc<dyn Parts>,
    at: u64,
}

impl PartsReader {
    /// From the beginning.
    pub fn new(parts: Arc<dyn Parts>) -> PartsReader {
        PartsReader { parts, at: 0 }
    }
}

impl Read for PartsReader {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let count = self.parts.read_at(self.at, into)?;
        self.at += count as u64;
        Ok(count)
    }
}

impl Seek for PartsReader {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let at = match to {
            SeekFrom::Start(at) => Some(at),
            SeekFrom::End(by) => self.parts.size().checked_add_signed(by),
            SeekFrom::Current(by) => self.at.checked_add_signed(by),
        };
        self.at = at.ok_or_else(|| io::Error::from(io::ErrorKind::InvalidInput))?;
        Ok(self.at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Letters;

    impl Parts for Letters {
        fn size(&self) -> u64 {
            26
        }

        fn read_at(&self, offset: u64, into: &mut [u8]) -> io::Result<usize> {
            let rest = &b"abcdefghijklmnopqrstuvwxyz"[offset.min(26) as usize..];
            let count = rest.len().min(into.len()).min(3);
            into[..count].copy_from_slice(&rest[..count]);
            Ok(count)
        }

        fn state(&self) -> &[u8] {
            b"letters"
        }

        fn is_settled(&self) -> bool {
            true
        }
    }

    #[test]
    fn parts_are_read_as_the_whole_is() {
        let content = Content::Parts {
            parts: Arc::new(Letters),
            digest: [0; 32],
        };
        assert_eq!(content.whole().unwrap().len(), 26);
        let held = Content::Bytes(content.whole().unwrap());
        for content in [content, held] {
            let (mut source, mut part) = (content.source(), [0; 5]);
            source.seek(SeekFrom::Start(2)).unwrap();
            source.seek(SeekFrom::Current(1)).unwrap();
            source.read_exact(&mut part).unwrap();
            assert_eq!(&part, b"defgh");
            assert_eq!(source.seek(SeekFrom::End(-1)).unwrap(), 25);
            assert!(source.read_exact(&mut part).is_err());
            assert!(source.seek(SeekFrom::Current(-100)).is_err());
        }
    }

    #[test]
    fn rasters_are_known_by_their_names() {
        assert!(is_read_by_parts("a/b.tif") && is_read_by_parts("x.TIFF"));
        assert!(!is_read_by_parts("tif") && !is_read_by_parts("a.tif.gz"));
    }
}
