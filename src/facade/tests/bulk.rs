//! Facades of many kinds: retargeting from the smallest canvas to ten times its size, groups,
//! counters of both axes, masks, hidden shapes, and figures of time.

use std::time::Instant;

use crate::layout::lay_out;
use fretwork_geometry::FacadeLayout;

use super::Sketch;

fn house(width: f64) -> Sketch {
    Sketch::new(width)
        .symbols(&[
            "A 0.8 opaque",
            "B 1.2 opaque unoccludable",
            "C 0.6",
            "D 1.4",
        ])
        .layer("walls", "A(BA)^k")
        .layer("corners", "cec; c = C")
}

/// What holds for every layout.
fn sound(layout: &FacadeLayout) {
    let slack = 1e-7 * layout.width;
    for borders in [&layout.x, &layout.y] {
        assert!(borders.windows(2).all(|pair| pair[0] < pair[1]));
    }
    assert_eq!(
        (layout.x[0], *layout.x.last().expect("borders")),
        (0.0, layout.width)
    );
    for cell in &layout.cells {
        assert!(
            cell.width > 0.0 && cell.x >= -slack && cell.x + cell.width <= layout.width + slack
        );
        let same = layout
            .cells
            .iter()
            .find(|other| other.symbol_x == cell.symbol_x);
        assert!(
            same.is_some_and(|other| (other.width - cell.width).abs() <= slack),
            "one size a symbol"
        );
        let on = |x: f64| {
            layout
                .cells
                .iter()
                .any(|c| (c.x - x).abs() < slack || (c.x + c.width - x).abs() < slack)
        };
        assert!(on(cell.x));
    }
}

#[test]
fn retargeting_gives_sensible_layouts_at_all_widths() {
    // The smallest word is two walls and a window.
    let mut counts = Vec::new();
    for tenth in 17..=280 {
        let width = f64::from(tenth) / 10.0;
        let layout = house(width).solve();
        sound(&layout);
        let windows = layout
            .cells
            .iter()
            .filter(|c| c.layer == 0 && c.symbol_x == 'B')
            .count();
        let ideal = (width - 0.8) / 2.0;
        assert!(
            (windows as f64 - ideal).abs() <= 1.0,
            "{width}: {windows} windows"
        );
        let corners: Vec<_> = layout.cells.iter().filter(|c| c.layer == 1).collect();
        assert!(
            corners.len() == 2
                && corners[0].x == 0.0
                && (corners[1].x + corners[1].width - width).abs() < 1e-9
        );
        counts.push(windows);
    }
    let (first, last) = (counts.first().copied(), counts.last().copied());
    assert_eq!((first, last), (Some(1), Some(14)));
}

#[test]
fn groups_are_aligned_apart_and_share_sizes() {
    let mut sketch = Sketch::new(12.0)
        .symbols(&["A 2 opaque", "B 1 opaque", "C 3 opaque"])
        .layer("low", "A(BA)^k")
        .layer("high", "CB^n");
    sketch.0.layers[1].groups[0] = "other".into();
    let layout = sketch.solve();
    let width = |layer: u32| {
        layout
            .cells
            .iter()
            .find(|c| c.layer == layer && c.symbol_x == 'B')
            .map(|c| c.width)
    };
    assert!((width(0).expect("B") - width(1).expect("B")).abs() < 1e-9);
    assert!(layout.columns() > 8);
}

#[test]
fn a_counter_of_both_axes_has_one_value() {
    let mut sketch = Sketch::new(8.0)
        .symbols(&["A 2 opaque", "B 3 opaque"])
        .grid("wall", "A^k", "B^k");
    sketch.0.canvas[1] = 12.0;
    let layout = sketch.solve();
    assert_eq!(
        (layout.columns(), layout.rows(), layout.size_error),
        (4, 4, 0.0)
    );
    sketch.0.canvas[1] = 9.0;
    let layout = sketch.solve();
    assert_eq!(layout.columns(), layout.rows());
}

