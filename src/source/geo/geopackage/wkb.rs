//! Geometries of a GeoPackage: its header (GeoPackage 1.3, clause 2.1.3), then WKB in two or more
//! dimensions, of which the first two are kept.

use crate::geo::Record;
use fretwork_geometry::Point;

/// Geometries inside of one another, at most.
const DEEPEST: usize = 16;

/// Adds the geometry in `blob` to a record.
///
/// # Errors
/// With a sentence on what is wrong with it.
pub fn add(record: &mut Record, blob: &[u8]) -> Result<(), String> {
    let wrong = || "its geometry has no header of a GeoPackage".to_string();
    let [b'G', b'P', _, flags, ..] = blob else {
        return Err(wrong());
    };
    if flags & 0x20 != 0 {
        return Err("its geometry is of an extended type, which is not read".into());
    }
    if flags & 0x10 != 0 {
        return Ok(());
    }
    let envelope = match flags >> 1 & 7 {
        0 => 0,
        1 => 32,
        2 | 3 => 48,
        4 => 64,
        _ => return Err(wrong()),
    };
    let mut reader = Reader {
        bytes: blob.get(8 + envelope..).ok_or_else(wrong)?,
        is_little: true,
    };
    let added = reader.geometry(record, 0);
    added.ok_or_else(|| "its geometry is cut or of a type that is not read".to_string())
}

/// What is left of a geometry.
struct Reader<'a> {
    bytes: &'a [u8],
    is_little: bool,
}

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (own, rest) = self.bytes.split_first_chunk::<N>()?;
        self.bytes = rest;
        Some(*own)
    }

    fn count(&mut self) -> Option<u32> {
        let bytes = self.take()?;
        Some(if self.is_little {
            u32::from_le_bytes(bytes)
        } else {
            u32::from_be_bytes(bytes)
        })
    }

    fn number(&mut self) -> Option<f64> {
        let bytes = self.take()?;
        Some(if self.is_little {
            f64::from_le_bytes(bytes)
        } else {
            f64::from_be_bytes(bytes)
        })
    }

    fn point(&mut self, dimensions: usize) -> Option<Point> {
        let p = Point::new(self.number()?, self.number()?);
        for _ in 2..dimensions {
            self.number()?;
        }
        Some(p)
    }

    fn points(&mut self, dimensions: usize) -> Option<Vec<Point>> {
        let count = self.count()? as usize;
        if count.checked_mul(8 * dimensions)? > self.bytes.len() {
            return None;
        }
        (0..count).map(|_| self.point(dimensions)).collect()
    }

    fn geometry(&mut self, record: &mut Record, depth: usize) -> Option<()> {
        if depth > DEEPEST {
            return None;
        }
        let [order] = self.take()?;
        self.is_little = order == 1;
        let kind = self.count()?;
        // ISO counts dimensions in thousands, an older way in the highest bits.
        let old = (kind >> 31 & 1) as usize + (kind >> 30 & 1) as usize;
        let dimensions = match kind & 0x0fff_ffff {
            0..1000 => 2 + old,
            1000..3000 => 3,
            _ => 4,
        };
        match (kind & 0x0fff_ffff) % 1000 {
            1 => {
                let p = self.point(dimensions)?;
                // An empty point is written as one that is no number.
                if !(p.x.is_nan() && p.y.is_nan()) {
                    record.points.push(p);
                }
            }
            2 => record.lines.push(self.points(dimensions)?),
            3 => {
                for _ in 0..self.count()? {
                    let ring = self.points(dimensions)?;
                    record.push_ring(ring);
                }
            }
            4..=7 => {
                for _ in 0..self.count()? {
                    self.geometry(record, depth + 1)?;
                }
            }
            _ => return None,
        }
        Some(())
    }
}
