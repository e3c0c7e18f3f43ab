//! SVG: the size in millimetres, one group per label, which Inkscape shows as a layer, one path or
//! circle per item. A user unit is a millimetre, the plane is unflipped. No dates, no program's
//! name: the same sheet gives the same bytes.

use std::collections::BTreeSet;

use super::xml::escaped;
use super::{FileUnit, path_data};
use crate::origin::{NAMESPACE, Origin};
use crate::sheet::arc_fit::{self, Circle};
use crate::sheet::fixed_point;
use crate::sheet::lines::{is_closed, outlines};
use crate::sheet::{Item, Layer, Role, Sheet, Style};

/// The file. Coordinates are written to 10^-4 mm, circles and arcs as such where corners lie on
/// them; of what is not a number or out of range ([`Sheet::check`]) nothing sensible is written.
pub fn write(sheet: &Sheet, unit: FileUnit, origin: Option<&Origin>) -> Vec<u8> {
    let elements = Elements {
        unit_mm: sheet.unit_mm,
        has_arcs: true,
        shared: 1,
    };
    render(sheet, (unit, origin), 0.0, elements)
}

/// The file of a window: as [`write()`], but with lines as they are cut, for an arc that is found in a part
/// of a line is not that of the whole.
pub fn write_cut(sheet: &Sheet, unit: FileUnit, origin: Option<&Origin>) -> Vec<u8> {
    let elements = Elements {
        unit_mm: sheet.unit_mm,
        has_arcs: false,
        shared: 1,
    };
    render(sheet, (unit, origin), 0.0, elements)
}

/// The file for a renderer: lines are at least `width` mm wide, and up to a thousand of them share
/// a path element, so that a million are no burden.
pub(crate) fn preview(sheet: &Sheet, width: f64) -> Vec<u8> {
    let elements = Elements {
        unit_mm: sheet.unit_mm,
        has_arcs: false,
        shared: 1000,
    };
    render(sheet, (FileUnit::Millimetre, None), width, elements)
}

/// Lines are at least so wide.
fn render(
    sheet: &Sheet,
    (unit, origin): (FileUnit, Option<&Origin>),
    least_width: f64,
    elements: Elements,
) -> Vec<u8> {
    let page = sheet.page_mm();
    let mut out = String::from(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" ",
    );
    out += "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\"";
    let [x, y, w, h] = [page.min.x, page.min.y, page.width(), page.height()].map(number);
    let unit = unit.svg();
    out += &format!(" width=\"{w}{unit}\" height=\"{h}{unit}\" viewBox=\"{x} {y} {w} {h}\"");
    out += " stroke-linecap=\"round\" stroke-linejoin=\"round\">\n";
    if let Some(origin) = origin {
        push_origin(&mut out, origin);
    }
    let mut ids = BTreeSet::new();
    // A label with several looks, such as areas and open lines, is one layer with a group for each.
    let is_one = |a: &Layer, b: &Layer| (&a.name, a.role) == (&b.name, b.role);
    for looks in sheet.layers.chunk_by(is_one) {
        let id = unique_id(&looks[0].name, &mut ids);
        open_layer(&mut out, &looks[0], &id);
        if let [layer] = looks {
            push_style(&mut out, layer, least_width);
            out += ">\n";
            push_items(&mut out, layer, elements);
        } else {
            out += ">\n";
            for layer in looks {
                out += "<g";
                push_style(&mut out, layer, least_width);
                out += ">\n";
                push_items(&mut out, layer, elements);
                out += "</g>\n";
            }
        }
        out += "</g>\n";
    }
    out += "</svg>\n";
    out.into_bytes()
}

fn push_origin(out: &mut String, origin: &Origin) {
    let [spec, artifact] = [&origin.spec, &origin.artifact].map(|name| escaped(name));
    *out +=
        &format!("<metadata><origin xmlns=\"{NAMESPACE}\" spec=\"{spec}\" artifact=\"{artifact}\"");
    *out += &format!(" recipe=\"{}\"/></metadata>\n", origin.recipe);
}

fn push_items(out: &mut String, layer: &Layer, elements: Elements) {
    let shared = if layer.style.fill.is_some() {
        1
    } else {
        elements.shared
    };
    for items in layer.items.chunks(shared) {
        elements.push(out, items, layer.style);
    }
}

/// Begins the group of a layer; its look and the end of the tag follow.
fn open_layer(out: &mut String, layer: &Layer, id: &str) {
    let role = match layer.role {
        Role::Cut => "cut",
        Role::Engrave => "engrave",
        Role::Draw => "draw",
    };
    let name = escaped(&layer.name);
    *out += &format!(
        "<g id=\"{id}\" inkscape:groupmode=\"layer\" inkscape:label=\"{name}\" data-role=\"{role}\""
    );
}

