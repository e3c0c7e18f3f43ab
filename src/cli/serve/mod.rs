//! `fretwork watch --serve`: builds at every change, and shows what comes of it on a page. The server has a thread of its own
//! and answers from what was published last; the thread of the command builds. Between them stands the `board`.

mod board;
mod browser;
mod feed;
mod live;
mod shown;
mod state;
mod wish;

use std::sync::Arc;
use std::sync::mpsc::channel;
use std::thread;

use super::arguments::Watch;
use super::build;
use super::terminal::{self, Failure};
use board::Board;
use fretwork_engine::Versions;
use fretwork_serve::{Hosts, Server};
use live::{Live, Wake};

/// Builds and serves until the process is ended.
pub fn run(arguments: &Watch, versions: Versions) -> Result<(), Failure> {
    let session = build::open(&arguments.build, versions)?;
    let server = Server::bind(arguments.port).map_err(|e| taken(arguments.port, &e))?;
    let hosts = Hosts::new(server.port(), &arguments.hosts);
    let address = format!("http://127.0.0.1:{}/", server.port());
    let (sender, wakes) = channel();
    let waker = sender.clone();
    let board = Arc::new(Board::new(move || {
        // The receiver lives as long as the process.
        let _ = waker.send(Wake::Wish);
    }));
    let site = board.clone();
    thread::Builder::new()
        .spawn(move || {
            if let Err(error) = server.serve(hosts, site) {
                terminal::note(&format!("the page is served no longer: {error}"));
            }
        })
        .map_err(|e| Failure::usage(format!("cannot serve the page: {e}")))?;
    terminal::print(&format!("serving {address}\n"))?;
    if arguments.open {
        browser::open(&address);
    }
    Live::new(session, arguments, versions, board).run(sender, &wakes)
}

fn taken(port: Option<u16>, error: &std::io::Error) -> Failure {
    match port {
        Some(port) => Failure::usage(format!("cannot serve on port {port}: {error}")),
        None => Failure::usage(format!(
            "cannot serve the page: {error}; name a free port with `--port`, or any with `--port 0`"
        )),
    }
}
