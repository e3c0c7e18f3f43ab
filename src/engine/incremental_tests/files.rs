//! Edits of files beside a spec: drawings and scripts, whole and broken.

use super::kinds::KINDS;
use super::*;

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
