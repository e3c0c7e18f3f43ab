//! Who may ask: a page of another place must not read or change anything, though it runs in the same browser. A name that
//! leads here by a trick of the domain name system is not ours, and neither is a request that another page has made.

use hyper::Method;
use hyper::header::{CONTENT_TYPE, HOST, HeaderMap, HeaderName, ORIGIN};
use hyper::http::request::Parts;

/// The names under which a server is known.
#[derive(Clone, Debug)]
pub struct Hosts {
    own: Vec<String>,
    allowed: Vec<String>,
}

impl Hosts {
    /// Those of this machine with `port`, and `allowed` ones as `NAME` or `NAME:PORT`. One without a port may be asked for
    /// with `port` too.
    pub fn new(port: u16, allowed: &[String]) -> Hosts {
        let own = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{port}"));
        let with_port = |name: &String| match name.rsplit_once(':') {
            Some(_) => vec![name.clone()],
            None => vec![name.clone(), format!("{name}:{port}")],
        };
        Hosts {
            own: own.into(),
            allowed: allowed.iter().flat_map(with_port).collect(),
        }
    }

    /// Whether the request may be looked at.
    pub fn admit(&self, head: &Parts) -> bool {
        let Some(host) = only(&head.headers, &HOST) else {
            return false;
        };
        let mut named = head.uri.authority().into_iter().map(|host| host.as_str());
        if !self.has(host) || !named.all(|host| self.has(host)) {
            return false;
        }
        let has_origin = head.headers.contains_key(ORIGIN);
        let is_ours = only(&head.headers, &ORIGIN).is_some_and(|origin| self.is_origin(origin));
        if has_origin && !is_ours {
            return false;
        }
        head.method != Method::POST || (has_origin && is_json(&head.headers))
    }

    fn has(&self, host: &str) -> bool {
        let mut all = self.own.iter().chain(&self.allowed);
        all.any(|known| known.eq_ignore_ascii_case(host))
    }

    /// Whether pages of this origin are ours. A tunnel may be reached by `https`, this machine itself never is.
    fn is_origin(&self, origin: &str) -> bool {
        let is = |known: &String, host: &str| known.eq_ignore_ascii_case(host);
        match (
            origin.strip_prefix("http://"),
            origin.strip_prefix("https://"),
        ) {
            (Some(host), _) => self.has(host),
            (_, Some(host)) => self.allowed.iter().any(|known| is(known, host)),
            _ => false,
        }
    }
}

/// The value of a header that is given once, if it is text.
fn only<'a>(headers: &'a HeaderMap, name: &HeaderName) -> Option<&'a str> {
    let mut values = headers.get_all(name).iter();
    match (values.next(), values.next()) {
        (Some(value), None) => value.to_str().ok(),
        _ => None,
    }
}

fn is_json(headers: &HeaderMap) -> bool {
    let media = only(headers, &CONTENT_TYPE).map(|value| value.split(';').next().unwrap_or(value));
    media.is_some_and(|media| media.trim().eq_ignore_ascii_case("application/json"))
}
