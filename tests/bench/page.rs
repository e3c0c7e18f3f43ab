//! The page of all shipped specs: how long until it is served and, where there is a browser, drawn (it is to take 1.5 s); how
//! long after a save, and after a control, the page is told of the build (the build and 100 ms).

use std::cell::LazyCell;
use std::fs;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::rc::Rc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::super::Bench;

/// A page of a copy of the shipped specs.
struct Page {
    folder: tempfile::TempDir,
    child: Child,
    port: u16,
    rounds: AtomicU64,
}

impl Page {
    fn new() -> Page {
        let folder = tempfile::tempdir().expect("a folder can be made");
        fs::write(folder.path().join("fretwork.toml"), "").expect("the folder is writable");
        let specs = Path::new(env!("CARGO_MANIFEST_DIR")).join("specs");
        super::build::copy(&specs, &folder.path().join("specs"));
        let mut child = Command::new(env!("CARGO_BIN_EXE_fretwork"))
            .args(["watch", "--serve", "--port", "0"])
            .current_dir(folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("it starts");
        let mut lines = BufReader::new(child.stdout.take().expect("it is a pipe")).lines();
        let mut line = || {
            lines
                .next()
                .and_then(Result::ok)
                .expect("it says something")
        };
        let address = line();
        let port = address.trim_end_matches('/').rsplit(':').next();
        let port = port.and_then(|port| port.parse().ok()).expect("a port");
        // The first build ends with a line about what was written.
        line();
        // Whatever else it says is read by nobody.
        std::thread::spawn(move || lines.for_each(drop));
        Page {
            folder,
            child,
            port,
            rounds: AtomicU64::new(0),
        }
    }

    fn ask(&self, head: &str, body: &str) -> TcpStream {
        let port = self.port;
        let mut stream = TcpStream::connect(("127.0.0.1", port)).expect("it listens");
        let request = format!(
            "{head} HTTP/1.1\r\nHost: localhost:{port}\r\nOrigin: http://localhost:{port}\r\n\
             Content-Type: application/json\r\nContent-Length: {}\r\n\
             Connection: close\r\n\r\n{body}",
            body.len()
        );
        stream.write_all(request.as_bytes()).expect("it listens");
        stream
    }

    fn get(&self, path: &str) -> String {
        let mut text = String::new();
        let mut stream = self.ask(&format!("GET {path}"), "");
        stream.read_to_string(&mut text).expect("it answers");
        text
    }

    /// What is told of the next build, after `change`.
    fn next(&self, change: impl FnOnce(u64)) -> String {
        let events = BufReader::new(self.ask("GET /events", "")).lines();
        let mut builds = events
            .map_while(Result::ok)
            .filter(|line| line.starts_with("data: {\"build\""));
        let before = builds.next();
        change(self.rounds.fetch_add(1, Ordering::Relaxed));
        let mut after = builds.skip_while(|line| Some(line) == before.as_ref());
        after.next().unwrap_or_default();
        let state = self.get("/state.json");
        let seconds = state.split("\"seconds\":").nth(1).unwrap_or_default();
        let seconds = seconds.split([',', '}']).next().unwrap_or_default();
        format!("of which the build {seconds} s")
    }

    fn edit(&self, round: u64) {
        let path = self.folder.path().join("specs/jigsaw.yaml");
        let text = fs::read_to_string(&path).expect("the spec is there");
        let seed = text.lines().find(|line| line.starts_with("seed:"));
        let seed = seed.expect("the jigsaw has a seed");
        let text = text.replace(seed, &format!("seed: {}", 1000 + round));
        fs::write(&path, text).expect("the folder is writable");
    }

    fn set(&self, round: u64) {
        let columns = 4 + round % 20;
        let body = format!(r#"{{"spec":"specs/jigsaw.yaml","values":{{"columns":"{columns}"}}}}"#);
        let mut answer = String::new();
        let mut stream = self.ask("POST /set", &body);
        stream.read_to_string(&mut answer).expect("it answers");
    }

    /// Milliseconds until a browser has drawn what is to be seen at first.
    fn drawn(&self) -> String {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let output = Command::new("node")
            .arg(root.join("tests/browser/page.mjs"))
            .arg("measure")
            .arg(root.join("target/browser/node_modules"))
            .arg("/usr/bin/chromium")
            .arg(format!("http://localhost:{}/", self.port))
            .output();
        match output {
            Ok(output) if output.status.success() => {
                let ms = String::from_utf8_lossy(&output.stdout).trim().to_owned();
                format!("drawn in {ms} ms after the browser has started")
            }
            _ => "no browser".into(),
        }
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Runs the benchmarks of this file, all on one page.
pub fn run(bench: &Bench) {
    let page = LazyCell::new(|| Rc::new(Page::new()));
    let prepare = || Rc::clone(&page);
    bench.run("page/served", prepare, |page| {
        format!("{} bytes", page.get("/").len())
    });
    bench.run("page/drawn", prepare, |page| page.drawn());
    bench.run("page/from a save to its event", prepare, |page| {
        page.next(|round| page.edit(round))
    });
    bench.run("page/from a control to its event", prepare, |page| {
        page.next(|round| page.set(round))
    });
}
