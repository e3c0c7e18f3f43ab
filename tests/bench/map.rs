//! Maps: hatching of faces, slope at many places, a shapefile of many polygons, tiles one after another.
//!
//! Figures of other programs on a machine like this one: shapely clips 13,587 hatches of 35 faces in 1.24 s; gdaldem takes 46 ns a
//! pixel for the slope of a whole raster.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::super::Bench;
use fretwork::geometry::{Lattice, Point};
use fretwork::source::geo::geotiff;
use std::sync::Arc;

const HEAD: &str =
    "fretwork: 1\nmap: { crs: \"EPSG:32616\", tiles: { origin: [735000, 4054500], size: 8000 } }\n";

/// Every face of the massif hatched along its own direction.
const HATCH: &str = "regions:
  massif: { geodata: { file: data/faces.shp } }
  sheet: { rectangle: { width: 7200, height: 6000, at: [735000, 4048500] } }
fields:
  orient: { attribute: { region: massif, name: orient } }
partitions:
  rows: { stripes: { angle: orient, spacing: 5.2 } }
arrangements:
  hatch: { fill: { faces: massif, with: rows } }
artifacts:
  hatch.geojson: { from: hatch, region: sheet, clip: true, crs: map }
";

/// Cells of a large sheet moved at random, and hatched.
const JITTERED: &str = "regions:
  sheet: { rectangle: { width: SIDE, height: SIDE, at: [735000, 4048500] } }
partitions:
  cells: { uniform: { cell_size: 60, border: crop_add_boundary } }
  rows: { stripes: { angle: 30, spacing: 5 } }
arrangements:
  stones:
    map:
      faces: cells
      reach: 9
      with: |
        def stone(face):
            return translate(scale(contour(face), 0.7), point(random(face, -4, 4, 1), random(face, -4, 4, 2)))
  hatch: { fill: { faces: stones, with: rows } }
artifacts:
  hatch.geojson: { from: hatch, region: sheet, crs: map }
";

/// That of a sheet with sides of so many metres.
fn jittered(side: &str) -> Project {
    Project::of(&JITTERED.replace("SIDE", side))
}

/// A window of it.
const WINDOW: [&str; 4] = [
    "build",
    "--no-cache",
    "--window",
    "738000,4051000,738600,4051600",
];

/// A million bricks, each turned a little at random.
const VARIED: &str = "regions:
  sheet: { rectangle: { width: 10000, height: 5000, at: [735000, 4048500] } }
partitions:
  bricks: { grid: { across: { angle: 0, spacing: 5 }, along: { angle: 90, spacing: 10 }, border: keep_inside } }
arrangements:
  varied:
    vary:
      faces: bricks
      with: |
        def brick(face):
            return rotate(scale(contour(face), 0.8), random(face, -0.1, 0.1, 1))
";

/// A sheet of cells, each of them hatched.
const HATCHED: &str = "regions:
  sheet: { rectangle: { width: 7200, height: 6000, at: [735000, 4048500] } }
partitions:
  cells: { uniform: { cell_size: 50, border: crop_add_boundary } }
  rows: { stripes: { angle: 30, spacing: 2.3 } }
arrangements:
  hatch: { fill: { faces: cells, with: rows } }
artifacts:
  hatch.geojson: { from: hatch, region: sheet, crs: map }
";

/// A sheet of 64 tiles.
fn tiled() -> Project {
    let project = jittered("8000");
    let spec = project.0.path().join("specs/map.yaml");
    let text = fs::read_to_string(&spec).expect("it was written");
    let text = text.replace("4054500]", "4056500]");
    fs::write(spec, text).expect("the folder is writable");
    project
}

/// Draws the tiles of a sheet one after another, each in a process of its own.
fn each_tile(project: &Project) -> String {
    for number in 0..64 {
        let tile = format!("3/{}/{}", number % 8, number / 8);
        project.run(&["build", "--no-cache", "--tile", &tile]);
    }
    String::new()
}

/// What `work` prints, with the time of processors that the processes took which it started.
fn with_processor(work: impl Fn() -> String) -> String {
    let before = of_children();
    let note = work();
    format!("{:.2} s of processor  {note}", of_children() - before)
}

/// The seconds of processors that processes took which this one started and that have ended, as Linux counts them: the 14th and
/// 15th number after the name of the program, in hundredths. Zero on other systems.
fn of_children() -> f64 {
    let text = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let after = text.rsplit_once(')').map_or("", |(_, after)| after);
    let numbers = after.split_whitespace().skip(13).take(2);
    numbers.filter_map(|n| n.parse::<f64>().ok()).sum::<f64>() / 100.0
}

/// Edits a value of the table of the massif, in the column of directions, which is then another one than before; and builds.
fn edit_and_build(project: &Project) -> String {
    let path = project.0.path().join("specs/data/faces.dbf");
    let mut table = fs::read(&path).expect("the table was copied");
    let head = usize::from(u16::from_le_bytes([table[8], table[9]]));
    let (mut at, mut offset) = (32, 1);
    while !table[at..].starts_with(b"orient\0") {
        offset += usize::from(table[at + 16]);
        at += 32;
    }
    let field = head + offset..head + offset + usize::from(table[at + 16]);
    let digit = table[field].iter_mut().find(|byte| byte.is_ascii_digit());
    let digit = digit.expect("the first value is a number");
    *digit = b'0' + (*digit - b'0' + 1) % 10;
    fs::write(path, table).expect("the folder is writable");
    project.run(&["build"])
}

