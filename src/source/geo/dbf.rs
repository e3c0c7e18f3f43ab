//! dBASE tables, as shapefiles have them beside them: numbers, texts, dates as texts, yes and no.
//! Memos, which lie in a third file, are left out.

use std::sync::Arc;

use super::GeoError;
use super::code_pages::Letters;
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
    /// Whether its numbers have no decimals.
    is_whole: bool,
    start: usize,
    width: usize,
}

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
                let value = value(&line[c.start..c.start + c.width], c, letters)?;
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
                name: letters.text(name).trim().into(),
                kind: field[11],
                is_whole: field[11] == b'N' && field[17] == 0,
                start: start - width,
                width,
            }
        })
        .collect()
}

/// The letters that a `.cpg`, or else the table's language byte, stands for.
fn letters(language: u8, page: Option<&str>) -> Result<Letters, GeoError> {
    match page.map(str::trim).filter(|page| !page.is_empty()) {
        Some(page) => Letters::of_name(page).ok_or_else(|| {
            GeoError::Damaged(format!(
                "the code page `{page}`, which the `.cpg` beside it names, is not known"
            ))
        }),
        None => Ok(Letters::of_language(language)),
    }
}

/// The value of an entry, none where it is empty or no number where one should be.
fn value(bytes: &[u8], column: &Column, letters: Letters) -> Option<Attribute> {
    let (kind, is_whole) = (column.kind, column.is_whole);
    match kind {
        b'N' | b'F' => {
            let text = std::str::from_utf8(bytes).ok()?;
            let text = text.trim_matches(['\0', ' ']);
            if let (true, Ok(number)) = (is_whole, text.parse()) {
                return Some(Attribute::Whole(number));
            }
            let number: f64 = text.parse().ok()?;
            number.is_finite().then_some(Attribute::Number(number))
        }
        b'L' => match bytes.first()? {
            b'T' | b't' | b'Y' | b'y' | b'1' => Some(Attribute::Truth(true)),
            b'F' | b'f' | b'N' | b'n' | b'0' => Some(Attribute::Truth(false)),
            _ => None,
        },
        b'I' | b'+' => {
            let number = i32::from_le_bytes(bytes.try_into().ok()?);
            Some(Attribute::Whole(i64::from(number)))
        }
        b'O' => {
            let number = f64::from_le_bytes(bytes.try_into().ok()?);
            number.is_finite().then_some(Attribute::Number(number))
        }
        b'M' | b'B' | b'G' | b'P' => None,
        _ => {
            let text = letters.text(bytes);
            // Texts are filled up to their width at the end; what stands before one belongs to it.
            let text = text.trim_end_matches(['\0', ' ']);
            let text = match kind {
                b'D' => date(text.trim_start())?,
                _ => text.to_string(),
            };
            (!text.trim_start().is_empty()).then(|| Attribute::Text(text.into()))
        }
    }
}

/// A date as other formats write it, `2020-02-03`; none where it is one of zeros.
fn date(text: &str) -> Option<String> {
    let is_plain = text.len() == 8 && text.bytes().all(|b| b.is_ascii_digit());
    match text.bytes().all(|b| b == b'0') {
        true => None,
        false if is_plain => Some(format!("{}-{}-{}", &text[..4], &text[4..6], &text[6..])),
        false => Some(text.to_string()),
    }
}
