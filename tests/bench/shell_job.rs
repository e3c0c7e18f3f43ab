//! Whole shells from their spec to their files, nothing remembered: pictures of the kinds that the source measures, its
//! gravity, its loop with a limit of stress and one of lengths, the wall and its full analysis.
//!
//! The source gives 14.6, 40 and 52 s for keyboard, hooks and an anisotropic exemplar at 256, on its authors' machine. The
//! peak is that of the process: run one by its name to have its own.

use std::sync::Arc;

use fretwork::engine::MemoryWorld;

use super::analyse::{peak_megabytes, processor_seconds};
use super::jobs::build;
use super::shell_pictures::{PICTURES, png};
use crate::Bench;

/// A lampshade with a picture on it.
const SPEC: &str = r#"fretwork: 1
seed: 1
exemplars:
  picture: { image: { file: picture.png, pixel_size: 0.5, solid: { darker_than: 0.5 }, feature_radius: 1.5, tileable: TILES } }
surfaces:
  body: { revolve: { profile: [[26, 0], [36, 35], [38, 60], [26, 100]], segments: 120 } }
force_profiles:
  standing: { material: abs, supports: [ { lowest: 4mm } ], gravity: [0, 0, -1], max_stress: "40kPa" }
shells:
  shade: { surface: body, exemplar: picture, resolution: RESOLUTION, thickness: 2, min_feature: 1.6, geodesic_limit: 1.5, keep_solid: [ { lowest: 3mm } ], force_profile: standing, analysis: ANALYSIS }
artifacts:
  shade.stl: { from: shade }
  shade.json: { from: shade }
"#;

/// Runs the benchmarks named `shell job: ...`.
pub fn run(bench: &Bench) {
    for (name, tiles, picture) in PICTURES {
        let of = |resolution: u32, analysis: bool| {
            let text = SPEC
                .replace("TILES", &tiles.to_string())
                .replace("RESOLUTION", &resolution.to_string())
                .replace("ANALYSIS", &analysis.to_string());
            let mut world = MemoryWorld::default();
            world.files.insert("s.yaml".into(), text.into_bytes());
            world.files.insert("picture.png".into(), png(picture));
            Arc::new(world)
        };
        let measured = |world: &Arc<MemoryWorld>| {
            let begin = processor_seconds();
            let said = build(world, "s.yaml", 2);
            let spent = processor_seconds() - begin;
            format!(
                "{said}, {spent:.1} s of processor, peak {:.0} MB",
                peak_megabytes()
            )
        };
        for resolution in [128, 256, 512] {
            let title = format!("shell job: {name} at {resolution}");
            bench.run(&title, || of(resolution, true), measured);
            let title = format!("shell job: {name} at {resolution}, not analysed");
            bench.run(&title, || of(resolution, false), measured);
        }
    }
}
