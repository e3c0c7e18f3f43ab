//! The store proves itself, is repaired, and stays within its size.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::time::SystemTime;

use super::super::{StoreSize, Verification};
use super::*;

/// Where an entry lies.
fn path(store: &LocalStore, table: Table, digest: &Digest) -> PathBuf {
    let root = store.0.path.join(format!("v{FORMAT}"));
    root.join(table.name()).join(digest.hex())
}

fn store() -> (tempfile::TempDir, LocalStore) {
    let folder = tempfile::tempdir().unwrap();
    let store = LocalStore::new(folder.path());
    (folder, store)
}

fn put(store: &LocalStore, text: &str) -> (Digest, Digest) {
    let (key, output) = (
        Digest::of(format!("key {text}").as_bytes()),
        Digest::of(text.as_bytes()),
    );
    store.put_blob(&output, &[text.as_bytes()]).unwrap();
    store
        .put_action(
            &key,
            ActionResult {
                reads: Vec::new(),
                output,
                note: b"n".to_vec(),
            },
        )
        .unwrap();
    (key, output)
}

#[test]
fn what_was_put_is_found_again() {
    let (_folder, store) = store();
    let (key, output) = put(&store, "value");
    assert_eq!(store.action(&key)[0].output, output);
    assert_eq!(store.blob(&output).unwrap(), b"value");
    assert_eq!(store.action(&output), []);
    assert_eq!(store.size().unwrap().blobs, 1);
}

#[test]
fn a_result_is_kept_for_each_state_of_the_files_that_were_read() {
    let (_folder, store) = store();
    let result = |state: u8| {
        let reads = vec![
            ("lib.star".to_string(), Some(Digest::of(&[state]))),
            ("missing.star".to_string(), None),
        ];
        ActionResult {
            reads,
            output: Digest::of(&[state, state]),
            note: Vec::new(),
        }
    };
    let key = Digest::of(b"key");
    for state in [1, 2, 1] {
        store.put_action(&key, result(state)).unwrap();
    }
    assert_eq!(store.action(&key), [result(1), result(2)]);
    for state in 0..=u8::MAX {
        store.put_action(&key, result(state)).unwrap();
    }
    assert_eq!(store.action(&key).len(), MAX_RESULTS);
}

#[test]
fn every_damaged_byte_and_every_truncation_is_detected_and_dropped() {
    let (_folder, store) = store();
    let (key, output) = put(&store, "value");
    for (table, digest) in [(Table::Actions, key), (Table::Blobs, output)] {
        let path = path(&store, table, &digest);
        let whole = fs::read(&path).unwrap();
        let found = || {
            if table == Table::Actions {
                !store.action(&digest).is_empty()
            } else {
                store.blob(&digest).is_some()
            }
        };
        for i in 0..whole.len() {
            let mut damaged = whole.clone();
            damaged[i] ^= 1;
            fs::write(&path, damaged).unwrap();
            assert!(!found() && !path.exists(), "{table:?}: byte {i} flipped");
            fs::write(&path, &whole[..i]).unwrap();
            assert!(!found() && !path.exists(), "{table:?}: cut at {i}");
        }
        fs::write(&path, &whole).unwrap();
        assert!(found());
    }
}

#[test]
fn verify_removes_what_is_damaged_and_keeps_the_rest() {
    let (_folder, store) = store();
    let (_, damaged) = put(&store, "one");
    let (_, whole) = put(&store, "two");
    fs::write(path(&store, Table::Blobs, &damaged), "eno").unwrap();
    let damaged_entries = |damaged| Verification {
        damaged,
        unreadable: 0,
    };
    assert_eq!(store.verify().unwrap(), damaged_entries(1));
    assert!(store.has_blob(&whole) && !store.has_blob(&damaged));
    assert_eq!(store.verify().unwrap(), damaged_entries(0));
}

#[test]
fn collecting_keeps_what_was_used_last() {
    let (_folder, store) = store();
    let (_, old) = put(&store, "old value");
    let past = SystemTime::now() - Duration::from_secs(1_000_000);
    fs::File::options()
        .append(true)
        .open(path(&store, Table::Blobs, &old))
        .unwrap()
        .set_modified(past)
        .unwrap();
    let (_, new) = put(&store, "new value");
    let size = store.size().unwrap().bytes;
    assert_eq!(store.collect(size - 1).unwrap(), 9);
    assert!(store.has_blob(&new) && !store.has_blob(&old));
    assert!(store.collect(0).unwrap() > 0);
    assert_eq!(store.size().unwrap(), StoreSize::default());
}

#[test]
fn a_damaged_blob_of_the_right_length_is_not_kept_when_put_again_after_a_read() {
    let (_folder, store) = store();
    let (_, output) = put(&store, "value");
    fs::write(path(&store, Table::Blobs, &output), "eulav").unwrap();
    assert_eq!(store.blob(&output), None);
    store.put_blob(&output, &[b"value"]).unwrap();
    assert_eq!(store.blob(&output).unwrap(), b"value");
}

