//! dBASE tables, as shapefiles have them beside them: numbers, texts, dates as texts, yes and no.
//! Memos, which lie in a third file, are left out.

use std::sync::Arc;

use super::GeoError;
use fretwork_geometry::Attribute;

/// A table. Lines that were struck out keep their place.
#[derive(Clone, Debug)]
pub struct Table {
    columns: Vec<Column>,
    /// Of every line, the values of those columns that have one.
    pub lines: Vec<Vec<(Arc<str>, Attribute)>>,
}

#[derive(Clone, Debug)]
struct Column {
    name: Arc<str>,
    kind: u8,
    start: usize,
    width: usize,
}

/// How texts are written.
#[derive(Clone, Copy)]
enum Letters {
    /// A code page of the web's encoding standard.
    Page(&'static encoding_rs::Encoding),
    /// The upper half of a code page of DOS.
    Dos(&'static str),
    /// UTF-8 where it is that, else Latin-1.
    Guess,
}

const DOS_437: &str = "ÇüéâäàåçêëèïîìÄÅÉæÆôöòûùÿÖÜ¢£¥₧ƒáíóúñÑªº¿⌐¬½¼¡«»░▒▓│┤╡╢╖╕╣║╗╝╜╛┐└┴┬├─┼╞╟╚╔╩╦╠═╬╧╨╤╥╙╘╒╓╫╪┘┌█▄▌▐▀αßΓπΣσµτΦΘΩδ∞φε∩≡±≥≤⌠⌡÷≈°∙·√ⁿ²■\u{a0}";
const DOS_850: &str = "ÇüéâäàåçêëèïîìÄÅÉæÆôöòûùÿÖÜø£Ø×ƒáíóúñÑªº¿®¬½¼¡«»░▒▓│┤ÁÂÀ©╣║╗╝¢¥┐└┴┬├─┼ãÃ╚╔╩╦╠═╬¤ðÐÊËÈıÍÎÏ┘┌█▄¦Ì▀ÓßÔÒõÕµþÞÚÛÙýÝ¯´\u{ad}±‗¾¶§÷¸°¨·¹³²■\u{a0}";

/// Bytes before the first column, and of a column.
const HEAD: usize = 32;

/// The table in `bytes`; `page` is the content of a `.cpg`, which names the code page.
///
/// # Errors
/// When it is no table, or is shorter than it says.
pub fn read(bytes: &[u8], page: Option<&str>) -> Result<Table, GeoError> {
    let damaged = |message: &str| GeoError::Damaged(message.to_string());
    let short = || damaged("the table is shorter than it says");
    let head = bytes.get(..HEAD).ok_or_else(short)?;
    let number = |at: usize| usize::from(u16::from_le_bytes([head[at], head[at + 1]]));
    let count = u32::from_le_bytes([head[4], head[5], head[6], head[7]]) as usize;
    let (start, width) = (number(8), number(10));
    let letters = letters(head[29], page)?;
    let columns = columns(bytes.get(HEAD..start).ok_or_else(short)?, letters);
    if columns.iter().any(|c| c.start + c.width > width) || width == 0 {
        return Err(damaged("the columns of the table are wider than its lines"));
    }
    let end = count
        .checked_mul(width)
        .and_then(|size| size.checked_add(start));
    let content = end
        .and_then(|end| bytes.get(start..end))
        .ok_or_else(short)?;
    let lines = content
        .chunks_exact(width)
        .map(|line| {
            let entry = |c: &Column| {
                let value = value(&line[c.start..c.start + c.width], c.kind, letters)?;
                Some((c.name.clone(), value))
            };
            columns.iter().filter_map(entry).collect()
        })
        .collect();
    Ok(Table { columns, lines })
}

impl Table {
    /// The names of the columns.
    pub fn columns(&self) -> Vec<Arc<str>> {
        self.columns.iter().map(|c| c.name.clone()).collect()
    }
}

fn columns(bytes: &[u8], letters: Letters) -> Vec<Column> {
    // The first byte of a line says whether it was struck out.
    let mut start = 1;
    let fields = bytes
        .chunks_exact(HEAD)
        .take_while(|field| field[0] != 0x0d);
    fields
        .map(|field| {
            let name = &field[..11];
            let name = &name[..name.iter().position(|b| *b == 0).unwrap_or(11)];
            let long = u16::from_le_bytes([field[16], field[17]]);
            // Wide texts have the upper byte of their width where numbers have their decimals.
            let width = if field[11] == b'C' {
                usize::from(long)
            } else {
                usize::from(field[16])
            };
            start += width;
            Column {
                name: text(name, letters).trim().into(),
                kind: field[11],
                start: start - width,
                width,
            }
        })
        .collect()
}

/// The letters that a `.cpg`, or else the table's language byte, stands for.
fn letters(language: u8, page: Option<&str>) -> Result<Letters, GeoError> {
    if let Some(page) = page.map(str::trim).filter(|page| !page.is_empty()) {
        let unknown = || GeoError::Damaged(format!("the code page `{page}` is not known"));
        let upper = page.to_ascii_uppercase();
        if let Some((_, part)) = upper.split_once("8859") {
            let found = label(&format!("iso-8859-{}", part.trim_matches(['-', ' ', '_'])));
            return found.ok_or_else(unknown);
        }
        let number = upper.trim_start_matches(|c: char| !c.is_ascii_digit());
        return match number {
            "437" => Some(Letters::Dos(DOS_437)),
            "850" => Some(Letters::Dos(DOS_850)),
            "65001" => Some(Letters::Page(encoding_rs::UTF_8)),
            "932" => label("shift_jis"),
            "936" => label("gbk"),
            "949" => label("euc-kr"),
            "950" => label("big5"),
            _ if number.starts_with("125") => label(&format!("windows-{number}")),
            _ => label(page),
        }
        .ok_or_else(unknown);
    }
    Ok(match language {
        0x01 => Letters::Dos(DOS_437),
        0x02 => Letters::Dos(DOS_850),
        0x03 | 0x57 => Letters::Page(encoding_rs::WINDOWS_1252),
        0x13 | 0x7b => Letters::Page(encoding_rs::SHIFT_JIS),
        0x4d | 0x7a => Letters::Page(encoding_rs::GBK),
        0x4e | 0x79 => Letters::Page(encoding_rs::EUC_KR),
        0x4f | 0x78 => Letters::Page(encoding_rs::BIG5),
        0x65 => Letters::Page(encoding_rs::IBM866),
        0xc8 => Letters::Page(encoding_rs::WINDOWS_1250),
        0xc9 => Letters::Page(encoding_rs::WINDOWS_1251),
        0xca => Letters::Page(encoding_rs::WINDOWS_1254),
        0xcb => Letters::Page(encoding_rs::WINDOWS_1253),
        _ => Letters::Guess,
    })
}

fn label(name: &str) -> Option<Letters> {
    let name = name.to_ascii_lowercase();
    let found = encoding_rs::Encoding::for_label(name.trim_start_matches("ansi ").as_bytes());
    found.map(Letters::Page)
}

fn text(bytes: &[u8], letters: Letters) -> String {
    match letters {
        Letters::Page(page) => page.decode_without_bom_handling(bytes).0.into_owned(),
        Letters::Dos(upper) => bytes
            .iter()
            .map(|b| match b.checked_sub(128) {
                Some(above) => upper.chars().nth(usize::from(above)).unwrap_or('\u{fffd}'),
                None => char::from(*b),
            })
            .collect(),
        Letters::Guess => match std::str::from_utf8(bytes) {
            Ok(text) => text.to_string(),
            Err(_) => bytes.iter().map(|b| char::from(*b)).collect(),
        },
    }
}

/// The value of an entry, none where it is empty or no number where one should be.
fn value(bytes: &[u8], kind: u8, letters: Letters) -> Option<Attribute> {
    match kind {
        b'N' | b'F' => {
            let text = std::str::from_utf8(bytes).ok()?;
            let number: f64 = text.trim_matches(['\0', ' ']).parse().ok()?;
            number.is_finite().then_some(Attribute::Number(number))
        }
        b'L' => match bytes.first()? {
            b'T' | b't' | b'Y' | b'y' | b'1' => Some(Attribute::Truth(true)),
            b'F' | b'f' | b'N' | b'n' | b'0' => Some(Attribute::Truth(false)),
            _ => None,
        },
        b'I' | b'+' => {
            let number = i32::from_le_bytes(bytes.try_into().ok()?);
            Some(Attribute::Number(f64::from(number)))
        }
        b'O' => {
            let number = f64::from_le_bytes(bytes.try_into().ok()?);
            number.is_finite().then_some(Attribute::Number(number))
        }
        b'M' | b'B' | b'G' | b'P' => None,
        _ => {
            let text = text(bytes, letters);
            let text = text.trim_matches(['\0', ' ']);
            (!text.is_empty()).then(|| Attribute::Text(text.into()))
        }
    }
}
