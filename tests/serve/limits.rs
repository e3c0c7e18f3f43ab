//! W3: how much, how long, how many.

use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::thread;
use std::time::{Duration, Instant};

use super::{Served, connect, read, send};

#[test]
fn a_head_may_be_sixteen_kibibytes() {
    let served = Served::new();
    let status = |length: usize| {
        let long = format!("X-Long: {}", "x".repeat(length));
        served.ask("GET /", &[&long], "").status
    };
    assert_eq!(status(15 << 10), 200);
    for length in [17 << 10, 100 << 10, 2 << 20] {
        assert_eq!(status(length), 431, "{length}");
    }
    let many: Vec<String> = (0..2000).map(|n| format!("X-{n}: {n}")).collect();
    let many: Vec<&str> = many.iter().map(String::as_str).collect();
    assert_eq!(served.ask("GET /", &many, "").status, 431);
    let path = format!("GET /{}", "x".repeat(20 << 10));
    assert!([414, 431].contains(&served.ask(&path, &[], "").status));
}

fn post(port: u16, heads: &str) -> TcpStream {
    let mut stream = connect(port);
    let head = format!(
        "POST /set HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nOrigin: http://127.0.0.1:{port}\r\n\
         Content-Type: application/json\r\nConnection: close\r\n{heads}\r\n\r\n"
    );
    stream.write_all(head.as_bytes()).unwrap();
    stream
}

#[test]
fn a_body_may_be_sixty_four_kibibytes() {
    let served = Served::new();
    let mut stream = post(served.port, "Content-Length: 65536");
    stream.write_all(&[b'x'; 65536]).unwrap();
    assert_eq!(read(stream).status, 400);
    assert_eq!(served.site.bodies.lock().unwrap()[0].len(), 65536);
    let mut stream = post(served.port, "Content-Length: 65537");
    let _ = stream.write_all(&[b'x'; 65537]);
    assert_eq!(read(stream).status, 413);
    assert_eq!(served.site.bodies.lock().unwrap().len(), 1);
}

#[test]
fn a_gigabyte_is_refused_before_it_comes() {
    let served = Served::new();
    let started = Instant::now();
    let mut stream = post(served.port, "Content-Length: 1073741824");
    let mut sent = 0;
    while sent < 1 << 26 && stream.write_all(&[b'x'; 1 << 16]).is_ok() {
        sent += 1 << 16;
    }
    assert!(sent < 1 << 26, "it reads on");
    assert!(started.elapsed() < Duration::from_secs(10));
    // Whoever listens first is told why.
    let stream = post(served.port, "Content-Length: 1073741824");
    assert_eq!(read(stream).status, 413);
}

#[test]
fn a_body_without_a_length_is_limited_too() {
    let served = Served::new();
    let mut stream = post(served.port, "Transfer-Encoding: chunked");
    let chunk = format!("4000\r\n{}\r\n", "x".repeat(0x4000));
    for _ in 0..6 {
        let _ = stream.write_all(chunk.as_bytes());
    }
    assert_eq!(read(stream).status, 413);
    assert!(served.site.bodies.lock().unwrap().is_empty());
}

#[test]
fn a_head_has_ten_seconds() {
    let served = Served::new();
    for begun in ["", "GET / HTTP/1.1\r\nHost: 127.0.0.1"] {
        let mut stream = connect(served.port);
        stream.write_all(begun.as_bytes()).unwrap();
        let started = Instant::now();
        let reply = read(stream);
        let waited = started.elapsed().as_secs_f64();
        assert_eq!(reply.status, 408, "{begun}");
        assert!((9.0..15.0).contains(&waited), "{waited}");
        assert!(reply.heads.contains("frame-ancestors 'none'"), "{reply:?}");
    }
}

#[test]
fn sixty_four_connections_are_served_and_the_others_are_told() {
    let served = Served::new();
    let request = format!(
        "GET /events HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n",
        served.port
    );
    let held: Vec<TcpStream> = (0..64)
        .map(|_| {
            let mut stream = connect(served.port);
            stream.write_all(request.as_bytes()).unwrap();
            let mut begun = [0; 12];
            stream.read_exact(&mut begun).unwrap();
            assert_eq!(&begun, b"HTTP/1.1 200");
            stream
        })
        .collect();
    let refused = send(served.port, request.as_bytes());
    assert_eq!(refused.status, 503, "{refused:?}");
    assert!(refused.heads.contains("nosniff"), "{refused:?}");
    // A client that hangs up in the middle of a stream gives its place back.
    drop(held);
    let started = Instant::now();
    while served.ask("GET /", &[], "").status != 200 {
        assert!(
            started.elapsed() < Duration::from_secs(10),
            "places are lost"
        );
        thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn a_thousand_connections_at_once_do_no_harm() {
    let served = Served::new();
    let mut held = Vec::new();
    for _ in 0..1000 {
        // The system may have no more of them, which is its own protection.
        if let Ok(stream) = TcpStream::connect(("127.0.0.1", served.port)) {
            held.push(stream);
        }
        if held.len() > 400 {
            held.swap_remove(7);
        }
    }
    drop(held);
    let started = Instant::now();
    while served.ask("GET /", &[], "").status != 200 {
        assert!(
            started.elapsed() < Duration::from_secs(20),
            "it has not recovered"
        );
        thread::sleep(Duration::from_millis(50));
    }
}

#[test]
fn a_connection_serves_several_requests() {
    let served = Served::new();
    let one = format!("GET / HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n", served.port);
    let last = one.replace("\r\n\r\n", "\r\nConnection: close\r\n\r\n");
    let all = format!("{one}{one}{last}");
    let mut stream = connect(served.port);
    stream.write_all(all.as_bytes()).unwrap();
    let mut text = String::new();
    stream.read_to_string(&mut text).unwrap();
    assert_eq!(text.matches("HTTP/1.1 200").count(), 3);
}
