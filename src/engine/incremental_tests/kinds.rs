//! Edits of nodes of every kind: which stages run.

use super::*;

/// A node of every kind that is evaluated, drawn by an artifact of its own.
pub(super) const KINDS: &str = r#"fretwork: 1
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
            partitions.pebbles
            partitions.shards
            arrangements.both
            arrangements.filled
            arrangements.inline
            arrangements.inner
            arrangements.mapped
            arrangements.outer
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
            arrangements.both
            arrangements.filled
            arrangements.inline
            arrangements.inner
            arrangements.mapped
            arrangements.outer
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
