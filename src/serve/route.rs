//! From a request to its reply. Who asks is looked at first, then how much, then for what.

use std::sync::Arc;
use std::time::Duration;

use http_body_util::{BodyExt as _, LengthLimitError, Limited};
use hyper::body::{Body as _, Bytes, Incoming};
use hyper::http::request::Parts;
use hyper::{Method, Request, StatusCode};
use tokio::time::timeout;

use super::admission::Hosts;
use super::events::Events;
use super::path;
use super::reply::{self, Reply};
use super::site::{Piece, Site, Verdict};

/// The most bytes of the line and the heads of a request.
pub const HEAD: usize = 16 << 10;
/// The most bytes of a body.
const BODY: usize = 64 << 10;
/// How long a body may take.
const PATIENCE: Duration = Duration::from_secs(10);

/// The reply to a request.
pub async fn answer(request: Request<Incoming>, hosts: &Hosts, site: &Arc<dyn Site>) -> Reply {
    let (head, body) = request.into_parts();
    if !hosts.admit(&head) {
        return reply::refusal(StatusCode::FORBIDDEN);
    }
    if size(&head) > HEAD {
        return reply::refusal(StatusCode::REQUEST_HEADER_FIELDS_TOO_LARGE);
    }
    let Some(path) = path::plain(head.uri.path()) else {
        return reply::refusal(StatusCode::BAD_REQUEST);
    };
    match (&*path, &head.method) {
        ("/set", &Method::POST) => match bytes(body).await {
            Ok(bytes) => set(&bytes, site),
            Err(status) => reply::refusal(status),
        },
        ("/set", _) => reply::other_method("POST"),
        (_, &Method::GET) => {
            let found = found(&path, head.uri.query().unwrap_or_default(), site);
            found.unwrap_or_else(|| reply::refusal(StatusCode::NOT_FOUND))
        }
        ("/" | "/state.json" | "/events", _) => reply::other_method("GET"),
        (path, _) if path.starts_with("/files/") || path.starts_with("/assets/") => {
            reply::other_method("GET")
        }
        _ => reply::refusal(StatusCode::NOT_FOUND),
    }
}

/// About as many bytes as the head had on its way.
fn size(head: &Parts) -> usize {
    let line = head
        .uri
        .path_and_query()
        .map_or(0, |path| path.as_str().len());
    let fields = head.headers.iter();
    line + fields
        .map(|(name, value)| name.as_str().len() + value.len() + 4)
        .sum::<usize>()
}

/// What stands at a path.
fn found(path: &str, query: &str, site: &Arc<dyn Site>) -> Option<Reply> {
    let reply = match path {
        "/" => reply::page(Piece {
            media: "text/html; charset=utf-8",
            bytes: site.page(),
        }),
        "/state.json" => reply::piece(Piece {
            media: "application/json",
            bytes: site.state(),
        }),
        "/events" => reply::events(Events::of(site.listen())),
        _ => {
            let piece = if let Some(name) = path.strip_prefix("/assets/") {
                site.asset(name)
            } else {
                let name = path.strip_prefix("/files/")?;
                let of = |key| path::value(query, key);
                site.file(name, of("v").as_deref(), of("as").as_deref())
            };
            reply::piece(piece?)
        }
    };
    Some(reply)
}

fn set(body: &[u8], site: &Arc<dyn Site>) -> Reply {
    let answer = site.set(body);
    let status = match answer.verdict {
        Verdict::Taken => StatusCode::ACCEPTED,
        Verdict::Refused => StatusCode::UNPROCESSABLE_ENTITY,
        Verdict::Malformed => StatusCode::BAD_REQUEST,
    };
    reply::json(status, answer.json)
}

/// A body that is neither too long nor too slow.
async fn bytes(body: Incoming) -> Result<Bytes, StatusCode> {
    if body.size_hint().lower() > BODY as u64 {
        return Err(StatusCode::PAYLOAD_TOO_LARGE);
    }
    let whole = timeout(PATIENCE, Limited::new(body, BODY).collect()).await;
    match whole.map_err(|_| StatusCode::REQUEST_TIMEOUT)? {
        Ok(body) => Ok(body.to_bytes()),
        Err(error) if error.is::<LengthLimitError>() => Err(StatusCode::PAYLOAD_TOO_LARGE),
        Err(_) => Err(StatusCode::BAD_REQUEST),
    }
}
