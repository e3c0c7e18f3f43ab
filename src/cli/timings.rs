//! The trace of a build in Chrome's trace event format, which Perfetto and `chrome://tracing` open.

use std::path::Path;

use serde_json::json;

use super::own_file::OwnFile;
use super::terminal::Failure;
use fretwork_engine::Report;

/// What every trace begins with.
const HEAD: &str = "{\"displayTimeUnit\":\"ms\",\"traceEvents\":[";

/// Where a trace is to be written.
pub struct Trace(OwnFile);

impl Trace {
    /// The file `path`, as the project at `root` sees it.
    ///
    /// # Errors
    /// When something is there that is no trace: a spec, a device, or another file.
    pub fn at(root: &Path, path: &Path) -> Result<Trace, Failure> {
        OwnFile::at(root, path, HEAD, "trace of a build").map(Trace)
    }

    /// Writes the trace of a build.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(&self, report: &Report) -> Result<(), Failure> {
        self.0.write(&trace(report))
    }
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
