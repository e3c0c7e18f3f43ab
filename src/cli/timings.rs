//! The trace of a build in Chrome's trace event format, which Perfetto and `chrome://tracing` open.

use serde_json::json;

use fretwork_engine::Report;

/// One complete event (`"ph": "X"`) per job that ran; microseconds since the build began.
pub fn trace(report: &Report) -> String {
    let events: Vec<_> = report
        .spans
        .iter()
        .map(|span| {
            json!({
                "name": span.name, "cat": span.kind, "ph": "X", "pid": 1, "tid": span.thread,
                "ts": span.start.as_micros() as u64, "dur": span.time.as_micros() as u64,
                "args": { "status": span.status },
            })
        })
        .collect();
    json!({ "displayTimeUnit": "ms", "traceEvents": events }).to_string() + "\n"
}
