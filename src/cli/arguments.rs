//! The command line as types.

use std::path::PathBuf;

use super::windows;
use clap::{Args, Parser, Subcommand, ValueEnum};
use fretwork_engine::{Cutting, EngineChoice, Window};

/// Compiles specs in YAML into files that can be fabricated.
#[derive(Debug, Parser)]
#[command(name = "fretwork", version, about, disable_help_subcommand = true)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Write the artifacts of specs
    Build(Build),
    /// Parse, resolve and type-check specs without building them
    Check(Check),
    /// Build, and build again whenever a file changes
    Watch(Watch),
    /// Write a page that shows the artifacts, the diagnostics and the graph
    Report(Report),
    /// Say what a change does to the artifacts: of a revision of git, and another one or the work tree
    Diff(Diff),
    /// Say where files come from, and whether the specs still give them
    Origin(Origin),
    /// Print the graph of a spec
    Graph(Graph),
    /// Say why a node was evaluated or not, and what it depends on
    Explain(Explain),
    /// Print the measures of one value, in the spec's units
    Inspect(Inspect),
    /// Print the parameters of a spec
    Params(Params),
    /// Print the JSON Schema of specs, or the language reference
    Schema(Schema),
    /// Make a folder with a small project that builds
    Init(Init),
    /// Look after the cache
    Cache(Cache),
    /// Print a completion script for a shell
    Completions(Completions),
}

/// How results are printed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// For people.
    #[default]
    Human,
    /// One JSON value.
    Json,
}

/// How arrangements are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Engine {
    /// What is repeated is drawn once.
    #[default]
    Auto,
    /// Cell by cell.
    General,
}

impl From<Engine> for EngineChoice {
    fn from(engine: Engine) -> EngineChoice {
        match engine {
            Engine::Auto => EngineChoice::Auto,
            Engine::General => EngineChoice::General,
        }
    }
}

/// What the commands that evaluate have in common.
#[derive(Clone, Debug, Args)]
pub struct Evaluation {
    /// Give a parameter a value
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = name_and_value)]
    pub sets: Vec<(String, String)>,
    /// Threads to use; all cores when not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// Allow a build so many times as much work and memory as by default
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = factor)]
    pub budget: f64,
    /// How to draw arrangements: what is repeated once and copied where that is the same, or all cell by cell
    #[arg(long, value_enum, default_value_t)]
    pub engine: Engine,
    /// Folder of the cache [default: .fretwork beside the project's root marker]
    #[arg(long, value_name = "DIR")]
    pub cache_dir: Option<PathBuf>,
    /// Neither read nor write the cache
    #[arg(long)]
    pub no_cache: bool,
}

fn factor(text: &str) -> Result<f64, String> {
    let factor = text.parse().ok();
    let factor = factor.filter(|factor| (0.001..=1000.0).contains(factor));
    factor.ok_or_else(|| "expected a number from 0.001 to 1000".to_string())
}

fn place(text: &str) -> Result<[f64; 2], String> {
    let number = |part: &str| part.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    let place = text
        .split_once(',')
        .and_then(|(x, y)| Some([number(x)?, number(y)?]));
    place.ok_or_else(|| "a place is two numbers, as in `--at 735000,4048500`".to_string())
}

fn host(text: &str) -> Result<String, String> {
    let (name, port) = match text.rsplit_once(':') {
        Some((name, port)) => (name, port.parse::<u16>().is_ok()),
        None => (text, true),
    };
    let is_part = |c: char| c.is_ascii_alphanumeric() || "-._".contains(c);
    match port && !name.is_empty() && name.chars().all(is_part) {
        true => Ok(text.to_ascii_lowercase()),
        false => Err("expected NAME or NAME:PORT, as in `--allow-host box.local:8080`".to_string()),
    }
}

fn name_and_value(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() => {
            Ok((name.trim().to_string(), value.to_string()))
        }
        _ => Err("expected NAME=VALUE".to_string()),
    }
}

