//! The stress in patterns that are joined, that their stress is taken from, and that no long ways lead through beside that: the
//! table of the page about shells, by the full analysis of each body.
//!
//! The source gives for its own model, kPa: under the profile's gravity a mean of 16.4, 5.68 and 5.42, and 154, 31.7 and 30.5 that 99 %
//! stay below; under gravity from the side 87.0, 23.5, 20.1 and 694, 186, 146. It says that means fall three times
//! and the 99th percentile 4.8 times.

use std::sync::Arc;

use fretwork::engine::MemoryWorld;

use super::jobs::built;
use super::shell_pictures::{Picture, png, waves};
use crate::Bench;

const SPEC: &str = r#"fretwork: 1
seed: 1
exemplars:
  picture: { image: { file: picture.png, pixel_size: 0.5, solid: { darker_than: 0.5 }, feature_radius: 1.5, tileable: true } }
surfaces:
  body: { revolve: { profile: [[30, 0], [42, 40], [34, 100]], segments: 96 } }
force_profiles:
  standing: { material: abs, supports: [ { lowest: 4mm } ], gravity: [0, 0, -1], max_stress: "8kPa" }
  aside: { material: abs, supports: [ { lowest: 4mm } ], gravity: [1, 0, 0] }
shells:
  joined: { surface: body, exemplar: picture, voxel: 0.8, thickness: 2, min_feature: 1.6, keep_solid: [ { lowest: 3mm } ] }
  strong: { surface: body, exemplar: picture, voxel: 0.8, thickness: 2, min_feature: 1.6, keep_solid: [ { lowest: 3mm } ], force_profile: standing, analysis: false }
  guarded: { surface: body, exemplar: picture, voxel: 0.8, thickness: 2, min_feature: 1.6, keep_solid: [ { lowest: 3mm } ], force_profile: standing, geodesic_limit: 1.5, analysis: false }
analyses:
  joined_standing: { of: joined, force_profile: standing, voxel: 0.65 }
  strong_standing: { of: strong, force_profile: standing, voxel: 0.65 }
  guarded_standing: { of: guarded, force_profile: standing, voxel: 0.65 }
  joined_aside: { of: joined, force_profile: aside, voxel: 0.65 }
  strong_aside: { of: strong, force_profile: aside, voxel: 0.65 }
  guarded_aside: { of: guarded, force_profile: aside, voxel: 0.65 }
artifacts:
  joined_standing.json: { from: joined_standing }
  strong_standing.json: { from: strong_standing }
  guarded_standing.json: { from: guarded_standing }
  joined_aside.json: { from: joined_aside }
  strong_aside.json: { from: strong_aside }
  guarded_aside.json: { from: guarded_aside }
"#;

/// Runs the benchmarks named `shell table: ...`.
pub fn run(bench: &Bench) {
    let pictures: [(&str, Picture); 2] = [("bands", bands), ("waves", waves)];
    for (name, picture) in pictures {
        let world = || {
            let mut world = MemoryWorld::default();
            world.files.insert("s.yaml".into(), SPEC.into());
            world.files.insert("picture.png".into(), png(picture));
            Arc::new(world)
        };
        bench.run(&format!("shell table: {name}"), world, table);
    }
}

/// Straight bands.
fn bands(_: f64, y: f64) -> bool {
    (6.0 * y).rem_euclid(1.0) < 0.45
}

/// For each gravity and figure the three bodies in kPa, and how many times less the last has than the first.
fn table(world: &Arc<MemoryWorld>) -> String {
    let files = match built(world, "s.yaml", 2) {
        Ok(files) => files,
        Err(said) => return said,
    };
    let figure = |body: &str, gravity: &str, field: &str| {
        let name = format!("{body}_{gravity}.json");
        let file = files.iter().find(|(path, _)| path.ends_with(&name));
        let text = &file.expect("each analysis has a file").1;
        let json: serde_json::Value = serde_json::from_slice(text).expect("it is JSON");
        json["stress"][field].as_f64().expect("a body has stress") / 1000.0
    };
    let mut told = String::new();
    for gravity in ["standing", "aside"] {
        for field in ["mean", "p99"] {
            let row = ["joined", "strong", "guarded"].map(|body| figure(body, gravity, field));
            let factor = row[0] / row[2];
            told += &format!("\n    {gravity} {field}: {row:.3?}, {factor:.1} times less");
        }
    }
    told
}
