//! Which cells a moulding runs through as one.

use std::collections::BTreeMap;

use super::bend::Bend;
use fretwork_geometry::facade::{Moulding, Run};
use fretwork_geometry::{Facade, FacadeBody, FacadeCell, Polygon};

/// The difference of two places along a facade that are one, as a part of its width.
const SAME_PLACE: f64 = 1e-7;

/// The cells at which mouldings begin, by number, each as long as its moulding runs: over neighbours in
/// its layer with the same moulding, the same extent across and the same turn. A cell without a visible
/// area ends a run. The other cells of a run are not listed.
pub fn runs(facade: &Facade, areas: &[Vec<Polygon>]) -> BTreeMap<usize, FacadeCell> {
    let mut lanes: BTreeMap<_, Vec<usize>> = BTreeMap::new();
    for (number, cell) in facade.layout.cells.iter().enumerate() {
        let Some(moulding) = moulding(facade, number).filter(|_| !areas[number].is_empty()) else {
            continue;
        };
        let across = match moulding.run {
            Run::Row => [cell.y, cell.height],
            Run::Column | Run::Frame => [cell.x, cell.width],
        };
        let turn = [cell.mirrored_x, cell.mirrored_y];
        let kind = (cell.layer, facade.shape_of[number], turn);
        let lane = lanes.entry((kind, across.map(f64::to_bits)));
        lane.or_default().push(number);
    }
    let mut runs = BTreeMap::new();
    for mut lane in lanes.into_values() {
        let cells = &facade.layout.cells;
        lane.sort_by(|a, b| {
            let (a, b) = (&cells[*a], &cells[*b]);
            a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
        });
        join(facade, &lane, &mut runs);
    }
    runs
}

fn moulding(facade: &Facade, cell: usize) -> Option<&Moulding> {
    match &facade.shape(cell)?.body {
        FacadeBody::Moulding(moulding) => Some(moulding),
        _ => None,
    }
}

/// Joins the cells of one lane, which are in order, where they touch.
fn join(facade: &Facade, lane: &[usize], runs: &mut BTreeMap<usize, FacadeCell>) {
    let slack = SAME_PLACE * facade.layout.width;
    let mut begin = None;
    for number in lane {
        let cell = &facade.layout.cells[*number];
        let run = moulding(facade, *number).map(|moulding| moulding.run);
        let before: Option<&mut FacadeCell> = begin.and_then(|begin| runs.get_mut(begin));
        match (run, before) {
            (Some(Run::Row), Some(before)) if (before.x + before.width - cell.x).abs() <= slack => {
                before.width = cell.x + cell.width - before.x;
            }
            (Some(Run::Column), Some(before))
                if (before.y + before.height - cell.y).abs() <= slack =>
            {
                before.height = cell.y + cell.height - before.y;
            }
            _ => {
                runs.insert(*number, cell.clone());
                begin = Some(number);
            }
        }
    }
}

/// Whether a row takes the whole way around a facade that meets itself.
pub fn is_ring(facade: &Facade, bend: &Bend, run: &FacadeCell) -> bool {
    let slack = SAME_PLACE * facade.layout.width;
    bend.is_around() && run.x <= slack && run.width >= facade.layout.width - slack
}