/// `build`.
#[derive(Clone, Debug, Args)]
pub struct Build {
    /// Specs, or folders of specs; every specs/**/*.yaml of the project when none is given
    #[arg(value_name = "SPEC")]
    pub specs: Vec<PathBuf>,
    /// Folder to write to, a folder below it for every spec; with one SPEC its files stand in DIR itself [default: out beside
    /// the project's root marker]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Build only this artifact, or the artifacts that use this node
    #[arg(long, value_name = "ARTIFACT|NODE")]
    pub only: Vec<String>,
    /// Build what drawings and maps show in this part of the plane, in the spec's units, into a file of its own
    #[arg(long = "window", value_name = "X0,Y0,X1,Y1", value_parser = windows::window, allow_hyphen_values = true,
        conflicts_with_all = ["locked", "lock", "prune"])]
    pub windows: Vec<Cutting>,
    /// Build this tile of the map's `tiles`, or those of ranges (`3/0-3/*`) that meet the page
    #[arg(long = "tile", value_name = "Z/X/Y", value_parser = windows::tiles, conflicts_with_all = ["locked", "lock", "prune"])]
    pub tiles: Vec<Cutting>,
    /// How to evaluate.
    #[command(flatten)]
    pub evaluation: Evaluation,
    /// How to print the result
    #[arg(long, value_enum, default_value_t)]
    pub format: DiagnosticFormat,
    /// Write nothing, and fail when the artifacts are not those of fretwork.lock, or when one on disk is not what the
    /// spec gives. Without fretwork.lock all is computed anew
    #[arg(long, conflicts_with = "overwrite")]
    pub locked: bool,
    /// Write the digests of all artifacts to fretwork.lock beside the project's root marker
    #[arg(long, conflicts_with_all = ["only", "locked", "sets"])]
    pub lock: bool,
    /// Remove files that a build has written and that the specs no longer name
    #[arg(long, conflicts_with_all = ["only", "locked"])]
    pub prune: bool,
    /// Replace files in the place of artifacts that no build has written
    #[arg(long)]
    pub overwrite: bool,
    /// Treat these as errors
    #[arg(long, value_enum, value_name = "WHAT")]
    pub deny: Option<Deny>,
    /// Write a trace of the build in Chrome's trace event format
    #[arg(long, value_name = "FILE")]
    pub timings: Option<PathBuf>,
}

/// `watch`.
#[derive(Clone, Debug, Args)]
pub struct Watch {
    /// What to build.
    #[command(flatten)]
    pub build: Build,
    /// Show the artifacts, the diagnostics and the graph on a page that follows every build, for a browser on this machine
    #[arg(long)]
    pub serve: bool,
    /// The port of the page, 0 for any [default: 4180, or the next free of nine]
    #[arg(long, value_name = "N", requires = "serve")]
    pub port: Option<u16>,
    /// Open the page in the browser
    #[arg(long, requires = "serve")]
    pub open: bool,
    /// Serve the page under another name too, as for a tunnel or a container; may be given several times
    #[arg(long = "allow-host", value_name = "NAME[:PORT]", value_parser = host, requires = "serve")]
    pub hosts: Vec<String>,
}

/// How diagnostics are printed. `github` and `sarif` go to standard output, and the text for people to standard error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum DiagnosticFormat {
    /// For people.
    #[default]
    Human,
    /// As JSON.
    Json,
    /// As workflow commands of GitHub, with a summary of the job.
    Github,
    /// As a SARIF log.
    Sarif,
}

/// What `--deny` turns into errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Deny {
    /// Warnings.
    Warnings,
}

/// `check`.
#[derive(Clone, Debug, Args)]
pub struct Check {
    /// Specs, or folders of specs; every specs/**/*.yaml of the project when none is given
    #[arg(value_name = "SPEC")]
    pub specs: Vec<PathBuf>,
    /// Give a parameter a value
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = name_and_value)]
    pub sets: Vec<(String, String)>,
    /// How to print the result
    #[arg(long, value_enum, default_value_t)]
    pub format: DiagnosticFormat,
    /// Treat these as errors
    #[arg(long, value_enum, value_name = "WHAT")]
    pub deny: Option<Deny>,
}

/// `report`.
#[derive(Clone, Debug, Args)]
pub struct Report {
    /// Specs, or folders of specs; every specs/**/*.yaml of the project when none is given
    #[arg(value_name = "SPEC")]
    pub specs: Vec<PathBuf>,
    /// The file [default: out/report.html beside the project's root marker]
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// How to evaluate.
    #[command(flatten)]
    pub evaluation: Evaluation,
    /// Leave times out, so that the same specs give the same bytes
    #[arg(long)]
    pub stable: bool,
    /// Show what differs from this revision of git
    #[arg(long, value_name = "REV")]
    pub against: Option<String>,
}

/// `diff`.
#[derive(Clone, Debug, Args)]
pub struct Diff {
    /// The revision of git before: a branch, a tag, a commit
    #[arg(value_name = "REV")]
    pub before: String,
    /// The revision after; the work tree when none is given
    #[arg(value_name = "REV")]
    pub after: Option<String>,
    /// Compare only this spec, or those of this folder
    #[arg(long = "spec", value_name = "SPEC")]
    pub specs: Vec<PathBuf>,
    /// Compare only this artifact, or the artifacts that use this node
    #[arg(long, value_name = "ARTIFACT|NODE")]
    pub only: Vec<String>,
    /// Folder to write pictures of what differs to
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// How to evaluate.
    #[command(flatten)]
    pub evaluation: Evaluation,
    /// How to print the result
    #[arg(long, value_enum, default_value_t)]
    pub format: DiffFormat,
    /// Exit with 3 if an artifact is changed, added or removed
    #[arg(long)]
    pub exit_code: bool,
}