/// A project with one spec and the data of the maps.
struct Project(tempfile::TempDir);

impl Project {
    fn of(spec: &str) -> Project {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let data = folder.path().join("specs/data");
        fs::create_dir_all(&data).expect("the folder is writable");
        fs::write(folder.path().join("fretwork.toml"), "").expect("the folder is writable");
        let text = format!("{HEAD}{spec}");
        fs::write(folder.path().join("specs/map.yaml"), text).expect("the folder is writable");
        let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("specs/maps/data");
        for entry in fs::read_dir(shipped).expect("the data are there") {
            let entry = entry.expect("the folder can be read");
            fs::copy(entry.path(), data.join(entry.file_name())).expect("the folder is writable");
        }
        Project(folder)
    }

    /// What a command prints.
    fn run(&self, arguments: &[&str]) -> String {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
        let command = command.args(arguments).current_dir(self.0.path());
        let output = command.output().expect("it starts");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        let printed = String::from_utf8_lossy(&output.stdout);
        printed.lines().last().unwrap_or_default().to_owned()
    }
}

/// A shapefile of squares, `side` of them in a row and as many rows.
fn squares(side: u32) -> Vec<u8> {
    let mut records = Vec::new();
    for number in 0..side * side {
        let (x, y) = (f64::from(number % side), f64::from(number / side));
        let corners = [
            [x, y],
            [x, y + 1.0],
            [x + 1.0, y + 1.0],
            [x + 1.0, y],
            [x, y],
        ];
        let mut record = 5i32.to_le_bytes().to_vec();
        for number in [x, y, x + 1.0, y + 1.0] {
            record.extend(number.to_le_bytes());
        }
        for number in [1i32, 5, 0] {
            record.extend(number.to_le_bytes());
        }
        for number in corners.concat() {
            record.extend(number.to_le_bytes());
        }
        records.extend((number + 1).to_be_bytes());
        records.extend((record.len() as u32 / 2).to_be_bytes());
        records.extend(record);
    }
    let mut file = Vec::new();
    for number in [9994, 0, 0, 0, 0, 0, (100 + records.len() as u32) / 2] {
        file.extend(number.to_be_bytes());
    }
    file.extend(1000i32.to_le_bytes());
    file.extend(5i32.to_le_bytes());
    for number in [
        0.0,
        0.0,
        f64::from(side),
        f64::from(side),
        0.0,
        0.0,
        0.0,
        0.0,
    ] {
        file.extend(number.to_le_bytes());
    }
    file.extend(records);
    file
}

/// Runs the benchmarks of this file.
pub fn run(bench: &Bench) {
    bench.run(
        "map: hatches of 35 faces, as GeoJSON",
        || Project::of(HATCH),
        |project| project.run(&["build", "--no-cache"]),
    );
    bench.run(
        "map: the same in 64 tiles",
        || Project::of(HATCH),
        |project| project.run(&["build", "--no-cache", "--tile", "3/*/*"]),
    );
    bench.run(
        "map: 10^4 cells moved at random and hatched",
        || jittered("6000"),
        |project| project.run(&["build", "--no-cache"]),
    );
    bench.run(
        "map: a window of 10^2 cells of it",
        || jittered("6000"),
        |project| project.run(&WINDOW),
    );
    bench.run(
        "map: a window of a sheet of 10^9 cells",
        || jittered("2000000"),
        |project| project.run(&WINDOW),
    );
    bench.run(
        "map: 10^6 cells varied, measured",
        || Project::of(VARIED),
        |project| {
            let varied = ["inspect", "specs/map.yaml", "varied", "--region", "sheet"];
            with_processor(|| project.run(&varied))
        },
    );
    bench.run(
        "map: 10^6 lines, hatches of 17,000 faces and their borders",
        || Project::of(HATCHED),
        |project| with_processor(|| project.run(&["build", "--no-cache", "--budget", "4"])),
    );
    bench.run("map: a sheet of 64 tiles, whole", tiled, |project| {
        with_processor(|| project.run(&["build", "--no-cache"]))
    });
    bench.run("map: its tiles one after another", tiled, |project| {
        with_processor(|| each_tile(project))
    });
    bench.run(
        "map: built again after an edit of an attribute",
        || {
            let project = Project::of(HATCH);
            project.run(&["build"]);
            project
        },
        edit_and_build,
    );
    bench.run(
        "map: 10^5 polygons read",
        || {
            let project = Project::of("regions: { all: { geodata: { file: squares.shp } } }\n");
            fs::write(project.0.path().join("specs/squares.shp"), squares(316))
                .expect("the folder is writable");
            project
        },
        |project| project.run(&["inspect", "specs/map.yaml", "all"]),
    );
    bench.run(
        "map: slope at 10^6 places",
        || {
            let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("specs/maps/data/massif.tif");
            let bytes: Arc<[u8]> = fs::read(file).expect("the data are there").into();
            let raster =
                geotiff::open(std::io::Cursor::new(bytes.clone()), 1).expect("it is a GeoTIFF");
            let frame = raster.frame.expect("it has a place");
            Lattice::new(raster.blocks, frame, None).expect("its frame has an inverse")
        },
        |lattice| {
            let at = |n: u32| {
                Point::new(
                    735_015.0 + f64::from(n % 1000) * 7.17,
                    4_048_515.0 + f64::from(n / 1000) * 5.97,
                )
            };
            let steep = (0..1_000_000).filter(|n| lattice.gradient(at(*n)).length() > 0.4);
            format!("{} steep", steep.count())
        },
    );
}
