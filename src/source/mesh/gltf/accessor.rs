//! Lists of numbers in buffers.

use serde_json::Value as Json;

use super::document::Document;

/// Vectors of `N` numbers, or the columns of matrices (16). Whole numbers that stand for fractions (`normalized`) are fractions here.
pub fn vectors<const N: usize>(
    document: &Document,
    number: &Json,
) -> Result<Vec<[f64; N]>, String> {
    read(document, number, N, [0.0; N], |block, i| {
        std::array::from_fn(|k| block.fraction(i, k))
    })
}

/// Numbers of vertices.
pub fn indices(document: &Document, number: &Json) -> Result<Vec<u32>, String> {
    if !is_whole(&document.item("accessors", number)?["componentType"]) {
        return Err(format!("accessor {number} holds no numbers of vertices"));
    }
    read(document, number, 1, 0, |block, i| block.number(i, 0) as u32)
}

/// The items of an accessor that are `width` numbers wide, those that it replaces (`sparse`) among them.
fn read<T: Clone>(
    document: &Document,
    number: &Json,
    width: usize,
    zero: T,
    value: impl Fn(&Block, usize) -> T,
) -> Result<Vec<T>, String> {
    let accessor = document.item("accessors", number)?;
    let wrong = |what: &str| format!("accessor {number} {what}");
    let expected = match width {
        1 => "SCALAR",
        2 => "VEC2",
        3 => "VEC3",
        4 => "VEC4",
        _ => "MAT4",
    };
    if accessor["type"].as_str() != Some(expected) {
        return Err(wrong(&format!("is not of type {expected}")));
    }
    let count = whole(&accessor["count"]).ok_or_else(|| wrong("has no count"))?;
    let (kind, is_normalized) = (
        &accessor["componentType"],
        accessor["normalized"].as_bool().unwrap_or(false),
    );
    let block = |place: &Json, count: usize, kind: &Json, width: usize| {
        Block::read(document, place, count, kind, width, is_normalized).map_err(|what| wrong(&what))
    };
    let sparse = &accessor["sparse"];
    let mut items: Vec<T> = if !accessor["bufferView"].is_null() || sparse.is_null() {
        let dense = block(accessor, count, kind, width)?;
        (0..count).map(|i| value(&dense, i)).collect()
    } else if count <= document.size() {
        vec![zero; count]
    } else {
        return Err(wrong(&format!(
            "claims {count} items, more than the file has bytes for"
        )));
    };
    if !sparse.is_null() {
        let replaced = whole(&sparse["count"])
            .ok_or_else(|| wrong("does not say how many items it replaces"))?;
        if !is_whole(&sparse["indices"]["componentType"]) {
            return Err(wrong("does not say which items it replaces"));
        }
        let places = block(
            &sparse["indices"],
            replaced,
            &sparse["indices"]["componentType"],
            1,
        )?;
        let values = block(&sparse["values"], replaced, kind, width)?;
        for i in 0..replaced {
            let slot = items.get_mut(places.number(i, 0) as usize);
            *slot.ok_or_else(|| wrong("replaces an item that it does not have"))? =
                value(&values, i);
        }
    }
    Ok(items)
}

fn whole(value: &Json) -> Option<usize> {
    value.as_u64().and_then(|v| usize::try_from(v).ok())
}

/// Whether this is a type of whole numbers that are not below zero.
fn is_whole(kind: &Json) -> bool {
    matches!(kind.as_u64(), Some(5121 | 5123 | 5125))
}

/// Numbers of one type in a buffer, so many to an item.
struct Block<'a> {
    bytes: &'a [u8],
    step: usize,
    kind: u64,
    is_normalized: bool,
}

impl<'a> Block<'a> {
    /// The block of `count` items at the `bufferView` and `byteOffset` of `place`.
    fn read(
        document: &'a Document,
        place: &Json,
        count: usize,
        kind: &Json,
        width: usize,
        is_normalized: bool,
    ) -> Result<Block<'a>, String> {
        let kind = kind.as_u64().unwrap_or(0);
        let size = match kind {
            5120 | 5121 => 1,
            5122 | 5123 => 2,
            5125 | 5126 => 4,
            _ => return Err("has no component type that is known".into()),
        };
        let (view, stride) = document
            .view(&place["bufferView"])
            .map_err(|e| format!("has no bytes: {e}"))?;
        let (start, item) = (whole(&place["byteOffset"]).unwrap_or(0), width * size);
        let step = stride.filter(|step| *step > 0).unwrap_or(item);
        let needed = count
            .checked_sub(1)
            .map_or(Some(0), |last| last.checked_mul(step)?.checked_add(item));
        let end = needed
            .and_then(|needed| start.checked_add(needed))
            .filter(|end| *end <= view.len());
        if end.is_none() || step < item {
            return Err(format!(
                "claims {count} items, more than its buffer view has bytes for"
            ));
        }
        Ok(Block {
            bytes: view.get(start..).unwrap_or(&[]),
            step,
            kind,
            is_normalized,
        })
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
