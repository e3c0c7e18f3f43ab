use std::fs;
use std::os::unix::fs::{PermissionsExt as _, symlink};

use super::*;

fn scratch() -> (tempfile::TempDir, Folder) {
    let scratch = tempfile::tempdir().expect("a folder can be made");
    fs::create_dir_all(scratch.path().join("own/sub")).expect("it is empty");
    fs::write(scratch.path().join("secret"), "mine").expect("it is empty");
    let folder = Folder::open(&scratch.path().join("own")).expect("it is there");
    (scratch, folder)
}

#[test]
fn what_is_written_is_read_again_and_replaced_as_a_whole() {
    let (scratch, folder) = scratch();
    folder
        .write("a.svg", &[b"long first ", b"text"], Lasting::OnDisk)
        .expect("it is written");
    folder
        .write("a.svg", &[b"second"], Lasting::UntilPowerFails)
        .expect("it is replaced");
    assert_eq!(folder.read("a.svg").expect("it is there"), b"second");
    assert_eq!(folder.names().expect("it is a folder"), ["a.svg", "sub"]);
    let umask = fs::metadata(scratch.path().join("own/a.svg")).expect("it is there");
    assert_eq!(umask.permissions().mode() & 0o111, 0, "nobody runs it");
}

#[test]
fn links_are_refused_by_name() {
    let (scratch, folder) = scratch();
    let at = |name: &str| scratch.path().join("own").join(name);
    symlink("..", at("up")).expect("the name is free");
    symlink("../secret", at("file")).expect("the name is free");
    symlink("nowhere", at("broken")).expect("the name is free");
    for name in ["up", "file", "broken"] {
        let told = |error: io::Error| {
            let text = error.to_string();
            assert!(
                text.contains(&format!("{name}` is a symbolic link")),
                "{text}"
            );
        };
        told(folder.folder(name).expect_err("it is a link"));
        told(folder.make_folder(name).expect_err("it is a link"));
        told(folder.read(name).expect_err("it is a link"));
        told(
            folder
                .write(name, &[b"x"], Lasting::OnDisk)
                .expect_err("it is a link"),
        );
        assert!(
            folder
                .descend(Path::new(name).join("a").as_path(), true)
                .is_err()
        );
    }
    assert!(
        folder
            .names()
            .expect("it is a folder")
            .iter()
            .all(|name| !is_temporary(name))
    );
    folder.remove_all("up").expect("the link goes");
    folder.remove_file("file").expect("the link goes");
    assert_eq!(
        fs::read(scratch.path().join("secret")).expect("it stays"),
        b"mine"
    );
}

#[test]
fn only_plain_names_are_taken() {
    let (_scratch, folder) = scratch();
    for name in ["", ".", "..", "sub/..", "../secret", "/etc", "sub/"] {
        assert!(folder.entry(name).is_err(), "{name}");
        assert!(
            folder.write(name, &[b"x"], Lasting::OnDisk).is_err(),
            "{name}"
        );
        assert!(folder.remove_all(name).is_err(), "{name}");
    }
    assert!(folder.descend(Path::new("../own"), false).is_err());
    assert_eq!(
        folder
            .descend(Path::new("sub"), false)
            .expect("it is there")
            .path(),
        folder.path().join("sub")
    );
}

#[test]
fn pipes_and_folders_are_no_files() {
    let (scratch, folder) = scratch();
    let pipe = scratch.path().join("own/pipe");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    if made.is_ok_and(|status| status.success()) {
        assert!(folder.read("pipe").is_err(), "and does not wait");
        assert!(folder.write("pipe", &[b"x"], Lasting::OnDisk).is_err());
    }
    assert!(folder.read("sub").is_err());
    assert!(folder.write("sub", &[b"x"], Lasting::OnDisk).is_err());
    assert!(
        !folder
            .names()
            .expect("it is a folder")
            .iter()
            .any(|name| is_temporary(name))
    );
}

#[test]
fn removing_a_folder_follows_no_link_in_it() {
    let (scratch, folder) = scratch();
    fs::create_dir_all(scratch.path().join("own/sub/deep/er")).expect("it is new");
    symlink("../../..", scratch.path().join("own/sub/deep/out")).expect("the name is free");
    folder.remove_all("sub").expect("all of it can be removed");
    assert_eq!(folder.names().expect("it is a folder"), [""; 0]);
    assert!(scratch.path().join("secret").exists());
}

#[test]
fn files_of_killed_processes_are_known_by_name_and_age() {
    let (_scratch, folder) = scratch();
    let staged = folder
        .stage(&[b"half"], Lasting::UntilPowerFails)
        .expect("it is written");
    folder
        .write(".fretwork-tmp-notes", &[b"mine"], Lasting::OnDisk)
        .expect("it is written");
    assert_eq!(
        folder.remove_abandoned().expect("it is a folder"),
        0,
        "it is young"
    );
    let old = SystemTime::now() - 2 * ABANDONED;
    for name in [&staged, ".fretwork-tmp-notes"] {
        let file = File::options().append(true).open(folder.path().join(name));
        file.expect("it is there")
            .set_modified(old)
            .expect("the time can be set");
    }
    assert_eq!(folder.remove_abandoned().expect("it is a folder"), 4);
    assert_eq!(
        folder.names().expect("it is a folder"),
        [".fretwork-tmp-notes", "sub"]
    );
}

#[test]
fn paths_and_descriptors_see_the_same() {
    let (scratch, folder) = scratch();
    symlink("..", scratch.path().join("own/up")).expect("the name is free");
    fs::write(scratch.path().join("own/file"), "text").expect("the name is free");
    let other = portable::Handle::open(folder.path()).expect("it is a folder");
    for name in ["up", "file", "sub", "none"] {
        let kinds = [folder.handle.entry(name), other.entry(name)];
        let [one, two] = kinds.map(|entry| entry.ok().map(|e| (e.kind, e.modified)));
        assert_eq!(one, two, "{name}");
        assert_eq!(
            folder.folder(name).is_ok(),
            other.folder(name).is_ok(),
            "{name}"
        );
        let opened = folder
            .handle
            .open_file(name)
            .is_ok_and(|f| f.metadata().is_ok_and(|m| m.is_file()));
        assert_eq!(opened, other.open_file(name).is_ok(), "{name}");
    }
    let (mut one, mut two) = (
        folder.handle.names().expect("it is a folder"),
        other.names().expect("it is a folder"),
    );
    one.sort();
    two.sort();
    assert_eq!(one, two);
}
