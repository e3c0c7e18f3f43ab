//! DXF, release 2000: circles, and closed and open polylines with arcs in them, on named layers, in
//! millimetres, y up.
//!
//! Written here rather than through a library: such a file needs few kinds of records, while the
//! library brings an image codec and stamps dates and random identifiers into every file.

use std::collections::{BTreeMap, BTreeSet};

use super::{FileUnit, dxf_color};
use crate::origin::Origin;
use crate::sheet::arc_fit::{self, Circle};
use crate::sheet::fixed_point::{self, Cell};
use crate::sheet::lines::{is_closed, outlines};
use crate::sheet::{Role, Sheet};
use fretwork_geometry::Point;

/// The file. The plane is mirrored in the x axis, so that the picture looks as it does in SVG.
/// Areas are written as their outlines. Layers keep the names of the sheet's layers as far as DXF
/// allows, and have the colour of the file's palette that is nearest to that of their lines. Holds
/// no dates and no random identifiers.
pub fn write(sheet: &Sheet, unit: FileUnit, origin: Option<&Origin>) -> Vec<u8> {
    let (layers, numbers) = file_layers(sheet);
    let mut entities = Records {
        text: String::new(),
        next_handle: FIRST_LAYER + layers.len() as u64,
    };
    for (layer, number) in sheet.layers.iter().zip(numbers) {
        for line in layer.items.iter().flat_map(outlines) {
            entities.line(&line, &layers[number].name, sheet.unit_mm);
        }
    }
    let mut file = Records {
        text: String::new(),
        next_handle: FIRST_LAYER,
    };
    if let Some(origin) = origin {
        file.put(&[(999, &origin.line())]);
    }
    file.header(sheet, unit, entities.next_handle);
    file.tables(&layers);
    file.blocks();
    file.section("ENTITIES", |file| file.text += &entities.text);
    file.section("OBJECTS", |file| {
        file.put(&[
            (0, "DICTIONARY"),
            (5, "C"),
            (330, "0"),
            (100, "AcDbDictionary"),
            (281, "1"),
        ]);
        file.put(&[(3, "ACAD_GROUP"), (350, "D")]);
        file.put(&[
            (0, "DICTIONARY"),
            (5, "D"),
            (330, "C"),
            (100, "AcDbDictionary"),
            (281, "1"),
        ]);
    });
    file.put(&[(0, "EOF")]);
    latin(&file.text)
}

/// Handles below it are those of the fixed records; the layers and then the polylines follow.
const FIRST_LAYER: u64 = 0x30;
const MODEL_SPACE: &str = "1F";
const PAPER_SPACE: &str = "1B";

/// Pairs of group codes and values, a line each.
struct Records {
    text: String,
    next_handle: u64,
}

impl Records {
    fn put(&mut self, pairs: &[(u16, &str)]) {
        for (code, value) in pairs {
            self.text += &format!("{code}\n{value}\n");
        }
    }

    fn number(&mut self, code: u16, whole: i64) {
        self.text += &format!("{code}\n");
        fixed_point::push(&mut self.text, whole);
        self.text.push('\n');
    }

    fn handle(&mut self) -> String {
        self.next_handle += 1;
        format!("{:X}", self.next_handle - 1)
    }

    fn section(&mut self, name: &str, content: impl FnOnce(&mut Records)) {
        self.put(&[(0, "SECTION"), (2, name)]);
        content(self);
        self.put(&[(0, "ENDSEC")]);
    }

    fn header(&mut self, sheet: &Sheet, unit: FileUnit, end_of_handles: u64) {
        let page = sheet.page_mm();
        self.section("HEADER", |file| {
            file.put(&[
                (9, "$ACADVER"),
                (1, "AC1015"),
                (9, "$DWGCODEPAGE"),
                (3, "ANSI_1252"),
            ]);
            file.put(&[
                (9, "$INSUNITS"),
                (70, unit.dxf()),
                (9, "$MEASUREMENT"),
                (70, "1"),
            ]);
            file.put(&[(9, "$HANDSEED"), (5, &format!("{end_of_handles:X}"))]);
            let corners = [
                ("$EXTMIN", page.min.x, page.max.y),
                ("$EXTMAX", page.max.x, page.min.y),
            ];
            for (name, x, y) in corners {
                file.put(&[(9, name)]);
                file.number(10, fixed_point::whole(x));
                file.number(20, -fixed_point::whole(y));
                file.number(30, 0);
            }
        });
    }

