//! What runs again after an edit: the names of the executed queries, and the nodes whose stages
//! ran. Everything happens in memory; what two processes share is tested with a store that two
//! compilers use.

mod facades;
mod maps;
mod shells;

use std::sync::{Arc, Mutex};

use expect_test::{Expect, expect};

use super::cache::{Cache, Versions};
use super::compile::{Compiler, Progress, Request};
use super::report::Report;
use super::settings::Settings;
use super::world::{MemoryWorld, World};
use fretwork_action::ReadError;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::progress::Steps;
use fretwork_store::LocalStore;

/// Files that change while a compiler holds them.
#[derive(Default)]
struct Files(Mutex<MemoryWorld>);

impl World for Files {
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        self.0.lock().unwrap().read(path)
    }

    fn names(&self, folder: &str) -> Vec<String> {
        self.0.lock().unwrap().names(folder)
    }
}

impl Files {
    fn write(&self, path: &str, text: &str) {
        self.0
            .lock()
            .unwrap()
            .files
            .insert(path.to_string(), text.as_bytes().to_vec());
    }

    fn remove(&self, path: &str) {
        self.0.lock().unwrap().files.remove(path);
    }
}

struct Silent;

impl Progress for Silent {
    fn total(&self, _: usize) {}
    fn started(&self, _: &str, _: &Arc<Steps>) {}
    fn finished(&self, _: &str) {}
}

/// A compiler, its files, and the folder of its store, if it has one.
struct Bench {
    files: Arc<Files>,
    compiler: Compiler,
}

const SPEC: &str = "specs/spec.yaml";

impl Bench {
    fn new(spec: &str) -> Bench {
        let files = Arc::new(Files::default());
        files.write(SPEC, spec);
        files.write("specs/zig.svg", ZIG);
        files.write("specs/blob.svg", BLOB);
        files.write("specs/m.star", MAPPERS);
        files.write("specs/lib.star", LIBRARY);
        Bench {
            compiler: Compiler::new(files.clone(), None, true),
            files,
        }
    }

    /// The same files for another process, which uses `store`.
    fn process(&self, store: LocalStore) -> Bench {
        Bench {
            files: self.files.clone(),
            compiler: Compiler::new(
                self.files.clone(),
                Some(Cache {
                    store,
                    versions: Versions::default(),
                }),
                true,
            ),
        }
    }

    fn report(&self, sets: &[(&str, &str)]) -> Report {
        self.compiler.build(&Request {
            specs: vec![SPEC.to_string()],
            settings: Settings::new(sets.iter().copied()),
            only: Vec::new(),
            threads: 1,
            progress: &Silent,
        })
    }

    /// Builds without errors.
    #[track_caller]
    fn build(&self, sets: &[(&str, &str)]) -> Report {
        let report = self.report(sets);
        // That a parameter is unused is told, but is no matter here.
        let mut diagnostics = report.diagnostics.clone();
        diagnostics.retain(|d| !d.message.starts_with("no expression uses the parameter"));
        assert_eq!(diagnostics, []);
        report
    }

    /// Writes a file and tells the compiler.
    fn edit(&mut self, path: &str, text: &str) {
        self.files.write(path, text);
        self.compiler.refresh();
    }
}

/// The queries in the order in which they first ran, with their numbers, and the nodes whose stages
/// ran.
fn summary(compiler: &Compiler, report: &Report) -> String {
    let mut counts: Vec<(String, usize)> = Vec::new();
    for name in compiler.database.take_executed() {
        match counts.iter_mut().find(|(n, _)| *n == name) {
            Some((_, count)) => *count += 1,
            None => counts.push((name, 1)),
        }
    }
    let mut lines: Vec<String> = counts
        .into_iter()
        .map(|(name, count)| {
            if count == 1 {
                name
            } else {
                format!("{name} {count}")
            }
        })
        .collect();
    lines.extend(
        evaluated(report)
            .into_iter()
            .map(|node| format!("-> {node}")),
    );
    lines.join("\n")
}

fn evaluated(report: &Report) -> Vec<String> {
    report
        .nodes
        .iter()
        .filter(|n| n.was_evaluated())
        .map(|n| format!("{}.{}", n.section, n.name))
        .collect()
}

