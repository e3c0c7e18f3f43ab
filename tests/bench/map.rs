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
