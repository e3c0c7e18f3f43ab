//! What is refused, and how.

use super::*;
use crate::synthesize::SynthesizeError;

#[test]
fn exemplars_that_show_nothing_are_refused() {
    let levels = sphere();
    let refused = |change: fn(&mut Pixels)| {
        let mut exemplar = exemplars::dots();
        change(&mut exemplar);
        Synthesizer::new(&levels, &exemplar, &Options::default()).err()
    };
    assert_eq!(refused(|_| ()), None);
    assert_eq!(
        refused(|e| e.solid.fill(true)),
        Some(SynthesizeError::AllSolid)
    );
    assert_eq!(
        refused(|e| e.solid.fill(false)),
        Some(SynthesizeError::AllEmpty)
    );
    let small = SynthesizeError::TooSmall {
        width: 4.0,
        height: 4.0,
        voxel: levels[0].surface.voxels.lattice.pitch,
    };
    assert_eq!(refused(|e| e.pixel_size = 0.0625), Some(small));
    let nothing = SynthesizeError::PixelSize { pixel_size: 0.0 };
    assert_eq!(refused(|e| e.pixel_size = 0.0), Some(nothing));
    let is_no_picture = |e| matches!(e, Some(SynthesizeError::NoPicture { .. }));
    assert!(is_no_picture(refused(|e| e.width = 0)));
    assert!(is_no_picture(refused(|e| e.width = 63)));
    assert!(is_no_picture(refused(|e| e.rgb.truncate(64))));
}

#[test]
fn options_of_another_surface_are_refused() {
    let levels = sphere();
    let exemplar = exemplars::dots();
    let refused = |options: Options| Synthesizer::new(&levels, &exemplar, &options).err();
    let plain = Options::default;
    let is_count = |e| matches!(e, Some(SynthesizeError::Count { given: 3, .. }));
    assert!(is_count(refused(Options {
        keep: vec![true; 3],
        ..plain()
    })));
    let orientation = Some(vec![[1.0, 0.0, 0.0]; 3]);
    assert!(is_count(refused(Options {
        orientation,
        ..plain()
    })));
    let jitter = SynthesizeError::Jitter { jitter: 2.0 };
    assert_eq!(
        refused(Options {
            jitter: 2.0,
            ..plain()
        }),
        Some(jitter)
    );
    let up = [f32::NAN, 0.0, 0.0];
    assert_eq!(
        refused(Options { up, ..plain() }),
        Some(SynthesizeError::Direction)
    );
    let synthesizer = Synthesizer::new(&levels, &exemplar, &plain()).unwrap();
    let pattern = synthesizer.synthesize();
    assert!(is_count(
        synthesizer.resynthesize(&pattern, &[true; 3]).err()
    ));
    let nothing = Synthesizer::new(&[], &exemplar, &plain()).err();
    assert_eq!(nothing, Some(SynthesizeError::NoVoxels));
}
