//! What one process keeps and another takes from the store.

use super::kinds::KINDS;
use super::*;

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
