//! Areas of real countries in projections of every kind, beside those of the same corners in PROJ 9.5.1.

use super::{measures, project};

/// Names, codes of systems, square metres. Of the projections: Lambert conformal, Mercator, transverse Mercator, polar
/// stereographic, Lambert azimuthal, cylindrical equal-area, oblique Mercator, Albers.
const RECORDED: [(&str, u32, f64); 9] = [
    ("Belgium", 3812, 30_123_594_137.2),
    ("Brazil", 3395, 9_002_223_598_312.7),
    // Two of its islands lie across the date line, which is inside of this system.
    ("Fiji", 3832, 21_153_615_122.2),
    ("Germany", 25832, 357_392_355_094.8),
    ("Greenland", 3413, 2_181_916_914_059.3),
    ("Poland", 3035, 310_397_369_229.3),
    ("South Africa", 6933, 1_216_331_845_075.8),
    ("Switzerland", 2056, 46_189_127_616.9),
    ("United States of America", 5070, 9_510_420_770_314.7),
];

#[test]
fn areas_of_countries_are_those_of_proj() {
    for (name, code, expected) in RECORDED {
        let project = project(&format!(
            "fretwork: 1
map: {{ crs: \"EPSG:{code}\" }}
regions:
  land: {{ geodata: {{ file: data/countries.geojson, where: {{ name: {name} }} }} }}
artifacts:
  land.geojson: {{ from: land, crs: map, draw: filled }}
"
        ));
        let countries = include_bytes!("data/countries.geojson");
        project.write("specs/data/countries.geojson", countries);
        let found = measures(&project, &["land"])["area"].as_f64().unwrap();
        assert!(
            (found / expected - 1.0).abs() < 1e-7,
            "{name} in EPSG:{code}: {found} and {expected}"
        );
    }
}
