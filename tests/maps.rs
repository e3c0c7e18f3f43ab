//! Maps from files to measures: regions from geodata, fields from rasters, attributes, and what is wrong
//! with them.

use super::project::Project;

macro_rules! data {
    ($($name:literal),*) => {
        [$(($name, &include_bytes!(concat!("../specs/maps/data/", $name))[..])),*]
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
    let massif = &include_bytes!("../specs/maps/data/massif.tif")[..];
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
        "  land: { geodata: { file: data/faces.shp, labels: rok } }",
        &attribute("gap"),
    );
    assert!(text.contains("`rock`"), "{text}");
    project.write(
        "specs/data/faces.dbf",
        &include_bytes!("../specs/maps/data/faces.dbf")[..700],
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
    let mut table = include_bytes!("../specs/maps/data/faces.dbf").to_vec();
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

#[test]
fn the_specs_of_the_page_about_maps_build() {
    let page = include_str!("../schemas/maps.md");
    let specs = page.split("```yaml\n").skip(1);
    let specs = specs.filter_map(|rest| rest.split("```").next());
    let mut count = 0;
    for spec in specs {
        let project = project(spec);
        let island = include_bytes!("../specs/maps/data/island.geojson");
        project.write("specs/data/island.geojson", island);
        let done = project.run(&["build"]);
        assert!(
            done.code == Some(0) && !done.stderr.contains('⚠'),
            "{}",
            done.stderr
        );
        count += 1;
    }
    assert_eq!(count, 4);
}

#[test]
fn points_that_bound_nothing_are_told() {
    let point =
        r#"{"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[10,20]}}"#;
    let line = r#"{"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":[[0,0],[9,9]]}}"#;
    let run = |features: &str| {
        let project = project(&format!(
            "fretwork: 1\n{UTM}\nregions:\n  land: {{ geodata: {{ file: data/points.geojson }} }}\n\
             artifacts:\n  x.geojson: {{ from: land, crs: map }}\n"
        ));
        let crs = r#""crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32616"}}"#;
        let file = format!(r#"{{"type":"FeatureCollection",{crs},"features":[{features}]}}"#);
        project.write("specs/data/points.geojson", file);
        project.run(&["build"])
    };
    let alone = run(point);
    assert!(
        alone.code == Some(1) && alone.stderr.contains("points alone"),
        "{}",
        alone.stderr
    );
    let both = run(&format!("{point},{line}"));
    assert!(
        both.code == Some(0) && both.stderr.contains("are left out: 1"),
        "{}",
        both.stderr
    );
}

/// A country of which one province has a lake that is no part of it.
const COUNTRY: &str = r#"{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32616"}},"features":[
{"type":"Feature","properties":{"name":"west"},"geometry":{"type":"Polygon","coordinates":[[[0,0],[100,0],[100,100],[0,100],[0,0]],[[30,30],[30,70],[70,70],[70,30],[30,30]]]}},
{"type":"Feature","properties":{"name":"east"},"geometry":{"type":"Polygon","coordinates":[[[100,0],[200,0],[200,100],[100,100],[100,0]]]}}]}"#;

#[test]
fn a_lake_is_neither_masked_nor_filled() {
    let project = project(&format!(
        "fretwork: 1
{UTM}
regions:
  country: {{ geodata: {{ file: data/country.geojson }} }}
  page: {{ rectangle: {{ width: 220, height: 120, at: [-10, -10] }} }}
partitions:
  rows: {{ stripes: {{ angle: 90, spacing: 20, anchor: origin, edge_labels: row }} }}
arrangements:
  masked: {{ inside: {{ input: rows, mask: country }} }}
  filled: {{ fill: {{ faces: country, with: rows }} }}
  lines:
    map:
      edges: filled
      with: \"def row(e):\\n  return to_curve(e) if has_label(e, 'row') else nothing()\\n\"
artifacts:
  x.svg: {{ from: masked, region: page }}
"
    ));
    project.write("specs/data/country.geojson", COUNTRY);
    // Rows stand at 10, 30, … 190; in the lake from 30 to 70 half of the height of three of them is missing, of which
    // those at its sides run along its shore.
    let length = |node: &str| {
        measures(&project, &[node, "--region", "page"])["length"]
            .as_f64()
            .expect("a length")
    };
    let (masked, filled) = (length("masked"), length("lines"));
    assert!((masked - 960.0).abs() < 1e-3, "{masked}");
    assert!((filled - 880.0).abs() < 81.0, "{filled}");
}

#[test]
fn curves_beyond_their_reach_are_told_with_the_cell() {
    let spec = |reach: &str| {
        format!(
            "fretwork: 1
{UTM}
regions:
  page: {{ rectangle: {{ width: 40, height: 20 }} }}
partitions:
  net: {{ grid: {{ across: {{ spacing: 10 }}, along: {{ angle: 90, spacing: 10 }}, border: keep_inside, anchor: [5, 5] }} }}
arrangements:
  moved: {{ vary: {{ faces: net, with: \"def f(c):\\n  return translate(contour(c), point(12, 0))\\n\"{reach} }} }}
artifacts:
  x.geojson: {{ from: moved, region: page, crs: map }}
"
        )
    };
    let done = project(&spec(", reach: 5")).run(&["build"]);
    assert_eq!(done.code, Some(1));
    for said in [
        "reaches 12",
        "`reach: 5`",
        "the face at (5, 5)",
        "spec.yaml:",
    ] {
        assert!(done.stderr.contains(said), "{said}: {}", done.stderr);
    }
    assert_eq!(project(&spec(", reach: 12")).run(&["build"]).code, Some(0));
    // `vary` promises the diagonal without being asked.
    assert_eq!(project(&spec("")).run(&["build"]).code, Some(0));
    let far = spec("").replace("point(12", "point(15");
    let done = project(&far).run(&["build"]);
    assert!(
        done.code == Some(1) && done.stderr.contains("diagonal"),
        "{}",
        done.stderr
    );
}

/// Hatching by an attribute and by heights, in artifacts of their own, through a mapper.
const EDITED: &str = "regions:
  sheet: { rectangle: { width: 7200, height: 6000, at: [735000, 4048500] } }
  massif: { geodata: { file: data/faces.shp } }
fields:
  height: { raster: { file: data/massif.tif } }
  gap: { attribute: { region: massif, name: gap } }
  orient: { attribute: { region: massif, name: orient } }
partitions:
  rows: { stripes: { angle: 30, spacing: gap } }
  turned: { stripes: { angle: orient, spacing: 90 } }
  cells: { uniform: { cell_size: 600 } }
arrangements:
  spaced: { fill: { faces: massif, with: rows } }
  aimed: { fill: { faces: massif, with: turned } }
  high: { map: { faces: cells, with: { script: high.star, entry: high, args: { height: height } } } }
artifacts:
  spaced.geojson: { from: spaced, region: sheet, crs: map }
  aimed.geojson: { from: aimed, region: sheet, crs: map }
  high.geojson: { from: high, region: sheet, crs: map }
";

const HIGH: &str = "def high(height):
    def keep(face):
        z = height(face)
        return contour(face) if z != None and z > 600 else nothing()
    return keep
";

/// The names of the nodes that a build evaluates, and the artifacts that it writes.
fn ran(project: &Project) -> (Vec<String>, Vec<String>) {
    let report = project.succeed(&["build", "--format", "json"]);
    let report: serde_json::Value = serde_json::from_str(&report).expect("a report");
    let of = |list: &str, status: &str, key: &str| -> Vec<String> {
        let all = report[list].as_array().expect("a list").iter();
        let meant = all.filter(|one| one["status"] == status);
        meant
            .map(|one| one[key].as_str().expect("a name").to_string())
            .collect()
    };
    (
        of("nodes", "evaluated", "name"),
        of("artifacts", "written", "path"),
    )
}

#[test]
fn an_edit_of_the_data_reaches_what_reads_it_and_nothing_else() {
    let project = project(&format!("fretwork: 1\n{UTM}\n{EDITED}"));
    project.write("specs/high.star", HIGH);
    assert_eq!(ran(&project).1.len(), 3);
    assert_eq!(ran(&project), (vec![], vec![]));
    // The first digit of one value in the column `gap`.
    let mut table = include_bytes!("../specs/maps/data/faces.dbf").to_vec();
    let header = usize::from(u16::from_le_bytes([table[8], table[9]]));
    let (mut at, mut offset) = (32, 1);
    while !table[at..].starts_with(b"gap\0") {
        offset += usize::from(table[at + 16]);
        at += 32;
    }
    let field = header + offset;
    let width = usize::from(table[at + 16]);
    let first = (field..field + width).find(|byte| table[*byte].is_ascii_digit());
    let digit = first.expect("the first value is a number");
    table[digit] = if table[digit] == b'7' { b'3' } else { b'7' };
    project.write("specs/data/faces.dbf", table);
    let (nodes, written) = ran(&project);
    assert_eq!(written, ["spec/spaced.geojson"]);
    assert!(nodes.contains(&"spaced".to_string()), "{nodes:?}");
    assert!(!nodes.contains(&"high".to_string()), "{nodes:?}");
    // Another raster.
    project.write(
        "specs/data/massif.tif",
        include_bytes!("../specs/maps/data/lake.tif"),
    );
    let (nodes, written) = ran(&project);
    assert_eq!(written, ["spec/high.geojson"]);
    assert!(
        nodes.contains(&"high".to_string()) && !nodes.contains(&"spaced".to_string()),
        "{nodes:?}"
    );
    // A comment in a script changes no file.
    project.write("specs/high.star", format!("# Only what is high.\n{HIGH}"));
    assert_eq!(ran(&project).1, Vec::<String>::new());
}

/// The lines of a GeoJSON file, a feature a line.
fn drawn(project: &Project, name: &str) -> Vec<(String, Vec<[f64; 2]>)> {
    let path = project.path(&format!("out/spec/{name}"));
    let text = std::fs::read_to_string(path).expect("it was written");
    let features = text
        .lines()
        .filter(|line| line.starts_with("{\"type\":\"Feature\""));
    let points = |line: &str| -> Vec<[f64; 2]> {
        let json: serde_json::Value =
            serde_json::from_str(line.trim_end_matches(',')).expect("a feature");
        let all = json["geometry"]["coordinates"]
            .as_array()
            .expect("coordinates")
            .iter();
        all.map(|p| [0, 1].map(|i| p[i].as_f64().expect("a number")))
            .collect()
    };
    features
        .map(|line| (line.trim_end_matches(',').to_string(), points(line)))
        .collect()
}

#[test]
fn what_a_field_changes_within_a_window_changes_nothing_beyond_the_reach() {
    let mut random = super::project::Random(23);
    for _ in 0..4 {
        let (x, y) = (random.below(3000) as f64, random.below(2000) as f64);
        let (half, reach) = (100.0 + random.below(300) as f64, 80.0);
        let spec = |hill: f64| {
            format!(
                "fretwork: 1
map: {{}}
seed: {}
regions:
  sheet: {{ rectangle: {{ width: 3000, height: 2000 }} }}
fields:
  height: {{ expression: {{ value: \"100 + x / 40 + {hill} * max(0, 1 - max(abs(x - {x}), abs(y - {y})) / {half})\" }} }}
partitions:
  cells: {{ uniform: {{ cell_size: 60 }} }}
arrangements:
  strokes:
    map:
      faces: cells
      with: {{ script: stroke.star, entry: strokes, args: {{ height: height }} }}
      reach: {reach}
artifacts:
  strokes.geojson: {{ from: strokes, region: sheet, crs: map }}
",
                random.0 % 1000
            )
        };
        let script = "def strokes(height):
    def one(face):
        z = height(centroid(face))
        return scale(contour(face), min(z / 500, 1.0))
    return one
";
        let build = |hill: f64| {
            let project = project(&spec(hill));
            project.write("specs/stroke.star", script);
            project.succeed(&["build"]);
            drawn(&project, "strokes.geojson")
        };
        let (before, after) = (build(0.0), build(90.0));
        // A cell that touches the window is not larger than twice the size asked for, and reaches so far.
        let far = |line: &(String, Vec<[f64; 2]>)| {
            line.1.iter().all(|p| {
                let distance = (p[0] - x).abs().max((p[1] - y).abs()) - half;
                distance > reach + 120.0
            })
        };
        let lines = |all: &[(String, Vec<[f64; 2]>)], is_far: bool| -> Vec<String> {
            let some = all.iter().filter(|line| far(line) == is_far);
            some.map(|line| line.0.clone()).collect()
        };
        assert!(lines(&before, true).len() > 500);
        assert_eq!(lines(&before, true), lines(&after, true));
        assert_ne!(lines(&before, false), lines(&after, false));
    }
}