    fn tables(&mut self, layers: &[FileLayer]) {
        self.section("TABLES", |file| {
            file.table("VPORT", "8", 0, |_| {});
            file.table("LTYPE", "5", 3, |file| {
                for (handle, name) in [("14", "ByBlock"), ("15", "ByLayer"), ("16", "Continuous")] {
                    file.record("LTYPE", handle, "5", "AcDbLinetypeTableRecord", name);
                    file.put(&[(70, "0"), (3, ""), (72, "65"), (73, "0"), (40, "0")]);
                }
            });
            file.table("LAYER", "2", layers.len() + 1, |file| {
                file.layer("10", "0", dxf_color::BLACK);
                for layer in layers {
                    let handle = file.handle();
                    file.layer(&handle, &layer.name, layer.color);
                }
            });
            file.table("STYLE", "3", 1, |file| {
                file.record("STYLE", "11", "3", "AcDbTextStyleTableRecord", "Standard");
                file.put(&[
                    (70, "0"),
                    (40, "0"),
                    (41, "1"),
                    (50, "0"),
                    (71, "0"),
                    (42, "2.5"),
                    (3, "txt"),
                    (4, ""),
                ]);
            });
            file.table("VIEW", "6", 0, |_| {});
            file.table("UCS", "7", 0, |_| {});
            file.table("APPID", "9", 1, |file| {
                file.record("APPID", "12", "9", "AcDbRegAppTableRecord", "ACAD");
                file.put(&[(70, "0")]);
            });
            file.table("DIMSTYLE", "A", 0, |file| {
                file.put(&[(100, "AcDbDimStyleTable")])
            });
            file.table("BLOCK_RECORD", "1", 2, |file| {
                for (handle, name) in [(MODEL_SPACE, "*Model_Space"), (PAPER_SPACE, "*Paper_Space")]
                {
                    file.record("BLOCK_RECORD", handle, "1", "AcDbBlockTableRecord", name);
                    file.put(&[(340, "0")]);
                }
            });
        });
    }

    fn table(
        &mut self,
        name: &str,
        handle: &str,
        count: usize,
        content: impl FnOnce(&mut Records),
    ) {
        self.put(&[
            (0, "TABLE"),
            (2, name),
            (5, handle),
            (330, "0"),
            (100, "AcDbSymbolTable"),
        ]);
        self.put(&[(70, &count.to_string())]);
        content(self);
        self.put(&[(0, "ENDTAB")]);
    }

    fn record(&mut self, kind: &str, handle: &str, owner: &str, class: &str, name: &str) {
        self.put(&[
            (0, kind),
            (5, handle),
            (330, owner),
            (100, "AcDbSymbolTableRecord"),
            (100, class),
            (2, name),
        ]);
    }

    fn layer(&mut self, handle: &str, name: &str, color: u8) {
        self.record("LAYER", handle, "2", "AcDbLayerTableRecord", name);
        self.put(&[(70, "0"), (62, &color.to_string()), (6, "Continuous")]);
    }

    fn blocks(&mut self) {
        self.section("BLOCKS", |file| {
            let spaces = [
                ("*Model_Space", MODEL_SPACE, "20", "21"),
                ("*Paper_Space", PAPER_SPACE, "1C", "1D"),
            ];
            for (name, owner, begin, end) in spaces {
                let entity = [(330, owner), (100, "AcDbEntity"), (8, "0")];
                file.put(&[(0, "BLOCK"), (5, begin)]);
                file.put(&entity);
                file.put(&[
                    (100, "AcDbBlockBegin"),
                    (2, name),
                    (70, "0"),
                    (10, "0"),
                    (20, "0"),
                    (30, "0"),
                    (3, name),
                    (1, ""),
                ]);
                file.put(&[(0, "ENDBLK"), (5, end)]);
                file.put(&entity);
                file.put(&[(100, "AcDbBlockEnd")]);
            }
        });
    }

    /// One line, if it has an extent: a circle, or a polyline with arcs where its corners lie on
    /// them.
    fn line(&mut self, line: &[Point], layer: &str, unit_mm: f64) {
        let cells = fixed_point::cells(line, unit_mm);
        if cells.len() < 2 {
            return;
        }
        let is_closed = is_closed(&cells);
        match arc_fit::circle(&cells).filter(|_| is_closed) {
            Some(circle) => self.circle(circle, layer),
            None => self.polyline(&cells, is_closed, layer),
        }
    }

    fn entity(&mut self, kind: &str, layer: &str, class: &str) {
        let handle = self.handle();
        self.put(&[
            (0, kind),
            (5, &handle),
            (330, MODEL_SPACE),
            (100, "AcDbEntity"),
            (8, layer),
            (100, class),
        ]);
    }

