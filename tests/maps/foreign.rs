//! Maps from files as other programs write them: files beside files, systems without codes, poles and the date line, and
//! files that are cut.

use super::{UTM, UTM_MEMBER, feature, measures, project};
use crate::project::Project;

fn geojson(project: &Project, name: &str) -> serde_json::Value {
    let text = std::fs::read_to_string(project.path(&format!("out/spec/{name}"))).unwrap();
    serde_json::from_str(&text).unwrap()
}

#[test]
fn a_file_that_appears_beside_another_is_seen() {
    let spec = format!(
        "fretwork: 1
{UTM}
regions:
  land: {{ geodata: {{ file: data/late.shp }} }}
artifacts:
  x.geojson: {{ from: land, region: land, draw: filled, crs: map }}
"
    );
    let project = project(&spec);
    let massif =
        |ending: &str| std::fs::read(project.path(&format!("specs/data/faces.{ending}"))).unwrap();
    project.write("specs/data/late.shp", massif("shp"));
    let properties = || geojson(&project, "x.geojson")["features"][0]["properties"].clone();
    project.succeed(&["build"]);
    assert!(properties().get("rock").is_none());
    // Capitals, and some of them, are other names of the same files.
    for name in ["late.Dbf", "late.dBF", "late.DBF"] {
        project.write(&format!("specs/data/{name}"), massif("dbf"));
        project.succeed(&["build"]);
        assert!(
            properties().get("rock").is_some(),
            "{name}: {}",
            properties()
        );
        if name != "late.DBF" {
            std::fs::remove_file(project.path(&format!("specs/data/{name}"))).unwrap();
        }
    }
    project.write("specs/data/late.prj", "PROJCS[");
    assert_eq!(project.run(&["build"]).code, Some(1));
    project.write("specs/data/late.prj", massif("prj"));
    project.succeed(&["build"]);
    std::fs::remove_file(project.path("specs/data/late.DBF")).unwrap();
    project.succeed(&["build"]);
    assert!(properties().get("rock").is_none());
}

#[test]
fn a_system_without_a_code_is_named_where_it_has_one() {
    let project = project(
        "fretwork: 1
map: {}
regions:
  land: { geodata: { file: data/faces.shp } }
artifacts:
  x.geojson: { from: land, region: land, crs: map }
",
    );
    project.succeed(&["build"]);
    let name = &geojson(&project, "x.geojson")["crs"]["properties"]["name"];
    assert_eq!(name, "urn:ogc:def:crs:EPSG::32616");
    let odd = "+proj=tmerc +lon_0=-86.9 +k=0.9996 +x_0=500000 +datum=WGS84";
    project.edit(
        "specs/spec.yaml",
        "map: {}",
        &format!("map: {{ crs: \"{odd}\" }}"),
    );
    let done = project.run(&["build"]);
    assert!(done.stderr.contains("no EPSG code"), "{}", done.stderr);
    assert!(geojson(&project, "x.geojson").get("crs").is_none());
}

