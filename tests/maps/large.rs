//! Rasters that are larger than what is held of them: files with holes, which take no room on the disk, of more bytes than
//! are read of any other file.

use std::fs::File;
use std::io::{Seek as _, SeekFrom, Write as _};
use std::time::{Duration, SystemTime};

use super::super::project::{Project, Run, finish};

/// Pixels along a side of a tile, of four bytes each.
const TILE: u64 = 512;
/// Tiles along a side of the raster: 1.3 GiB.
const TILES: u64 = 36;
const TILE_BYTES: u64 = TILE * TILE * 4;

/// A project with a raster of 1.3 GiB whose heights are x + y / 100000 in tiles 17 and 18 of each direction, and 0 elsewhere.
fn project(is_big: bool) -> Project {
    let project = Project::of(
        "fretwork: 1\nmap: {}\nregions:\n  window: { rectangle: { width: 400, height: 400, at: [9000, -9400] } }\nfields:\n  height: { raster: { file: large.tif } }\n  slope: { derive: { from: height, operator: slope } }\npartitions:\n  rows: { isolines: { field: height, every: 100 } }\nartifacts:\n  rows.svg: { from: rows, region: window }\n",
    );
    write(&project, is_big);
    project
}

/// Writes the raster, as it was a day ago.
fn write(project: &Project, is_big: bool) {
    let path = project.path("specs/large.tif");
    let mut file = File::create(&path).unwrap();
    let head = head(is_big);
    let first = head.len() as u64;
    file.write_all(&head).unwrap();
    file.set_len(first + TILES * TILES * TILE_BYTES).unwrap();
    for (j, i) in [(17, 17), (17, 18), (18, 17), (18, 18)] {
        file.seek(SeekFrom::Start(first + (j * TILES + i) * TILE_BYTES))
            .unwrap();
        let value = |k: u64| {
            let (x, y) = (i * TILE + k % TILE, j * TILE + k / TILE);
            (x as f32 + y as f32 / 100_000.0).to_le_bytes()
        };
        let tile: Vec<u8> = (0..TILE * TILE).flat_map(value).collect();
        file.write_all(&tile).unwrap();
    }
    let day = Duration::from_secs(86_400);
    file.set_modified(SystemTime::now() - day).unwrap();
}

/// All that stands before the first tile. A pixel is a metre, and the first begins at (0, 0).
fn head(is_big: bool) -> Vec<u8> {
    let (word, kind) = if is_big { (8usize, 16u16) } else { (4, 4) };
    let number = |value: u64, size: usize| value.to_le_bytes()[..size].to_vec();
    let double = |values: &[f64]| values.iter().flat_map(|v| v.to_le_bytes()).collect();
    let count = TILES * TILES;
    let long = |value: u64| (4, number(value, 4));
    let short = |value: u64| (3, number(value, 2));
    // The tags in order; the places of the tiles follow once the length of it all is known.
    let tags = |first: u64| -> Vec<(u64, (u16, Vec<u8>))> {
        let places = (0..count).flat_map(|k| number(first + k * TILE_BYTES, word));
        let sizes = (0..count).flat_map(|_| number(TILE_BYTES, word));
        vec![
            (256, long(TILES * TILE)),
            (257, long(TILES * TILE)),
            (258, short(32)),
            (259, short(1)),
            (262, short(1)),
            (277, short(1)),
            (322, long(TILE)),
            (323, long(TILE)),
            (324, (kind, places.collect())),
            (325, (kind, sizes.collect())),
            (339, short(3)),
            (33550, (12, double(&[1.0, 1.0, 0.0]))),
            (33922, (12, double(&[0.0; 6]))),
        ]
    };
    let write = |first: u64| {
        let mut out = b"II".to_vec();
        out.extend(number(if is_big { 43 } else { 42 }, 2));
        if is_big {
            out.extend([8, 0, 0, 0]);
        }
        let tags = tags(first);
        let begin = out.len() + word;
        out.extend(number(begin as u64, word));
        out.extend(number(tags.len() as u64, if is_big { 8 } else { 2 }));
        let mut after = begin + if is_big { 8 } else { 2 } + tags.len() * (4 + 2 * word) + word;
        let mut apart = Vec::new();
        for (tag, (kind, content)) in tags {
            let size = match kind {
                3 => 2,
                4 => 4,
                _ => 8,
            };
            out.extend(number(tag, 2));
            out.extend(number(kind.into(), 2));
            out.extend(number((content.len() / size) as u64, word));
            if content.len() > word {
                out.extend(number(after as u64, word));
                after += content.len();
                apart.extend(content);
            } else {
                let mut value = content;
                value.resize(word, 0);
                out.extend(value);
            }
        }
        out.extend(number(0, word));
        out.extend(apart);
        out
    };
    let length = write(0).len() as u64;
    write(length)
}

/// A run in an address space that cannot hold the file.
fn within(project: &Project, megabytes: u32, arguments: &[&str]) -> Run {
    let plain = project.command(arguments);
    let mut command = std::process::Command::new("sh");
    command
        .arg("-c")
        .arg(format!(
            "ulimit -v {}; exec \"$0\" \"$@\"",
            megabytes * 1024
        ))
        .arg(plain.get_program())
        .args(plain.get_args())
        .current_dir(project.path(""));
    finish(command)
}

/// Bug: a raster was held as a whole, and one of more than a gibibyte refused.
#[test]
#[cfg(target_os = "linux")]
fn a_window_of_a_raster_of_more_than_a_gibibyte_needs_megabytes() {
    for is_big in [false, true] {
        let project = project(is_big);
        let at = ["inspect", "specs/spec.yaml", "height", "--at"];
        let place = ["9215.5,-9217.5", "--jobs", "2", "--format", "json"];
        let run = within(&project, 400, &[&at[..], &place].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let found: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
        let value = found["at"][0]["value"].as_f64().unwrap();
        // In the corner where the four tiles meet.
        assert!((value - 9215.09217).abs() < 1e-3, "{value}");
        let run = within(&project, 400, &["build", "--jobs", "2"]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        // Four lines of equal height, and it knows the file from its digest the next time.
        let lines = String::from_utf8_lossy(&project.files("out/spec")["rows.svg"]).into_owned();
        assert_eq!(lines.matches("<path").count(), 4, "{lines}");
        assert_eq!(project.build(&[]).artifacts("unchanged").len(), 1);
    }
}

/// The digest of a raster that is read by parts is remembered beside what the system says of the file, and no longer holds
/// when that changes.
#[test]
fn a_large_raster_that_is_written_anew_is_built_anew() {
    let project = project(true);
    let before = project.succeed(&["build", "--format", "json"]);
    assert!(before.contains("rows.svg"));
    let path = project.path("specs/large.tif");
    let mut file = File::options().write(true).open(&path).unwrap();
    let modified = file.metadata().unwrap().modified().unwrap();
    file.seek(SeekFrom::End(-4)).unwrap();
    file.write_all(&1f32.to_le_bytes()).unwrap();
    // The time of modification says nothing of it; what else the system notes does.
    file.set_modified(modified).unwrap();
    drop(file);
    let report = project.build(&[]);
    assert!(
        report
            .nodes("evaluated")
            .iter()
            .any(|node| node == "partitions.rows"),
        "{:?}",
        report.nodes("evaluated")
    );
    assert_eq!(report.artifacts("unchanged").len(), 1);
}
