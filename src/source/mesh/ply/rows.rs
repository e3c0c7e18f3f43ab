//! The rows of a PLY file, one after the other, and where they are for errors.

use super::header::{Element, Form, Header, Property, Scalar};
use crate::mesh::lines::{Lines, shown};
use fretwork_geometry::counted;

/// The rows that are still to be read.
pub enum Rows<'a> {
    /// Numbers as their bytes.
    Binary { rest: &'a [u8], is_big_endian: bool },
    /// One row a line.
    Text {
        lines: Lines<'a>,
        row: &'a [u8],
        line: usize,
    },
}

impl<'a> Rows<'a> {
    pub fn new(header: &Header, body: &'a [u8]) -> Rows<'a> {
        match header.form {
            Form::Text => Rows::Text {
                lines: Lines::new(body, header.lines),
                row: b"",
                line: header.lines,
            },
            form => Rows::Binary {
                rest: body,
                is_big_endian: form == Form::BigEndian,
            },
        }
    }

    /// The bytes that are still to be read, of the row or of the file.
    pub fn rest(&self) -> &'a [u8] {
        match self {
            Rows::Binary { rest, .. } => rest,
            Rows::Text { lines, row: [], .. } => lines.rest(),
            Rows::Text { row, .. } => row,
        }
    }

    /// Where the row is that is being read, the one numbered `number` (from 1) of `element`.
    fn place(&self, element: &Element, number: u64) -> String {
        let name = &element.name;
        match self {
            Rows::Binary { .. } => format!("row {number} of `{name}`"),
            Rows::Text { line, .. } => format!("line {line}, row {number} of `{name}`"),
        }
    }

    /// Calls `read` for each row of the element; a row must have just what it reads.
    pub fn each(
        &mut self,
        element: &Element,
        mut read: impl FnMut(&mut Rows<'a>, u64) -> Result<(), String>,
    ) -> Result<(), String> {
        if element.properties.is_empty() {
            return Ok(());
        }
        for number in 1..=element.count {
            let made = self.next_row().and_then(|()| read(self, number));
            made.and_then(|()| self.end_row())
                .map_err(|what| format!("{}: {what}", self.place(element, number)))?;
        }
        Ok(())
    }

    fn next_row(&mut self) -> Result<(), String> {
        if let Rows::Text { lines, row, line } = self {
            let mut filled = lines.filter(|(_, text)| !text.trim_ascii().is_empty());
            (*line, *row) = filled.next().ok_or("it is cut off")?;
        }
        Ok(())
    }

    fn end_row(&mut self) -> Result<(), String> {
        match self {
            Rows::Text { row, .. } if !row.trim_ascii().is_empty() => Err(format!(
                "it has more values than the header says, first `{}`",
                shown(row.trim_ascii())
            )),
            Rows::Text { row, .. } => {
                *row = b"";
                Ok(())
            }
            Rows::Binary { .. } => Ok(()),
        }
    }

    /// What is left over after the last row.
    pub fn finish(self) -> Result<Option<String>, String> {
        match self {
            Rows::Text { mut lines, .. } => {
                match lines.find(|(_, text)| !text.trim_ascii().is_empty()) {
                    Some((line, _)) => Err(format!(
                        "line {line}: there are more rows than the header says"
                    )),
                    None => Ok(None),
                }
            }
            // Some programs end binary files with a line break.
            Rows::Binary { rest, .. } if rest.trim_ascii().is_empty() => Ok(None),
            Rows::Binary { rest, .. } => Ok(Some(format!(
                "{} after the last row {} not read: does the header fit the rows?",
                counted(rest.len(), "byte", "bytes"),
                if rest.len() == 1 { "is" } else { "are" }
            ))),
        }
    }

    pub fn number(&mut self, scalar: Scalar) -> Result<f64, String> {
        match self {
            Rows::Text { row, .. } => word(row),
            Rows::Binary {
                rest,
                is_big_endian,
            } => {
                let size = scalar.size();
                let mut bytes = [0u8; 8];
                bytes[..size].copy_from_slice(rest.get(..size).ok_or("it is cut off")?);
                *rest = &rest[size..];
                if *is_big_endian {
                    bytes[..size].reverse();
                }
                Ok(scalar.value(bytes))
            }
        }
    }

    /// The length of a list whose items are still to come.
    pub fn length(&mut self, length: Scalar, item: Scalar) -> Result<usize, String> {
        let count = self.number(length)?;
        let room = match self {
            // A digit and what parts it from the next, but for the last one.
            Rows::Text { .. } => (self.rest().len() as f64 + 1.0) / 2.0,
            Rows::Binary { .. } => self.rest().len() as f64 / item.size() as f64,
        };
        if count < 0.0 || count.fract() != 0.0 || count > room {
            return Err(format!("a list claims {count} items, and fewer are there"));
        }
        Ok(count as usize)
    }

    pub fn pass(&mut self, property: &Property) -> Result<(), String> {
        let count = property
            .length
            .map_or(Ok(1), |length| self.length(length, property.item))?;
        (0..count).try_for_each(|_| self.number(property.item).map(|_| ()))
    }
}

/// Takes the next word off a row; it must be a number.
fn word(row: &mut &[u8]) -> Result<f64, String> {
    let text = row.trim_ascii_start();
    let end = text.iter().position(u8::is_ascii_whitespace);
    let (word, rest) = text.split_at(end.unwrap_or(text.len()));
    *row = rest;
    if word.is_empty() {
        return Err("it has fewer values than the header says".into());
    }
    let number = std::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
    number.ok_or_else(|| format!("`{}` is no number", shown(word)))
}
