//! Responses, and the heads that all of them have: nothing is kept by anybody, nothing is guessed, and no other page may
//! hold, frame or read what comes from here.

use std::convert::Infallible;
use std::fmt::Write as _;

use http_body_util::combinators::UnsyncBoxBody;
use http_body_util::{BodyExt as _, Full};
use hyper::body::Bytes;
use hyper::header::{ALLOW, CONTENT_SECURITY_POLICY, CONTENT_TYPE, HeaderValue};
use hyper::{Response, StatusCode};

use super::events::Events;
use super::site::Piece;

/// The body of a response.
pub type Reply = Response<UnsyncBoxBody<Bytes, Infallible>>;

const TEXT: &str = "text/plain; charset=utf-8";
const JSON: &str = "application/json";

/// What the page may do: run and look like itself, show pictures, ask this server.
const PAGE: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; \
    connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// What everything else may do, when somebody opens it by itself: drawings have styles and pictures in them.
const PIECE: &str = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; \
    form-action 'none'; frame-ancestors 'none'";

const ALWAYS: [(&str, &str); 5] = [
    ("cache-control", "no-store"),
    ("x-content-type-options", "nosniff"),
    ("cross-origin-resource-policy", "same-origin"),
    ("cross-origin-opener-policy", "same-origin"),
    ("referrer-policy", "no-referrer"),
];

/// The page.
pub fn page(piece: Piece) -> Reply {
    let mut reply = self::piece(piece);
    let policy = HeaderValue::from_static(PAGE);
    reply.headers_mut().insert(CONTENT_SECURITY_POLICY, policy);
    reply
}

/// Bytes of some sort.
pub fn piece(piece: Piece) -> Reply {
    full(StatusCode::OK, piece.media, Bytes::from_owner(piece.bytes))
}

/// JSON with a status.
pub fn json(status: StatusCode, text: String) -> Reply {
    full(status, JSON, text.into())
}

/// Events without an end.
pub fn events(events: Events) -> Reply {
    dressed(StatusCode::OK, "text/event-stream", events.boxed_unsync())
}

/// A refusal.
pub fn refusal(status: StatusCode) -> Reply {
    full(status, TEXT, sentence(status).into())
}

/// A refusal of a method where another one is allowed.
pub fn other_method(allowed: &'static str) -> Reply {
    let mut reply = refusal(StatusCode::METHOD_NOT_ALLOWED);
    let allowed = HeaderValue::from_static(allowed);
    reply.headers_mut().insert(ALLOW, allowed);
    reply
}

/// A refusal as bytes, for a connection that is closed with it.
pub fn raw(status: StatusCode) -> Vec<u8> {
    let body = sentence(status);
    let mut text = format!("HTTP/1.1 {} {body}\r\n", status.as_u16());
    let length = body.len().to_string();
    let own = [
        ("content-type", TEXT),
        ("content-length", &length),
        ("connection", "close"),
        ("content-security-policy", PIECE),
    ];
    for (name, value) in own.into_iter().chain(ALWAYS) {
        // Writing to a String cannot fail.
        let _ = write!(text, "{name}: {value}\r\n");
    }
    format!("{text}\r\n{body}").into_bytes()
}

fn sentence(status: StatusCode) -> &'static str {
    status.canonical_reason().unwrap_or("refused")
}

fn full(status: StatusCode, media: &'static str, bytes: Bytes) -> Reply {
    dressed(status, media, Full::new(bytes).boxed_unsync())
}

fn dressed(
    status: StatusCode,
    media: &'static str,
    body: UnsyncBoxBody<Bytes, Infallible>,
) -> Reply {
    let mut reply = Response::new(body);
    *reply.status_mut() = status;
    let headers = reply.headers_mut();
    headers.insert(CONTENT_TYPE, HeaderValue::from_static(media));
    headers.insert(CONTENT_SECURITY_POLICY, HeaderValue::from_static(PIECE));
    for (name, value) in ALWAYS {
        headers.insert(name, HeaderValue::from_static(value));
    }
    reply
}
