//! Origins: what they depend on, and that no node runs again because of them.

use super::*;

const FIELD: &str = r#"fretwork: 1
params: { size: 9 }
regions:
  page: { rectangle: { width: "${size}", height: 9 } }
  hole: { circle: { radius: 2, at: [4, 4] } }
  plate: { difference: [page, hole] }
fields:
  ramp: { expression: { value: x } }
  steep: { expression: { value: "2 * s", fields: { s: ramp } } }
artifacts:
  "steep-${size}.png": { from: steep, region: page, width: 8 }
  plate.svg: { from: plate }
  plain.svg: { from: plate, provenance: false }
"#;

const OLD: Versions = Versions(&[("primitive", "1"), ("stage/artifact", "1")]);
const NEW: Versions = Versions(&[("primitive", "2"), ("stage/artifact", "2")]);

/// Functions stand among inputs for the code that they are applied by; of that a file says nothing.
#[test]
fn no_version_is_in_an_origin() {
    let folder = tempfile::tempdir().unwrap();
    let files = Bench::new(FIELD).files;
    let built = |versions: Versions| {
        let store = LocalStore::new(folder.path());
        let cache = Cache { store, versions };
        let bench = Bench {
            compiler: Compiler::new(files.clone(), Some(cache), true),
            files: files.clone(),
        };
        let report = bench.build(&[]);
        let recipes = report
            .artifacts
            .iter()
            .map(|one| bench.compiler.recipe(one));
        (
            digests(&report),
            recipes.collect::<Vec<_>>(),
            evaluated(&report).len(),
        )
    };
    let (old, new) = (built(OLD), built(NEW));
    assert_eq!((&old.0, &old.1), (&new.0, &new.1));
    assert!(new.2 > 0, "another version has computed nothing anew");
    assert_eq!(old.1.iter().filter(|recipe| recipe.is_some()).count(), 2);
}

#[test]
fn another_name_runs_the_artifacts_that_say_theirs() {
    check_names(
        "plate.svg: { from",
        "board.svg: { from",
        expect!["artifacts.board.svg"],
    );
    check_names(
        "plain.svg: { from",
        "bare.svg: { from",
        expect!["artifacts.bare.svg"],
    );
    check_names(
        "hole: { circle: { radius: 2,",
        "hole: { circle: { radius: 2mm,",
        expect![""],
    );
}

/// A hole that is drawn in another way and comes out the same: what stops a rebuild stops it as before.
#[test]
fn a_value_that_comes_out_the_same_keeps_the_recipe() {
    let same = "hole: { circle: { radius: 2, at: [4, 4] } }\n  round: { union: [hole] }";
    check_names(
        "hole: { circle: { radius: 2, at: [4, 4] } }",
        same,
        expect![""],
    );
    check_names(
        "plate: { difference: [page, hole] }",
        "disc: { circle: { radius: 2, at: [4, 4] } }\n  plate: { difference: [page, disc] }",
        expect![[r#"
            regions.disc
            regions.plate"#]],
    );
}

/// Edits the spec in a compiler and compares which stages run.
#[track_caller]
fn check_names(from: &str, to: &str, expect: Expect) {
    let mut bench = Bench::new(FIELD);
    bench.build(&[]);
    assert!(FIELD.contains(from), "{from}");
    bench.edit(SPEC, &FIELD.replace(from, to));
    let report = bench.build(&[]);
    expect.assert_eq(&evaluated(&report).join("\n"));
}