fn digests(report: &Report) -> Vec<(String, String)> {
    report
        .artifacts
        .iter()
        .map(|a| (a.path.clone(), a.digest.hex()))
        .collect()
}

/// Builds `before`, then `after` in the same compiler, and compares what ran for it. The artifacts
/// are those that a new compiler gives.
#[track_caller]
fn check_edit(before: &str, after: &str, expect: Expect) {
    let mut bench = Bench::new(before);
    bench.build(&[]);
    bench.compiler.database.take_executed();
    bench.edit(SPEC, after);
    let report = bench.build(&[]);
    expect.assert_eq(&summary(&bench.compiler, &report));
    assert_eq!(digests(&report), digests(&Bench::new(after).build(&[])));
}

const ZIG: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 10 4'><path d='M0 2 L3 0 L7 4 L10 2' fill='none' stroke='black'/></svg>";
const BLOB: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 4 4'><path id='blob' d='M0 0 H4 V4 H0 Z'/></svg>";
const MAPPERS: &str = "load('lib.star', 'outline')

def hatch(gap):
    def mapper(face):
        return outline(face)
    return mapper

def jitter():
    def mapper(face):
        return contour(face)
    return mapper

def overview(cells):
    return map_to_faces(outline, cells)
";
const LIBRARY: &str = "def outline(face):\n    return contour(face)\n";

const SMALL: &str = r#"fretwork: 1
params: { size: 40, gap: 5 }
regions:
  page: { rectangle: { width: "${size}", height: 40 } }
  hole: { circle: { radius: 8, at: [20, 20] } }
  plate: { difference: [page, hole] }
partitions:
  rows: { stripes: { spacing: "${gap}" } }
artifacts:
  plate.svg: { from: plate }
  rows.svg: { from: rows, region: page }
"#;

#[test]
fn a_comment_runs_the_parse_alone() {
    check_edit(
        SMALL,
        &SMALL.replace("regions:", "# A comment.\n\nregions:  # another"),
        expect!["parse"],
    );
}