#[test]
fn an_entry_of_another_key_is_damage_and_leaves_no_trace() {
    let (_folder, store) = store();
    let (one, _) = put(&store, "one");
    let (two, output) = put(&store, "two");
    fs::copy(
        path(&store, Table::Actions, &two),
        path(&store, Table::Actions, &one),
    )
    .unwrap();
    assert_eq!(store.action(&one), []);
    fs::copy(
        path(&store, Table::Actions, &two),
        path(&store, Table::Actions, &one),
    )
    .unwrap();
    let (key, _) = put(&store, "one");
    assert_eq!(
        store.action(&key).len(),
        1,
        "the foreign result is not kept"
    );
    assert_eq!(store.action(&two)[0].output, output);
    store.put_note(&one, b"text").unwrap();
    fs::copy(
        path(&store, Table::Notes, &one),
        path(&store, Table::Notes, &two),
    )
    .unwrap();
    assert_eq!(
        (store.note(&one).as_deref(), store.note(&two)),
        (Some(&b"text"[..]), None)
    );
}

#[test]
fn what_stands_in_the_place_of_an_entry_is_replaced() {
    let (folder, store) = store();
    let (key, output) = put(&store, "value");
    fs::write(folder.path().join("mine"), "mine").unwrap();
    for (table, digest) in [(Table::Actions, key), (Table::Blobs, output)] {
        let place = path(&store, table, &digest);
        fs::remove_file(&place).unwrap();
        fs::create_dir_all(place.join("deep")).unwrap();
        fs::write(place.join("deep/file"), "x").unwrap();
        assert!(!store.has_blob(&output) || table == Table::Actions);
        put(&store, "value");
        assert!(place.is_file());
        #[cfg(unix)]
        {
            fs::remove_file(&place).unwrap();
            std::os::unix::fs::symlink(folder.path().join("mine"), &place).unwrap();
            put(&store, "value");
            assert!(fs::symlink_metadata(&place).unwrap().is_file());
        }
    }
    assert_eq!(store.blob(&output).unwrap(), b"value");
    assert_eq!(fs::read(folder.path().join("mine")).unwrap(), b"mine");
}

#[test]
#[cfg(unix)]
fn links_inside_of_the_store_are_not_passed() {
    let (folder, store) = store();
    let (key, _) = put(&store, "value");
    let elsewhere = tempfile::tempdir().unwrap();
    let root = folder.path().join(format!("v{FORMAT}"));
    fs::rename(root.join("actions"), elsewhere.path().join("actions")).unwrap();
    std::os::unix::fs::symlink(elsewhere.path().join("actions"), root.join("actions")).unwrap();
    let store = LocalStore::new(folder.path());
    assert_eq!(store.action(&key), []);
    let result = ActionResult {
        reads: Vec::new(),
        output: key,
        note: Vec::new(),
    };
    assert!(
        store
            .put_action(&key, result)
            .unwrap_err()
            .to_string()
            .contains("symbolic link")
    );
    assert!(store.collect(0).is_err() && store.verify().is_err());
    assert_eq!(
        fs::read_dir(elsewhere.path().join("actions"))
            .unwrap()
            .count(),
        1
    );
}

#[test]
fn only_what_has_the_name_of_an_entry_is_removed() {
    let (folder, store) = store();
    let (key, _) = put(&store, "value");
    let hex = key.hex();
    let older = format!("v2/actions/{}/{}", &hex[..2], &hex[2..]);
    let kept = [
        "notes.txt".to_string(),
        "v3/mine".to_string(),
        format!("v3/actions/{}", hex.to_uppercase().replace('0', "A")),
        "v3/blobs/picture.png".to_string(),
        "v2/actions/ab/mine".to_string(),
        "v2/actions/mine/x".to_string(),
        "v4/actions/x".to_string(),
    ];
    for name in kept.iter().chain([&older]) {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "mine").unwrap();
    }
    assert_eq!(store.verify().unwrap(), Verification::default());
    assert!(store.collect(0).unwrap() > 4);
    assert_eq!(store.size().unwrap(), StoreSize::default());
    for name in kept {
        assert!(folder.path().join(&name).exists(), "{name}");
    }
    assert!(!folder.path().join(older).exists());
}

#[test]
fn it_keeps_its_size_by_itself() {
    let (_folder, store) = store();
    let limit = 40_000;
    let mut last = Vec::new();
    for i in 0..100 {
        let (_, output) = put(&store, &format!("{i:04}").repeat(250));
        last.push(output);
        store.settle(limit).unwrap();
        assert!(store.size().unwrap().bytes <= limit, "{i}");
    }
    let kept = last.iter().filter(|output| store.has_blob(output)).count();
    assert!(kept > 15, "{kept}");
    assert!(last[95..].iter().all(|output| store.has_blob(output)));
    assert!(!store.has_blob(&last[0]));
    store.settle(0).unwrap();
    assert_eq!(store.size().unwrap().bytes, 0);
}
