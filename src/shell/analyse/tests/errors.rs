//! What cannot be analysed is told, and never solved.

use fretwork_geometry::{Bounds3, Point3};

use super::super::{
    AcrossLayers, AnalysisError, Body, Case, Load, Material, MemoryLimit, Model, Zone, analyse,
};
use super::{ABS, block, millimetres, on_floor, set};

fn error_of(material: Material, case: Case) -> Option<AnalysisError> {
    let voxels = block([2, 2, 3]);
    analyse(&millimetres(&voxels), &material, &on_floor, &[case]).err()
}

#[test]
fn a_body_without_voxels_or_supports_is_refused() {
    let none = set(Vec::new());
    let found = analyse(&millimetres(&none), &ABS, &on_floor, &[]);
    assert_eq!(found, Err(AnalysisError::Empty));
    let voxels = block([2, 2, 3]);
    let nowhere = |_: Point3| false;
    let found = analyse(&millimetres(&voxels), &ABS, &nowhere, &[]);
    assert_eq!(found, Err(AnalysisError::NothingSupported));
}

#[test]
fn a_load_that_misses_is_told_by_its_number() {
    let above = |p: Point3| p.z > 5.0;
    let loads = [&on_floor as super::super::Places, &above].map(|at| Load {
        at,
        force: [1.0; 3],
    });
    let case = Case {
        loads: loads.to_vec(),
        ..Case::default()
    };
    let found = error_of(ABS, case).unwrap();
    assert_eq!(found, AnalysisError::LoadMisses { load: 1 });
    assert_eq!(found.to_string(), "load 2 catches no part of the body");
}

#[test]
fn impossible_constants_are_named() {
    let layers = |strength, direction| {
        Some(AcrossLayers {
            strength,
            direction,
        })
    };
    let changed: [(&str, fn(&mut Material)); 7] = [
        ("Young's modulus cannot be 0", |m| m.youngs_modulus = 0.0),
        ("Young's modulus cannot be NaN", |m| {
            m.youngs_modulus = f64::NAN
        }),
        ("Poisson's ratio cannot be 0.5", |m| m.poisson_ratio = 0.5),
        ("Poisson's ratio cannot be -1", |m| m.poisson_ratio = -1.0),
        ("density cannot be -1", |m| m.density = -1.0),
        ("density cannot be inf", |m| m.density = f64::INFINITY),
        ("yield strength cannot be 0", |m| {
            m.yield_strength = Some(0.0)
        }),
    ];
    for (message, change) in changed {
        let mut material = ABS;
        change(&mut material);
        let found = error_of(material, Case::default()).unwrap();
        assert_eq!(found.to_string(), message);
    }
    for (strength, direction) in [(0.0, [1.0; 3]), (0.5, [0.0; 3])] {
        let material = Material {
            across_layers: layers(strength, direction),
            ..ABS
        };
        assert!(error_of(material, Case::default()).is_some());
    }
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    let case = Case {
        gravity: [0.0, f64::NAN, 0.0],
        loads: Vec::new(),
    };
    assert!(matches!(
        error_of(ABS, case),
        Some(AnalysisError::Value {
            what: "gravity",
            ..
        })
    ));
    let everywhere = |_: Point3| true;
    let loads = vec![Load {
        at: &everywhere,
        force: [0.0, 0.0, f64::INFINITY],
    }];
    let case = Case {
        loads,
        ..Case::default()
    };
    assert!(matches!(
        error_of(ABS, case),
        Some(AnalysisError::Value {
            what: "a force",
            ..
        })
    ));
    let voxels = block([1, 1, 1]);
    let body = Body {
        voxels: &voxels,
        metres_per_unit: 0.0,
    };
    assert!(analyse(&body, &ABS, &on_floor, &[]).is_err());
}

#[test]
fn what_does_not_fit_is_refused_with_an_estimate() {
    let voxels = block([20, 20, 20]);
    let error =
        |limit: u64| Model::new(&millimetres(&voxels), &ABS, &on_floor, MemoryLimit(limit)).err();
    // By the voxels, then by the nodes, then by the factor, what was too much before being allowed.
    let mut limit = 1_000_000;
    for _ in 0..3 {
        let Some(AnalysisError::TooLarge { voxels, bytes, .. }) = error(limit) else {
            panic!("{limit} bytes are too few");
        };
        assert!(voxels == 8000 && bytes > limit, "{bytes}");
        limit = bytes;
    }
    assert!(error(limit).is_none());
    let message = error(1_000_000).unwrap().to_string();
    assert!(
        message.contains("more than 1 MB: use larger voxels"),
        "{message}"
    );
}

#[test]
fn zones_hold_their_borders() {
    let voxels = block([4, 4, 10]);
    let bounds = millimetres(&voxels).bounds();
    assert_eq!(bounds.size(), Point3::new(4.0, 4.0, 10.0));
    let zone = Bounds3 {
        min: Point3::new(1.0, 1.0, 1.0),
        max: Point3::new(2.0, 2.0, 3.0),
    };
    let ball = Zone::Ball {
        center: Point3::new(0.0, 0.0, 5.0),
        radius: 2.0,
    };
    let at = Point3::new;
    for (zone, inside, outside) in [
        (
            Zone::Lowest(3.0),
            at(9.0, 0.0, 3.0 + 1e-10),
            at(0.0, 0.0, 3.1),
        ),
        (
            Zone::Highest(3.0),
            at(0.0, 9.0, 7.0 - 1e-10),
            at(0.0, 0.0, 6.9),
        ),
        (Zone::Box(zone), at(1.0, 2.0, 3.0), at(1.0, 2.1, 3.0)),
        (ball, at(0.0, 2.0, 5.0), at(0.0, 1.5, 6.5)),
    ] {
        assert!(zone.contains(inside, &bounds), "{zone:?}");
        assert!(!zone.contains(outside, &bounds), "{zone:?}");
    }
}