    fn circle(&mut self, circle: Circle, layer: &str) {
        self.entity("CIRCLE", layer, "AcDbCircle");
        self.number(10, circle.center.0);
        self.number(20, -circle.center.1);
        self.number(30, 0);
        self.number(40, circle.radius);
    }

    fn polyline(&mut self, cells: &[Cell], is_closed: bool, layer: &str) {
        let stretches = arc_fit::stretches(cells);
        // Every stretch is written as the corner that it begins at; an open line has a last corner.
        let mut corners: Vec<(Cell, f64)> = Vec::with_capacity(stretches.len() + 1);
        let mut at = cells[0];
        for stretch in stretches {
            corners.push((at, stretch.arc.map_or(0.0, |arc| arc.bulge)));
            at = stretch.end;
        }
        if !is_closed {
            corners.push((at, 0.0));
        }
        self.entity("LWPOLYLINE", layer, "AcDbPolyline");
        self.put(&[
            (90, &corners.len().to_string()),
            (70, if is_closed { "1" } else { "0" }),
        ]);
        for ((x, y), bulge) in corners {
            self.number(10, x);
            self.number(20, -y);
            if bulge != 0.0 {
                // The plane is mirrored, and with it the sense of the arcs.
                self.put(&[(42, &plain_number(-bulge))]);
            }
        }
    }
}

/// A bulge with nine digits behind the point, at most: on a chord of a kilometre that is 10^-3 mm.
fn plain_number(bulge: f64) -> String {
    let mut text = String::new();
    fixed_point::push_scaled(&mut text, (bulge * 1e9).round() as i64, 9);
    text
}

/// A layer of the file.
struct FileLayer {
    name: String,
    color: u8,
}

/// The layers of the file, and which of them each layer of the sheet is: the same for layers of one
/// name, role and colour, which stand more than once where they take turns. Names are such as DXF
/// allows, and distinct whatever their case.
fn file_layers(sheet: &Sheet) -> (Vec<FileLayer>, Vec<usize>) {
    let mut taken = BTreeSet::from(["0".to_string()]);
    let mut known: BTreeMap<(&str, Role, u8), usize> = BTreeMap::new();
    let mut layers = Vec::new();
    let mut numbers = Vec::new();
    for layer in &sheet.layers {
        let color = dxf_color::of(layer).0;
        let next = layers.len();
        let number = *known
            .entry((&layer.name, layer.role, color))
            .or_insert(next);
        numbers.push(number);
        if number == next {
            let name = unique_name(&layer.name, layer.role, &mut taken);
            layers.push(FileLayer { name, color });
        }
    }
    (layers, numbers)
}

fn unique_name(name: &str, role: Role, taken: &mut BTreeSet<String>) -> String {
    let forbidden = |c: char| c.is_control() || c > '\u{ff}' || "<>/\\\":;?*|=`,".contains(c);
    let plain = name.trim().chars();
    let plain = plain.map(|c| if forbidden(c) { '_' } else { c }).take(200);
    let mut plain: String = plain.collect();
    if plain.is_empty() {
        plain = "layer".to_string();
    }
    // One name for two things that are done: the second is told apart by what is done.
    let word = match role {
        Role::Cut => "cut",
        Role::Engrave => "engrave",
        Role::Draw => "draw",
    };
    let told_apart = [plain.clone(), format!("{plain} {word}")];
    let numbered = (2..).map(|count| format!("{plain}-{count}"));
    told_apart
        .into_iter()
        .chain(numbered)
        .find(|name| taken.insert(name.to_lowercase()))
        .unwrap_or(plain)
}

