//! Text to its lines, whatever ends them: LF, CR LF, or CR alone.

/// `bytes` without the mark that some editors begin UTF-8 files with.
///
/// # Errors
/// A message when the mark is that of UTF-16.
pub fn unmarked(bytes: &[u8]) -> Result<&[u8], String> {
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err("it is UTF-16 text; save it as UTF-8".into());
    }
    Ok(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes))
}

/// The lines of a text with their numbers, from 1.
#[derive(Clone)]
pub struct Lines<'a> {
    rest: Option<&'a [u8]>,
    number: usize,
}

impl<'a> Lines<'a> {
    /// The lines of `bytes`; what is before them counts as `before` lines.
    pub fn new(bytes: &'a [u8], before: usize) -> Lines<'a> {
        Lines {
            rest: Some(bytes),
            number: before,
        }
    }

    /// What is still to come.
    pub fn rest(&self) -> &'a [u8] {
        self.rest.unwrap_or(b"")
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = (usize, &'a [u8]);

    fn next(&mut self) -> Option<(usize, &'a [u8])> {
        let rest = self.rest?;
        let end = rest.iter().position(|b| matches!(b, b'\n' | b'\r'));
        self.number += 1;
        let Some(end) = end else {
            self.rest = None;
            return Some((self.number, rest));
        };
        let length = if rest[end..].starts_with(b"\r\n") {
            2
        } else {
            1
        };
        self.rest = Some(&rest[end + length..]);
        Some((self.number, &rest[..end]))
    }
}

/// A piece of a file in a message: its first characters, without what is no text.
pub fn shown(word: &[u8]) -> String {
    let text: String = String::from_utf8_lossy(word).chars().take(20).collect();
    text.replace(char::is_control, "\u{fffd}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_end_of_a_line_ends_one() {
        let found: Vec<_> = Lines::new(b"a\nb\r\nc\rd\n\re", 2).collect();
        let expected: [(usize, &[u8]); 6] = [
            (3, b"a"),
            (4, b"b"),
            (5, b"c"),
            (6, b"d"),
            (7, b""),
            (8, b"e"),
        ];
        assert_eq!(found, expected);
        assert_eq!(Lines::new(b"", 0).count(), 1);
    }

    #[test]
    fn marks_are_taken_off() {
        assert_eq!(unmarked(b"\xef\xbb\xbfv"), Ok(&b"v"[..]));
        assert!(unmarked(b"\xff\xfev\0").unwrap_err().contains("UTF-16"));
    }
}
