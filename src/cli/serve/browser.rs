//! The browser of whoever sits at this machine.

use std::process::{Command, Stdio};
use std::thread;

use super::super::terminal;

/// The program that opens an address, and what it is told before it.
const OPENER: (&str, &[&str]) = if cfg!(target_os = "macos") {
    ("open", &[])
} else if cfg!(windows) {
    ("cmd", &["/C", "start", ""])
} else {
    ("xdg-open", &[])
};

/// Opens `address`; where that fails, says so.
pub fn open(address: &str) {
    let (program, first) = OPENER;
    let started = Command::new(program)
        .args(first)
        .arg(address)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn();
    let message = format!("cannot open a browser; the page is at {address}");
    let failed = move || terminal::note(&message);
    match started {
        Err(_) => failed(),
        Ok(mut child) => {
            // Some openers live as long as the browser does.
            thread::spawn(move || {
                if !child.wait().is_ok_and(|status| status.success()) {
                    failed();
                }
            });
        }
    }
}
