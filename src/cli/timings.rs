//! The trace of a build in Chrome's trace event format, which Perfetto and `chrome://tracing` open.

use std::io;
use std::path::{Path, PathBuf};

use serde_json::json;

use super::place::Place;
use super::terminal::Failure;
use fretwork_engine::Report;
use fretwork_store::Lasting;

/// What every trace begins with.
const HEAD: &str = "{\"displayTimeUnit\":\"ms\",\"traceEvents\":[";

/// Where a trace is to be written.
pub struct Trace {
    path: PathBuf,
    place: Place,
    name: String,
}

impl Trace {
    /// The file `path`, as the project at `root` sees it.
    ///
    /// # Errors
    /// When something is there that is no trace: a spec, a device, or another file.
    pub fn at(root: &Path, path: &Path) -> Result<Trace, Failure> {
        let failed = |e: io::Error| refused(path, &e);
        let (place, name) = Place::of_file(root, path).map_err(failed)?;
        match place.open().and_then(|folder| folder.read(&name)) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Err(failed(error)),
            Ok(bytes) if bytes.is_empty() || bytes.starts_with(HEAD.as_bytes()) => {}
            Ok(_) => {
                let foreign = io::Error::other("the file there is no trace of a build");
                return Err(failed(foreign));
            }
        }
        Ok(Trace {
            path: path.to_path_buf(),
            place,
            name,
        })
    }

    /// Writes the trace of a build.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(&self, report: &Report) -> Result<(), Failure> {
        let text = trace(report);
        let folder = self.place.make().map_err(|e| refused(&self.path, &e))?;
        let result = folder.write(&self.name, &[text.as_bytes()], Lasting::UntilPowerFails);
        result.map_err(|e| refused(&self.path, &e))
    }
}

fn refused(path: &Path, error: &io::Error) -> Failure {
    Failure::usage(format!("cannot write `{}`: {error}", path.display()))
}

/// One complete event (`"ph": "X"`) per job that ran; microseconds since the build began.
fn trace(report: &Report) -> String {
    let event = |span: &fretwork_engine::TraceSpan| {
        let event = json!({
            "name": span.name, "cat": span.kind, "ph": "X", "pid": 1, "tid": span.thread,
            "ts": span.start.as_micros() as u64, "dur": span.time.as_micros() as u64,
            "args": { "status": span.status },
        });
        event.to_string()
    };
    let events: Vec<String> = report.spans.iter().map(event).collect();
    format!("{HEAD}{}]}}\n", events.join(","))
}
