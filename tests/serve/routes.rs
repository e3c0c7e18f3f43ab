//! W2: what stands where.

use super::Served;

#[test]
fn what_is_there_is_served_as_what_it_is() {
    let served = Served::new();
    for (path, media, body) in [
        ("/", "text/html; charset=utf-8", "<!DOCTYPE html>page"),
        ("/state.json", "application/json", "{}"),
        (
            "/assets/page.js",
            "text/javascript; charset=utf-8",
            "script",
        ),
        ("/files/a%20b/%C3%BC%25.svg", "image/svg+xml", "<svg/>"),
        (
            "/files/a%20b/%c3%bc%25.svg?v=1&as=glb",
            "image/svg+xml",
            "<svg/>glb",
        ),
    ] {
        let reply = served.ask(&format!("GET {path}"), &[], "");
        let got = (reply.status, reply.head("content-type"), &*reply.body);
        assert_eq!(got, (200, Some(media), body), "{path}");
    }
    let page = served.ask("GET /?from=somewhere", &[], "");
    let policy = page.head("content-security-policy").unwrap();
    assert!(policy.contains("script-src 'self'"), "{policy}");
    assert!(!policy.contains("unsafe"), "{policy}");
}

#[test]
fn nothing_else_is() {
    let served = Served::new();
    for path in [
        "/index.html",
        "/state.json/",
        "/assets",
        "/assets/",
        "/assets/page.rs",
        "/files",
        "/files/",
        "/files/Cargo.toml",
        "/files/etc/passwd",
        "/files//etc/passwd",
        "/files/a%20b/%C3%BC%25.svg?v=2",
        "/Files/a",
        "//",
    ] {
        let status = served.ask(&format!("GET {path}"), &[], "").status;
        assert_eq!(status, 404, "{path}");
    }
    // A server knows no proxies and no options of all.
    let own = format!("GET http://127.0.0.1:{}/", served.port);
    assert_eq!(served.ask(&own, &[], "").status, 200);
}

#[test]
fn other_methods_are_refused() {
    let served = Served::new();
    for method in ["HEAD", "PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "BREW"] {
        for path in [
            "/",
            "/state.json",
            "/events",
            "/files/a",
            "/assets/page.js",
            "/set",
        ] {
            let reply = served.ask(&format!("{method} {path}"), &[], "");
            assert_eq!(reply.status, 405, "{method} {path}");
            let allowed = if path == "/set" { "post" } else { "get" };
            assert_eq!(reply.head("allow"), Some(allowed), "{method} {path}");
        }
    }
    assert_eq!(served.ask("GET /set", &[], "").status, 405);
    let ours = format!("Origin: http://127.0.0.1:{}", served.port);
    let json = "Content-Type: application/json";
    assert_eq!(served.ask("POST /", &[&ours, json], "yes").status, 405);
}

#[test]
fn a_path_that_leaves_its_folder_is_refused() {
    let served = Served::new();
    for path in [
        "/..",
        "/../",
        "/files/../../etc/passwd",
        "/files/..",
        "/files/%2e%2e/%2e%2e/etc/passwd",
        "/files/%2E./x",
        "/files/%252e%252e/x",
        "/files/%25252e%25252e/x",
        "/files/..%2fx",
        "/files/..%252fx",
        "/files/..%5cx",
        "/files/a%5cb",
        "/files/a%255cb",
        "/files/a%00",
        "/files/a%2500",
        "/files/%ff",
        "/files/%",
        "/files/%4",
    ] {
        let status = served.ask(&format!("GET {path}"), &[], "").status;
        assert_eq!(status, 400, "{path}");
    }
    let status = served.ask("GET /files/a\\..\\b", &[], "").status;
    assert_eq!(status, 400);
}

#[test]
fn values_are_taken_refused_or_none() {
    let served = Served::new();
    let ours = format!("Origin: http://localhost:{}", served.port);
    let heads = [&*ours, "Content-Type: application/json"];
    for (body, status) in [("yes", 202), ("no", 422), ("?", 400), ("", 400)] {
        let reply = served.ask("POST /set", &heads, body);
        let got = (reply.status, reply.head("content-type"), &*reply.body);
        let json = Some("application/json");
        assert_eq!(got, (status, json, "{\"said\":true}"), "{body}");
    }
}
