//! The records of a DXF file: its header, its tables, and the fixed blocks, with a handle for each.

use super::layers::FileLayer;
use crate::format::{FileUnit, dxf_color};
use crate::sheet::Sheet;
use crate::sheet::fixed_point;

/// Handles below it are those of the fixed records; the layers and then the polylines follow.
pub const FIRST_LAYER: u64 = 0x30;
/// The handle of the space that all entities lie in.
pub const MODEL_SPACE: &str = "1F";
const PAPER_SPACE: &str = "1B";
/// Pairs of group codes and values, a line each.
pub struct Records {
    /// What is written so far.
    pub text: String,
    /// The handle of the next record that needs one of its own.
    pub next_handle: u64,
}

impl Records {
    pub fn put(&mut self, pairs: &[(u16, &str)]) {
        for (code, value) in pairs {
            self.text += &format!("{code}\n{value}\n");
        }
    }

    pub fn number(&mut self, code: u16, whole: i64) {
        self.text += &format!("{code}\n");
        fixed_point::push(&mut self.text, whole);
        self.text.push('\n');
    }

    pub fn handle(&mut self) -> String {
        self.next_handle += 1;
        format!("{:X}", self.next_handle - 1)
    }

    pub fn section(&mut self, name: &str, content: impl FnOnce(&mut Records)) {
        self.put(&[(0, "SECTION"), (2, name)]);
        content(self);
        self.put(&[(0, "ENDSEC")]);
    }

    pub fn header(&mut self, sheet: &Sheet, unit: FileUnit, end_of_handles: u64) {
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

    pub fn tables(&mut self, layers: &[FileLayer]) {
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

    pub fn blocks(&mut self) {
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
}
