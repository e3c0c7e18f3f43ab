//! Cuts of a window in an order that follows from what lies in it alone: what is near a window was drawn in another order than
//! the whole, and what encloses the window is not known. Coordinates stay as they are.

use super::fixed_point::{self, Cell};
use super::layer::{Item, Layer, Sheet};
use super::lines::outlines;
use super::optimize::{Job, Outlines, steps};
use super::style::Role;
use super::unite::united;

/// The sheet with its cuts after all that is engraved and drawn: of these what is inside of closed lines of the sheet before
/// those, whatever layers they are on, else the layers by name and the lines of a layer as they are. A sheet with filled layers
/// is a picture, whose layers stay in paint order.
pub fn inside_first(sheet: &Sheet) -> Sheet {
    if sheet.layers.iter().any(|layer| layer.style.fill.is_some()) {
        return sheet.clone();
    }
    let is_cut = |layer: &Layer| layer.role == Role::Cut;
    let (cuts, mut layers): (Vec<Layer>, Vec<Layer>) =
        sheet.layers.iter().cloned().partition(is_cut);
    let mut cuts = united(&sheet.with(cuts));
    cuts.layers.sort_by(|a, b| a.name.cmp(&b.name));
    let around = Outlines::of(&cuts);
    let jobs: Vec<Job> = (0..cuts.layers.len())
        .map(|number| job(&cuts, number, &around))
        .collect();
    let group: Vec<usize> = (0..jobs.len()).collect();
    for (number, only) in steps(&jobs, &group) {
        let (layer, job) = (&cuts.layers[number], &jobs[number]);
        let mut order: Vec<usize> = (0..layer.items.len()).collect();
        order.retain(|&i| only.is_none_or(|only| only == job.lines[i].0));
        order.sort_by_key(|&i| std::cmp::Reverse(job.lines[i].0));
        let items = order.into_iter().map(|i| layer.items[i].clone());
        layers.push(layer.with(items.collect()));
    }
    sheet.with(layers)
}

/// The items of a layer as a job, one line for each: its outer one.
fn job(sheet: &Sheet, number: usize, around: &Outlines) -> Job {
    let mut job = Job::default();
    let line = |item: &Item| -> Vec<Cell> {
        let outer = outlines(item).pop().unwrap_or_default();
        fixed_point::cells(&outer, sheet.unit_mm)
    };
    for line in sheet.layers[number].items.iter().map(line) {
        let owners = around.owners(&line);
        job.around.extend(&owners);
        job.lines.push((owners.len(), line));
    }
    job.around.remove(&number);
    job
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Style;
    use fretwork_geometry::Point;

    fn square(low: f64, high: f64) -> Item {
        let corners = [
            [low, low],
            [high, low],
            [high, high],
            [low, high],
            [low, low],
        ];
        Item::Line(corners.map(Point::from).to_vec())
    }

    fn layer(name: &str, role: Role, items: &[Item]) -> Layer {
        Layer {
            name: name.into(),
            role,
            style: Style::outline(1.0),
            items: items.to_vec(),
        }
    }

    #[test]
    fn what_is_inside_is_cut_first_whatever_the_order_was() {
        let sheet = |layers: Vec<Layer>| Sheet {
            page: None,
            unit_mm: 1.0,
            layers,
        };
        let (outer, middle, inner) = (square(0.0, 9.0), square(1.0, 8.0), square(2.0, 3.0));
        let open = Item::Line(vec![Point::new(4.0, 4.0), Point::new(5.0, 4.0)]);
        let drawn = layer("drawn", Role::Draw, std::slice::from_ref(&open));
        let whole = sheet(vec![
            layer("b", Role::Cut, &[outer.clone(), open.clone()]),
            drawn.clone(),
            layer("a", Role::Cut, &[middle.clone(), inner.clone()]),
        ]);
        let apart = sheet(vec![
            layer("a", Role::Cut, std::slice::from_ref(&middle)),
            layer("b", Role::Cut, &[outer.clone(), open.clone()]),
            layer("a", Role::Cut, std::slice::from_ref(&inner)),
            drawn.clone(),
        ]);
        let shown = |sheet: &Sheet| -> Vec<(String, Vec<Item>)> {
            let layers = inside_first(sheet).layers.into_iter();
            layers.map(|l| (l.name.to_string(), l.items)).collect()
        };
        let expected = [
            ("drawn".to_string(), vec![open.clone()]),
            ("a".to_string(), vec![inner]),
            ("b".to_string(), vec![open]),
            ("a".to_string(), vec![middle]),
            ("b".to_string(), vec![outer]),
        ];
        assert_eq!(shown(&whole), expected);
        assert_eq!(shown(&apart), expected);
    }
}
