//! Files beside the artifacts that a command writes where it is told to: a trace, a report. They never take the place of a file
//! of another sort.

use std::io;
use std::path::{Path, PathBuf};

use super::place::Place;
use super::terminal::Failure;
use fretwork_store::Lasting;

/// A file that is to be written.
pub struct OwnFile {
    path: PathBuf,
    place: Place,
    name: String,
}

impl OwnFile {
    /// The file `path`, as the project at `root` sees it. All files of its sort begin with `head`; `sort` says what they are.
    ///
    /// # Errors
    /// When something of another sort is there: a spec, a device, or another file.
    pub fn at(root: &Path, path: &Path, head: &str, sort: &str) -> Result<OwnFile, Failure> {
        let failed = |e: io::Error| refused(path, &e);
        let (place, name) = Place::of_file(root, path).map_err(failed)?;
        match place.open().and_then(|folder| folder.read(&name)) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Err(failed(error)),
            Ok(bytes) if bytes.is_empty() || bytes.starts_with(head.as_bytes()) => {}
            Ok(_) => {
                let foreign = io::Error::other(format!("the file there is no {sort}"));
                return Err(failed(foreign));
            }
        }
        Ok(OwnFile {
            path: path.to_path_buf(),
            place,
            name,
        })
    }

    /// Writes the file.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(&self, text: &str) -> Result<(), Failure> {
        let folder = self.place.make().map_err(|e| refused(&self.path, &e))?;
        let result = folder.write(&self.name, &[text.as_bytes()], Lasting::UntilPowerFails);
        result.map_err(|e| refused(&self.path, &e))
    }
}

fn refused(path: &Path, error: &io::Error) -> Failure {
    Failure::usage(format!("cannot write `{}`: {error}", path.display()))
}
