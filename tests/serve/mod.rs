//! The server of the page against raw sockets: who may ask, for what, how much and how long; and the page of a project that
//! is watched.

mod admission;
mod events;
mod heads;
mod limits;
mod routes;
mod soak;
mod values;
mod watched;

use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

use fretwork::serve::{Answer, Bell, Hosts, Listener, Piece, Server, Site, Verdict};

/// A site that shows next to nothing, and what it was sent.
struct Stub {
    bell: Bell,
    bodies: Mutex<Vec<Vec<u8>>>,
}

impl Site for Stub {
    fn page(&self) -> Arc<[u8]> {
        b"<!DOCTYPE html>page".as_slice().into()
    }

    fn asset(&self, name: &str) -> Option<Piece> {
        (name == "page.js").then(|| Piece {
            media: "text/javascript; charset=utf-8",
            bytes: b"script".as_slice().into(),
        })
    }

    fn state(&self) -> Arc<[u8]> {
        b"{}".as_slice().into()
    }

    fn file(&self, path: &str, digest: Option<&str>, view: Option<&str>) -> Option<Piece> {
        let is_known = path == "a b/ü%.svg" && digest.is_none_or(|digest| digest == "1");
        is_known.then(|| Piece {
            media: "image/svg+xml",
            bytes: format!("<svg/>{}", view.unwrap_or_default())
                .into_bytes()
                .into(),
        })
    }

    fn set(&self, body: &[u8]) -> Answer {
        self.bodies.lock().unwrap().push(body.to_vec());
        let verdict = match body {
            b"yes" => Verdict::Taken,
            b"no" => Verdict::Refused,
            _ => Verdict::Malformed,
        };
        let json = "{\"said\":true}".into();
        Answer { verdict, json }
    }

    fn listen(&self) -> Listener {
        self.bell.listen()
    }
}

/// A server of a [`Stub`] on a port of its own, which lives as long as the process.
struct Served {
    port: u16,
    site: Arc<Stub>,
}

impl Served {
    fn new() -> Served {
        Served::with(&[])
    }

    fn with(allowed: &[&str]) -> Served {
        let server = Server::bind(Some(0)).unwrap();
        let port = server.port();
        let site = Arc::new(Stub {
            bell: Bell::new("{\"build\":1,\"ok\":true}".into()),
            bodies: Mutex::default(),
        });
        let allowed: Vec<String> = allowed.iter().map(ToString::to_string).collect();
        let (hosts, shown) = (Hosts::new(port, &allowed), site.clone());
        thread::spawn(move || server.serve(hosts, shown));
        Served { port, site }
    }

    fn ask(&self, line: &str, heads: &[&str], body: &str) -> Reply {
        ask(self.port, line, heads, body)
    }
}

/// What came back.
#[derive(Debug)]
struct Reply {
    status: u16,
    heads: String,
    body: String,
}

impl Reply {
    fn of(text: &str) -> Reply {
        let (heads, body) = text.split_once("\r\n\r\n").unwrap_or((text, ""));
        let status = heads.split(' ').nth(1).and_then(|word| word.parse().ok());
        Reply {
            status: status.unwrap_or(0),
            heads: heads.to_ascii_lowercase(),
            body: body.to_owned(),
        }
    }

    /// The value of a head, by its name in lower case.
    fn head(&self, name: &str) -> Option<&str> {
        let mut lines = self.heads.lines().filter_map(|line| line.split_once(": "));
        lines.find(|(key, _)| *key == name).map(|(_, value)| value)
    }
}

fn connect(port: u16) -> TcpStream {
    let stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    let patience = Some(Duration::from_secs(30));
    stream.set_read_timeout(patience).unwrap();
    stream.set_write_timeout(patience).unwrap();
    stream
}

/// Sends a request as it stands and reads until the server closes the connection.
fn send(port: u16, request: &[u8]) -> Reply {
    let mut stream = connect(port);
    // Whoever is turned away early does not read it all.
    let _ = stream.write_all(request);
    read(stream)
}

fn read(mut stream: TcpStream) -> Reply {
    let mut bytes = Vec::new();
    // What came before the connection broke counts.
    let _ = stream.read_to_end(&mut bytes);
    Reply::of(&String::from_utf8_lossy(&bytes))
}

/// Sends a request with a right host, unless the heads have one, that ends the connection.
fn ask(port: u16, line: &str, heads: &[&str], body: &str) -> Reply {
    let mut request = format!("{line} HTTP/1.1\r\n");
    if !heads
        .iter()
        .any(|head| head.to_ascii_lowercase().starts_with("host:"))
    {
        request += &format!("Host: 127.0.0.1:{port}\r\n");
    }
    for head in heads {
        request += &format!("{head}\r\n");
    }
    if !body.is_empty() {
        request += &format!("Content-Length: {}\r\n", body.len());
    }
    request += &format!("Connection: close\r\n\r\n{body}");
    send(port, request.as_bytes())
}
