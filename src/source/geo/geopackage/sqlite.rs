//! SQLite files, read only: pages, b-trees of tables, records (SQLite file format, sections 1.5 to 2.1
//! and 2.6). Indices, and what has not been written into the file yet, are left out.

use std::cell::Cell;
use std::collections::BTreeSet;

/// A value of a record.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Nothing.
    Null,
    /// A whole number.
    Integer(i64),
    /// A number.
    Real(f64),
    /// Text.
    Text(String),
    /// Bytes.
    Blob(Vec<u8>),
}

impl Value {
    /// The text.
    pub fn text(&self) -> Option<&str> {
        match self {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The whole number.
    pub fn integer(&self) -> Option<i64> {
        match self {
            Value::Integer(number) => Some(*number),
            _ => None,
        }
    }
}

/// A line of a table: the number that it is stored under, and its values.
pub type Line = (i64, Vec<Value>);

/// A file.
pub struct Database<'a> {
    bytes: &'a [u8],
    page: usize,
    /// The bytes of a page that hold content.
    usable: usize,
    /// The bytes of records that may still be put together. Pages that several records claim would else make more of a file
    /// than is in it.
    left: Cell<usize>,
}

/// Trees are never so deep.
const DEEPEST: usize = 40;

type Read<T> = Result<T, String>;

fn damaged(what: &str) -> String {
    format!("the file is damaged: {what}")
}

impl<'a> Database<'a> {
    /// The database in `bytes`.
    ///
    /// # Errors
    /// With a sentence on why it is none.
    pub fn open(bytes: &'a [u8]) -> Read<Database<'a>> {
        if bytes.len() < 100 || !bytes.starts_with(b"SQLite format 3\0") {
            return Err("it is no GeoPackage: it does not begin as an SQLite file does".into());
        }
        let page = match u16::from_be_bytes([bytes[16], bytes[17]]) {
            1 => 65536,
            size => usize::from(size),
        };
        if page < 512 || !page.is_power_of_two() {
            return Err(damaged("its pages have no size"));
        }
        if bytes[56..60] != [0, 0, 0, 1] && bytes[56..60] != [0, 0, 0, 0] {
            return Err("its texts are in UTF-16, which is not read".into());
        }
        let usable = page - usize::from(bytes[20]);
        if usable < 480 {
            return Err(damaged("its pages are full of nothing"));
        }
        Ok(Database {
            bytes,
            page,
            usable,
            left: Cell::new(bytes.len().saturating_mul(8)),
        })
    }

    /// Where a table begins and the statement that made it; none where there is no table of the name.
    ///
    /// # Errors
    /// When the list of tables is damaged.
    pub fn table(&self, name: &str) -> Read<Option<(usize, String)>> {
        for (_, line) in self.lines(1)? {
            let [kind, own, _, root, sql, ..] = &line[..] else {
                continue;
            };
            let is_it = own.text().is_some_and(|own| own.eq_ignore_ascii_case(name));
            if kind.text() == Some("table") && is_it {
                let root = root.integer().and_then(|root| usize::try_from(root).ok());
                let root = root.ok_or_else(|| damaged("a table has no root"))?;
                return Ok(Some((root, sql.text().unwrap_or("").to_string())));
            }
        }
        Ok(None)
    }

    /// Whether there is a view of the name: a query that looks like a table.
    ///
    /// # Errors
    /// When the list of tables is damaged.
    pub fn has_view(&self, name: &str) -> Read<bool> {
        let is_it = |(_, line): &Line| match &line[..] {
            [kind, own, ..] => {
                kind.text() == Some("view")
                    && own.text().is_some_and(|own| own.eq_ignore_ascii_case(name))
            }
            _ => false,
        };
        Ok(self.lines(1)?.iter().any(is_it))
    }

    /// The lines of the table whose tree begins at page `root`, in their order.
    ///
    /// # Errors
    /// When the tree or a record is damaged.
    pub fn lines(&self, root: usize) -> Read<Vec<Line>> {
        let mut lines = Vec::new();
        let mut seen = BTreeSet::new();
        self.walk(root, 0, &mut seen, &mut lines)?;
        Ok(lines)
    }

    fn page(&self, number: usize) -> Read<&'a [u8]> {
        let start = number.checked_sub(1).and_then(|n| n.checked_mul(self.page));
        let end = start.and_then(|start| start.checked_add(self.page));
        let found = start
            .zip(end)
            .and_then(|(start, end)| self.bytes.get(start..end));
        found.ok_or_else(|| format!("the file ends before its page {number}"))
    }

