//! Lists of numbers in buffers.

use serde_json::Value as Json;

use super::document::Document;
use super::item;

/// Vectors of `N` numbers. Whole numbers that stand for fractions (`normalized`) are fractions here.
pub fn vectors<const N: usize>(document: &Document, number: &Json) -> Result<Vec<[f64; N]>, String> {
    let accessor = Accessor::read(document, number, N)?;
    Ok((0..accessor.count).map(|i| std::array::from_fn(|k| accessor.fraction(i, k))).collect())
}

/// Numbers of vertices.
pub fn indices(document: &Document, number: &Json) -> Result<Vec<u32>, String> {
    let accessor = Accessor::read(document, number, 1)?;
    if !matches!(accessor.kind, 5121 | 5123 | 5125) {
        return Err(format!("accessor {number} holds no numbers of vertices"));
    }
    Ok((0..accessor.count).map(|i| accessor.number(i, 0) as u32).collect())
}

struct Accessor<'a> {
    bytes: &'a [u8],
    count: usize,
    step: usize,
    kind: u64,
    is_normalized: bool,
}

impl<'a> Accessor<'a> {
    fn read(document: &'a Document, number: &Json, width: usize) -> Result<Accessor<'a>, String> {
        let accessor = item(document, "accessors", number)?;
        let wrong = |what: &str| format!("accessor {number} {what}");
        let expected = ["", "SCALAR", "VEC2", "VEC3", "VEC4"][width];
        if accessor["type"].as_str() != Some(expected) {
            return Err(wrong(&format!("is not of type {expected}")));
        }
        if !accessor["sparse"].is_null() {
            return Err(wrong("is sparse, which is not supported"));
        }
        let kind = accessor["componentType"].as_u64().unwrap_or(0);
        let size = match kind {
            5120 | 5121 => 1,
            5122 | 5123 => 2,
            5125 | 5126 => 4,
            _ => return Err(wrong("has no component type that is known")),
        };
        let whole = |name: &str| accessor[name].as_u64().and_then(|v| usize::try_from(v).ok());
        let count = whole("count").ok_or_else(|| wrong("has no count"))?;
        let (view, stride) = document.view(&accessor["bufferView"])?;
        let (start, item) = (whole("byteOffset").unwrap_or(0), width * size);
        let step = stride.filter(|step| *step > 0).unwrap_or(item);
        let needed = count.checked_sub(1).map_or(Some(0), |last| last.checked_mul(step)?.checked_add(item));
        let end = needed.and_then(|needed| start.checked_add(needed)).filter(|end| *end <= view.len());
        if end.is_none() || step < item {
            return Err(wrong(&format!("claims {count} items, more than its buffer view has bytes for")));
        }
        let is_normalized = accessor["normalized"].as_bool().unwrap_or(false);
        Ok(Accessor { bytes: view.get(start..).unwrap_or(&[]), count, step, kind, is_normalized })
    }

    fn number(&self, index: usize, component: usize) -> f64 {
        let at = |size: usize| index * self.step + component * size;
        let two = || [self.bytes[at(2)], self.bytes[at(2) + 1]];
        let four = || std::array::from_fn::<u8, 4, _>(|i| self.bytes[at(4) + i]);
        match self.kind {
            5120 => f64::from(self.bytes[at(1)] as i8),
            5121 => f64::from(self.bytes[at(1)]),
            5122 => f64::from(i16::from_le_bytes(two())),
            5123 => f64::from(u16::from_le_bytes(two())),
            5125 => f64::from(u32::from_le_bytes(four())),
            _ => f64::from(f32::from_le_bytes(four())),
        }
    }

    fn fraction(&self, index: usize, component: usize) -> f64 {
        let number = self.number(index, component);
        match self.kind {
            _ if !self.is_normalized => number,
            5120 => (number / 127.0).max(-1.0),
            5121 => number / 255.0,
            5122 => (number / 32767.0).max(-1.0),
            5123 => number / 65535.0,
            _ => number,
        }
    }
}
