//! Maps from files to measures: regions from geodata, fields from rasters, attributes, and what is wrong
//! with them. Areas of countries are in `countries`, how fine curves of drawings are in `curved`, what is odd in `doubts`, what
//! is drawn of maps in `drawn`, areas that are drawn in `filled`, what edits of them run in `edits`, files as other programs
//! write them in `foreign`, those too large to hold in `large`, windows in `near`, points in `points`, windows within rings in
//! `ringed`, what tables say in `tables`, windows of what is built as a whole in `whole`.

mod countries;
mod curved;
mod doubts;
mod drawn;
mod edits;
mod filled;
mod foreign;
mod large;
mod near;
mod points;
mod ringed;
mod tables;
mod whole;

use super::project::Project;

macro_rules! data {
    ($($name:literal),*) => {
        [$(($name, &include_bytes!(concat!("../../specs/maps/data/", $name))[..])),*]
    };
}

/// A project with the data of the maps and this spec.
fn project(spec: &str) -> Project {
    let project = Project::empty();
    project.write("specs/spec.yaml", spec);
    let files = data![
        "massif.tif",
        "lake.tif",
        "turned.tif",
        "jacksboro.tif",
        "faces.shp",
        "faces.dbf",
        "faces.shx",
        "faces.prj",
        "faces.cpg",
        "faces.geojson",
        "lines.shp",
        "lines.dbf",
        "lines.prj",
        "massif.gpkg"
    ];
    for (name, bytes) in files {
        project.write(&format!("specs/data/{name}"), bytes);
    }
    project
}

fn measures(project: &Project, args: &[&str]) -> serde_json::Value {
    let args = [&["inspect", "specs/spec.yaml"], args, &["--format", "json"]].concat();
    serde_json::from_str(&project.succeed(&args)).unwrap()
}

/// The value of a field at a place, as its mean over a square of a millimetre; none where it has none.
fn values(
    head: &str,
    fields: &str,
    places: &[[f64; 2]],
    asked: &[(&str, &[Option<f64>])],
    close: f64,
) {
    let regions: String = places
        .iter()
        .enumerate()
        .map(|(n, [x, y])| {
            let (x, y) = (x - 5e-4, y - 5e-4);
            format!("  p{n}: {{ rectangle: {{ width: 0.001, height: 0.001, at: [{x}, {y}] }} }}\n")
        })
        .collect();
    let project = project(&format!(
        "fretwork: 1\n{head}\nregions:\n  massif: {{ geodata: {{ file: data/faces.shp }} }}\n{regions}fields:\n{fields}"
    ));
    for (name, expected) in asked {
        for (n, expected) in expected.iter().enumerate() {
            let found = measures(&project, &[name, "--region", &format!("p{n}")])["mean"].as_f64();
            let is_close = match (found, expected) {
                (Some(found), Some(expected)) => (found - expected).abs() < close,
                (found, expected) => found.is_none() && expected.is_none(),
            };
            assert!(
                is_close,
                "{name} at {:?}: {found:?}, not {expected:?}",
                places[n]
            );
        }
    }
}

const UTM: &str = "map: { crs: \"EPSG:32616\" }";

/// Heights, slopes and roughness by GDAL 3.6 (`gdaldem -compute_edges`), between samples by its rules on the gradient.
#[test]
fn rasters_and_their_relief_are_those_of_gdal() {
    let fields = "  height: { raster: { file: data/massif.tif } }
  near: { raster: { file: data/massif.tif, interpolate: nearest } }
  slope: { derive: { from: height, operator: slope } }
  aspect: { derive: { from: height, operator: aspect } }
  rough: { derive: { from: height, operator: roughness } }
  other: { raster: { file: data/jacksboro.tif } }
";
    let places = [
        [735615.0, 4053585.0],
        [738615.0, 4051515.0],
        [741015.0, 4049985.0],
        [734990.0, 4052000.0],
    ];
    values(
        UTM,
        fields,
        &places,
        &[
            (
                "height",
                &[Some(597.97998), Some(542.559998), Some(590.900024), None],
            ),
            (
                "slope",
                &[Some(7.665114), Some(19.833378), Some(22.785462), None],
            ),
            (
                "rough",
                &[Some(11.789978), Some(29.039978), Some(33.400024), None],
            ),
        ],
        2e-3,
    );
    values(
        UTM,
        fields,
        &places,
        &[(
            "aspect",
            &[Some(168.481519), Some(206.334119), Some(116.041484), None],
        )],
        0.05,
    );
    let between = [
        [739460.67, 4053799.73],
        [740520.83, 4049875.21],
        [735004.0, 4052000.0],
    ];
    values(
        UTM,
        fields,
        &between,
        &[
            (
                "height",
                &[Some(645.118951), Some(517.384581), Some(431.996674)],
            ),
            ("slope", &[Some(9.788132), Some(4.46705), Some(18.848999)]),
        ],
        5e-3,
    );
    // A raster in degrees is read at the place on the map.
    let other = [[738615.0, 4051515.0], [741015.0, 4049985.0]];
    values(
        UTM,
        fields,
        &other,
        &[("other", &[Some(541.656051), Some(590.709105)])],
        0.02,
    );
}

