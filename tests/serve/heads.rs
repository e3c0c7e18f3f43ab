//! Heads that nobody would send: whatever comes, the server answers or hangs up, lets nobody in whom it does not know, and
//! goes on.

use std::io::Write as _;
use std::net::Shutdown;

use super::super::project::Random;
use super::{Served, connect, read};

/// Requests that are changed bit by bit.
fn seeds(port: u16) -> [String; 4] {
    let host = format!("Host: 127.0.0.1:{port}\r\n");
    let origin = format!("Origin: http://127.0.0.1:{port}\r\n");
    [
        format!("GET / HTTP/1.1\r\n{host}\r\n"),
        format!("GET /files/a%20b/%C3%BC%25.svg?v=1 HTTP/1.1\r\n{host}{origin}Accept: */*\r\n\r\n"),
        format!(
            "POST /set HTTP/1.1\r\n{host}{origin}Content-Type: application/json\r\n\
             Content-Length: 3\r\n\r\nyes"
        ),
        format!(
            "POST /set HTTP/1.1\r\n{host}{origin}Content-Type: application/json\r\n\
             Transfer-Encoding: chunked\r\n\r\n3\r\nyes\r\n0\r\n\r\n"
        ),
    ]
}

const PIECES: [&[u8]; 16] = [
    b"\r\n",
    b"\n",
    b"\0",
    b"\xff",
    b"%2e%2e/",
    b"../",
    b"Host: evil.example\r\n",
    b"Origin: null\r\n",
    b"Content-Length: 99999999999999999999\r\n",
    b"Content-Length: -1\r\n",
    b"Transfer-Encoding: chunked\r\n",
    b"HTTP/9.9",
    b" ",
    b":",
    b"\t folded\r\n",
    b"ffffffffffffffff\r\n",
];

fn mutated(seed: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len() as u64 + 1) as usize;
        let until = (at + random.below(12) as usize).min(bytes.len());
        match random.below(4) {
            0 => {
                bytes.splice(at..until, []);
            }
            1 => {
                let piece = PIECES[random.below(PIECES.len() as u64) as usize];
                bytes.splice(at..at, piece.iter().copied());
            }
            2 if at < bytes.len() => bytes[at] ^= 1 << random.below(8),
            _ => {
                let copy = bytes[at..until].to_vec();
                bytes.splice(at..at, copy);
            }
        }
    }
    bytes
}

#[test]
fn mutated_heads_neither_end_the_server_nor_let_others_in() {
    let served = Served::new();
    let seeds = seeds(served.port);
    let mut random = Random(11);
    for round in 0..3000 {
        let seed = seeds[random.below(4) as usize].as_bytes();
        let request = mutated(seed, &mut random);
        let mut stream = connect(served.port);
        let _ = stream.write_all(&request);
        let _ = stream.shutdown(Shutdown::Write);
        let reply = read(stream);
        let shown = String::from_utf8_lossy(&request).into_owned();
        let known = [0, 200, 202, 400, 403, 404, 405, 413, 422, 431, 501, 505];
        assert!(known.contains(&reply.status), "{round}: {shown}: {reply:?}");
        // Headers are read up to the first empty line.
        let head = shown.split("\r\n\r\n").next().unwrap_or_default();
        if head.contains("\r\nHost: evil.example\r\n") || head.contains("\r\nOrigin: null\r\n") {
            assert!(![200, 202].contains(&reply.status), "{shown}: {reply:?}");
        }
    }
    assert_eq!(served.ask("GET /", &[], "").status, 200);
}