#[test]
fn other_ways_to_write_the_same_run_no_stage() {
    check_edit(
        SMALL,
        &SMALL
            .replace("height: 40", "height: 40mm")
            .replace("[20, 20]", "[2e1, 20.0]"),
        expect![[r#"
            parse
            program
            check
            scope
            basis
            linked
            entry 6
            read 2"#]],
    );
}

#[test]
fn the_order_of_entries_means_nothing() {
    let after = SMALL.replace("  hole: { circle: { radius: 8, at: [20, 20] } }\n", "");
    let after = after.replace(
        "partitions:",
        "  hole: { circle: { radius: 8, at: [20, 20] } }\npartitions:",
    );
    check_edit(
        SMALL,
        &after,
        expect![[r#"
        parse
        program"#]],
    );
}

#[test]
fn an_edit_of_a_node_runs_it_and_what_depends_on_it() {
    check_edit(
        SMALL,
        &SMALL.replace("radius: 8", "radius: 9"),
        expect![[r#"
        parse
        program
        check
        scope
        basis
        linked
        entry 6
        read
        definition
        evaluated 3
        -> regions.hole
        -> regions.plate
        -> artifacts.plate.svg"#]],
    );
}

#[test]
fn an_edit_of_an_artifact_runs_it_alone() {
    check_edit(
        SMALL,
        &SMALL.replace("{ from: plate }", "{ from: plate, draw: filled }"),
        expect![[r#"
            parse
            program
            check
            scope
            basis
            linked
            entry 6
            read
            definition
            evaluated
            format
            -> artifacts.plate.svg"#]],
    );
}

#[test]
fn an_edit_of_an_unused_parameter_runs_no_stage() {
    let before = SMALL.replace("gap: 5", "gap: 5, unused: 1");
    check_edit(
        &before,
        &before.replace("unused: 1", "unused: 2"),
        expect![[r#"
            parse
            program
            check
            scope
            basis
            linked
            entry 6
            read 6
            format 2"#]],
    );
}

#[test]
fn a_value_that_comes_out_the_same_stops_the_rebuild() {
    // The hole reaches into the page no further than before.
    let before = SMALL.replace("at: [20, 20]", "at: [-20, 20]");
    check_edit(
        &before,
        &before.replace("radius: 8", "radius: 9"),
        expect![[r#"
        parse
        program
        check
        scope
        basis
        linked
        entry 6
        read
        definition
        evaluated 2
        -> regions.hole
        -> regions.plate"#]],
    );
}

#[test]
fn a_documented_parameter_is_the_same_parameter() {
    check_edit(
        SMALL,
        &SMALL.replace("gap: 5", "gap: { default: 5, doc: \"distance\" }"),
        expect![[r#"
        parse
        program
        check
        scope
        basis
        linked
        entry 6"#]],
    );
}

#[test]
fn a_new_node_that_nobody_uses_runs_no_stage() {
    check_edit(
        SMALL,
        &SMALL.replace(
            "partitions:",
            "  more: { circle: { radius: 3 } }\npartitions:",
        ),
        expect![[r#"
            parse
            program
            check
            scope
            basis
            linked
            entry 7
            read
            definition 6"#]],
    );
}

#[test]
fn the_seed_runs_random_nodes_again() {
    let before = SMALL.replace(
        "stripes: { spacing: \"${gap}\" }",
        "uniform: { cell_size: \"${gap}\" }",
    );
    check_edit(
        &before,
        &before.replace("params:", "seed: 5\nparams:"),
        expect![[r#"
            parse
            program
            check
            scope
            basis
            linked
            entry 6
            read 6
            definition 6
            evaluated 2
            -> partitions.rows
            -> artifacts.rows.svg"#]],
    );
}

#[test]
fn equal_texts_start_no_revision() {
    let mut bench = Bench::new(SMALL);
    bench.build(&[]);
    bench.compiler.database.take_executed();
    bench.edit(SPEC, SMALL);
    bench.edit("specs/zig.svg", "nobody asks for it");
    assert_eq!(bench.compiler.refresh(), []);
    let report = bench.build(&[]);
    expect![""].assert_eq(&summary(&bench.compiler, &report));
}

#[test]
fn an_edit_of_an_included_file_parses_that_file_alone() {
    let mut bench = Bench::new(&SMALL.replace("params:", "include: [a.yaml, b.yaml]\nparams:"));
    bench.files.write(
        "specs/a.yaml",
        "fretwork: 1\nregions:\n  a: { circle: { radius: 1 } }\n",
    );
    bench.files.write(
        "specs/b.yaml",
        "fretwork: 1\nregions:\n  b: { circle: { radius: 1 } }\n",
    );
    bench.build(&[]);
    bench.compiler.database.take_executed();
    bench.edit(
        "specs/a.yaml",
        "# A comment.\nfretwork: 1\nregions:\n  a: { circle: { radius: 1 } }\n",
    );
    let report = bench.build(&[]);
    expect![[r#"
        program
        parse"#]]
    .assert_eq(&summary(&bench.compiler, &report));
    bench.edit(
        "specs/b.yaml",
        "fretwork: 1\nregions:\n  b: { circle: { radius: 2 } }\n",
    );
    let report = bench.build(&[]);
    expect![[r#"
        program
        parse
        check
        scope
        basis
        linked
        entry 8
        read"#]]
    .assert_eq(&summary(&bench.compiler, &report));
}

#[test]
fn set_parses_nothing() {
    let bench = Bench::new(SMALL);
    bench.build(&[]);
    bench.compiler.database.take_executed();
    let report = bench.build(&[("gap", "6")]);
    expect![[r#"
        check
        scope
        basis
        linked
        read 6
        definition 6
        evaluated 6
        format 2
        -> regions.hole
        -> regions.page
        -> regions.plate
        -> partitions.rows
        -> artifacts.plate.svg
        -> artifacts.rows.svg"#]]
    .assert_eq(&summary(&bench.compiler, &report));
    let report = bench.build(&[("gap", "6")]);
    expect![""].assert_eq(&summary(&bench.compiler, &report));
}

#[test]
fn an_error_that_is_mended_gives_the_old_values() {
    let mut bench = Bench::new(SMALL);
    let first = digests(&bench.build(&[]));
    bench.edit(SPEC, &SMALL.replace("radius: 8", "radius: -8"));
    assert_eq!(bench.report(&[]).diagnostics.len(), 1);
    bench.edit(SPEC, SMALL);
    assert_eq!(digests(&bench.build(&[])), first);
}

/// A node of every kind that is evaluated, drawn by an artifact of its own.
const KINDS: &str = r#"fretwork: 1
seed: 3
regions:
  page: { rectangle: { width: 40, height: 40 } }
  disc: { circle: { radius: 8, at: [20, 20] } }
  drawn: { svg: { file: blob.svg, at: [3, 3] } }
  window: { inset: { from: page, by: 2 } }
  whole: { union: [disc, drawn] }
  common: { intersection: [disc, window] }
  plate: { difference: [window, disc] }
exemplars:
  zig: { vector: { file: zig.svg } }
  blob: { vector: { file: blob.svg, id: blob } }
fields:
  tilt: { expression: { value: "x * 0.01", unit: rad } }
  slope: { derive: { from: tilt, operator: slope } }
partitions:
  rows: { stripes: { angle: tilt, spacing: 5 } }
  hatch: { stripes: { angle: slope, spacing: 3 } }
  net: { grid: { across: { angle: 0, spacing: 9 }, along: { angle: 90, spacing: 8 } } }
  cells: { uniform: { cell_size: 9 } }
  shards: { random: { cell_size: 9 } }
  pebbles: { packed: { elements: blob, gap: 1 } }
  contours: { isolines: { field: tilt, every: 0.1 } }
arrangements:
  inline: { map: { edges: net, with: "def keep(edge):\n  return to_curve(edge)\n" } }
  mapped: { map: { faces: net, with: { script: m.star, entry: hatch, args: { gap: 4 } } } }
  placed: { place: { edges: net, element: zig, from: start, to: end } }
  shrunk: { transform: { faces: net, scale: 0.8 } }
  filled: { fill: { faces: shrunk, with: rows } }
  both: { union: [placed, net] }
  inner: { inside: { input: hatch, mask: shrunk } }
  outer: { outside: { input: hatch, mask: shrunk } }
  varied: { vary: { faces: net, with: { script: m.star, entry: jitter } } }
  texture: { script: { file: m.star, entry: overview, args: { cells: net } } }
artifacts:
  drawn.svg: { from: drawn }
  whole.svg: { from: whole }
  common.dxf: { from: common }
  plate.json: { from: plate }
  zig.svg: { from: zig }
  blob.svg: { from: blob }
  cells.png: { from: cells, region: page, width: 50 }
  shards.svg: { from: shards, region: page }
  pebbles.svg: { from: pebbles, region: page }
  contours.svg: { from: contours, region: page }
  inline.svg: { from: inline, region: page }
  mapped.svg: { from: mapped, region: page }
  filled.svg: { from: filled, region: page }
  both.svg: { from: both, region: page }
  inner.svg: { from: inner, region: page }
  outer.svg: { from: outer, region: page }
  varied.svg: { from: varied, region: page }
  texture.svg: { from: texture, region: page }
"#;

/// Edits `from` to `to` in [`KINDS`] and compares which stages run.
#[track_caller]
fn check_stages(from: &str, to: &str, expect: Expect) {
    assert_eq!(
        KINDS.matches(from).count(),
        1,
        "`{from}` must name one place"
    );
    let mut bench = Bench::new(KINDS);
    bench.build(&[]);
    bench.edit(SPEC, &KINDS.replace(from, to));
    let report = bench.build(&[]);
    expect.assert_eq(&evaluated(&report).join("\n"));
    assert_eq!(
        digests(&report),
        digests(&Bench::new(&KINDS.replace(from, to)).build(&[]))
    );
}

#[test]
fn a_comment_runs_no_stage_of_any_kind() {
    let commented: String = KINDS
        .lines()
        .map(|line| format!("{line} # a comment\n"))
        .collect();
    check_edit(KINDS, &commented, expect!["parse"]);
}

#[test]
fn an_edit_of_a_region_runs_what_depends_on_it() {
    check_stages(
        "rectangle: { width: 40",
        "rectangle: { width: 41",
        expect![[r#"
        regions.common
        regions.page
        regions.plate
        regions.window
        partitions.cells
        partitions.contours
        partitions.hatch
        partitions.net
        partitions.pebbles
        partitions.shards
        arrangements.both
        arrangements.filled
        arrangements.inline
        arrangements.inner
        arrangements.mapped
        arrangements.outer
        arrangements.placed
        arrangements.shrunk
        arrangements.texture
        arrangements.varied
        artifacts.both.svg
        artifacts.cells.png
        artifacts.contours.svg
        artifacts.filled.svg
        artifacts.inline.svg
        artifacts.inner.svg
        artifacts.mapped.svg
        artifacts.outer.svg
        artifacts.pebbles.svg
        artifacts.plate.json
        artifacts.shards.svg
        artifacts.texture.svg
        artifacts.varied.svg"#]],
    );
    check_stages(
        "radius: 8",
        "radius: 9",
        expect![[r#"
        regions.common
        regions.disc
        regions.plate
        regions.whole
        artifacts.common.dxf
        artifacts.plate.json
        artifacts.whole.svg"#]],
    );
    check_stages(
        "file: blob.svg, at: [3, 3]",
        "file: blob.svg, at: [3, 4]",
        expect![[r#"
        regions.drawn
        regions.whole
        artifacts.drawn.svg
        artifacts.whole.svg"#]],
    );
    check_stages(
        "by: 2",
        "by: 3",
        expect![[r#"
        regions.common
        regions.plate
        regions.window
        artifacts.plate.json"#]],
    );
    check_stages(
        "union: [disc, drawn]",
        "union: [disc, window]",
        expect![[r#"
        regions.whole
        artifacts.whole.svg"#]],
    );
    check_stages(
        "intersection: [disc, window]",
        "intersection: [drawn, window]",
        expect![[r#"
        regions.common
        artifacts.common.dxf"#]],
    );
    check_stages(
        "difference: [window, disc]",
        "difference: [window, drawn]",
        expect![[r#"
        regions.plate
        artifacts.plate.json"#]],
    );
}

#[test]
fn an_edit_of_an_exemplar_runs_what_depends_on_it() {
    check_stages(
        "file: zig.svg",
        "file: zig.svg, rotate: 90",
        expect![[r#"
        exemplars.zig
        arrangements.both
        arrangements.placed
        artifacts.both.svg
        artifacts.zig.svg"#]],
    );
    check_stages(
        "id: blob",
        "id: blob, scale: 0.5",
        expect![[r#"
        exemplars.blob
        partitions.pebbles
        artifacts.blob.svg
        artifacts.pebbles.svg"#]],
    );
}

#[test]
fn an_edit_of_a_field_runs_what_depends_on_it() {
    check_stages(
        "x * 0.01",
        "x * 0.02",
        expect![[r#"
        partitions.contours
        partitions.hatch
        arrangements.filled
        arrangements.inner
        arrangements.outer
        artifacts.contours.svg
        artifacts.filled.svg
        artifacts.inner.svg
        artifacts.outer.svg"#]],
    );
    check_stages(
        "operator: slope",
        "operator: aspect",
        expect![[r#"
        partitions.hatch
        arrangements.inner
        arrangements.outer
        artifacts.inner.svg
        artifacts.outer.svg"#]],
    );
}

#[test]
fn an_edit_of_a_partition_runs_what_depends_on_it() {
    check_stages(
        "angle: tilt, spacing: 5",
        "angle: tilt, spacing: 6",
        expect![[r#"
        arrangements.filled
        artifacts.filled.svg"#]],
    );
    check_stages(
        "along: { angle: 90",
        "along: { angle: 80",
        expect![[r#"
        partitions.net
        arrangements.both
        arrangements.filled
        arrangements.inline
        arrangements.inner
        arrangements.mapped
        arrangements.outer
        arrangements.placed
        arrangements.shrunk
        arrangements.texture
        arrangements.varied
        artifacts.both.svg
        artifacts.filled.svg
        artifacts.inline.svg
        artifacts.inner.svg
        artifacts.mapped.svg
        artifacts.outer.svg
        artifacts.texture.svg
        artifacts.varied.svg"#]],
    );
    check_stages(
        "uniform: { cell_size: 9 }",
        "uniform: { cell_size: 8 }",
        expect![[r#"
        partitions.cells
        artifacts.cells.png"#]],
    );
    check_stages(
        "random: { cell_size: 9 }",
        "random: { cell_size: 8 }",
        expect![[r#"
        partitions.shards
        artifacts.shards.svg"#]],
    );
    check_stages(
        "gap: 1",
        "gap: 2",
        expect![[r#"
        partitions.pebbles
        artifacts.pebbles.svg"#]],
    );
    check_stages(
        "every: 0.1",
        "every: 0.05",
        expect![[r#"
        partitions.contours
        artifacts.contours.svg"#]],
    );
}

#[test]
fn an_edit_of_an_arrangement_runs_what_depends_on_it() {
    check_stages(
        "return to_curve(edge)",
        "return scale(to_curve(edge), 0.5)",
        expect![[r#"
        arrangements.inline
        artifacts.inline.svg"#]],
    );
    check_stages(
        "args: { gap: 4 }",
        "args: { gap: 5 }",
        expect![[r#"
        arrangements.mapped
        artifacts.mapped.svg"#]],
    );
    check_stages(
        "from: start, to: end",
        "from: end, to: start",
        expect![[r#"
        arrangements.both
        arrangements.placed
        artifacts.both.svg"#]],
    );
    check_stages(
        "scale: 0.8",
        "scale: 0.7",
        expect![[r#"
        arrangements.filled
        arrangements.inner
        arrangements.outer
        arrangements.shrunk
        artifacts.filled.svg
        artifacts.inner.svg
        artifacts.outer.svg"#]],
    );
    check_stages(
        "fill: { faces: shrunk, with: rows }",
        "fill: { faces: shrunk, with: hatch }",
        expect![[r#"
        arrangements.filled
        artifacts.filled.svg"#]],
    );
    check_stages(
        "union: [placed, net]",
        "union: [placed]",
        expect![[r#"
        arrangements.both
        artifacts.both.svg"#]],
    );
    check_stages(
        "inside: { input: hatch, mask: shrunk }",
        "inside: { input: rows, mask: shrunk }",
        expect![[r#"
        partitions.rows
        arrangements.inner
        artifacts.inner.svg"#]],
    );
    check_stages(
        "outside: { input: hatch, mask: shrunk }",
        "outside: { input: rows, mask: shrunk }",
        expect![[r#"
        partitions.rows
        arrangements.outer
        artifacts.outer.svg"#]],
    );
    check_stages(
        "entry: jitter",
        "entry: hatch, args: { gap: 1 }",
        expect![[r#"
        arrangements.varied
        artifacts.varied.svg"#]],
    );
    check_stages(
        "args: { cells: net }",
        "args: { cells: shrunk }",
        expect![[r#"
        arrangements.texture
        artifacts.texture.svg"#]],
    );
}

#[test]
fn an_edit_of_an_artifact_runs_only_it() {
    check_stages("width: 50", "width: 60", expect!["artifacts.cells.png"]);
    check_stages(
        "{ from: plate }",
        "{ from: window }",
        expect!["artifacts.plate.json"],
    );
}

/// Edits a file beside [`KINDS`], compares which stages run, and takes the edit back.
#[track_caller]
fn check_file(path: &str, after: &str, expect: Expect) {
    let mut bench = Bench::new(KINDS);
    let first = digests(&bench.build(&[]));
    let before = String::from_utf8(bench.files.read(path).unwrap()).unwrap();
    bench.edit(path, after);
    let report = bench.build(&[]);
    expect.assert_eq(&evaluated(&report).join("\n"));
    bench.edit(path, &before);
    assert_eq!(digests(&bench.build(&[])), first);
}

#[test]
fn new_bytes_of_a_drawing_run_its_readers() {
    check_file(
        "specs/zig.svg",
        &ZIG.replace("L3 0", "L3 1"),
        expect![[r#"
        exemplars.zig
        arrangements.both
        arrangements.placed
        artifacts.both.svg
        artifacts.zig.svg"#]],
    );
    check_file(
        "specs/zig.svg",
        &ZIG.replace("<path", "<!-- a zigzag --><path"),
        expect!["exemplars.zig"],
    );
    check_file(
        "specs/blob.svg",
        &BLOB.replace("H4 V4", "H4 V3"),
        expect![[r#"
        exemplars.blob
        regions.drawn
        regions.whole
        partitions.pebbles
        artifacts.blob.svg
        artifacts.drawn.svg
        artifacts.pebbles.svg
        artifacts.whole.svg"#]],
    );
}

#[test]
fn new_bytes_of_a_script_run_its_users_and_those_of_what_it_loads_too() {
    check_file(
        "specs/m.star",
        &MAPPERS.replace("contour(face)", "scale(contour(face), 0.5)"),
        expect![[r#"
        arrangements.mapped
        arrangements.texture
        arrangements.varied
        artifacts.varied.svg"#]],
    );
    check_file(
        "specs/m.star",
        &format!("# A comment.\n{MAPPERS}"),
        expect![[r#"
        arrangements.mapped
        arrangements.texture
        arrangements.varied"#]],
    );
    check_file(
        "specs/lib.star",
        "def outline(face):\n    return scale(contour(face), 0.5)\n",
        expect![[r#"
        arrangements.mapped
        arrangements.texture
        arrangements.varied
        artifacts.mapped.svg
        artifacts.texture.svg"#]],
    );
}

/// What is wrong with the spec after an edit of a file, and what that says; then the file is mended.
#[track_caller]
fn check_mended(path: &str, broken: Option<&str>, message: &str) {
    let mut bench = Bench::new(KINDS);
    let first = digests(&bench.build(&[]));
    let before = String::from_utf8(bench.files.read(path).unwrap()).unwrap();
    match broken {
        Some(text) => bench.files.write(path, text),
        None => bench.files.remove(path),
    }
    // A compiler that saw it whole, and one that begins with it broken.
    let mut late = Bench {
        files: bench.files.clone(),
        compiler: Compiler::new(bench.files.clone(), None, true),
    };
    bench.compiler.refresh();
    for bench in [&bench, &late] {
        let said: Vec<Diagnostic> = bench.report(&[]).diagnostics;
        assert!(said.iter().any(|d| d.message.contains(message)), "{said:?}");
    }
    bench.edit(path, &before);
    late.compiler.refresh();
    for bench in [&bench, &late] {
        assert_eq!(digests(&bench.build(&[])), first);
    }
}

#[test]
fn files_that_are_mended_give_the_old_values() {
    check_mended("specs/zig.svg", Some("<svg"), "XML");
    check_mended("specs/zig.svg", None, "no such file");
    check_mended("specs/m.star", Some("def hatch(:"), "");
    check_mended("specs/m.star", None, "no such file");
    check_mended(
        "specs/lib.star",
        Some("def outline(face):\n    return 1 / 0\n"),
        "",
    );
    check_mended("specs/lib.star", Some("outline = "), "");
    check_mended("specs/lib.star", None, "no such file");
}

#[test]
fn another_process_takes_everything_from_the_store() {
    let folder = tempfile::tempdir().unwrap();
    let first = Bench::new(KINDS).process(LocalStore::new(folder.path()));
    let expected = first.build(&[]);
    let mut second = first.process(LocalStore::new(folder.path()));
    let report = second.build(&[]);
    assert_eq!(evaluated(&report), [""; 0]);
    assert_eq!(digests(&report), digests(&expected));
    // The hole is another node, and the same disc: what needs the plate stops there.
    let same =
        "round: { circle: { radius: 8, at: [20, 20] } }\n  plate: { difference: [window, round] }";
    second.edit(
        SPEC,
        &KINDS.replace("plate: { difference: [window, disc] }", same),
    );
    assert_eq!(
        evaluated(&second.build(&[])),
        ["regions.plate", "regions.round"]
    );
    // A script's own reads are part of what is remembered.
    second.edit(
        "specs/lib.star",
        "def outline(face):\n    return scale(contour(face), 0.5)\n",
    );
    let third = second.process(LocalStore::new(folder.path()));
    expect![[r#"
        arrangements.mapped
        arrangements.texture
        arrangements.varied
        artifacts.mapped.svg
        artifacts.texture.svg"#]]
    .assert_eq(&evaluated(&third.build(&[])).join("\n"));
    second.edit("specs/lib.star", LIBRARY);
    assert_eq!(
        evaluated(&first.process(LocalStore::new(folder.path())).build(&[])),
        [""; 0]
    );
}
