//! SVG: the size in millimetres, one group per layer, which Inkscape shows as a layer, one path
//! per item. A user unit is a millimetre, the plane is unflipped. No dates, no program's name: the
//! same sheet gives the same bytes.

use std::collections::BTreeSet;
use std::fmt::Write;

use crate::sheet::fixed_point::{self, Cell};
use crate::sheet::lines::is_closed;
use crate::sheet::{Item, Layer, Role, Sheet, Style};
use fretwork_geometry::Point;

/// The file. Coordinates are written to 10^-4 mm; of what is not a number or out of range
/// ([`Sheet::check`]) nothing sensible is written.
pub fn write(sheet: &Sheet) -> Vec<u8> {
    render(sheet, 0.0, 1)
}

/// The file for a renderer: lines are at least `width` mm wide, and up to a thousand of them share
/// a path element, so that a million are no burden.
pub(crate) fn preview(sheet: &Sheet, width: f64) -> Vec<u8> {
    render(sheet, width, 1000)
}

fn render(sheet: &Sheet, least_width: f64, shared: usize) -> Vec<u8> {
    let page = sheet.page_mm();
    let mut out = String::from(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" ",
    );
    out += "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\"";
    let [x, y, w, h] = [page.min.x, page.min.y, page.width(), page.height()].map(number);
    out += &format!(" width=\"{w}mm\" height=\"{h}mm\" viewBox=\"{x} {y} {w} {h}\"");
    out += " stroke-linecap=\"round\" stroke-linejoin=\"round\">\n";
    let mut ids = BTreeSet::new();
    for layer in &sheet.layers {
        open_group(
            &mut out,
            layer,
            &unique_id(&layer.name, &mut ids),
            least_width,
        );
        let shared = if layer.style.fill.is_some() {
            1
        } else {
            shared
        };
        for items in layer.items.chunks(shared) {
            push_items(&mut out, items, layer.style, sheet.unit_mm);
        }
        out += "</g>\n";
    }
    out += "</svg>\n";
    out.into_bytes()
}

fn open_group(out: &mut String, layer: &Layer, id: &str, least_width: f64) {
    let role = match layer.role {
        Role::Cut => "cut",
        Role::Engrave => "engrave",
        Role::Draw => "draw",
    };
    let name = escaped(&layer.name);
    *out += &format!(
        "<g id=\"{id}\" inkscape:groupmode=\"layer\" inkscape:label=\"{name}\" data-role=\"{role}\""
    );
    match layer.style.fill {
        Some(color) => *out += &format!(" fill=\"{color}\" fill-rule=\"evenodd\""),
        None => *out += " fill=\"none\"",
    }
    if let Some(pen) = layer.style.stroke {
        *out += &format!(
            " stroke=\"{}\" stroke-width=\"{}\"",
            pen.color,
            number(pen.width.max(least_width))
        );
    }
    *out += ">\n";
}

/// Appends one path element for all `items`.
fn push_items(out: &mut String, items: &[Item], style: Style, unit_mm: f64) {
    let begin = out.len();
    *out += "<path d=\"";
    let empty = out.len();
    let mut open = false;
    for item in items {
        match item {
            Item::Line(points) => {
                open = !is_closed(points);
                let ring = if open {
                    &points[..]
                } else {
                    &points[..points.len() - 1]
                };
                push_path(out, ring, !open, unit_mm);
            }
            Item::Area(polygon) => polygon
                .rings()
                .for_each(|ring| push_path(out, ring, true, unit_mm)),
        }
    }
    if out.len() == empty {
        out.truncate(begin);
        return;
    }
    *out += if open && style.fill.is_some() {
        "\" fill=\"none\"/>\n"
    } else {
        "\"/>\n"
    };
}

/// Appends the path data of one polyline; nothing when it has no extent.
fn push_path(out: &mut String, points: &[Point], closed: bool, unit_mm: f64) {
    let mut cells: Vec<Cell> = points
        .iter()
        .map(|&p| fixed_point::cell(p, unit_mm))
        .collect();
    cells.dedup();
    if closed && cells.len() > 1 && cells.first() == cells.last() {
        cells.pop();
    }
    if cells.len() < 2 {
        return;
    }
    let mut command = 'M';
    let mut previous: Option<Cell> = None;
    for &(x, y) in &cells {
        let next = match previous {
            None => 'M',
            Some((_, py)) if py == y => 'H',
            Some((px, _)) if px == x => 'V',
            Some(_) => 'L',
        };
        // A letter begins a run of one command; more numbers go on with it.
        out.push(if previous.is_some() && next == command {
            ' '
        } else {
            next
        });
        command = next;
        match next {
            'H' => fixed_point::push(out, x),
            'V' => fixed_point::push(out, y),
            _ => {
                fixed_point::push(out, x);
                out.push(' ');
                fixed_point::push(out, y);
            }
        }
        previous = Some((x, y));
    }
    if closed {
        out.push('Z');
    }
}