    fn walk(
        &self,
        number: usize,
        depth: usize,
        seen: &mut BTreeSet<usize>,
        lines: &mut Vec<Line>,
    ) -> Read<()> {
        if depth > DEEPEST || !seen.insert(number) {
            return Err(damaged("a tree of pages leads back into itself"));
        }
        let page = self.page(number)?;
        let head = if number == 1 { 100 } else { 0 };
        let kind = page[head];
        let count = usize::from(u16::from_be_bytes([page[head + 3], page[head + 4]]));
        let first = head + if kind == 5 { 12 } else { 8 };
        let pointers = page
            .get(first..first + 2 * count)
            .ok_or_else(|| damaged("a page lists too many cells"))?;
        for pointer in pointers.chunks_exact(2) {
            let at = usize::from(u16::from_be_bytes([pointer[0], pointer[1]]));
            let cell = page.get(at..).unwrap_or_default();
            match kind {
                5 => self.walk(child(cell)?, depth + 1, seen, lines)?,
                13 => lines.push(self.line(cell)?),
                _ => return Err(damaged("a page of a table is of another kind")),
            }
        }
        if kind == 5 {
            self.walk(child(&page[head + 8..])?, depth + 1, seen, lines)?;
        }
        Ok(())
    }

    /// The line in a cell of a leaf, with what of it lies on other pages.
    fn line(&self, cell: &[u8]) -> Read<Line> {
        let short = || damaged("a cell is cut");
        let (size, rest) = varint(cell).ok_or_else(short)?;
        let (key, rest) = varint(rest).ok_or_else(short)?;
        let size = usize::try_from(size).map_err(|_| short())?;
        let left = self.left.get().checked_sub(size);
        self.left
            .set(left.ok_or_else(|| damaged("its records hold more than the file"))?);
        let most = self.usable - 35;
        if size <= most {
            return Ok((key, record(rest.get(..size).ok_or_else(short)?)?));
        }
        let least = (self.usable - 12) * 32 / 255 - 23;
        let fitting = least + (size - least) % (self.usable - 4);
        let local = if fitting <= most { fitting } else { least };
        let mut whole = rest.get(..local).ok_or_else(short)?.to_vec();
        let mut next = child(rest.get(local..).ok_or_else(short)?)?;
        while whole.len() < size {
            let page = self.page(next)?;
            let part = (self.usable - 4).min(size - whole.len());
            whole.extend_from_slice(&page[4..4 + part]);
            next = child(page)?;
        }
        Ok((key, record(&whole)?))
    }
}

/// The number of a page at the start of `bytes`.
fn child(bytes: &[u8]) -> Read<usize> {
    match bytes {
        [a, b, c, d, ..] => Ok(u32::from_be_bytes([*a, *b, *c, *d]) as usize),
        _ => Err(damaged("a cell is cut")),
    }
}

/// A number of one to nine bytes, and what follows.
fn varint(bytes: &[u8]) -> Option<(i64, &[u8])> {
    let mut value = 0u64;
    for (i, byte) in bytes.iter().take(9).enumerate() {
        if i == 8 {
            return Some(((value << 8 | u64::from(*byte)) as i64, &bytes[9..]));
        }
        value = value << 7 | u64::from(byte & 0x7f);
        if byte & 0x80 == 0 {
            return Some((value as i64, &bytes[i + 1..]));
        }
    }
    None
}

/// The values of a record.
fn record(bytes: &[u8]) -> Read<Vec<Value>> {
    let short = || damaged("a record is cut");
    let (head, mut kinds) = varint(bytes).ok_or_else(short)?;
    let head = usize::try_from(head).map_err(|_| short())?;
    let taken = bytes.len() - kinds.len();
    kinds = bytes.get(taken..head).ok_or_else(short)?;
    let mut content = bytes.get(head..).ok_or_else(short)?;
    let mut values = Vec::new();
    while !kinds.is_empty() {
        let (kind, rest) = varint(kinds).ok_or_else(short)?;
        kinds = rest;
        let size = match kind {
            0 | 8 | 9 => 0,
            1..=4 => kind as usize,
            5 => 6,
            6 | 7 => 8,
            12.. => usize::try_from((kind - 12) / 2).map_err(|_| short())?,
            _ => return Err(damaged("a value is of an unknown kind")),
        };
        let (own, rest) = content.split_at_checked(size).ok_or_else(short)?;
        content = rest;
        values.push(value(kind, own)?);
    }
    Ok(values)
}

fn value(kind: i64, bytes: &[u8]) -> Read<Value> {
    let whole = || {
        let negative = bytes.first().is_some_and(|b| b & 0x80 != 0);
        let start = if negative { -1i64 } else { 0 };
        bytes.iter().fold(start, |n, b| n << 8 | i64::from(*b))
    };
    Ok(match kind {
        0 => Value::Null,
        8 => Value::Integer(0),
        9 => Value::Integer(1),
        7 => Value::Real(f64::from_bits(whole() as u64)),
        1..=6 => Value::Integer(whole()),
        _ if kind % 2 == 0 => Value::Blob(bytes.to_vec()),
        _ => Value::Text(String::from_utf8_lossy(bytes).into_owned()),
    })
}
