//! The brackets of a script and a bound on how deeply it is nested, found without parsing it: the
//! parser and the compiler recurse, and a text of a million opening brackets would end the process.

/// How deeply operators, brackets and words such as `lambda` may be nested.
const DEPTH: usize = 400;
/// How far a line may be indented, and how many `elif`s a text may have.
const INDENT: usize = 400;

/// Pairs of matching brackets, by the bytes where they stand.
#[derive(Debug, Default)]
pub(crate) struct Layout {
    /// (opening, closing), in order of closing.
    pairs: Vec<(usize, usize)>,
    /// Openings in order.
    opens: Vec<usize>,
}

/// Where a text goes beyond the limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TooDeep {
    pub at: usize,
}

/// Words that nest what follows them.
const NESTING: [&str; 9] = [
    "and", "elif", "else", "for", "if", "in", "lambda", "not", "or",
];

impl Layout {
    /// Reads the brackets of `text`, strings and comments apart.
    pub fn read(text: &str) -> Result<Layout, TooDeep> {
        let mut layout = Layout::default();
        let mut scan = Scan {
            levels: vec![(0, 0)],
            indent: 0,
            elifs: 0,
            line_start: true,
        };
        let bytes = text.as_bytes();
        let mut at = 0;
        while at < bytes.len() {
            let length = scan.token(bytes, at, &mut layout)?;
            at += length;
        }
        Ok(layout)
    }

    /// The last closing bracket in `from..to`, with its opening one.
    pub fn last_closed(&self, from: usize, to: usize) -> Option<(usize, usize)> {
        let end = self.pairs.partition_point(|pair| pair.1 < to);
        self.pairs[..end]
            .last()
            .copied()
            .filter(|pair| pair.1 >= from)
    }

    /// The first opening bracket at or after `from`.
    pub fn first_opened(&self, from: usize) -> Option<usize> {
        self.opens
            .get(self.opens.partition_point(|open| *open < from))
            .copied()
    }
}

struct Scan {
    /// Open brackets: where they stand, and what nests inside them since the last comma.
    levels: Vec<(usize, usize)>,
    indent: usize,
    elifs: usize,
    line_start: bool,
}

impl Scan {
    /// Takes one token at `at`; how long it is.
    fn token(&mut self, bytes: &[u8], at: usize, layout: &mut Layout) -> Result<usize, TooDeep> {
        let byte = bytes[at];
        if self.line_start && byte != b' ' && byte != b'\t' {
            self.line_start = false;
        }
        match byte {
            b'#' => {
                return Ok(bytes[at..]
                    .iter()
                    .position(|b| *b == b'\n')
                    .unwrap_or(bytes.len() - at));
            }
            b'\'' | b'"' => return Ok(string(bytes, at)),
            b'\\' => return Ok(2),
            b' ' | b'\t' if self.line_start => self.indent += 1,
            b'\n' | b';' if self.levels.len() == 1 => {
                self.levels[0].1 = 0;
                self.line_start = byte == b'\n';
                self.indent = 0;
            }
            b',' => self.top().1 = 0,
            b'(' | b'[' | b'{' => {
                layout.opens.push(at);
                self.levels.push((at, 0));
            }
            b')' | b']' | b'}' if self.levels.len() > 1 => {
                if let Some((open, _)) = self.levels.pop() {
                    layout.pairs.push((open, at));
                }
                self.top().1 += 1;
            }
            b'+' | b'-' | b'*' | b'/' | b'%' | b'<' | b'>' | b'=' | b'!' | b'&' | b'|' | b'^'
            | b'~' | b'.' => {
                self.top().1 += 1;
            }
            b'_' | b'a'..=b'z' | b'A'..=b'Z' => {
                let word = bytes[at..]
                    .iter()
                    .position(|b| *b != b'_' && !b.is_ascii_alphanumeric());
                let word = &bytes[at..word.map_or(bytes.len(), |length| at + length)];
                self.elifs += usize::from(word == b"elif");
                self.top().1 += usize::from(NESTING.iter().any(|w| w.as_bytes() == word));
                self.check(at)?;
                return Ok(word.len());
            }
            _ => {}
        }
        self.check(at)?;
        Ok(1)
    }

    fn top(&mut self) -> &mut (usize, usize) {
        self.levels
            .last_mut()
            .expect("the outermost level is never popped")
    }

    fn check(&self, at: usize) -> Result<(), TooDeep> {
        // Sums over all levels only where a single one or their number has become large.
        let deep =
            self.levels.len() > DEPTH / 8 || self.levels.last().is_some_and(|l| l.1 > DEPTH / 8);
        let depth = || self.levels.iter().map(|level| level.1 + 1).sum::<usize>();
        if self.indent > INDENT || self.elifs > INDENT || (deep && depth() > DEPTH) {
            return Err(TooDeep { at });
        }
        Ok(())
    }
}

/// The length of the string that begins at `at`; to the end of the line or text if it is open.
fn string(bytes: &[u8], at: usize) -> usize {
    let quote = bytes[at];
    let triple = bytes[at..].starts_with(&[quote; 3]);
    let close: &[u8] = if triple { &[quote; 3] } else { &[quote] };
    let raw = at > 0 && matches!(bytes[at - 1], b'r' | b'R');
    let mut end = at + close.len();
    while end < bytes.len() {
        if bytes[end..].starts_with(close) {
            return end + close.len() - at;
        }
        if bytes[end] == b'\n' && !triple {
            break;
        }
        // In a raw string too a backslash keeps the quote after it from closing.
        end += if bytes[end] == b'\\' && (raw || end + 1 < bytes.len()) {
            2
        } else {
            1
        };
    }
    bytes.len().min(end) - at
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brackets_are_paired_outside_strings_and_comments() {
        let text = "f(a['(']) # )\n(b)\n'''(\n'''";
        let layout = Layout::read(text).unwrap();
        assert_eq!(layout.pairs, [(3, 7), (1, 8), (14, 16)]);
        assert_eq!(layout.last_closed(2, 9), Some((1, 8)));
        assert_eq!(layout.last_closed(2, 8), Some((3, 7)));
        assert_eq!(layout.last_closed(9, 14), None);
        assert_eq!(layout.first_opened(4), Some(14));
    }

    #[test]
    fn deep_texts_are_refused_and_long_ones_are_not() {
        for deep in [
            "(",
            "[",
            "-",
            "not ",
            "lambda: ",
            "1 if 1 else ",
            "x.",
            "f(",
            "1+",
            "f()",
        ] {
            let text = deep.repeat(5000);
            assert!(Layout::read(&text).is_err(), "{deep}");
        }
        let blocks: String = (0..1000)
            .map(|i| format!("{}if 1:\n", " ".repeat(i)))
            .collect();
        assert!(Layout::read(&blocks).is_err());
        assert!(Layout::read(&"elif x:\n  pass\n".repeat(1000)).is_err());
        let wide = format!("x = [{}]\n", vec!["-1.5 + f(2)"; 5000].join(", "));
        assert!(Layout::read(&wide.repeat(3)).is_ok());
        assert!(Layout::read("x = 'open\ny = \"\"\"open").is_ok());
        assert!(Layout::read("'\\").is_ok());
    }
}