/// How a comparison is printed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum DiffFormat {
    /// For people.
    #[default]
    Human,
    /// As JSON.
    Json,
    /// As workflow commands of GitHub, with a summary of the job.
    Github,
}

/// `origin`.
#[derive(Clone, Debug, Args)]
pub struct Origin {
    /// Files that builds have written
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<PathBuf>,
    /// How to evaluate.
    #[command(flatten)]
    pub evaluation: Evaluation,
    /// How to print the result
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// `graph`.
#[derive(Clone, Debug, Args)]
pub struct Graph {
    /// The spec
    pub spec: PathBuf,
    /// Give a parameter a value
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = name_and_value)]
    pub sets: Vec<(String, String)>,
    /// The text format
    #[arg(long, value_enum, default_value_t)]
    pub format: GraphFormat,
}

/// Text formats of graphs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum GraphFormat {
    /// Graphviz.
    #[default]
    Dot,
    /// Mermaid flowchart.
    Mermaid,
    /// JSON.
    Json,
}

/// `explain`.
#[derive(Clone, Debug, Args)]
pub struct Explain {
    /// The spec
    pub spec: PathBuf,
    /// A node, as `name` or `section.name`
    pub node: String,
    /// Give a parameter a value
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = name_and_value)]
    pub sets: Vec<(String, String)>,
    /// Folder of the cache [default: .fretwork beside the project's root marker]
    #[arg(long, value_name = "DIR")]
    pub cache_dir: Option<PathBuf>,
    /// How to print the result
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// `inspect`.
#[derive(Clone, Debug, Args)]
pub struct Inspect {
    /// The spec
    pub spec: PathBuf,
    /// A node, as `name` or `section.name`
    pub node: String,
    /// The region to apply an arrangement to [default: that of the node's artifact]
    #[arg(long, value_name = "REGION")]
    pub region: Option<String>,
    /// Print the value of a field, or the face and the nearest curve of an arrangement, at a place; may be given several
    /// times
    #[arg(long, value_name = "X,Y", value_parser = place, allow_hyphen_values = true)]
    pub at: Vec<[f64; 2]>,
    /// Measure only what lies in this part of the plane
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = windows::part, allow_hyphen_values = true)]
    pub window: Option<Window>,
    /// How to evaluate.
    #[command(flatten)]
    pub evaluation: Evaluation,
    /// How to print the result
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// `params`.
#[derive(Clone, Debug, Args)]
pub struct Params {
    /// The spec
    pub spec: PathBuf,
    /// Give a parameter a value
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = name_and_value)]
    pub sets: Vec<(String, String)>,
    /// How to print the result
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// `schema`.
#[derive(Clone, Debug, Args)]
pub struct Schema {
    /// Print the reference page in Markdown instead
    #[arg(long, conflicts_with = "functions")]
    pub reference: bool,
    /// Print the functions of scripts in Markdown instead
    #[arg(long)]
    pub functions: bool,
}

/// `init`.
#[derive(Clone, Debug, Args)]
pub struct Init {
    /// The folder; it is made when it does not exist, and must be empty otherwise
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// Add a workflow for this service, which builds the specs and shows what is wrong with them
    #[arg(long, value_enum, value_name = "SERVICE")]
    pub ci: Option<Ci>,
    /// What the project begins with, instead of a drawing for a coaster
    #[arg(long, value_enum, value_name = "KIND")]
    pub template: Option<Template>,
}

/// Specs to start from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Template {
    /// A lattice around a turned body, for a printer.
    Print,
    /// A sign in one piece, for a laser cutter.
    Laser,
    /// A seamless tile that a script draws.
    Texture,
    /// A front of windows.
    Facade,
    /// A cuff from a drawing, in any length.
    Band,
}

/// Where builds run at every push.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Ci {
    /// GitHub Actions.
    Github,
}

/// `cache`.
#[derive(Clone, Debug, Args)]
pub struct Cache {
    /// What to do with it.
    #[command(subcommand)]
    pub action: CacheAction,
    /// Folder of the cache [default: .fretwork beside the project's root marker]
    #[arg(long, value_name = "DIR", global = true)]
    pub cache_dir: Option<PathBuf>,
}

/// What `cache` does.
#[derive(Clone, Copy, Debug, Subcommand)]
pub enum CacheAction {
    /// Print how much it holds
    Size,
    /// Read all of it and remove what is damaged
    Verify,
    /// Remove what was used least recently
    Gc {
        /// Megabytes to keep; builds keep the cache at FRETWORK_CACHE_SIZE by themselves (2GB when that is not set)
        #[arg(long, value_name = "MB", default_value_t = 1024)]
        keep: u64,
    },
}

/// `completions`.
#[derive(Clone, Copy, Debug, Args)]
pub struct Completions {
    /// The shell
    pub shell: clap_complete::Shell,
}
