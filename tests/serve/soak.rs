//! Many edits and requests: by hand, since it takes minutes. `cargo test --release -- --ignored soak`

use std::fs;
use std::io::Write as _;

use super::super::project::Project;
use super::watched::Watched;
use super::{ask, connect};

/// The memory of a process in kilobytes.
fn memory(id: u32) -> u64 {
    let status = fs::read_to_string(format!("/proc/{id}/status")).unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    line.unwrap()
        .trim()
        .trim_end_matches(" kB")
        .parse()
        .unwrap()
}

#[test]
#[ignore = "takes minutes"]
#[cfg(target_os = "linux")]
fn soak_of_ten_thousand_edits_and_requests_has_flat_memory() {
    let watched = Watched::new(Project::small());
    let id = watched.child.id();
    let mut levels = Vec::new();
    for round in 0..10_000_u64 {
        let before = watched.state()["build"].as_u64();
        if round % 2 == 0 {
            let radius = 5 + round % 97;
            let text = super::super::project::SPEC
                .replace("radius: 10", &format!("radius: {}.{round}", radius % 20));
            watched.project.write("specs/spec.yaml", text);
        } else {
            let spacing = 3.0 + (round % 5000) as f64 / 400.0;
            let body =
                format!(r#"{{"spec":"specs/spec.yaml","values":{{"spacing":"{spacing}"}}}}"#);
            assert_eq!(watched.set(&body).status, 202);
        }
        watched.until(|state| state["build"].as_u64() > before);
        assert_eq!(ask(watched.port, "GET /", &[], "").status, 200);
        let mut hung_up = connect(watched.port);
        hung_up.write_all(b"GET /events HTTP/1.1\r\nHost").unwrap();
        if round % 1000 == 999 {
            levels.push(memory(id));
            println!("{round}: {} kB", memory(id));
        }
    }
    let (early, late) = (levels[2], levels[levels.len() - 1]);
    assert!(late < early + early / 4, "{levels:?}");
}
