//! The path of a request as text. One that means to leave its folder is none, however it is written.

/// A path with its escapes resolved; none where it holds `..` as a part, NUL or `\`, plain or in escapes of any depth, or
/// what is no UTF-8.
pub fn plain(path: &str) -> Option<String> {
    let decoded = unescaped(path)?;
    let mut text = decoded.clone();
    loop {
        if !is_harmless(&text) {
            return None;
        }
        // Each round is shorter than the one before, unless nothing is escaped any more.
        match unescaped(&text) {
            Some(next) if next != text => text = next,
            _ => return Some(decoded),
        }
    }
}

/// The value of a name in a query, its escapes resolved.
pub fn value(query: &str, name: &str) -> Option<String> {
    let mut pairs = query.split('&').filter_map(|pair| pair.split_once('='));
    let (_, value) = pairs.find(|(key, _)| *key == name)?;
    unescaped(value)
}

fn is_harmless(text: &str) -> bool {
    !text.contains(['\0', '\\']) && text.split('/').all(|part| part != "..")
}

/// The text with `%XX` resolved once; none where an escape is broken or the result is no UTF-8.
fn unescaped(text: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, more @ ..] = rest {
        rest = more;
        if *first != b'%' {
            bytes.push(*first);
            continue;
        }
        let [high, low, more @ ..] = rest else {
            return None;
        };
        let digit = |byte: &u8| char::from(*byte).to_digit(16);
        bytes.push((digit(high)? * 16 + digit(low)?) as u8);
        rest = more;
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_that_leaves_its_folder_is_none_however_it_is_written() {
        for path in [
            "/..",
            "/../x",
            "/files/../x",
            "/%2e%2e/x",
            "/.%2E/x",
            "/%252e%252e/x",
            "/%25252e./x",
            "/files/..%2fx",
            "/files/..%252fx",
            "/files/a%5c..",
            "/a\\b",
            "/%00",
            "/%2500",
            "/%",
            "/%2",
            "/%zz",
            "/%ff",
        ] {
            assert_eq!(plain(path), None, "{path}");
        }
    }

    #[test]
    fn other_paths_are_resolved_once() {
        for (path, text) in [
            ("/", "/"),
            ("/files/a%20b.svg", "/files/a b.svg"),
            ("/files/a..b", "/files/a..b"),
            ("/files/50%2525.svg", "/files/50%25.svg"),
            ("/files/50%25.svg", "/files/50%.svg"),
            ("/files/%C3%A9", "/files/é"),
        ] {
            assert_eq!(plain(path).as_deref(), Some(text), "{path}");
        }
        assert_eq!(value("a=1&v=%61b&v=c", "v").as_deref(), Some("ab"));
        assert_eq!(value("av=1&v", "v"), None);
    }
}
