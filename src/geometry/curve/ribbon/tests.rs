//! Frames and mitres of strips.

use super::*;

fn helix() -> SpaceCurve {
    let at = |i: usize| {
        let a = i as f64 * 0.02;
        Point3::new(20.0 * libm::cos(a), 20.0 * libm::sin(a), 3.0 * a)
    };
    SpaceCurve::new((0..800).map(at), false).unwrap()
}

fn assert_orthonormal(f: Frame) {
    for (a, b) in [
        (f.tangent, f.across),
        (f.across, f.normal),
        (f.normal, f.tangent),
    ] {
        assert!(
            a.dot(b).abs() < 1e-12 && (a.length() - 1.0).abs() < 1e-12,
            "{f:?}"
        );
    }
    assert!(f.tangent.cross(f.across).distance(f.normal) < 1e-12);
}

#[test]
fn frames_are_orthonormal_and_smooth() {
    let knots = [
        [0., 0., 0.],
        [80., 60., 40.],
        [0., 140., 90.],
        [-90., 60., 140.],
        [0., 0., 200.],
    ]
    .map(Point3::from);
    for closed in [false, true] {
        let curve = SpaceCurve::spline(&knots, closed).unwrap();
        for across in [Across::Plane, Across::Normal] {
            let ribbon = Ribbon::new(curve.clone(), across, false).unwrap();
            let n = 4000;
            let frames: Vec<Frame> = (0..=n)
                .map(|i| ribbon.frame(curve.length() * f64::from(i) / f64::from(n)))
                .collect();
            frames.iter().for_each(|&f| assert_orthonormal(f));
            let step = frames
                .windows(2)
                .map(|w| w[0].across.dot(w[1].across))
                .fold(1.0, f64::min);
            assert!(step > 0.98, "{closed} {across:?} {step}");
            if closed {
                assert!(frames[0].across.dot(frames[frames.len() - 1].across) > 0.995);
            }
        }
    }
}

#[test]
fn minimal_frames_turn_less_about_the_curve_than_any_other() {
    // The frame of least rotation does not turn about the tangent: what the normal changes by has no part across.
    let ribbon = Ribbon::new(helix(), Across::Normal, false).unwrap();
    for i in 1..790 {
        let (a, b) = (
            ribbon.frame(i as f64 * 0.4),
            ribbon.frame(i as f64 * 0.4 + 0.4),
        );
        let about = a.across.cross(b.across).dot(a.tangent);
        assert!(about.abs() < 2e-4, "{about}");
    }
}

#[test]
fn the_outer_side_is_away_from_the_middle_however_the_curve_runs() {
    let arc = |from: f64, to: f64| SpaceCurve::arc(10.0, from, to).unwrap();
    for curve in [
        SpaceCurve::circle(10.0).unwrap(),
        arc(0.0, 5.0),
        arc(5.0, 0.0),
    ] {
        for flip in [false, true] {
            let ribbon = Ribbon::new(curve.clone(), Across::Normal, flip).unwrap();
            let out = ribbon.place(3.0, 0.0, ribbon.outward());
            assert!((out.length() - 11.0).abs() < 0.01, "{flip} {out:?}");
            let flat = Ribbon::new(curve.clone(), Across::Plane, flip).unwrap();
            assert!((flat.place(3.0, 0.0, flat.outward()).z - 1.0).abs() < 1e-9);
        }
    }
    let line = SpaceCurve::new(
        vec![Point3::new(0.0, 0.0, 0.0), Point3::new(9.0, 0.0, 0.0)],
        false,
    );
    let ribbon = Ribbon::new(line.unwrap(), Across::Normal, false).unwrap();
    assert_eq!(ribbon.outward(), 1.0);
}

#[test]
fn across_is_left_of_open_curves_and_outward_on_closed_ones() {
    let line = SpaceCurve::new([Point3::ORIGIN, Point3::new(10.0, 0.0, 0.0)], false).unwrap();
    let ribbon = Ribbon::new(line.clone(), Across::Plane, false).unwrap();
    assert_eq!(ribbon.place(4.0, 2.0, 0.5), Point3::new(4.0, 2.0, 0.5));
    assert_eq!(
        Ribbon::new(line, Across::Plane, true)
            .unwrap()
            .place(4.0, 2.0, 0.0),
        Point3::new(4.0, -2.0, 0.0)
    );
    let circle = SpaceCurve::circle(10.0).unwrap();
    let p = Ribbon::new(circle.clone(), Across::Plane, false)
        .unwrap()
        .place(0.0, 2.0, 0.0);
    assert!(p.distance(Point3::new(12.0, 0.0, 0.0)) < 1e-3);
    let up = Ribbon::new(circle, Across::Normal, false).unwrap();
    assert!(up.place(3.0, 2.0, 0.0).z == 2.0 && up.plane().is_none());
}

#[test]
fn corners_are_mitred() {
    let corner = [
        Point3::ORIGIN,
        Point3::new(10.0, 0.0, 0.0),
        Point3::new(10.0, 10.0, 0.0),
    ];
    let ribbon = Ribbon::new(
        SpaceCurve::new(corner, false).unwrap(),
        Across::Plane,
        false,
    )
    .unwrap();
    assert!(
        ribbon
            .place(10.0, 1.0, 0.0)
            .distance(Point3::new(9.0, 1.0, 0.0))
            < 1e-12
    );
    assert!(
        ribbon
            .place(10.0, -1.0, 0.0)
            .distance(Point3::new(11.0, -1.0, 0.0))
            < 1e-12
    );
    assert_eq!(ribbon.fold(19.0), None);
}

#[test]
fn too_high_a_strip_folds_where_the_curve_is_sharpest() {
    let ribbon = Ribbon::new(SpaceCurve::circle(10.0).unwrap(), Across::Plane, false).unwrap();
    assert_eq!(ribbon.fold(19.9), None);
    assert!((ribbon.fold(21.0).unwrap().height - 20.0).abs() < 1e-3);
}

#[test]
fn impossible_directions_are_refused() {
    let line = SpaceCurve::new([Point3::ORIGIN, Point3::new(0.0, 0.0, 9.0)], false).unwrap();
    let along = Across::Direction(Point3::new(0.0, 0.0, 1.0));
    assert!(matches!(
        Ribbon::new(line.clone(), along, false),
        Err(RibbonError::Parallel(_))
    ));
    assert_eq!(
        Ribbon::new(line, Across::Surface, false),
        Err(RibbonError::NoSurface)
    );
}

#[test]
fn twist_turns_the_frame() {
    let line = SpaceCurve::new(
        [
            Point3::ORIGIN,
            Point3::new(5.0, 0.0, 0.0),
            Point3::new(10.0, 0.0, 0.0),
        ],
        false,
    );
    let twisted = line
        .unwrap()
        .twisted(vec![(0.0, 0.0), (1.0, std::f64::consts::FRAC_PI_2)]);
    let ribbon = Ribbon::new(twisted, Across::Plane, false).unwrap();
    assert!(
        ribbon
            .frame(10.0)
            .across
            .distance(Point3::new(0.0, 0.0, 1.0))
            < 1e-12
    );
    assert!(ribbon.plane().is_none());
}
