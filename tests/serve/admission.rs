//! W3: hosts, origins and the heads of every response.

use super::{Served, ask};

const JSON: &str = "Content-Type: application/json";

#[test]
fn only_the_names_of_this_machine_are_hosts() {
    let served = Served::new();
    let port = served.port;
    let status = |host: &str| served.ask("GET /", &[&format!("Host: {host}")], "").status;
    assert_eq!(status(&format!("127.0.0.1:{port}")), 200);
    assert_eq!(status(&format!("localhost:{port}")), 200);
    assert_eq!(status(&format!("LocalHost:{port}")), 200);
    for host in [
        "evil.example".to_string(),
        format!("evil.example:{port}"),
        "127.0.0.1".to_string(),
        "localhost".to_string(),
        format!("127.0.0.1:{}", port ^ 1),
        format!("127.0.0.1:{port}.evil.example"),
        format!("127.0.0.1:{port}:{port}"),
        format!("evil.example@127.0.0.1:{port}"),
        format!("[::1]:{port}"),
        String::new(),
    ] {
        assert_eq!(status(&host), 403, "{host}");
    }
    let own = format!("Host: 127.0.0.1:{port}");
    assert_eq!(
        served
            .ask("GET /", &[&own, "Host: evil.example"], "")
            .status,
        403
    );
    assert_eq!(served.ask("GET /", &[&own, &own], "").status, 403);
    let line = "GET http://evil.example/";
    assert_eq!(served.ask(line, &[&own], "").status, 403);
    let none = super::send(port, b"GET / HTTP/1.1\r\nConnection: close\r\n\r\n");
    assert!([400, 403].contains(&none.status), "{none:?}");
}

#[test]
fn only_our_own_pages_are_origins() {
    let served = Served::new();
    let port = served.port;
    let get = |origin: &str| {
        served
            .ask("GET /", &[&format!("Origin: {origin}")], "")
            .status
    };
    assert_eq!(get(&format!("http://127.0.0.1:{port}")), 200);
    assert_eq!(get(&format!("http://localhost:{port}")), 200);
    for origin in [
        "null".to_string(),
        String::new(),
        "http://evil.example".to_string(),
        "http://127.0.0.1".to_string(),
        format!("https://127.0.0.1:{port}"),
        format!("http://127.0.0.1:{port}.evil.example"),
        format!("http://127.0.0.1:{port}/"),
        format!("127.0.0.1:{port}"),
    ] {
        assert_eq!(get(&origin), 403, "{origin}");
    }
    let ours = format!("Origin: http://127.0.0.1:{port}");
    let two = served.ask("GET /", &[&ours, "Origin: http://evil.example"], "");
    assert_eq!(two.status, 403);
}

#[test]
fn values_need_an_origin_and_json() {
    let served = Served::new();
    let ours = format!("Origin: http://127.0.0.1:{}", served.port);
    let post = |heads: &[&str]| served.ask("POST /set", heads, "yes").status;
    assert_eq!(post(&[&ours, JSON]), 202);
    assert_eq!(
        post(&[&ours, "Content-Type: Application/JSON; charset=utf-8"]),
        202
    );
    for heads in [
        &[][..],
        &[&*ours],
        &[JSON],
        &["Origin: null", JSON],
        &[&ours, "Content-Type: text/plain"],
        &[&ours, "Content-Type: application/x-www-form-urlencoded"],
        &[&ours, "Content-Type: application/jsonp"],
        &[&ours, JSON, "Content-Type: text/plain"],
    ] {
        assert_eq!(post(heads), 403, "{heads:?}");
    }
    assert_eq!(served.site.bodies.lock().unwrap().len(), 2);
}

#[test]
fn a_wrong_host_is_refused_before_anything_else_is_looked_at() {
    let served = Served::new();
    let evil = "Host: evil.example";
    for line in ["GET /../x", "BREW /", "GET /none", "POST /set", "GET /%00"] {
        assert_eq!(served.ask(line, &[evil], "").status, 403, "{line}");
    }
    let long = format!("X: {}", "x".repeat(70_000));
    let status = served.ask("GET /", &[evil, &long], "").status;
    assert!([403, 431].contains(&status));
}

#[test]
fn a_host_can_be_allowed() {
    let served = Served::with(&["box.local", "tunnel.example:443"]);
    let status = |heads: &[&str]| ask(served.port, "GET /", heads, "").status;
    assert_eq!(status(&["Host: box.local"]), 200);
    assert_eq!(status(&[&format!("Host: box.local:{}", served.port)]), 200);
    assert_eq!(status(&["Host: tunnel.example:443"]), 200);
    let tunnel = "Origin: https://tunnel.example:443";
    assert_eq!(status(&["Host: tunnel.example:443", tunnel]), 200);
    for host in [
        "box.local:1",
        "tunnel.example",
        "tunnel.example:80",
        "a.box.local",
    ] {
        assert_eq!(status(&[&format!("Host: {host}")]), 403, "{host}");
    }
}

#[test]
fn every_response_keeps_others_out() {
    let served = Served::new();
    let ours = format!("Origin: http://127.0.0.1:{}", served.port);
    for (line, heads) in [
        ("GET /", &[][..]),
        ("GET /state.json", &[]),
        ("GET /assets/page.js", &[]),
        ("GET /files/a%20b/%C3%BC%25.svg", &[]),
        ("GET /none", &[]),
        ("GET /..", &[]),
        ("DELETE /", &[]),
        ("OPTIONS /set", &["Access-Control-Request-Method: POST"]),
        ("POST /set", &[]),
        ("POST /set", &[&*ours, JSON]),
        ("GET /", &["Host: evil.example"]),
    ] {
        let reply = served.ask(line, heads, "yes");
        let policy = reply.head("content-security-policy").unwrap();
        assert!(policy.contains("default-src 'none'"), "{line}: {policy}");
        assert!(
            policy.contains("frame-ancestors 'none'"),
            "{line}: {policy}"
        );
        for (name, value) in [
            ("x-content-type-options", "nosniff"),
            ("cross-origin-resource-policy", "same-origin"),
            ("cache-control", "no-store"),
        ] {
            assert_eq!(reply.head(name), Some(value), "{line}: {}", reply.heads);
        }
        assert!(!reply.heads.contains("access-control-"), "{}", reply.heads);
    }
}
