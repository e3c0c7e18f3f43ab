//! From the layout of an axis to positions: the borders of its columns and the places of its letters.

use super::contest::{Aligned, Layout};
use crate::align::place::Entry;
use crate::candidate::axis_task::AxisTask;
use crate::candidate::words::Word;

/// Borders that are nearer than this part of the canvas are one: they differ by rounding only.
const SAME_BORDER: f64 = 1e-7;

/// A letter in its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// The number of its symbol.
    pub symbol: usize,
    /// Whether it is mirrored.
    pub mirrored: bool,
    /// Its begin, in the unit of the canvas.
    pub start: f64,
    /// Its end, in the unit of the canvas.
    pub end: f64,
}

/// Where everything lies along an axis.
pub struct Positions {
    /// The borders between columns of all groups, from 0 to the side of the canvas.
    pub borders: Vec<f64>,
    /// The solid letters of each line.
    pub lines: Vec<Vec<Placed>>,
}

/// The positions of a layout.
pub fn positions(task: &AxisTask, layout: &Layout) -> Positions {
    let mut lines = vec![Vec::new(); task.lines.len()];
    let mut borders = Vec::new();
    for (group, aligned) in layout.groups.iter().enumerate() {
        let own = borders_of(task, aligned, &layout.sizes.of);
        let members = task
            .lines
            .iter()
            .enumerate()
            .filter(|(_, line)| line.group == group);
        let columns = Columns {
            aligned,
            borders: &own,
            sizes: &layout.sizes.of,
        };
        for ((number, _), (row, word)) in members.zip(&aligned.lines) {
            lines[number] = columns.letters(*row, word);
        }
        borders.extend(own);
    }
    borders.sort_by(f64::total_cmp);
    borders.dedup_by(|b, a| *b - *a < task.canvas * SAME_BORDER);
    Positions { borders, lines }
}

/// The borders of a group's columns.
fn borders_of(task: &AxisTask, aligned: &Aligned, sizes: &[f64]) -> Vec<f64> {
    let mut borders = vec![0.0];
    let mut end = 0.0;
    for pair in aligned.path.windows(2) {
        let mut rows = aligned.network.rows.iter().enumerate();
        let length =
            rows.find_map(
                |(i, row)| match aligned.network.entry(i, pair[0][i], pair[1][i]) {
                    Entry::Solid(a, b) => {
                        let letters = row.letters[a..b].iter();
                        Some(letters.map(|letter| sizes[letter.symbol]).sum::<f64>())
                    }
                    _ => None,
                },
            );
        end += length.unwrap_or(0.0);
        borders.push(end);
    }
    if let Some(last) = borders.last_mut() {
        *last = task.canvas;
    }
    borders
}

/// The columns of a group.
struct Columns<'a> {
    aligned: &'a Aligned,
    borders: &'a [f64],
    sizes: &'a [f64],
}

impl Columns<'_> {
    /// The solid letters of a line, which is read as this row.
    fn letters(&self, row: usize, word: &Word) -> Vec<Placed> {
        let mut placed = Vec::new();
        let columns = self.aligned.path.windows(2).zip(self.borders.windows(2));
        for (pair, border) in columns {
            let entry = self.aligned.network.entry(row, pair[0][row], pair[1][row]);
            let Entry::Solid(from, to) = entry else {
                continue;
            };
            let mut start = border[0];
            for i in from..to {
                let symbol = word.measured[i].symbol;
                let end = if i + 1 == to {
                    border[1]
                } else {
                    start + self.sizes[symbol]
                };
                placed.push(Placed {
                    symbol,
                    mirrored: word.letters[i].mirrored,
                    start,
                    end,
                });
                start = end;
            }
        }
        placed
    }
}
