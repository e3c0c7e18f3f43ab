//! A file of the disk that is held open and read by parts, as long as nobody writes to it.

use std::fs::{File, Metadata};
use std::io::{self, Read as _, Seek as _, SeekFrom};
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, SystemTime};

use fretwork_engine::Parts;

/// After so long a file that is written to again has another time of modification on every file system.
const SETTLES: Duration = Duration::from_secs(2);

/// An open file. One that is renamed over it leaves it as it was.
pub struct DiskParts {
    file: Mutex<File>,
    size: u64,
    state: Vec<u8>,
    is_settled: bool,
}

impl DiskParts {
    /// Opens the file at `path`.
    ///
    /// # Errors
    /// When it cannot be opened.
    pub fn open(path: &Path) -> io::Result<DiskParts> {
        let file = File::open(path)?;
        let meta = file.metadata()?;
        let age = SystemTime::now().duration_since(meta.modified()?);
        Ok(DiskParts {
            size: meta.len(),
            state: [
                &*written(&meta)?,
                &*identity(&meta),
                path.as_os_str().as_encoded_bytes(),
            ]
            .concat(),
            is_settled: age.is_ok_and(|age| age > SETTLES),
            file: Mutex::new(file),
        })
    }

    fn check(&self, file: &File) -> io::Result<()> {
        // The identity is left out: a file that was renamed over this one has changed it, and not these bytes.
        let is_same = self.state.starts_with(&written(&file.metadata()?)?);
        let changed = || io::Error::other("the file changed while it was read");
        is_same.then_some(()).ok_or_else(changed)
    }
}

impl Parts for DiskParts {
    fn size(&self) -> u64 {
        self.size
    }

    fn read_at(&self, offset: u64, into: &mut [u8]) -> io::Result<usize> {
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.seek(SeekFrom::Start(offset))?;
        let count = file.read(into)?;
        // After the bytes were read: what was written before has left its trace by now.
        self.check(&file)?;
        Ok(count)
    }

    fn state(&self) -> &[u8] {
        &self.state
    }

    fn is_settled(&self) -> bool {
        self.is_settled
    }
}

/// The size and the time of modification.
fn written(meta: &Metadata) -> io::Result<Vec<u8>> {
    let since = meta.modified()?.duration_since(SystemTime::UNIX_EPOCH);
    let since = since.unwrap_or_default().as_nanos();
    Ok([&meta.len().to_le_bytes()[..], &since.to_le_bytes()].concat())
}

/// The file's number, and when it was last written to, renamed or given another time of modification.
#[cfg(unix)]
fn identity(meta: &Metadata) -> Vec<u8> {
    use std::os::unix::fs::MetadataExt as _;
    let numbers = [
        meta.dev(),
        meta.ino(),
        meta.ctime() as u64,
        meta.ctime_nsec() as u64,
    ];
    numbers.map(u64::to_le_bytes).concat()
}

#[cfg(not(unix))]
fn identity(_: &Metadata) -> Vec<u8> {
    Vec::new()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_file_that_is_written_to_is_read_no_further() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.tif");
        fs::write(&path, b"0123456789").unwrap();
        let parts = DiskParts::open(&path).unwrap();
        let mut part = [0; 4];
        assert_eq!(parts.read_at(3, &mut part).unwrap(), 4);
        assert_eq!((&part, parts.size()), (b"3456", 10));
        assert!(!parts.is_settled());
        // One that takes its place is another file.
        let other = folder.path().join("b.tif");
        fs::write(&other, b"abcdefghij").unwrap();
        assert_ne!(DiskParts::open(&other).unwrap().state(), parts.state());
        fs::rename(&other, &path).unwrap();
        assert_eq!(parts.read_at(3, &mut part).unwrap(), 4);
        let parts = DiskParts::open(&path).unwrap();
        fs::write(&path, b"01234567890").unwrap();
        let error = parts.read_at(0, &mut part).unwrap_err().to_string();
        assert_eq!(error, "the file changed while it was read");
    }

    #[test]
    fn a_file_of_long_ago_is_settled() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.tif");
        fs::write(&path, b"x").unwrap();
        let day = Duration::from_secs(86_400);
        let file = File::options().append(true).open(&path).unwrap();
        file.set_modified(SystemTime::now() - day).unwrap();
        let before = DiskParts::open(&path).unwrap();
        assert!(before.is_settled());
        file.set_modified(SystemTime::now() - 2 * day).unwrap();
        assert_ne!(DiskParts::open(&path).unwrap().state(), before.state());
    }
}