#[test]
fn borders_of_faces_have_the_labels_of_the_lines_along_them() {
    let project = project(&format!(
        "fretwork: 1
{UTM}
regions:
  land: {{ geodata: {{ file: data/land.geojson }} }}
  ridges: {{ geodata: {{ file: data/ridges.geojson, labels: kind }} }}
arrangements:
  all: {{ union: [land, ridges] }}
artifacts:
  x.geojson: {{ from: all, region: land, crs: map }}
  x.svg: {{ from: all, region: land, style: {{ ridge: {{ stroke: \"#ff0000\" }} }} }}
"
    ));
    let square = |x: u32| {
        let ring = format!("[[[{x},0],[{0},0],[{0},100],[{x},100],[{x},0]]]", x + 100);
        let whole = feature(UTM_MEMBER, "Polygon", &ring);
        let (_, one) = whole.split_once("\"features\":[").expect("a list");
        one.trim_end_matches("]}").to_string()
    };
    let head = format!(r#"{{"type":"FeatureCollection"{UTM_MEMBER},"features":["#);
    let land = format!("{head}{},{}]}}", square(0), square(100));
    project.write("specs/data/land.geojson", land);
    // It leaves the border, and begins within a side.
    let ridge = feature(UTM_MEMBER, "LineString", "[[100,20],[100,100],[150,150]]");
    let ridge = ridge.replace("\"properties\":{}", "\"properties\":{\"kind\":\"ridge\"}");
    project.write("specs/data/ridges.geojson", ridge);
    project.succeed(&["build"]);
    let mut lengths = [0.0, 0.0];
    for feature in geojson(&project, "x.geojson")["features"]
        .as_array()
        .unwrap()
    {
        let is_ridge = feature["properties"]["labels"][0] == "ridge";
        let points = feature["geometry"]["coordinates"].as_array().unwrap();
        let points: Vec<[f64; 2]> = points
            .iter()
            .map(|p| [p[0].as_f64().unwrap(), p[1].as_f64().unwrap()])
            .collect();
        for w in points.windows(2) {
            lengths[usize::from(is_ridge)] += (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1]);
        }
    }
    assert!(
        (lengths[1] - (80.0 + 50.0 * 2f64.sqrt())).abs() < 1e-3,
        "{lengths:?}"
    );
    assert!((lengths[0] - 620.0).abs() < 1e-3, "{lengths:?}");
    let svg = std::fs::read_to_string(project.path("out/spec/x.svg")).unwrap();
    assert!(svg.contains("ff0000") || svg.contains("f00"), "{svg}");
}

#[test]
fn a_face_around_a_pole_is_in_the_file_of_degrees() {
    let project = project(
        "fretwork: 1
map: { crs: \"EPSG:3031\" }
regions:
  cap: { circle: { radius: 2000000 } }
artifacts:
  x.geojson: { from: cap, region: cap, draw: filled }
",
    );
    project.succeed(&["build"]);
    let found = geojson(&project, "x.geojson");
    assert_eq!(found["features"].as_array().unwrap().len(), 1);
    let ring = found["features"][0]["geometry"]["coordinates"][0]
        .as_array()
        .unwrap();
    let has = |x: f64, y: f64| ring.iter().any(|p| p[0] == x && p[1] == y);
    assert!(has(180.0, -90.0) && has(-180.0, -90.0), "{ring:?}");
}

/// A raster in degrees whose pixels are moved so that it begins at this longitude.
fn moved(west: f64) -> Vec<u8> {
    let mut bytes = include_bytes!("../../specs/maps/data/jacksboro.tif").to_vec();
    // The tie point: three zeros, then the place of the first corner.
    let zeros = [0; 24];
    let tie = bytes.windows(32).position(|w| {
        let place = f64::from_le_bytes(w[24..].try_into().unwrap());
        w[..24] == zeros && (-84.5..-84.3).contains(&place)
    });
    let at = tie.expect("the file says where it lies") + 24;
    bytes[at..at + 8].copy_from_slice(&west.to_le_bytes());
    bytes
}

#[test]
fn a_raster_across_the_date_line_has_its_values_on_either_side() {
    let project = project(
        "fretwork: 1
map: { crs: \"EPSG:3832\" }
fields:
  height: { raster: { file: data/pacific.tif } }
  slope: { derive: { from: height, operator: slope } }
",
    );
    let side = 111_319.490_793;
    let values = |west: f64, node: &str, east: &[f64]| -> Vec<Option<f64>> {
        project.write("specs/data/pacific.tif", moved(west));
        let places = east
            .iter()
            .map(|d| format!("{},4352200", (d - 150.0) * side));
        let args: Vec<String> = places.flat_map(|p| ["--at".to_string(), p]).collect();
        let args: Vec<&str> = [node]
            .into_iter()
            .chain(args.iter().map(|a| &**a))
            .collect();
        let found = measures(&project, &args);
        let found = found["at"].as_array().expect("a list").iter();
        found.map(|one| one["value"].as_f64()).collect()
    };
    // The same ground, far from the date line, across it, and called by its other name.
    for node in ["height", "slope"] {
        let known = values(170.0, node, &[170.02, 170.1, 170.12]);
        assert!(known.iter().all(Option::is_some), "{known:?}");
        for (west, east) in [
            (179.9, 179.9),
            (-180.1, 179.9),
            (185.0, 185.0),
            (-175.0, 185.0),
        ] {
            let found = values(west, node, &[east + 0.02, east + 0.1, east + 0.12]);
            for (found, known) in found.iter().zip(&known) {
                let (found, known) = (found.unwrap_or(f64::NAN), known.unwrap_or(f64::NAN));
                assert!(
                    (found - known).abs() < 1e-3,
                    "{west} {node}: {found}, not {known}"
                );
            }
        }
    }
}

#[test]
fn a_picture_lies_somewhere_on_a_map() {
    let picture = include_bytes!("../../specs/shells/assets/ripples.png");
    let project = project(&format!(
        "fretwork: 1
{UTM}
fields:
  tone: {{ raster: {{ file: data/tone.png }} }}
"
    ));
    project.write("specs/data/tone.png", picture);
    let done = project.run(&["inspect", "specs/spec.yaml", "tone", "--at", "1,-1"]);
    assert!(
        done.code == Some(1) && done.stderr.contains("georeference"),
        "{}",
        done.stderr
    );
    project.write("specs/data/tone.pgw", "10\n0\n0\n-10\n5\n-5\n");
    project.succeed(&["inspect", "specs/spec.yaml", "tone", "--at", "1,-1"]);
}

#[test]
fn a_shapefile_that_is_cut_between_records_is_refused() {
    let project = project(&format!(
        "fretwork: 1\n{UTM}\nregions:\n  land: {{ geodata: {{ file: data/faces.shp }} }}\n"
    ));
    let whole = std::fs::read(project.path("specs/data/faces.shp")).unwrap();
    let words = u32::from_be_bytes(whole[104..108].try_into().unwrap()) as usize;
    let first = &whole[..108 + 2 * words];
    project.write("specs/data/faces.shp", first);
    let done = project.run(&["inspect", "specs/spec.yaml", "land"]);
    assert!(
        done.code == Some(1) && done.stderr.contains("truncated"),
        "{}",
        done.stderr
    );
    // Where the head says so too, the table has more to tell.
    let mut first = first.to_vec();
    let length = (first.len() / 2) as u32;
    first[24..28].copy_from_slice(&length.to_be_bytes());
    project.write("specs/data/faces.shp", first);
    let done = project.run(&["inspect", "specs/spec.yaml", "land"]);
    assert!(
        done.code == Some(0) && done.stderr.contains("1 feature, and"),
        "{}",
        done.stderr
    );
}

#[test]
fn nothing_to_read_is_told_with_what_was_asked() {
    let project = project(&format!(
        "fretwork: 1\n{UTM}\nregions:\n  land: {{ geodata: {{ file: data/faces.shp, where: {{ rock: 77 }} }} }}\n"
    ));
    let told = |project: &Project| {
        let done = project.run(&["inspect", "specs/spec.yaml", "land"]);
        assert_eq!(done.code, Some(1), "{}", done.stderr);
        done.stderr
    };
    let text = told(&project);
    assert!(
        text.contains("no feature of") && text.contains("faces.shp"),
        "{text}"
    );
    project.edit(
        "specs/spec.yaml",
        "data/faces.shp, where: { rock: 77 }",
        "data/x.geojson",
    );
    project.write(
        "specs/data/x.geojson",
        r#"{"type":"FeatureCollection","features":[]}"#,
    );
    let text = told(&project);
    assert!(
        text.contains("x.geojson") && text.contains("no features"),
        "{text}"
    );
    let beyond = r#"{"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":[[80,0],[81,0]]}},{"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":[[0,1],[0,95]]}}]}"#;
    project.write("specs/data/x.geojson", beyond);
    let text = told(&project);
    assert!(
        text.contains("feature 2") && text.contains("latitude 95"),
        "{text}"
    );
}

#[test]
fn the_tiles_of_the_web_are_known_by_any_name_of_its_system() {
    let project = project("fretwork: 1\n");
    for crs in [
        "epsg:3857",
        "urn:ogc:def:crs:EPSG::3857",
        "+proj=merc +a=6378137 +b=6378137 +lat_ts=0 +lon_0=0 +x_0=0 +y_0=0 +k=1 +units=m +nadgrids=@null +wktext +no_defs",
    ] {
        project.write(
            "specs/spec.yaml",
            format!(
                "fretwork: 1
map: {{ crs: \"{crs}\" }}
regions:
  sheet: {{ rectangle: {{ width: 1000, height: 1000 }} }}
artifacts:
  x.geojson: {{ from: sheet, region: sheet }}
"
            ),
        );
        project.succeed(&["build", "--tile", "1/1/0"]);
        let tile = geojson(&project, "x/1/1/0.geojson");
        assert!(!tile["features"].as_array().unwrap().is_empty(), "{crs}");
    }
}

#[test]
fn places_are_told_in_plain_words_too() {
    let project = project(&format!(
        "fretwork: 1\n{UTM}\nfields:\n  height: {{ raster: {{ file: data/massif.tif }} }}\n"
    ));
    let asked = ["--at", "735615,4053585", "--at", "0,0"];
    let args = [&["inspect", "specs/spec.yaml", "height"], &asked[..]].concat();
    let text = project.succeed(&args);
    assert!(text.contains("(735615, 4053585)  value 597.98"), "{text}");
    assert!(text.contains("(0, 0)  value none"), "{text}");
}
