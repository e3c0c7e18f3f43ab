//! The command `fretwork`.

fn main() -> std::process::ExitCode {
    fretwork::cli::run(fretwork::VERSIONS)
}
