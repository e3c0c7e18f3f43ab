//! Path data of SVG.

use crate::sheet::arc_fit::{self, Circle, Stretch};
use crate::sheet::fixed_point::{self, Cell};
use crate::sheet::lines::is_closed;

/// Appends the path data of one polyline, with arcs where its corners lie on them if `has_arcs`;
/// nothing when it has no extent.
pub fn push(out: &mut String, line: &[Cell], has_arcs: bool) {
    if line.len() < 2 {
        return;
    }
    let is_closed = is_closed(line);
    let mut path = Path {
        out,
        at: line[0],
        command: 'M',
    };
    if has_arcs
        && is_closed
        && let Some(circle) = arc_fit::circle(line)
    {
        return path.circle(circle);
    }
    path.begin(line[0]);
    let mut stretches = if has_arcs {
        arc_fit::stretches(line)
    } else {
        line[1..]
            .iter()
            .map(|&end| Stretch { end, arc: None })
            .collect()
    };
    // Closing the path draws its last straight stretch.
    if is_closed && stretches.last().is_some_and(|last| last.arc.is_none()) {
        stretches.pop();
    }
    stretches.iter().for_each(|stretch| path.go(stretch));
    if is_closed {
        path.out.push('Z');
    }
}

/// Path data as it grows.
struct Path<'a> {
    out: &'a mut String,
    at: Cell,
    command: char,
}

impl Path<'_> {
    fn begin(&mut self, at: Cell) {
        self.out.push('M');
        self.numbers(&[at.0, at.1]);
    }

    fn go(&mut self, stretch: &Stretch) {
        let end = stretch.end;
        match stretch.arc {
            Some(arc) => self.arc(arc.radius, arc.bulge > 0.0, end),
            None if end.1 == self.at.1 => {
                self.command('H');
                self.numbers(&[end.0]);
            }
            None if end.0 == self.at.0 => {
                self.command('V');
                self.numbers(&[end.1]);
            }
            None => {
                self.command('L');
                self.numbers(&[end.0, end.1]);
            }
        }
        self.at = end;
    }

    /// A letter begins a run of one command; more numbers go on with it.
    fn command(&mut self, command: char) {
        self.out.push(if command == self.command {
            ' '
        } else {
            command
        });
        self.command = command;
    }

    fn numbers(&mut self, numbers: &[i64]) {
        for (i, number) in numbers.iter().enumerate() {
            if i > 0 {
                self.out.push(' ');
            }
            fixed_point::push(self.out, *number);
        }
    }

    /// An arc of less than half a circle, turning from the x axis to the y axis if `is_positive`.
    fn arc(&mut self, radius: i64, is_positive: bool, end: Cell) {
        self.command('A');
        self.numbers(&[radius, radius]);
        *self.out += if is_positive { " 0 0 1 " } else { " 0 0 0 " };
        self.numbers(&[end.0, end.1]);
    }

    /// A circle, as two halves.
    fn circle(&mut self, circle: Circle) {
        let (x, y) = circle.center;
        self.begin((x - circle.radius, y));
        self.arc(circle.radius, true, (x + circle.radius, y));
        self.arc(circle.radius, true, (x - circle.radius, y));
        self.out.push('Z');
    }
}
