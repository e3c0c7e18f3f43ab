//! Any bytes as a request to the server of the page: it must answer or hang up, and go on.
//!
//! `RUSTC_BOOTSTRAP=1 cargo fuzz run -s none --fuzz-dir tests/fuzz heads`
#![no_main]

use std::io::{Read as _, Write as _};
use std::net::{Shutdown, TcpStream};
use std::sync::{Arc, OnceLock};
use std::thread;

use fretwork::serve::{Answer, Bell, Hosts, Listener, Piece, Server, Site, Verdict};
use libfuzzer_sys::fuzz_target;

/// A site that shows nothing.
struct Nothing(Bell);

impl Site for Nothing {
    fn page(&self) -> Arc<[u8]> {
        Arc::default()
    }

    fn asset(&self, _: &str) -> Option<Piece> {
        None
    }

    fn state(&self) -> Arc<[u8]> {
        Arc::default()
    }

    fn file(&self, path: &str, _: Option<&str>, _: Option<&str>) -> Option<Piece> {
        assert!(path.split('/').all(|part| part != "..") && !path.contains(['\0', '\\']));
        None
    }

    fn set(&self, body: &[u8]) -> Answer {
        assert!(body.len() <= 64 << 10);
        let verdict = Verdict::Malformed;
        Answer { verdict, json: String::new() }
    }

    fn listen(&self) -> Listener {
        self.0.listen()
    }
}

fn port() -> u16 {
    static PORT: OnceLock<u16> = OnceLock::new();
    *PORT.get_or_init(|| {
        let server = Server::bind(Some(0)).expect("there is a free port");
        let port = server.port();
        // Short heads of the fuzzer's own are to be admitted.
        let hosts = Hosts::new(port, &["a".to_owned()]);
        thread::spawn(move || server.serve(hosts, Arc::new(Nothing(Bell::new(String::new())))));
        port
    })
}

fuzz_target!(|bytes: &[u8]| {
    let mut stream = TcpStream::connect(("127.0.0.1", port())).expect("the server goes on");
    let _ = stream.write_all(bytes);
    let _ = stream.shutdown(Shutdown::Write);
    // A stream of events has no end.
    let _ = stream.read(&mut [0; 64]);
});