/// The text in the code page that the header names, in which the characters up to U+00FF that
/// names can hold are single bytes.
fn latin(text: &str) -> Vec<u8> {
    text.chars()
        .map(|c| u8::try_from(u32::from(c)).unwrap_or(b'_'))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Item, Layer, Style};
    use expect_test::expect;
    use fretwork_geometry::Polygon;

    fn sheet() -> Sheet {
        let square = |a: f64, b: f64| {
            vec![
                Point::new(a, a),
                Point::new(b, a),
                Point::new(b, b),
                Point::new(a, b),
            ]
        };
        let area = Item::Area(Polygon {
            outer: square(0.0, 4.0),
            holes: vec![square(1.0, 2.0)],
        });
        let open = Item::Line(vec![Point::new(0.0, 0.0), Point::new(1.0, -0.25)]);
        let layer = |name: &str, role, items| Layer {
            name: name.into(),
            role,
            style: Style::outline(0.1),
            items,
        };
        let layers = vec![
            layer("plate: höhe", Role::Cut, vec![area]),
            layer("Plate\u{4e00} höhe", Role::Engrave, vec![open]),
        ];
        Sheet {
            page: None,
            unit_mm: 10.0,
            layers,
        }
    }

    #[test]
    fn polylines_have_these_bytes() {
        let text: String = write(&sheet(), FileUnit::Millimetre, None)
            .into_iter()
            .map(char::from)
            .collect();
        let entities = text
            .split("2\nENTITIES\n")
            .nth(1)
            .unwrap()
            .split("0\nENDSEC")
            .next()
            .unwrap();
        let brief: Vec<&str> = entities.lines().collect();
        let pairs: Vec<String> = brief
            .chunks(2)
            .map(|p| format!("{}={}", p[0], p[1]))
            .collect();
        expect![[r#"
            0=LWPOLYLINE 5=32 330=1F 100=AcDbEntity 8=plate_ höhe 100=AcDbPolyline 90=4 70=1 10=10 20=-10 10=20 20=-10 10=20 20=-20 10=10 20=-20
            0=LWPOLYLINE 5=33 330=1F 100=AcDbEntity 8=plate_ höhe 100=AcDbPolyline 90=4 70=1 10=0 20=0 10=40 20=0 10=40 20=-40 10=0 20=-40
            0=LWPOLYLINE 5=34 330=1F 100=AcDbEntity 8=Plate_ höhe engrave 100=AcDbPolyline 90=2 70=0 10=0 20=0 10=10 20=2.5
        "#]]
        .assert_eq(&(pairs.join(" ").replace(" 0=", "\n0=") + "\n"));
    }

    #[test]
    fn records_are_pairs_and_handles_are_distinct() {
        let text: String = write(&sheet(), FileUnit::Millimetre, None)
            .into_iter()
            .map(char::from)
            .collect();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len() % 2, 0);
        let pairs: Vec<(u16, &str)> = lines
            .chunks(2)
            .map(|p| (p[0].parse().unwrap(), p[1]))
            .collect();
        assert_eq!(pairs.last(), Some(&(0, "EOF")));
        let header_end = pairs.iter().position(|p| *p == (0, "ENDSEC")).unwrap();
        let handles: Vec<&str> = pairs[header_end..]
            .iter()
            .filter(|p| p.0 == 5)
            .map(|p| p.1)
            .collect();
        assert_eq!(handles.iter().collect::<BTreeSet<_>>().len(), handles.len());
        let count = |pair| pairs.iter().filter(|p| **p == pair).count();
        assert_eq!(count((0, "SECTION")), count((0, "ENDSEC")));
        assert_eq!(count((0, "TABLE")), count((0, "ENDTAB")));
        assert!(text.contains("$INSUNITS\n70\n4\n"));
    }

    fn entities(sheet: &Sheet) -> String {
        let text: String = write(sheet, FileUnit::Millimetre, None)
            .into_iter()
            .map(char::from)
            .collect();
        let entities = text.split("2\nENTITIES\n").nth(1).unwrap();
        entities
            .split("0\nENDSEC")
            .next()
            .unwrap()
            .replace('\n', " ")
    }

    fn one_line(line: Vec<Point>) -> Sheet {
        let mut sheet = sheet();
        sheet.unit_mm = 1.0;
        sheet.layers.truncate(1);
        sheet.layers[0].items = vec![Item::Line(line)];
        sheet
    }

    #[test]
    fn a_hole_is_a_circle_and_a_slot_has_arcs() {
        let step = std::f64::consts::TAU / 80.0;
        let at = |x: f64, i: usize| {
            let angle = i as f64 * step;
            Point::new(x + 1.6 * libm::cos(angle), 7.0 + 1.6 * libm::sin(angle))
        };
        let mut hole: Vec<Point> = (0..80).map(|i| at(7.0, i)).collect();
        hole.push(hole[0]);
        assert!(entities(&one_line(hole)).ends_with("AcDbCircle 10 7 20 -7 30 0 40 1.6 "));
        let mut slot: Vec<Point> = (0..=80)
            .map(|i| at(if i < 41 { 7.0 } else { 3.0 }, i))
            .collect();
        slot[80] = at(3.0, 80);
        slot.push(slot[0]);
        let text = entities(&one_line(slot));
        assert!(text.matches(" 42 ").count() <= 8, "{text}");
    }

    #[test]
    fn layers_of_one_name_and_role_are_one() {
        let mut twice = sheet();
        twice.layers.push(twice.layers[0].clone());
        assert_eq!(file_layers(&twice).1, [0, 1, 0]);
    }
}
