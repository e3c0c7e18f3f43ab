//! The command `fretwork`.

fn main() {}