#[test]
fn hidden_shapes_are_told() {
    let sketch = Sketch::new(8.0)
        .symbols(&["A 2 opaque", "D 4 opaque", "C 2"])
        .layer("wall", "AAAA")
        .layer("door", "ede; d = D")
        .layer("lamp", "fcf; c = C");
    let layout = sketch.solve();
    let hidden = layout.hidden();
    let of = |layer: u32| {
        layout
            .cells
            .iter()
            .zip(&hidden)
            .filter(|(c, h)| c.layer == layer && **h)
            .count()
    };
    let all = layout.cells.iter().filter(|c| c.layer == 0).count();
    assert_eq!((all, of(0), of(1), of(2)), (4, 2, 0, 0));
    assert_eq!(layout.clone().culled().cells.len(), layout.cells.len() - 2);
    let text = serde_json::to_string(&layout).expect("JSON");
    assert_eq!(
        serde_json::from_str::<FacadeLayout>(&text).expect("a layout"),
        layout
    );
}

#[test]
fn the_order_of_attributes_does_not_matter_to_the_result() {
    let first = house(9.3).solve();
    assert_eq!(first, house(9.3).solve());
}

#[test]
fn lone_layers_of_ten_thousand_letters() {
    let sketch = Sketch::new(10_000.0)
        .symbols(&["A 1 opaque", "B 2 opaque"])
        .layer("wall", "A(BA)^k");
    let start = Instant::now();
    let layout = sketch.solve();
    assert!(
        layout.columns() > 5000,
        "{} after {:?}",
        layout.columns(),
        start.elapsed()
    );
    assert!(lay_out(&sketch.0).is_ok());
}

/// Layers of an apartment house whose sizes do not go together, with free counters and wildcards.
fn apartments(width: f64, layers: usize) -> Sketch {
    let symbols = [
        "A 1.3 opaque",
        "B 1.7 opaque",
        "C 0.9",
        "D 2.1 opaque",
        "E 1.1",
        "H 1.9",
    ];
    let patterns = [
        "A(BA)^k",
        "cec; c = C",
        "vcwcv; c = H",
        "fdf; d = D",
        "(pq)^mp; q = E",
        "oho; h = C",
        "s(ct)^2; c = H",
        "xcy; c = H",
    ];
    let all = patterns.iter().take(layers).enumerate();
    all.fold(Sketch::new(width).symbols(&symbols), |sketch, (n, text)| {
        sketch.layer(&format!("layer{n}"), text)
    })
}

#[test]
fn a_loosely_sized_apartment_house_ends_with_a_layout() {
    for (width, layers) in [
        (31.7, 5),
        (31.7, 6),
        (31.7, 7),
        (31.7, 8),
        (20.0, 8),
        (25.0, 8),
        (40.0, 8),
        (50.0, 8),
    ] {
        let sketch = apartments(width, layers);
        let (layout, warnings) =
            lay_out(&sketch.0).unwrap_or_else(|problems| panic!("{width} {layers}: {problems:?}"));
        sound(&layout);
        assert!(
            layout.alignment_error < 0.15 * width,
            "{width} {layers}: {}",
            layout.alignment_error
        );
        let [warning] = &warnings[..] else {
            panic!("{warnings:?}")
        };
        assert!(warning.message.contains("cut short"), "{warning:?}");
        assert!(
            warning
                .help
                .as_ref()
                .is_some_and(|help| help.contains("`k`, `m`")),
            "{warning:?}"
        );
    }
}

#[test]
fn wildcards_that_contradict_each_other_are_told_at_once() {
    // One `e` cannot be as long as the canvas without C and without C and H.
    let sketch = apartments(31.7, 1)
        .layer("corners", "cec; c = C")
        .layer("pillars", "cdcec; c = C; d = H");
    assert!(sketch.complain().contains("cannot be aligned along x"));
}
