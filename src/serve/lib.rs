//! The server of a page: HTTP/1.1 for one reader on the same machine, on one thread. It knows routes, heads, limits and
//! events, and takes what it serves from a [`Site`]; it knows nothing of specs, and it never reads a file.
//!
//! A request passes `admission` (who asks), `path` (for what), `route` (what that is) and gets a `reply`; `connection`
//! holds it to its times and sizes, `events` tells the page what happens.

mod admission;
mod connection;
mod events;
mod path;
mod reply;
mod route;
mod site;

pub use admission::Hosts;
pub use events::{Bell, Listener};
pub use site::{Answer, Piece, Site, Verdict};

use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::sync::Arc;

/// Where a server listens when nobody says, and how many ports after it are tried.
const PORT: u16 = 4180;
const MORE: u16 = 9;

/// A server that has its port.
#[derive(Debug)]
pub struct Server {
    listener: TcpListener,
    port: u16,
}

impl Server {
    /// A server on a port of 127.0.0.1: the given one, any for 0, otherwise 4180 or the next free of nine.
    ///
    /// # Errors
    /// When the port is taken, or all of them.
    pub fn bind(port: Option<u16>) -> io::Result<Server> {
        let bind = |port| TcpListener::bind(SocketAddr::from((Ipv4Addr::LOCALHOST, port)));
        let listener = match port {
            Some(port) => bind(port)?,
            None => {
                let next = || (PORT + 1..=PORT + MORE).find_map(|port| bind(port).ok());
                bind(PORT).or_else(|error| next().ok_or(error))?
            }
        };
        let port = listener.local_addr()?.port();
        Ok(Server { listener, port })
    }

    /// The port.
    pub fn port(&self) -> u16 {
        self.port
    }

    /// Serves `site` to those who name one of `hosts`, on this thread, until the process ends.
    ///
    /// # Errors
    /// When the system gives no runtime or the listener is lost.
    pub fn serve(self, hosts: Hosts, site: Arc<dyn Site>) -> io::Result<()> {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_io()
            .enable_time()
            .build()?;
        runtime.block_on(connection::accept(self.listener, hosts, site))
    }
}
