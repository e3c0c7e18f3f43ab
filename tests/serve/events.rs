//! W4: what the page is told.

use std::io::{BufRead as _, BufReader, Write as _};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use super::{Served, connect};

/// The lines of a stream of events.
fn listen(served: &Served) -> BufReader<TcpStream> {
    let mut stream = connect(served.port);
    let request = format!(
        "GET /events HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n",
        served.port
    );
    stream.write_all(request.as_bytes()).unwrap();
    BufReader::new(stream)
}

/// The next line of an event: neither a head nor the length of a chunk.
fn said(stream: &mut BufReader<TcpStream>) -> String {
    loop {
        let mut line = String::new();
        assert!(
            stream.read_line(&mut line).unwrap() > 0,
            "the stream has ended"
        );
        let line = line.trim_end();
        if ["event: ", "data: "]
            .iter()
            .any(|start| line.starts_with(start))
            || line == ":"
        {
            return line.to_owned();
        }
    }
}

#[test]
fn the_last_build_is_told_at_once_and_each_that_follows() {
    let served = Served::new();
    let mut stream = listen(&served);
    let mut next = || (said(&mut stream), said(&mut stream));
    let event = |name: &str, json: &str| (format!("event: {name}"), format!("data: {json}"));
    assert_eq!(next(), event("build", "{\"build\":1,\"ok\":true}"));
    served.site.bell.progress("{\"done\":1}".into());
    assert_eq!(next(), event("progress", "{\"done\":1}"));
    served.site.bell.build("{\"build\":2,\"ok\":false}".into());
    assert_eq!(next(), event("build", "{\"build\":2,\"ok\":false}"));
    let mut late = listen(&served);
    assert_eq!(said(&mut late), "event: build");
    assert_eq!(said(&mut late), "data: {\"build\":2,\"ok\":false}");
}

#[test]
fn whoever_reads_slowly_is_told_of_the_newest_build_only() {
    let served = Served::new();
    let mut stream = listen(&served);
    assert_eq!(said(&mut stream), "event: build");
    // More than the system keeps for a connection.
    let long = format!("\"long\":\"{}\"", "x".repeat(4000));
    for build in 2..100_000 {
        served
            .site
            .bell
            .build(format!("{{\"build\":{build},{long}}}"));
    }
    let mut count = 0;
    while !said(&mut stream).contains("\"build\":99999,") {
        count += 1;
    }
    assert!(count < 20_000, "{count} lines were kept");
}

#[test]
fn a_silent_stream_has_a_comment_in_fifteen_seconds() {
    let served = Served::new();
    let mut stream = listen(&served);
    said(&mut stream);
    said(&mut stream);
    let started = Instant::now();
    assert_eq!(said(&mut stream), ":");
    let waited = started.elapsed();
    assert!(waited > Duration::from_secs(14), "{waited:?}");
    assert!(waited < Duration::from_secs(20), "{waited:?}");
}