/// The attributes of a look.
fn push_style(out: &mut String, layer: &Layer, least_width: f64) {
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
}

/// How lines become elements.
#[derive(Clone, Copy)]
struct Elements {
    unit_mm: f64,
    /// Whether arcs are found again in polylines.
    has_arcs: bool,
    /// So many lines share a path element.
    shared: usize,
}

impl Elements {
    /// Appends one element for all `items`: a circle, or else a path.
    fn push(self, out: &mut String, items: &[Item], style: Style) {
        if self.has_arcs
            && let [Item::Line(points)] = items
            && let Some(circle) = arc_fit::circle(&fixed_point::cells(points, self.unit_mm))
        {
            return push_circle(out, circle);
        }
        let begin = out.len();
        *out += "<path d=\"";
        let empty = out.len();
        let mut is_open = false;
        for item in items {
            is_open = matches!(item, Item::Line(points) if !is_closed(points));
            for line in outlines(item) {
                let cells = fixed_point::cells(&line, self.unit_mm);
                path_data::push(out, &cells, self.has_arcs);
            }
        }
        if out.len() == empty {
            out.truncate(begin);
            return;
        }
        *out += if is_open && style.fill.is_some() {
            "\" fill=\"none\"/>\n"
        } else {
            "\"/>\n"
        };
    }
}

fn push_circle(out: &mut String, circle: Circle) {
    *out += "<circle cx=\"";
    fixed_point::push(out, circle.center.0);
    *out += "\" cy=\"";
    fixed_point::push(out, circle.center.1);
    *out += "\" r=\"";
    fixed_point::push(out, circle.radius);
    *out += "\"/>\n";
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Color;
    use expect_test::expect;
    use fretwork_geometry::{Bounds, Point, Polygon};

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
            <g id="a____b_" inkscape:groupmode="layer" inkscape:label="a &amp; &quot;b&quot;" data-role="cut">
            <g fill="none" stroke="#000000" stroke-width="0.1">
            <path d="M0 0H10 20V-1L3.3333 10"/>
            <path d="M10 10L25 12.5 20 30Z"/>
            </g>
            <g fill="#ff0010" fill-rule="evenodd">
            <path d="M10 10H20V20H10ZM0 0H40V40H0Z"/>
            <path d="M10 10L25 12.5 20 30Z"/>
            <path d="M0 0H10 20V-1L3.3333 10" fill="none"/>
            </g>
            </g>
            </svg>
        "##]]
        .assert_eq(&String::from_utf8(write(&sheet, FileUnit::Millimetre, None)).unwrap());
    }

    #[test]
    fn holes_are_circles_and_rounded_corners_arcs() {
        let corner = |x: f64, y: f64, radius: f64, angle: f64| {
            Point::new(x + radius * libm::cos(angle), y + radius * libm::sin(angle))
        };
        let step = std::f64::consts::TAU / 80.0;
        let circle = |radius: f64| -> Vec<Point> {
            (0..80)
                .map(|i| corner(7.0, 7.0, radius, f64::from(i) * step))
                .collect()
        };
        let mut hole = circle(1.6);
        hole.push(hole[0]);
        let centers = [(16.0, 16.0), (4.0, 16.0), (4.0, 4.0), (16.0, 4.0)];
        let rounded = (0..84).map(|i| {
            let (x, y) = centers[i / 21];
            corner(x, y, 4.0, ((i / 21) * 20 + i % 21) as f64 * step)
        });
        let plate = Polygon {
            outer: rounded.collect(),
            holes: vec![circle(2.0)],
        };
        let layers = vec![
            layer("hole", Style::outline(0.1), vec![Item::Line(hole)]),
            layer(
                "plate",
                Style::filled(Color::default()),
                vec![Item::Area(plate)],
            ),
        ];
        let sheet = Sheet {
            page: None,
            unit_mm: 1.0,
            layers,
        };
        let text = String::from_utf8(write(&sheet, FileUnit::Millimetre, None)).unwrap();
        let shapes = text
            .lines()
            .filter(|line| line.starts_with("<circle") || line.starts_with("<path"));
        expect![[r#"
            <circle cx="7" cy="7" r="1.6"/>
            <path d="M5 7A2 2 0 0 1 9 7 2 2 0 0 1 5 7ZM20 16A4 4 0 0 1 16 20H4A4 4 0 0 1 0 16V4A4 4 0 0 1 4 0H16A4 4 0 0 1 20 4Z"/>
        "#]]
        .assert_eq(&(shapes.collect::<Vec<_>>().join("\n") + "\n"));
    }
}