fn number(mm: f64) -> String {
    let mut out = String::new();
    fixed_point::push(&mut out, fixed_point::whole(mm));
    out
}

/// An id made of the name's letters and digits that no other group has.
fn unique_id(name: &str, taken: &mut BTreeSet<String>) -> String {
    let plain = |c: char| {
        if c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.') {
            c
        } else {
            '_'
        }
    };
    let mut id: String = name.chars().map(plain).collect();
    if !id.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') {
        id.insert(0, '_');
    }
    let mut candidate = id.clone();
    let mut count = 1;
    while !taken.insert(candidate.clone()) {
        count += 1;
        candidate = format!("{id}-{count}");
    }
    candidate
}

/// The text as it may stand in an attribute; characters that XML does not know are left out.
fn escaped(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            '\t' | '\n' | '\r' => {
                write!(out, "&#{};", c as u32).expect("a string takes all that is written")
            }
            '\u{0}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => {}
            _ => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Color;
    use expect_test::expect;
    use fretwork_geometry::{Bounds, Polygon};

    fn line(points: &[[f64; 2]]) -> Item {
        Item::Line(points.iter().map(|&p| p.into()).collect())
    }

    fn layer(name: &str, style: Style, items: Vec<Item>) -> Layer {
        Layer {
            name: name.into(),
            role: Role::Cut,
            style,
            items,
        }
    }

    #[test]
    fn a_small_sheet_has_these_bytes() {
        let square = |a: f64, b: f64| {
            vec![
                Point::new(a, a),
                Point::new(b, a),
                Point::new(b, b),
                Point::new(a, b),
            ]
        };
        let area = Polygon {
            outer: square(0.0, 4.0),
            holes: vec![square(1.0, 2.0)],
        };
        let closed = line(&[[1.0, 1.0], [2.5, 1.25], [2.0, 3.0], [1.0, 1.0]]);
        let open = line(&[
            [0.0, 0.0],
            [1.0, 0.0],
            [2.0, 0.0],
            [2.0, -0.1],
            [0.33333333, 1.0],
        ]);
        let dot = line(&[[1.0, 1.0], [1.000001, 1.0]]);
        let sheet = Sheet {
            page: Some(Bounds {
                min: Point::new(-1.0, 0.0),
                max: Point::new(9.0, 5.0),
            }),
            unit_mm: 10.0,
            layers: vec![
                layer(
                    "a & \"b\"",
                    Style::outline(0.1),
                    vec![open.clone(), dot, closed.clone(), line(&[])],
                ),
                layer(
                    "a & \"b\"",
                    Style::filled(Color([255, 0, 16])),
                    vec![Item::Area(area), closed, open],
                ),
            ],
        };
        expect![[r##"
            <?xml version="1.0" encoding="UTF-8"?>
            <svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" width="100mm" height="50mm" viewBox="-10 0 100 50" stroke-linecap="round" stroke-linejoin="round">
            <g id="a____b_" inkscape:groupmode="layer" inkscape:label="a &amp; &quot;b&quot;" data-role="cut" fill="none" stroke="#000000" stroke-width="0.1">
            <path d="M0 0H10 20V-1L3.3333 10"/>
            <path d="M10 10L25 12.5 20 30Z"/>
            </g>
            <g id="a____b_-2" inkscape:groupmode="layer" inkscape:label="a &amp; &quot;b&quot;" data-role="cut" fill="#ff0010" fill-rule="evenodd">
            <path d="M0 0H40V40H0ZM10 10H20V20H10Z"/>
            <path d="M10 10L25 12.5 20 30Z"/>
            <path d="M0 0H10 20V-1L3.3333 10" fill="none"/>
            </g>
            </svg>
        "##]]
        .assert_eq(&String::from_utf8(write(&sheet)).unwrap());
    }
}
