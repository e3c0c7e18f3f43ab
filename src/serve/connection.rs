//! Connections: how many, and how long they may take to say what they want. Whoever is turned away is told so.

use std::convert::Infallible;
use std::future::poll_fn;
use std::io;
use std::sync::Arc;
use std::time::Duration;

use hyper::StatusCode;
use hyper::server::conn::http1::Builder;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio::time::{sleep, timeout};

use super::admission::Hosts;
use super::reply;
use super::route::{self, HEAD};
use super::site::Site;

/// So many connections are served at the same time, and so many more are told that they are not.
const SERVED: usize = 64;
const TURNED_AWAY: usize = 256;
/// A head that takes longer is given up.
const PATIENCE: Duration = Duration::from_secs(10);
/// So long, and so many bytes, what a client still sends is read before the connection is closed: closed earlier, it would
/// not see the reply.
const FAREWELL: Duration = Duration::from_secs(1);
const REST: usize = 8 << 20;

/// Serves all who come.
///
/// # Errors
/// When the listener cannot be used.
pub async fn accept(
    listener: std::net::TcpListener,
    hosts: Hosts,
    site: Arc<dyn Site>,
) -> io::Result<()> {
    listener.set_nonblocking(true)?;
    let listener = TcpListener::from_std(listener)?;
    let hosts = Arc::new(hosts);
    let served = Arc::new(Semaphore::new(SERVED));
    let turned_away = Arc::new(Semaphore::new(TURNED_AWAY));
    loop {
        let Ok((stream, _)) = listener.accept().await else {
            // There are no more file descriptors, or the client has gone already.
            sleep(Duration::from_millis(20)).await;
            continue;
        };
        // Small events are not to wait for more of them.
        let _ = stream.set_nodelay(true);
        if let Ok(place) = served.clone().try_acquire_owned() {
            tokio::spawn(attend(stream, place, hosts.clone(), site.clone()));
        } else if let Ok(place) = turned_away.clone().try_acquire_owned() {
            tokio::spawn(turn_away(stream, place));
        }
    }
}

/// Serves one connection to its end.
async fn attend(
    stream: TcpStream,
    place: OwnedSemaphorePermit,
    hosts: Arc<Hosts>,
    site: Arc<dyn Site>,
) {
    let service = service_fn(move |request| {
        let (hosts, site) = (hosts.clone(), site.clone());
        Box::pin(async move { Ok::<_, Infallible>(route::answer(request, &hosts, &site).await) })
    });
    let mut connection = Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(PATIENCE)
        .max_buf_size(HEAD)
        .serve_connection(TokioIo::new(stream), service);
    let result = poll_fn(|context| connection.poll_without_shutdown(context)).await;
    let mut stream = connection.into_parts().io.into_inner();
    if result.is_err_and(|error| error.is_timeout()) {
        // Whoever has gone does not read it.
        let _ = stream
            .write_all(&reply::raw(StatusCode::REQUEST_TIMEOUT))
            .await;
    }
    part(stream).await;
    drop(place);
}

/// Tells a client that there are too many.
async fn turn_away(mut stream: TcpStream, place: OwnedSemaphorePermit) {
    let reply = reply::raw(StatusCode::SERVICE_UNAVAILABLE);
    // Whoever has gone does not read it.
    let _ = timeout(FAREWELL, stream.write_all(&reply)).await;
    part(stream).await;
    drop(place);
}

/// Closes a connection so that its last reply arrives.
async fn part(mut stream: TcpStream) {
    if stream.shutdown().await.is_err() {
        return;
    }
    let rest = async {
        let (mut buffer, mut read) = (vec![0; 1 << 14], 0);
        while read < REST {
            match stream.read(&mut buffer).await {
                Ok(count) if count > 0 => read += count,
                _ => break,
            }
        }
    };
    // A client that goes on talking is not waited for.
    let _ = timeout(FAREWELL, rest).await;
}