#[test]
fn samples_that_are_missing_have_no_value_or_the_one_that_is_asked_for() {
    let fields = "  lake: { raster: { file: data/lake.tif } }
  slope: { derive: { from: lake, operator: slope } }
  wet: { raster: { file: data/lake.tif, otherwise: -1 } }
  sum: { expression: { value: \"l + 1 if l > 0 else 2\", fields: { l: lake } } }
  some: { expression: { value: \"l + 1\", fields: { l: lake }, otherwise: 7 } }
";
    let places = [
        [739515.0, 4051785.0],
        [739515.0, 4051185.0],
        [739506.0, 4051191.0],
    ];
    values(
        UTM,
        fields,
        &places,
        &[
            ("lake", &[None, Some(704.0), Some(706.1)]),
            ("slope", &[None, Some(12.510783), Some(12.01994)]),
            ("wet", &[Some(-1.0), Some(704.0), Some(706.1)]),
            ("sum", &[None, Some(705.0), Some(707.1)]),
            ("some", &[Some(7.0), Some(705.0), Some(707.1)]),
        ],
        5e-3,
    );
}

#[test]
fn attributes_and_statistics_are_constant_in_each_face() {
    let fields = "  height: { raster: { file: data/massif.tif } }
  density: { attribute: { region: massif, name: density } }
  zmax: { attribute: { region: massif, name: zmax } }
  high: { zonal: { faces: massif, from: height, statistic: max } }
  low: { zonal: { faces: massif, from: height, statistic: min } }
  orient: { attribute: { region: massif, name: orient } }
  down: { zonal: { faces: massif, from: height, statistic: direction } }
";
    let places = [
        [740902.5, 4048620.0],
        [740714.6, 4049449.69],
        [734000.0, 4050000.0],
    ];
    values(
        UTM,
        fields,
        &places,
        &[("density", &[Some(0.98), Some(0.985), None])],
        1e-9,
    );
    let text = format!(
        "fretwork: 1\n{UTM}\nregions:\n  massif: {{ geodata: {{ file: data/faces.shp }} }}\n  all: {{ rectangle: {{ width: 7200, height: 6000, at: [735000, 4048500] }} }}\nfields:\n{fields}"
    );
    let project = project(&text);
    let of = |name: &str, what: &str| {
        measures(&project, &[name, "--region", "all"])[what]
            .as_f64()
            .unwrap()
    };
    assert!(of("high", "max") > of("low", "max"));
    assert!(
        (of("high", "max") - of("zmax", "max")).abs() < 60.0,
        "{} {}",
        of("high", "max"),
        of("zmax", "max")
    );
    assert!((0.0..=360.0).contains(&of("down", "min")) && of("down", "defined") > 0.99);
}

#[test]
fn regions_are_the_same_from_every_format() {
    let project = project(&format!(
        "fretwork: 1
{UTM}
regions:
  shp: {{ geodata: {{ file: data/faces.shp }} }}
  json: {{ geodata: {{ file: data/faces.geojson }} }}
  gpkg: {{ geodata: {{ file: data/massif.gpkg, layer: faces }} }}
  one: {{ geodata: {{ file: data/faces.shp, where: {{ id: [1, 2] }} }} }}
  named: {{ geodata: {{ file: data/faces.shp, where: {{ name: Crête 1 }} }} }}
  borders: {{ geodata: {{ file: data/lines.shp, labels: kind }} }}
"
    ));
    for (name, close) in [("shp", 1e-3), ("json", 1.0), ("gpkg", 1e-3)] {
        let area = measures(&project, &[name])["area"].as_f64().unwrap();
        assert!((area - 43.2e6).abs() < close, "{name}: {area}");
    }
    let of = |name: &str| measures(&project, &[name])["area"].as_f64().unwrap();
    assert!(of("one") > of("named") && of("named") > 0.0);
    assert!((of("borders") - 43.2e6).abs() < 1.0, "{}", of("borders"));
}

/// What a build of a spec with this map, these regions and fields says, which must fail, at a place in the spec.
fn said(project: &Project, regions: &str, fields: &str) -> String {
    project.write(
        "specs/spec.yaml",
        format!(
            "fretwork: 1
{UTM}
regions:
  sheet: {{ rectangle: {{ width: 7200, height: 6000, at: [735000, 4048500] }} }}
{regions}
partitions:
  rows: {{ stripes: {{ angle: f, spacing: 500 }} }}
fields:
{fields}
artifacts:
  x.svg: {{ from: rows, region: sheet }}
"
        ),
    );
    let done = project.run(&["build"]);
    assert_eq!(done.code, Some(1), "{}", done.stderr);
    assert!(done.stderr.contains("spec.yaml:"), "{}", done.stderr);
    assert!(!std::fs::exists(project.path("out/spec/x.svg")).unwrap());
    done.stderr
}

#[test]
fn wrong_files_are_told_with_their_names() {
    let project = project("fretwork: 1\n");
    let raster = "  f: { raster: { file: data/r.tif } }";
    let massif = &include_bytes!("../../specs/maps/data/massif.tif")[..];
    project.write("specs/data/r.tif", &massif[..massif.len() / 2]);
    let text = said(&project, "", raster);
    assert!(text.contains("r.tif"), "{text}");
    // Bytes of blocks that are no Deflate any more are found where they are read.
    let mut damaged = massif.to_vec();
    let end = damaged.len() - 4096;
    damaged[4096..end].fill(0x55);
    project.write("specs/data/r.tif", damaged);
    let text = said(&project, "", raster);
    assert!(text.contains("r.tif") && text.contains("damaged"), "{text}");
    let attribute = |name: &str| format!("  f: {{ attribute: {{ region: land, name: {name} }} }}");
    let land = "  land: { geodata: { file: data/faces.shp } }";
    let text = said(&project, land, &attribute("orent"));
    assert!(text.contains("`orient`"), "{text}");
    let text = said(&project, land, &attribute("name"));
    assert!(text.contains("a number is needed"), "{text}");
    let text = said(
        &project,
        "  land: { geodata: { file: data/massif.gpkg } }",
        &attribute("gap"),
    );
    assert!(text.contains("faces, lines"), "{text}");
    let text = said(
        &project,
        "  land: { geodata: { file: data/massif.gpkg, layer: face } }",
        &attribute("gap"),
    );
    assert!(text.contains("no layer `face`"), "{text}");
    let text = said(
        &project,
        "  land: { geodata: { file: data/faces.geojson, layer: roads } }",
        &attribute("gap"),
    );
    assert!(text.contains("no layer `roads`"), "{text}");
    let text = said(
        &project,
        "  land: { geodata: { file: data/faces.shp, labels: rok } }",
        &attribute("gap"),
    );
    assert!(text.contains("`rock`"), "{text}");
    project.write(
        "specs/data/faces.dbf",
        &include_bytes!("../../specs/maps/data/faces.dbf")[..700],
    );
    let text = said(&project, land, &attribute("gap"));
    assert!(text.contains("shorter than it says"), "{text}");
    std::fs::remove_file(project.path("specs/data/faces.dbf")).unwrap();
    let text = said(&project, land, &attribute("gap"));
    assert!(
        text.contains("faces.dbf") && text.contains("`gap`"),
        "{text}"
    );
}

#[test]
fn a_map_in_degrees_and_an_unknown_system_are_refused() {
    let project = project("fretwork: 1\n");
    for (crs, reason) in [
        ("EPSG:4326", "degree"),
        ("EPSG:999999", "999999"),
        ("EPSG:2236", "in metres"),
    ] {
        project.write(
            "specs/spec.yaml",
            format!(
                "fretwork: 1
map: {{ crs: \"{crs}\" }}
regions:
  land: {{ geodata: {{ file: data/faces.geojson }} }}
artifacts:
  x.svg: {{ from: land }}
"
            ),
        );
        let done = project.run(&["build"]);
        assert!(
            done.code == Some(1) && done.stderr.contains(reason),
            "{}",
            done.stderr
        );
    }
}

#[test]
fn an_edit_of_a_file_beside_the_map_is_seen() {
    let project = project(&format!(
        "fretwork: 1
{UTM}
regions:
  land: {{ geodata: {{ file: data/faces.shp, where: {{ id: 1 }} }} }}
"
    ));
    let before = measures(&project, &["land"]);
    let mut table = include_bytes!("../../specs/maps/data/faces.dbf").to_vec();
    // The ids of two features change places.
    let head = usize::from(u16::from_le_bytes([table[8], table[9]]));
    let line = usize::from(u16::from_le_bytes([table[10], table[11]]));
    let width = usize::from(table[32 + 16]);
    for i in 0..width {
        table.swap(head + 1 + i, head + line + 1 + i);
    }
    project.write("specs/data/faces.dbf", table);
    assert_ne!(before, measures(&project, &["land"]));
}

/// A GeoJSON text of one feature with these rings, each a polygon of its own or one with holes.
fn feature(crs: &str, kind: &str, coordinates: &str) -> String {
    format!(
        r#"{{"type":"FeatureCollection"{crs},"features":[{{"type":"Feature","properties":{{}},"geometry":{{"type":"{kind}","coordinates":{coordinates}}}}}]}}"#
    )
}

const UTM_MEMBER: &str =
    r#","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32616"}}"#;

/// The faces of a region that is read from this text, and what was said about it.
fn faces(map: &str, json: &str) -> (serde_json::Value, String) {
    let project = project(&format!(
        "fretwork: 1
{map}
regions:
  land: {{ geodata: {{ file: data/x.geojson }} }}
arrangements:
  all: {{ union: [land] }}
"
    ));
    project.write("specs/data/x.geojson", json);
    let done = project.run(&[
        "inspect",
        "specs/spec.yaml",
        "all",
        "--region",
        "land",
        "--format",
        "json",
    ]);
    let measures = serde_json::from_str(&done.stdout).unwrap_or(serde_json::Value::Null);
    (measures, done.stderr)
}

#[test]
fn rings_nest_whatever_their_winding() {
    // A square of 100, a hole of 60 in it and an island of 20 in that, all wound the same way.
    let ring = |side: f64| {
        let (a, b) = (740_000.0 - side / 2.0, 740_000.0 + side / 2.0);
        let (c, d) = (4_050_000.0 - side / 2.0, 4_050_000.0 + side / 2.0);
        format!("[[{a},{c}],[{b},{c}],[{b},{d}],[{a},{d}],[{a},{c}]]")
    };
    let rings = format!("[{},{},{}]", ring(20.0), ring(100.0), ring(60.0));
    let (measures, _) = faces(UTM, &feature(UTM_MEMBER, "Polygon", &rings));
    assert_eq!(measures["faces"], 3, "{measures}");
    let project = project(&format!(
        "fretwork: 1\n{UTM}\nregions:\n  land: {{ geodata: {{ file: data/x.geojson }} }}\n"
    ));
    project.write(
        "specs/data/x.geojson",
        feature(UTM_MEMBER, "Polygon", &rings),
    );
    let area = measures_of_land(&project);
    assert!((area - (10_000.0 - 3600.0 + 400.0)).abs() < 1e-3, "{area}");
}

fn measures_of_land(project: &Project) -> f64 {
    measures(project, &["land"])["area"].as_f64().unwrap()
}

#[test]
fn a_ring_that_crosses_itself_is_even_and_odd_with_a_warning() {
    let bow =
        "[[[740000,4050000],[740200,4050200],[740200,4050000],[740000,4050200],[740000,4050000]]]";
    let (measures, said) = faces(UTM, &feature(UTM_MEMBER, "Polygon", bow));
    assert_eq!(measures["faces"], 2, "{measures} {said}");
    assert!(
        said.contains("crosses itself at (740100, 4050100)"),
        "{said}"
    );
}

#[test]
fn what_the_date_line_cuts_is_one_face_where_it_is_no_border() {
    let halves = "[[[[178,50],[180,50],[180,52],[178,52],[178,50]]],[[[-180,50],[-178,50],[-178,52],[-180,52],[-180,50]]]]";
    let (measures, said) = faces(
        "map: { crs: \"EPSG:3832\" }",
        &feature("", "MultiPolygon", halves),
    );
    assert_eq!(measures["faces"], 1, "{measures} {said}");
}

#[test]
fn longitudes_go_on_beyond_the_date_line_where_it_is_a_border() {
    let square = "[[[178,-18],[181.5,-18],[181.5,-16],[178,-16],[178,-18]]]";
    let (beyond, said) = faces(
        "map: { crs: \"EPSG:3857\" }",
        &feature("", "Polygon", square),
    );
    let far = "[[[-182,-18],[-178.5,-18],[-178.5,-16],[-182,-16],[-182,-18]]]";
    let (west, _) = faces("map: { crs: \"EPSG:3857\" }", &feature("", "Polygon", far));
    let plain = "[[[8,-18],[11.5,-18],[11.5,-16],[8,-16],[8,-18]]]";
    let (plain, _) = faces(
        "map: { crs: \"EPSG:3857\" }",
        &feature("", "Polygon", plain),
    );
    let area = |measures: &serde_json::Value| measures["area"].as_f64().unwrap();
    assert!(
        (area(&beyond) - area(&plain)).abs() < 1.0,
        "{beyond} {plain} {said}"
    );
    assert!((area(&west) - area(&plain)).abs() < 1.0, "{west} {plain}");
    let right = beyond["bounds"][1][0].as_f64().unwrap();
    assert!((right - 20_204_487.579).abs() < 1e-2, "{right}");
}

#[test]
fn vertices_without_a_place_are_told_with_their_feature() {
    let beyond = "[[[0,80],[10,80],[5,95],[0,80]]]";
    let (_, said) = faces(UTM, &feature("", "Polygon", beyond));
    assert!(said.contains("feature 1") && said.contains("95"), "{said}");
    let pole = "[[[0,80],[10,80],[5,90],[0,80]]]";
    let (_, said) = faces("map: { crs: \"EPSG:3395\" }", &feature("", "Polygon", pole));
    assert!(
        said.contains("feature 1") && said.contains("no place"),
        "{said}"
    );
    let (_, said) = faces("map: {}", &feature("", "Polygon", pole));
    assert!(
        said.contains("degree") && said.contains("map: { crs:"),
        "{said}"
    );
}

#[test]
fn a_map_without_a_system_has_that_of_its_inputs() {
    let project = project(
        "fretwork: 1
map: {}
regions:
  land: { geodata: { file: data/faces.shp } }
fields:
  height: { raster: { file: data/massif.tif } }
",
    );
    assert!((measures_of_land(&project) - 43.2e6).abs() < 1e-3);
    project.edit("specs/spec.yaml", "massif.tif", "jacksboro.tif");
    let done = project.run(&["inspect", "specs/spec.yaml", "land"]);
    assert!(
        done.code == Some(1) && done.stderr.contains("jacksboro.tif"),
        "{}",
        done.stderr
    );
}

#[test]
fn a_face_whose_field_has_no_value_stays_empty_with_one_warning() {
    let project = project(&format!(
        "fretwork: 1
{UTM}
regions:
  pond: {{ circle: {{ radius: 200, at: [739515, 4051785] }} }}
partitions:
  rows: {{ stripes: {{ angle: f, spacing: 50 }} }}
fields:
  h: {{ raster: {{ file: data/lake.tif }} }}
  f: {{ derive: {{ from: h, operator: slope }} }}
arrangements:
  x: {{ fill: {{ faces: pond, with: rows }} }}
artifacts:
  x.svg: {{ from: x, region: pond }}
"
    ));
    let done = project.run(&["build"]);
    assert_eq!(done.code, Some(0), "{}", done.stderr);
    assert!(
        done.stderr.contains("no value") && done.stderr.contains("(7395"),
        "{}",
        done.stderr
    );
}

#[test]
fn fields_are_asked_at_places() {
    let project = project(&format!(
        "fretwork: 1
{UTM}
fields:
  height: {{ raster: {{ file: data/massif.tif }} }}
"
    ));
    let found = measures(
        &project,
        &["height", "--at", "735615,4053585", "--at", "0,0"],
    );
    assert!(
        (found["at"][0]["value"].as_f64().unwrap() - 597.98).abs() < 2e-3,
        "{found}"
    );
    assert_eq!(found["at"][1]["value"], serde_json::Value::Null);
    assert_eq!(
        project
            .run(&["inspect", "specs/spec.yaml", "height", "--at", "1"])
            .code,
        Some(2)
    );
}
